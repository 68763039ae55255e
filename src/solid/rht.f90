!> Concrete of Riedel, Hiermaier & Thoma (1999), as Borrvall & Riedel set it down (8th European LS-DYNA Conference, 2011): three
!> surfaces that know the third invariant, hardening, damage, and pores that close along a p-alpha curve.
!>
!> Stars: stresses over fc. Pressure, compression positive, p* = p/fc. Failure surface of the compressive meridian
!>   s_f = A (p* - F/3 + (A/F)^(-1/n))^n              3 p* >= F
!>       = F fs/Q1 + 3 p* (1 - fs/Q1)                 F > 3 p* >= 0
!>       = F fs/Q1 - 3 p* (1/Q2 - fs/(Q1 ft))         0 > 3 p* > 3 p_t
!> times R3 of Willam & Warnke between the meridians, ratio Q = Q0 + B p*; F the rate factor, Q1 = R3(30 degrees, Q0), Q2 = Q0. The
!> elastic surface is g s_f(p*/g), with g rising from Fe Fc (elastic limits gc, gt; cap of the pores) to 1 while the
!> plastic strain rises to e_h = s_f (1 - Fe Fc)/(3 xi G); then damage leads it to the residual surface Af p*^nf.
!> Rate factor F = (rate/static)^b, static 3e-5/s in compression and 3e-6/s in tension, between them along the pressure.
!>
!> Here the rate is that of the whole deviatoric strain. Damage under tension may follow from the dissipated work (crack_band);
!> the elastic surface then begins at the tensile strength.
module rht
  use cell_functions, only: chunk
  use constants, only: third
  use crack_band, only: open_cracks, soften
  use deck_material, only: material_group
  use kinds, only: wp
  use particle_step, only: step_type
  implicit none
  private
  public :: make_rht, rht_stress, rht_modulus

  type, public :: rht_constants
    real(wp) :: fc = 1, fs = 0, ft = 0 !< compressive strength; shear and tensile strength over fc
    real(wp) :: a = 0, n = 1, q0 = 0, b = 0 !< failure surface
    real(wp) :: gc = 1, gt = 1, xi = 1 !< elastic limits; hardening modulus over elastic shear modulus
    real(wp) :: af = 0, nf = 1 !< residual surface
    real(wp) :: d1 = 1, d2 = 1, ef_min = 0 !< damage
    real(wp) :: rate_compression = 0, rate_tension = 0 !< exponents
    real(wp) :: static_compression = 1, static_tension = 1 !< rates where the factors are 1
    real(wp) :: alpha = 1, p_crush = 0, p_comp = 1, n_comp = 1 !< porosity at rest; pores begin and end to close; exponent
    real(wp) :: a1 = 0, a2 = 0, a3 = 0, b0 = 0, b1 = 0, t1 = 0, t2 = 0 !< pressure of the solid between the pores
    real(wp) :: q1 = 1 !< R3 at 30 degrees
    real(wp) :: p_t = 0 !< pressure over fc where the strength vanishes, at F = 1; negative
    real(wp) :: fracture_energy = 0 !< per area of a crack; 0: damage under tension as under compression
  end type rht_constants

