!> Concrete of Holmquist, Johnson & Cook (1993): pressure-dependent strength, damage, and compaction of the pores.
!>
!> Signs: pressure and compression mu = r/r0 - 1 are positive in compression. The bulk modulus below crushing is
!> K_e = p_crush/mu_crush, which need not agree with E/(3(1-2 nu)); E and nu give the shear modulus only.
module hjc
  use kinds, only: wp
  use solid_material, only: hjc_constants
  implicit none
  private
  public :: hjc_pressure, hjc_return, hjc_modulus

contains

  !> Pressure of n particles after the compression mu has been reached; compaction (largest mu so far) is brought up to date.
  !>
  !> Envelope: K_e mu up to mu_crush, a straight line to (mu_plock, p_lock), then K1 m + K2 m^2 + K3 m^3 with
  !> m = (mu - mu_lock)/(1 + mu_lock). Between crushing and locking a particle unloads and reloads along a straight line whose slope
  !> goes linearly from K_e to K1; fully dense material follows the polynomial both ways, K1 m in tension. The pressure is never
  !> below -T(1-D). permanent: growth in this step of the compression that would remain at zero pressure.
  pure subroutine hjc_pressure(n, h, compression, damage, compaction, pressure, permanent)
    integer, intent(in) :: n
    type(hjc_constants), intent(in) :: h
    real(wp), intent(in) :: compression(n), damage(n)
    real(wp), intent(inout) :: compaction(n)
    real(wp), intent(out) :: pressure(n), permanent(n)
    real(wp) :: crush, plock, per_range, per_lock, k_elastic, k1, k2, k3, p_crush, slope, lock, t
    real(wp) :: reached, before, fraction, envelope, unloading, m, dense, partly
    integer :: i
    crush = h%mu_crush
    plock = h%mu_plock
    per_range = 1/(plock - crush)
    per_lock = 1/(1 + h%mu_lock)
    k_elastic = h%k_elastic
    k1 = h%k1
    k2 = h%k2
    k3 = h%k3
    p_crush = h%p_crush
    slope = h%slope
    lock = h%mu_lock
    t = h%t
    !$omp simd private(reached, before, fraction, envelope, unloading, m, dense, partly)
    do i = 1, n
      before = min(max(compaction(i), crush), plock)
      fraction = (before - crush)*per_range
      permanent(i) = before - (p_crush + slope*(before - crush))/(k_elastic + fraction*(k1 - k_elastic))
      compaction(i) = max(compaction(i), compression(i))
      reached = min(max(compaction(i), crush), plock)
      fraction = (reached - crush)*per_range
      unloading = k_elastic + fraction*(k1 - k_elastic)
      envelope = p_crush + slope*(reached - crush)
      permanent(i) = max((reached - envelope/unloading) - permanent(i), 0.0_wp)
      partly = envelope - unloading*(reached - compression(i))
      partly = merge(partly, k_elastic*compression(i), compaction(i) > crush)
      m = (compression(i) - lock)*per_lock
      dense = m*(k1 + max(m, 0.0_wp)*(k2 + max(m, 0.0_wp)*k3))
      pressure(i) = max(merge(dense, partly, compaction(i) > plock), -t*(1 - damage(i)))
    end do
  end subroutine hjc_pressure

  !> Strength, radial return and damage of n particles.
  !>
  !> s* = min(Smax, [A(1-D) + B P*^N][1 + C ln rate*]) for P >= 0; for P < 0 the strength goes linearly from its value at P = 0
  !> to zero at P = -T(1-D). dD = (d e_p + permanent)/max(D1 (P* + T*)^D2, ef_min). From failure_damage on: no deviator, no tension.
  !> trial: equivalent trial stress; strain: equivalent strain increment; dt_rate: time step times the reference strain rate;
  !> volume: at mid step; ratio: what the trial deviator must be multiplied by.
  pure subroutine hjc_return(n, h, shear_modulus, failure_damage, dt_rate, trial, strain, volume, permanent, plastic_strain, &
    damage, &
      plastic_work, pressure, ratio)
    integer, intent(in) :: n
    type(hjc_constants), intent(in) :: h
    real(wp), intent(in) :: shear_modulus, failure_damage, dt_rate, trial(n), strain(n), volume(n), permanent(n)
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n), pressure(n)
    real(wp), intent(out) :: ratio(n)
    real(wp), parameter :: smallest = 1e-12_wp
    real(wp) :: a, b, exponent, c, fc, per_fc, s_max, t, d1, d2, ef_min, inverse, by_shear
    real(wp) :: p, sound, cohesion, friction, strength, increment, fracture(n)
    integer :: i
    a = h%a
    b = h%b
    exponent = h%n
    c = h%c
    fc = h%fc
    per_fc = 1/h%fc
    s_max = h%s_max
    t = h%t
    d1 = h%d1
    d2 = h%d2
    ef_min = h%ef_min
    inverse = 1/dt_rate
    by_shear = 1/(3*shear_modulus)
    if (abs(d2 - 1) <= epsilon(d2)) then
      !$omp simd
      do i = 1, n
        fracture(i) = max(d1*((pressure(i) + t)*per_fc), ef_min)
      end do
    else
      !$omp simd
      do i = 1, n
        fracture(i) = max(d1*exp(d2*log(max((pressure(i) + t)*per_fc, smallest))), ef_min)
      end do
    end if
    !$omp simd private(p, friction)
    do i = 1, n
      p = pressure(i)*per_fc
      friction = b*exp(exponent*log(max(p, smallest)))
      ratio(i) = merge(friction, 0.0_wp, p > smallest)
    end do
    !$omp simd private(p, sound, cohesion, strength, increment)
    do i = 1, n
      sound = 1 - damage(i)
      p = pressure(i)
      cohesion = a*sound*merge(max(1 + p/(t*max(sound, smallest)), 0.0_wp), 1.0_wp, p < 0)
      strength = (cohesion + ratio(i))*(1 + c*log(max(strain(i)*inverse, 1.0_wp)))
      strength = min(strength, s_max)*fc
      increment = max(trial(i) - strength, 0.0_wp)*by_shear
      strength = min(strength, trial(i))
      damage(i) = min(damage(i) + (increment + permanent(i))/fracture(i), 1.0_wp)
      plastic_strain(i) = plastic_strain(i) + increment
      strength = merge(strength, 0.0_wp, damage(i) < failure_damage)
      plastic_work(i) = plastic_work(i) + strength*increment*volume(i)
      pressure(i) = merge(p, max(p, 0.0_wp), damage(i) < failure_damage)
      ratio(i) = strength/max(trial(i), tiny(1.0_wp))
      ratio(i) = merge(ratio(i), merge(1.0_wp, 0.0_wp, damage(i) < failure_damage), trial(i) > 0)
    end do
  end subroutine hjc_return

  !> Largest slope dp/dmu that n particles can meet at their present compression, for the sound speed.
  pure subroutine hjc_modulus(n, h, compression, compaction, modulus)
    integer, intent(in) :: n
    type(hjc_constants), intent(in) :: h
    real(wp), intent(in) :: compression(n), compaction(n)
    real(wp), intent(out) :: modulus(n)
    real(wp) :: fraction, m, per_range, per_lock, crush, plock, lock, k_elastic, k1, k2, k3, slope, dense, partly
    integer :: i
    crush = h%mu_crush
    plock = h%mu_plock
    lock = h%mu_lock
    k_elastic = h%k_elastic
    k1 = h%k1
    k2 = h%k2
    k3 = h%k3
    slope = h%slope
    per_range = 1/(plock - crush)
    per_lock = 1/(1 + lock)
    !$omp simd private(fraction, m, dense, partly)
    do i = 1, n
      fraction = (min(max(compaction(i), crush), plock) - crush)*per_range
      partly = max(k_elastic + fraction*(k1 - k_elastic), slope)
      m = max((compression(i) - lock)*per_lock, 0.0_wp)
      dense = (k1 + m*(2*k2 + m*3*k3))*per_lock
      modulus(i) = merge(dense, partly, compaction(i) > plock)
    end do
  end subroutine hjc_modulus

end module hjc
