!> Linear elasticity, and what every metal shares with it: the pressure K mu and the limit of tension.
module elastic
  use kinds, only: wp
  implicit none
  private
  public :: elastic_pressure, elastic_ratio, limit_tension

contains

  !> Pressure p = K mu of n particles, mu = r/r0 - 1.
  !>
  !> The pressure follows from the present volume and not from a sum of increments, so it cannot drift and a particle that has
  !> opened and closes again bears load only when it is back at its density.
  pure subroutine elastic_pressure(n, bulk_modulus, compression, pressure)
    integer, intent(in) :: n
    real(wp), intent(in) :: bulk_modulus, compression(n)
    real(wp), intent(out) :: pressure(n)
    integer :: i
    !$omp simd
    do i = 1, n
      pressure(i) = bulk_modulus*compression(i)
    end do
  end subroutine elastic_pressure

  !> Factor of the deviator of n particles: 1, or 0 where they have failed.
  pure subroutine elastic_ratio(n, failure_damage, damage, ratio)
    integer, intent(in) :: n
    real(wp), intent(in) :: failure_damage, damage(n)
    real(wp), intent(out) :: ratio(n)
    integer :: i
    !$omp simd
    do i = 1, n
      ratio(i) = merge(1.0_wp, 0.0_wp, damage(i) < failure_damage)
    end do
  end subroutine elastic_ratio

  !> No tension beyond the limit, where a particle fails if it is to; a failed one bears compression only.
  pure subroutine limit_tension(n, limit, fails, failure_damage, damage, pressure)
    integer, intent(in) :: n
    real(wp), intent(in) :: limit, failure_damage
    logical, intent(in) :: fails
    real(wp), intent(inout) :: damage(n), pressure(n)
    real(wp) :: at_limit
    integer :: i
    at_limit = merge(1.0_wp, 0.0_wp, fails)
    !$omp simd
    do i = 1, n
      damage(i) = max(damage(i), merge(at_limit, 0.0_wp, pressure(i) < -limit))
      pressure(i) = max(pressure(i), merge(-limit, 0.0_wp, damage(i) < failure_damage))
    end do
  end subroutine limit_tension

end module elastic
