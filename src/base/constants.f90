!> Numbers that belong to no room in particular.
module constants
  use kinds, only: wp
  implicit none
  private
  real(wp), parameter, public :: pi = 3.14159265358979323846_wp
  real(wp), parameter, public :: unset = -huge(1.0_wp) !< marks a real number of the deck that was not given
  real(wp), parameter, public :: third = 1.0_wp/3.0_wp
end module constants
