!> Dynamic increase factor of the tensile strength of concrete: (rate/static)^d up to a knee, b (rate/static)^(1/3) beyond.
!>
!> ceb: CEB-FIP Model Code 1990, section 2.1.4.5: static rate 3e-6/s, exponent 1.016 d with d = 1/(10 + 6 fc/10 MPa), knee at
!> 30/s, lg b = 7.112 d - 2.33. malvar: Malvar & Crawford, 28th DDESB Seminar, Orlando 1998: static rate 1e-6/s, d = 1/(1 + 8
!> fc/10 MPa), knee at 1/s, lg b = 6 d - 2. No test went beyond some 200/s: the factor rises no further from 300/s on.
module tension_rate
  use constants, only: third
  use kinds, only: wp
  implicit none
  private
  public :: make_tension_rate, tension_factor

  type, public :: tension_rate_type
    logical :: active = .false. !< otherwise the factor is 1
    real(wp) :: static_rate = 1 !< up to which the factor is 1
    real(wp) :: exponent = 0, knee = 1 !< of the first part, and where it ends
    real(wp) :: steep = 1 !< b of the second part
    real(wp) :: largest = 1 !< rate up to which the factor rises
  end type tension_rate_type

contains

  !> law: 'none', 'ceb' or 'malvar'; strength: fc over 10 MPa; per_second: 1/s in the units of the deck.
  pure function make_tension_rate(law, strength, per_second) result(rate)
    character(*), intent(in) :: law
    real(wp), intent(in) :: strength, per_second
    type(tension_rate_type) :: rate
    real(wp) :: d
    rate%active = .true.
    select case (law)
    case ('ceb')
      d = 1/(10 + 6*strength)
      rate%static_rate = 3e-6_wp*per_second
      rate%exponent = 1.016_wp*d
      rate%knee = 30*per_second
      rate%steep = 10**(7.112_wp*d - 2.33_wp)
    case ('malvar')
      d = 1/(1 + 8*strength)
      rate%static_rate = 1e-6_wp*per_second
      rate%exponent = d
      rate%knee = per_second
      rate%steep = 10**(6*d - 2)
    case default
      rate%active = .false.
    end select
    rate%largest = 300*per_second
  end function make_tension_rate

  !> Factor of n particles. The rate is the norm of the strain rate, which in uniaxial tension is the rate of the test.
  !> shear: d:d of the deviatoric increment; the volumes give the rest of the strain increment.
  pure subroutine tension_factor(n, rate, dt, shear, old_volume, volume, factor)
    integer, intent(in) :: n
    type(tension_rate_type), intent(in) :: rate
    real(wp), intent(in) :: dt, shear(n), old_volume(n), volume(n)
    real(wp), intent(out) :: factor(n)
    real(wp) :: inverse, exponent, knee, steep, largest, bulk, x
    integer :: i
    if (.not. rate%active) then
      factor = 1
      return
    end if
    inverse = 1/(dt*rate%static_rate)
    exponent = rate%exponent
    knee = rate%knee/rate%static_rate
    steep = rate%steep
    largest = rate%largest/rate%static_rate
    !$omp simd private(bulk, x)
    do i = 1, n
      bulk = 2*(volume(i) - old_volume(i))/(volume(i) + old_volume(i))
      x = log(min(max(sqrt(shear(i) + third*bulk*bulk)*inverse, 1.0_wp), largest))
      factor(i) = merge(steep, 1.0_wp, x > log(knee))*exp(merge(third, exponent, x > log(knee))*x)
    end do
  end subroutine tension_factor

end module tension_rate
