!> Which cells the solid takes up (paper section 3.1, eq. 28): from the particles alone, no surface is reconstructed.
!> Fluid (type II): no particle. Inside (type I): a particle cell whose face neighbours all are particle cells.
!> Interface (type III): the other particle cells.
module cell_types
  use blocks, only: block
  use halo, only: halo_type, fill
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: classify_cells, mirror_ghosts

  real(wp), parameter, public :: fluid_cell = 0, interface_cell = 1, inside_cell = 2

contains

  !> Sets kind (fluid_cell, interface_cell, inside_cell) in all cells and ghost layers from the number of particles in each cell.
  !> occupancy: one variable, its ghosts are set here; beyond the faces of the domain the solid is taken to go on as it is
  !> at the face, so that a body cut by a symmetry plane is inside there. Where occupancy is unallocated kind stays as it is: all
  !> fluid.
  subroutine classify_cells(mesh, halo, occupancy, kind)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(block), intent(inout) :: occupancy(:), kind(:)
    integer :: b
    call fill(mesh, halo, occupancy, 1, only_faces=.true.)
    do b = 1, mesh%n_local
      if (.not. allocated(occupancy(b)%a)) cycle
      call mirror_ghosts(mesh, mesh%local(b), occupancy(b))
      call classify_brick(mesh%brick_cells, mesh%active, mesh%ghost, occupancy(b)%a(:, 1, :, :), kind(b)%a(:, 1, :, :))
    end do
    call fill(mesh, halo, kind, 1)
    do b = 1, mesh%n_local
      if (allocated(occupancy(b)%a)) call mirror_ghosts(mesh, mesh%local(b), kind(b))
    end do
  end subroutine classify_cells

  !> n: cells of the brick; active: directions with neighbours; ghost: layers around the cells in both arrays.
  subroutine classify_brick(n, active, ghost, occupancy, kind)
    integer, intent(in) :: n(3), ghost(3)
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: occupancy(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(inout) :: kind(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):)
    integer :: i, j, k, d, step(3)
    logical :: inside
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          kind(i, j, k) = fluid_cell
          if (occupancy(i, j, k) < 0.5_wp) cycle
          inside = .true.
          do d = 1, 3
            if (.not. active(d)) cycle
            step = merge(1, 0, [1, 2, 3] == d)
            inside = inside .and. occupancy(i - step(1), j - step(2), k - step(3)) > 0 &
                     .and. occupancy(i + step(1), j + step(2), k + step(3)) > 0
          end do
          kind(i, j, k) = merge(inside_cell, interface_cell, inside)
        end do
      end do
    end do
  end subroutine classify_brick

  !> Ghost cells beyond the faces of the domain get the values of the cells at the mirror place (variable 1).
  subroutine mirror_ghosts(mesh, brick, b)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: brick
    type(block), intent(inout) :: b
    integer :: g
    associate (n => mesh%brick_cells, low => mesh%brick(brick)%at_low, high => mesh%brick(brick)%at_high)
      do g = 1, mesh%ghosts
        if (mesh%active(1) .and. low(1)) b%a(1 - g, 1, :, :) = b%a(g, 1, :, :)
        if (mesh%active(1) .and. high(1)) b%a(n(1) + g, 1, :, :) = b%a(n(1) + 1 - g, 1, :, :)
        if (mesh%active(2) .and. low(2)) b%a(:, 1, 1 - g, :) = b%a(:, 1, g, :)
        if (mesh%active(2) .and. high(2)) b%a(:, 1, n(2) + g, :) = b%a(:, 1, n(2) + 1 - g, :)
        if (mesh%active(3) .and. low(3)) b%a(:, 1, :, 1 - g) = b%a(:, 1, :, g)
        if (mesh%active(3) .and. high(3)) b%a(:, 1, :, n(3) + g) = b%a(:, 1, :, n(3) + 1 - g)
      end do
    end associate
  end subroutine mirror_ghosts

end module cell_types
