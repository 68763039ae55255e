!> Programmed burn, its set-up: the time at which the front of the detonation arrives in each cell, straight from the detonators at
!> constant speed. What then happens in a step is in burn_release.
!>
!> Unburnt explosive is the material of the products at rest at its own density and the ambient pressure. Its energy lies below that
!> of the equation of state's E0 by the energy of detonation, so what has burnt lies on the Hugoniot of the products, and the
!> Chapman-Jouguet state comes out by itself.
module burn
  use blocks, only: allocate_cells
  use burn_release, only: unburnt_part
  use flow_shapes, only: filled_shape
  use flow_state, only: flow_type
  use geometry, only: cell_volumes
  use kinds, only: wp
  use mesh, only: mesh_type
  use reductions, only: reduce_max, reduce_sum
  implicit none
  private
  public :: set_up_burn, end_burn, arrival_time, unburnt_energy

  integer, parameter, public :: detonator_point = 1, detonator_line = 2, detonator_plane = 3
  real(wp), parameter, public :: burnt_long_ago = -1e30_wp !< arrival where nothing is to burn
  real(wp), parameter :: margin = 4 !< cells around a charge that count as it
  real(wp), parameter :: earlier = 8 !< way of the front by which a place outside of a charge burns earlier, over its distance

  type, public :: detonator_type
    integer :: kind = detonator_point
    real(wp) :: position(3) = 0 !< the point, the start of the line, a point of the plane
    real(wp) :: end(3) = 0 !< of the line
    real(wp) :: normal(3) = 0 !< of the plane
    real(wp) :: time = 0
  end type detonator_type

  !> A charge that burns; without detonators one that has burnt before the start.
  type, public :: burning_charge
    type(filled_shape) :: shape
    integer :: material = 0 !< of the flow
    real(wp) :: speed = 0 !< of the front
    real(wp) :: energy = 0 !< released per mass
    type(detonator_type), allocatable :: detonator(:)
  end type burning_charge

