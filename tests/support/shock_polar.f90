!> Oblique shocks in an ideal gas, and what becomes of a plane shock that runs onto a wedge: regular reflection of two shocks, which
!> ends at detachment, or Mach reflection of three (Ben-Dor 2007, Shock Wave Reflection Phenomena, ch. 1 and 3). Seen from the point
!> where the shocks meet the flow is steady; the Mach stem is taken to be straight and at right angles to the wedge. Angles in
!> radian.
module shock_polar
  use constants, only: pi
  use kinds, only: wp
  implicit none
  private
  public :: pressure_ratio, deflection, mach_behind, detached_at, regular_pressure, detachment_angle, triple_point_angle

contains

  !> Pressure behind a shock at this angle to a flow of this Mach number, over that ahead.
  pure real(wp) function pressure_ratio(gamma, mach, angle)
    real(wp), intent(in) :: gamma, mach, angle
    pressure_ratio = 1 + 2*gamma/(gamma + 1)*((mach*sin(angle))**2 - 1)
  end function pressure_ratio

  !> By how much the shock turns the flow.
  pure real(wp) function deflection(gamma, mach, angle)
    real(wp), intent(in) :: gamma, mach, angle
    deflection = atan(2/tan(angle)*((mach*sin(angle))**2 - 1)/(mach**2*(gamma + cos(2*angle)) + 2))
  end function deflection

  !> Mach number of the flow behind the shock.
  pure real(wp) function mach_behind(gamma, mach, angle)
    real(wp), intent(in) :: gamma, mach, angle
    real(wp) :: normal
    normal = (mach*sin(angle))**2
    mach_behind = sqrt(((gamma - 1)*normal + 2)/(2*gamma*normal - gamma + 1))/sin(angle - deflection(gamma, mach, angle))
  end function mach_behind

  !> Angle of the shock that turns the flow the most (golden section).
  pure real(wp) function detached_at(gamma, mach) result(angle)
    real(wp), intent(in) :: gamma, mach
    real(wp), parameter :: golden = 0.6180339887498949_wp
    real(wp) :: low, high, a, b
    integer :: i
    low = asin(1/mach)
    high = 0.5_wp*pi
    do i = 1, 60
      a = high - golden*(high - low)
      b = low + golden*(high - low)
      if (deflection(gamma, mach, a) < deflection(gamma, mach, b)) then
        low = a
      else
        high = b
      end if
    end do
    angle = 0.5_wp*(low + high)
  end function detached_at

  !> Pressure behind the reflected shock over that ahead of the incident one, a shock of Mach number `mach` on a wedge; the weaker
  !> of the two solutions, 0 where regular reflection cannot be.
  pure real(wp) function regular_pressure(gamma, mach, wedge) result(pressure)
    real(wp), intent(in) :: gamma, mach, wedge
    real(wp) :: flow, behind, turn, low, high, angle
    integer :: i
    pressure = 0
    flow = mach/cos(wedge)
    angle = 0.5_wp*pi - wedge
    turn = deflection(gamma, flow, angle)
    behind = mach_behind(gamma, flow, angle)
    if (behind <= 1) return
    low = asin(1/behind)
    high = detached_at(gamma, behind)
    if (deflection(gamma, behind, high) < turn) return
    do i = 1, 60
      angle = 0.5_wp*(low + high)
      if (deflection(gamma, behind, angle) < turn) then
        low = angle
      else
        high = angle
      end if
    end do
    pressure = pressure_ratio(gamma, flow, 0.5_wp*pi - wedge)*pressure_ratio(gamma, behind, angle)
  end function regular_pressure

  !> Angle of the wedge below which a shock cannot reflect regularly.
  pure real(wp) function detachment_angle(gamma, mach) result(wedge)
    real(wp), intent(in) :: gamma, mach
    real(wp) :: low, high
    integer :: i
    low = 0.02_wp*pi
    high = 0.49_wp*pi
    do i = 1, 50
      wedge = 0.5_wp*(low + high)
      if (regular_pressure(gamma, mach, wedge) > 0) then
        high = wedge
      else
        low = wedge
      end if
    end do
  end function detachment_angle

  !> Angle between the wedge and the path of the triple point of a Mach reflection, 0 where there is none; stem: pressure behind the
  !> foot of the Mach stem over that ahead.
  pure subroutine triple_point_angle(gamma, mach, wedge, angle, stem)
    real(wp), intent(in) :: gamma, mach, wedge
    real(wp), intent(out) :: angle, stem
    real(wp) :: low, high, mismatch_low, mismatch
    integer :: i
    integer, parameter :: n = 400
    angle = 0
    stem = 0
    mismatch_low = huge(1.0_wp)
    do i = 1, n - 1
      high = i*(0.5_wp*pi - wedge)/n
      mismatch = mismatch_of_turns(gamma, mach, wedge, high)
      if (mismatch < huge(1.0_wp) .and. mismatch_low < huge(1.0_wp) .and. &
        (mismatch > 0 .neqv. mismatch_low > 0)) exit
      low = high
      mismatch_low = mismatch
    end do
    if (i == n) return
    do i = 1, 50
      angle = 0.5_wp*(low + high)
      mismatch = mismatch_of_turns(gamma, mach, wedge, angle)
      if (mismatch > 0 .eqv. mismatch_low > 0) then
        low = angle
      else
        high = angle
      end if
    end do
    stem = pressure_ratio(gamma, mach*cos(angle)/cos(wedge + angle), 0.5_wp*pi)
  end subroutine triple_point_angle

  !> Turn through incident and reflected shock less that through the stem, at equal pressure behind; huge where there is no such
  !> reflected shock.
  pure real(wp) function mismatch_of_turns(gamma, mach, wedge, angle) result(mismatch)
    real(wp), intent(in) :: gamma, mach, wedge, angle
    real(wp) :: flow, incident, behind, ratio, normal
    mismatch = huge(1.0_wp)
    incident = 0.5_wp*pi - wedge - angle
    flow = mach/sin(incident)
    behind = mach_behind(gamma, flow, incident)
    ratio = pressure_ratio(gamma, flow, 0.5_wp*pi - angle)/pressure_ratio(gamma, flow, incident)
    if (ratio < 1) return
    normal = sqrt(1 + (ratio - 1)*(gamma + 1)/(2*gamma))
    if (normal >= behind) return
    mismatch = deflection(gamma, flow, incident) - deflection(gamma, behind, asin(normal/behind)) &
               - deflection(gamma, flow, 0.5_wp*pi - angle)
  end function mismatch_of_turns

end module shock_polar
