!> Polynomial equation of state with mu = r/r0 - 1: p = K1 mu + K2 mu**2 + K3 mu**3 + g (1 + mu) r0 e, that is p = f(r) + g r e
!> (the usual B0 and B1 being equal to g). In tension, mu < 0, f = K1 mu.
!> Where K2 or K3 are negative f may turn down: from the relative volume `least_volume` on it goes on as a straight line.
module polynomial_eos
  use kinds, only: wp
  implicit none
  private
  public :: polynomial_reference

  type, public :: polynomial_type
    real(wp) :: k1 = 1, k2 = 0, k3 = 0 !< pressures
    real(wp) :: density = 1 !< r0
    real(wp) :: least_volume = 0.5_wp !< r0/r where the straight line begins
  end type polynomial_type

contains

  !> Row of f and of r df/dr. v: relative volumes r0/r of n cells.
  pure subroutine polynomial_reference(eos, n, v, f, r_df)
    type(polynomial_type), intent(in) :: eos
    integer, intent(in) :: n
    real(wp), intent(in) :: v(n)
    real(wp), intent(out) :: f(n), r_df(n)
    real(wp) :: k1, k2, k3, most, q, mu, curved, slope
    integer :: i
    k1 = eos%k1; k2 = eos%k2; k3 = eos%k3
    most = 1/eos%least_volume - 1
    !$omp simd private(q, mu, curved, slope)
    do i = 1, n
      q = 1/v(i)
      mu = q - 1
      curved = min(max(mu, 0.0_wp), most) ! where the curve is left for its tangent, on both sides
      slope = k1 + curved*(2*k2 + curved*(3*k3))
      f(i) = curved*(k1 + curved*(k2 + curved*k3)) + slope*(mu - curved)
      r_df(i) = slope*q
    end do
  end subroutine polynomial_reference

end module polynomial_eos
