!> One material point that is driven along a path of velocity gradients, or with its lateral stress held.
module material_point
  use cell_functions, only: chunk
  use kinds, only: wp
  use particles, only: at_mass, at_volume, at_stress, at_energy
  use solid_material, only: solid_material_type, model_fluid
  use particle_fluid, only: fluid_energy, fluid_rest_pressure
  use stress_update, only: update_stress
  implicit none
  private
  public :: start_point, drive, drive_held, pressure_of, mises_of, lateral_stress_of

  !> A particle of unit volume.
  type, public :: point_type
    type(solid_material_type) :: material
    real(wp) :: length = 1 !< size of the cell that it stands for
    real(wp), allocatable :: f(:, :) !< (1, column)
  end type point_type

contains

  !> At rest, without stress; a fluid at the energy of the explosive or without pressure.
  function start_point(material, length) result(point)
    type(solid_material_type), intent(in) :: material
    real(wp), intent(in) :: length
    type(point_type) :: point
    point%material = material
    point%length = length
    allocate (point%f(1, material%n_field), source=0.0_wp)
    point%f(1, at_volume) = 1
    point%f(1, at_mass) = material%density
    if (material%at_strength > 0) point%f(1, material%at_strength) = 1
    if (material%at_stiffness > 0) point%f(1, material%at_stiffness) = 1
    if (material%model /= model_fluid) return
    point%f(1, at_energy) = material%density*fluid_energy(material%eos, material%density, 0.0_wp)
    point%f(1, at_stress:at_stress + 2) = -fluid_rest_pressure(material%eos, material%density, &
      point%f(1, at_energy)/material%density)
  end function start_point

  !> n steps of size dt with the velocity gradient rate(i,j) = dv_i/dx_j.
  pure subroutine drive(point, rate, n, dt)
    type(point_type), intent(inout) :: point
    real(wp), intent(in) :: rate(3, 3), dt
    integer, intent(in) :: n
    real(wp) :: gradient(chunk, 9)
    integer :: step
    gradient = 0
    gradient(1, :) = dt*reshape(transpose(rate), [9])
    do step = 1, n
      call update_stress(point%material, dt, point%length, 1, 1, size(point%f, 2), point%f, 1, gradient)
    end do
  end subroutine drive

  !> One step with the axial strain rate given (x) and the lateral stress (mean of y and z) held at the target.
  !>
  !> lateral: the lateral strain rate that does it; on entry a guess, that of the step before. The stress rises with it, so it is
  !> bracketed and found by the regula falsi (Illinois).
  pure subroutine drive_held(point, axial, target, dt, lateral)
    type(point_type), intent(inout) :: point
    real(wp), intent(in) :: axial, target, dt
    real(wp), intent(inout) :: lateral
    real(wp) :: low, high, at_low, at_high, width, x, value, tolerance
    integer :: i, last
    tolerance = 1e-9_wp*(point%material%bulk_modulus*abs(axial)*dt + abs(target))
    x = lateral
    value = excess(x)
    width = 0.1_wp*abs(axial)
    low = x
    high = x
    at_low = value
    at_high = value
    do i = 1, 60
      if (at_low <= 0 .and. at_high >= 0) exit
      if (at_low > 0) then
        high = low
        at_high = at_low
        low = low - width
        at_low = excess(low)
      else
        low = high
        at_low = at_high
        high = high + width
        at_high = excess(high)
      end if
      width = 2*width
    end do
    last = 0
    do i = 1, 100
      if (abs(value) <= tolerance .or. high - low <= epsilon(1.0_wp)*abs(axial)) exit
      x = (low*at_high - high*at_low)/max(at_high - at_low, tiny(1.0_wp))
      if (.not. (x > low .and. x < high)) x = 0.5_wp*(low + high)
      value = excess(x)
      if (value < 0) then
        low = x
        at_low = value
        if (last < 0) at_high = 0.5_wp*at_high
        last = -1
      else
        high = x
        at_high = value
        if (last > 0) at_low = 0.5_wp*at_low
        last = 1
      end if
    end do
    lateral = x
    call drive(point, stretch(x), 1, dt)

  contains

    pure real(wp) function excess(lateral_rate)
      real(wp), intent(in) :: lateral_rate
      type(point_type) :: trial
      trial = point
      call drive(trial, stretch(lateral_rate), 1, dt)
      excess = lateral_stress_of(trial) - target
    end function excess

    pure function stretch(lateral_rate) result(rate)
      real(wp), intent(in) :: lateral_rate
      real(wp) :: rate(3, 3)
      rate = 0
      rate(1, 1) = axial
      rate(2, 2) = lateral_rate
      rate(3, 3) = lateral_rate
    end function stretch

  end subroutine drive_held

  pure real(wp) function lateral_stress_of(point)
    type(point_type), intent(in) :: point
    lateral_stress_of = 0.5_wp*(point%f(1, at_stress + 1) + point%f(1, at_stress + 2))
  end function lateral_stress_of

  pure real(wp) function pressure_of(point)
    type(point_type), intent(in) :: point
    pressure_of = -sum(point%f(1, at_stress:at_stress + 2))/3
  end function pressure_of

  !> Von Mises stress.
  pure real(wp) function mises_of(point)
    type(point_type), intent(in) :: point
    real(wp) :: s(3)
    s = point%f(1, at_stress:at_stress + 2) + pressure_of(point)
    mises_of = sqrt(1.5_wp*(sum(s**2) + 2*sum(point%f(1, at_stress + 3:at_stress + 5)**2)))
  end function mises_of

end module material_point