contains

  !> Sets arrivals, energies and rates of the flow; with ghosts, from places alone, so that bricks and ranks agree.
  !> width: cells over which the energy is released.
  subroutine set_up_burn(mesh, flow, charges, width)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(burning_charge), intent(in) :: charges(:)
    real(wp), intent(in) :: width
    real(wp) :: length, last, nothing(0), x(3)
    integer :: c, b, i, j, k
    flow%burn_speed = 0
    flow%burn_energy = 0
    flow%burn_rate = 0
    length = width*maxval(mesh%spacing, mesh%active)
    do c = 1, size(charges)
      if (size(charges(c)%detonator) == 0) cycle
      flow%burn_energy(charges(c)%material) = charges(c)%energy
      flow%burn_rate(charges(c)%material) = charges(c)%speed/length
      flow%burn_speed = max(flow%burn_speed, charges(c)%speed)
    end do
    if (.not. flow%burn_speed > 0) return
    last = 0
    do b = 1, mesh%n_local
      call allocate_cells(flow%arrival(b), mesh%brick_cells, mesh%ghost, 1, burnt_long_ago)
      do k = 1 - mesh%ghost(3), mesh%brick_cells(3) + mesh%ghost(3)
        do j = 1 - mesh%ghost(2), mesh%brick_cells(2) + mesh%ghost(2)
          do i = 1 - mesh%ghost(1), mesh%brick_cells(1) + mesh%ghost(1)
            x = centre_of(mesh, mesh%brick(mesh%local(b))%location*mesh%brick_cells + [i, j, k])
            flow%arrival(b)%a(i, 1, j, k) = arrival_at(mesh, charges, length, x)
          end do
        end do
      end do
      last = max(last, maxval(flow%arrival(b)%a))
      if (.not. any(flow%arrival(b)%a > burnt_long_ago)) deallocate (flow%arrival(b)%a)
    end do
    call reduce_max(last, nothing)
    flow%burn_end = last + length/minval(flow%burn_rate*length, flow%burn_rate > 0) ! half of it and some more for round-off
  end subroutine set_up_burn

  !> Lets go of the arrivals once all has burnt. The same on every rank, and no bit of the flow depends on it.
  subroutine end_burn(flow)
    type(flow_type), intent(inout) :: flow
    integer :: b
    if (.not. (flow%burn_speed > 0 .and. flow%time > flow%burn_end)) return
    flow%burn_speed = 0
    do b = 1, size(flow%arrival)
      if (allocated(flow%arrival(b)%a)) deallocate (flow%arrival(b)%a)
    end do
  end subroutine end_burn

  !> Centre of a cell of the domain, ghosts included; beyond periodic faces that of the cell it stands for.
  pure function centre_of(mesh, cell) result(x)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: cell(3)
    real(wp) :: x(3)
    x = mesh%lower + (merge(modulo(cell - 1, mesh%cells) + 1, cell, mesh%periodic) - 0.5_wp)*mesh%spacing
  end function centre_of

  !> Arrival in a cell: that of the nearest charge, if it is near. length: over which the energy is released.
  pure real(wp) function arrival_at(mesh, charges, length, x) result(arrival)
    type(mesh_type), intent(in) :: mesh
    type(burning_charge), intent(in) :: charges(:)
    real(wp), intent(in) :: length, x(3)
    real(wp) :: d, nearest
    integer :: c
    arrival = burnt_long_ago
    nearest = margin*maxval(mesh%spacing, mesh%active)
    do c = 1, size(charges)
      d = charges(c)%shape%distance(x)
      if (.not. d < nearest) cycle
      nearest = d
      arrival = burnt_long_ago
      if (size(charges(c)%detonator) > 0) arrival = arrival_time(charges(c), length, mesh%active, x)
    end do
  end function arrival_at

  !> Time at which the front of a charge is at x: of its detonators the one counts that comes first. What lies within half a length
  !> of release of a detonator burns together, so that nothing has burnt before the detonator's time. Outside of the charge
  !> it is the earlier the further out: what flies off, faster than the front, goes on burning and must not take energy back.
  pure real(wp) function arrival_time(charge, length, active, x) result(arrival)
    type(burning_charge), intent(in) :: charge
    real(wp), intent(in) :: length, x(3)
    logical, intent(in) :: active(3)
    real(wp) :: outside
    integer :: i
    outside = max(charge%shape%distance(x), 0.0_wp)
    arrival = huge(1.0_wp)
    do i = 1, size(charge%detonator)
      arrival = min(arrival, charge%detonator(i)%time + &
        max(distance_from(charge%detonator(i), active, x) - earlier*outside, 0.5_wp*length)/charge%speed)
    end do
  end function arrival_time

  !> Distance from a detonator in the active directions.
  pure real(wp) function distance_from(detonator, active, x) result(distance)
    type(detonator_type), intent(in) :: detonator
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: x(3)
    real(wp) :: away(3), axis(3)
    away = merge(x - detonator%position, 0.0_wp, active)
    select case (detonator%kind)
    case (detonator_line)
      axis = merge(detonator%end - detonator%position, 0.0_wp, active)
      if (any(abs(axis) > 0)) away = away - min(max(dot_product(away, axis)/dot_product(axis, axis), 0.0_wp), 1.0_wp)*axis
      distance = norm2(away)
    case (detonator_plane)
      axis = merge(detonator%normal, 0.0_wp, active)
      distance = abs(dot_product(away, axis))/norm2(axis)
    case default
      distance = norm2(away)
    end select
  end function distance_from

  !> Energy that the open cells are still to release at the flow's time; the same bits on any number of ranks.
  real(wp) function unburnt_energy(mesh, flow) result(energy)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    real(wp) :: partial(1, mesh%n_local), total(1), row(mesh%brick_cells(1)), here(mesh%brick_cells(1))
    integer :: b, j, k, m
    energy = 0
    if (.not. flow%burn_speed > 0) return
    partial = 0
    do b = 1, mesh%n_local
      if (.not. allocated(flow%arrival(b)%a)) cycle
      row = 0
      associate (nx => mesh%brick_cells(1), w => flow%w(b, flow%current)%a, arrival => flow%arrival(b)%a)
        do k = 1, mesh%brick_cells(3)
          do j = 1, mesh%brick_cells(2)
            do m = 1, flow%n_materials
              if (.not. flow%burn_energy(m) > 0) cycle
              here = flow%burn_energy(m)*w(1:nx, m, j, k)*unburnt_part(flow%time, arrival(1:nx, 1, j, k), flow%burn_rate(m))
              if (allocated(flow%open(b)%a)) here = merge(here, 0.0_wp, flow%open(b)%a(1:nx, 1, j, k) > 0)
              row = row + here
            end do
          end do
        end do
      end associate
      partial(1, b) = sum(row*cell_volumes(mesh, b))
    end do
    call reduce_sum(mesh, partial, total)
    energy = total(1)
  end function unburnt_energy

end module burn
