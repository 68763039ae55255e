!> Noh's implosion: a cold ideal gas falls at speed u0 on a wall, an axis or a centre, and stops in a shock that moves outwards.
!> Source: Noh 1987, J. Comput. Phys. 72:78.
module noh
  use kinds, only: wp
  implicit none
  private
  public :: inflow_density

  type, public :: noh_type
    integer :: geometry = 3 !< n: 1 plane, 2 cylindrical, 3 spherical
    real(wp) :: gamma = 5/3.0_wp
    real(wp) :: density = 1 !< r0, everywhere at the start
    real(wp) :: speed = 1 !< u0, inwards
  contains
    procedure :: shock_speed
    procedure :: state
  end type noh_type

contains

  pure real(wp) function shock_speed(self)
    class(noh_type), intent(in) :: self
    shock_speed = 0.5_wp*(self%gamma - 1)*self%speed
  end function shock_speed

  !> Density, velocity (outwards) and pressure at distance r from the centre and time t. The gas ahead has no pressure.
  pure function state(self, r, t)
    class(noh_type), intent(in) :: self
    real(wp), intent(in) :: r, t
    real(wp) :: state(3)
    associate (n => self%geometry, g => self%gamma)
      if (r < self%shock_speed()*t) then
        state(1) = self%density*((g + 1)/(g - 1))**n
        state(2) = 0
        state(3) = 0.5_wp*(g - 1)*state(1)*self%speed**2
      else
        state = [inflow_density(n, self%density, self%speed, r, t), -self%speed, 0.0_wp]
      end if
    end associate
  end function state

  !> Density of a cold gas that has flowed inwards at one speed everywhere for a time t: r0 (1 + u0 t/r)**(n - 1).
  elemental real(wp) function inflow_density(geometry, density, speed, r, t)
    integer, intent(in) :: geometry
    real(wp), intent(in) :: density, speed, r, t
    inflow_density = density*(1 + speed*t/r)**(geometry - 1)
  end function inflow_density

end module noh
