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
    real(wp) :: volume(mesh%brick_cells(1)), inner
    integer :: i
    do i = 1, size(volume)
      inner = mesh%brick(mesh%local(b))%origin(1) + (i - 1)*mesh%spacing(1)
      volume(i) = mesh%cell_volume*ring_volume(mesh%radial_power, inner, inner + mesh%spacing(1))
    end do
  end function cell_volumes

  !> Areas of the faces across x, from the low face of the first cell of local brick b.
  pure function x_face_areas(mesh, b) result(area)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b
    real(wp) :: area(mesh%brick_cells(1) + 1), r
    integer :: i
    do i = 1, size(area)
      r = mesh%brick(mesh%local(b))%origin(1) + (i - 1)*mesh%spacing(1)
      select case (mesh%radial_power)
      case (cylindrical); area(i) = 2*pi*r
      case (spherical); area(i) = 4*pi*r*r
      case default; area(i) = 1
      end select
      area(i) = area(i)*mesh%spacing(2)*mesh%spacing(3)
    end do
  end function x_face_areas

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
