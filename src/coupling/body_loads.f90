!> What the flow does to each body: force, moment and impulse, and on its surface overpressure, peak, impulse per area and arrival.
!>
!> All follow from the impulse that the coupling books in the interface cells of a step, so the impulses of the bodies sum up to
!> that of the coupling. A cell's particles share its impulse equally, as they share the force. The maps are carried by the particles
!> of the interface cells, in columns of their own: they move with the surface, from rank to rank and through a restart.
module body_loads
  use interface_cells, only: interface_list
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_mass, at_position, at_velocity, load_overpressure, load_peak, load_impulse, load_arrival, &
    load_not_wetted, load_not_reached, n_load_columns
  use reductions, only: reduce_sum
  use rigid_motion, only: cross_product
  use solid_state, only: solid_type
  implicit none
  private
  public :: start_loads, gather_loads, sum_loads

  !> Sums by brick, so that they do not depend on who owns it.
  type, public :: body_loads_type
    logical :: active = .false.
    real(wp) :: threshold = 0 !< overpressure that counts as arrival
    real(wp), allocatable :: latest(:, :, :) !< (6, body, local brick) impulse and its moment about the origin, of the last step
    real(wp), allocatable :: impulse(:, :, :) !< (3, body, local brick) since the start
    real(wp) :: duration = 1 !< of the last step
  end type body_loads_type

  !> The loads on all bodies at one time.
  type, public :: body_sums
    real(wp), allocatable :: force(:, :), moment(:, :) !< (3, body) mean of the last step; moment about where the centre of mass was then
    real(wp), allocatable :: impulse(:, :) !< since the start
    real(wp), allocatable :: center(:, :), velocity(:, :) !< of mass
  end type body_sums

