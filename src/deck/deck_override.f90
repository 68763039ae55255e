!> Settings of the command line, `--set group%key=value`, put into a scanned deck.
module deck_override
  use deck_keys, only: key_table, kind_text
  use deck_problems, only: problem_list, nearest_or_allowed
  use deck_scan, only: entry_type, scan_deck, scanned_group
  use deck_tables, only: group_names, may_repeat
  use text, only: lowercase, str
  implicit none
  private
  public :: apply_override

contains

  !> Adds one setting to the groups of the deck: 'run%end_time=1e-3', 'material(2)%density=1600', 'mesh%cells=40,40,1'.
  !> A text needs no quotes. What the deck says for the key is replaced. prototypes: a table for each kind of group.
  subroutine apply_override(groups, setting, prototypes, problems)
    type(scanned_group), allocatable, intent(inout) :: groups(:)
    character(*), intent(in) :: setting
    type(key_table), intent(in) :: prototypes(:)
    type(problem_list), intent(inout) :: problems
    character(:), allocatable :: group, key, value, reason
    type(entry_type) :: entry
    integer :: index_given, g
    call split_setting(setting, group, index_given, key, value, reason)
    if (reason == '') call find_group(groups, group, index_given, g, reason)
    if (reason == '') call make_entry(group, key, value, prototypes, entry, reason)
    if (reason /= '') then
      call problems%add(0, '', reason, file='--set '//setting)
      return
    end if
    entry%option = setting
    call append_entry(groups(g), entry)
  end subroutine apply_override

  ! 'group(index)%key=value' in its parts; index_given is 0 where there is none.
  subroutine split_setting(setting, group, index_given, key, value, reason)
    character(*), intent(in) :: setting
    character(:), allocatable, intent(out) :: group, key, value, reason
    integer, intent(out) :: index_given
    integer :: equals, percent, open, status
    reason = ''
    group = ''
    key = ''
    value = ''
    index_given = 0
    equals = index(setting, '=')
    percent = index(setting(1:max(equals, 1)), '%')
    if (percent < 2 .or. equals < percent + 2) then
      reason = 'a setting has the form group%key=value'
      return
    end if
    group = trim(adjustl(lowercase(setting(1:percent - 1))))
    key = trim(adjustl(lowercase(setting(percent + 1:equals - 1))))
    value = trim(adjustl(setting(equals + 1:)))
    open = index(group, '(')
    if (open > 0) then
      status = 1
      if (group(len(group):) == ')' .and. verify(group(open + 1:len(group) - 1), '0123456789') == 0) then
        read (group(open + 1:len(group) - 1), *, iostat=status) index_given
      end if
      if (status /= 0 .or. index_given < 1) reason = 'the number in () behind the group must be a whole number from 1'
      group = trim(group(1:open - 1))
    end if
    if (.not. any(group_names == group)) reason = 'there is no group &'//group// &
      nearest_or_allowed(group, group_names, 'groups')
  end subroutine split_setting

  ! Place of the group in the deck; one that the deck lacks is made, if it is of the kind that stands there once.
  subroutine find_group(groups, name, index_given, g, reason)
    type(scanned_group), allocatable, intent(inout) :: groups(:)
    character(*), intent(in) :: name
    integer, intent(in) :: index_given
    integer, intent(out) :: g
    character(:), allocatable, intent(out) :: reason
    type(scanned_group), allocatable :: larger(:)
    integer :: i, n
    reason = ''
    n = 0
    g = 0
    do i = 1, size(groups)
      if (groups(i)%name /= name) cycle
      n = n + 1
      if (n == max(index_given, 1)) g = i
    end do
    if (.not. may_repeat(name)) then
      if (index_given > 1) reason = '&'//name//' stands in a deck once'
      if (g > 0 .or. reason /= '') return
      g = size(groups) + 1
      allocate (larger(g))
      larger(1:g - 1) = groups
      larger(g)%name = name
      allocate (larger(g)%entry(1))
      call move_alloc(larger, groups)
    else if (g == 0) then
      reason = 'the deck has '//str(n)//' groups &'//name
    else if (index_given == 0 .and. n > 1) then
      reason = 'which of the '//str(n)//' groups &'//name//'? Write '//name//'(1)%...'
    end if
  end subroutine find_group

  ! The key and its value, scanned as if they stood in a deck.
  subroutine make_entry(group, key, value, prototypes, entry, reason)
    character(*), intent(in) :: group, key, value
    type(key_table), intent(in) :: prototypes(:)
    type(entry_type), intent(out) :: entry
    character(:), allocatable, intent(out) :: reason
    type(scanned_group), allocatable :: scanned(:)
    type(problem_list) :: mistakes
    character(:), allocatable :: shown
    integer :: i, k
    reason = ''
    shown = value
    do i = 1, size(prototypes)
      if (prototypes(i)%group /= group) cycle
      k = prototypes(i)%find(key)
      if (k == 0) exit
      if (prototypes(i)%key(k)%kind == kind_text .and. scan(value//' ', '''"') /= 1) shown = quoted(value)
    end do
    mistakes%file = ''
    mistakes%has_lines = .false.
    call scan_deck('&'//group//' '//key//' = '//shown//new_line('a')//'/', group_names, scanned, mistakes)
    if (mistakes%n > 0) then
      reason = mistakes%message(1)
      reason = reason(3:)
    else if (size(scanned) /= 1) then
      reason = 'one key and its value are expected'
    else if (scanned(1)%n /= 1) then
      reason = 'one key and its value are expected'
    else
      entry = scanned(1)%entry(1)
      entry%line = 0
    end if
  end subroutine make_entry

  pure function quoted(text) result(with_quotes)
    character(*), intent(in) :: text
    character(:), allocatable :: with_quotes
    integer :: i
    with_quotes = ''''
    do i = 1, len(text)
      with_quotes = with_quotes//text(i:i)
      if (text(i:i) == '''') with_quotes = with_quotes//''''
    end do
    with_quotes = with_quotes//''''
  end function quoted

  subroutine append_entry(group, entry)
    type(scanned_group), intent(inout) :: group
    type(entry_type), intent(in) :: entry
    type(entry_type), allocatable :: larger(:)
    if (group%n == size(group%entry)) then
      allocate (larger(group%n + 1))
      larger(1:group%n) = group%entry
      call move_alloc(larger, group%entry)
    end if
    group%n = group%n + 1
    group%entry(group%n) = entry
  end subroutine append_entry

end module deck_override
