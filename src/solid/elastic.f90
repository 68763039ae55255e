!> Linear elasticity: the pressure of every isotropic model that has a constant bulk modulus.
module elastic
  use kinds, only: wp
  implicit none
  private
  public :: elastic_pressure

contains

  !> Pressure p = K mu of n particles; a failed one bears compression only. mu = r/r0 - 1.
  !>
  !> The pressure follows from the present volume and not from a sum of increments, so it cannot drift and a particle that has
  !> opened and closes again bears load only when it is back at its density.
  pure subroutine elastic_pressure(n, bulk_modulus, failure_damage, damage, compression, pressure)
    integer, intent(in) :: n
    real(wp), intent(in) :: bulk_modulus, failure_damage, damage(n), compression(n)
    real(wp), intent(out) :: pressure(n)
    integer :: i
    real(wp) :: p
    !$omp simd private(p)
    do i = 1, n
      p = bulk_modulus*compression(i)
      pressure(i) = merge(p, max(p, 0.0_wp), damage(i) < failure_damage)
    end do
  end subroutine elastic_pressure

end module elastic
