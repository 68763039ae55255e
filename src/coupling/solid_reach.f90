!> Which bricks the solid concerns: those that hold particles and those that border on them. Only they need arrays of the coupling.
module solid_reach
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_IN_PLACE, MPI_LOGICAL, MPI_LOR
  use parallel, only: world
  use solid_state, only: solid_type, brick_particles
  implicit none
  private
  public :: near_solid

contains

  !> True for local bricks that hold particles or have a neighbour, across a face, an edge or a corner, that does. By all ranks.
  function near_solid(mesh, solid) result(near)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    logical :: near(mesh%n_local), holds(size(mesh%brick))
    integer :: b, i, j, k, other
    holds = .false.
    do b = 1, mesh%n_local
      holds(mesh%local(b)) = brick_particles(solid, b) > 0
    end do
    call MPI_Allreduce(MPI_IN_PLACE, holds, size(holds), MPI_LOGICAL, MPI_LOR, world)
    do b = 1, mesh%n_local
      near(b) = holds(mesh%local(b))
      do k = -1, 1
        do j = -1, 1
          do i = -1, 1
            other = mesh%brick(mesh%local(b))%neighbour(i, j, k)
            if (other > 0) near(b) = near(b) .or. holds(other)
          end do
        end do
      end do
    end do
  end function near_solid

end module solid_reach
