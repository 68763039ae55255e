!> A test problem of the flow as one entry of a table: what is where at the start, until when it runs, what the answer is, and how
!> far from it a run may end. The entries stand in flow_suite and the modules that it lists; flow_problem_run runs them.
module flow_problem
  use equation_of_state, only: eos_type
  use flow_filling, only: trace_density
  use flow_scenes, only: flow_scene
  use flow_state, only: face_outflow, n_repairs
  use kinds, only: wp, i8
  implicit none
  private
  public :: add_problem, fill_region, bound, note_measure, measured

  real(wp), parameter, public :: trace_fraction = 1e-8_wp !< of a material where it is not

  !> A uniform state of one material; the other materials are there as traces.
  type, public :: region_type
    integer :: material = 1
    real(wp) :: density = 1, velocity(3) = 0, pressure = 1
  end type region_type

  !> What is measured of a run and the most it may be.
  type, public :: measure_type
    character(24) :: name = ''
    real(wp) :: value = huge(1.0_wp)
    real(wp) :: bound = huge(1.0_wp) !< huge: only reported
  end type measure_type

  !> One entry. Only what differs from the defaults need be given.
  type, public :: problem_type
    character(32) :: name = ''
    character(120) :: title = ''
    type(eos_type), allocatable :: eos(:) !< of the materials
    type(region_type), allocatable :: region(:) !< uniform states that start makes use of; one at least for each material
    integer :: cells(3) = [100, 1, 1] !< where the bounds hold; at another resolution n they are scaled to n along x
    integer, allocatable :: resolutions(:) !< cells along x of the accuracy study; none: not a part of it
    real(wp) :: lower(3) = 0, upper(3) = 1
    integer :: faces(2, 3) = face_outflow
    real(wp) :: place = 0.5_wp !< of the jump along x, where there is one
    real(wp) :: end_time = 0
    real(wp) :: spacing(3) = 1 !< of the cells, set when the scene is made
    logical :: is_hard = .false. !< a part of the stability study
    logical :: is_long = .false. !< a minute or more
    procedure(start_procedure), pointer, nopass :: start => null()
    procedure(exact_procedure), pointer, nopass :: exact => null() !< if the solution is known
    integer :: fine_cells = 0 !< of a run along x that stands for the solution where that is not known
    real(wp) :: window(3, 2) = reshape([-1, -1, -1, 1, 1, 1]*huge(1.0_wp), [3, 2]) !< corners of where errors count
    procedure(measure_procedure), pointer, nopass :: measure => null() !< further measures
    type(measure_type), allocatable :: bound(:) !< name and bound of what must not be more
  end type problem_type

  !> What became of a run.
  type, public :: outcome_type
    character(32) :: name = '', scheme = ''
    integer :: cells(3) = 1, steps = 0
    real(wp) :: cfl = 0
    logical :: finished = .false., positive = .false.
    character(:), allocatable :: message !< why it did not finish
    real(wp) :: wall = 0 !< seconds of the steps
    real(wp) :: nanoseconds = 0 !< per cell and stage
    integer(i8) :: repairs(n_repairs) = 0
    type(measure_type), allocatable :: measure(:)
  contains
    procedure :: passes
    procedure :: failures
  end type outcome_type

  abstract interface
    !> Phase densities, fractions, velocity and pressure at a point, as in flow_scenes.
    subroutine start_procedure(problem, x, r, a, u, p)
      import :: problem_type, wp
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: x(3)
      real(wp), intent(out) :: r(:), a(:), u(3), p
    end subroutine start_procedure

    !> Density, velocity and pressure (5) of the solution at time t at points x(3, :).
    subroutine exact_procedure(problem, t, x, state)
      import :: problem_type, wp
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: t, x(:, :)
      real(wp), intent(out) :: state(:, :)
    end subroutine exact_procedure

    !> Notes further measures of a scene that ran to the end.
    subroutine measure_procedure(problem, scene, outcome)
      import :: problem_type, flow_scene, outcome_type
      type(problem_type), intent(in) :: problem
      type(flow_scene), intent(in) :: scene
      type(outcome_type), intent(inout) :: outcome
    end subroutine measure_procedure
  end interface
  public :: start_procedure, exact_procedure, measure_procedure

