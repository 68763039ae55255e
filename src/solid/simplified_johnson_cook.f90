!> Johnson-Cook strength without temperature: (A + B e_p^n)(1 + C ln rate*) (paper eq. 41).
module simplified_johnson_cook
  use kinds, only: wp
  implicit none
  private
  public :: simplified_johnson_cook_yield

contains

  !> The yield stress of n particles at their present plastic strain; it lags by one step's hardening.
  !>
  !> strain: equivalent strain increment of this step; dt_rate: time step times the reference strain rate. Below the
  !> reference rate the factor stays 1.
  pure subroutine simplified_johnson_cook_yield(n, a, b, exponent, c, dt_rate, strain, plastic_strain, yield)
    integer, intent(in) :: n
    real(wp), intent(in) :: a, b, exponent, c, dt_rate, strain(n), plastic_strain(n)
    real(wp), intent(out) :: yield(n)
    real(wp), parameter :: smallest = 1e-30_wp
    integer :: i
    real(wp) :: inverse, base(n), factor(n), rate(n)
    inverse = 1/dt_rate
    ! limits in a loop of their own: beside them the compiler branches around exp and log, which then are not vectorised
    !$omp simd
    do i = 1, n
      base(i) = max(plastic_strain(i), smallest)
      factor(i) = merge(b, 0.0_wp, plastic_strain(i) > smallest)
      rate(i) = max(strain(i)*inverse, 1.0_wp)
    end do
    !$omp simd
    do i = 1, n
      yield(i) = (a + factor(i)*exp(exponent*log(base(i))))*(1 + c*log(rate(i)))
    end do
  end subroutine simplified_johnson_cook_yield

end module simplified_johnson_cook
