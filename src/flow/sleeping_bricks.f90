!> Bricks in one uniform state sleep: they hold no cells of their own and are not advanced.
!>
!> All sleeping bricks of a rank that are in the same state share one block of it, a common state, which whoever reads the flow
!> finds through flow%holder. A common state is advanced like any other, on one cell whose neighbours are like it, so it need not
!> be a state of rest. A brick wakes before the stage in which it would feel a difference: when a ghost differs in one bit from the
!> common state, when a boundary condition or a closed cell would change it, or when one of its neighbour's cells is redone. So the
!> answer has the same bits as without sleep. Bricks that lie wholly inside a solid sleep whatever is around them.
module sleeping_bricks
  use blocks, only: block, allocate_cells, own, row_length, share
  use brick_stage, only: advance_brick, brick_report, prepare_scratch, stage_type
  use flow_boundary, only: fill_boundary
  use flow_layout, only: n_flow_books
  use flow_state, only: flow_type, hold_cells, face_symmetry, face_inflow, face_ambient, most_common_states
  use geometry, only: cell_volumes, x_face_areas
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_INTEGER8, MPI_SUM
  use parallel, only: world
  implicit none
  private
  public :: is_asleep, wake, wake_in_stage, rouse, let_sleep, sleep_if_uniform, start_in_state, share_state, note_closed, &
    advance_common_states, advance_state, book_sleeper, awake_share

