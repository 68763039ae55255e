!> Stress, energy, density and state of particles from the velocity gradient of one step; up to `chunk` particles per call.
!>
!> The order is the same for every model: strain and Jaumann rotation give a trial deviator (particle_step); the model gives the
!> pressure and the factor that brings the trial deviator back to its yield surface; then stress, energy and volume follow. Metals
!> take their yield stress and their pressure from laws that are chosen apart. A model has its own file and one line here.
module stress_update
  use cell_functions, only: chunk
  use constants, only: third
  use crack_band, only: soften
  use drucker_prager, only: drucker_prager_stress, sliding_modulus
  use elastic, only: elastic_pressure, elastic_ratio, limit_tension
  use hjc, only: hjc_stress, hjc_modulus
  use johnson_cook, only: johnson_cook_yield
  use johnson_cook_damage, only: accumulate_damage
  use kinds, only: wp
  use linear_hardening, only: linear_yield
  use neo_hookean, only: neo_hookean_stress, neo_hookean_modulus
  use particle_fluid, only: fluid_pressure, fluid_sound_speed
  use particle_step, only: step_type, strain_and_rotate, bulk_viscosity, deviator_work, set_stress
  use particles, only: at_velocity, at_mass, at_volume, at_stress, at_energy, at_viscosity, at_plastic_strain, at_damage, &
    at_plastic_work
  use perfect_plasticity, only: perfect_yield
  use radial_return, only: return_to_yield
  use rht, only: rht_stress, rht_modulus
  use simplified_johnson_cook, only: simplified_johnson_cook_yield
  use solid_material, only: solid_material_type, model_elastic, model_perfect_plasticity, model_linear_hardening, &
    model_johnson_cook, model_simplified_johnson_cook, model_hjc, model_rht, model_drucker_prager, model_neo_hookean, model_fluid, &
    pressure_eos
  use strength_factors, only: factors_of, to_reference, from_reference, reference_compression
  implicit none
  private
  public :: update_stress, signal_speeds

