!> What every snapshot file says of itself beside its data: a group /brisance that other readers pass over.
module snapshot_header
  use geometry, only: geometry_names
  use hdf5_attributes, only: put_attribute
  use hdf5_files, only: hdf5_file, create_group
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: snapshot_clock, put_header, thin_spacing

  !> When and of what run.
  type :: snapshot_clock
    character(:), allocatable :: title
    character(:), allocatable :: length_unit, time_unit
    real(wp) :: time = 0
    integer :: step = 0
  end type snapshot_clock

contains

  !> content: 'flow', 'solid' or 'peaks'.
  subroutine put_header(file, content, clock, mesh)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: content
    type(snapshot_clock), intent(in) :: clock
    type(mesh_type), intent(in) :: mesh
    character(*), parameter :: group = 'brisance'
    call create_group(file, group)
    call put_attribute(file, group, 'format', [1])
    call put_attribute(file, group, 'content', content)
    call put_attribute(file, group, 'title', clock%title)
    call put_attribute(file, group, 'time', [clock%time])
    call put_attribute(file, group, 'step', [clock%step])
    call put_attribute(file, group, 'length_unit', clock%length_unit)
    call put_attribute(file, group, 'time_unit', clock%time_unit)
    call put_attribute(file, group, 'geometry', trim(geometry_names(mesh%radial_power)))
    call put_attribute(file, group, 'cells', mesh%cells)
    call put_attribute(file, group, 'active', merge(1, 0, mesh%active))
    call put_attribute(file, group, 'lower', mesh%lower)
    call put_attribute(file, group, 'upper', mesh%upper)
  end subroutine put_header

  !> Cell size as drawn: a direction without cells is drawn as thin as the finest cell, not one unit of length thick.
  pure function thin_spacing(mesh) result(spacing)
    type(mesh_type), intent(in) :: mesh
    real(wp) :: spacing(3)
    spacing = merge(mesh%spacing, minval(mesh%spacing, mask=mesh%active), mesh%active)
  end function thin_spacing

end module snapshot_header
