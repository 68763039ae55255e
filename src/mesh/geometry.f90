!> Cartesian, cylindrical and spherical meshes: x is the distance from the axis or centre in the last two.
!> A cylindrical mesh of two directions is axisymmetric, y along the axis. Areas and volumes are those of the whole turn (per unit
!> length in one cylindrical direction), so masses and energies are those of the whole body.
module geometry
  use constants, only: pi
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: cell_volumes, x_face_areas, ring_volume

  integer, parameter, public :: cartesian = 0, cylindrical = 1, spherical = 2 !< power of x in the area of its faces
  character(11), parameter, public :: geometry_names(0:2) = [character(11) :: 'cartesian', 'cylindrical', 'spherical']

contains

  !> Volumes of the cells of a row along x of local brick b.
  pure function cell_volumes(mesh, b) result(volume)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b
    real(wp) :: volume(mesh%brick_cells(1)), r(mesh%brick_cells(1) + 1)
    integer :: i
    r = face_positions(mesh, b)
    do i = 1, size(volume)
      volume(i) = mesh%cell_volume*ring_volume(mesh%radial_power, r(i), r(i + 1))
    end do
  end function cell_volumes

  !> Areas of the faces across x, from the low face of the first cell of local brick b.
  pure function x_face_areas(mesh, b) result(area)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b
    real(wp) :: area(mesh%brick_cells(1) + 1), r(mesh%brick_cells(1) + 1)
    r = face_positions(mesh, b)
    select case (mesh%radial_power)
    case (cylindrical); area = 2*pi*r
    case (spherical); area = 4*pi*r*r
    case default; area = 1
    end select
    area = area*mesh%spacing(2)*mesh%spacing(3)
  end function x_face_areas

  !> Positions of the faces across x, counted from the low face of the domain: the same bits however it is cut into bricks.
  pure function face_positions(mesh, b) result(x)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b
    real(wp) :: x(mesh%brick_cells(1) + 1)
    integer :: i, before
    before = mesh%brick(mesh%local(b))%location(1)*mesh%brick_cells(1)
    do i = 1, size(x)
      x(i) = mesh%lower(1) + (before + i - 1)*mesh%spacing(1)
    end do
  end function face_positions

  !> Volume between two radii over their difference; 1 on a Cartesian mesh.
  pure real(wp) function ring_volume(radial_power, inner, outer)
    integer, intent(in) :: radial_power
    real(wp), intent(in) :: inner, outer
    select case (radial_power)
    case (cylindrical); ring_volume = pi*(inner + outer)
    case (spherical); ring_volume = 4*pi/3*(inner*inner + inner*outer + outer*outer)
    case default; ring_volume = 1
    end select
  end function ring_volume

end module geometry
