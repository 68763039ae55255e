!> Plane Chapman-Jouguet detonation that runs in direction +x from x = 0 at time 0, and the expansion behind it (Taylor 1950,
!> Proc. R. Soc. A 200:235; Fickett & Davis 1979, ch. 2): all is a function of x/t. Products of any equation of state.
module detonation_wave
  use equation_of_state, only: eos_type
  use isentropes, only: isentrope_type, isentrope_point, new_isentrope
  use kinds, only: wp
  implicit none
  private
  public :: new_detonation

  type, public :: detonation_type
    type(eos_type) :: eos !< of the products
    real(wp) :: unreacted_density = 1
    real(wp) :: speed = 0 !< D of the front
    real(wp) :: density = 0, velocity = 0, pressure = 0 !< behind the front
    real(wp) :: rest_speed = 0 !< of the end of the expansion, if x = 0 is closed: the sound speed of the products at rest
    type(isentrope_type), private :: isentrope
  contains
    procedure :: closed_end
    procedure :: free_end
  end type detonation_type

contains

  !> energy: per mass, of the explosive at rest and zero pressure, in the products' reckoning (of a JWL: E0/r0).
  pure function new_detonation(eos, unreacted_density, energy) result(wave)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: unreacted_density, energy
    type(detonation_type) :: wave
    type(isentrope_point) :: rest
    real(wp) :: low, high, p
    integer :: i
    wave%eos = eos
    wave%unreacted_density = unreacted_density
    low = unreacted_density
    high = 1.01_wp*low
    do while (.not. is_subsonic(eos, unreacted_density, energy, high))
      low = high
      high = high + 0.01_wp*unreacted_density
    end do
    do i = 1, 60
      wave%density = 0.5_wp*(low + high)
      if (is_subsonic(eos, unreacted_density, energy, wave%density)) then
        high = wave%density
      else
        low = wave%density
      end if
    end do
    p = hugoniot_pressure(eos, unreacted_density, energy, wave%density)
    wave%pressure = p
    wave%speed = sqrt(p/(unreacted_density*(1 - unreacted_density/wave%density)))
    wave%velocity = wave%speed*(1 - unreacted_density/wave%density)
    wave%isentrope = new_isentrope(eos, wave%density, p)
    rest = wave%isentrope%at_velocity(-wave%velocity)
    wave%rest_speed = rest%sound_speed
  end function new_detonation

  !> Are the products at density r on the Hugoniot slower than sound against the front? From density r0 upwards they are faster
  !> until the Chapman-Jouguet point.
  pure logical function is_subsonic(eos, r0, energy, r)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r0, energy, r
    real(wp) :: p
    p = hugoniot_pressure(eos, r0, energy, r)
    is_subsonic = p*r0/(r*(r - r0)) < eos%sound_speed_squared(r, p)
  end function is_subsonic

  !> Pressure at density r from e = energy + p (1/r0 - 1/r)/2, e being linear in p.
  pure real(wp) function hugoniot_pressure(eos, r0, energy, r)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r0, energy, r
    hugoniot_pressure = (energy - eos%energy(r, 0.0_wp))/(1/(eos%grueneisen*r) - 0.5_wp*(1/r0 - 1/r))
  end function hugoniot_pressure

  !> Density, velocity and pressure at xi = x/t > 0 behind a wall at x = 0.
  pure function closed_end(self, xi) result(state)
    class(detonation_type), intent(in) :: self
    real(wp), intent(in) :: xi
    real(wp) :: state(3)
    state = free_end(self, max(xi, self%rest_speed))
  end function closed_end

  !> Density, velocity and pressure at xi = x/t of a charge that ends at x = 0, with vacuum beyond.
  pure function free_end(self, xi) result(state)
    class(detonation_type), intent(in) :: self
    real(wp), intent(in) :: xi
    real(wp) :: state(3)
    type(isentrope_point) :: point
    if (xi > self%speed) then
      state = [self%unreacted_density, 0.0_wp, 0.0_wp]
    else
      point = self%isentrope%at_speed(xi - self%velocity)
      state = [point%density, self%velocity + point%velocity, point%pressure]
    end if
  end function free_end

end module detonation_wave
