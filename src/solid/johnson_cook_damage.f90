!> Failure strain of Johnson & Cook (Engineering Fracture Mechanics 21, 1985):
!> e_f = (D1 + D2 exp(D3 s*))(1 + D4 ln rate*)(1 + D5 T*), s* the mean stress over the equivalent stress.
module johnson_cook_damage
  use kinds, only: wp
  implicit none
  private
  public :: accumulate_damage

  real(wp), parameter :: largest_triaxiality = 1.5_wp !< up to which the authors give the law; beyond it the value there

  type, public :: johnson_cook_damage_type
    logical :: active = .false.
    real(wp) :: d1 = 0, d2 = 0, d3 = 0, d4 = 0, d5 = 0
    real(wp) :: heating = 0 !< homologous temperature per plastic work and mass; 0: no temperature
  end type johnson_cook_damage_type

contains

  !> Damage grows by the plastic increment over the failure strain; at 1 a particle has failed: no deviator from then on.
  !>
  !> before: plastic strain at the start of the step; old_pressure: pressure there; trial, ratio: give the equivalent stress at the
  !> end. The failure strain is at least `least`, which keeps constants that make it negative harmless.
  pure subroutine accumulate_damage(n, d, dt_rate, strain, before, plastic_strain, plastic_work, mass, old_pressure, trial, ratio, &
      damage)
    integer, intent(in) :: n
    type(johnson_cook_damage_type), intent(in) :: d
    real(wp), intent(in) :: dt_rate
    real(wp), intent(in), dimension(n) :: strain, before, plastic_strain, plastic_work, mass, old_pressure, trial, ratio
    real(wp), intent(inout) :: damage(n)
    real(wp), parameter :: least = 1e-6_wp
    real(wp) :: d1, d2, d3, d4, d5, heating, inverse, stress, triaxiality, failure
    integer :: i
    d1 = d%d1
    d2 = d%d2
    d3 = d%d3
    d4 = d%d4
    d5 = d%d5
    heating = d%heating
    inverse = 1/dt_rate
    !$omp simd private(stress, triaxiality, failure)
    do i = 1, n
      stress = max(trial(i)*ratio(i), tiny(1.0_wp))
      triaxiality = max(min(-old_pressure(i), largest_triaxiality*stress), -10*stress)/stress
      failure = (d1 + d2*exp(d3*triaxiality))*(1 + d4*log(max(strain(i)*inverse, 1.0_wp))) &
        *(1 + d5*min(heating*plastic_work(i)/mass(i), 1.0_wp))
      damage(i) = min(damage(i) + (plastic_strain(i) - before(i))/max(failure, least), 1.0_wp)
    end do
  end subroutine accumulate_damage

end module johnson_cook_damage
