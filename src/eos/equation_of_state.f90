!> One interface to every equation of state of Mie-Grueneisen form, p = f(r) + g r e with a constant g.
!> Inside the flow, energies of gases are counted from their offset q: masses are conserved one by one, so q changes nothing.
!>
!> Condensed matter: let h(r) = r f' - f. Then r c**2 = h + (1 + g) p, so sound at any pressure from 0 up, and one answer of the
!> pressure relaxation, need h > 0. Curves through shock data lose it in strong compression (those of metals near V = 0.63,
!> at some 250 GPa), so f is a straight line in r, with constant h, from the volume on where h has come down to a quarter of its
!> value at rest (`least_volume`).
module equation_of_state
  use cochran_chan, only: cochran_chan_type, cochran_chan_reference, cochran_chan_isentrope_density, &
    cochran_chan_largest_density
  use kinds, only: wp
  use jwl, only: jwl_type, jwl_cold_pressure, jwl_isentrope_density, jwl_reference
  use mie_grueneisen, only: pressure_from, energy_from, sound_speed_squared_from, pressure_without_sound
  use polynomial_eos, only: polynomial_type, polynomial_reference
  use shock_eos, only: shock_type, shock_reference
  use stiffened_gas, only: stiffened_gas_type, gas_pressure, gas_energy, gas_sound_speed_squared, gas_isentrope_density
  implicit none
  private
  public :: new_ideal_gas, new_stiffened_gas, new_jwl, new_cochran_chan, new_shock, new_polynomial

  integer, parameter, public :: max_materials = 8 !< in a cell
  integer, parameter, public :: is_ideal_gas = 1, is_stiffened_gas = 2, is_jwl = 3, is_cochran_chan = 4, is_shock = 5, &
    is_polynomial = 6

  type, public :: eos_type
    integer :: kind = is_ideal_gas
    type(stiffened_gas_type) :: gas
    type(jwl_type) :: jwl
    type(cochran_chan_type) :: cochran_chan
    type(shock_type) :: shock
    type(polynomial_type) :: polynomial
    real(wp) :: grueneisen = 0.4_wp !< g
    real(wp) :: density = 1 !< r0 of the relative volume V = r0/r; gases have none
    logical :: is_gas = .true. !< energy per volume = pressure*over_g + rest_energy with constants
    real(wp) :: over_g = 2.5_wp !< 1/g
    real(wp) :: rest_energy = 0 !< of a gas, per volume at zero pressure: gamma p_infinity/(gamma - 1)
  contains
    procedure :: pressure !< of density and energy per mass
    procedure :: energy !< per mass, of density and pressure
    procedure :: sound_speed_squared !< of density and pressure
    procedure :: isentrope_density !< density at another pressure on the isentrope through a state
    procedure :: lowest_pressure !< states at or below it do not exist
    procedure :: largest_density !< up to which the reference curve of condensed matter is good; huge without a limit
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
    eos = not_gas(is_jwl, omega, density)
    eos%jwl = jwl_type(a, b, r1, r2, omega, density, energy_per_volume)
  end function new_jwl

  !> Cochran-Chan of condensed matter; a1 and a2 are pressures, e1 and e2 exponents of the volume.
  pure function new_cochran_chan(a1, a2, e1, e2, grueneisen, density) result(eos)
    real(wp), intent(in) :: a1, a2, e1, e2, grueneisen, density
    type(eos_type) :: eos
    eos = not_gas(is_cochran_chan, grueneisen, density)
    eos%cochran_chan = cochran_chan_type(a1, a2, e1, e2, grueneisen, density)
  end function new_cochran_chan

  !> Condensed matter with the shock speed us = sound_speed + slope*up.
  pure function new_shock(sound_speed, slope, grueneisen, density) result(eos)
    real(wp), intent(in) :: sound_speed, slope, grueneisen, density
    type(eos_type) :: eos
    eos = not_gas(is_shock, grueneisen, density)
    ! At 0.9 of the pole the pressure is 90/s times the bulk modulus, and only with a small g f still rises there.
    eos%shock = shock_type(sound_speed, slope, grueneisen, density, max(1 - 0.9_wp/slope, 0.05_wp))
    eos%shock%least_volume = volume_of_stiffness(eos, eos%shock%least_volume)
  end function new_shock

  !> Polynomial in mu = r/density - 1 with the coefficients k1, k2, k3 (pressures).
  pure function new_polynomial(k1, k2, k3, grueneisen, density) result(eos)
    real(wp), intent(in) :: k1, k2, k3, grueneisen, density
    type(eos_type) :: eos
    eos = not_gas(is_polynomial, grueneisen, density)
    eos%polynomial = polynomial_type(k1, k2, k3, density, 0.05_wp)
    eos%polynomial%least_volume = volume_of_stiffness(eos, eos%polynomial%least_volume)
  end function new_polynomial

  pure function not_gas(kind, grueneisen, density) result(eos)
    integer, intent(in) :: kind
    real(wp), intent(in) :: grueneisen, density
    type(eos_type) :: eos
    eos%kind = kind
    eos%grueneisen = grueneisen
    eos%over_g = 1/grueneisen
    eos%density = density
    eos%is_gas = .false.
  end function not_gas

  !> Relative volume down to which, from rest, r f' - f is at least a quarter of its value at rest; no less than `least`.
  pure real(wp) function volume_of_stiffness(eos, least) result(volume)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: least
    integer, parameter :: n = 1000
    real(wp) :: at_rest, low, high
    integer :: i
    at_rest = stiffness(1.0_wp)
    do i = 1, n
      volume = 1 - (1 - least)*real(i, wp)/n
      if (stiffness(volume) < 0.25_wp*at_rest) exit
    end do
    volume = least
    if (i > n) return
    low = 1 - (1 - least)*real(i, wp)/n
    high = 1 - (1 - least)*real(i - 1, wp)/n
    do i = 1, 60
      volume = 0.5_wp*(low + high)
      if (stiffness(volume) < 0.25_wp*at_rest) then
        low = volume
      else
        high = volume
      end if
    end do
    volume = high
  contains
    pure real(wp) function stiffness(v)
      real(wp), intent(in) :: v
      real(wp) :: f, r_df
      call reference_point(eos, eos%density/v, f, r_df)
      stiffness = r_df - f
    end function stiffness
  end function volume_of_stiffness

  elemental real(wp) function pressure(self, r, e)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, e
    real(wp) :: f, r_df
    if (self%is_gas) then
      pressure = gas_pressure(self%gas, r, e)
    else
      call reference_point(self, r, f, r_df)
      pressure = pressure_from(f, self%grueneisen, r, e)
    end if
  end function pressure

  elemental real(wp) function energy(self, r, p)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p
    real(wp) :: f, r_df
    if (self%is_gas) then
      energy = gas_energy(self%gas, r, p)
    else
      call reference_point(self, r, f, r_df)
      energy = energy_from(f, self%grueneisen, r, p)
    end if
  end function energy

  elemental real(wp) function sound_speed_squared(self, r, p)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p
    real(wp) :: f, r_df
    if (self%is_gas) then
      sound_speed_squared = gas_sound_speed_squared(self%gas, r, p)
    else
      call reference_point(self, r, f, r_df)
      sound_speed_squared = sound_speed_squared_from(f, r_df, self%grueneisen, r, p)
    end if
  end function sound_speed_squared

  elemental real(wp) function isentrope_density(self, r, p, p_new)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p, p_new
    if (self%is_gas) then
      isentrope_density = gas_isentrope_density(self%gas, r, p, p_new)
    else if (self%kind == is_jwl) then
      isentrope_density = jwl_isentrope_density(self%jwl, r, p, p_new)
    else if (self%kind == is_cochran_chan) then
      isentrope_density = cochran_chan_isentrope_density(self%cochran_chan, r, p, p_new)
    else
      isentrope_density = marched_isentrope_density(self, r, p, p_new)
    end if
  end function isentrope_density

  !> Density at pressure p_new on the isentrope through (r, p) of condensed matter, by steps of Newton's method along it.
  !> With x = ln r the isentrope is dp/dx = h + (1 + g) p, h = r f' - f: its integral over a step is found by Gauss' rule, piece
  !> by piece where f changes from curve to straight line.
  pure real(wp) function marched_isentrope_density(self, r, p, p_new) result(density)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r, p, p_new
    real(wp), parameter :: longest_step = 0.25_wp, longest_way = 10
    real(wp) :: x, dx, now, f, r_df, bulk
    integer :: i
    x = log(r)
    now = p
    do i = 1, 200
      call reference_point(self, exp(x), f, r_df)
      bulk = r_df - f + (1 + self%grueneisen)*now
      if (.not. bulk > 0 .or. abs(x - log(r)) > longest_way) exit
      dx = max(min((p_new - now)/bulk, longest_step), -longest_step)
      now = pressure_after(self, x, dx, now)
      x = x + dx
      if (abs(dx) < 1e-12_wp) exit
    end do
    density = exp(x)
  end function marched_isentrope_density

  !> Pressure on the isentrope from (x, p) to x + dx, x = ln r: exp((1+g) dx) (p + integral of h exp(-(1+g) t) dt).
  pure real(wp) function pressure_after(self, x, dx, p)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: x, dx, p
    real(wp), parameter :: node(5) = [-0.906179845938663993_wp, -0.538469310105683091_wp, 0.0_wp, 0.538469310105683091_wp, &
      0.906179845938663993_wp]
    real(wp), parameter :: weight(5) = [0.236926885056189088_wp, 0.478628670499366468_wp, 0.568888888888888889_wp, &
      0.478628670499366468_wp, 0.236926885056189088_wp]
    real(wp) :: kink(0:3), start, finish, t, f, r_df
    integer :: i, k
    kink = [-huge(1.0_wp), log(self%density), log(self%largest_density()), huge(1.0_wp)]
    pressure_after = p
    do k = 1, 3
      start = min(max(x, kink(k - 1)), kink(k)) - x
      finish = min(max(x + dx, kink(k - 1)), kink(k)) - x
      if (abs(finish - start) <= 0) cycle
      do i = 1, 5
        t = 0.5_wp*(start + finish) + 0.5_wp*(finish - start)*node(i)
        call reference_point(self, exp(x + t), f, r_df)
        pressure_after = pressure_after + 0.5_wp*(finish - start)*weight(i)*(r_df - f)*exp(-(1 + self%grueneisen)*t)
      end do
    end do
    pressure_after = pressure_after*exp((1 + self%grueneisen)*dx)
  end function pressure_after

  !> JWL: the isentrope without its thermal term. Condensed matter: the tension at which c**2 vanishes.
  elemental real(wp) function lowest_pressure(self, r)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r
    real(wp) :: f, r_df
    if (self%is_gas) then
      lowest_pressure = -self%gas%p_infinity
    else if (self%kind == is_jwl) then
      lowest_pressure = jwl_cold_pressure(self%jwl, r)
    else
      call reference_point(self, r, f, r_df)
      lowest_pressure = pressure_without_sound(f, r_df, self%grueneisen)
    end if
  end function lowest_pressure

  !> Beyond it f is a straight line, or, Cochran-Chan with g > E1 - 1, h is negative.
  elemental real(wp) function largest_density(self)
    class(eos_type), intent(in) :: self
    largest_density = huge(1.0_wp)
    if (self%kind == is_shock) largest_density = self%density/self%shock%least_volume
    if (self%kind == is_polynomial) largest_density = self%density/self%polynomial%least_volume
    if (self%kind == is_cochran_chan) largest_density = cochran_chan_largest_density(self%cochran_chan)
  end function largest_density

  !> f and r df/dr at density r, of all but gases.
  pure subroutine reference_point(self, r, f, r_df)
    class(eos_type), intent(in) :: self
    real(wp), intent(in) :: r
    real(wp), intent(out) :: f, r_df
    real(wp) :: v(1), row_f(1), row_r_df(1)
    v = self%density/r
    call reference_of_volumes(self, 1, v, row_f, row_r_df)
    f = row_f(1)
    r_df = row_r_df(1)
  end subroutine reference_point

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
    density = self%density
    !$omp simd
    do i = 1, n
      volume(i) = density*a(i)/m(i)
    end do
    call reference_of_volumes(self, n, volume, f, r_df)
  end subroutine reference_rows

  !> Rows of f and r df/dr from relative volumes v, of all but gases.
  pure subroutine reference_of_volumes(self, n, v, f, r_df)
    class(eos_type), intent(in) :: self
    integer, intent(in) :: n
    real(wp), intent(in) :: v(n)
    real(wp), intent(out) :: f(n), r_df(n)
    select case (self%kind)
    case (is_jwl)
      call jwl_reference(self%jwl, n, v, f, r_df)
    case (is_cochran_chan)
      call cochran_chan_reference(self%cochran_chan, n, v, f, r_df)
    case (is_shock)
      call shock_reference(self%shock, n, v, f, r_df)
    case (is_polynomial)
      call polynomial_reference(self%polynomial, n, v, f, r_df)
    case default
      f = 0
      r_df = 0
    end select
  end subroutine reference_of_volumes

  pure function name(self) result(text)
    class(eos_type), intent(in) :: self
    character(:), allocatable :: text
    character(14), parameter :: names(6) = [character(14) :: 'ideal gas', 'stiffened gas', 'JWL', 'Cochran-Chan', 'shock', &
      'polynomial']
    text = trim(names(self%kind))
  end function name

end module equation_of_state
