!> Flows without shocks that are known exactly: vortex, density wave, simple wave. For orders of accuracy.
module smooth_flows
  use equation_of_state, only: eos_type
  use isentropes, only: isentrope_type, isentrope_point, new_isentrope
  use kinds, only: wp
  implicit none
  private
  public :: new_simple_wave

  real(wp), parameter :: pi = acos(-1.0_wp)

  !> Isentropic vortex of an ideal gas, carried by a uniform flow of density 1 and pressure 1 through a periodic box
  !> (Yee, Sandham & Djomehri 1999; Shu 1998). It falls as exp((1 - r**2)/2): at the edge of a box of 10, 6e-6 of it is left.
  type, public :: vortex_type
    real(wp) :: gamma = 1.4_wp
    real(wp) :: strength = 5 !< beta
    real(wp) :: velocity(2) = 1 !< of the uniform flow
    real(wp) :: centre(2) = 0 !< at the start
    real(wp) :: box(2) = 10
  contains
    procedure :: state => vortex_state
  end type vortex_type

  !> Sine wave of density that a uniform velocity carries along at uniform pressure, in one to three directions.
  type, public :: density_wave_type
    real(wp) :: density = 1, amplitude = 0.2_wp !< mean, and part of it
    real(wp) :: velocity(3) = [1.0_wp, 0.0_wp, 0.0_wp]
    real(wp) :: pressure = 1
    real(wp) :: waves(3) = [1.0_wp, 0.0_wp, 0.0_wp] !< per length, in each direction
  contains
    procedure :: state => density_wave_state
  end type density_wave_type

  !> Simple wave running in direction +x into any material: log(r/crest) = amplitude*(sin(2 pi x/wavelength) - 1) at the start,
  !> the velocity that of the invariant u - w; each state keeps its speed u + c until the wave breaks
  !> (Courant & Friedrichs 1948, ch. III; Landau & Lifshitz 1987, section 101).
  type, public :: simple_wave_type
    real(wp) :: amplitude = 0.1_wp, wavelength = 1
    real(wp) :: velocity = 0 !< at the crest
    type(isentrope_type), private :: isentrope
  contains
    procedure :: state => simple_wave_state
    procedure :: breaking_time
  end type simple_wave_type

contains

  !> Density, velocity in x and y, and pressure at point x and time t.
  pure function vortex_state(self, x, t) result(state)
    class(vortex_type), intent(in) :: self
    real(wp), intent(in) :: x(2), t
    real(wp) :: state(4), d(2), swirl, temperature
    d = x - self%centre - self%velocity*t
    d = d - self%box*anint(d/self%box)
    associate (g => self%gamma)
      swirl = self%strength/(2*pi)*exp(0.5_wp*(1 - sum(d**2)))
      temperature = 1 - (g - 1)/(2*g)*swirl**2
      state(1) = temperature**(1/(g - 1))
      state(2:3) = self%velocity + swirl*[-d(2), d(1)]
      state(4) = temperature**(g/(g - 1))
    end associate
  end function vortex_state

  !> Density, velocity (three components) and pressure at point x and time t.
  pure function density_wave_state(self, x, t) result(state)
    class(density_wave_type), intent(in) :: self
    real(wp), intent(in) :: x(3), t
    real(wp) :: state(5)
    state = [self%density*(1 + self%amplitude*sin(2*pi*dot_product(self%waves, x - self%velocity*t))), self%velocity, self%pressure]
  end function density_wave_state

  !> density, pressure, velocity: at the crest.
  pure function new_simple_wave(eos, density, pressure, velocity, amplitude, wavelength) result(wave)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, pressure, velocity, amplitude, wavelength
    type(simple_wave_type) :: wave
    wave%amplitude = amplitude
    wave%wavelength = wavelength
    wave%velocity = velocity
    wave%isentrope = new_isentrope(eos, density, pressure)
  end function new_simple_wave

  !> The state that starts at x.
  pure function start_point(self, x) result(point)
    type(simple_wave_type), intent(in) :: self
    real(wp), intent(in) :: x
    type(isentrope_point) :: point
    point = self%isentrope%at_density(self%isentrope%start%density*exp(self%amplitude*(sin(2*pi*x/self%wavelength) - 1)))
  end function start_point

  !> Speed u + c of the state that starts at x.
  pure real(wp) function start_speed(self, x)
    type(simple_wave_type), intent(in) :: self
    real(wp), intent(in) :: x
    type(isentrope_point) :: point
    point = start_point(self, x)
    start_speed = self%velocity + point%velocity + point%sound_speed
  end function start_speed

  !> Density, velocity and pressure at x and time t, before the wave breaks.
  pure function simple_wave_state(self, x, t) result(state)
    class(simple_wave_type), intent(in) :: self
    real(wp), intent(in) :: x, t
    real(wp) :: state(3), low, high, start
    type(isentrope_point) :: point
    integer :: i
    low = x - start_speed(self, 0.25_wp*self%wavelength)*t
    high = x - start_speed(self, 0.75_wp*self%wavelength)*t
    start = low
    do i = 1, 100
      start = 0.5_wp*(low + high)
      if (start <= low .or. start >= high) exit
      if (start + start_speed(self, start)*t < x) then
        low = start
      else
        high = start
      end if
    end do
    point = start_point(self, start)
    state = [point%density, self%velocity + point%velocity, point%pressure]
  end function simple_wave_state

  !> When the wave first becomes vertical somewhere: -1 over the steepest fall of u + c at the start (to about 1e-6).
  pure real(wp) function breaking_time(self)
    class(simple_wave_type), intent(in) :: self
    integer, parameter :: n = 2000
    real(wp) :: x, h, steepest
    integer :: i
    h = 1e-5_wp*self%wavelength
    steepest = 0
    do i = 1, n
      x = self%wavelength*(0.25_wp + 0.5_wp*i/n)
      steepest = min(steepest, (start_speed(self, x + h) - start_speed(self, x - h))/(2*h))
    end do
    breaking_time = -1/steepest
  end function breaking_time

end module smooth_flows
