!> A stopwatch with named phases, so that the wall time of a run can be told by what it was spent on.
module timers
  use kinds, only: wp, i8
  implicit none
  private

  integer, parameter, public :: phase_name_length = 32

  !> Phases are made by their first start. They may be nested: each counts all the time between its start and its stop.
  type, public :: stopwatch
    private
    integer :: n = 0 !< number of phases
    character(phase_name_length), allocatable :: name(:)
    integer(i8), allocatable :: ticks(:) !< collected in finished intervals
    integer(i8), allocatable :: began(:) !< clock at the start of the open interval
    integer(i8), allocatable :: intervals(:) !< number of finished intervals
    logical, allocatable :: running(:)
  contains
    procedure, public :: start
    procedure, public :: stop => stop_phase
    procedure, public :: seconds
    procedure, public :: count => interval_count
    procedure, public :: list
    procedure, public :: reset
  end type stopwatch

contains

  !> Starts a phase; one that runs already goes on.
  subroutine start(self, name)
    class(stopwatch), intent(inout) :: self
    character(*), intent(in) :: name
    integer :: phase
    phase = find(self, name)
    if (phase == 0) then
      call add_phase(self, name)
      phase = self%n
    end if
    if (self%running(phase)) return
    self%running(phase) = .true.
    call system_clock(self%began(phase))
  end subroutine start

  !> Stops a phase and adds the interval to it; one that does not run is left alone.
  subroutine stop_phase(self, name)
    class(stopwatch), intent(inout) :: self
    character(*), intent(in) :: name
    integer(i8) :: now
    integer :: phase
    call system_clock(now)
    phase = find(self, name)
    if (phase == 0) return
    if (.not. self%running(phase)) return
    self%running(phase) = .false.
    self%ticks(phase) = self%ticks(phase) + now - self%began(phase)
    self%intervals(phase) = self%intervals(phase) + 1
  end subroutine stop_phase

  !> Wall time spent in a phase so far (s), with that of the open interval; 0 for a phase never started.
  real(wp) function seconds(self, name)
    class(stopwatch), intent(in) :: self
    character(*), intent(in) :: name
    integer(i8) :: now, ticks, clock_rate
    integer :: phase
    seconds = 0
    phase = find(self, name)
    if (phase == 0) return
    call system_clock(now, clock_rate)
    ticks = self%ticks(phase)
    if (self%running(phase)) ticks = ticks + now - self%began(phase)
    seconds = real(ticks, wp)/real(clock_rate, wp)
  end function seconds

  !> Number of finished intervals of a phase.
  integer(i8) function interval_count(self, name)
    class(stopwatch), intent(in) :: self
    character(*), intent(in) :: name
    integer :: phase
    phase = find(self, name)
    interval_count = 0
    if (phase > 0) interval_count = self%intervals(phase)
  end function interval_count

  !> Names of all phases, in the order of their first start.
  function list(self) result(names)
    class(stopwatch), intent(in) :: self
    character(phase_name_length), allocatable :: names(:)
    allocate (names(self%n))
    if (self%n > 0) names = self%name(1:self%n)
  end function list

  !> Forgets everything.
  subroutine reset(self)
    class(stopwatch), intent(inout) :: self
    self%n = 0
    if (allocated(self%name)) deallocate (self%name, self%ticks, self%began, self%intervals, self%running)
  end subroutine reset

  !> Number of a phase, 0 if there is none of that name.
  pure integer function find(self, name)
    class(stopwatch), intent(in) :: self
    character(*), intent(in) :: name
    character(phase_name_length) :: wanted
    wanted = name
    do find = self%n, 1, -1
      if (self%name(find) == wanted) return
    end do
  end function find

  subroutine add_phase(self, name)
    class(stopwatch), intent(inout) :: self
    character(*), intent(in) :: name
    character(phase_name_length) :: padded
    padded = name
    if (.not. allocated(self%name)) then
      allocate (self%name(0), self%ticks(0), self%began(0), self%intervals(0), self%running(0))
    end if
    self%name = [character(phase_name_length) :: self%name(1:self%n), padded]
    self%ticks = [self%ticks, 0_i8]
    self%began = [self%began, 0_i8]
    self%intervals = [self%intervals, 0_i8]
    self%running = [self%running, .false.]
    self%n = self%n + 1
  end subroutine add_phase

end module timers
