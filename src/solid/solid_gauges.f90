!> Gauges that move with the solid: each follows the particle that was nearest to a point at the start.
module solid_gauges
  use kinds, only: wp
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_DOUBLE_PRECISION, MPI_SUM
  use parallel, only: world
  use particles, only: at_position, at_velocity, at_stress
  use reductions, only: reduce_min
  use solid_state, only: solid_type
  implicit none
  private
  public :: nearest_particle, read_gauges

  integer, parameter, public :: n_gauge_values = 7 !< position (3), velocity (3), pressure

  !> The particle that a gauge follows, and where this rank saw it last.
  type, public :: solid_gauge
    integer :: id = 0 !< number of the particle, 0: none
    integer :: set = 0 !< its material
    logical :: lost = .false. !< it left the domain
    real(wp) :: value(n_gauge_values) = 0 !< the last values read
    integer :: local = 0, index = 0 !< brick and place on this rank, 0: elsewhere
  end type solid_gauge

contains

  !> The particle nearest to a point (the first in brick order of equally near ones), on all ranks.
  function nearest_particle(mesh, solid, point) result(gauge)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    real(wp), intent(in) :: point(3)
    type(solid_gauge) :: gauge
    real(wp) :: best, distance, companion(2)
    integer :: b, set, i
    best = huge(best)
    companion = 0
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          do i = 1, blk%n
            distance = sum((blk%f(i, at_position:at_position + 2) - point)**2, mesh%active)
            if (distance >= best) cycle
            best = distance
            companion = [real(wp) :: blk%id(i), set]
          end do
        end associate
      end do
    end do
    call reduce_min(best, companion)
    gauge%id = nint(companion(1))
    gauge%set = nint(companion(2))
  end function nearest_particle

  !> Brings gauge%value up to date on all ranks; a gauge whose particle left keeps its last values.
  subroutine read_gauges(mesh, solid, gauges)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(solid_gauge), intent(inout) :: gauges(:)
    real(wp) :: mine(n_gauge_values + 1, size(gauges)), everyone(n_gauge_values + 1, size(gauges))
    integer :: g
    if (size(gauges) == 0) return
    mine = 0
    do g = 1, size(gauges)
      if (gauges(g)%id == 0 .or. gauges(g)%lost) cycle
      call find_gauge(mesh, solid, gauges(g))
      if (gauges(g)%local == 0) cycle
      associate (blk => solid%block(gauges(g)%set, gauges(g)%local), i => gauges(g)%index)
        mine(1:3, g) = blk%f(i, at_position:at_position + 2)
        mine(4:6, g) = blk%f(i, at_velocity:at_velocity + 2)
        mine(7, g) = -(blk%f(i, at_stress) + blk%f(i, at_stress + 1) + blk%f(i, at_stress + 2))/3
        mine(n_gauge_values + 1, g) = 1
      end associate
    end do
    call MPI_Allreduce(mine, everyone, size(mine), MPI_DOUBLE_PRECISION, MPI_SUM, world)
    do g = 1, size(gauges)
      if (everyone(n_gauge_values + 1, g) > 0.5_wp) then
        gauges(g)%value = everyone(:n_gauge_values, g)
      else
        gauges(g)%lost = .true.
      end if
    end do
  end subroutine read_gauges

  !> Looks where the particle was, then in the same brick, then in all.
  subroutine find_gauge(mesh, solid, gauge)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(solid_gauge), intent(inout) :: gauge
    integer :: b
    if (gauge%local > 0) then
      associate (blk => solid%block(gauge%set, gauge%local))
        if (gauge%index <= blk%n) then
          if (blk%id(gauge%index) == gauge%id) return
        end if
        gauge%index = findloc(blk%id(:blk%n), gauge%id, dim=1)
        if (gauge%index > 0) return
      end associate
    end if
    do b = 1, mesh%n_local
      gauge%index = findloc(solid%block(gauge%set, b)%id(:solid%block(gauge%set, b)%n), gauge%id, dim=1)
      gauge%local = b
      if (gauge%index > 0) return
    end do
    gauge%local = 0
  end subroutine find_gauge

end module solid_gauges
