!> A thin layer over parallel HDF5. All ranks open one file together; a dataset is a list of columns (one number each, or `width`
!> numbers), cut into one contiguous run of columns per rank, written and read collectively. Every procedure is to be called by
!> all ranks. An error is fatal and names the file; after one (a test may catch it) further calls on that file do nothing.
module hdf5_files
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use, intrinsic :: iso_fortran_env, only: int32, int64, real32, real64
  use hdf5
  use mpi_f08, only: MPI_INFO_NULL
  use errors, only: fatal
  use parallel, only: is_root, n_ranks, world
  implicit none
  private
  public :: hdf5_file, create_file, open_file, close_file, create_group, has_object, n_columns
  public :: put_slab, get_slab, put_whole, check_hdf5

  !> An open file.
  type :: hdf5_file
    integer(hid_t) :: id = -1
    character(:), allocatable :: name !< path on disk
    logical :: ok = .false. !< open, and nothing has failed yet
  end type hdf5_file

  !> put_slab(file, path, values, offset, total [, width] [, one_byte]): my columns, one after the other in values(:), of a
  !> dataset of `total` columns, `offset` of them before mine. The dataset is made at the first call; more calls may fill more.
  interface put_slab
    module procedure put_real64, put_real32, put_int32, put_int64
  end interface put_slab
  !> get_slab(file, path, values, offset [, width]): columns offset+1 and on, as many as values(:) holds.
  interface get_slab
    module procedure get_real64, get_int32, get_int64
  end interface get_slab
  !> put_whole(file, path, values [, width]): a dataset that every rank holds whole; the root writes it.
  interface put_whole
    module procedure put_whole_real, put_whole_int32, put_whole_int64
  end interface put_whole

  logical :: library_is_open = .false. ! HDF5 is started at the first file

