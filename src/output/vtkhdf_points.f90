!> Particles as a VTKHDF file of type UnstructuredGrid, version 1.0, one vertex cell per particle. Real numbers are single precision
!> on disk. Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
module vtkhdf_points
  use, intrinsic :: iso_fortran_env, only: real32
  use file_system, only: publish_file
  use hdf5_attributes, only: put_attribute
  use hdf5_files, only: hdf5_file, create_file, close_file, create_group, put_slab, put_whole
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allgather, MPI_INTEGER8
  use parallel, only: n_ranks, rank, world
  use single_precision, only: single
  use snapshot_header, only: snapshot_clock, put_header, thin_spacing
  implicit none
  private
  public :: point_file, create_point_file, put_points, close_point_file

  !> A point file being written, aside until it is closed.
  type :: point_file
    type(hdf5_file) :: hdf5
    character(:), allocatable :: name !< path that the file gets when it is whole
    integer :: mine = 0 !< points of this rank
    integer(i8) :: offset = 0 !< points of the ranks before
    integer(i8) :: total = 0 !< points of all ranks
  end type point_file

  !> put_points(file, name, unit, values [, width | one_byte]): one field, of all my points one after the other.
  interface put_points
    module procedure put_real_points, put_integer_points
  end interface put_points

contains

  !> Opens the file and writes the points. position(3*n): of this rank's points, x y z of one after the other.
  subroutine create_point_file(file, name, clock, mesh, position)
    type(point_file), intent(out) :: file
    character(*), intent(in) :: name
    type(snapshot_clock), intent(in) :: clock
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: position(:)
    integer(i8) :: counts(n_ranks), offsets(1)
    integer, allocatable :: identity(:)
    real(real32), allocatable :: drawn(:)
    integer :: i, d, last
    real(wp) :: thickness
    integer, parameter :: vertex = 1
    file%name = name
    file%mine = size(position)/3
    call MPI_Allgather(int(file%mine, i8), 1, MPI_INTEGER8, counts, 1, MPI_INTEGER8, world)
    file%offset = sum(counts(:rank))
    file%total = sum(counts)
    call create_file(file%hdf5, name//'.part')
    call create_group(file%hdf5, 'VTKHDF')
    call put_attribute(file%hdf5, 'VTKHDF', 'Version', [1, 0])
    call put_attribute(file%hdf5, 'VTKHDF', 'Type', 'UnstructuredGrid')
    call create_group(file%hdf5, 'VTKHDF/PointData')
    call create_group(file%hdf5, 'VTKHDF/CellData')
    call create_group(file%hdf5, 'VTKHDF/FieldData')
    offsets = file%total
    call put_whole(file%hdf5, 'VTKHDF/NumberOfPoints', offsets)
    call put_whole(file%hdf5, 'VTKHDF/NumberOfCells', offsets)
    call put_whole(file%hdf5, 'VTKHDF/NumberOfConnectivityIds', offsets)
    allocate (drawn(size(position)))
    do d = 1, 3
      thickness = 1
      if (.not. mesh%active(d)) thickness = minval(thin_spacing(mesh))
      drawn(d::3) = single(thickness*position(d::3))
    end do
    call put_slab(file%hdf5, 'VTKHDF/Points', drawn, file%offset, file%total, 3)
    allocate (identity(file%mine + 1))
    identity(:) = [(int(file%offset) + i, i=0, file%mine)]
    call put_slab(file%hdf5, 'VTKHDF/Connectivity', identity(:file%mine), file%offset, file%total)
    last = merge(file%mine + 1, file%mine, rank == n_ranks - 1) ! there is one offset more than cells
    call put_slab(file%hdf5, 'VTKHDF/Offsets', identity(:last), file%offset, file%total + 1)
    identity(:) = vertex
    call put_slab(file%hdf5, 'VTKHDF/Types', identity(:file%mine), file%offset, file%total, one_byte=.true.)
    call put_header(file%hdf5, 'solid', clock, mesh)
  end subroutine create_point_file

  subroutine put_real_points(file, name, unit, values, width)
    type(point_file), intent(inout) :: file
    character(*), intent(in) :: name, unit
    real(wp), intent(in) :: values(:)
    integer, intent(in), optional :: width
    real(real32), allocatable :: short(:)
    allocate (short(size(values)))
    short(:) = single(values)
    call put_slab(file%hdf5, 'VTKHDF/PointData/'//name, short, file%offset, file%total, width)
    call put_attribute(file%hdf5, 'VTKHDF/PointData/'//name, 'unit', trim(unit))
  end subroutine put_real_points

  subroutine put_integer_points(file, name, unit, values, one_byte)
    type(point_file), intent(inout) :: file
    character(*), intent(in) :: name, unit
    integer, intent(in), contiguous :: values(:)
    logical, intent(in), optional :: one_byte !< all are 0 to 255
    call put_slab(file%hdf5, 'VTKHDF/PointData/'//name, values, file%offset, file%total, one_byte=one_byte)
    call put_attribute(file%hdf5, 'VTKHDF/PointData/'//name, 'unit', trim(unit))
  end subroutine put_integer_points

  !> Finishes the file and gives it its name.
  subroutine close_point_file(file)
    type(point_file), intent(inout) :: file
    call close_file(file%hdf5)
    call publish_file(file%name//'.part', file%name)
  end subroutine close_point_file

end module vtkhdf_points
