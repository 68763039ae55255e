!> The one real kind and the long integer of the program.
module kinds
  use, intrinsic :: iso_fortran_env, only: int64, real64
  implicit none
  private
  integer, parameter, public :: wp = real64 !< working precision of every real
  integer, parameter, public :: i8 = int64 !< counts that may pass 2**31
end module kinds
