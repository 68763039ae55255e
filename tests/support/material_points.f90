!> One material point driven along a path of velocity gradients.
module material_points
  use cell_functions, only: chunk
  use deck_types, only: material_group
  use kinds, only: wp
  use particles, only: at_mass, at_volume, at_stress
  use solid_material, only: solid_material_type, make_solid_material
  use stress_update, only: update_stress
  implicit none
  private
  public :: new_point, drive, pressure_of, mises_of

  !> A particle of unit volume.
  type, public :: point_type
    type(solid_material_type) :: material
    real(wp), allocatable :: f(:, :) !< (1, column)
  end type point_type

contains

  !> At rest, without stress. viscosity: with bulk viscosity (none by default).
  function new_point(group, viscosity) result(point)
    type(material_group), intent(in) :: group
    logical, intent(in), optional :: viscosity
    type(point_type) :: point
    logical :: viscous
    viscous = .false.
    if (present(viscosity)) viscous = viscosity
    point%material = make_solid_material(group, viscous)
    allocate (point%f(1, point%material%n_field), source=0.0_wp)
    point%f(1, at_volume) = 1
    point%f(1, at_mass) = point%material%density
  end function new_point

  !> n steps of size dt with the velocity gradient rate(i,j) = dv_i/dx_j.
  subroutine drive(point, rate, n, dt)
    type(point_type), intent(inout) :: point
    real(wp), intent(in) :: rate(3, 3), dt
    integer, intent(in) :: n
    real(wp) :: gradient(chunk, 9)
    integer :: step
    gradient = 0
    gradient(1, :) = dt*reshape(transpose(rate), [9])
    do step = 1, n
      call update_stress(point%material, dt, 1.0_wp, 1, 1, size(point%f, 2), point%f, 1, gradient)
    end do
  end subroutine drive

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

end module material_points
