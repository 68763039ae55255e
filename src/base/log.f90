!> What the program tells its user: lines on standard output, from the root only, and none if it is to be quiet.
module log
  use, intrinsic :: iso_fortran_env, only: output_unit
  use parallel, only: is_root
  implicit none
  private
  public :: say, be_quiet

  logical :: quiet = .false.

contains

  !> Prints a line.
  subroutine say(line)
    character(*), intent(in) :: line
    if (quiet .or. .not. is_root()) return
    write (output_unit, '(a)') line
    flush (output_unit)
  end subroutine say

  !> From now on nothing but warnings and errors is printed. was: what it was before; silent (default true): what it shall be.
  subroutine be_quiet(silent, was)
    logical, intent(in), optional :: silent
    logical, intent(out), optional :: was
    if (present(was)) was = quiet
    quiet = .true.
    if (present(silent)) quiet = silent
  end subroutine be_quiet

end module log