contains

  !> Makes an empty file, replacing one of that name.
  subroutine create_file(file, name)
    type(hdf5_file), intent(out) :: file
    character(*), intent(in) :: name
    integer(hid_t) :: access
    integer :: error
    file%name = trim(name)
    access = parallel_access()
    call h5fcreate_f(file%name, H5F_ACC_TRUNC_F, file%id, error, access_prp=access)
    file%ok = error >= 0
    if (.not. file%ok) call fatal('can''t create "'//file%name//'" (is the folder there and writable, is the disk full?)')
    call h5pclose_f(access, error)
  end subroutine create_file

  !> Opens a file for reading. With missing_ok, a file that can't be opened is no error but leaves file%ok false.
  subroutine open_file(file, name, missing_ok)
    type(hdf5_file), intent(out) :: file
    character(*), intent(in) :: name
    logical, intent(in), optional :: missing_ok
    logical :: forgive
    integer(hid_t) :: access
    integer :: error
    file%name = trim(name)
    access = parallel_access()
    call h5fopen_f(file%name, H5F_ACC_RDONLY_F, file%id, error, access_prp=access)
    file%ok = error >= 0
    forgive = .false.
    if (present(missing_ok)) forgive = missing_ok
    if (.not. (file%ok .or. forgive)) call fatal('can''t open "'//file%name//'": it is missing, unreadable or not a whole file')
    call h5pclose_f(access, error)
  end subroutine open_file

  !> Closes the file; only then is all of it on disk.
  subroutine close_file(file)
    type(hdf5_file), intent(inout) :: file
    integer :: error
    if (file%id < 0) return
    call h5fclose_f(file%id, error)
    call check_hdf5(file, error, 'be closed')
    file%id = -1
    file%ok = .false.
  end subroutine close_file

  !> Makes a group; the groups above it must be there.
  subroutine create_group(file, path)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t) :: group
    integer :: error
    if (.not. file%ok) return
    call h5gcreate_f(file%id, path, group, error)
    call check_hdf5(file, error, 'take group '//path)
    if (file%ok) call h5gclose_f(group, error)
  end subroutine create_group

  !> True if the file has a group or dataset of that path (without a slash in front).
  logical function has_object(file, path) result(found)
    type(hdf5_file), intent(in) :: file
    character(*), intent(in) :: path
    integer :: error, i
    found = file%ok
    do i = 2, len_trim(path) ! the library takes a missing group on the way for an error
      if (found .and. path(i:i) == '/') call h5lexists_f(file%id, path(:i - 1), found, error)
    end do
    if (found) call h5lexists_f(file%id, trim(path), found, error)
  end function has_object

  !> Number of columns (extent of the last dimension) of a dataset.
  integer(int64) function n_columns(file, path) result(columns)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t) :: dataset, space
    integer(hsize_t) :: extent(2), largest(2)
    integer :: error, dimensions
    columns = 0
    call open_dataset(file, path, dataset)
    if (.not. file%ok) return
    call h5dget_space_f(dataset, space, error)
    call h5sget_simple_extent_ndims_f(space, dimensions, error)
    if (dimensions == 1 .or. dimensions == 2) then
      call h5sget_simple_extent_dims_f(space, extent(:dimensions), largest(:dimensions), error)
      columns = extent(dimensions)
    else
      call check_hdf5(file, -1, 'be read: dataset '//path//' has neither one nor two dimensions')
    end if
    call h5sclose_f(space, error)
    call h5dclose_f(dataset, error)
  end function n_columns

  ! ---- datasets ----

  subroutine put_real64(file, path, values, offset, total, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    real(real64), intent(in), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset, total
    integer, intent(in), optional :: width
    real(real64), target :: nothing(1)
    nothing = 0
    if (size(values) > 0) then
      call write_columns(file, path, H5T_NATIVE_DOUBLE, c_loc(values), size(values, kind=int64), offset, total, width)
    else
      call write_columns(file, path, H5T_NATIVE_DOUBLE, c_loc(nothing), 0_int64, offset, total, width)
    end if
  end subroutine put_real64

  subroutine put_real32(file, path, values, offset, total, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    real(real32), intent(in), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset, total
    integer, intent(in), optional :: width
    real(real32), target :: nothing(1)
    nothing = 0
    if (size(values) > 0) then
      call write_columns(file, path, H5T_NATIVE_REAL, c_loc(values), size(values, kind=int64), offset, total, width)
    else
      call write_columns(file, path, H5T_NATIVE_REAL, c_loc(nothing), 0_int64, offset, total, width)
    end if
  end subroutine put_real32

  subroutine put_int32(file, path, values, offset, total, width, one_byte)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int32), intent(in), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset, total
    integer, intent(in), optional :: width
    logical, intent(in), optional :: one_byte !< bytes without a sign on disk
    integer(int32), target :: nothing(1)
    nothing = 0
    if (size(values) > 0) then
      call write_columns(file, path, H5T_NATIVE_INTEGER, c_loc(values), size(values, kind=int64), offset, total, width, one_byte)
    else
      call write_columns(file, path, H5T_NATIVE_INTEGER, c_loc(nothing), 0_int64, offset, total, width, one_byte)
    end if
  end subroutine put_int32

  subroutine put_int64(file, path, values, offset, total, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int64), intent(in), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset, total
    integer, intent(in), optional :: width
    integer(int64), target :: nothing(1)
    nothing = 0
    if (size(values) > 0) then
      call write_columns(file, path, H5T_STD_I64LE, c_loc(values), size(values, kind=int64), offset, total, width)
    else
      call write_columns(file, path, H5T_STD_I64LE, c_loc(nothing), 0_int64, offset, total, width)
    end if
  end subroutine put_int64

  subroutine get_real64(file, path, values, offset, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    real(real64), intent(inout), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset
    integer, intent(in), optional :: width
    real(real64), target :: nothing(1)
    if (size(values) > 0) then
      call read_columns(file, path, H5T_NATIVE_DOUBLE, c_loc(values), size(values, kind=int64), offset, width)
    else
      call read_columns(file, path, H5T_NATIVE_DOUBLE, c_loc(nothing), 0_int64, offset, width)
    end if
  end subroutine get_real64

  subroutine get_int32(file, path, values, offset, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int32), intent(inout), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset
    integer, intent(in), optional :: width
    integer(int32), target :: nothing(1)
    if (size(values) > 0) then
      call read_columns(file, path, H5T_NATIVE_INTEGER, c_loc(values), size(values, kind=int64), offset, width)
    else
      call read_columns(file, path, H5T_NATIVE_INTEGER, c_loc(nothing), 0_int64, offset, width)
    end if
  end subroutine get_int32

  subroutine get_int64(file, path, values, offset, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int64), intent(inout), target, contiguous :: values(:)
    integer(int64), intent(in) :: offset
    integer, intent(in), optional :: width
    integer(int64), target :: nothing(1)
    if (size(values) > 0) then
      call read_columns(file, path, H5T_STD_I64LE, c_loc(values), size(values, kind=int64), offset, width)
    else
      call read_columns(file, path, H5T_STD_I64LE, c_loc(nothing), 0_int64, offset, width)
    end if
  end subroutine get_int64

  subroutine put_whole_real(file, path, values, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    real(real64), intent(in), contiguous :: values(:)
    integer, intent(in), optional :: width
    integer(int64) :: total
    total = size(values)
    if (present(width)) total = total/width
    call put_slab(file, path, values(:merge(size(values), 0, is_root())), 0_int64, total, width)
  end subroutine put_whole_real

  subroutine put_whole_int32(file, path, values, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int32), intent(in), contiguous :: values(:)
    integer, intent(in), optional :: width
    integer(int64) :: total
    total = size(values)
    if (present(width)) total = total/width
    call put_slab(file, path, values(:merge(size(values), 0, is_root())), 0_int64, total, width)
  end subroutine put_whole_int32

  subroutine put_whole_int64(file, path, values, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(int64), intent(in), contiguous :: values(:)
    integer, intent(in), optional :: width
    integer(int64) :: total
    total = size(values)
    if (present(width)) total = total/width
    call put_slab(file, path, values(:merge(size(values), 0, is_root())), 0_int64, total, width)
  end subroutine put_whole_int64

  subroutine write_columns(file, path, memory_type, address, n_values, offset, total, width, one_byte)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t), intent(in) :: memory_type
    type(c_ptr), intent(in) :: address
    integer(int64), intent(in) :: n_values, offset, total
    integer, intent(in), optional :: width
    logical, intent(in), optional :: one_byte
    integer(hid_t) :: dataset, space, disk_type, creation
    integer :: error
    if (.not. file%ok) return
    disk_type = memory_type
    if (present(one_byte)) then
      if (one_byte) disk_type = H5T_STD_U8LE
    end if
    if (has_object(file, path)) then
      call open_dataset(file, path, dataset)
    else
      space = columns_space(total, width)
      call h5pcreate_f(H5P_DATASET_CREATE_F, creation, error)
      call h5pset_alloc_time_f(creation, H5D_ALLOC_TIME_EARLY_F, error) ! the same bytes from one rank as from many,
      call h5pset_obj_track_times_f(creation, .false., error) ! and tomorrow as today
      call h5dcreate_f(file%id, path, disk_type, space, dataset, error, creation)
      call check_hdf5(file, error, 'take dataset '//path)
      call h5pclose_f(creation, error)
      call h5sclose_f(space, error)
    end if
    call transfer_columns(file, path, dataset, memory_type, address, n_values, offset, width, writing=.true.)
  end subroutine write_columns

  subroutine read_columns(file, path, memory_type, address, n_values, offset, width)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t), intent(in) :: memory_type
    type(c_ptr), intent(in) :: address
    integer(int64), intent(in) :: n_values, offset
    integer, intent(in), optional :: width
    integer(hid_t) :: dataset
    call open_dataset(file, path, dataset)
    call transfer_columns(file, path, dataset, memory_type, address, n_values, offset, width, writing=.false.)
  end subroutine read_columns

  !> Moves one run of columns between memory and an open dataset, and closes the dataset.
  subroutine transfer_columns(file, path, dataset, memory_type, address, n_values, offset, width, writing)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t), intent(in) :: dataset, memory_type
    type(c_ptr), intent(in) :: address
    integer(int64), intent(in) :: n_values, offset
    integer, intent(in), optional :: width
    logical, intent(in) :: writing
    integer(hid_t) :: file_space, memory_space, collective
    integer(hsize_t) :: start(2), extent(2), columns
    integer(hssize_t) :: all_values
    type(c_ptr) :: buffer
    integer :: error, status, dimensions
    if (.not. file%ok) return
    buffer = address
    columns = n_values
    if (present(width)) columns = n_values/width
    dimensions = merge(2, 1, present(width))
    start = 0
    start(dimensions) = offset
    if (present(width)) extent(1) = width
    extent(dimensions) = columns
    call h5dget_space_f(dataset, file_space, error)
    memory_space = columns_space(max(columns, 1_hsize_t), width)
    if (columns > 0) then
      call h5sselect_hyperslab_f(file_space, H5S_SELECT_SET_F, start(:dimensions), extent(:dimensions), status)
    else
      call h5sselect_none_f(file_space, status)
      call h5sselect_none_f(memory_space, error)
    end if
    call h5pcreate_f(H5P_DATASET_XFER_F, collective, error)
    if (n_ranks > 1) call h5pset_dxpl_mpio_f(collective, H5FD_MPIO_COLLECTIVE_F, error)
    call h5sget_simple_extent_npoints_f(file_space, all_values, error)
    if (status < 0) then
      call check_hdf5(file, status, 'give or take that part of dataset '//path)
    else if (all_values == 0) then
      continue ! the library can't move nothing at all
    else if (writing) then
      call h5dwrite_f(dataset, memory_type, address, error, memory_space, file_space, collective)
      call check_hdf5(file, error, 'take the values of dataset '//path//' (is the disk full?)')
    else
      call h5dread_f(dataset, memory_type, buffer, error, memory_space, file_space, collective)
      call check_hdf5(file, error, 'give the values of dataset '//path)
    end if
    call h5pclose_f(collective, error)
    call h5sclose_f(memory_space, error)
    call h5sclose_f(file_space, error)
    call h5dclose_f(dataset, error)
  end subroutine transfer_columns

  subroutine open_dataset(file, path, dataset)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: path
    integer(hid_t), intent(out) :: dataset
    integer :: error
    dataset = -1
    if (.not. file%ok) return
    error = -1
    if (has_object(file, path)) call h5dopen_f(file%id, path, dataset, error)
    call check_hdf5(file, error, 'give dataset '//path//', which it lacks')
  end subroutine open_dataset

  integer(hid_t) function columns_space(columns, width) result(space)
    integer(int64), intent(in) :: columns
    integer, intent(in), optional :: width
    integer :: error
    if (present(width)) then
      call h5screate_simple_f(2, [int(width, hsize_t), int(columns, hsize_t)], space, error)
    else
      call h5screate_simple_f(1, [int(columns, hsize_t)], space, error)
    end if
  end function columns_space

  ! ---- the library ----

  !> Settings with which all ranks open a file together.
  integer(hid_t) function parallel_access() result(access)
    integer :: error
    if (.not. library_is_open) then
      call h5open_f(error)
      call h5eset_auto_f(0, error) ! we say ourselves what went wrong
      library_is_open = .true.
    end if
    call h5pcreate_f(H5P_FILE_ACCESS_F, access, error)
    if (n_ranks > 1) call h5pset_fapl_mpio_f(access, world%MPI_VAL, MPI_INFO_NULL%MPI_VAL, error) ! else plain files
  end function parallel_access

  !> Fatal if the last call of the library failed; what: ends the sentence "file ... can't ...".
  subroutine check_hdf5(file, error, what)
    type(hdf5_file), intent(inout) :: file
    integer, intent(in) :: error
    character(*), intent(in) :: what
    if (error >= 0 .or. .not. file%ok) return
    file%ok = .false.
    call fatal('file "'//file%name//'" can''t '//what)
  end subroutine check_hdf5

end module hdf5_files
