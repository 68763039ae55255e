!> Runs a test problem of the flow and measures it: errors against the exact solution or a fine run, balances of mass and energy,
!> positivity and repairs. A state that cannot be repaired ends the run, not the program.
module flow_problem_run
  use errors, only: fatal_handler, on_fatal
  use flow_problem, only: problem_type, outcome_type, note_measure
  use flow_profiles, only: profile_type, profile_of, all_positive, coarse_profile
  use flow_scenes, only: flow_scene, make_scene, run_step
  use flow_scheme, only: scheme_type, muscl, venkatakrishnan
  use flow_state, only: face_outflow
  use flow_time_step, only: flow_limit, flow_limit_type
  use flow_totals, only: flow_totals_type, sum_flow
  use kinds, only: wp, i8
  implicit none
  private
  public :: run_problem, open_problem

  type(scheme_type), parameter, public :: paper_scheme = scheme_type(muscl, venkatakrishnan, .false., .false.)
  integer, parameter :: most_steps = 1000000
  integer, parameter :: best_brick(3) = [4096, 64, 32] !< cells along each direction that fit the caches, by dimensions
  logical :: failed = .false.
  character(:), allocatable :: failure

  type(problem_type) :: opened !< what turned_start fills a scene with; not host-associated: that would need an executable stack
  integer :: turn = 0 !< directions that its x is turned by

  !> The last fine run: it serves all schemes and resolutions of a problem.
  character(32) :: fine_name = ''
  type(profile_type) :: fine

