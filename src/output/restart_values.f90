!> Small data of a restart file, which every rank holds alike: clock, counters, books, gauges. To be called by all ranks.
module restart_values
  use errors, only: fatal
  use hdf5_attributes, only: get_attribute, put_attribute
  use hdf5_files, only: get_slab, n_columns, put_whole
  use kinds, only: wp, i8
  use restart_files, only: restart_file
  use text, only: str
  implicit none
  private
  public :: restart_put, restart_get, restart_count

  !> restart_put(file, name, value): a real, integer, long integer, logical or text, a list of reals, integers or long integers, or
  !> a table of reals.
  interface restart_put
    module procedure put_real, put_integer, put_long, put_logical, put_text, put_reals, put_integers, put_longs, put_table
  end interface restart_put
  !> restart_get(file, name, value): what restart_put wrote. A list or table must have the size that was written; else fatal.
  interface restart_get
    module procedure get_real, get_integer, get_long, get_logical, get_text, get_reals, get_integers, get_longs, get_table
  end interface restart_get

contains

  !> Number of numbers in a list or table.
  integer function restart_count(file, name) result(n)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    n = int(n_columns(file%hdf5, 'state/'//name))
  end function restart_count

  !> Fatal unless the list has the size that is asked for.
  subroutine check_count(file, name, n)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: n
    integer :: there
    there = restart_count(file, name)
    if (there == n .or. .not. file%hdf5%ok) return
    file%hdf5%ok = .false.
    call fatal('restart file "'//file%name//'": '//name//' has '//str(there)//' numbers, not '//str(n)//'; the deck has changed')
  end subroutine check_count

  subroutine put_reals(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(in) :: value(:)
    call put_whole(file%hdf5, 'state/'//name, value)
  end subroutine put_reals

  subroutine get_reals(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(inout) :: value(:)
    call check_count(file, name, size(value))
    call get_slab(file%hdf5, 'state/'//name, value, 0_i8)
  end subroutine get_reals

  subroutine put_integers(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: value(:)
    call put_whole(file%hdf5, 'state/'//name, value)
  end subroutine put_integers

  subroutine get_integers(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(inout) :: value(:)
    call check_count(file, name, size(value))
    call get_slab(file%hdf5, 'state/'//name, value, 0_i8)
  end subroutine get_integers

  subroutine put_longs(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer(i8), intent(in) :: value(:)
    call put_whole(file%hdf5, 'state/'//name, value)
  end subroutine put_longs

  subroutine get_longs(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer(i8), intent(inout) :: value(:)
    call check_count(file, name, size(value))
    call get_slab(file%hdf5, 'state/'//name, value, 0_i8)
  end subroutine get_longs

  subroutine put_real(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(in) :: value
    call put_reals(file, name, [value])
  end subroutine put_real

  subroutine get_real(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(inout) :: value
    real(wp) :: list(1)
    list = value
    call get_reals(file, name, list)
    value = list(1)
  end subroutine get_real

  subroutine put_integer(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: value
    call put_integers(file, name, [value])
  end subroutine put_integer

  subroutine get_integer(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(inout) :: value
    integer :: list(1)
    list = value
    call get_integers(file, name, list)
    value = list(1)
  end subroutine get_integer

  subroutine put_long(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer(i8), intent(in) :: value
    call put_longs(file, name, [value])
  end subroutine put_long

  subroutine get_long(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer(i8), intent(inout) :: value
    integer(i8) :: list(1)
    list = value
    call get_longs(file, name, list)
    value = list(1)
  end subroutine get_long

  subroutine put_logical(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    logical, intent(in) :: value
    call put_integers(file, name, [merge(1, 0, value)])
  end subroutine put_logical

  subroutine get_logical(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    logical, intent(out) :: value
    integer :: list(1)
    list = 0
    call get_integers(file, name, list)
    value = list(1) == 1
  end subroutine get_logical

  subroutine put_text(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name, value
    call put_attribute(file%hdf5, 'state', name, value)
  end subroutine put_text

  subroutine get_text(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    character(:), allocatable, intent(out) :: value
    call get_attribute(file%hdf5, 'state', name, value)
  end subroutine get_text

  subroutine put_table(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(in) :: value(:, :)
    call put_reals(file, name, reshape(value, [size(value)]))
  end subroutine put_table

  subroutine get_table(file, name, value)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    real(wp), intent(inout) :: value(:, :)
    real(wp) :: list(size(value))
    list = 0
    call get_reals(file, name, list)
    value = reshape(list, shape(value))
  end subroutine get_table

end module restart_values
