!> Reads a deck: scan, settings of the command line, values, materials of the library, checks. All that is wrong is told at once.
module deck
  use deck_assign, only: assign_group
  use deck_check, only: check_deck
  use deck_files, only: read_text_file, stem_of
  use deck_keys, only: key_table
  use deck_override, only: apply_override
  use deck_problems, only: problem_list, group_place, nearest_or_allowed
  use deck_scan, only: scan_deck, scanned_group
  use deck_tables, only: allocate_groups, find_table, group_names, group_number, make_table, make_tables, may_repeat
  use deck_types, only: deck_type, material_group
  use deck_write, only: write_deck, deck_text
  use errors, only: exit_bad_input, fatal, warn
  use material_library, only: find_library_file, library_names, load_material
  use parallel, only: is_root, barrier, n_ranks
  use text, only: nearest_name, str
  implicit none
  private
  public :: deck_type, read_deck, read_deck_string, write_deck, deck_text

  integer, parameter, public :: message_length = 512 !< of the messages that read_deck_string gives back

contains

  !> Reads and checks a deck file. Called by all ranks. The root prints all mistakes and ends the run with exit_bad_input
  !> if there are any, and prints the warnings.
  subroutine read_deck(file, deck, overrides)
    character(*), intent(in) :: file
    type(deck_type), intent(out) :: deck
    character(*), intent(in), optional :: overrides(:) !< 'group%key=value'
    character(:), allocatable :: text
    type(problem_list) :: problems, warnings
    logical :: found
    integer :: i
    call read_text_file(file, text, found)
    if (.not. found) then
      call tell_and_end(file//': there is no such deck, or it cannot be read')
      return
    end if
    call read_text(text, file, deck, problems, warnings, overrides)
    if (is_root()) then
      do i = 1, warnings%n
        call warn(warnings%message(i))
      end do
    end if
    if (problems%n == 1) then
      call tell_and_end(problems%all_messages())
    else if (problems%n > 1) then
      call tell_and_end(str(problems%n)//' mistakes in the deck'//new_line('a')//problems%all_messages())
    end if
  end subroutine read_deck

  ! The message of the root must be out before another rank ends the run.
  subroutine tell_and_end(message)
    character(*), intent(in) :: message
    if (is_root()) call fatal(message, exit_bad_input)
    if (n_ranks > 1) call barrier()
  end subroutine tell_and_end

  !> The same from a string: the mistakes and the warnings come back, and nothing is printed.
  subroutine read_deck_string(text, deck, errors, warnings, overrides, file)
    character(*), intent(in) :: text
    type(deck_type), intent(out) :: deck
    character(message_length), allocatable, intent(out) :: errors(:) !< size 0 if the deck is right
    character(message_length), allocatable, intent(out), optional :: warnings(:)
    character(*), intent(in), optional :: overrides(:)
    character(*), intent(in), optional :: file !< name in the messages, default 'deck.nml'
    type(problem_list) :: problems, doubts
    character(:), allocatable :: name
    name = 'deck.nml'
    if (present(file)) name = file
    call read_text(text, name, deck, problems, doubts, overrides)
    call list_messages(problems, errors)
    if (present(warnings)) call list_messages(doubts, warnings)
  end subroutine read_deck_string

  subroutine list_messages(problems, messages)
    type(problem_list), intent(in) :: problems
    character(message_length), allocatable, intent(out) :: messages(:)
    integer :: i
    allocate (messages(problems%n))
    do i = 1, problems%n
      messages(i) = problems%message(i)
    end do
  end subroutine list_messages

  subroutine read_text(text, file, deck, problems, warnings, overrides)
    character(*), intent(in) :: text, file
    type(deck_type), intent(out), target :: deck
    type(problem_list), intent(inout) :: problems, warnings
    character(*), intent(in), optional :: overrides(:)
    type(deck_type), target :: prototype
    type(scanned_group), allocatable :: groups(:)
    type(key_table), allocatable :: tables(:), prototypes(:)
    integer, allocatable :: kind(:), ordinal(:)
    integer :: i, g
    deck%file = file
    deck%name = stem_of(file)
    problems%file = file
    warnings%file = file
    call allocate_groups(prototype, [(1, g=1, size(group_names))])
    call make_tables(prototype, prototypes)
    call scan_deck(text, group_names, groups, problems)
    if (present(overrides)) then
      do i = 1, size(overrides)
        call apply_override(groups, trim(overrides(i)), prototypes, problems)
      end do
    end if
    call identify_groups(groups, kind, ordinal, problems)
    call allocate_groups(deck, [(count(kind == g), g=1, size(group_names))])
    call make_tables(deck, tables)
    ! the unit system must be known before materials of the library are converted to it
    do i = 1, size(groups)
      if (kind(i) == group_number('run')) call fill_group(groups(i), ordinal(i))
    end do
    do i = 1, size(groups)
      if (kind(i) > 0 .and. kind(i) /= group_number('run')) call fill_group(groups(i), ordinal(i))
    end do
    call check_deck(deck, tables, problems, warnings)

  contains

    ! Values of one scanned group. A second one of its name where only one may stand (ordinal 0) is looked through in vain.
    subroutine fill_group(group, ordinal)
      type(scanned_group), intent(in) :: group
      integer, intent(in) :: ordinal
      type(key_table) :: spare
      integer :: k
      if (ordinal == 0) then
        spare = prototypes(find_table(prototypes, group%name, 1))
        call assign_group(group, spare, prototypes, problems)
        return
      end if
      k = find_table(tables, group%name, ordinal)
      tables(k)%line = group%line
      if (group%name == 'material') call start_from_library(group, deck, deck%material(ordinal), tables(k), problems)
      call assign_group(group, tables(k), prototypes, problems)
    end subroutine fill_group

  end subroutine read_text

  ! Which group each one is (place in group_names, 0 for none) and the how manieth of its name. A misspelt name is noted and
  ! taken for the nearest right one, so that what stands in the group is looked at too.
  subroutine identify_groups(groups, kind, ordinal, problems)
    type(scanned_group), intent(inout) :: groups(:)
    integer, allocatable, intent(out) :: kind(:), ordinal(:)
    type(problem_list), intent(inout) :: problems
    integer :: i, first
    allocate (kind(size(groups)), ordinal(size(groups)), source=0)
    do i = 1, size(groups)
      kind(i) = group_number(groups(i)%name)
      if (kind(i) == 0 .and. groups(i)%name /= '') then
        call problems%add(groups(i)%line, '&'//groups(i)%name, 'there is no such group'// &
          nearest_or_allowed(groups(i)%name, group_names, 'groups'))
        groups(i)%name = nearest_name(groups(i)%name, group_names)
        kind(i) = group_number(groups(i)%name)
      end if
      if (kind(i) == 0) cycle
      first = findloc(kind, kind(i), 1)
      if (may_repeat(groups(i)%name)) then
        ordinal(i) = count(kind(1:i) == kind(i))
      else if (first == i) then
        ordinal(i) = 1
      else
        call problems%add(groups(i)%line, '&'//groups(i)%name, 'this group stands in a deck once; the first is on line '// &
          str(groups(first)%line))
      end if
    end do
  end subroutine identify_groups

  ! The constants of the library come first: what the deck gives overrides them.
  subroutine start_from_library(group, deck, material, table, problems)
    type(scanned_group), intent(in) :: group
    type(deck_type), intent(in) :: deck
    type(material_group), intent(inout) :: material
    type(key_table), intent(inout) :: table
    type(problem_list), intent(inout) :: problems
    type(problem_list) :: problems_of_file
    character(:), allocatable :: name, file
    integer :: i, line
    name = ''
    line = group%line
    do i = 1, group%n
      if (group%entry(i)%key /= 'library' .or. group%entry(i)%bad) cycle
      name = group%entry(i)%value(1)%text
      if (group%entry(i)%line > 0) line = group%entry(i)%line
    end do
    if (name == '') return
    table%incomplete = .true.
    if (deck%run%units == 'none') then
      call problems%add(line, group_place(table, 'library'), &
        'the library is in SI, and units = ''none'' does not say how to convert it')
      return
    end if
    file = find_library_file(name, trim(deck%file))
    if (file == '') then
      call problems%add(line, group_place(table, 'library'), 'the library has no '''//name//''''// &
        nearest_or_allowed(name, library_names(trim(deck%file)), 'library'))
      return
    end if
    call load_material(file, trim(deck%run%units), material, problems_of_file)
    call problems%take(problems_of_file)
    table%incomplete = problems_of_file%n > 0
  end subroutine start_from_library

end module deck
