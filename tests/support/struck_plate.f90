!> A free plate between two fluids, struck by a weak pulse of pressure p exp(-t/T) that comes through the first (Taylor 1941, The
!> pressure and impulse of submarine explosion waves on plates; the second fluid, which he leaves out, adds its impedance).
module struck_plate
  use kinds, only: wp
  implicit none
  private
  public :: plate_velocity, plate_peak

contains

  !> Velocity at time t after the pulse met the plate. mass: per area; front, back: density times sound speed of the fluids;
  !> mass/(front + back) must not be the duration T of the pulse.
  elemental real(wp) function plate_velocity(t, pressure, duration, mass, front, back) result(velocity)
    real(wp), intent(in) :: t, pressure, duration, mass, front, back
    real(wp) :: ratio
    ratio = duration*(front + back)/mass
    velocity = 2*pressure*duration/mass*(exp(-t/duration) - exp(-ratio*t/duration))/(ratio - 1)
  end function plate_velocity

  !> Largest velocity and when it is reached. The impulse that the plate has by then is mass times velocity.
  pure subroutine plate_peak(pressure, duration, mass, front, back, t, velocity)
    real(wp), intent(in) :: pressure, duration, mass, front, back
    real(wp), intent(out) :: t, velocity
    real(wp) :: ratio
    ratio = duration*(front + back)/mass
    t = duration*log(ratio)/(ratio - 1)
    velocity = plate_velocity(t, pressure, duration, mass, front, back)
  end subroutine plate_peak

end module struck_plate
