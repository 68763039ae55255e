!> Stress, energy, density and state of particles from the velocity gradient of one step; up to `chunk` particles per call.
!>
!> The order is the same for every model: strain and Jaumann rotation give a trial deviator; the model gives the pressure and
!> the factor that brings the trial deviator back to its yield surface; then stress, energy and volume follow.
module stress_update
  use constants, only: third
  use elastic, only: elastic_pressure
  use hjc, only: hjc_pressure, hjc_return, hjc_modulus
  use johnson_cook, only: johnson_cook_yield
  use kinds, only: wp
  use linear_hardening, only: linear_yield
  use particle_fluid, only: fluid_pressure, fluid_sound_speed
  use particles, only: at_velocity, at_mass, at_volume, at_stress, at_energy, at_viscosity, at_plastic_strain, at_damage, &
    at_plastic_work
  use perfect_plasticity, only: perfect_yield
  use radial_return, only: return_to_yield
  use simplified_johnson_cook, only: simplified_johnson_cook_yield
  use solid_material, only: solid_material_type, model_elastic, model_perfect_plasticity, model_linear_hardening, &
    model_johnson_cook, model_simplified_johnson_cook, model_hjc, model_fluid
  use strength_factors, only: factors_of, to_reference, from_reference, stiffen
  use cell_functions, only: chunk
  implicit none
  private
  public :: update_stress, signal_speeds

