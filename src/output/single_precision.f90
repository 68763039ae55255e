!> Rounding to single precision for files that are only looked at.
module single_precision
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
  use, intrinsic :: iso_fortran_env, only: real32
  use kinds, only: wp
  implicit none
  private
  public :: single

contains

  !> The nearest number of single precision; too large ones become its largest and too small ones zero, so that nothing traps.
  elemental real(real32) function single(value)
    real(wp), intent(in) :: value
    real(wp), parameter :: largest = huge(1.0_real32), smallest = tiny(1.0_real32)
    if (ieee_is_nan(value)) then
      single = ieee_value(1.0_real32, ieee_quiet_nan)
    else if (abs(value) < smallest) then
      single = 0
    else if (abs(value) > largest) then
      single = merge(huge(1.0_real32), -huge(1.0_real32), value > 0)
    else
      single = real(value, real32)
    end if
  end function single

end module single_precision
