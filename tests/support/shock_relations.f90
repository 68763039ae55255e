!> Rankine-Hugoniot relations of a shock in any equation of state (Toro 2009, ch. 3; Zel'dovich & Raizer 1967, ch. I).
module shock_relations
  use equation_of_state, only: eos_type
  use kinds, only: wp
  implicit none
  private
  public :: shock_jump, reflected_pressure

contains

  !> What a shock that raises (r, p) to pressure p_new does: density behind it, change of the material's velocity in the
  !> direction of the shock, speed of the shock against the material ahead. Without a rise it is a sound wave. Compressions up to
  !> a hundredth of the volume are looked at.
  pure subroutine shock_jump(eos, r, p, p_new, density, velocity, speed)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_new
    real(wp), intent(out) :: density, velocity, speed
    real(wp) :: low, high, middle
    integer :: i
    if (eos%is_gas) then
      associate (g => eos%gas%gamma, stiffness => eos%gas%p_infinity)
        density = r*((g + 1)*(p_new + stiffness) + (g - 1)*(p + stiffness)) &
          /((g - 1)*(p_new + stiffness) + (g + 1)*(p + stiffness))
        speed = sqrt(0.5_wp*((g + 1)*(p_new + stiffness) + (g - 1)*(p + stiffness))/r)
        velocity = (p_new - p)/(r*speed)
      end associate
      return
    end if
    density = r
    velocity = 0
    speed = sqrt(eos%sound_speed_squared(r, p))
    if (p_new <= p) return
    ! the unknown is the part 1 - r/density of the volume that is lost; the first crossing is the shock
    low = 0
    high = 0.01_wp
    do while (excess_energy(eos, r, p, p_new, high) > 0 .and. high < 0.985_wp)
      low = high
      high = high + 0.01_wp
    end do
    do i = 1, 80
      middle = 0.5_wp*(low + high)
      if (excess_energy(eos, r, p, p_new, middle) > 0) then
        low = middle
      else
        high = middle
      end if
    end do
    if (.not. high > 0) return
    density = r/(1 - high)
    velocity = sqrt((p_new - p)*high/r)
    speed = sqrt((p_new - p)/(r*high))
  end subroutine shock_jump

  !> Energy of the state behind the shock less that which the Hugoniot relation e - e0 = (p + p0) (1/r0 - 1/r)/2 gives it.
  pure real(wp) function excess_energy(eos, r, p, p_new, lost)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_new, lost
    excess_energy = eos%energy(r/(1 - lost), p_new) - eos%energy(r, p) - 0.5_wp*(p + p_new)*lost/r
  end function excess_energy

  !> Pressure behind the shock that a rigid wall sends back, when a shock of pressure p_incident came through (r, p) at rest:
  !> the second shock undoes the velocity of the first.
  pure real(wp) function reflected_pressure(eos, r, p, p_incident) result(pressure)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_incident
    real(wp) :: r_incident, velocity, speed, low, high, r_trial, velocity_trial
    integer :: i
    call shock_jump(eos, r, p, p_incident, r_incident, velocity, speed)
    low = p_incident
    high = p_incident + r_incident*velocity*(velocity + sqrt(eos%sound_speed_squared(r_incident, p_incident)))
    velocity_trial = 0
    do while (velocity_trial < velocity)
      high = high + 2*(high - low)
      call shock_jump(eos, r_incident, p_incident, high, r_trial, velocity_trial, speed)
    end do
    do i = 1, 100
      pressure = 0.5_wp*(low + high)
      call shock_jump(eos, r_incident, p_incident, pressure, r_trial, velocity_trial, speed)
      if (velocity_trial < velocity) then
        low = pressure
      else
        high = pressure
      end if
    end do
  end function reflected_pressure

end module shock_relations
