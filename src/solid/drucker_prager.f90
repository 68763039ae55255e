!> Drucker & Prager (1952): soil, rock, rubble. q <= M p + k, with M = 6 sin f/(3 - sin f) and k = 6 c cos f/(3 - sin f), which is
!> Mohr & Coulomb's friction angle f and cohesion c in triaxial compression.
!>
!> Plastic flow dilates: a plastic strain de opens the volume by M' de, M' as M of the dilatancy angle. Pressure is positive in
!> compression, p = K (mu + dilation), mu = r/r0 - 1.
module drucker_prager
  use deck_material, only: material_group
  use kinds, only: wp
  use particle_step, only: step_type
  implicit none
  private
  public :: make_drucker_prager, drucker_prager_stress, sliding_modulus

  type, public :: drucker_prager_type
    real(wp) :: friction = 0 !< M
    real(wp) :: cohesion = 0 !< k
    real(wp) :: dilatancy = 0 !< M'
    real(wp) :: tensile_limit = 0 !< largest tensile pressure: at most that of the apex, k/M
  end type drucker_prager_type

contains

  !> Constants from a checked group of the deck.
  pure function make_drucker_prager(group) result(d)
    type(material_group), intent(in) :: group
    type(drucker_prager_type) :: d
    real(wp) :: angle, degree
    degree = acos(-1.0_wp)/180
    angle = group%friction_angle*degree
    d%friction = 6*sin(angle)/(3 - sin(angle))
    d%cohesion = 6*group%cohesion*cos(angle)/(3 - sin(angle))
    d%dilatancy = 6*sin(group%dilatancy_angle*degree)/(3 - sin(group%dilatancy_angle*degree))
    d%tensile_limit = huge(1.0_wp)
    if (d%friction > 0) d%tensile_limit = d%cohesion/d%friction
    if (group%tensile_limit > 0) d%tensile_limit = min(d%tensile_limit, group%tensile_limit)
  end function make_drucker_prager

  !> Return of n particles to the cone, to its apex where the cone's own return would pass it, and the limit of tension.
  !>
  !> What opens beyond the limit of tension is no plastic strain: a particle that has come apart bears load when it is back at its
  !> density, less what it has dilated. A failed one keeps its friction and nothing else. dilation: column of this model.
  pure subroutine drucker_prager_stress(n, d, bulk_modulus, shear_modulus, failure_strain, failure_damage, s, plastic_strain, &
      damage, plastic_work, dilation)
    integer, intent(in) :: n
    type(drucker_prager_type), intent(in) :: d
    real(wp), intent(in) :: bulk_modulus, shear_modulus, failure_strain, failure_damage
    type(step_type), intent(inout) :: s
    real(wp), intent(inout), dimension(n) :: plastic_strain, damage, plastic_work, dilation
    call return_to_cone(n, d%friction, d%cohesion, d%dilatancy, d%tensile_limit, bulk_modulus, shear_modulus, failure_strain, &
      failure_damage, s%trial, s%compression, s%middle, plastic_strain, damage, plastic_work, dilation, s%pressure, s%ratio)
  end subroutine drucker_prager_stress

  pure subroutine return_to_cone(n, friction, cohesion, dilatancy, limit, bulk, shear, failure_strain, failure_damage, trial, &
      compression, volume, plastic_strain, damage, plastic_work, dilation, pressure, ratio)
    integer, intent(in) :: n
    real(wp), intent(in) :: friction, cohesion, dilatancy, limit, bulk, shear, failure_strain, failure_damage
    real(wp), intent(in), dimension(n) :: trial, compression, volume
    real(wp), intent(inout), dimension(n) :: plastic_strain, damage, plastic_work, dilation
    real(wp), intent(out), dimension(n) :: pressure, ratio
    real(wp) :: p, k, most, increment, stress, m, by_cone, by_shear, by_volume, three_shear, inverse_strain, c, t, failed
    integer :: i
    by_cone = 1/(3*shear + bulk*friction*dilatancy)
    by_shear = 1/(3*shear)
    three_shear = 3*shear
    by_volume = bulk
    m = friction
    c = cohesion
    t = limit
    failed = failure_damage
    inverse_strain = merge(1/failure_strain, 0.0_wp, failure_strain < huge(1.0_wp))
    !$omp simd private(p, k, most, increment, stress)
    do i = 1, n
      k = merge(c, 0.0_wp, damage(i) < failed)
      most = merge(t, 0.0_wp, damage(i) < failed)
      p = by_volume*(compression(i) + dilation(i))
      increment = min(max(trial(i) - m*p - k, 0.0_wp)*by_cone, trial(i)*by_shear)
      stress = max(trial(i) - three_shear*increment, 0.0_wp)
      dilation(i) = dilation(i) + dilatancy*increment
      p = max(p + by_volume*dilatancy*increment, -most)
      pressure(i) = p
      plastic_strain(i) = plastic_strain(i) + increment
      plastic_work(i) = plastic_work(i) + (stress - p*dilatancy)*increment*volume(i)
      damage(i) = min(max(damage(i), plastic_strain(i)*inverse_strain), 1.0_wp)
      stress = stress/max(trial(i), tiny(1.0_wp))
      ratio(i) = merge(stress, 1.0_wp, trial(i) > 0)
    end do
  end subroutine return_to_cone

  !> What stands for G in the speed of signals. Where expansion takes pressure off a sliding material its strength goes too, so
  !> K + 2/3 M K cos a + 4/3 G sin(a)**2 stands for K + 4/3 G, a the angle between the deviator and the direction of the wave.
  pure real(wp) function sliding_modulus(d, bulk_modulus, shear_modulus) result(modulus)
    type(drucker_prager_type), intent(in) :: d
    real(wp), intent(in) :: bulk_modulus, shear_modulus
    real(wp) :: cosine
    cosine = 0.25_wp*d%friction*bulk_modulus/shear_modulus
    if (cosine < 1) then
      modulus = shear_modulus*(1 + cosine**2)
    else
      modulus = 0.5_wp*d%friction*bulk_modulus
    end if
  end function sliding_modulus

end module drucker_prager
