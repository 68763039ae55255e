!> Detonation speed and pressure that follow from a JWL: the point where the Rayleigh line touches the products' Hugoniot.
module chapman_jouguet
  use kinds, only: wp
  use jwl, only: jwl_type, jwl_pressure
  implicit none
  private
  public :: chapman_jouguet_state

contains

  !> Speed D, pressure and relative volume V of the Chapman-Jouguet point of an explosive at rest at zero pressure. The speed
  !> is 0 for constants that allow no detonation.
  !> Hugoniot: E - E0 = p (1 - V)/2; Rayleigh line: r0 D**2 = p/(1 - V), whose smallest value on the Hugoniot is the point.
  pure subroutine chapman_jouguet_state(eos, speed, pressure, relative_volume)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(out) :: speed, pressure, relative_volume
    real(wp), parameter :: golden = 0.618033988749894848_wp
    real(wp) :: low, high, left, right, best, trial
    integer :: i
    ! a coarse scan first: the slope is not monotonic far from the point
    best = 0.4_wp
    do i = 1, 55
      trial = 0.4_wp + 0.01_wp*i
      if (rayleigh_slope(eos, trial) < rayleigh_slope(eos, best)) best = trial
    end do
    low = best - 0.01_wp
    high = best + 0.01_wp
    do i = 1, 60
      left = high - golden*(high - low)
      right = low + golden*(high - low)
      if (rayleigh_slope(eos, left) < rayleigh_slope(eos, right)) then
        high = right
      else
        low = left
      end if
    end do
    relative_volume = 0.5_wp*(low + high)
    pressure = hugoniot_pressure(eos, relative_volume)
    speed = sqrt(max(rayleigh_slope(eos, relative_volume), 0.0_wp)/eos%density)
  end subroutine chapman_jouguet_state

  pure real(wp) function rayleigh_slope(eos, v)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(in) :: v
    rayleigh_slope = hugoniot_pressure(eos, v)/(1 - v)
  end function rayleigh_slope

  !> Pressure of the products at relative volume v on the Hugoniot centred on the unreacted explosive.
  pure real(wp) function hugoniot_pressure(eos, v)
    type(jwl_type), intent(in) :: eos
    real(wp), intent(in) :: v
    hugoniot_pressure = jwl_pressure(eos, eos%density/v, eos%energy_per_volume/eos%density) &
      /(1 - 0.5_wp*eos%omega*(1 - v)/v)
  end function hugoniot_pressure

end module chapman_jouguet
