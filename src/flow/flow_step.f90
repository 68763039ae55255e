!> One time step of the flow: three stages of the strong-stability-preserving Runge-Kutta scheme of Shu and Osher.
!> The coupling may change velocities in the buffer that a stage wrote: the next stage starts from what it finds there.
module flow_step
  use afterburn, only: released_in_step
  use blocks, only: block, row_length
  use brick_stage, only: advance_brick, prepare_scratch, stage_type, brick_report
  use flow_boundary, only: fill_boundary
  use flow_repair, only: repair_brick, count_repair, mark_troubled, none_troubled, troubled_around
  use flow_state, only: flow_type, most_common_states, repair_negative_mass, repair_clipped_fraction, repair_relaxation
  use geometry, only: cell_volumes, x_face_areas
  use halo, only: halo_type, fill
  use kinds, only: wp
  use mesh, only: mesh_type
  use reductions, only: any_rank
  use sleeping_bricks, only: is_asleep, wake, wake_in_stage, let_sleep, rouse, note_closed, advance_common_states, &
    advance_state, book_sleeper
  implicit none
  private
  public :: advance_stage, accept_step, fill_ghosts, settled_state

  real(wp), parameter :: part(3) = [1.0_wp, 0.25_wp, 2.0_wp/3.0_wp] !< new = start + part (from - start - d)
  real(wp), parameter, public :: stage_weight(3) = [1.0_wp/6.0_wp, 1.0_wp/6.0_wp, 2.0_wp/3.0_wp] !< of a stage's fluxes in the step
  real(wp), parameter :: stage_time(0:3) = [0.0_wp, 1.0_wp, 0.5_wp, 1.0_wp] !< of the state that a stage makes, in steps
  integer, parameter :: most_attempts = 4 !< at a stage that leaves troubled cells

  !> What a stage has added to before it turns out that it must be redone.
  type :: books_type
    real(wp), allocatable :: entered(:, :, :)
    type(block), allocatable :: wall_impulse(:)
  end type books_type

