!> One interface to every equation of state of Mie-Grueneisen form, p = f(r) + g r e with a constant g.
!> Inside the flow, energies of gases are counted from their offset q: masses are conserved one by one, so q changes nothing.
module equation_of_state
  use kinds, only: wp
  use jwl, only: jwl_type, jwl_pressure, jwl_energy, jwl_sound_speed_squared, jwl_cold_pressure, jwl_isentrope_density, &
    jwl_reference
  use stiffened_gas, only: stiffened_gas_type, gas_pressure, gas_energy, gas_sound_speed_squared, gas_isentrope_density
  implicit none
  private
  public :: new_ideal_gas, new_stiffened_gas, new_jwl

  integer, parameter, public :: max_materials = 8 !< in a cell
  integer, parameter, public :: is_ideal_gas = 1, is_stiffened_gas = 2, is_jwl = 3

  type, public :: eos_type
    integer :: kind = is_ideal_gas
    type(stiffened_gas_type) :: gas
    type(jwl_type) :: jwl
    real(wp) :: grueneisen = 0.4_wp !< g
    logical :: is_gas = .true. !< energy per volume = pressure*over_g + rest_energy with constants
    real(wp) :: over_g = 2.5_wp !< 1/g
    real(wp) :: rest_energy = 0 !< of a gas, per volume at zero pressure: gamma p_infinity/(gamma - 1)
  contains
    procedure :: pressure !< of density and energy per mass
    procedure :: energy !< per mass, of density and pressure
    procedure :: sound_speed_squared !< of density and pressure
    procedure :: isentrope_density !< density at another pressure on the isentrope through a state
    procedure :: lowest_pressure !< states at or below it do not exist
    procedure :: reference_rows
    procedure :: name
  end type eos_type

contains

  !> Ideal gas p = (gamma - 1) r (e - offset).
  pure function new_ideal_gas(gamma, energy_offset) result(eos)
    real(wp), intent(in) :: gamma
    real(wp), intent(in), optional :: energy_offset
    type(eos_type) :: eos
    eos%kind = is_ideal_gas
    eos%gas = stiffened_gas_type(gamma, 0.0_wp, 0.0_wp)
    if (present(energy_offset)) eos%gas%energy_offset = energy_offset
    eos%grueneisen = gamma - 1
    eos%over_g = 1/eos%grueneisen
  end function new_ideal_gas

  !> Stiffened gas p = (gamma - 1) r (e - offset) - gamma p_infinity.
  pure function new_stiffened_gas(gamma, p_infinity, energy_offset) result(eos)
    real(wp), intent(in) :: gamma, p_infinity
    real(wp), intent(in), optional :: energy_offset
    type(eos_type) :: eos
    eos = new_ideal_gas(gamma, energy_offset)
    eos%kind = is_stiffened_gas
    eos%gas%p_infinity = p_infinity
    eos%rest_energy = gamma*p_infinity*eos%over_g
  end function new_stiffened_gas

  !> JWL of products; a, b and energy_per_volume are pressures, density is that of the unreacted explosive.
  pure function new_jwl(a, b, r1, r2, omega, density, energy_per_volume) result(eos)
    real(wp), intent(in) :: a, b, r1, r2, omega, density, energy_per_volume
    type(eos_type) :: eos
    eos%kind = is_jwl
    eos%jwl = jwl_type(a, b, r1, r2, omega, density, energy_per_volume)
    eos%grueneisen = omega
    eos%over_g = 1/omega
    eos%is_gas = .false.
  end function new_jwl

  elemental real(wp) function pressure(self, r, e)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, e
    if (self%is_gas) then
      pressure = gas_pressure(self%gas, r, e)
    else
      pressure = jwl_pressure(self%jwl, r, e)
    end if
  end function pressure

  elemental real(wp) function energy(self, r, p)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p
    if (self%is_gas) then
      energy = gas_energy(self%gas, r, p)
    else
      energy = jwl_energy(self%jwl, r, p)
    end if
  end function energy

  elemental real(wp) function sound_speed_squared(self, r, p)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p
    if (self%is_gas) then
      sound_speed_squared = gas_sound_speed_squared(self%gas, r, p)
    else
      sound_speed_squared = jwl_sound_speed_squared(self%jwl, r, p)
    end if
  end function sound_speed_squared

  elemental real(wp) function isentrope_density(self, r, p, p_new)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p, p_new
    if (self%is_gas) then
      isentrope_density = gas_isentrope_density(self%gas, r, p, p_new)
    else
      isentrope_density = jwl_isentrope_density(self%jwl, r, p, p_new)
    end if
  end function isentrope_density

  elemental real(wp) function lowest_pressure(self, r)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r
    if (self%is_gas) then
      lowest_pressure = -self%gas%p_infinity
    else
      lowest_pressure = jwl_cold_pressure(self%jwl, r)
    end if
  end function lowest_pressure

  !> Rows of f(r) and r df/dr from partial densities m and volume fractions a (1 for a single material).
  !> volume: scratch of the same length. Gases have f = -gamma p_infinity, energies being counted from the offset.
  pure subroutine reference_rows(self, n, m, a, volume, f, r_df)
    class(eos_type), intent(in) :: self
    integer, intent(in) :: n
    real(wp), intent(in) :: m(n), a(n)
    real(wp), intent(out) :: volume(n), f(n), r_df(n)
    real(wp) :: density
    integer :: i
    if (self%is_gas) then
      volume = 0
      f = -self%gas%gamma*self%gas%p_infinity
      r_df = 0
      return
    end if
    density = self%jwl%density
    !$omp simd
    do i = 1, n
      volume(i) = density*a(i)/m(i)
    end do
    call jwl_reference(self%jwl, n, volume, f, r_df)
  end subroutine reference_rows

  pure function name(self) result(text)
    class(eos_type), intent(in) :: self
    character(:), allocatable :: text
    character(14), parameter :: names(3) = [character(14) :: 'ideal gas', 'stiffened gas', 'JWL']
    text = trim(names(self%kind))
  end function name

end module equation_of_state
