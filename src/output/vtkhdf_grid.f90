!> Cell data as a VTKHDF file of type OverlappingAMR, version 1.0, one box per brick: the form that every reader from VTK 9.2 and
!> ParaView 5.11 on opens. Numbers are single precision on disk. Bricks stand in curve order, so a file does not show the ranks.
!> Format: https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
module vtkhdf_grid
  use, intrinsic :: iso_fortran_env, only: real32
  use blocks, only: block, holder
  use file_system, only: publish_file
  use hdf5_attributes, only: put_attribute
  use hdf5_files, only: hdf5_file, create_file, close_file, create_group, put_slab, put_whole
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  use single_precision, only: single
  use snapshot_header, only: snapshot_clock, put_header, thin_spacing
  implicit none
  private
  public :: grid_file, create_grid_file, put_cells, close_grid_file

  !> A grid file being written, aside until it is closed.
  type :: grid_file
    type(hdf5_file) :: hdf5
    character(:), allocatable :: name !< path that the file gets when it is whole
    integer(i8) :: offset = 0 !< cells of the bricks before mine
    integer(i8) :: total = 0 !< cells of all bricks
  end type grid_file

  character(*), parameter :: level = 'VTKHDF/Level0'

contains

  !> Opens the file and writes the boxes. content: 'flow' or 'peaks'.
  subroutine create_grid_file(file, name, content, clock, mesh)
    type(grid_file), intent(out) :: file
    character(*), intent(in) :: name, content
    type(snapshot_clock), intent(in) :: clock
    type(mesh_type), intent(in) :: mesh
    integer :: box(6, size(mesh%brick)), b, low(3), per_brick
    file%name = name
    per_brick = product(mesh%brick_cells)
    file%total = int(per_brick, i8)*size(mesh%brick)
    if (mesh%n_local > 0) file%offset = int(per_brick, i8)*(mesh%local(1) - 1)
    do b = 1, size(mesh%brick)
      low = mesh%brick(b)%location*mesh%brick_cells
      box(1::2, b) = low
      box(2::2, b) = low + mesh%brick_cells - 1
    end do
    call create_file(file%hdf5, name//'.part')
    call create_group(file%hdf5, 'VTKHDF')
    call put_attribute(file%hdf5, 'VTKHDF', 'Version', [1, 0])
    call put_attribute(file%hdf5, 'VTKHDF', 'Type', 'OverlappingAMR')
    call put_attribute(file%hdf5, 'VTKHDF', 'GridDescription', 'XYZ')
    call put_attribute(file%hdf5, 'VTKHDF', 'Origin', mesh%lower)
    call create_group(file%hdf5, level)
    call put_attribute(file%hdf5, level, 'Spacing', thin_spacing(mesh))
    call create_group(file%hdf5, level//'/CellData')
    call create_group(file%hdf5, level//'/PointData')
    call create_group(file%hdf5, level//'/FieldData')
    call put_whole(file%hdf5, level//'/AMRBox', reshape(box, [size(box)]), 6)
    call put_header(file%hdf5, content, clock, mesh)
  end subroutine create_grid_file

  !> Writes one field. blocks: of the local bricks; columns: the variables that are its components (1 or 3); remainder: the field is
  !> instead what the columns together lack of 1; absent: value in a brick whose block is not allocated (default 0).
  subroutine put_cells(file, mesh, name, unit, blocks, columns, remainder, absent)
    type(grid_file), intent(inout) :: file
    type(mesh_type), intent(in) :: mesh
    character(*), intent(in) :: name, unit
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: columns(:)
    logical, intent(in), optional :: remainder
    real(wp), intent(in), optional :: absent
    real(real32), allocatable :: values(:)
    integer :: b, h, width, per_brick
    logical :: rest
    real(wp) :: missing
    rest = .false.
    if (present(remainder)) rest = remainder
    missing = 0
    if (present(absent)) missing = absent
    width = merge(1, size(columns), rest)
    per_brick = width*product(mesh%brick_cells)
    allocate (values(per_brick*mesh%n_local))
    do b = 1, mesh%n_local
      h = holder(blocks, b)
      if (allocated(blocks(h)%a)) then
        call collect_cells(mesh%brick_cells, blocks(h), columns, rest, values((b - 1)*per_brick + 1:b*per_brick))
      else
        values((b - 1)*per_brick + 1:b*per_brick) = real(missing, real32)
      end if
    end do
    if (width == 1) then
      call put_slab(file%hdf5, level//'/CellData/'//name, values, file%offset, file%total)
    else
      call put_slab(file%hdf5, level//'/CellData/'//name, values, file%offset, file%total, width)
    end if
    call put_attribute(file%hdf5, level//'/CellData/'//name, 'unit', trim(unit))
  end subroutine put_cells

  !> The cells of one block without its ghosts, components together, x fastest, in single precision.
  pure subroutine collect_cells(n, b, columns, rest, values)
    integer, intent(in) :: n(3)
    type(block), intent(in) :: b
    integer, intent(in) :: columns(:)
    logical, intent(in) :: rest
    real(real32), intent(out) :: values(:)
    integer :: i, j, k, c, place
    place = 0
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          if (rest) then
            place = place + 1
            values(place) = single(1 - sum(b%a(i, columns, j, k)))
          else
            do c = 1, size(columns)
              place = place + 1
              values(place) = single(b%a(i, columns(c), j, k))
            end do
          end if
        end do
      end do
    end do
  end subroutine collect_cells

  !> Finishes the file and gives it its name.
  subroutine close_grid_file(file)
    type(grid_file), intent(inout) :: file
    call close_file(file%hdf5)
    call publish_file(file%name//'.part', file%name)
  end subroutine close_grid_file

end module vtkhdf_grid
