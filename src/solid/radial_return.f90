!> What the models with a yield stress share: the return to the yield surface once the yield stress is known.
module radial_return
  use kinds, only: wp
  implicit none
  private
  public :: return_to_yield

contains

  !> Scales the trial deviator back to the yield stress and books what that means.
  !>
  !> With the yield stress s_y + H de (H: hardening in this step, 0 where s_y is fixed in it), limited to ultimate,
  !> the plastic increment is de = (s_trial - s_y)/(3 G + H). damage = e_p/failure_strain; from failure_damage on the
  !> particle has no deviator. trial: equivalent trial stress; ratio: what the trial deviator must be multiplied by;
  !> volume: at mid step, for the plastic work.
  pure subroutine return_to_yield(n, shear_modulus, hardening, ultimate, failure_strain, failure_damage, yield, trial, volume, &
      plastic_strain, damage, plastic_work, ratio)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, hardening, ultimate, failure_strain, failure_damage
    real(wp), intent(in) :: yield(n), trial(n), volume(n)
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n)
    real(wp), intent(out) :: ratio(n)
    integer :: i
    real(wp) :: increment, stress, by_hardening, by_limit, inverse_strain
    by_hardening = 1/(3*shear_modulus + hardening)
    by_limit = 1/(3*shear_modulus)
    inverse_strain = merge(1/failure_strain, 0.0_wp, failure_strain < huge(1.0_wp)) ! no tiny numbers, which are slow
    !$omp simd private(increment, stress)
    do i = 1, n
      increment = max((trial(i) - yield(i))*by_hardening, (trial(i) - ultimate)*by_limit, 0.0_wp)
      increment = merge(increment, 0.0_wp, damage(i) < failure_damage)
      stress = trial(i) - 3*shear_modulus*increment
      plastic_strain(i) = plastic_strain(i) + increment
      plastic_work(i) = plastic_work(i) + stress*increment*volume(i)
      damage(i) = min(max(damage(i), plastic_strain(i)*inverse_strain), 1.0_wp)
      stress = stress/max(trial(i), tiny(1.0_wp))
      stress = merge(stress, 1.0_wp, trial(i) > 0)
      ratio(i) = merge(stress, 0.0_wp, damage(i) < failure_damage)
    end do
  end subroutine return_to_yield

end module radial_return