contains

  !> Stage 1, 2 or 3 of a step of length dt on all bricks of this rank that are awake. Cells that get a negative mass, pressure or
  !> square of the sound speed are troubled: the stage is redone in their bricks with first-order fluxes at all their faces, on both
  !> sides alike, so nothing is lost. What is still bad after that is repaired.
  subroutine advance_stage(mesh, halo, flow, stage, dt)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: stage
    real(wp), intent(in) :: dt
    type(stage_type) :: plan
    type(books_type) :: books
    type(brick_report) :: report(mesh%n_local)
    real(wp) :: flux(flow%layout%n_conserved, 3, most_common_states)
    logical :: is_new
    integer :: b, from, attempt
    from = flow%current
    if (stage > 1) from = flow%target(stage - 1)
    plan = stage_plan(mesh, flow, stage, dt)
    if (stage == 1) call note_closed(mesh, flow)
    call rouse(mesh, flow, plan, from)
    call fill_ghosts(mesh, halo, flow, from)
    if (stage == 1) call let_sleep(mesh, flow, plan, from, only_faces(flow))
    call prepare_scratch(flow%scratch, flow%layout, mesh%brick_cells, row_length(mesh%brick_cells, mesh%ghost))
    call keep_books(flow, books)
    call advance_common_states(mesh, flow, plan, from, flow%target(stage), flux)
    do b = 1, mesh%n_local
      if (flow%closed(b)) then
        if (.not. is_asleep(flow, b)) flow%w(b, flow%target(stage))%a = flow%w(b, from)%a
      else if (is_asleep(flow, b)) then
        call book_sleeper(mesh, plan, b, flux(:, :, flow%w(b, from)%shares - mesh%n_local), flow%books(:, :, b))
      else
        call advance_one(mesh, flow, plan, b, from, flow%current, flow%target(stage), report(b))
        flow%advanced_bricks = flow%advanced_bricks + 1
      end if
    end do
    flow%all_bricks = flow%all_bricks + mesh%n_local
    do attempt = 1, most_attempts
      if (.not. any_rank(any(report%bad + report%negative_masses > 0))) exit
      call mark_troubled(mesh, halo, flow, flow%target(stage), report%bad + report%negative_masses > 0, is_new)
      if (.not. any_rank(is_new)) exit
      do b = 1, mesh%n_local
        if (flow%closed(b) .or. .not. troubled_around(flow%troubled(b))) cycle
        if (is_asleep(flow, b)) call wake_in_stage(mesh, flow, b, from)
        flow%books(:, :, b) = books%entered(:, :, b)
        if (allocated(books%wall_impulse(b)%a)) flow%wall_impulse(b)%a = books%wall_impulse(b)%a
        call advance_one(mesh, flow, plan, b, from, flow%current, flow%target(stage), report(b))
      end do
    end do
    call none_troubled(flow)
    do b = 1, mesh%n_local
      call count_repair(mesh, flow, repair_negative_mass, report(b)%negative_masses, b, report(b)%repaired)
      call count_repair(mesh, flow, repair_clipped_fraction, report(b)%clipped_fractions, b, report(b)%repaired)
      call count_repair(mesh, flow, repair_relaxation, report(b)%fallbacks, b, report(b)%repaired)
      if (report(b)%bad > 0) call repair_brick(mesh, flow, b, flow%target(stage))
    end do
  end subroutine advance_stage

  !> The target of the third stage becomes the state.
  subroutine accept_step(flow)
    type(flow_type), intent(inout) :: flow
    flow%current = flow%target(3)
  end subroutine accept_step

  !> Ghost cells of one buffer, from neighbours and from the boundary conditions. Sleeping bricks whose ghosts would differ from
  !> their cells wake.
  subroutine fill_ghosts(mesh, halo, flow, buffer)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: buffer
    integer :: b
    call fill(mesh, halo, flow%w(:, buffer), flow%layout%n_rows, only_faces(flow), flow%closed)
    do b = 1, mesh%n_local
      if (flow%w(b, buffer)%shares > 0) cycle
      call wake(flow, b)
      call fill_boundary(mesh, flow, b, buffer)
    end do
  end subroutine fill_ghosts

  !> True if no ghosts beyond the edges of bricks are needed: what looks across the direction of a sweep needs them.
  pure logical function only_faces(flow)
    type(flow_type), intent(in) :: flow
    only_faces = .not. (flow%scheme%cure_shocks .or. (flow%scheme%sharpen .and. flow%n_materials > 1))
  end function only_faces

  !> The state that a cell among others like it comes to: its last bits are those that the scheme gives it.
  function settled_state(mesh, flow, state) result(settled)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    real(wp), intent(in) :: state(:)
    real(wp), dimension(size(state)) :: settled, start, from
    type(stage_type) :: plan
    type(brick_report) :: report
    logical :: changes
    integer :: turn, stage
    integer, parameter :: most_turns = 10
    real(wp), parameter :: slight = 1e-7_wp !< as the closing of a mixture with traces may change; more is left to the first step
    settled = state
    do turn = 1, most_turns
      start = settled
      changes = .false.
      do stage = 1, 3
        plan = stage_plan(mesh, flow, stage, 1.0_wp)
        plan%gravity = 0
        plan%afterburn = 0
        from = settled
        call advance_state(mesh, flow, plan, from, start, settled, report)
        changes = changes .or. any(abs(settled - start) > 0)
      end do
      if (.not. changes) exit
    end do
    if (any(abs(settled - state) > slight*abs(state))) settled = state
  end function settled_state

  !> What all bricks need to know of a stage.
  function stage_plan(mesh, flow, stage, dt) result(plan)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: stage
    real(wp), intent(in) :: dt
    type(stage_type) :: plan
    plan%first = stage == 1
    plan%part = part(stage)
    plan%weight = stage_weight(stage)
    plan%dt = dt
    plan%time = flow%time + [0.0_wp, dt*stage_time(stage - 1), dt*stage_time(stage)]
    plan%spacing = mesh%spacing
    plan%active = mesh%active
    plan%radial = mesh%radial_power > 0
    plan%scheme = flow%scheme
    ! not in several directions, where the steps of a coarse charge would become jets along the mesh; and what has not burnt has too
    ! little heat to expand
    plan%fans = flow%scheme%cure_shocks .and. count(mesh%active) == 1 &
      .and. .not. (flow%burn_speed > 0 .and. flow%time <= flow%burn_end)
    plan%trace = flow%trace_fraction
    plan%floor_pressure = flow%floor_pressure
    plan%lowest = flow%lowest_pressure()
    plan%gravity = flow%gravity
    plan%slip = flow%slip
    plan%burn_energy = flow%burn_energy
    plan%burn_rate = flow%burn_rate
    plan%afterburn = released_in_step(flow%afterburn, flow%time, dt)
  end function stage_plan

  subroutine keep_books(flow, books)
    type(flow_type), intent(in) :: flow
    type(books_type), intent(out) :: books
    books%entered = flow%books
    books%wall_impulse = flow%wall_impulse
  end subroutine keep_books

  subroutine advance_one(mesh, flow, plan, b, from, start, new, report)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: plan
    integer, intent(in) :: b, from, start, new
    type(brick_report), intent(out) :: report
    logical :: at_face(6)
    at_face(1::2) = mesh%brick(mesh%local(b))%at_low .and. mesh%active
    at_face(2::2) = mesh%brick(mesh%local(b))%at_high .and. mesh%active
    ! what is not allocated counts as absent
    call advance_brick(mesh%brick_cells, mesh%ghost, size(flow%w(b, 1)%a, 1), flow%layout, flow%eos, plan, flow%eps2, &
      flow%steepest, flow%positive, at_face, x_face_areas(mesh, b), cell_volumes(mesh, b), flow%w(b, from)%a, &
      flow%w(b, start)%a, flow%w(b, new)%a, flow%books(:, :, b), flow%scratch, report, flow%open(b)%a, flow%wall_impulse(b)%a, &
      flow%troubled(b)%a, flow%arrival(b)%a, flow%wall(b)%a)
  end subroutine advance_one

end module flow_step