contains

  !> Runs a problem with n cells along x (its own number if 0) and notes all measures. along: the direction of the mesh that the
  !> problem's x points to.
  subroutine run_problem(problem, n, cfl, scheme, scheme_name, outcome, along, scene)
    type(problem_type), intent(in) :: problem
    integer, intent(in) :: n
    real(wp), intent(in) :: cfl
    type(scheme_type), intent(in) :: scheme
    character(*), intent(in) :: scheme_name
    type(outcome_type), intent(out) :: outcome
    integer, intent(in), optional :: along
    type(flow_scene), intent(out), optional, target :: scene
    type(flow_scene), target :: own
    if (present(scene)) then
      call run_in(scene)
    else
      call run_in(own)
    end if

  contains

    subroutine run_in(scene)
      type(flow_scene), intent(inout) :: scene
      type(flow_totals_type) :: before
      integer(i8) :: began, ended, rate
      outcome%name = problem%name
      outcome%scheme = scheme_name
      outcome%cfl = cfl
      allocate (outcome%measure(0))
      call open_problem(problem, n, scheme, scene, along)
      outcome%cells = cells_of(problem, n)
      scene%flow%cfl = cfl
      before = sum_flow(scene%mesh, scene%flow)
      call system_clock(began, rate)
      call advance(scene, problem%end_time, outcome%finished, outcome%message)
      call system_clock(ended)
      outcome%wall = real(ended - began, wp)/real(rate, wp)
      outcome%steps = scene%steps
      outcome%repairs = scene%flow%repairs%count
      outcome%nanoseconds = 1e9_wp*outcome%wall/(3.0_wp*max(1, scene%steps)*product(real(scene%mesh%cells, wp)))
      if (.not. outcome%finished) return
      outcome%positive = all_positive(scene)
      call note_balances(problem, scene, before, outcome)
      call note_errors(problem, scene, scheme, along, outcome)
      if (associated(problem%measure)) call problem%measure(problem, scene, outcome)
      call note_missing(problem, outcome)
    end subroutine run_in

  end subroutine run_problem

  !> The scene at its start.
  subroutine open_problem(problem, n, scheme, scene, along, brick)
    type(problem_type), intent(in) :: problem
    integer, intent(in) :: n
    type(scheme_type), intent(in) :: scheme
    type(flow_scene), intent(out) :: scene
    integer, intent(in), optional :: along, brick(3)
    integer :: cells(3), bricks(3)
    turn = 0
    if (present(along)) turn = along - 1
    opened = problem
    cells = cells_of(problem, n)
    opened%spacing = (problem%upper - problem%lower)/cells
    bricks = divisor(cells, best_brick(max(1, count(cells > 1))))
    if (present(brick)) bricks = brick
    call make_scene(scene, problem%eos, cshift(cells, -turn), cshift(problem%lower, -turn), cshift(problem%upper, -turn), &
      cshift(bricks, -turn), face_outflow, turned_start, cshift(problem%faces, -turn, 2), scheme)
  end subroutine open_problem

  !> The start of the problem that is being opened, its x along a direction of the mesh.
  subroutine turned_start(x, r, a, u, p)
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call opened%start(opened, cshift(x, turn), r, a, u, p)
    u = cshift(u, -turn)
  end subroutine turned_start

  !> Cells of the problem with n along x.
  pure function cells_of(problem, n) result(cells)
    type(problem_type), intent(in) :: problem
    integer, intent(in) :: n
    integer :: cells(3)
    cells = problem%cells
    if (n > 0) cells = max(1, merge(problem%cells*n/problem%cells(1), 1, problem%cells > 1))
  end function cells_of

  !> The largest divisor of n that is not above a limit.
  elemental integer function divisor(n, limit)
    integer, intent(in) :: n, limit
    do divisor = min(n, limit), 2, -1
      if (mod(n, divisor) == 0) return
    end do
    divisor = 1
  end function divisor

  !> Steps to the end time, or until there is no valid state.
  subroutine advance(scene, end_time, finished, message)
    type(flow_scene), intent(inout) :: scene
    real(wp), intent(in) :: end_time
    logical, intent(out) :: finished
    character(:), allocatable, intent(out) :: message
    procedure(fatal_handler), pointer :: before
    type(flow_limit_type) :: limit
    before => on_fatal
    on_fatal => note_failure
    failed = .false.
    failure = ''
    do while (scene%time < end_time*(1 - 1e-12_wp))
      limit = flow_limit(scene%mesh, scene%flow)
      if (.not. (limit%dt > 0 .and. limit%dt < huge(1.0_wp))) call note_failure('no time step', 3)
      if (scene%steps > most_steps) call note_failure('too many steps', 3)
      if (.not. failed) call run_step(scene, min(limit%dt, end_time - scene%time))
      if (failed) exit
    end do
    on_fatal => before
    finished = .not. failed
    message = failure
  end subroutine advance

  subroutine note_failure(message, status)
    character(*), intent(in) :: message
    integer, intent(in) :: status
    if (failed) return
    failed = status >= 0
    failure = message(:index(message//new_line('a'), new_line('a')) - 1)
  end subroutine note_failure

  !> What was lost or gained of mass (the worst material) and energy beside what entered, relative to all there was.
  subroutine note_balances(problem, scene, before, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(flow_totals_type), intent(in) :: before
    type(outcome_type), intent(inout) :: outcome
    type(flow_totals_type) :: after
    real(wp) :: turnover
    integer :: n
    n = size(problem%eos)
    after = sum_flow(scene%mesh, scene%flow)
    call note_measure(problem, outcome, 'mass balance', &
      maxval(abs(after%mass - sum(after%entered(:n, :), 2) - before%mass))/sum(before%mass))
    turnover = before%kinetic + sum(abs(before%internal)) + sum(abs(after%entered(n + 4, :)))
    call note_measure(problem, outcome, 'energy balance', abs(after%kinetic + sum(after%internal) - sum(after%entered(n + 4, :)) &
      - before%kinetic - sum(before%internal))/turnover)
  end subroutine note_balances

  !> Relative errors sum|e|/sum|exact| and the mean error of density, in the window of the problem.
  subroutine note_errors(problem, scene, scheme, along, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(scheme_type), intent(in) :: scheme
    integer, intent(in), optional :: along
    type(outcome_type), intent(inout) :: outcome
    type(profile_type) :: found
    real(wp), allocatable :: exact(:, :)
    logical, allocatable :: counts(:)
    integer :: i
    found = profile_of(scene, along)
    allocate (exact(5, size(found%x, 2)), counts(size(found%x, 2)))
    if (associated(problem%exact)) then
      call problem%exact(problem, scene%time, found%x, exact)
    else if (problem%fine_cells > outcome%cells(1)) then
      call run_fine(problem, scheme)
      exact = coarse_profile(fine, size(found%x, 2))
    else
      return
    end if
    do i = 1, size(counts)
      counts(i) = all(found%x(:, i) >= problem%window(:, 1) .and. found%x(:, i) <= problem%window(:, 2))
    end do
    call note('density', 1, 1)
    call note('velocity', 2, 4)
    call note('pressure', 5, 5)
    call note_measure(problem, outcome, 'mean density', sum(abs(found%state(1, :) - exact(1, :)), counts)/count(counts))

  contains

    !> Without a scale where the solution is nil.
    subroutine note(name, first, last)
      character(*), intent(in) :: name
      integer, intent(in) :: first, last
      real(wp) :: scale, error
      integer :: q
      scale = 0
      error = 0
      do q = first, last
        scale = scale + sum(abs(exact(q, :)), counts)
        error = error + sum(abs(found%state(q, :) - exact(q, :)), counts)
      end do
      if (scale > tiny(1.0_wp)) error = error/scale
      call note_measure(problem, outcome, name, error)
    end subroutine note

  end subroutine note_errors

  !> The fine run of the problem, if it is not the last one made. With the scheme asked for: all have the same limit.
  subroutine run_fine(problem, scheme)
    type(problem_type), intent(in) :: problem
    type(scheme_type), intent(in) :: scheme
    type(flow_scene) :: scene
    character(:), allocatable :: message
    logical :: finished
    if (fine_name == problem%name) return
    call open_problem(problem, problem%fine_cells, scheme, scene)
    scene%flow%cfl = 0.5_wp
    call advance(scene, problem%end_time, finished, message)
    fine = profile_of(scene)
    fine_name = problem%name
  end subroutine run_fine

  !> A bound whose measure could not be taken is not kept.
  subroutine note_missing(problem, outcome)
    type(problem_type), intent(in) :: problem
    type(outcome_type), intent(inout) :: outcome
    integer :: i
    do i = 1, size(problem%bound)
      if (.not. any(outcome%measure%name == problem%bound(i)%name)) &
        call note_measure(problem, outcome, trim(problem%bound(i)%name), huge(1.0_wp))
    end do
  end subroutine note_missing

end module flow_problem_run