contains

  !> Constants from a checked group of the deck.
  pure function make_rht(group) result(c)
    type(material_group), intent(in) :: group
    type(rht_constants) :: c
    c%fc = group%rht_fc
    c%fs = group%rht_fs
    c%ft = group%rht_ft
    c%a = group%rht_a
    c%n = group%rht_n
    c%q0 = group%rht_q0
    c%b = group%rht_b
    c%gc = group%rht_gc
    c%gt = group%rht_gt
    c%xi = group%rht_xi
    c%af = group%rht_af
    c%nf = group%rht_nf
    c%d1 = group%rht_d1
    c%d2 = group%rht_d2
    c%ef_min = group%rht_ef_min
    c%rate_compression = group%rht_beta_c
    c%rate_tension = group%rht_beta_t
    c%static_compression = 3e-5_wp*group%per_second
    c%static_tension = 3e-6_wp*group%per_second
    c%alpha = group%rht_alpha
    c%p_crush = group%rht_p_crush
    c%p_comp = group%rht_p_lock
    c%n_comp = group%rht_n_compaction
    c%a1 = group%rht_a1
    c%a2 = group%rht_a2
    c%a3 = group%rht_a3
    c%b0 = group%rht_b0
    c%b1 = group%rht_b1
    c%t1 = group%rht_t1
    c%t2 = group%rht_t2
    if (group%failure == 'fracture_energy') then
      c%fracture_energy = group%fracture_energy
      c%gt = 1
    end if
    c%q1 = willam_warnke(sqrt(0.75_wp), c%q0)
    c%p_t = c%q0*c%fs*c%ft/(3*(c%q1*c%ft - c%q0*c%fs))
  end function make_rht

  !> Radius of the deviatoric section over that of the compressive meridian; x: cosine of the Lode angle, 1 in tension, 1/2 in
  !> compression; q: ratio of the meridians.
  pure real(wp) function willam_warnke(x, q)
    real(wp), intent(in) :: x, q
    real(wp) :: c
    c = 4*(1 - q*q)*x*x
    willam_warnke = (2*(1 - q*q)*x + (2*q - 1)*sqrt(max(c + 5*q*q - 4*q, 0.0_wp)))/(c + (1 - 2*q)**2)
  end function willam_warnke

  !> Pressure, factor of the deviator and state of n particles. own: columns of this model, the part of alpha - 1 that has closed
  !> and, with a fracture energy, the opening of the cracks. energy: at the start of the step, as the work of the deviator comes
  !> later. At D = 1 there is no tension any more, and the friction of the residual surface stays.
  pure subroutine rht_stress(n, c, shear_modulus, s, capacity, energy, plastic_strain, damage, plastic_work, own)
    integer, intent(in) :: n, capacity
    type(rht_constants), intent(in) :: c
    real(wp), intent(in) :: shear_modulus, energy(n)
    type(step_type), intent(inout) :: s
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n)
    real(wp), intent(inout) :: own(capacity, *)
    real(wp), dimension(chunk) :: factor_c, factor_t, crush, limit, opened, before, lode, work
    integer :: i
    call rate_factors(n, c, s%dt, s%strain, factor_c, factor_t)
    call close_pores(n, c, s%compression, energy, s%old_volume, s%volume, s%old_pressure, s%viscosity, own(1, 1), s%pressure, &
      crush)
    do i = 1, n
      limit(i) = -c%p_t*c%fc*factor_t(i)*(1 - damage(i))
    end do
    if (c%fracture_energy > 0) then
      call open_cracks(n, c%a1/c%alpha, limit, own(1, 2), s%pressure, opened)
    else
      do i = 1, n
        s%pressure(i) = max(s%pressure(i), -limit(i))
      end do
    end if
    before(:n) = plastic_work
    call lode_cosine(n, s%deviator, s%trial, lode)
    call rht_return(n, c, shear_modulus, s%trial, lode, s%middle, factor_c, factor_t, crush, s%pressure, plastic_strain, damage, &
      plastic_work, s%ratio)
    if (c%fracture_energy > 0) then
      do i = 1, n
        work(i) = merge((plastic_work(i) - before(i))/s%middle(i) + limit(i)*opened(i), 0.0_wp, s%pressure(i) < 0)
      end do
      call soften(n, c%fracture_energy/s%length, work, damage)
    end if
  end subroutine rht_stress

  pure subroutine rate_factors(n, c, dt, strain, factor_c, factor_t)
    integer, intent(in) :: n
    type(rht_constants), intent(in) :: c
    real(wp), intent(in) :: dt, strain(n)
    real(wp), intent(out) :: factor_c(n), factor_t(n)
    real(wp) :: by_c, by_t, beta_c, beta_t
    integer :: i
    by_c = 1/(dt*c%static_compression)
    by_t = 1/(dt*c%static_tension)
    beta_c = c%rate_compression
    beta_t = c%rate_tension
    !$omp simd
    do i = 1, n
      factor_c(i) = exp(beta_c*log(max(strain(i)*by_c, 1.0_wp)))
      factor_t(i) = exp(beta_t*log(max(strain(i)*by_t, 1.0_wp)))
    end do
  end subroutine rate_factors

  !> Cosine of the Lode angle of the deviator: 1 in tension, 1/2 in compression.
  pure subroutine lode_cosine(n, t, trial, lode)
    integer, intent(in) :: n
    real(wp), intent(in) :: t(chunk, 6), trial(n)
    real(wp), intent(out) :: lode(n)
    real(wp) :: det, q, d1, d2, d3, d4, d5, d6
    integer :: i
    !$omp simd private(det, q, d1, d2, d3, d4, d5, d6)
    do i = 1, n
      q = 1/max(trial(i), 1e-90_wp)
      d1 = t(i, 1)*q
      d2 = t(i, 2)*q
      d3 = t(i, 3)*q
      d4 = t(i, 4)*q
      d5 = t(i, 5)*q
      d6 = t(i, 6)*q
      det = d1*(d2*d3 - d4*d4) - d6*(d6*d3 - d4*d5) + d5*(d6*d4 - d2*d5)
      lode(i) = cos(acos(max(min(13.5_wp*det, 1.0_wp), -1.0_wp))*third)
    end do
  end subroutine lode_cosine

  !> Pressure after the pores have closed as far as it needs; crush: the pressure at which they go on closing.
  !>
  !> alpha never opens again; where p(r, alpha) would exceed p_comp - (p_comp - p_crush) x, x = ((alpha - 1)/(alpha_0 - 1))^(1/n),
  !> both are equal, found by Newton's method in x. The thermal part of the pressure holds the energy at the end of the step, as
  !> in particle_fluid.
  pure subroutine close_pores(n, c, compression, energy, old_volume, volume, old_pressure, viscosity, closed, pressure, crush)
    integer, intent(in) :: n
    type(rht_constants), intent(in) :: c
    real(wp), intent(in), dimension(n) :: compression, energy, old_volume, volume, old_pressure, viscosity
    real(wp), intent(inout) :: closed(n)
    real(wp), intent(out) :: pressure(n), crush(n)
    real(wp), parameter :: smallest = 1e-12_wp
    real(wp), dimension(chunk) :: thermal, change, x, most, excess
    real(wp) :: rest, range, power, alpha, eta, solid, slope, coupling, of_x, tolerance
    integer :: i, iteration
    rest = c%alpha
    range = c%p_comp - c%p_crush
    tolerance = 1e-9_wp*c%p_crush
    power = c%n_comp
    !$omp simd
    do i = 1, n
      change(i) = 0.5_wp*(old_volume(i) - volume(i))/volume(i)
      thermal(i) = energy(i)/volume(i) + change(i)*(old_pressure(i) + 2*viscosity(i))
      x(i) = exp(log(max(1 - closed(i)/(rest - 1), smallest))/power)
      most(i) = x(i)
    end do
    do iteration = 0, 8
      !$omp simd private(alpha, eta, solid, slope, coupling)
      do i = 1, n
        alpha = 1 + (rest - 1)*exp(power*log(x(i)))
        eta = alpha*(1 + compression(i))/rest - 1
        solid = eta*merge(c%a1 + eta*(c%a2 + eta*c%a3), c%t1 + eta*c%t2, eta > 0)/alpha
        coupling = c%b0 + merge(c%b1*eta, 0.0_wp, eta > 0)
        pressure(i) = (solid + coupling*thermal(i))/(1 - coupling*change(i))
        crush(i) = c%p_comp - range*x(i)
        excess(i) = pressure(i) - crush(i)
      end do
      if (iteration == 8) exit
      if (.not. any(excess(:n) > tolerance .or. (excess(:n) < -tolerance .and. x(:n) < most(:n)))) exit
      !$omp simd private(alpha, eta, solid, slope, of_x)
      do i = 1, n
        alpha = 1 + (rest - 1)*exp(power*log(x(i)))
        eta = alpha*(1 + compression(i))/rest - 1
        solid = eta*(c%a1 + eta*(c%a2 + eta*c%a3))/alpha
        slope = (c%a1 + eta*(2*c%a2 + eta*3*c%a3))*(1 + compression(i))/rest/alpha - solid/alpha
        of_x = slope*(alpha - 1)*power/x(i) + range
        x(i) = max(min(x(i) - excess(i)/of_x, most(i)), smallest)
      end do
    end do
    !$omp simd
    do i = 1, n
      closed(i) = max(closed(i), (rest - 1)*(1 - exp(power*log(x(i)))))
    end do
  end subroutine close_pores

  !> Strength, return, hardening and damage of n particles.
  pure subroutine rht_return(n, c, shear_modulus, trial, lode, volume, factor_c, factor_t, crush, pressure, plastic_strain, &
      damage, plastic_work, ratio)
    integer, intent(in) :: n
    type(rht_constants), intent(in) :: c
    real(wp), intent(in) :: shear_modulus
    real(wp), intent(in), dimension(n) :: trial, lode, volume, factor_c, factor_t, crush, pressure
    real(wp), intent(inout), dimension(n) :: plastic_strain, damage, plastic_work
    real(wp), intent(out) :: ratio(n)
    real(wp), parameter :: smallest = 1e-12_wp
    real(wp), dimension(chunk) :: elastic, surface, scaled, section, residual, full, one
    real(wp) :: fc, per_fc, ft, q0, qb, gc, gt, af, nf, d1, d2, ef_min, p_t, xi_shear, by_shear
    real(wp) :: p, f_c, f_t, low, high, cap, p_u, p_0, q, x, root, hardening, strength, increment, fracture, sound, work_hard
    logical :: by_work
    integer :: i
    by_work = c%fracture_energy > 0
    fc = c%fc; per_fc = 1/c%fc; ft = c%ft; q0 = c%q0; qb = c%b
    gc = c%gc; gt = c%gt; af = c%af; nf = c%nf; d1 = c%d1; d2 = c%d2; ef_min = c%ef_min; p_t = c%p_t
    xi_shear = c%xi*shear_modulus*3
    by_shear = 1/(3*shear_modulus)
    ! elastic limit over failure surface, and the section between the meridians
    !$omp simd private(p, f_c, f_t, low, high, p_u, p_0, cap, q, x, root)
    do i = 1, n
      p = pressure(i)*per_fc
      f_c = factor_c(i)
      f_t = factor_t(i)
      low = -f_t*gt*ft
      high = f_c*gc
      x = max(min((3*p - low)/(high - low), 1.0_wp), 0.0_wp)
      p_u = f_c*gc/3 + shear_modulus*plastic_strain(i)*per_fc
      p_0 = crush(i)*per_fc
      cap = max(min((p - p_u)/max(p_0 - p_u, smallest), 1.0_wp), 0.0_wp)
      elastic(i) = max((gt + x*(gc - gt))*sqrt(1 - cap*cap), 1e-3_wp)
      q = max(min(q0 + qb*p, 1.0_wp), 0.51_wp)
      x = lode(i)
      root = sqrt(max(4*(1 - q*q)*x*x + 5*q*q - 4*q, 0.0_wp))
      section(i) = (2*(1 - q*q)*x + (2*q - 1)*root)/(4*(1 - q*q)*x*x + (1 - 2*q)*(1 - 2*q))
    end do
    one(:n) = 1
    call failure_surface(n, c, pressure, one, factor_c, factor_t, full)
    ! hardening: the plastic strain from the elastic to the failure surface, and how far it has come
    !$omp simd private(hardening)
    do i = 1, n
      hardening = full(i)*section(i)*fc*(1 - elastic(i))/xi_shear
      hardening = min(plastic_strain(i)/max(hardening, smallest), 1.0_wp)
      scaled(i) = elastic(i) + (1 - elastic(i))*hardening
    end do
    call failure_surface(n, c, pressure, scaled, factor_c, factor_t, surface)
    !$omp simd private(p)
    do i = 1, n
      p = pressure(i)*per_fc
      residual(i) = merge(af*exp(nf*log(max(p, smallest))), 0.0_wp, p > smallest)
    end do
    !$omp simd private(p, sound, strength, increment, fracture, work_hard)
    do i = 1, n
      p = pressure(i)*per_fc
      sound = 1 - damage(i)
      strength = (scaled(i)*surface(i)*section(i)*sound + residual(i)*damage(i))*fc
      increment = max(trial(i) - strength, 0.0_wp)*by_shear
      strength = min(strength, trial(i))
      fracture = max(d1*exp(d2*log(max(p - sound*p_t*factor_t(i), smallest))), ef_min)
      work_hard = merge(0.0_wp, 1.0_wp, scaled(i) < 1 - 1e-6_wp .or. (by_work .and. p < 0))
      damage(i) = min(damage(i) + work_hard*increment/fracture, 1.0_wp)
      plastic_strain(i) = plastic_strain(i) + increment
      plastic_work(i) = plastic_work(i) + strength*increment*volume(i)
      ratio(i) = merge(strength/max(trial(i), tiny(1.0_wp)), 1.0_wp, trial(i) > 0)
    end do
  end subroutine rht_return

  !> s_f at p*/part of each particle.
  pure subroutine failure_surface(n, c, pressure, part, factor_c, factor_t, surface)
    integer, intent(in) :: n
    type(rht_constants), intent(in) :: c
    real(wp), intent(in) :: pressure(n), part(n), factor_c(n), factor_t(n)
    real(wp), intent(out) :: surface(n)
    real(wp) :: at_zero, per_exponent, tension, exponent, a, ft, per_fc, p, f_c, f_t, fr, x
    integer :: i
    a = c%a
    ft = c%ft
    exponent = c%n
    per_fc = 1/c%fc
    at_zero = c%fs/c%q1
    tension = 1/c%q0 - c%fs/(c%q1*ft)
    per_exponent = -1/exponent
    !$omp simd private(p, f_c, f_t, fr, x)
    do i = 1, n
      f_c = factor_c(i)
      f_t = factor_t(i)
      p = pressure(i)*per_fc/part(i)
      x = max(min((3*p + f_t*ft)/(f_c + f_t*ft), 1.0_wp), 0.0_wp)
      fr = f_t + x*(f_c - f_t)
      x = max(p - fr/3, 0.0_wp) + exp(per_exponent*log(a/fr))
      x = a*exp(exponent*log(x))
      x = merge(x, fr*at_zero + 3*p*(1 - at_zero), 3*p >= fr)
      surface(i) = merge(x, max(fr*at_zero - 3*p*tension, 0.0_wp), p >= 0)
    end do
  end subroutine failure_surface

  !> Largest slope dp/dmu that n particles can meet at their present compression, for the sound speed.
  pure subroutine rht_modulus(n, c, compression, energy, volume, closed, modulus)
    integer, intent(in) :: n
    type(rht_constants), intent(in) :: c
    real(wp), intent(in), dimension(n) :: compression, energy, volume, closed
    real(wp), intent(out) :: modulus(n)
    real(wp) :: rest, a1, a2, a3, b0, b1, t1, alpha, eta, heat, solid
    integer :: i
    rest = c%alpha
    a1 = c%a1; a2 = c%a2; a3 = c%a3; b0 = c%b0; b1 = c%b1; t1 = c%t1
    !$omp simd private(alpha, eta, heat, solid)
    do i = 1, n
      alpha = rest - closed(i)
      eta = max(alpha*(1 + compression(i))/rest - 1, 0.0_wp)
      heat = max(energy(i)/volume(i), 0.0_wp)
      solid = eta*(a1 + eta*(a2 + eta*a3))/alpha + (b0 + b1*eta)*heat
      ! dp/dmu at constant energy and (p/r) dp/de, the density being r0 (1 + mu)
      modulus(i) = max(a1 + eta*(2*a2 + eta*3*a3), t1)/rest + (b0 + b1*(1 + 2*eta))*heat/(1 + compression(i)) &
        + solid*(b0 + b1*eta)/(1 + compression(i))
    end do
  end subroutine rht_modulus

end module rht
