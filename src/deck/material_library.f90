!> Materials from files: input/materials/<name>.nml holds one &material group in SI, with a source for every constant.
module material_library
  use kinds, only: wp
  use deck_assign, only: assign_group
  use deck_files, only: long_path, material_files, read_text_file, stem_of
  use deck_keys, only: key_table, kind_real, word_length
  use deck_material, only: material_group, material_keys
  use deck_problems, only: problem_list
  use deck_scan, only: scan_deck, scanned_group
  use text, only: lowercase
  use units, only: from_si
  implicit none
  private
  public :: load_material, find_library_file, library_names

contains

  !> Fills a material with the constants of a file of the library, in the unit system given. Called by all ranks.
  subroutine load_material(file, system, material, problems)
    character(*), intent(in) :: file
    character(*), intent(in) :: system !< one of unit_system_names
    type(material_group), intent(inout), target :: material
    type(problem_list), intent(inout) :: problems !< of the file, if it has any
    character(:), allocatable :: text
    type(scanned_group), allocatable :: groups(:)
    type(key_table) :: table
    logical :: found
    problems%file = file
    call read_text_file(file, text, found)
    if (.not. found) then
      call problems%add(0, '', 'cannot be read')
      return
    end if
    call scan_deck(text, ['material'], groups, problems)
    if (size(groups) /= 1) then
      call problems%add(0, '', 'holds one group, &material')
      return
    else if (groups(1)%name /= 'material') then
      call problems%add(groups(1)%line, '', 'the group of a material is &material, not &'//groups(1)%name)
      return
    end if
    call material_keys(material, table)
    call assign_group(groups(1), table, [key_table ::], problems)
    call convert_from_si(table, system)
  end subroutine load_material

  ! Numbers of the table that are given, from SI to the system.
  subroutine convert_from_si(table, system)
    type(key_table), intent(in) :: table
    character(*), intent(in) :: system
    integer :: i
    do i = 1, table%n
      associate (key => table%key(i))
        if (key%kind /= kind_real .or. .not. key%given(1)) cycle
        call key%set_real(1, from_si(key%real_element(1), key%dimension(1), key%dimension(2), key%dimension(3), system))
      end associate
    end do
  end subroutine convert_from_si

  !> Path of the first file of this name in the places of material_files, '' if there is none. Called by all ranks.
  function find_library_file(name, deck_file) result(file)
    character(*), intent(in) :: name, deck_file
    character(:), allocatable :: file
    character(long_path), allocatable :: files(:)
    integer :: i
    allocate (files, source=material_files(deck_file))
    do i = 1, size(files)
      file = trim(files(i))
      if (lowercase(stem_of(file)) == lowercase(name)) return
    end do
    file = ''
  end function find_library_file

  !> Names of all materials that can be found, each once. Called by all ranks.
  function library_names(deck_file) result(names)
    character(*), intent(in) :: deck_file
    character(word_length), allocatable :: names(:)
    character(long_path), allocatable :: files(:)
    integer :: i
    allocate (names(0))
    allocate (files, source=material_files(deck_file))
    do i = 1, size(files)
      if (.not. any(names == stem_of(files(i)))) names = [character(word_length) :: names, stem_of(files(i))]
    end do
  end function library_names

end module material_library
