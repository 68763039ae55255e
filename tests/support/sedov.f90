!> Blast from a plane, line or point in an ideal gas of uniform density without pressure: Sedov 1959, Similarity and Dimensional
!> Methods, ch. IV, in the notation of Kamm & Timmes 2007 (LA-UR-07-2849), omega = 0, standard case.
!> All is a function of V between V0 = 2/((j + 2) gamma) at the centre and V2 = 4/((j + 2)(gamma + 1)) at the shock. Here the
!> functions are written with y = x2**-a2, 0 to 1, which r follows like a straight line near the centre, and such that nothing
!> is singular at gamma = 2. Valid for gamma > 1, and below 7 for a point: from there on the centre is empty.
module sedov
  use gauss_quadrature, only: gauss_rule
  use kinds, only: wp
  implicit none
  private
  public :: new_sedov

  type, public :: sedov_type
    integer :: geometry = 3 !< j: 1 plane, 2 cylindrical, 3 spherical
    real(wp) :: gamma = 1.4_wp
    real(wp) :: density = 1 !< ahead of the shock
    real(wp) :: energy = 1 !< per area on one side of the plane, per length of the line, of the point
    real(wp) :: alpha = 1 !< energy = alpha*density*radius**(j + 2)/time**2
  contains
    procedure :: shock_radius
    procedure :: shock_speed
    procedure :: state => state_at
  end type sedov_type

  !> The profile at one place, over its values behind the shock.
  type :: profile_point
    real(wp) :: radius, velocity, density, pressure
    real(wp) :: slope !< d log(radius)/d log(y)
  end type profile_point

contains

  pure function new_sedov(geometry, gamma, density, energy) result(blast)
    integer, intent(in) :: geometry
    real(wp), intent(in) :: gamma, density, energy
    type(sedov_type) :: blast
    blast%geometry = geometry
    blast%gamma = gamma
    blast%density = density
    blast%energy = energy
    blast%alpha = energy_constant(blast)
  end function new_sedov

  !> At time t after the blast.
  elemental real(wp) function shock_radius(self, t)
    class(sedov_type), intent(in) :: self
    real(wp), intent(in) :: t
    shock_radius = (self%energy*t**2/(self%alpha*self%density))**(1.0_wp/(self%geometry + 2))
  end function shock_radius

  elemental real(wp) function shock_speed(self, t)
    class(sedov_type), intent(in) :: self
    real(wp), intent(in) :: t
    shock_speed = 2*self%shock_radius(t)/((self%geometry + 2)*t)
  end function shock_speed

  !> Density, velocity (outwards) and pressure at distance r >= 0 from the centre and time t > 0.
  pure function state_at(self, r, t) result(state)
    class(sedov_type), intent(in) :: self
    real(wp), intent(in) :: r, t
    real(wp) :: state(3), low, high, ratio, speed
    type(profile_point) :: point
    integer :: i
    ratio = r/self%shock_radius(t)
    if (ratio > 1) then
      state = [self%density, 0.0_wp, 0.0_wp]
      return
    end if
    low = 0
    high = 1
    do i = 1, 100
      point = profile(self, 0.5_wp*(low + high))
      if (point%radius < ratio) then
        low = 0.5_wp*(low + high)
      else
        high = 0.5_wp*(low + high)
      end if
    end do
    point = profile(self, high)
    speed = self%shock_speed(t)
    state = [self%density*(self%gamma + 1)/(self%gamma - 1)*point%density, 2*speed/(self%gamma + 1)*point%velocity, &
      2*self%density*speed**2/(self%gamma + 1)*point%pressure]
  end function state_at

  !> Eq. 30-41 of Kamm & Timmes, y in (0, 1].
  pure function profile(self, y) result(point)
    class(sedov_type), intent(in) :: self
    real(wp), intent(in) :: y
    type(profile_point) :: point
    real(wp) :: j, g, a1, exponent, v_first, v_shock, v, x1, x3, x4, dv, delta, common, log_x2, z, ratio
    j = self%geometry
    g = self%gamma - 1
    exponent = (2*g + j)/g ! -1/a2
    a1 = (j + 2)*(g + 1)/(2 + j*g)*(2*j*(1 - g)/((g + 1)*(j + 2)**2) + 1/exponent)
    v_first = 2/((j + 2)*(g + 1))
    v_shock = 4/((j + 2)*(g + 2))
    log_x2 = exponent*log(max(y, tiny(y)))
    dv = v_first*g/(g + 2)*exp(max(log_x2, -700.0_wp))
    v = v_first + dv
    x1 = 0.25_wp*(j + 2)*(g + 2)*v
    x3 = (1 - 0.5_wp*(2 + j*g)*v)/(1 - 0.5_wp*(2 + j*g)*v_shock)
    x4 = (1 - 0.5_wp*(j + 2)*v)/(1 - 0.5_wp*(j + 2)*v_shock)
    ! x3**a4*x4**a5: both exponents are infinite at gamma = 2, where x3 = x4
    delta = j*(1 - g)
    z = delta*(v - v_shock)/(2*(1 - 0.5_wp*(j + 2)*v)*(1 - 0.5_wp*(2 + j*g)*v_shock)) ! x3/x4 - 1
    if (abs(z) < 1e-4_wp) then
      ratio = (v - v_shock)/(2*(1 - 0.5_wp*(j + 2)*v)*(1 - 0.5_wp*(2 + j*g)*v_shock))*(1 - z/2 + z**2/3 - z**3/4)
    else
      ratio = log(x3/x4)/delta
    end if
    common = (j - 2)*(2*j - (j - 2)*g)/((2 + j*g)*(2*g + j))*log(x4) + j*(j + 2)*a1*ratio
    point%radius = y*x1**(-2/(j + 2))*x3**(-a1)
    point%velocity = x1*point%radius
    point%density = exp(max(j/(2*g + j)*log_x2 + common, -700.0_wp))
    point%pressure = x1**(2*j/(j + 2))*x3**(-2*a1)*x4*exp(common)
    point%slope = 1 - (2/((j + 2)*v) - a1*0.5_wp*(2 + j*g)/(1 - 0.5_wp*(2 + j*g)*v))*dv*exponent
  end function profile

  !> Energy of the profile for a density, shock radius and time of 1.
  pure real(wp) function energy_constant(self) result(alpha)
    type(sedov_type), intent(in) :: self
    real(wp), parameter :: pi = acos(-1.0_wp), measure(3) = [1.0_wp, 2*pi, 4*pi]
    real(wp), dimension(1024) :: node, weight
    real(wp) :: speed, kinetic, internal
    type(profile_point) :: point
    integer :: i
    speed = 2.0_wp/(self%geometry + 2)
    kinetic = 0.5_wp*(self%gamma + 1)/(self%gamma - 1)*(2*speed/(self%gamma + 1))**2
    internal = 2*speed**2/((self%gamma + 1)*(self%gamma - 1))
    call gauss_rule(0.0_wp, 1.0_wp, node, weight)
    alpha = 0
    do i = 1, size(node)
      point = profile(self, node(i))
      alpha = alpha + weight(i)*point%slope/node(i)*point%radius**self%geometry &
        *(kinetic*point%density*point%velocity**2 + internal*point%pressure)
    end do
    alpha = alpha*measure(self%geometry)
  end function energy_constant

end module sedov
