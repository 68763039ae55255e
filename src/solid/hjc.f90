!> Concrete of Holmquist, Johnson & Cook (1993): pressure-dependent strength, damage, and compaction of the pores.
!>
!> Signs: pressure and compression mu = r/r0 - 1 are positive in compression. The bulk modulus below crushing is
!> K_e = p_crush/mu_crush, which need not agree with E/(3(1-2 nu)); E and nu give the shear modulus only.
!>
!> Beside the paper's rules: the tensile limit T may rise with the strain rate (tension_rate), and damage under tension may follow
!> from the dissipated work instead of the plastic strain (crack_band).
module hjc
  use cell_functions, only: chunk
  use constants, only: unset
  use crack_band, only: open_cracks, soften
  use deck_material, only: material_group
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp
  use particle_step, only: step_type
  use tension_rate, only: tension_rate_type, make_tension_rate, tension_factor
  use text, only: str
  implicit none
  private
  public :: make_hjc, hjc_stress, hjc_modulus, lock_compression

  !> Constants of the concrete of Holmquist, Johnson & Cook (1993), named as there.
  type, public :: hjc_constants
    real(wp) :: a = 0, b = 0, n = 1, c = 0 !< strength
    real(wp) :: fc = 1, s_max = 0, t = 0 !< compressive strength, largest normalised strength, tensile pressure
    real(wp) :: d1 = 1, d2 = 1, ef_min = 0 !< damage
    real(wp) :: p_crush = 0, mu_crush = 1, p_lock = 0, mu_lock = 0 !< compaction
    real(wp) :: k1 = 0, k2 = 0, k3 = 0 !< fully dense material
    real(wp) :: k_elastic = 0 !< bulk modulus below crushing: p_crush/mu_crush
    real(wp) :: mu_plock = 1 !< compression at which p_lock is reached
    real(wp) :: slope = 0 !< of the compaction line: (p_lock - p_crush)/(mu_plock - mu_crush)
    real(wp) :: reference_strain_rate = 1
    type(tension_rate_type) :: rate !< of T
    real(wp) :: fracture_energy = 0 !< per area of a crack; 0: damage under tension by the paper's rule
  end type hjc_constants

