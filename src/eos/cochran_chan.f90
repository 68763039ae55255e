!> Cochran-Chan equation of state of condensed matter, with V = r0/r and a constant Grueneisen coefficient g:
!> p = p_ref + g r (e - e_ref),  p_ref = A1 V**-E1 - A2 V**-E2,
!> r0 e_ref = A1 (V**(1-E1) - 1)/(E1 - 1) - A2 (V**(1-E2) - 1)/(E2 - 1).
!> p_ref is an isentrope, e_ref the work done along it from V = 1: there e = 0 goes with p = A1 - A2.
!> Source: Cochran & Chan 1979, UCID-18024; Saurel & Abgrall 1999, SIAM J. Sci. Comput. 21, 1115; Shyue 2001, J. Comput. Phys. 171.
module cochran_chan
  use kinds, only: wp
  implicit none
  private
  public :: cochran_chan_reference, cochran_chan_cold_pressure, cochran_chan_isentrope_density, &
    cochran_chan_largest_density

  type, public :: cochran_chan_type
    real(wp) :: a1 = 0, a2 = 0 !< pressures
    real(wp) :: e1 = 3, e2 = 2 !< without dimension, more than 1
    real(wp) :: grueneisen = 1
    real(wp) :: density = 1 !< r0
  end type cochran_chan_type

  !> Beyond this exponent, up or down, powers are cut: no density that matters, and no overflow.
  real(wp), parameter :: largest_exponent = 300

contains

  !> Row of f and of r df/dr. v: relative volumes r0/r of n cells.
  pure subroutine cochran_chan_reference(eos, n, v, f, r_df)
    type(cochran_chan_type), intent(in) :: eos
    integer, intent(in) :: n
    real(wp), intent(in) :: v(n)
    real(wp), intent(out) :: f(n), r_df(n)
    real(wp) :: first, second, at_rest, e1, e2, logarithm, term1, term2, term3
    integer :: i
    e1 = eos%e1; e2 = eos%e2
    first = eos%a1*(1 - eos%grueneisen/(e1 - 1))
    second = -eos%a2*(1 - eos%grueneisen/(e2 - 1))
    at_rest = eos%grueneisen*(eos%a1/(e1 - 1) - eos%a2/(e2 - 1))
    !$omp simd private(logarithm, term1, term2, term3)
    do i = 1, n
      logarithm = log(v(i))
      term1 = first*exp(max(min(-e1*logarithm, largest_exponent), -largest_exponent))
      term2 = second*exp(max(min(-e2*logarithm, largest_exponent), -largest_exponent))
      term3 = at_rest/v(i)
      f(i) = term1 + term2 + term3
      r_df(i) = e1*term1 + e2*term2 + term3
    end do
  end subroutine cochran_chan_reference

  !> p_ref at density r.
  elemental real(wp) function cochran_chan_cold_pressure(eos, r)
    type(cochran_chan_type), intent(in) :: eos
    real(wp), intent(in) :: r
    real(wp) :: logarithm
    logarithm = log(r/eos%density)
    cochran_chan_cold_pressure = eos%a1*exp(max(min(eos%e1*logarithm, largest_exponent), -largest_exponent)) &
      - eos%a2*exp(max(min(eos%e2*logarithm, largest_exponent), -largest_exponent))
  end function cochran_chan_cold_pressure

  !> Density at pressure p_new on the isentrope p = p_ref + C V**-(1+g) through (r, p). An isentrope reaches no lower than its
  !> own tension; below that the answer is the lowest density looked at.
  elemental real(wp) function cochran_chan_isentrope_density(eos, r, p, p_new) result(density)
    type(cochran_chan_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_new
    real(wp) :: thermal, low, high, middle
    integer :: i
    thermal = p - cochran_chan_cold_pressure(eos, r)
    low = log(r) - 0.125_wp
    do while (on_isentrope(exp(low)) > p_new .and. low > log(r) - 30)
      low = low - 0.125_wp
    end do
    high = log(r) + 0.125_wp
    do while (on_isentrope(exp(high)) < p_new .and. high < log(r) + 5)
      high = high + 0.125_wp
    end do
    do i = 1, 60
      middle = 0.5_wp*(low + high)
      if (on_isentrope(exp(middle)) < p_new) then
        low = middle
      else
        high = middle
      end if
    end do
    density = exp(0.5_wp*(low + high))
  contains
    pure real(wp) function on_isentrope(trial)
      real(wp), intent(in) :: trial
      on_isentrope = cochran_chan_cold_pressure(eos, trial) + thermal*(trial/r)**(1 + eos%grueneisen)
    end function on_isentrope
  end function cochran_chan_isentrope_density

  !> Density where r f' - f = A1 (E1 - 1 - g) V**-E1 - A2 (E2 - 1 - g) V**-E2 turns negative; huge where it does not.
  elemental real(wp) function cochran_chan_largest_density(eos) result(density)
    type(cochran_chan_type), intent(in) :: eos
    real(wp) :: rising, falling, logarithm
    density = huge(1.0_wp)
    rising = eos%a2*(1 + eos%grueneisen - eos%e2)
    falling = eos%a1*(1 + eos%grueneisen - eos%e1)
    if (.not. (falling > 0 .and. rising > 0 .and. eos%e1 > eos%e2)) return
    logarithm = log(rising/falling)/(eos%e1 - eos%e2)
    if (logarithm < largest_exponent) density = eos%density*exp(logarithm)
  end function cochran_chan_largest_density

end module cochran_chan
