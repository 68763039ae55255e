!> Equation of state about the shocks of a material, us = c0 + s up, with a constant Grueneisen coefficient g (Mie-Grueneisen):
!> p = p_h + g r (e - e_h),  p_h = r0 c0**2 x/(1 - s x)**2,  e_h = p_h x/(2 r0),  x = 1 - V,  V = r0/r,
!> so that f = p_h (1 - g x/(2 V)). In tension, V > 1, it is f = r0 c0**2 (1/V - 1).
!> The curve has a pole at s x = 1, and with g > 0 f turns down long before it. From `least_volume` on f goes on as a straight
!> line in the density: f and f' stay continuous and f rises for good. See equation_of_state for where that is.
!> Source: McQueen, Marsh, Taylor, Fritz & Carter 1970; Meyers 1994, Dynamic Behavior of Materials, ch. 5.
module shock_eos
  use kinds, only: wp
  implicit none
  private
  public :: shock_reference

  type, public :: shock_type
    real(wp) :: sound_speed = 1 !< c0
    real(wp) :: slope = 1 !< s
    real(wp) :: grueneisen = 1
    real(wp) :: density = 1 !< r0
    real(wp) :: least_volume = 0.5_wp !< V where the straight line begins; 1 - V < 1/s
  end type shock_type

contains

  !> Row of f and of r df/dr. v: relative volumes r0/r of n cells.
  pure subroutine shock_reference(eos, n, v, f, r_df)
    type(shock_type), intent(in) :: eos
    integer, intent(in) :: n
    real(wp), intent(in) :: v(n)
    real(wp), intent(out) :: f(n), r_df(n)
    real(wp) :: bulk, s, half_g, least, curved, compression, q, over_curved, denominator, hugoniot, slope
    integer :: i
    bulk = eos%density*eos%sound_speed**2
    s = eos%slope; half_g = 0.5_wp*eos%grueneisen; least = eos%least_volume
    !$omp simd private(curved, compression, q, over_curved, denominator, hugoniot, slope)
    do i = 1, n
      curved = max(min(v(i), 1.0_wp), least) ! where the curve is left for its tangent, on both sides
      compression = 1 - curved
      q = 1/v(i)
      over_curved = 1/curved
      denominator = 1/(1 - s*compression)
      hugoniot = bulk*compression*denominator*denominator
      ! df/d(1/V)
      slope = curved*curved*bulk*denominator*denominator*(1 + 2*s*compression*denominator)*(1 - half_g*compression*over_curved) &
        - half_g*hugoniot
      f(i) = hugoniot*(1 - half_g*compression*over_curved) + slope*(q - over_curved)
      r_df(i) = slope*q
    end do
  end subroutine shock_reference

end module shock_eos
