!> Jones-Wilkins-Lee equation of state of detonation products, with V = r0/r and E the energy per initial volume:
!> p = A (1 - w/(R1 V)) exp(-R1 V) + B (1 - w/(R2 V)) exp(-R2 V) + w E/V,  so that p = f(r) + w r e with e = E/r0.
!> Source: Lee, Hornig & Kury 1968; Dobratz & Crawford 1985.
module jwl
  use kinds, only: wp
  implicit none
  private
  public :: jwl_reference, jwl_pressure, jwl_cold_pressure, jwl_isentrope_density

  type, public :: jwl_type
    real(wp) :: a = 0, b = 0 !< pressures
    real(wp) :: r1 = 1, r2 = 1 !< without dimension
    real(wp) :: omega = 0.3_wp !< Grueneisen coefficient
    real(wp) :: density = 1 !< r0, of the unreacted explosive
    real(wp) :: energy_per_volume = 0 !< E0, per initial volume
  end type jwl_type

  !> Beyond this exponent the terms are nil in double precision, and vector exponentials turn slow.
  real(wp), parameter :: largest_exponent = 600

contains

  !> Row of f and of r df/dr. v: relative volumes r0/r of n cells.
  pure subroutine jwl_reference(eos, n, v, f, r_df)
    type(jwl_type), intent(in) :: eos
    integer, intent(in) :: n
    real(wp), intent(in) :: v(n)
    real(wp), intent(out) :: f(n), r_df(n)
    real(wp) :: x1, x2, term1, term2, a, b, r1, r2, over_r1, over_r2, w, q
    integer :: i
    a = eos%a; b = eos%b; r1 = eos%r1; r2 = eos%r2; w = eos%omega
    over_r1 = w/r1; over_r2 = w/r2
    !$omp simd private(x1, x2, term1, term2, q)
    do i = 1, n
      x1 = r1*v(i)
      x2 = r2*v(i)
      term1 = a*exp(-min(x1, largest_exponent))
      term2 = b*exp(-min(x2, largest_exponent))
      q = 1/v(i)
      f(i) = term1*(1 - over_r1*q) + term2*(1 - over_r2*q)
      r_df(i) = term1*(x1 - w - over_r1*q) + term2*(x2 - w - over_r2*q)
    end do
  end subroutine jwl_reference

  !> Pressure at density r and energy per mass e.
  elemental real(wp) function jwl_pressure(eos, r, e)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(in) :: r, e
    real(wp) :: v(1), f(1), r_df(1)
    v = eos%density/r
    call jwl_reference(eos, 1, v, f, r_df)
    jwl_pressure = f(1) + eos%omega*r*e
  end function jwl_pressure

  !> The lowest pressure that the products can have at density r: the isentrope without its thermal term.
  elemental real(wp) function jwl_cold_pressure(eos, r)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(in) :: r
    jwl_cold_pressure = eos%a*exp(-min(eos%r1*eos%density/r, largest_exponent)) &
      + eos%b*exp(-min(eos%r2*eos%density/r, largest_exponent))
  end function jwl_cold_pressure

  !> Density at pressure p_new > 0 on the isentrope p = A exp(-R1 V) + B exp(-R2 V) + C V**-(1+w) through (r, p).
  elemental real(wp) function jwl_isentrope_density(eos, r, p, p_new) result(density)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_new
    real(wp) :: thermal, low, high, middle
    integer :: i
    thermal = (p - jwl_cold_pressure(eos, r))*(eos%density/r)**(1 + eos%omega)
    low = log(r) - 1
    do while (on_isentrope(exp(low)) > p_new .and. low > log(r) - 60)
      low = low - 1
    end do
    high = log(r) + 1
    do while (on_isentrope(exp(high)) < p_new .and. high < log(r) + 5)
      high = high + 0.5_wp
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
      on_isentrope = jwl_cold_pressure(eos, trial) + thermal*(trial/eos%density)**(1 + eos%omega)
    end function on_isentrope
  end function jwl_isentrope_density

end module jwl
