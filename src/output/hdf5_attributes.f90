!> Attributes of groups and datasets of an HDF5 file. To be called by all ranks, with the same values; errors are fatal.
module hdf5_attributes
  use, intrinsic :: iso_c_binding, only: c_loc, c_ptr
  use, intrinsic :: iso_fortran_env, only: int64, real64
  use hdf5
  use hdf5_files, only: hdf5_file, check_hdf5
  implicit none
  private
  public :: put_attribute, get_attribute

  !> put_attribute(file, object, name, value): a text (fixed-length ASCII) or a list of integers or reals.
  interface put_attribute
    module procedure put_text, put_integers, put_reals
  end interface put_attribute
  !> get_attribute(file, object, name, value): the same number of values as were put.
  interface get_attribute
    module procedure get_text, get_integers, get_reals
  end interface get_attribute

contains

  subroutine put_text(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    character(*), intent(in) :: value
    character(:), allocatable, target :: buffer
    integer(hid_t) :: kind_of_text
    integer :: error
    if (.not. file%ok) return
    buffer = value
    if (len(buffer) == 0) buffer = ' ' ! the library has no text of length zero
    call h5tcopy_f(H5T_C_S1, kind_of_text, error)
    call h5tset_size_f(kind_of_text, int(len(buffer), size_t), error)
    call h5tset_strpad_f(kind_of_text, H5T_STR_NULLPAD_F, error)
    call write_attribute(file, object, name, kind_of_text, 0, c_loc(buffer))
    call h5tclose_f(kind_of_text, error)
  end subroutine put_text

  subroutine put_integers(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    integer, intent(in) :: value(:)
    integer(int64), target :: buffer(size(value))
    buffer = value
    call write_attribute(file, object, name, H5T_STD_I64LE, size(value), c_loc(buffer))
  end subroutine put_integers

  subroutine put_reals(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    real(real64), intent(in) :: value(:)
    real(real64), target :: buffer(size(value))
    buffer = value
    call write_attribute(file, object, name, H5T_NATIVE_DOUBLE, size(value), c_loc(buffer))
  end subroutine put_reals

  !> n: number of values, 0 for a scalar.
  subroutine write_attribute(file, object, name, kind_of_value, n, address)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    integer(hid_t), intent(in) :: kind_of_value
    integer, intent(in) :: n
    type(c_ptr), intent(in) :: address
    integer(hid_t) :: owner, space, attribute
    integer :: error
    if (.not. file%ok) return
    call h5oopen_f(file%id, object, owner, error)
    call check_hdf5(file, error, 'give object '//object)
    if (.not. file%ok) return
    if (n > 0) then
      call h5screate_simple_f(1, [int(n, hsize_t)], space, error)
    else
      call h5screate_f(H5S_SCALAR_F, space, error)
    end if
    call h5acreate_f(owner, name, kind_of_value, space, attribute, error)
    call check_hdf5(file, error, 'take attribute '//name//' of '//object)
    if (file%ok) then
      call h5awrite_f(attribute, kind_of_value, address, error)
      call check_hdf5(file, error, 'take the value of attribute '//name//' of '//object)
      call h5aclose_f(attribute, error)
    end if
    call h5sclose_f(space, error)
    call h5oclose_f(owner, error)
  end subroutine write_attribute

  subroutine get_text(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    character(:), allocatable, intent(out) :: value
    character(:), allocatable, target :: buffer
    type(c_ptr) :: address
    integer(hid_t) :: attribute, kind_of_text
    integer(hsize_t) :: length
    integer :: error
    value = ''
    call open_attribute(file, object, name, attribute)
    if (.not. file%ok) return
    call h5aget_storage_size_f(attribute, length, error)
    allocate (character(length) :: buffer)
    call h5aget_type_f(attribute, kind_of_text, error)
    address = c_loc(buffer)
    call h5aread_f(attribute, kind_of_text, address, error)
    call check_hdf5(file, error, 'give the text of attribute '//name//' of '//object)
    value = trim(buffer)
    call h5tclose_f(kind_of_text, error)
    call h5aclose_f(attribute, error)
  end subroutine get_text

  subroutine get_integers(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    integer, intent(out) :: value(:)
    integer(int64), target :: buffer(size(value))
    buffer = 0
    call read_attribute(file, object, name, H5T_STD_I64LE, size(value), c_loc(buffer))
    value = int(buffer)
  end subroutine get_integers

  subroutine get_reals(file, object, name, value)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    real(real64), intent(out) :: value(:)
    real(real64), target :: buffer(size(value))
    buffer = 0
    call read_attribute(file, object, name, H5T_NATIVE_DOUBLE, size(value), c_loc(buffer))
    value = buffer
  end subroutine get_reals

  subroutine read_attribute(file, object, name, kind_of_value, n, address)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    integer(hid_t), intent(in) :: kind_of_value
    integer, intent(in) :: n
    type(c_ptr), intent(in) :: address
    type(c_ptr) :: buffer
    integer(hid_t) :: attribute
    integer(hsize_t) :: length
    integer :: error
    call open_attribute(file, object, name, attribute)
    if (.not. file%ok) return
    call h5aget_storage_size_f(attribute, length, error)
    if (length /= 8*n) error = -1
    buffer = address
    if (error >= 0) call h5aread_f(attribute, kind_of_value, buffer, error)
    call check_hdf5(file, error, 'give the expected number of values for attribute '//name//' of '//object)
    call h5aclose_f(attribute, error)
  end subroutine read_attribute

  subroutine open_attribute(file, object, name, attribute)
    type(hdf5_file), intent(inout) :: file
    character(*), intent(in) :: object, name
    integer(hid_t), intent(out) :: attribute
    integer :: error
    attribute = -1
    if (.not. file%ok) return
    call h5aopen_by_name_f(file%id, object, name, attribute, error)
    call check_hdf5(file, error, 'give attribute '//name//' of '//object//', which it lacks')
  end subroutine open_attribute

end module hdf5_attributes
