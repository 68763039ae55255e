!> The one way out on an error: every rank ends, with a status that a batch script can read.
module errors
  use, intrinsic :: iso_fortran_env, only: error_unit
  use mpi_f08, only: MPI_Abort, MPI_Initialized
  use parallel, only: world
  use process, only: exit_process
  implicit none
  private
  public :: fatal, warn, fatal_handler

  integer, parameter, public :: exit_done = 0 !< the run reached its end
  integer, parameter, public :: exit_bad_input = 2 !< bad deck or option; nothing was written
  integer, parameter, public :: exit_failed = 3 !< the computation failed: not finite, negative, out of memory
  integer, parameter, public :: exit_stopped = 4 !< stopped by a signal or a limit after writing a restart

  abstract interface
    !> What is done with a fatal error; a test may put its own in place.
    subroutine fatal_handler(message, status)
      character(*), intent(in) :: message
      integer, intent(in) :: status
    end subroutine fatal_handler
  end interface
  procedure(fatal_handler), pointer, public :: on_fatal => abort_all !< replaceable by tests
  integer, protected, public :: n_warnings = 0 !< warnings given by this rank so far

contains

  !> Ends the whole run with a message. status: exit_bad_input, exit_failed (default) or exit_stopped.
  subroutine fatal(message, status)
    character(*), intent(in) :: message
    integer, intent(in), optional :: status
    integer :: code
    code = exit_failed
    if (present(status)) code = status
    call on_fatal(message, code)
  end subroutine fatal

  !> Tells the user of something doubtful and goes on.
  subroutine warn(message)
    character(*), intent(in) :: message
    n_warnings = n_warnings + 1
    write (error_unit, '(2a)') 'warning: ', message
  end subroutine warn

  subroutine abort_all(message, status)
    character(*), intent(in) :: message
    integer, intent(in) :: status
    logical :: started
    write (error_unit, '(2a)') 'error: ', message
    flush (error_unit)
    call MPI_Initialized(started)
    if (started) call MPI_Abort(world, status)
    call exit_process(status)
  end subroutine abort_all

end module errors
