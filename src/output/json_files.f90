!> A small writer of JSON: nested objects of names and values, as in summary.json. The root writes; other ranks' calls do nothing.
module json_files
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use errors, only: fatal
  use file_system, only: rename_file
  use kinds, only: wp, i8
  use parallel, only: is_root
  use text, only: str
  implicit none
  private
  public :: json_file, open_json, close_json, json_begin, json_end, json_put

  !> A file being written, aside until it is closed.
  type :: json_file
    integer :: unit = 0
    integer :: depth = 0
    logical :: first = .true. !< nothing yet in the innermost object
    character(:), allocatable :: name
  end type json_file

  !> json_put(file, key, value): text, logical, integer, long integer, real, or a list of integers, reals or texts.
  !> A real that is not finite becomes null.
  interface json_put
    module procedure put_text, put_logical, put_integer, put_long, put_real, put_integers, put_reals, put_texts
  end interface json_put

contains

  !> Starts a file with its outermost object.
  subroutine open_json(file, name)
    type(json_file), intent(out) :: file
    character(*), intent(in) :: name
    integer :: status
    file%name = trim(name)
    if (.not. is_root()) return
    open (newunit=file%unit, file=file%name//'.part', status='replace', action='write', iostat=status)
    if (status /= 0) call fatal('can''t write "'//file%name//'"')
    write (file%unit, '(a)', advance='no') '{'
    file%depth = 1
    file%first = .true.
  end subroutine open_json

  !> Ends all objects and gives the file its name.
  subroutine close_json(file)
    type(json_file), intent(inout) :: file
    integer :: status
    if (file%unit == 0) return
    do while (file%depth > 0)
      call json_end(file)
    end do
    write (file%unit, '()')
    close (file%unit, iostat=status)
    if (status /= 0) call fatal('can''t write "'//file%name//'" (is the disk full?)')
    call rename_file(file%name//'.part', file%name)
    file%unit = 0
  end subroutine close_json

  !> Starts an object inside the present one.
  subroutine json_begin(file, key)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    if (file%unit == 0) return
    call put_raw(file, key, '{')
    file%depth = file%depth + 1
    file%first = .true.
  end subroutine json_begin

  !> Ends the innermost object.
  subroutine json_end(file)
    type(json_file), intent(inout) :: file
    if (file%unit == 0) return
    file%depth = file%depth - 1
    if (.not. file%first) write (file%unit, '(/,a)', advance='no') repeat('  ', file%depth)
    write (file%unit, '(a)', advance='no') '}'
    file%first = .false.
  end subroutine json_end

  subroutine put_text(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key, value
    call put_raw(file, key, quoted(value))
  end subroutine put_text

  subroutine put_logical(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    logical, intent(in) :: value
    call put_raw(file, key, str(value))
  end subroutine put_logical

  subroutine put_integer(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    integer, intent(in) :: value
    call put_raw(file, key, str(value))
  end subroutine put_integer

  subroutine put_long(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    integer(i8), intent(in) :: value
    call put_raw(file, key, str(value))
  end subroutine put_long

  subroutine put_real(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    real(wp), intent(in) :: value
    call put_raw(file, key, number(value))
  end subroutine put_real

  subroutine put_integers(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    integer, intent(in) :: value(:)
    character(:), allocatable :: list
    integer :: i
    list = ''
    do i = 1, size(value)
      list = list//', '//str(value(i))
    end do
    call put_raw(file, key, '['//list(min(3, len(list) + 1):)//']')
  end subroutine put_integers

  subroutine put_reals(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    real(wp), intent(in) :: value(:)
    character(:), allocatable :: list
    integer :: i
    list = ''
    do i = 1, size(value)
      list = list//', '//number(value(i))
    end do
    call put_raw(file, key, '['//list(min(3, len(list) + 1):)//']')
  end subroutine put_reals

  subroutine put_texts(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key
    character(*), intent(in) :: value(:)
    character(:), allocatable :: list
    integer :: i
    list = ''
    do i = 1, size(value)
      list = list//', '//quoted(value(i))
    end do
    call put_raw(file, key, '['//list(min(3, len(list) + 1):)//']')
  end subroutine put_texts

  subroutine put_raw(file, key, value)
    type(json_file), intent(inout) :: file
    character(*), intent(in) :: key, value
    integer :: status
    if (file%unit == 0) return
    if (.not. file%first) write (file%unit, '(a)', advance='no') ','
    write (file%unit, '(/,a)', advance='no', iostat=status) repeat('  ', file%depth)//quoted(key)//': '//value
    if (status /= 0) call fatal('can''t write "'//file%name//'" (is the disk full?)')
    file%first = .false.
  end subroutine put_raw

  !> 17 digits, so that every bit survives.
  pure function number(value) result(string)
    real(wp), intent(in) :: value
    character(:), allocatable :: string
    character(24) :: buffer
    if (ieee_is_finite(value)) then
      write (buffer, '(es24.16e3)') value
      string = trim(adjustl(buffer))
    else
      string = 'null'
    end if
  end function number

  pure function quoted(value) result(string)
    character(*), intent(in) :: value
    character(:), allocatable :: string
    character(6) :: code
    integer :: i
    string = '"'
    do i = 1, len_trim(value)
      select case (iachar(value(i:i)))
      case (34, 92) ! quotation mark, backslash
        string = string//achar(92)//value(i:i)
      case (0:31)
        write (code, '(a,z4.4)') achar(92)//'u', iachar(value(i:i))
        string = string//code
      case default
        string = string//value(i:i)
      end select
    end do
    string = string//'"'
  end function quoted

end module json_files
