!> Stiffened gas, p = (gamma - 1) r (e - q) - gamma p_inf; with p_inf = 0 and q = 0 it is the ideal gas.
!> Source: Harlow & Amsden 1971; Le Metayer, Massoni & Saurel 2004.
module stiffened_gas
  use kinds, only: wp
  implicit none
  private
  public :: gas_pressure, gas_energy, gas_sound_speed_squared, gas_isentrope_density

  type, public :: stiffened_gas_type
    real(wp) :: gamma = 1.4_wp !< ratio of specific heats
    real(wp) :: p_infinity = 0 !< stiffness; 0 for a gas
    real(wp) :: energy_offset = 0 !< q, energy per mass that exerts no pressure
  end type stiffened_gas_type

contains

  !> Pressure at density r and energy per mass e.
  elemental real(wp) function gas_pressure(gas, r, e)
    type(stiffened_gas_type), intent(in) :: gas
    real(wp), intent(in) :: r, e
    gas_pressure = (gas%gamma - 1)*r*(e - gas%energy_offset) - gas%gamma*gas%p_infinity
  end function gas_pressure

  !> Energy per mass at density r and pressure p.
  elemental real(wp) function gas_energy(gas, r, p)
    type(stiffened_gas_type), intent(in) :: gas
    real(wp), intent(in) :: r, p
    gas_energy = (p + gas%gamma*gas%p_infinity)/((gas%gamma - 1)*r) + gas%energy_offset
  end function gas_energy

  !> c**2 at density r and pressure p.
  elemental real(wp) function gas_sound_speed_squared(gas, r, p)
    type(stiffened_gas_type), intent(in) :: gas
    real(wp), intent(in) :: r, p
    gas_sound_speed_squared = gas%gamma*(p + gas%p_infinity)/r
  end function gas_sound_speed_squared

  !> Density at pressure p_new on the isentrope through (r, p).
  elemental real(wp) function gas_isentrope_density(gas, r, p, p_new)
    type(stiffened_gas_type), intent(in) :: gas
    real(wp), intent(in) :: r, p, p_new
    gas_isentrope_density = r*((p_new + gas%p_infinity)/(p + gas%p_infinity))**(1/gas%gamma)
  end function gas_isentrope_density

end module stiffened_gas
