!> The few calls on files and folders that Fortran lacks; every name is a plain path.
module file_system
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  use errors, only: fatal
  use parallel, only: barrier, is_root
  implicit none
  private
  public :: make_directory, rename_file, remove_file, file_exists, publish_file, base_name

  interface
    integer(c_int) function c_mkdir(path, mode) bind(c, name='mkdir')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
    end function c_mkdir
    integer(c_int) function c_rename(old, new) bind(c, name='rename')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: old(*), new(*)
    end function c_rename
    integer(c_int) function c_unlink(path) bind(c, name='unlink')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_unlink
    integer(c_int) function c_access(path, mode) bind(c, name='access')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: mode
    end function c_access
  end interface

contains

  !> Makes a folder and those above it; one that is there already is left as it is. Fatal if it can't be made or written to.
  subroutine make_directory(path)
    character(*), intent(in) :: path
    integer, parameter :: mode = 511 ! octal 777, cut down by the user's umask
    integer, parameter :: writable_and_searchable = 3
    integer :: i, status
    do i = 2, len_trim(path)
      if (path(i:i) == '/') status = c_mkdir(path(:i - 1)//c_null_char, mode)
    end do
    status = c_mkdir(trim(path)//c_null_char, mode)
    if (c_access(trim(path)//'/.'//c_null_char, writable_and_searchable) /= 0) then
      call fatal('the output folder "'//trim(path)//'" can''t be made or written to')
    end if
  end subroutine make_directory

  !> Gives a file its new name, replacing what had that name, in one step of the file system.
  subroutine rename_file(old, new)
    character(*), intent(in) :: old, new
    if (c_rename(trim(old)//c_null_char, trim(new)//c_null_char) /= 0) then
      call fatal('can''t rename "'//trim(old)//'" to "'//trim(new)//'"')
    end if
  end subroutine rename_file

  !> Removes a file; no error if there is none.
  subroutine remove_file(path)
    character(*), intent(in) :: path
    integer :: status
    status = c_unlink(trim(path)//c_null_char)
    if (status == 0) return
    if (file_exists(path)) call fatal('can''t remove "'//trim(path)//'"')
  end subroutine remove_file

  !> True for a file or folder of that name.
  logical function file_exists(path)
    character(*), intent(in) :: path
    file_exists = c_access(trim(path)//c_null_char, 0_c_int) == 0
  end function file_exists

  !> Renames a file that all ranks have finished writing into its place. To be called by all ranks.
  subroutine publish_file(aside, path)
    character(*), intent(in) :: aside, path
    call barrier()
    if (is_root()) call rename_file(aside, path)
    call barrier()
  end subroutine publish_file

  !> The path without its folders.
  pure function base_name(path) result(name)
    character(*), intent(in) :: path
    character(:), allocatable :: name
    name = trim(path(index(path, '/', back=.true.) + 1:))
  end function base_name

end module file_system