contains

  !> True if local brick b holds no cells of its own.
  pure logical function is_asleep(flow, b)
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: b
    is_asleep = flow%w(b, flow%current)%shares > 0
  end function is_asleep

  !> Gives local brick b cells of its own in all buffers, if it has none. To be called before its cells are changed.
  subroutine wake(flow, b)
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b
    integer :: buffer
    do buffer = 1, 3
      call own(flow%w(:, buffer), b)
    end do
  end subroutine wake

  !> Wakes a brick in a stage whose ghosts have been filled. from: buffer that the stage reads.
  subroutine wake_in_stage(mesh, flow, b, from)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b, from
    call wake(flow, b)
    call fill_boundary(mesh, flow, b, from)
  end subroutine wake_in_stage

  !> Finds the bricks that are closed: no cell of theirs, nor one beside them, is open.
  subroutine note_closed(mesh, flow)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer :: b
    do b = 1, mesh%n_local
      flow%closed(b) = .false.
      if (allocated(flow%open(b)%a)) flow%closed(b) = none_open(mesh%brick_cells, mesh%ghost, mesh%active, flow%open(b)%a)
    end do
  end subroutine note_closed

  pure logical function none_open(n, ghost, active, open)
    integer, intent(in) :: n(3), ghost(3)
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: open(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    integer :: d, beside(3)
    do d = 1, 3
      beside = merge(1, 0, [1, 2, 3] == d .and. active)
      none_open = .not. any(open(1 - beside(1):n(1) + beside(1), 1, 1 - beside(2):n(2) + beside(2), &
        1 - beside(3):n(3) + beside(3)) > 0)
      if (.not. none_open) return
    end do
  end function none_open

  !> Wakes the bricks that the next stage would change, so far as that does not come from their neighbours. from: buffer that it
  !> reads.
  subroutine rouse(mesh, flow, stage, from)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: stage
    integer, intent(in) :: from
    real(wp) :: state(flow%layout%n_rows)
    logical :: was_closed
    integer :: b
    do b = 1, mesh%n_local
      if (.not. is_asleep(flow, b)) cycle
      state = flow%w(flow%w(b, from)%shares, from)%a(1, :, 1, 1)
      was_closed = flow%common_closed(flow%w(b, from)%shares - mesh%n_local)
      if (flow%closed(b)) then
        if (.not. was_closed) call share_state(mesh, flow, b, state)
      else if (was_closed .or. .not. sleep_allowed(mesh, flow, stage, b, state)) then
        call wake(flow, b)
      end if
    end do
  end subroutine rouse

  !> Puts those awake to sleep that are in one state, ghosts included. buffer: of the state at the start of the step, that the first
  !> stage reads; only_faces: ghosts beyond edges are not filled.
  subroutine let_sleep(mesh, flow, stage, buffer, only_faces)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: stage
    integer, intent(in) :: buffer
    logical, intent(in) :: only_faces
    real(wp) :: state(flow%layout%n_rows)
    integer :: b, d, low(3), high(3)
    if (.not. flow%sleep) return
    do b = 1, mesh%n_local
      if (is_asleep(flow, b)) cycle
      state = flow%w(b, buffer)%a(1, :, 1, 1)
      if (.not. all_in_state(flow%w(b, buffer), [1, 1, 1], mesh%brick_cells, state)) cycle
      if (.not. flow%closed(b)) then
        if (.not. sleep_allowed(mesh, flow, stage, b, state)) cycle
        associate (brick => mesh%brick(mesh%local(b)))
          low = merge(0, mesh%ghost, brick%at_low)
          high = merge(0, mesh%ghost, brick%at_high)
        end associate
        if (only_faces) then
          do d = 1, 3
            if (.not. all_in_state(flow%w(b, buffer), 1 - merge(low, 0, [1, 2, 3] == d), &
              mesh%brick_cells + merge(high, 0, [1, 2, 3] == d), state)) exit
          end do
          if (d <= 3) cycle
        else if (.not. all_in_state(flow%w(b, buffer), 1 - low, mesh%brick_cells + high, state)) then
          cycle
        end if
      end if
      call share_state(mesh, flow, b, state)
    end do
  end subroutine let_sleep

  !> Puts local brick b to sleep if its cells are in one state; what is around them is left to the next step. For the set-up, which
  !> makes one brick after the other, so that the memory of those that sleep is never needed.
  subroutine sleep_if_uniform(mesh, flow, b)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b
    real(wp) :: state(flow%layout%n_rows)
    if (.not. flow%sleep .or. allocated(flow%arrival(b)%a)) return
    state = flow%w(b, flow%current)%a(1, :, 1, 1)
    if (all_in_state(flow%w(b, flow%current), [1, 1, 1], mesh%brick_cells, state)) call share_state(mesh, flow, b, state)
  end subroutine sleep_if_uniform

  !> Local brick b starts with all its cells in one state, and sleeps if it may. For the set-up.
  subroutine start_in_state(mesh, flow, b, state)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b
    real(wp), intent(in) :: state(:)
    if (flow%sleep .and. .not. allocated(flow%arrival(b)%a)) then
      call share_state(mesh, flow, b, state)
    else
      call hold_state(mesh, flow, b, state)
    end if
  end subroutine start_in_state

  !> True if all cells first..last have the bits of the state.
  pure logical function all_in_state(w, first, last, state)
    type(block), intent(in) :: w
    integer, intent(in) :: first(3), last(3)
    real(wp), intent(in) :: state(:)
    integer :: i, j, k, v
    integer(i8) :: bits
    all_in_state = .false.
    do k = first(3), last(3)
      do j = first(2), last(2)
        do v = 1, size(state)
          bits = transfer(state(v), 0_i8)
          do i = first(1), last(1)
            if (transfer(w%a(i, v, j, k), 0_i8) /= bits) return
          end do
        end do
      end do
    end do
    all_in_state = .true.
  end function all_in_state

  !> True unless local brick b would leave the common state by what happens in it or at the faces of the domain.
  pure logical function sleep_allowed(mesh, flow, stage, b, state)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(stage_type), intent(in) :: stage
    integer, intent(in) :: b
    real(wp), intent(in) :: state(:)
    integer :: d
    sleep_allowed = flow%sleep .and. .not. (flow%kept_awake(b) .or. any(stage%afterburn > 0))
    if (allocated(flow%open(b)%a) .or. allocated(flow%arrival(b)%a)) sleep_allowed = .false.
    associate (brick => mesh%brick(mesh%local(b)))
      do d = 1, 3
        if (.not. mesh%active(d)) cycle
        if (brick%at_low(d)) sleep_allowed = sleep_allowed .and. kept_by(flow%face(1, d))
        if (brick%at_high(d)) sleep_allowed = sleep_allowed .and. kept_by(flow%face(2, d))
      end do
    end associate
  contains
    pure logical function kept_by(face)
      integer, intent(in) :: face
      select case (face)
      case (face_symmetry); kept_by = .not. abs(state(flow%layout%velocity(d))) > 0
      case (face_inflow); kept_by = is_continued_by(flow%inflow)
      case (face_ambient); kept_by = is_continued_by(flow%ambient)
      case default; kept_by = .true.
      end select
    end function kept_by
    !> True if a neighbour like that changes nothing: all that is reconstructed has the same bits. Between equals at rest no flux
    !> depends on the speed of sound, which the first step computes anew, in another order.
    pure logical function is_continued_by(other)
      real(wp), intent(in) :: other(:)
      integer :: n
      n = merge(size(state), flow%layout%n_reconstructed, any(abs(state(flow%layout%velocity(1):flow%layout%velocity(3))) > 0))
      is_continued_by = all(transfer(state(:n), [0_i8]) == transfer(other(:n), [0_i8]))
    end function is_continued_by
  end function sleep_allowed

  !> Local brick b lets go of its cells and shares the common state of these rows. Where there are too many states already it has,
  !> or gets, cells of its own.
  subroutine share_state(mesh, flow, b, state)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b
    real(wp), intent(in) :: state(:)
    integer :: k, place, buffer
    place = 0
    do k = mesh%n_local + 1, mesh%n_local + most_common_states
      if (in_use(mesh, flow, k)) then
        if ((flow%common_closed(k - mesh%n_local) .neqv. flow%closed(b)) .or. &
          .not. all_in_state(flow%w(k, flow%current), [1, 1, 1], [1, 1, 1], state)) cycle
        place = k
        exit
      end if
      if (place == 0) place = k
    end do
    if (place == 0) then
      call wake(flow, b)
      if (allocated(flow%w(b, flow%current)%a)) return
      call hold_state(mesh, flow, b, state)
      return
    end if
    if (.not. in_use(mesh, flow, place)) then
      call hold_state(mesh, flow, place, state)
      flow%common_closed(place - mesh%n_local) = flow%closed(b)
    end if
    do buffer = 1, 3
      call share(flow%w(:, buffer), b, place)
    end do
  end subroutine share_state

  !> Gives local brick or common state b cells of its own, all in one state.
  subroutine hold_state(mesh, flow, b, state)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b
    real(wp), intent(in) :: state(:)
    integer :: buffer
    call hold_cells(flow, mesh, b)
    do buffer = 1, 3
      call fill_state(flow%w(b, buffer), state)
    end do
  end subroutine hold_state

  !> True if a brick shares block k.
  pure logical function in_use(mesh, flow, k)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: k
    in_use = any(flow%w(:mesh%n_local, flow%current)%shares == k)
  end function in_use

  pure subroutine fill_state(w, state)
    type(block), intent(inout) :: w
    real(wp), intent(in) :: state(:)
    integer :: v
    do v = 1, size(state)
      w%a(:, v, :, :) = state(v)
    end do
  end subroutine fill_state

  !> A stage of the common states. flux: through a face across each direction, (quantity, direction, common state). A state that
  !> needs repair, or does not stay the same at all radii, wakes its bricks.
  subroutine advance_common_states(mesh, flow, stage, from, new, flux)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: stage
    integer, intent(in) :: from, new
    real(wp), intent(out) :: flux(:, :, :)
    type(brick_report) :: report
    real(wp), dimension(flow%layout%n_rows) :: state, after
    logical :: is_good
    integer :: k, b, i
    flux = 0
    do k = mesh%n_local + 1, mesh%n_local + most_common_states
      if (.not. allocated(flow%w(k, from)%a)) cycle
      if (.not. in_use(mesh, flow, k)) then
        do i = 1, 3
          deallocate (flow%w(k, i)%a)
        end do
        cycle
      end if
      if (flow%common_closed(k - mesh%n_local)) cycle
      state = flow%w(k, from)%a(1, :, 1, 1)
      call advance_state(mesh, flow, stage, state, flow%w(k, flow%current)%a(1, :, 1, 1), after, report)
      associate (s => flow%common_scratch, q => flow%layout%n_conserved, f => flux(:, :, k - mesh%n_local))
        f(:, 1) = s%flux_x(1, :q)
        f(:, 2) = s%flux_y(1, :q, 0)
        f(:, 3) = s%flux_z(1, :q, 1, 0)
        is_good = report%bad + report%negative_masses + report%clipped_fractions + report%fallbacks == 0
        if (stage%radial) is_good = is_good .and. at_rest(s%flux_x(1, :))
      end associate
      if (is_good) then
        if (.not. all_in_state(flow%w(k, new), [1, 1, 1], [1, 1, 1], after)) call fill_state(flow%w(k, new), after)
      else
        do b = 1, mesh%n_local
          if (flow%w(b, flow%current)%shares == k) call wake_in_stage(mesh, flow, b, from)
        end do
      end if
    end do
  contains
    !> True if nothing crosses a face but the pressure.
    pure logical function at_rest(flux_x)
      real(wp), intent(in) :: flux_x(:)
      integer :: v
      at_rest = .true.
      do v = 1, flow%layout%n_fluxes
        if (v == flow%layout%momentum_flux) then
          at_rest = at_rest .and. .not. abs(flux_x(v) - state(flow%layout%pressure_row)) > 0
        else
          at_rest = at_rest .and. .not. abs(flux_x(v)) > 0
        end if
      end do
    end function at_rest
  end subroutine advance_common_states

  !> A stage of one cell among others like it. from, start, new: its states; the fluxes are left in flow%common_scratch.
  subroutine advance_state(mesh, flow, stage, from, start, new, report)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: stage
    real(wp), intent(in) :: from(:), start(:)
    real(wp), intent(out) :: new(:)
    type(brick_report), intent(out) :: report
    type(block) :: cell(3)
    type(stage_type) :: straight
    real(wp) :: booked(flow%layout%n_conserved, n_flow_books)
    integer :: i, ld
    integer, parameter :: n(3) = 1
    do i = 1, 3
      call allocate_cells(cell(i), n, mesh%ghost, flow%layout%n_rows, 1.0_wp)
    end do
    call fill_state(cell(1), from)
    call fill_state(cell(2), start)
    ld = row_length(n, mesh%ghost)
    call prepare_scratch(flow%common_scratch, flow%layout, n, ld)
    straight = stage
    straight%radial = .false.
    booked = 0
    call advance_brick(n, mesh%ghost, ld, flow%layout, flow%eos, straight, flow%eps2, flow%steepest, flow%positive, &
      spread(.false., 1, 6), [1.0_wp, 1.0_wp], [1.0_wp], cell(1)%a, cell(2)%a, cell(3)%a, booked, flow%common_scratch, report)
    new = cell(3)%a(1, :, 1, 1)
  end subroutine advance_state

  !> Books what a stage brings into sleeping brick b through the faces of the domain, in the order of additions of advance_brick.
  !> flux: of its common state, (quantity, direction).
  subroutine book_sleeper(mesh, stage, b, flux, booked)
    type(mesh_type), intent(in) :: mesh
    type(stage_type), intent(in) :: stage
    integer, intent(in) :: b
    real(wp), intent(in) :: flux(:, :)
    real(wp), intent(inout) :: booked(:, :)
    real(wp) :: weight(3), area(mesh%brick_cells(1) + 1), volume(mesh%brick_cells(1)), ends(2)
    integer :: n(3)
    n = mesh%brick_cells
    weight = stage%weight*stage%dt*product(stage%spacing)/stage%spacing
    associate (brick => mesh%brick(mesh%local(b)))
      if (.not. any(mesh%active .and. (brick%at_low .or. brick%at_high))) return
      volume = cell_volumes(mesh, b)
      ends = weight(1)
      if (stage%radial) then
        area = x_face_areas(mesh, b)
        ends = stage%weight*stage%dt*area([1, n(1) + 1])
      end if
      if (mesh%active(1) .and. brick%at_low(1)) call book(1, n(2)*n(3), ends(1)*flux(:, 1))
      if (mesh%active(1) .and. brick%at_high(1)) call book(2, n(2)*n(3), -(ends(2)*flux(:, 1)))
      if (mesh%active(2) .and. brick%at_low(2)) call book(3, n(3), weight(2)*sum_of_row(flux(:, 2)))
      if (mesh%active(2) .and. brick%at_high(2)) call book(4, n(3), -weight(2)*sum_of_row(flux(:, 2)))
      if (mesh%active(3) .and. brick%at_low(3)) call book(5, n(2), weight(3)*sum_of_row(flux(:, 3)))
      if (mesh%active(3) .and. brick%at_high(3)) call book(6, n(2), -weight(3)*sum_of_row(flux(:, 3)))
    end associate
  contains
    !> Sums of the same fluxes over a row of cells.
    pure function sum_of_row(flux) result(total)
      real(wp), intent(in) :: flux(:)
      real(wp) :: total(size(flux)), row(n(1))
      integer :: q
      do q = 1, size(flux)
        row = flux(q)
        if (stage%radial) then
          total(q) = sum(row*volume)/product(stage%spacing)
        else
          total(q) = sum(row)
        end if
      end do
    end function sum_of_row
    subroutine book(face, times, what)
      integer, intent(in) :: face, times
      real(wp), intent(in) :: what(:)
      integer :: i
      do i = 1, times
        booked(:size(what), face) = booked(:size(what), face) + what
      end do
    end subroutine book
  end subroutine book_sleeper

  !> Share of the bricks that were advanced, a mean over the stages of this run so far; 1 before the first. All ranks take part.
  real(wp) function awake_share(flow)
    type(flow_type), intent(in) :: flow
    integer(i8) :: everyone(2)
    call MPI_Allreduce([flow%advanced_bricks, flow%all_bricks], everyone, 2, MPI_INTEGER8, MPI_SUM, world)
    awake_share = 1
    if (everyone(2) > 0) awake_share = real(everyone(1), wp)/real(everyone(2), wp)
  end function awake_share

end module sleeping_bricks
