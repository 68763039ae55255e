!> Exact solution of the Riemann problem of two stiffened gases (Toro 2009, ch. 4; the stiffness only shifts the pressure).
module exact_riemann
  use kinds, only: wp
  use stiffened_gas, only: stiffened_gas_type
  implicit none
  private
  public :: star_state, exact_state

  !> One side of the problem.
  type, public :: side_type
    real(wp) :: density = 1, velocity = 0, pressure = 1
    type(stiffened_gas_type) :: gas
  end type side_type

contains

  !> Pressure and velocity between the waves, by bisection.
  pure subroutine star_state(left, right, pressure, velocity)
    type(side_type), intent(in) :: left, right
    real(wp), intent(out) :: pressure, velocity
    real(wp) :: low, high
    integer :: i
    low = -min(left%gas%p_infinity, right%gas%p_infinity)
    high = 10*max(left%pressure, right%pressure) + 10*max(left%gas%p_infinity, right%gas%p_infinity)
    do i = 1, 200
      pressure = 0.5_wp*(low + high)
      if (change(left, pressure) + change(right, pressure) + right%velocity - left%velocity > 0) then
        high = pressure
      else
        low = pressure
      end if
    end do
    velocity = 0.5_wp*(left%velocity + right%velocity + change(right, pressure) - change(left, pressure))
  end subroutine star_state

  !> Density, velocity and pressure at speed xi = x/t.
  pure function exact_state(left, right, xi) result(state)
    type(side_type), intent(in) :: left, right
    real(wp), intent(in) :: xi
    real(wp) :: state(3), pressure, velocity
    call star_state(left, right, pressure, velocity)
    if (xi < velocity) then
      state = behind_wave(left, -1.0_wp, pressure, velocity, xi)
    else
      state = behind_wave(right, 1.0_wp, pressure, velocity, xi)
    end if
  end function exact_state

  !> Velocity change across the wave into one side that brings it to pressure p.
  pure real(wp) function change(side, p)
    type(side_type), intent(in) :: side
    real(wp), intent(in) :: p
    real(wp) :: g, stiff, c
    g = side%gas%gamma
    stiff = side%gas%p_infinity
    if (p > side%pressure) then
      change = (p - side%pressure)*sqrt(2/(side%density*((g + 1)*(p + stiff) + (g - 1)*(side%pressure + stiff))))
    else
      c = sqrt(g*(side%pressure + stiff)/side%density)
      change = 2*c/(g - 1)*((max(p + stiff, 0.0_wp)/(side%pressure + stiff))**((g - 1)/(2*g)) - 1)
    end if
  end function change

  !> sign: -1 for the left side, 1 for the right.
  pure function behind_wave(side, sign, p, u, xi) result(state)
    type(side_type), intent(in) :: side
    real(wp), intent(in) :: sign, p, u, xi
    real(wp) :: state(3), g, stiff, c, ratio, shock, density, c_star, fan
    g = side%gas%gamma
    stiff = side%gas%p_infinity
    c = sqrt(g*(side%pressure + stiff)/side%density)
    ratio = (p + stiff)/(side%pressure + stiff)
    state = [side%density, side%velocity, side%pressure]
    if (p > side%pressure) then
      shock = side%velocity + sign*c*sqrt((g + 1)/(2*g)*ratio + (g - 1)/(2*g))
      if (sign*(xi - shock) > 0) return
      state = [side%density*(ratio + (g - 1)/(g + 1))/(ratio*(g - 1)/(g + 1) + 1), u, p]
    else
      density = side%density*ratio**(1/g)
      c_star = sqrt(g*(p + stiff)/density)
      if (sign*(xi - side%velocity - sign*c) > 0) return
      if (sign*(xi - u - sign*c_star) < 0) then
        state = [density, u, p]
      else
        fan = 2/(g + 1) - sign*(g - 1)/((g + 1)*c)*(side%velocity - xi)
        state = [side%density*fan**(2/(g - 1)), 2/(g + 1)*(-sign*c + (g - 1)/2*side%velocity + xi), &
          (side%pressure + stiff)*fan**(2*g/(g - 1)) - stiff]
      end if
    end if
  end function behind_wave

end module exact_riemann
