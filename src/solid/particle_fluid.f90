!> A fluid carried by particles: pressure from an equation of state p = f(r) + g r e, no deviator.
!> The energy of a gas is counted from its offset, as in the flow.
module particle_fluid
  use equation_of_state, only: eos_type, is_jwl
  use kinds, only: wp
  use cell_functions, only: chunk
  implicit none
  private
  public :: fluid_pressure, fluid_sound_speed, fluid_energy, fluid_energy_at, fluid_rest_pressure

contains

  !> Pressure of n <= chunk particles at their new volumes. The energy at the end, which the pressure depends on, is the old one
  !> plus the work of the mean pressure and of the viscosity, so that p is the solution of a linear equation.
  pure subroutine fluid_pressure(n, eos, mass, old_volume, volume, energy, old_pressure, viscosity, pressure)
    integer, intent(in) :: n
    type(eos_type), intent(in) :: eos
    real(wp), intent(in), dimension(n) :: mass, old_volume, volume, energy, old_pressure, viscosity
    real(wp), intent(out) :: pressure(n)
    real(wp) :: f(chunk), g, change
    integer :: i
    call reference_pressure(n, eos, mass, volume, f)
    g = eos%grueneisen
    !$omp simd private(change)
    do i = 1, n
      change = old_volume(i) - volume(i)
      pressure(i) = (f(i) + g*(energy(i) + (0.5_wp*old_pressure(i) + viscosity(i))*change)/volume(i)) &
        /(1 - 0.5_wp*g*change/volume(i))
    end do
  end subroutine fluid_pressure

  !> Sound speed of n <= chunk particles: r c**2 = r df/dr + (p - f) + g p.
  pure subroutine fluid_sound_speed(n, eos, mass, volume, energy, speed)
    integer, intent(in) :: n
    type(eos_type), intent(in) :: eos
    real(wp), intent(in), dimension(n) :: mass, volume, energy
    real(wp), intent(out) :: speed(n)
    real(wp) :: f(chunk), slope(chunk), g, thermal
    integer :: i
    call reference_pressure(n, eos, mass, volume, f, slope)
    g = eos%grueneisen
    !$omp simd private(thermal)
    do i = 1, n
      thermal = g*energy(i)/volume(i)
      speed(i) = sqrt(max(slope(i) + thermal + g*(f(i) + thermal), 0.0_wp)*volume(i)/mass(i))
    end do
  end subroutine fluid_sound_speed

  !> Energy per mass of a fluid at rest: that of the explosive, or of a gas at the given pressure.
  pure real(wp) function fluid_energy(eos, density, pressure) result(energy)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, pressure
    if (eos%kind /= is_jwl) then
      energy = fluid_energy_at(eos, density, pressure)
    else
      energy = eos%jwl%energy_per_volume/eos%jwl%density
    end if
  end function fluid_energy

  !> Energy per mass at a density and a pressure.
  pure real(wp) function fluid_energy_at(eos, density, pressure) result(energy)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, pressure
    real(wp) :: f(1)
    call reference_pressure(1, eos, [density], [1.0_wp], f)
    energy = (pressure - f(1))/(eos%grueneisen*density)
  end function fluid_energy_at

  !> Pressure at a density and an energy per mass.
  pure real(wp) function fluid_rest_pressure(eos, density, energy) result(pressure)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, energy
    real(wp) :: f(1)
    call reference_pressure(1, eos, [density], [1.0_wp], f)
    pressure = f(1) + eos%grueneisen*density*energy
  end function fluid_rest_pressure

  !> f and r df/dr of the equation of state for n particles.
  pure subroutine reference_pressure(n, eos, mass, volume, f, slope)
    integer, intent(in) :: n
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: mass(n), volume(n)
    real(wp), intent(out) :: f(n)
    real(wp), intent(out), optional :: slope(n)
    real(wp) :: density(chunk), one(chunk), scratch(chunk), derivative(chunk)
    density(:n) = mass/volume
    one(:n) = 1
    call eos%reference_rows(n, density, one, scratch, f, derivative)
    if (present(slope)) slope = derivative(:n)
  end subroutine reference_pressure

end module particle_fluid
