!> Cracks that cost the same energy in every mesh: tension softens with the work that is dissipated in it, against fracture energy
!> over cell size (crack band: Bazant & Oh, Materials and Structures 16, 1983).
!>
!> A damage D that scales every tensile strength by 1 - D and grows with the dissipated work w per volume as
!> d(1 - D)^2 = -dw h/Gf is spent, D = 1, exactly when w = Gf/h, on whatever path; where the inelastic strain grows on one path
!> it makes the softening linear. Cells must be smaller than about 2 E Gf/ft^2, beyond which the elastic energy of a cell alone
!> exceeds Gf.
module crack_band
  use kinds, only: wp
  implicit none
  private
  public :: open_cracks, soften

contains

  !> Pressure of n particles with a crack: none while it is open, and no tension beyond the limit, at which it opens further.
  !>
  !> opening: volumetric strain that must close before the pressure rises from zero; modulus: slope of the unloading;
  !> opened: what has opened in this step. pressure: without a limit on entry.
  pure subroutine open_cracks(n, modulus, limit, opening, pressure, opened)
    integer, intent(in) :: n
    real(wp), intent(in) :: modulus, limit(n)
    real(wp), intent(inout) :: opening(n), pressure(n)
    real(wp), intent(out) :: opened(n)
    real(wp) :: shifted, inverse
    integer :: i
    inverse = 1/modulus
    !$omp simd private(shifted)
    do i = 1, n
      shifted = min(pressure(i) + modulus*opening(i), 0.0_wp)
      opened(i) = max(-limit(i) - shifted, 0.0_wp)*inverse
      opening(i) = opening(i) + opened(i)
      pressure(i) = max(max(shifted, -limit(i)), pressure(i))
    end do
  end subroutine open_cracks

  !> Damage after the work (per volume) has been dissipated. energy: fracture energy over cell size.
  pure subroutine soften(n, energy, work, damage)
    integer, intent(in) :: n
    real(wp), intent(in) :: energy, work(n)
    real(wp), intent(inout) :: damage(n)
    real(wp) :: inverse
    integer :: i
    inverse = 1/energy
    !$omp simd
    do i = 1, n
      damage(i) = min(max(damage(i), 1 - sqrt(max((1 - damage(i))**2 - work(i)*inverse, 0.0_wp))), 1.0_wp)
    end do
  end subroutine soften

end module crack_band