contains

  !> Appends an entry to a table.
  subroutine add_problem(list, problem)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type), intent(in) :: problem
    type(problem_type), allocatable :: longer(:)
    integer :: i, n
    n = 0
    if (allocated(list)) n = size(list)
    allocate (longer(n + 1))
    do i = 1, n
      longer(i) = list(i)
    end do
    longer(n + 1) = problem
    if (.not. allocated(longer(n + 1)%resolutions)) allocate (longer(n + 1)%resolutions(0))
    if (.not. allocated(longer(n + 1)%bound)) allocate (longer(n + 1)%bound(0))
    call move_alloc(longer, list)
  end subroutine add_problem

  !> A bound for an entry.
  pure function bound(name, largest)
    character(*), intent(in) :: name
    real(wp), intent(in) :: largest
    type(measure_type) :: bound
    bound = measure_type(name, huge(1.0_wp), largest)
  end function bound

  !> State of region i; every other material is there as a trace, on the isentrope through its own region.
  subroutine fill_region(problem, i, r, a, u, p)
    type(problem_type), intent(in) :: problem
    integer, intent(in) :: i
    real(wp), intent(out) :: r(:), a(:), u(3), p
    integer :: k, home
    associate (region => problem%region)
      p = region(i)%pressure
      u = region(i)%velocity
      a = trace_fraction
      a(region(i)%material) = 1 - trace_fraction*(size(a) - 1)
      do k = 1, size(r)
        if (k == region(i)%material) then
          r(k) = region(i)%density
        else
          home = findloc(region%material, k, dim=1)
          r(k) = trace_density(problem%eos(k), region(home)%density, region(home)%pressure, p)
        end if
      end do
    end associate
  end subroutine fill_region

  !> Notes a measure of a run, with its bound if the problem has one for it and the run is at the problem's own resolution.
  subroutine note_measure(problem, outcome, name, value)
    type(problem_type), intent(in) :: problem
    type(outcome_type), intent(inout) :: outcome
    character(*), intent(in) :: name
    real(wp), intent(in) :: value
    type(measure_type) :: new
    integer :: i
    new%name = name
    new%value = value
    i = findloc(problem%bound%name == new%name, .true., dim=1)
    if (i > 0 .and. outcome%cells(1) == problem%cells(1)) new%bound = problem%bound(i)%bound
    outcome%measure = [outcome%measure, new]
  end subroutine note_measure

  !> A measure of a run; huge if it was not taken.
  pure real(wp) function measured(outcome, name)
    type(outcome_type), intent(in) :: outcome
    character(*), intent(in) :: name
    integer :: i
    measured = huge(1.0_wp)
    do i = 1, size(outcome%measure)
      if (outcome%measure(i)%name == name) measured = outcome%measure(i)%value
    end do
  end function measured

  !> Whether the run finished, stayed positive and kept all bounds.
  logical function passes(self)
    class(outcome_type), intent(in) :: self
    passes = len(self%failures()) == 0
  end function passes

  !> What is wrong with the run, in words; empty if nothing.
  function failures(self) result(text)
    class(outcome_type), intent(in) :: self
    character(:), allocatable :: text
    character(80) :: line
    integer :: i
    text = ''
    if (.not. self%finished) then
      text = 'not finished: '//self%message
      return
    end if
    if (.not. self%positive) text = 'not positive; '
    do i = 1, size(self%measure)
      associate (m => self%measure(i))
        if (m%value <= m%bound) cycle
        write (line, '(2a,es9.2,a,es9.2)') trim(m%name), ' ', m%value, ' >', m%bound
        text = text//trim(line)//'; '
      end associate
    end do
  end function failures

end module flow_problem