contains

  !> Advances particles first..first+n-1 by dt. gradient(:,3*(i-1)+j) = dt dv_i/dx_j; length: of a cell, for the bulk viscosity
  !> and the fracture energy.
  pure subroutine update_stress(m, dt, length, n, capacity, n_field, f, first, gradient)
    type(solid_material_type), intent(in) :: m
    real(wp), intent(in) :: dt, length
    integer, intent(in) :: n, capacity, n_field, first
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp), intent(in) :: gradient(chunk, 9)
    type(step_type) :: s
    real(wp), dimension(chunk) :: strength, stiffness, work
    s%dt = dt
    s%length = length
    call sound_at_start(m, n, capacity, n_field, f, first, s)
    call strain_and_rotate(n, m%shear_modulus, m%density, gradient, f(first, at_stress), f(first, at_stress + 1), &
      f(first, at_stress + 2), f(first, at_stress + 3), f(first, at_stress + 4), f(first, at_stress + 5), f(first, at_mass), &
      f(first, at_volume), s%deviator, s%trial, s%power, s%shear, s%strain, s%old_pressure, s%old_volume, s%volume, s%middle, &
      s%compression)
    call bulk_viscosity(n, dt, length, m%linear_viscosity, m%quadratic_viscosity, s%speed, f(first, at_mass), s%old_volume, &
      s%volume, s%viscosity)
    if (m%at_strength > 0) then
      call factors_of(n, capacity, f, first, m%at_strength, m%at_stiffness, strength, stiffness)
      call to_reference(n, strength, stiffness, m%shear_modulus, gradient, s%deviator, s%trial, s%power, s%shear, s%strain, &
        s%old_pressure, s%compression, s%viscosity, f(first, at_energy), f(first, at_plastic_strain), &
        f(first, at_plastic_work), work)
    end if
    select case (m%model)
    case (model_neo_hookean)
      call neo_hookean_stress(n, m%bulk_modulus, m%shear_modulus, m%density, gradient, f(first, at_mass), s%old_volume, s%volume, &
        s%viscosity, capacity, f(first, m%at_own), f(first, at_volume), f(first, at_energy), f(first, at_viscosity), &
        f(first, at_stress), f(first, at_stress + 1), f(first, at_stress + 2), f(first, at_stress + 3), f(first, at_stress + 4), &
        f(first, at_stress + 5))
    case (model_fluid)
      s%ratio(:n) = 0
      call fluid_pressure(n, m%eos, f(first, at_mass), s%old_volume, s%volume, f(first, at_energy), s%old_pressure, s%viscosity, &
        s%pressure)
    case (model_hjc)
      call hjc_stress(n, m%hjc, m%shear_modulus, m%failure_damage, s, capacity, f(first, at_plastic_strain), &
        f(first, at_damage), f(first, at_plastic_work), f(first, m%at_own))
    case (model_rht)
      call rht_stress(n, m%rht, m%shear_modulus, s, capacity, f(first, at_energy), f(first, at_plastic_strain), &
        f(first, at_damage), f(first, at_plastic_work), f(first, m%at_own))
    case (model_drucker_prager)
      call drucker_prager_stress(n, m%drucker_prager, m%bulk_modulus, m%shear_modulus, m%failure_strain, m%failure_damage, s, &
        f(first, at_plastic_strain), f(first, at_damage), f(first, at_plastic_work), f(first, m%at_own))
    case default
      call metal_deviator(m, n, f(first, at_mass), f(first, at_plastic_strain), f(first, at_damage), f(first, at_plastic_work), s)
      call metal_pressure(m, n, f(first, at_mass), f(first, at_energy), f(first, at_damage), s)
    end select
    if (m%at_strength > 0) call from_reference(n, strength, stiffness, work, s%deviator, s%power, s%shear, s%old_pressure, &
      s%viscosity, s%pressure, f(first, at_energy), f(first, at_plastic_strain), f(first, at_plastic_work))
    if (m%model /= model_neo_hookean) call set_stress(n, m%shear_modulus, s%deviator, s%ratio, s%pressure, s%power, s%shear, &
      s%old_pressure, s%viscosity, s%volume, s%middle, f(first, at_volume), f(first, at_energy), f(first, at_viscosity), &
      f(first, at_stress), f(first, at_stress + 1), f(first, at_stress + 2), f(first, at_stress + 3), f(first, at_stress + 4), &
      f(first, at_stress + 5))
  end subroutine update_stress

  !> Longitudinal sound speed before the step, for the bulk viscosity: that at rest, except where an equation of state gives more.
  pure subroutine sound_at_start(m, n, capacity, n_field, f, first, s)
    type(solid_material_type), intent(in) :: m
    integer, intent(in) :: n, capacity, n_field, first
    real(wp), intent(in) :: f(capacity, n_field)
    type(step_type), intent(inout) :: s
    real(wp) :: shear
    integer :: i
    if (m%pressure /= pressure_eos) then
      s%speed(:n) = m%sound_speed
      return
    end if
    call fluid_sound_speed(n, m%eos, f(first, at_mass), f(first, at_volume), f(first, at_energy), s%speed)
    shear = 4*third*m%shear_modulus/m%density
    !$omp simd
    do i = 1, n
      s%speed(i) = sqrt(s%speed(i)*s%speed(i) + shear)
    end do
  end subroutine sound_at_start

  !> Yield stress of a metal, return to it, damage.
  pure subroutine metal_deviator(m, n, mass, plastic_strain, damage, plastic_work, s)
    type(solid_material_type), intent(in) :: m
    integer, intent(in) :: n
    real(wp), intent(in) :: mass(n)
    real(wp), intent(inout) :: plastic_strain(n), damage(n), plastic_work(n)
    type(step_type), intent(inout) :: s
    real(wp) :: yield(chunk), before(chunk), dt_rate, failure_strain
    integer :: i
    dt_rate = s%dt*m%reference_strain_rate
    select case (m%model)
    case (model_elastic)
      call elastic_ratio(n, m%failure_damage, damage, s%ratio)
      return
    case (model_perfect_plasticity)
      call perfect_yield(n, m%yield_stress, yield)
    case (model_linear_hardening)
      call linear_yield(n, m%yield_stress, m%hardening_modulus, plastic_strain, yield)
    case (model_simplified_johnson_cook)
      call simplified_johnson_cook_yield(n, m%jc_a, m%jc_b, m%jc_n, m%jc_c, dt_rate, s%strain, plastic_strain, yield)
    case (model_johnson_cook)
      call johnson_cook_yield(n, m%jc_a, m%jc_b, m%jc_n, m%jc_c, m%jc_m, m%taylor_quinney/m%specific_heat, &
        m%reference_temperature, m%melt_temperature, dt_rate, s%strain, plastic_strain, plastic_work, mass, yield)
    end select
    if (m%jc_damage%active) before(:n) = plastic_strain
    failure_strain = m%failure_strain
    if (m%fracture_energy > 0) then
      failure_strain = huge(failure_strain)
      before(:n) = plastic_work
      !$omp simd
      do i = 1, n
        yield(i) = yield(i)*(1 - damage(i))
      end do
    end if
    call return_to_yield(n, m%shear_modulus, m%hardening_modulus, m%ultimate_stress, failure_strain, m%failure_damage, yield, &
      s%trial, s%middle, plastic_strain, damage, plastic_work, s%ratio)
    if (m%jc_damage%active) call accumulate_damage(n, m%jc_damage, dt_rate, s%strain, before, plastic_strain, plastic_work, mass, &
      s%old_pressure, s%trial, s%ratio, damage)
    if (m%fracture_energy > 0) then
      do i = 1, n
        yield(i) = merge((plastic_work(i) - before(i))/s%middle(i), 0.0_wp, plastic_strain(i) > m%failure_strain)
      end do
      call soften(n, m%fracture_energy/s%length, yield, damage)
    end if
  end subroutine metal_deviator

  !> Pressure of a metal and its limit of tension; after the deviator, whose work heats.
  pure subroutine metal_pressure(m, n, mass, energy, damage, s)
    type(solid_material_type), intent(in) :: m
    integer, intent(in) :: n
    real(wp), intent(in) :: mass(n), energy(n)
    real(wp), intent(inout) :: damage(n)
    type(step_type), intent(inout) :: s
    real(wp) :: work(chunk)
    integer :: i
    if (m%pressure == pressure_eos) then
      call deviator_work(n, m%shear_modulus, s%ratio, s%power, s%shear, s%middle, work)
      !$omp simd
      do i = 1, n
        work(i) = energy(i) + work(i)
      end do
      call fluid_pressure(n, m%eos, mass, s%old_volume, s%volume, work, s%old_pressure, s%viscosity, s%pressure)
    else
      call elastic_pressure(n, m%bulk_modulus, s%compression, s%pressure)
    end if
    call limit_tension(n, m%tensile_limit, m%tension_fails, m%failure_damage, damage, s%pressure)
  end subroutine metal_pressure

  !> Signal speed c + |v| of particles first..first+n-1; the bulk viscosity q stiffens by 4 q/r.
  pure subroutine signal_speeds(m, n, capacity, n_field, f, first, signal)
    type(solid_material_type), intent(in) :: m
    integer, intent(in) :: n, capacity, n_field, first
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(out) :: signal(chunk)
    real(wp), dimension(chunk) :: modulus, compression, strength, factor, energy
    real(wp) :: failure_damage, rubble_damage, shear
    integer :: i
    do i = 1, n
      compression(i) = f(first + i - 1, at_mass)/(m%density*f(first + i - 1, at_volume)) - 1
    end do
    call factors_of(n, capacity, f, first, m%at_strength, m%at_stiffness, strength, factor)
    if (m%at_strength > 0) call reference_compression(n, strength, factor, compression)
    energy(:n) = f(first:first + n - 1, at_energy)/strength(:n)
    select case (m%model)
    case (model_hjc)
      call hjc_modulus(n, m%hjc, compression, f(first, m%at_own), modulus)
    case (model_rht)
      call rht_modulus(n, m%rht, compression, energy, f(first, at_volume), f(first, m%at_own), modulus)
    case (model_neo_hookean)
      call neo_hookean_modulus(n, m%bulk_modulus, m%shear_modulus, m%density, f(first, at_mass), f(first, at_volume), &
        f(first, m%at_own), f(first, m%at_own + 1), f(first, m%at_own + 2), modulus)
    case default
      modulus(:n) = m%bulk_modulus
      if (m%pressure == pressure_eos) then
        call fluid_sound_speed(n, m%eos, f(first, at_mass), f(first, at_volume), energy, signal)
        !$omp simd
        do i = 1, n
          modulus(i) = signal(i)*signal(i)*m%density
        end do
      end if
    end select
    failure_damage = m%failure_damage
    if (m%keeps_friction) failure_damage = huge(1.0_wp)
    rubble_damage = huge(1.0_wp)
    if (m%model == model_hjc .or. m%model == model_rht) rubble_damage = 1
    shear = m%shear_modulus
    if (m%model == model_drucker_prager) shear = sliding_modulus(m%drucker_prager, m%bulk_modulus, m%shear_modulus)
    call add_speeds(n, m%density, shear, failure_damage, rubble_damage, factor, modulus, f(first, at_mass), f(first, at_volume), &
      f(first, at_viscosity), f(first, at_damage), f(first, at_velocity), f(first, at_velocity + 1), f(first, &
        at_velocity + 2), signal)
  end subroutine signal_speeds

  !> c**2 = k ((dp/dmu)/r0 + 4/3 G/r) + 4 q/r, k the factor of the stiffness, without G in failed particles, whose density may be
  !> small. Rubble, damaged to rubble_damage, resists by friction alone, and only when it is pressed together again: its G counts
  !> with the density at rest where it has thinned out.
  pure subroutine add_speeds(n, density, shear_modulus, failure_damage, rubble_damage, factor, modulus, mass, volume, viscosity, &
      damage, vx, vy, vz, signal)
    integer, intent(in) :: n
    real(wp), intent(in) :: density, shear_modulus, failure_damage, rubble_damage
    real(wp), intent(in), dimension(n) :: factor, modulus, mass, volume, viscosity, damage, vx, vy, vz
    real(wp), intent(out) :: signal(n)
    real(wp) :: stiff, per_density, four_thirds, inverse
    integer :: i
    four_thirds = 4*third*shear_modulus
    inverse = 1/density
    !$omp simd private(stiff, per_density)
    do i = 1, n
      per_density = volume(i)/mass(i)
      stiff = factor(i)*merge(four_thirds, 0.0_wp, damage(i) < failure_damage)
      stiff = stiff*merge(per_density, min(per_density, inverse), damage(i) < rubble_damage) + 4*viscosity(i)*per_density
      signal(i) = sqrt(factor(i)*modulus(i)*inverse + stiff) + sqrt(vx(i)*vx(i) + vy(i)*vy(i) + vz(i)*vz(i))
    end do
  end subroutine add_speeds

end module stress_update
