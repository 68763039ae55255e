!> Which solvers a scene still needs. The solid waits, rigid and at rest, until something acts on it; the flow ends when what it
!> does to the solid has faded; the solid ends when it has come to rest.
module stages
  use constants, only: unset
  use deck_stages, only: stages_group
  use flow_state, only: flow_type
  use flow_totals, only: flow_totals_type
  use immersed_boundary, only: coupling_type
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_energy, at_mass, at_velocity
  use reductions, only: any_rank, reduce_sum
  use rigid_bodies, only: all_fixed
  use solid_state, only: solid_type, book_coupling_impulse, book_impulse, book_lost_kinetic, book_lost_momentum, &
    n_supports
  use time_record, only: record_type
  implicit none
  private
  public :: start_stages, note_load, hold_load, note_motion, flow_has_faded, solid_rests, arrest_solid, pack_stages, unpack_stages

  !> Parts of the reference pressure on a cell's face: what still fluid may seem to do, and what counts as the begin of a load.
  real(wp), parameter :: round_off = 1e-12_wp, noticeable = 1e-6_wp

  !> Where the scene stands, and what has been seen of loads and motion.
  type, public :: stages_type
    type(stages_group) :: plan
    logical :: solid_waits = .false. !< nothing has acted on it yet, or nothing can move it
    logical :: solid_is_fixed = .false. !< all bodies are fixed: they wait for ever
    logical :: solid_met = .false. !< the coupling has seen the solid that waits
    logical :: flow_over = .false.
    logical :: solid_over = .false.
    real(wp) :: flow_ended = unset, solid_started = unset, solid_ended = unset !< times
    real(wp) :: load = 0 !< sum over the solid's cells of the size of the force, times time
    type(record_type) :: loads !< load over time, from the first noticeable one on
    real(wp) :: most_motion = 0 !< largest kinetic energy of the solid so far
    type(record_type) :: motions !< kinetic energy over time
    type(flow_totals_type) :: last_flow !< when the flow ended
  end type stages_type

