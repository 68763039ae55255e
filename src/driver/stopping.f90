!> Reasons to stop before the end: signals (SIGTERM, SIGUSR1), a wall-clock limit, a file named STOP in the output folder.
!> Each leads to a restart file and exit status 4, on all ranks together.
module stopping
  use, intrinsic :: iso_c_binding, only: c_int, c_funptr, c_funloc
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: wp
  use mpi_f08, only: MPI_Bcast, MPI_INTEGER, MPI_Allreduce, MPI_IN_PLACE, MPI_MAX
  use parallel, only: world, is_root
  implicit none
  private
  public :: watch_signals, stop_reason, wall_seconds, start_wall_clock

  integer, parameter, public :: go_on = 0, signal_received = 1, wall_limit_reached = 2, stop_file_found = 3
  character(*), parameter, public :: reason_name(3) = [character(24) :: 'a signal', 'the wall-clock limit', 'the file STOP']
  integer(c_int), parameter :: sigterm = 15, sigusr1 = 10
  integer(c_int), volatile :: signal_flag = 0 !< the one thing that a signal handler may touch
  integer(int64) :: clock_at_start = 0

  interface
    function c_signal(number, handler) bind(c, name='signal') result(previous)
      import :: c_int, c_funptr
      integer(c_int), value :: number
      type(c_funptr), value :: handler
      type(c_funptr) :: previous
    end function c_signal
  end interface

contains

  !> From now on SIGTERM and SIGUSR1 set a flag that stop_reason sees.
  subroutine watch_signals()
    type(c_funptr) :: previous
    previous = c_signal(sigterm, c_funloc(note_signal))
    previous = c_signal(sigusr1, c_funloc(note_signal))
  end subroutine watch_signals

  subroutine note_signal(number) bind(c)
    integer(c_int), value :: number
    signal_flag = number
  end subroutine note_signal

  !> Starts the clock that the wall limit is held against.
  subroutine start_wall_clock()
    call system_clock(clock_at_start)
  end subroutine start_wall_clock

  !> Seconds since start_wall_clock.
  real(wp) function wall_seconds()
    integer(int64) :: now, clock_rate
    call system_clock(now, clock_rate)
    wall_seconds = real(now - clock_at_start, wp)/clock_rate
  end function wall_seconds

  !> go_on or one of the reasons above, the same on every rank. margin: seconds that the next step and a restart file may take;
  !> look_for_file: also look for directory/STOP (the root removes it).
  integer function stop_reason(wall_limit, margin, directory, look_for_file) result(reason)
    real(wp), intent(in) :: wall_limit, margin
    character(*), intent(in) :: directory
    logical, intent(in) :: look_for_file
    logical :: found
    integer :: unit
    reason = go_on
    if (is_root()) then
      if (wall_limit > 0) then
        if (wall_seconds() + margin > wall_limit) reason = wall_limit_reached
      end if
      if (look_for_file) then
        inquire (file=directory//'/STOP', exist=found)
        if (found) then
          reason = stop_file_found
          open (newunit=unit, file=directory//'/STOP')
          close (unit, status='delete')
        end if
      end if
    end if
    if (signal_flag /= 0) reason = signal_received
    call MPI_Allreduce(MPI_IN_PLACE, reason, 1, MPI_INTEGER, MPI_MAX, world)
  end function stop_reason

end module stopping