contains

  !> Constants from a checked group of the deck.
  function make_hjc(group) result(h)
    type(material_group), intent(in) :: group
    type(hjc_constants) :: h
    h%a = group%hjc_a
    h%b = group%hjc_b
    h%n = group%hjc_n
    h%c = group%hjc_c
    h%fc = group%hjc_fc
    h%s_max = group%hjc_smax
    h%t = group%hjc_t
    h%d1 = group%hjc_d1
    h%d2 = group%hjc_d2
    h%ef_min = group%hjc_ef_min
    h%p_crush = group%hjc_p_crush
    h%mu_crush = group%hjc_mu_crush
    h%k1 = group%hjc_k1
    h%k2 = group%hjc_k2
    h%k3 = group%hjc_k3
    h%p_lock = group%hjc_p_lock
    h%k_elastic = h%p_crush/h%mu_crush
    call lock_compression(h, group%hjc_mu_lock, group%hjc_lock_strain == 'plastic_lock')
    if (h%mu_plock <= h%mu_crush .or. h%p_lock <= h%p_crush) call fatal("material '"//trim(group%name)// &
      "': hjc: locking (mu "//str(h%mu_plock)//") must come after crushing (mu "//str(h%mu_crush)//')', exit_bad_input)
    h%slope = (h%p_lock - h%p_crush)/(h%mu_plock - h%mu_crush)
    if (group%reference_strain_rate > unset) h%reference_strain_rate = group%reference_strain_rate
    h%rate = make_tension_rate(trim(group%tensile_rate_factor), h%fc/group%ten_megapascal, group%per_second)
    if (group%failure == 'fracture_energy') h%fracture_energy = group%fracture_energy
  end function make_hjc

  !> Fills mu_lock and mu_plock from the one that is given and p_lock = K1 m + K2 m^2 + K3 m^3, m = (mu_plock - mu_lock)/(1 +
  !> mu_lock).
  !>
  !> given: mu_plock where at_pressure, else mu_lock (the reading of Holmquist, Johnson & Cook 1993).
  pure subroutine lock_compression(h, given, at_pressure)
    type(hjc_constants), intent(inout) :: h
    real(wp), intent(in) :: given
    logical, intent(in) :: at_pressure
    real(wp) :: m, step
    integer :: iteration
    m = h%p_lock/h%k1
    do iteration = 1, 50
      step = (h%p_lock - m*(h%k1 + m*(h%k2 + m*h%k3)))/(h%k1 + m*(2*h%k2 + m*3*h%k3))
      m = m + step
      if (abs(step) <= 1e-15_wp*abs(m)) exit
    end do
    if (at_pressure) then
      h%mu_plock = given
      h%mu_lock = (given - m)/(1 + m)
    else
      h%mu_lock = given
      h%mu_plock = given + m*(1 + given)
    end if
  end subroutine lock_compression

  !> Pressure, factor of the deviator and state of n particles. own: columns of this model, largest compression so far and, with a
  !> fracture energy, opening of the cracks.
  pure subroutine hjc_stress(n, h, shear_modulus, failure_damage, s, capacity, plastic_strain, damage, plastic_work, own)
    integer, intent(in) :: n, capacity
    type(hjc_constants), intent(in) :: h
    real(wp), intent(in) :: shear_modulus, failure_damage
    type(step_type), intent(inout) :: s
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n)
    real(wp), intent(inout) :: own(capacity, *)
    real(wp), dimension(chunk) :: tension, permanent, opened, work
    call tension_factor(n, h%rate, s%dt, s%shear, s%old_volume, s%volume, tension)
    call hjc_pressure(n, h, s%compression, own(1, 1), s%pressure, permanent)
    if (h%fracture_energy > 0) then
      call tensile_limit(n, h%t, damage, tension)
      work(:n) = plastic_work
      call open_cracks(n, h%k_elastic, tension, own(1, 2), s%pressure, opened)
      call hjc_return(n, h, .true., shear_modulus, failure_damage, s%dt*h%reference_strain_rate, s%trial, s%strain, s%middle, &
        permanent, tension, plastic_strain, damage, plastic_work, s%pressure, s%ratio)
      call crack(n, h%fracture_energy/s%length, failure_damage, tension, opened, s%middle, plastic_work, work, damage, &
        s%pressure, s%ratio)
    else
      call limit_pressure(n, h%t, damage, tension, s%pressure)
      call hjc_return(n, h, .false., shear_modulus, failure_damage, s%dt*h%reference_strain_rate, s%trial, s%strain, s%middle, &
        permanent, tension, plastic_strain, damage, plastic_work, s%pressure, s%ratio)
    end if
  end subroutine hjc_stress

  !> From factors of the strain rate to the tensile limit T (1 - D) of each particle.
  pure subroutine tensile_limit(n, t, damage, tension)
    integer, intent(in) :: n
    real(wp), intent(in) :: t, damage(n)
    real(wp), intent(inout) :: tension(n)
    integer :: i
    !$omp simd
    do i = 1, n
      tension(i) = t*tension(i)*(1 - damage(i))
    end do
  end subroutine tensile_limit

  !> The same, and no tension beyond it.
  pure subroutine limit_pressure(n, t, damage, tension, pressure)
    integer, intent(in) :: n
    real(wp), intent(in) :: t, damage(n)
    real(wp), intent(inout) :: tension(n), pressure(n)
    integer :: i
    !$omp simd
    do i = 1, n
      tension(i) = t*tension(i)*(1 - damage(i))
      pressure(i) = max(pressure(i), -tension(i))
    end do
  end subroutine limit_pressure

  !> Damage by the work of cracks. before: plastic work at the start of the step.
  pure subroutine crack(n, energy, failure_damage, tension, opened, middle, plastic_work, before, damage, pressure, ratio)
    integer, intent(in) :: n
    real(wp), intent(in) :: energy, failure_damage, tension(n), opened(n), middle(n), plastic_work(n), before(n)
    real(wp), intent(inout) :: damage(n), pressure(n), ratio(n)
    real(wp) :: work(chunk)
    integer :: i
    !$omp simd
    do i = 1, n
      work(i) = merge((plastic_work(i) - before(i))/middle(i) + tension(i)*opened(i), 0.0_wp, pressure(i) < 0)
    end do
    call soften(n, energy, work, damage)
    !$omp simd
    do i = 1, n
      pressure(i) = merge(pressure(i), max(pressure(i), 0.0_wp), damage(i) < failure_damage)
      ratio(i) = merge(ratio(i), 0.0_wp, damage(i) < failure_damage)
    end do
  end subroutine crack

  !> Pressure of n particles after the compression mu has been reached; compaction (largest mu so far) is brought up to date.
  !>
  !> Envelope: K_e mu up to mu_crush, a straight line to (mu_plock, p_lock), then K1 m + K2 m^2 + K3 m^3 with
  !> m = (mu - mu_lock)/(1 + mu_lock). Between crushing and locking a particle unloads and reloads along a straight line whose slope
  !> goes linearly from K_e to K1; fully dense material follows the polynomial both ways, K1 m in tension. The limit of tension
  !> comes after it. permanent: growth in this step of the compression that would remain at zero pressure.
  pure subroutine hjc_pressure(n, h, compression, compaction, pressure, permanent)
    integer, intent(in) :: n
    type(hjc_constants), intent(in) :: h
    real(wp), intent(in) :: compression(n)
    real(wp), intent(inout) :: compaction(n)
    real(wp), intent(out) :: pressure(n), permanent(n)
    real(wp) :: crush, plock, per_range, per_lock, k_elastic, k1, k2, k3, p_crush, slope, lock
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
      pressure(i) = merge(dense, partly, compaction(i) > plock)
    end do
  end subroutine hjc_pressure

  !> Strength, radial return and damage of n particles.
  !>
  !> s* = min(Smax, [A(1-D) + B P*^N][1 + C ln rate*]) for P >= 0; for P < 0 the strength goes linearly from its value at P = 0
  !> to zero at P = -T(1-D), `tension`. dD = (d e_p + permanent)/max(D1 (P* + T*)^D2, ef_min). Failed particles: no deviator, no
  !> tension.
  !> trial: equivalent trial stress; strain: equivalent strain increment; dt_rate: time step times the reference strain rate;
  !> volume: at mid step; ratio: what the trial deviator must be multiplied by; by_work: damage under tension follows from the work
  !> and not from here.
  pure subroutine hjc_return(n, h, by_work, shear_modulus, failure_damage, dt_rate, trial, strain, volume, permanent, tension, &
      plastic_strain, damage, plastic_work, pressure, ratio)
    integer, intent(in) :: n
    type(hjc_constants), intent(in) :: h
    logical, intent(in) :: by_work
    real(wp), intent(in) :: shear_modulus, failure_damage, dt_rate, trial(n), strain(n), volume(n), permanent(n), tension(n)
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n), pressure(n)
    real(wp), intent(out) :: ratio(n)
    real(wp), parameter :: smallest = 1e-12_wp
    real(wp) :: a, b, exponent, c, fc, per_fc, s_max, t, d1, d2, ef_min, inverse, by_shear, least
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
    least = t*smallest
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
    if (by_work) then
      !$omp simd
      do i = 1, n
        fracture(i) = merge(fracture(i), huge(1.0_wp), pressure(i) >= 0)
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
      cohesion = a*sound*merge(max(1 + p/max(tension(i), least), 0.0_wp), 1.0_wp, p < 0)
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
