!> Johnson & Cook (1983): (A + B e_p^n)(1 + C ln rate*)(1 - T*^m), the temperature from the plastic work.
module johnson_cook
  use kinds, only: wp
  use simplified_johnson_cook, only: simplified_johnson_cook_yield
  implicit none
  private
  public :: johnson_cook_yield, johnson_cook_temperature

contains

  !> The yield stress of n particles; arguments as in simplified_johnson_cook_yield.
  !>
  !> heating: taylor_quinney/specific_heat, which turns plastic work per mass into a rise of temperature;
  !> T* = (T - reference)/(melt - reference), no strength from T* = 1 on.
  pure subroutine johnson_cook_yield(n, a, b, exponent, c, m, heating, reference, melt, dt_rate, strain, plastic_strain, &
      plastic_work, mass, yield)
    integer, intent(in) :: n
    real(wp), intent(in) :: a, b, exponent, c, m, heating, reference, melt, dt_rate
    real(wp), intent(in) :: strain(n), plastic_strain(n), plastic_work(n), mass(n)
    real(wp), intent(out) :: yield(n)
    real(wp), parameter :: smallest = 1e-30_wp
    integer :: i
    real(wp) :: homologous, softening, factor
    call simplified_johnson_cook_yield(n, a, b, exponent, c, dt_rate, strain, plastic_strain, yield)
    factor = heating/(melt - reference)
    !$omp simd private(homologous, softening)
    do i = 1, n
      homologous = min(factor*plastic_work(i)/mass(i), 1.0_wp)
      softening = exp(m*log(max(homologous, smallest)))
      softening = merge(softening, 0.0_wp, homologous > smallest)
      yield(i) = yield(i)*(1 - softening)
    end do
  end subroutine johnson_cook_yield

  !> Temperature of a particle from its plastic work and mass; adiabatic, from the reference temperature.
  pure elemental real(wp) function johnson_cook_temperature(heating, reference, plastic_work, mass) result(temperature)
    real(wp), intent(in) :: heating, reference, plastic_work, mass
    temperature = reference + heating*plastic_work/mass
  end function johnson_cook_temperature

end module johnson_cook