contains

  !> What may wait at the start. coupled: flow and solid meet.
  subroutine start_stages(stages, plan, solid, coupled)
    type(stages_type), intent(out) :: stages
    type(stages_group), intent(in) :: plan
    type(solid_type), intent(in) :: solid
    logical, intent(in) :: coupled
    stages%plan = plan
    if (.not. coupled) return
    stages%solid_is_fixed = all_fixed(solid)
    stages%solid_waits = trim(plan%solid_start) == 'loaded' .and. .not. any_rank(moves_by_itself(solid))
  end subroutine start_stages

  !> Something of this rank's solid would move without a load: it has speed or strain, or gravity pulls.
  pure logical function moves_by_itself(solid) result(moves)
    type(solid_type), intent(in) :: solid
    integer :: set, b
    moves = any(abs(solid%gravity) > 0)
    do b = 1, size(solid%block, 2)
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          moves = moves .or. any(abs(blk%f(:blk%n, at_velocity:at_velocity + 2)) > 0) .or. any(abs(blk%f(:blk%n, at_energy)) > 0)
        end associate
      end do
    end do
  end function moves_by_itself

  !> Takes in the force on the solid over a step of length dt that ends at this time; a load that is more than round-off ends the
  !> wait of a solid that can move.
  subroutine note_load(stages, mesh, coupling, time, dt)
    type(stages_type), intent(inout) :: stages
    type(mesh_type), intent(in) :: mesh
    type(coupling_type), intent(in) :: coupling
    real(wp), intent(in) :: time, dt
    real(wp) :: partial(3, mesh%n_local), total(3), force, whole
    integer :: b, c
    partial = 0
    whole = abs(coupling%reference_pressure)*minval(coupling%face)
    do b = 1, mesh%n_local
      do c = 1, coupling%list(b)%n
        force = norm2(coupling%list(b)%impulse(:, c))/dt
        partial(1, b) = partial(1, b) + force
        if (force > round_off*whole) partial(2, b) = 1
        if (force > noticeable*whole) partial(3, b) = 1
      end do
    end do
    call reduce_sum(mesh, partial, total)
    if (.not. total(2) > 0) return
    if (.not. stages%loads%has_begun() .and. total(3) > 0) call stages%loads%note(time - dt, stages%load)
    stages%load = stages%load + dt*total(1)
    if (stages%loads%has_begun()) call stages%loads%note(time, stages%load)
    if (stages%solid_waits .and. .not. stages%solid_is_fixed) then
      stages%solid_waits = .false.
      stages%solid_started = time - dt
    end if
  end subroutine note_load

  !> What the flow has given in a step to a solid that does not run goes to what holds it: the last of its supports.
  subroutine hold_load(coupling, solid)
    type(coupling_type), intent(in) :: coupling
    type(solid_type), intent(inout) :: solid
    integer, parameter :: held = book_impulse + 3*(n_supports - 1)
    real(wp) :: impulse(3)
    integer :: b
    do b = 1, size(coupling%list)
      if (coupling%list(b)%n == 0) cycle
      impulse = sum(coupling%list(b)%impulse, dim=2)
      associate (books => solid%books(:, b))
        books(book_coupling_impulse:book_coupling_impulse + 2) = books(book_coupling_impulse:book_coupling_impulse + 2) + impulse
        books(held:held + 2) = books(held:held + 2) - impulse
      end associate
    end do
  end subroutine hold_load

  !> The loads have faded, or the time set for it has come. part: what the second half of the time since the first load brought, of
  !> all. A load that falls like a power of time, of exponent two or more, has no more than that still to come.
  subroutine flow_has_faded(stages, flow, time, faded, part)
    type(stages_type), intent(in) :: stages
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: time
    logical, intent(out) :: faded !< never before all has burnt
    real(wp), intent(out) :: part
    faded = .false.
    part = 1
    if (stages%loads%has_begun()) &
      part = (stages%load - stages%loads%value_at(half_of=time))/max(stages%load, tiny(1.0_wp))
    if (.not. time > flow%burn_end) return
    faded = stages%plan%flow_end_time > unset .and. time >= stages%plan%flow_end_time
    if (trim(stages%plan%flow_end) == 'faded') faded = faded .or. part < stages%plan%faded_part
  end subroutine flow_has_faded

  !> Takes in the kinetic energy of the solid.
  subroutine note_motion(stages, mesh, solid, time)
    type(stages_type), intent(inout) :: stages
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    real(wp), intent(in) :: time
    real(wp) :: partial(1, mesh%n_local), total(1)
    integer :: b, set, d
    partial = 0
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          do d = 0, 2
            partial(1, b) = partial(1, b) + 0.5_wp*sum(blk%f(:blk%n, at_mass)*blk%f(:blk%n, at_velocity + d)**2)
          end do
        end associate
      end do
    end do
    call reduce_sum(mesh, partial, total)
    if (.not. total(1) > 0) return
    stages%most_motion = max(stages%most_motion, total(1))
    call stages%motions%note(time, total(1))
  end subroutine note_motion

  !> The solid has hardly moved in the second half of the time since it began to. part: largest kinetic energy of that half, of the
  !> largest ever.
  subroutine solid_rests(stages, time, rests, part)
    type(stages_type), intent(in) :: stages
    real(wp), intent(in) :: time
    logical, intent(out) :: rests
    real(wp), intent(out) :: part
    rests = .false.
    part = 1
    if (.not. stages%motions%has_begun()) return
    part = maxval(stages%motions%value(stages%motions%second_half(time):))/stages%most_motion
    rests = trim(stages%plan%solid_end) == 'rest' .and. part < stages%plan%rest_part
  end subroutine solid_rests

  !> Takes all speed from the solid; momentum and energy are booked as lost.
  subroutine arrest_solid(solid)
    type(solid_type), intent(inout) :: solid
    integer :: b, set, d, field
    do b = 1, size(solid%block, 2)
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b), books => solid%books(:, b))
          do d = 0, 2
            associate (mass => blk%f(:blk%n, at_mass), v => blk%f(:blk%n, at_velocity + d))
              books(book_lost_momentum + d) = books(book_lost_momentum + d) + sum(mass*v)
              books(book_lost_kinetic) = books(book_lost_kinetic) + 0.5_wp*sum(mass*v**2)
              v = 0
            end associate
          end do
        end associate
      end do
      do field = 1, solid%n_fields
        if (allocated(solid%node(field, b)%a)) solid%node(field, b)%a(:, 2:4, :, :) = 0
      end do
    end do
  end subroutine arrest_solid

  !> All that a restart needs.
  function pack_stages(stages) result(values)
    type(stages_type), intent(in) :: stages
    real(wp), allocatable :: values(:)
    values = [merge(1.0_wp, 0.0_wp, [stages%solid_waits, stages%flow_over, stages%solid_over]), stages%flow_ended, &
              stages%solid_started, stages%solid_ended, stages%load, stages%most_motion]
    values = [values, packed(stages%loads), packed(stages%motions)]
    if (.not. stages%flow_over) return
    associate (flow => stages%last_flow)
      values = [values, real(size(flow%mass), wp), real(size(flow%through_walls), wp), flow%mass, flow%internal, flow%momentum, &
                flow%kinetic, flow%afterburnt, flow%through_walls, reshape(flow%entered, [size(flow%entered)])]
    end associate
  end function pack_stages

  pure function packed(record) result(values)
    type(record_type), intent(in) :: record
    real(wp), allocatable :: values(:)
    if (record%has_begun()) then
      values = [real(size(record%age), wp), record%start, record%age, record%value]
    else
      values = [0.0_wp, 0.0_wp]
    end if
  end function packed

  !> Sets what pack_stages gave.
  subroutine unpack_stages(values, stages)
    real(wp), intent(in) :: values(:)
    type(stages_type), intent(inout) :: stages
    integer :: at, n, m
    stages%solid_waits = values(1) > 0
    stages%flow_over = values(2) > 0
    stages%solid_over = values(3) > 0
    stages%flow_ended = values(4)
    stages%solid_started = values(5)
    stages%solid_ended = values(6)
    stages%load = values(7)
    stages%most_motion = values(8)
    at = 8
    call take_record(stages%loads)
    call take_record(stages%motions)
    if (.not. stages%flow_over) return
    associate (flow => stages%last_flow)
      n = nint(values(at + 1))
      m = nint(values(at + 2))
      at = at + 2
      flow%mass = next(n)
      flow%internal = next(n)
      flow%momentum = next(3)
      flow%kinetic = sum(next(1))
      flow%afterburnt = sum(next(1))
      flow%through_walls = next(m)
      flow%entered = reshape(next(6*m), [m, 6])
    end associate

  contains

    function next(n) result(part)
      integer, intent(in) :: n
      real(wp) :: part(n)
      part = values(at + 1:at + n)
      at = at + n
    end function next

    subroutine take_record(record)
      type(record_type), intent(out) :: record
      real(wp) :: head(2)
      head = next(2)
      if (nint(head(1)) == 0) return
      record%start = head(2)
      record%age = next(nint(head(1)))
      record%value = next(nint(head(1)))
    end subroutine take_record

  end subroutine unpack_stages

end module stages
