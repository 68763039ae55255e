!> The end of the process with a status that the shell sees (a Fortran stop with a text would give 0).
module process
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: exit_process

  interface
    subroutine c_exit(status) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit
  end interface

contains

  !> Ends this process; to be called after MPI has been finalised or aborted.
  subroutine exit_process(status)
    integer, intent(in) :: status
    call c_exit(int(status, c_int))
  end subroutine exit_process

end module process
