!> The line that a run prints at each report: how far it is, what sets its time step, whether its books still balance.
module report
  use kinds, only: wp, i8
  use mpi_f08, only: MPI_Allreduce, MPI_INTEGER8, MPI_SUM
  use parallel, only: world
  use text, only: str
  implicit none
  private
  public :: report_figures, report_pace, start_pace, report_line, peak_memory, duration_text, memory_text

  !> What a line tells. Drifts are relative to what the books started with.
  type :: report_figures
    integer :: step = 0
    real(wp) :: time = 0 !< present
    real(wp) :: end_time = 1
    integer :: max_steps = huge(1) !< step at which the run ends if the time has not
    real(wp) :: dt = 0
    character(:), allocatable :: time_unit
    character(:), allocatable :: limiter !< what set dt: 'flow, air at (0.1, 0, 0.2)', 'solid, concrete at ...', 'end'
    real(wp) :: mass_drift = 0, momentum_drift = 0, energy_drift = 0
    integer(i8) :: repairs = 0 !< floors and limited states since the start
    integer(i8) :: memory = 0 !< peak memory of all ranks, bytes
    real(wp) :: awake = 1 !< mean share of the bricks of the flow that were advanced
    real(wp) :: cells = 0 !< cells (and particles) advanced per step
    real(wp) :: wall = 0 !< seconds since the start of this run
  end type report_figures

  !> How fast the run went at the last report, for the time that is left.
  type :: report_pace
    real(wp) :: time = 0, wall = 0 !< at the last report
    integer :: step = 0
    real(wp) :: time_per_second = 0 !< simulated time per second of wall time, smoothed
    real(wp) :: steps_per_second = 0
    real(wp) :: start_time = 0 !< simulated time at which the run began (not that of the restart)
  end type report_pace

contains

  !> start_time: of the scene, for the per cent; time, step: where this run begins (after a restart, not the same).
  subroutine start_pace(pace, start_time, time, step)
    type(report_pace), intent(out) :: pace
    real(wp), intent(in) :: start_time, time
    integer, intent(in) :: step
    pace%start_time = start_time
    pace%time = time
    pace%step = step
  end subroutine start_pace

  !> The line for these figures; the pace is brought up to date.
  function report_line(figures, pace) result(line)
    type(report_figures), intent(in) :: figures
    type(report_pace), intent(inout) :: pace
    character(:), allocatable :: line
    real(wp) :: fraction, left, speed
    character(8) :: percent
    call update_pace(figures, pace)
    fraction = (figures%time - pace%start_time)/max(figures%end_time - pace%start_time, tiny(1.0_wp))
    left = -1
    if (pace%time_per_second > 0) left = (figures%end_time - figures%time)/pace%time_per_second
    if (figures%max_steps < huge(1) .and. pace%steps_per_second > 0) then
      fraction = max(fraction, real(figures%step, wp)/max(figures%max_steps, 1))
      left = min(left, (figures%max_steps - figures%step)/pace%steps_per_second)
    end if
    speed = pace%steps_per_second*figures%cells
    write (percent, '(f5.1,a)') 100*min(max(fraction, 0.0_wp), 1.0_wp), '%'
    line = trim(percent)//'  step '//str(figures%step)//'  t '//str(figures%time, 5)//unit_text(figures%time_unit)// &
      '  dt '//str(figures%dt, 3)//' ('//figures%limiter//')'
    if (left >= 0) line = line//'  left '//duration_text(left)
    line = line//'  drift: mass '//brief(figures%mass_drift)//', momentum '//brief(figures%momentum_drift)// &
      ', energy '//brief(figures%energy_drift)//'  repairs '//str(figures%repairs)//'  '//memory_text(figures%memory)
    if (figures%awake < 1) line = line//'  awake '//str(100*figures%awake, 3)//'%'
    if (speed > 0) line = line//'  '//str(1e-6_wp*speed, 3)//' Mcells/s'
  end function report_line

  subroutine update_pace(figures, pace)
    type(report_figures), intent(in) :: figures
    type(report_pace), intent(inout) :: pace
    real(wp) :: seconds, recent
    seconds = figures%wall - pace%wall
    if (seconds <= 0 .or. figures%step <= pace%step) return
    recent = (figures%time - pace%time)/seconds
    if (pace%time_per_second > 0) recent = 0.5_wp*(recent + pace%time_per_second) ! one slow report shall not frighten
    pace%time_per_second = recent
    pace%steps_per_second = (figures%step - pace%step)/seconds
    pace%time = figures%time
    pace%wall = figures%wall
    pace%step = figures%step
  end subroutine update_pace

  !> Peak memory of all ranks in bytes (Linux: VmHWM of /proc/self/status; elsewhere 0). To be called by all ranks.
  integer(i8) function peak_memory() result(bytes)
    integer(i8) :: mine
    mine = own_peak_memory()
    call MPI_Allreduce(mine, bytes, 1, MPI_INTEGER8, MPI_SUM, world)
  end function peak_memory

  integer(i8) function own_peak_memory() result(bytes)
    integer :: unit, status
    character(128) :: line
    bytes = 0
    open (newunit=unit, file='/proc/self/status', status='old', action='read', iostat=status)
    if (status /= 0) return
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      if (line(1:6) /= 'VmHWM:') cycle
      read (line(7:index(line, 'kB') - 1), *, iostat=status) bytes
      bytes = 1024*bytes
      exit
    end do
    close (unit)
  end function own_peak_memory

  !> Seconds as a person says them: 42 s, 3 min 20 s, 2 h 05 min, 3 d 4 h.
  pure function duration_text(seconds) result(string)
    real(wp), intent(in) :: seconds
    character(:), allocatable :: string
    integer(i8) :: s
    s = nint(min(max(seconds, 0.0_wp), 1e12_wp), i8)
    if (s < 60) then
      string = str(s)//' s'
    else if (s < 3600) then
      string = str(s/60)//' min '//two_digits(mod(s, 60_i8))//' s'
    else if (s < 172800) then
      string = str(s/3600)//' h '//two_digits(mod(s/60, 60_i8))//' min'
    else
      string = str(s/86400)//' d '//str(mod(s/3600, 24_i8))//' h'
    end if
  end function duration_text

  !> Bytes in MB or GB.
  pure function memory_text(bytes) result(string)
    integer(i8), intent(in) :: bytes
    character(:), allocatable :: string
    character(16) :: buffer
    if (bytes < 1000000000_i8) then
      string = str(nint(bytes/1e6_wp))//' MB'
    else
      write (buffer, '(f12.1)') bytes/1e9_wp
      string = trim(adjustl(buffer))//' GB'
    end if
  end function memory_text

  pure function two_digits(n) result(string)
    integer(i8), intent(in) :: n
    character(2) :: string
    write (string, '(i2.2)') n
  end function two_digits

  pure function unit_text(unit) result(string)
    character(*), intent(in) :: unit
    character(:), allocatable :: string
    string = ''
    if (len_trim(unit) > 0 .and. unit /= '-') string = ' '//trim(unit)
  end function unit_text

  !> A drift in a few letters.
  pure function brief(value) result(string)
    real(wp), intent(in) :: value
    character(:), allocatable :: string
    character(10) :: buffer
    write (buffer, '(es9.1e2)') value
    string = trim(adjustl(buffer))
  end function brief

end module report