contains

  !> Advances particles first..first+n-1 by dt. gradient(:,3*(i-1)+j) = dt dv_i/dx_j; length: of a cell, for the bulk viscosity.
  pure subroutine update_stress(m, dt, length, n, capacity, n_field, f, first, gradient)
    type(solid_material_type), intent(in) :: m
    real(wp), intent(in) :: dt, length
    integer, intent(in) :: n, capacity, n_field, first
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp), intent(in) :: gradient(chunk, 9)
    real(wp), dimension(chunk) :: trial, power, shear, strain, old_pressure, volume, middle, compression
    real(wp), dimension(chunk) :: pressure, ratio, yield, viscosity, speed
    real(wp) :: deviator(chunk, 6), dt_rate
    real(wp), dimension(chunk) :: strength, stiffness, work
    if (m%model == model_fluid) then
      call fluid_sound_speed(n, m%eos, f(first, at_mass), f(first, at_volume), f(first, at_energy), speed)
    else
      speed(:n) = m%sound_speed
    end if
    call strain_and_rotate(n, m%shear_modulus, m%density, gradient, f(first, at_stress), f(first, at_stress + 1), &
      f(first, at_stress + 2), f(first, at_stress + 3), f(first, at_stress + 4), f(first, at_stress + 5), f(first, at_mass), &
      f(first, at_volume), deviator, trial, power, shear, strain, old_pressure, volume, middle, compression)
    call bulk_viscosity(n, dt, length, m%linear_viscosity, m%quadratic_viscosity, speed, f(first, at_mass), &
      f(first, at_volume), volume, viscosity)
    dt_rate = dt*m%reference_strain_rate
    if (m%at_strength > 0) then
      call factors_of(n, capacity, f, first, m%at_strength, m%at_stiffness, strength, stiffness)
      call to_reference(n, strength, stiffness, m%shear_modulus, gradient, deviator, trial, power, shear, strain, old_pressure, &
        compression, viscosity, f(first, at_energy), f(first, at_plastic_strain), f(first, at_plastic_work), work)
    end if
    select case (m%model)
    case (model_fluid)
      call fluid_pressure(n, m%eos, f(first, at_mass), f(first, at_volume), volume, f(first, at_energy), old_pressure, viscosity, &
        pressure)
      ratio(:n) = 0
    case (model_elastic)
      call elastic_pressure(n, m%bulk_modulus, m%failure_damage, f(first, at_damage), compression, pressure)
      ratio(:n) = 1
    case (model_hjc)
      call hjc_pressure(n, m%hjc, compression, f(first, at_damage), f(first, m%at_compaction), pressure, yield)
      call hjc_return(n, m%hjc, m%shear_modulus, m%failure_damage, dt_rate, trial, strain, middle, yield, &
        f(first, at_plastic_strain), f(first, at_damage), f(first, at_plastic_work), pressure, ratio)
    case default
      select case (m%model)
      case (model_perfect_plasticity)
        call perfect_yield(n, m%yield_stress, yield)
      case (model_linear_hardening)
        call linear_yield(n, m%yield_stress, m%hardening_modulus, f(first, at_plastic_strain), yield)
      case (model_simplified_johnson_cook)
        call simplified_johnson_cook_yield(n, m%jc_a, m%jc_b, m%jc_n, m%jc_c, dt_rate, strain, f(first, at_plastic_strain), yield)
      case (model_johnson_cook)
        call johnson_cook_yield(n, m%jc_a, m%jc_b, m%jc_n, m%jc_c, m%jc_m, m%taylor_quinney/m%specific_heat, &
          m%reference_temperature, m%melt_temperature, dt_rate, strain, f(first, at_plastic_strain), &
          f(first, at_plastic_work), f(first, at_mass), yield)
      end select
      call return_to_yield(n, m%shear_modulus, m%hardening_modulus, m%ultimate_stress, m%failure_strain, m%failure_damage, yield, &
        trial, middle, f(first, at_plastic_strain), f(first, at_damage), f(first, at_plastic_work), ratio)
      call elastic_pressure(n, m%bulk_modulus, m%failure_damage, f(first, at_damage), compression, pressure)
    end select
    if (m%at_strength > 0) call from_reference(n, strength, stiffness, work, deviator, power, shear, old_pressure, viscosity, &
      pressure, f(first, at_energy), f(first, at_plastic_strain), f(first, at_plastic_work))
    call set_stress(n, m%shear_modulus, deviator, ratio, pressure, power, shear, old_pressure, viscosity, volume, middle, &
      f(first, at_volume), f(first, at_energy), f(first, at_viscosity), f(first, at_stress), f(first, at_stress + 1), &
      f(first, at_stress + 2), f(first, at_stress + 3), f(first, at_stress + 4), f(first, at_stress + 5))
  end subroutine update_stress

  !> Strain increments, rotated old deviator plus elastic increment (trial deviator), and the new volume.
  !>
  !> The rotation is carried to second order in the spin increment, which keeps the invariants of the stress to fourth order.
  !> The volume changes by (1 + tr/2)/(1 - tr/2), tr the trace of the strain increment: positive, and the same backwards. trial:
  !> equivalent stress of the trial deviator t; power = t:d and shear = d:d with the deviatoric increment d; strain: equivalent
  !> increment sqrt(2/3 d:d); middle: volume at mid step; compression = r/r0 - 1 at the end.
  pure subroutine strain_and_rotate(n, shear_modulus, density, g, s1, s2, s3, s4, s5, s6, mass, old_volume, t, trial, power, &
    shear, &
      strain, old_pressure, volume, middle, compression)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, density, g(chunk, 9), mass(n), old_volume(n)
    real(wp), intent(in), dimension(n) :: s1, s2, s3, s4, s5, s6
    real(wp), intent(out) :: t(chunk, 6)
    real(wp), intent(out), dimension(n) :: trial, power, shear, strain, old_pressure, volume, middle, compression
    real(wp) :: p, a1, a2, a3, a4, a5, a6, r1, r2, r3, r4, r5, r6, q1, q2, q3, q4, q5, q6, w12, w13, w23
    real(wp) :: d1, d2, d3, d4, d5, d6, trace, twice
    integer :: i
    twice = 2*shear_modulus
    !$omp simd private(p, a1, a2, a3, a4, a5, a6, r1, r2, r3, r4, r5, r6, q1, q2, q3, q4, q5, q6, w12, w13, w23)
    do i = 1, n
      p = -(s1(i) + s2(i) + s3(i))*third
      old_pressure(i) = p
      a1 = s1(i) + p
      a2 = s2(i) + p
      a3 = s3(i) + p
      a4 = s4(i)
      a5 = s5(i)
      a6 = s6(i)
      w12 = 0.5_wp*(g(i, 2) - g(i, 4))
      w13 = 0.5_wp*(g(i, 3) - g(i, 7))
      w23 = 0.5_wp*(g(i, 6) - g(i, 8))
      r1 = 2*(w12*a6 + w13*a5)
      r2 = 2*(w23*a4 - w12*a6)
      r3 = -2*(w13*a5 + w23*a4)
      r4 = w23*(a3 - a2) - w12*a5 - w13*a6
      r5 = w13*(a3 - a1) + w12*a4 - w23*a6
      r6 = w12*(a2 - a1) + w13*a4 + w23*a5
      q1 = 2*(w12*r6 + w13*r5)
      q2 = 2*(w23*r4 - w12*r6)
      q3 = -2*(w13*r5 + w23*r4)
      q4 = w23*(r3 - r2) - w12*r5 - w13*r6
      q5 = w13*(r3 - r1) + w12*r4 - w23*r6
      q6 = w12*(r2 - r1) + w13*r4 + w23*r5
      t(i, 1) = a1 + (r1 + 0.5_wp*q1)
      t(i, 2) = a2 + (r2 + 0.5_wp*q2)
      t(i, 3) = a3 + (r3 + 0.5_wp*q3)
      t(i, 4) = a4 + (r4 + 0.5_wp*q4)
      t(i, 5) = a5 + (r5 + 0.5_wp*q5)
      t(i, 6) = a6 + (r6 + 0.5_wp*q6)
    end do
    !$omp simd private(trace, d1, d2, d3, d4, d5, d6)
    do i = 1, n
      trace = g(i, 1) + g(i, 5) + g(i, 9)
      volume(i) = old_volume(i)*((1 + 0.5_wp*trace)/(1 - 0.5_wp*trace))
      middle(i) = 0.5_wp*(old_volume(i) + volume(i))
      compression(i) = mass(i)/(density*volume(i)) - 1
      d1 = g(i, 1) - trace*third
      d2 = g(i, 5) - trace*third
      d3 = g(i, 9) - trace*third
      d4 = 0.5_wp*(g(i, 6) + g(i, 8))
      d5 = 0.5_wp*(g(i, 3) + g(i, 7))
      d6 = 0.5_wp*(g(i, 2) + g(i, 4))
      shear(i) = (d1*d1 + d2*d2 + d3*d3) + 2*(d4*d4 + d5*d5 + d6*d6)
      strain(i) = sqrt(2*third*shear(i))
      t(i, 1) = t(i, 1) + twice*d1
      t(i, 2) = t(i, 2) + twice*d2
      t(i, 3) = t(i, 3) + twice*d3
      t(i, 4) = t(i, 4) + twice*d4
      t(i, 5) = t(i, 5) + twice*d5
      t(i, 6) = t(i, 6) + twice*d6
      power(i) = (t(i, 1)*d1 + t(i, 2)*d2 + t(i, 3)*d3) + 2*(t(i, 4)*d4 + t(i, 5)*d5 + t(i, 6)*d6)
      trial(i) = sqrt(1.5_wp*((t(i, 1)*t(i, 1) + t(i, 2)*t(i, 2) + t(i, 3)*t(i, 3)) &
        + 2*(t(i, 4)*t(i, 4) + t(i, 5)*t(i, 5) + t(i, 6)*t(i, 6))))
    end do
  end subroutine strain_and_rotate

  !> q = r h e (linear c + quadratic h e) in compression, e = -dV/(V dt), h the cell length; zero in expansion.
  pure subroutine bulk_viscosity(n, dt, length, linear, quadratic, speed, mass, old_volume, volume, viscosity)
    integer, intent(in) :: n
    real(wp), intent(in) :: dt, length, linear, quadratic, speed(n), mass(n), old_volume(n), volume(n)
    real(wp), intent(out) :: viscosity(n)
    real(wp) :: jump, inverse
    integer :: i
    inverse = length/dt
    !$omp simd private(jump)
    do i = 1, n
      jump = max(old_volume(i)/volume(i) - 1, 0.0_wp)*inverse
      viscosity(i) = mass(i)/volume(i)*jump*(linear*speed(i) + quadratic*jump)
    end do
  end subroutine bulk_viscosity

  !> Stress from the scaled deviator and the pressure; energy by the mean stress power and the viscosity.
  pure subroutine set_stress(n, shear_modulus, t, ratio, pressure, power, shear, old_pressure, new_viscosity, new_volume, middle, &
      volume, energy, viscosity, s1, s2, s3, s4, s5, s6)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, t(chunk, 6)
    real(wp), intent(in), dimension(n) :: ratio, pressure, power, shear, old_pressure, new_viscosity, new_volume, middle
    real(wp), intent(inout), dimension(n) :: volume, energy
    real(wp), intent(out), dimension(n) :: viscosity, s1, s2, s3, s4, s5, s6
    integer :: i
    !$omp simd
    do i = 1, n
      s1(i) = ratio(i)*t(i, 1) - pressure(i)
      s2(i) = ratio(i)*t(i, 2) - pressure(i)
      s3(i) = ratio(i)*t(i, 3) - pressure(i)
      s4(i) = ratio(i)*t(i, 4)
      s5(i) = ratio(i)*t(i, 5)
      s6(i) = ratio(i)*t(i, 6)
    end do
    !$omp simd
    do i = 1, n
      energy(i) = energy(i) + 0.5_wp*middle(i)*((1 + ratio(i))*power(i) - 2*shear_modulus*shear(i)) &
        + (0.5_wp*(old_pressure(i) + pressure(i)) + new_viscosity(i))*(volume(i) - new_volume(i))
      viscosity(i) = new_viscosity(i)
      volume(i) = new_volume(i)
    end do
  end subroutine set_stress

  !> Signal speed c + |v| of particles first..first+n-1; the bulk viscosity q stiffens by 4 q/r.
  pure subroutine signal_speeds(m, n, capacity, n_field, f, first, signal)
    type(solid_material_type), intent(in) :: m
    integer, intent(in) :: n, capacity, n_field, first
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(out) :: signal(chunk)
    real(wp), dimension(chunk) :: modulus, compression, strength, stiffness
    integer :: i
    if (m%at_strength > 0) call factors_of(n, capacity, f, first, m%at_strength, m%at_stiffness, strength, stiffness)
    select case (m%model)
    case (model_fluid)
      call fluid_sound_speed(n, m%eos, f(first, at_mass), f(first, at_volume), f(first, at_energy), signal)
      !$omp simd
      do i = 1, n
        modulus(i) = signal(i)*signal(i)*m%density
      end do
    case (model_hjc)
      !$omp simd
      do i = 1, n
        compression(i) = f(first + i - 1, at_mass)/(m%density*f(first + i - 1, at_volume)) - 1
      end do
      if (m%at_strength > 0) compression(:n) = compression(:n)*stiffness(:n)/strength(:n)
      call hjc_modulus(n, m%hjc, compression, f(first, m%at_compaction), modulus)
    case default
      modulus(:n) = m%bulk_modulus
    end select
    if (m%at_strength > 0) call stiffen(n, stiffness, m%density, m%shear_modulus, m%failure_damage, f(first, at_mass), &
      f(first, at_volume), f(first, at_damage), modulus)
    call add_speeds(n, m%density, m%shear_modulus, m%failure_damage, modulus, f(first, at_mass), f(first, at_volume), &
      f(first, at_viscosity), f(first, at_damage), f(first, at_velocity), f(first, at_velocity + 1), f(first, &
        at_velocity + 2), signal)
  end subroutine signal_speeds

  !> c**2 = (dp/dmu)/r0 + (4/3 G + 4 q)/r, without G in failed particles, whose density may be small.
  pure subroutine add_speeds(n, density, shear_modulus, failure_damage, modulus, mass, volume, viscosity, damage, vx, vy, vz, &
    signal)
    integer, intent(in) :: n
    real(wp), intent(in) :: density, shear_modulus, failure_damage
    real(wp), intent(in), dimension(n) :: modulus, mass, volume, viscosity, damage, vx, vy, vz
    real(wp), intent(out) :: signal(n)
    real(wp) :: stiff, four_thirds, inverse
    integer :: i
    four_thirds = 4*third*shear_modulus
    inverse = 1/density
    !$omp simd private(stiff)
    do i = 1, n
      stiff = merge(four_thirds, 0.0_wp, damage(i) < failure_damage) + 4*viscosity(i)
      signal(i) = sqrt(modulus(i)*inverse + stiff*volume(i)/mass(i)) + sqrt(vx(i)*vx(i) + vy(i)*vy(i) + vz(i)*vz(i))
    end do
  end subroutine add_speeds

end module stress_update
