!> Expansion of a supersonic stream of an ideal gas around a corner (Meyer 1908; NACA report 1135, 1953, eq. 171).
!> The stream comes along +x over a wall that ends at the corner and goes on lower by an angle; the flow depends only on the
!> direction from the corner, counted from +x towards the stream: pi at the wall ahead, -turn at the wall behind.
module prandtl_meyer
  use kinds, only: wp
  implicit none
  private
  public :: prandtl_meyer_angle, new_corner

  real(wp), parameter :: pi = acos(-1.0_wp)

  type, public :: corner_type
    real(wp) :: gamma = 1.4_wp
    real(wp) :: mach = 2, density = 1, pressure = 1 !< of the stream
    real(wp) :: turn = 0 !< of the wall, radians
    real(wp) :: mach_behind = 2
    real(wp) :: head = 0, tail = 0 !< directions of the first and last ray of the fan
  contains
    procedure :: state
  end type corner_type

contains

  !> Angle by which a stream has turned since Mach 1.
  elemental real(wp) function prandtl_meyer_angle(mach, gamma)
    real(wp), intent(in) :: mach, gamma
    real(wp) :: b
    b = sqrt(max(mach**2 - 1, 0.0_wp))
    prandtl_meyer_angle = sqrt((gamma + 1)/(gamma - 1))*atan(sqrt((gamma - 1)/(gamma + 1))*b) - atan(b)
  end function prandtl_meyer_angle

  !> turn: below the angle that leaves vacuum, pi/2 (sqrt((gamma + 1)/(gamma - 1)) - 1) less that of the stream.
  pure function new_corner(gamma, mach, density, pressure, turn) result(corner)
    real(wp), intent(in) :: gamma, mach, density, pressure, turn
    type(corner_type) :: corner
    real(wp) :: low, high, angle
    integer :: i
    corner = corner_type(gamma, mach, density, pressure, turn)
    angle = prandtl_meyer_angle(mach, gamma) + turn
    low = 0 ! of 1/Mach
    high = 1/mach
    do i = 1, 100
      corner%mach_behind = 2/(low + high)
      if (prandtl_meyer_angle(corner%mach_behind, gamma) < angle) then
        high = 0.5_wp*(low + high)
      else
        low = 0.5_wp*(low + high)
      end if
    end do
    corner%head = asin(1/mach)
    corner%tail = asin(1/corner%mach_behind) - turn
  end function new_corner

  !> Density, velocity in x and y, and pressure in a direction from the corner, between -turn and pi.
  pure function state(self, direction)
    class(corner_type), intent(in) :: self
    real(wp), intent(in) :: direction
    real(wp) :: state(4), mach, spread, ratio, turned, speed
    associate (g => self%gamma)
      if (direction >= self%head) then
        mach = self%mach
      else if (direction <= self%tail) then
        mach = self%mach_behind
      else
        ! on a ray the direction is the Mach angle less the turn so far
        spread = sqrt((g + 1)/(g - 1))
        mach = sqrt(1 + (spread*tan((prandtl_meyer_angle(self%mach, g) + 0.5_wp*pi - direction)/spread))**2)
      end if
      turned = prandtl_meyer_angle(mach, g) - prandtl_meyer_angle(self%mach, g)
      ratio = (1 + 0.5_wp*(g - 1)*self%mach**2)/(1 + 0.5_wp*(g - 1)*mach**2) ! of temperatures
      speed = mach*sqrt(g*self%pressure/self%density*ratio)
      state = [self%density*ratio**(1/(g - 1)), speed*cos(turned), -speed*sin(turned), self%pressure*ratio**(g/(g - 1))]
    end associate
  end function state

end module prandtl_meyer
