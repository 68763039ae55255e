!> Material points from groups of a deck, for tests.
module material_points
  use deck_types, only: material_group
  use kinds, only: wp
  use material_point, only: point_type, start_point, drive, drive_held, pressure_of, mises_of, lateral_stress_of
  use solid_material, only: make_solid_material
  implicit none
  private
  public :: point_type, new_point, drive, drive_held, pressure_of, mises_of, lateral_stress_of

contains

  !> At rest, without stress. viscosity: with bulk viscosity (none by default); length: of its cell (1 by default).
  function new_point(group, viscosity, length) result(point)
    type(material_group), intent(in) :: group
    logical, intent(in), optional :: viscosity
    real(wp), intent(in), optional :: length
    type(point_type) :: point
    logical :: viscous
    real(wp) :: size
    viscous = .false.
    if (present(viscosity)) viscous = viscosity
    size = 1
    if (present(length)) size = length
    point = start_point(make_solid_material(group, viscous), size)
  end function new_point

end module material_points