contains

  !> Nothing has been felt yet.
  subroutine start_loads(loads, mesh, solid, threshold)
    type(body_loads_type), intent(out) :: loads
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: threshold
    integer :: b, set
    loads%active = .true.
    loads%threshold = threshold
    allocate (loads%latest(6, solid%n_bodies, mesh%n_local), loads%impulse(3, solid%n_bodies, mesh%n_local), source=0.0_wp)
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        solid%block(set, b)%f(:, solid%at_load(set) + load_arrival) = load_not_wetted
      end do
    end do
  end subroutine start_loads

  !> Takes in the impulses of a step, before the particles move. list: interface cells of each local brick; face: area of cell faces
  !> by direction; time: at the end of the step.
  subroutine gather_loads(loads, mesh, solid, list, face, time, dt)
    type(body_loads_type), intent(inout) :: loads
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(interface_list), intent(in) :: list(:)
    real(wp), intent(in) :: face(3), time, dt
    real(wp) :: share(3), pressure
    integer :: b, set, c, cell, first, last
    loads%latest = 0
    loads%duration = dt
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          blk%f(:blk%n, solid%at_load(set) + load_overpressure) = 0
        end associate
      end do
      do c = 1, list(b)%n
        associate (at => list(b)%cell(:, c), impulse => list(b)%impulse(:, c))
          share = impulse/solid%count(b)%a(at(1), 1, at(2), at(3))
          pressure = overpressure(impulse/dt, list(b)%closed(:, c), face, mesh%active)
          cell = at(1) + mesh%brick_cells(1)*(at(2) - 1 + mesh%brick_cells(2)*(at(3) - 1))
          do set = 1, solid%n_sets
            if (solid%block(set, b)%n == 0) cycle
            associate (blk => solid%block(set, b))
              first = blk%cell_start(cell)
              last = blk%cell_start(cell + 1) - 1
              if (last < first) cycle
              call share_impulse(first, last, blk%capacity, blk%f(:, at_position:at_position + 2), blk%body, share, &
                                 loads%latest(:, :, b))
              call note_pressure(first, last, blk%capacity, blk%f(:, solid%at_load(set):solid%at_load(set) + n_load_columns - 1), &
                                 pressure, time, dt, loads%threshold)
            end associate
          end do
        end associate
      end do
    end do
    loads%impulse = loads%impulse + loads%latest(1:3, :, :)
  end subroutine gather_loads

  !> Gives each particle first..last its share of the impulse; latest: of each body, with the moment about the origin.
  pure subroutine share_impulse(first, last, capacity, position, body, share, latest)
    integer, intent(in) :: first, last, capacity
    real(wp), intent(in) :: position(capacity, 3), share(3)
    integer, intent(in) :: body(capacity)
    real(wp), intent(inout) :: latest(:, :)
    real(wp) :: place(3)
    integer :: i, from
    from = first
    do i = first, last ! in runs of the same body
      if (i < last) then
        if (body(i + 1) == body(from)) cycle
      end if
      place = [sum(position(from:i, 1)), sum(position(from:i, 2)), sum(position(from:i, 3))]
      latest(1:3, body(from)) = latest(1:3, body(from)) + (i - from + 1)*share
      latest(4:6, body(from)) = latest(4:6, body(from)) + cross_product(place, share)
      from = i + 1
    end do
  end subroutine share_impulse

  !> Takes the pressure of a cell to its particles first..last. felt: their columns, from load_overpressure on.
  pure subroutine note_pressure(first, last, capacity, felt, pressure, time, dt, threshold)
    integer, intent(in) :: first, last, capacity
    real(wp), intent(inout) :: felt(capacity, 0:n_load_columns - 1)
    real(wp), intent(in) :: pressure, time, dt, threshold
    real(wp) :: arrival
    integer :: i
    arrival = merge(time, load_not_reached, pressure > threshold)
    do i = first, last
      felt(i, load_overpressure) = pressure
      felt(i, load_peak) = max(felt(i, load_peak), pressure)
      felt(i, load_impulse) = felt(i, load_impulse) + dt*pressure
      felt(i, load_arrival) = merge(felt(i, load_arrival), arrival, felt(i, load_arrival) >= 0)
    end do
  end subroutine note_pressure

  !> Pressure over the reference that makes this force on the closed faces of a cell. closed: by direction, high less low. A cell
  !> without any, or with one on either side, is a body as thin as a cell or its edge: the force over the face that feels most of it.
  pure real(wp) function overpressure(force, closed, face, active)
    real(wp), intent(in) :: force(3), face(3)
    integer, intent(in) :: closed(3)
    logical, intent(in) :: active(3)
    real(wp) :: area(3)
    area = merge(closed*face, 0.0_wp, active)
    if (any(abs(area) > 0)) then
      overpressure = sum(force*area)/sum(area**2)
    else
      overpressure = maxval(abs(force)/face, active)
    end if
  end function overpressure

  !> The loads on all bodies; the same bits on any number of ranks. A body that has left the domain has its centre at the origin.
  function sum_loads(loads, mesh, solid) result(sums)
    type(body_loads_type), intent(in) :: loads
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(body_sums) :: sums
    integer, parameter :: width = 16
    real(wp) :: partial(width, solid%n_bodies, mesh%n_local), total(width*solid%n_bodies), mass, acted(3)
    integer :: b, set, i, body
    partial = 0
    do b = 1, mesh%n_local
      partial(1:6, :, b) = loads%latest(:, :, b)
      partial(7:9, :, b) = loads%impulse(:, :, b)
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          do i = 1, blk%n
            associate (p => partial(10:16, blk%body(i), b))
              p = p + blk%f(i, at_mass)*[1.0_wp, blk%f(i, at_position:at_position + 2), blk%f(i, at_velocity:at_velocity + 2)]
            end associate
          end do
        end associate
      end do
    end do
    call reduce_sum(mesh, reshape(partial, [width*solid%n_bodies, mesh%n_local]), total)
    allocate (sums%force(3, solid%n_bodies), sums%moment(3, solid%n_bodies), sums%impulse(3, solid%n_bodies))
    allocate (sums%center(3, solid%n_bodies), sums%velocity(3, solid%n_bodies))
    do body = 1, solid%n_bodies
      associate (s => total(width*(body - 1) + 1:width*body))
        mass = max(s(10), tiny(1.0_wp))
        sums%center(:, body) = s(11:13)/mass
        sums%velocity(:, body) = s(14:16)/mass
        sums%force(:, body) = s(1:3)/loads%duration
        acted = sums%center(:, body) - loads%duration*sums%velocity(:, body)
        sums%moment(:, body) = s(4:6)/loads%duration - cross_product(acted, sums%force(:, body))
        sums%impulse(:, body) = s(7:9)
      end associate
    end do
  end function sum_loads

end module body_loads
