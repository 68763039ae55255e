!> Reading small text files on one rank for all, and the places where files of materials are looked for.
module deck_files
  use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_null_char, c_null_ptr, c_ptr, c_size_t
  use mpi_f08, only: MPI_Bcast, MPI_CHARACTER, MPI_INTEGER
  use parallel, only: world, n_ranks, is_root
  use version, only: data_directory, source_directory
  implicit none
  private
  public :: read_text_file, folder_of, stem_of, material_files

  integer, parameter, public :: long_path = 1024 !< characters of a path that the system gives

  ! The start of C's glob_t, with room for what a system may keep behind it.
  type, bind(c) :: glob_type
    integer(c_size_t) :: count = 0
    type(c_ptr) :: paths = c_null_ptr
    integer(c_size_t) :: offset = 0
    integer(c_size_t) :: rest(32) = 0
  end type glob_type

  interface
    function c_readlink(path, buffer, size) bind(c, name='readlink') result(length)
      import :: c_char, c_size_t
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(out) :: buffer(*)
      integer(c_size_t), value :: size
      integer(c_size_t) :: length
    end function c_readlink
    integer(c_int) function c_glob(pattern, flags, on_error, found) bind(c, name='glob')
      import :: c_char, c_int, c_ptr, glob_type
      character(kind=c_char), intent(in) :: pattern(*)
      integer(c_int), value :: flags
      type(c_ptr), value :: on_error
      type(glob_type), intent(inout) :: found
    end function c_glob
    subroutine c_globfree(found) bind(c, name='globfree')
      import :: glob_type
      type(glob_type), intent(inout) :: found
    end subroutine c_globfree
    function c_strlen(string) bind(c, name='strlen') result(length)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: string
      integer(c_size_t) :: length
    end function c_strlen
  end interface

contains

  !> The whole of a file. Called by all ranks: the root reads. found is false where it cannot be read.
  subroutine read_text_file(file, text, found)
    character(*), intent(in) :: file
    character(:), allocatable, intent(out) :: text
    logical, intent(out) :: found
    integer :: unit, status, length
    length = -1
    if (is_root()) then
      open (newunit=unit, file=file, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status == 0) then
        inquire (unit=unit, size=length)
        allocate (character(max(length, 0)) :: text)
        if (length > 0) read (unit, iostat=status) text
        if (status /= 0) length = -1
        close (unit)
      end if
    end if
    if (n_ranks > 1) then
      call MPI_Bcast(length, 1, MPI_INTEGER, 0, world)
      if (.not. is_root()) allocate (character(max(length, 0)) :: text)
      if (length > 0) call MPI_Bcast(text, length, MPI_CHARACTER, 0, world)
    end if
    found = length >= 0
    if (.not. allocated(text)) text = ''
  end subroutine read_text_file

  !> The folder of a path with its slash: 'a/b/' of 'a/b/c.nml', '' of 'c.nml'.
  pure function folder_of(path) result(folder)
    character(*), intent(in) :: path
    character(:), allocatable :: folder
    folder = path(1:index(path, '/', back=.true.))
  end function folder_of

  !> The name of a file without folder and ending: 'c' of 'a/b/c.nml'.
  pure function stem_of(path) result(stem)
    character(*), intent(in) :: path
    character(:), allocatable :: stem
    integer :: dot
    stem = trim(path(index(path, '/', back=.true.) + 1:))
    dot = index(stem, '.', back=.true.)
    if (dot > 1) stem = stem(1:dot - 1)
  end function stem_of

  !> All files of materials, from the place that counts most to the last: $BRISANCE_MATERIALS; materials/ beside the deck;
  !> share/brisance/input/materials and input/materials in the folders above the executable (installed, or built inside the
  !> source tree); the source tree and the place of installation as they were when it was built.
  !> Called by all ranks: the root looks.
  function material_files(deck_file) result(files)
    character(*), intent(in) :: deck_file
    character(long_path), allocatable :: files(:)
    character(long_path), allocatable :: folders(:)
    integer :: i, n
    allocate (files(0))
    if (is_root()) then
      allocate (folders, source=material_folders(deck_file))
      do i = 1, size(folders)
        files = [character(long_path) :: files, files_matching(trim(folders(i))//'*.nml')]
      end do
    end if
    n = size(files)
    if (n_ranks == 1) return
    call MPI_Bcast(n, 1, MPI_INTEGER, 0, world)
    if (.not. is_root()) then
      deallocate (files)
      allocate (files(n))
    end if
    if (n > 0) call MPI_Bcast(files, n*long_path, MPI_CHARACTER, 0, world)
  end function material_files

  function material_folders(deck_file) result(folders)
    character(*), intent(in) :: deck_file
    character(long_path), allocatable :: folders(:)
    character(long_path) :: value
    character(:), allocatable :: above
    integer :: status
    allocate (folders(0))
    call get_environment_variable('BRISANCE_MATERIALS', value, status=status)
    if (status == 0 .and. value /= '') folders = [character(long_path) :: folders, trim(value)//'/']
    folders = [character(long_path) :: folders, folder_of(deck_file)//'materials/']
    above = executable_path()
    do while (len(above) > 1)
      above = folder_of(above(1:len(above) - 1))
      folders = [character(long_path) :: folders, above//'share/brisance/input/materials/', above//'input/materials/']
    end do
    folders = [character(long_path) :: folders, trim(source_directory)//'/input/materials/', &
      trim(data_directory)//'/input/materials/']
  end function material_folders

  function executable_path() result(path)
    character(:), allocatable :: path
    character(kind=c_char) :: buffer(long_path)
    integer(c_size_t) :: length
    integer :: i
    length = c_readlink('/proc/self/exe'//c_null_char, buffer, int(long_path, c_size_t))
    path = ''
    do i = 1, int(length)
      path = path//buffer(i)
    end do
  end function executable_path

  ! The files that match a pattern with '*', in alphabetical order.
  function files_matching(pattern) result(files)
    character(*), intent(in) :: pattern
    character(long_path), allocatable :: files(:)
    type(glob_type) :: found
    type(c_ptr), pointer :: path(:)
    character(kind=c_char), pointer :: c(:)
    integer :: i, j
    if (c_glob(pattern//c_null_char, 0_c_int, c_null_ptr, found) == 0) then
      allocate (files(found%count))
      call c_f_pointer(found%paths, path, [found%count])
      do i = 1, size(files)
        files(i) = ''
        call c_f_pointer(path(i), c, [c_strlen(path(i))])
        do j = 1, min(size(c), long_path)
          files(i)(j:j) = c(j)
        end do
      end do
    else
      allocate (files(0))
    end if
    call c_globfree(found)
  end function files_matching

end module deck_files
