!> The text of a deck taken apart into groups, keys and values, with every mistake of form noted.
!>
!> A namelist read by itself does not see a misspelt group, a missing '/', a repeated key, a text that is too long or a
!> number out of range, and stops at the first unknown key without a line number. What is accepted here is the part of
!> the namelist form that a native read takes the same way: `key = value, value` and `key(i) = ...`, repeats `3*0.0`,
!> quotes of both kinds, comments from '!', any case, tabs, and lines that end as on Windows.
module deck_scan
  use deck_problems, only: problem_list
  use text, only: lowercase, str
  implicit none
  private
  public :: scan_deck

  !> One value as it stands in the deck.
  type, public :: value_type
    character(:), allocatable :: text !< without the quotes and with doubled quotes made one
    logical :: quoted = .false.
    integer :: repeats = 1
  end type value_type

  !> `key(first) = value(1:n)`
  type, public :: entry_type
    character(:), allocatable :: key !< lower case
    integer :: first = 0 !< the index behind the key, 0: none
    integer :: line = 0
    integer :: n = 0
    type(value_type), allocatable :: value(:)
    logical :: bad = .false. !< a mistake of form was noted: its values mean nothing
    character(:), allocatable :: option !< the command line option that gave it, if one did
  end type entry_type

  type, public :: scanned_group
    character(:), allocatable :: name !< lower case
    integer :: line = 0
    integer :: n = 0
    type(entry_type), allocatable :: entry(:)
  end type scanned_group

  integer, parameter :: is_word = 1, is_string = 2, is_comma = 3, is_equals = 4, is_open = 5, is_close = 6
  integer, parameter :: is_slash = 7, is_ampersand = 8, is_end = 9

  type :: token_type
    integer :: kind = is_end
    integer :: line = 0
    logical :: touches = .false. !< no blank between this token and the one before
    logical :: bad = .false.
    character(:), allocatable :: text
  end type token_type

  type :: reader_type
    character(:), allocatable :: text
    integer :: at = 1 !< next character
    integer :: line = 1
  end type reader_type

  character, parameter :: lf = achar(10), cr = achar(13)

contains

  !> Takes the text of a deck apart. known: names of the groups, for what to make of text outside of groups.
  subroutine scan_deck(text, known, groups, problems)
    character(*), intent(in) :: text
    character(*), intent(in) :: known(:)
    type(scanned_group), allocatable, intent(out) :: groups(:)
    type(problem_list), intent(inout) :: problems
    type(reader_type) :: reader
    type(scanned_group), allocatable :: larger(:)
    integer :: n
    reader%text = with_unix_lines(text)
    allocate (groups(8))
    n = 0
    do
      call skip_blanks(reader)
      if (reader%at > len(reader%text)) exit
      if (reader%text(reader%at:reader%at) == '&') then
        reader%at = reader%at + 1
      else if (.not. starts_known_group(reader, known, problems)) then
        call skip_outside_text(reader, groups(1:n), problems)
        cycle
      end if
      if (n == size(groups)) then
        allocate (larger(2*n))
        larger(1:n) = groups
        call move_alloc(larger, groups)
      end if
      n = n + 1
      call scan_group(reader, groups(n), problems)
    end do
    groups = groups(1:n)
  end subroutine scan_deck

  ! Ends of lines of any system as line feeds, and no byte order mark.
  pure function with_unix_lines(text) result(clean)
    character(*), intent(in) :: text
    character(:), allocatable :: clean
    integer :: i, n, first
    clean = text
    first = 1
    if (len(text) >= 3) then
      if (text(1:3) == char(239)//char(187)//char(191)) first = 4
    end if
    n = 0
    do i = first, len(text)
      if (text(i:i) == lf .and. i > first) then
        if (text(i - 1:i - 1) == cr) cycle
      end if
      n = n + 1
      clean(n:n) = text(i:i)
      if (text(i:i) == cr) clean(n:n) = lf
    end do
    clean = clean(1:n)
  end function with_unix_lines

  ! True if a group begins here without its ampersand (which is noted).
  logical function starts_known_group(reader, known, problems) result(found)
    type(reader_type), intent(inout) :: reader
    character(*), intent(in) :: known(:)
    type(problem_list), intent(inout) :: problems
    integer :: first, last
    first = reader%at
    if (index('$*#', reader%text(first:first)) > 0) first = first + 1
    last = first - 1
    do while (last < len(reader%text))
      if (.not. is_name_character(reader%text(last + 1:last + 1))) exit
      last = last + 1
    end do
    found = any(known == lowercase(reader%text(first:last))) .and. last >= first
    if (.not. found) return
    call problems%add(reader%line, '', 'group '''//reader%text(first:last)//''' must start with ''&'': &'// &
      lowercase(reader%text(first:last)))
    reader%at = first
  end function starts_known_group

  ! Notes a stretch of text outside of groups, and goes to the next ampersand.
  subroutine skip_outside_text(reader, groups, problems)
    type(reader_type), intent(inout) :: reader
    type(scanned_group), intent(in) :: groups(:)
    type(problem_list), intent(inout) :: problems
    integer :: first, last, line
    logical :: has_equals
    character(:), allocatable :: hint
    first = reader%at
    line = reader%line
    last = first
    has_equals = .false.
    do while (reader%at <= len(reader%text))
      select case (reader%text(reader%at:reader%at))
      case ('&')
        exit
      case ('!', lf)
        call skip_blanks(reader)
      case default
        if (reader%line == line) last = reader%at
        has_equals = has_equals .or. reader%text(reader%at:reader%at) == '='
        reader%at = reader%at + 1
      end select
    end do
    hint = ''
    if (has_equals .and. size(groups) > 0) hint = &
      '; did a ''/'' end &'//groups(size(groups))%name//' too early?'
    call problems%add(line, '', 'text outside of groups: '//reader%text(first:last)//hint)
  end subroutine skip_outside_text

  ! Reads a group from its name to its '/'.
  subroutine scan_group(reader, group, problems)
    type(reader_type), intent(inout) :: reader
    type(scanned_group), intent(inout) :: group
    type(problem_list), intent(inout) :: problems
    type(token_type), allocatable :: token(:)
    integer :: n, first
    first = reader%at
    do while (reader%at <= len(reader%text))
      if (.not. is_name_character(reader%text(reader%at:reader%at))) exit
      reader%at = reader%at + 1
    end do
    group%name = lowercase(reader%text(first:reader%at - 1))
    group%line = reader%line
    allocate (group%entry(8))
    if (group%name == '') call problems%add(group%line, '', 'no name of a group right behind ''&''')
    call read_tokens(reader, group%name, token, n, problems)
    select case (token(n)%kind)
    case (is_end)
      call problems%add(group%line, '&'//group%name, 'the group that starts here has no ''/'' at its end')
    case (is_ampersand)
      call problems%add(group%line, '&'//group%name, 'the group that starts here has no ''/'' before the ''&'' on line '// &
        str(token(n)%line))
    end select
    call parse_entries(token(1:n), group, problems)
  end subroutine scan_group

  ! All tokens up to the end of the group, which is the last one.
  subroutine read_tokens(reader, group, token, n, problems)
    type(reader_type), intent(inout) :: reader
    character(*), intent(in) :: group
    type(token_type), allocatable, intent(out) :: token(:)
    integer, intent(out) :: n
    type(problem_list), intent(inout) :: problems
    type(token_type), allocatable :: larger(:)
    allocate (token(32))
    n = 0
    do
      if (n == size(token)) then
        allocate (larger(2*n))
        larger(1:n) = token
        call move_alloc(larger, token)
      end if
      n = n + 1
      call next_token(reader, group, token(n), problems)
      if (token(n)%kind >= is_slash) exit
    end do
  end subroutine read_tokens

  subroutine next_token(reader, group, token, problems)
    type(reader_type), intent(inout) :: reader
    character(*), intent(in) :: group
    type(token_type), intent(inout) :: token
    type(problem_list), intent(inout) :: problems
    integer :: start
    character :: c
    start = reader%at
    call skip_blanks(reader)
    token%touches = reader%at == start
    token%line = reader%line
    token%kind = is_end
    token%bad = .false.
    token%text = ''
    if (reader%at > len(reader%text)) return
    c = reader%text(reader%at:reader%at)
    token%text = c
    select case (c)
    case ('&')
      token%kind = is_ampersand
      return
    case (',')
      token%kind = is_comma
    case ('=')
      token%kind = is_equals
    case ('(')
      token%kind = is_open
    case (')')
      token%kind = is_close
    case ('''', '"')
      call read_string(reader, group, token, problems)
      return
    case default
      if (ends_group(reader, first_of_word=.true.)) then
        token%kind = is_slash
      else
        call read_word(reader, group, token, problems)
        return
      end if
    end select
    reader%at = reader%at + 1
  end subroutine next_token

  ! A text in quotes; two quotes inside stand for one. It must end on its line.
  subroutine read_string(reader, group, token, problems)
    type(reader_type), intent(inout) :: reader
    character(*), intent(in) :: group
    type(token_type), intent(inout) :: token
    type(problem_list), intent(inout) :: problems
    character :: quote
    integer :: last
    token%kind = is_string
    quote = reader%text(reader%at:reader%at)
    token%text = ''
    reader%at = reader%at + 1
    do while (reader%at <= len(reader%text))
      if (reader%text(reader%at:reader%at) == lf) exit
      if (reader%text(reader%at:reader%at) == quote) then
        reader%at = reader%at + 1
        if (reader%at > len(reader%text)) return
        if (reader%text(reader%at:reader%at) /= quote) return
      end if
      token%text = token%text//reader%text(reader%at:reader%at)
      reader%at = reader%at + 1
    end do
    token%bad = .true.
    call problems%add(token%line, '&'//group, 'the text that starts with '//quote//token%text//' has no '//quote// &
      ' at its end')
    ! the '/' that ends a line was most likely meant to end the group
    last = len_trim(token%text)
    if (last > 0) then
      if (token%text(last:last) == '/') reader%at = reader%at - (len(token%text) - last) - 1
    end if
  end subroutine read_string

  ! Anything else: a key, a number, .true., or a text that lacks its quotes.
  subroutine read_word(reader, group, token, problems)
    type(reader_type), intent(inout) :: reader
    character(*), intent(in) :: group
    type(token_type), intent(inout) :: token
    type(problem_list), intent(inout) :: problems
    integer :: first, i
    token%kind = is_word
    first = reader%at
    do while (reader%at <= len(reader%text))
      if (index(' ,=()''"!', reader%text(reader%at:reader%at)) > 0 .or. iachar(reader%text(reader%at:reader%at)) < 32) exit
      if (reader%at > first .and. ends_group(reader, first_of_word=.false.)) exit
      reader%at = reader%at + 1
    end do
    token%text = reader%text(first:reader%at - 1)
    do i = 1, len(token%text)
      if (iachar(token%text(i:i)) > 127) token%bad = .true.
    end do
    if (token%bad) call problems%add(token%line, '&'//group, ''''//token%text// &
      ''' holds a character that is not ASCII (a no-break space or a curly quote?)')
  end subroutine read_word

  ! True if the next character is a '/' that ends the group: one inside a path without quotes does not.
  logical function ends_group(reader, first_of_word)
    type(reader_type), intent(in) :: reader
    logical, intent(in) :: first_of_word
    character :: next
    ends_group = .false.
    if (reader%text(reader%at:reader%at) /= '/') return
    ends_group = .true.
    if (reader%at == len(reader%text)) return
    next = reader%text(reader%at + 1:reader%at + 1)
    if (first_of_word) then
      ends_group = .not. is_name_character(next)
    else
      ends_group = index(' !&', next) > 0 .or. iachar(next) < 32
    end if
  end function ends_group

  ! The tokens of a group as entries `key = values`.
  subroutine parse_entries(token, group, problems)
    type(token_type), intent(in) :: token(:) !< the last one ends the group
    type(scanned_group), intent(inout) :: group
    type(problem_list), intent(inout) :: problems
    type(entry_type), allocatable :: larger(:)
    integer :: i, n
    n = size(token)
    i = 1
    do while (i < n)
      if (.not. starts_entry(token, i)) then
        call problems%add(token(i)%line, '&'//group%name, '''key = value'' is expected, found '''//token(i)%text//'''')
        do while (i < n .and. .not. starts_entry(token, i))
          i = i + 1
        end do
        cycle
      end if
      if (group%n == size(group%entry)) then
        allocate (larger(2*group%n))
        larger(1:group%n) = group%entry
        call move_alloc(larger, group%entry)
      end if
      group%n = group%n + 1
      call parse_entry(token, i, group%name, group%entry(group%n), problems)
    end do
  end subroutine parse_entries

  ! True where `word =` or `word ( ... ) =` stands.
  pure logical function starts_entry(token, i)
    type(token_type), intent(in) :: token(:)
    integer, intent(in) :: i
    integer :: j
    starts_entry = .false.
    if (i >= size(token)) return
    if (token(i)%kind /= is_word) return
    j = i + 1
    if (token(j)%kind == is_open) then
      do while (j < size(token) .and. token(j)%kind /= is_close .and. token(j)%kind /= is_equals)
        j = j + 1
      end do
      if (token(j)%kind == is_close .and. j < size(token)) j = j + 1
    end if
    starts_entry = token(j)%kind == is_equals
  end function starts_entry

  ! One entry; i goes to the token behind it.
  subroutine parse_entry(token, i, group, entry, problems)
    type(token_type), intent(in) :: token(:)
    integer, intent(inout) :: i
    character(*), intent(in) :: group
    type(entry_type), intent(inout) :: entry
    type(problem_list), intent(inout) :: problems
    character(:), allocatable :: place
    integer :: status
    logical :: value_due
    entry%key = lowercase(token(i)%text)
    entry%line = token(i)%line
    entry%bad = token(i)%bad
    place = '&'//group//' '//entry%key
    i = i + 1
    if (token(i)%kind == is_open) then
      status = 1
      if (token(i + 1)%kind == is_word .and. token(i + 2)%kind == is_close) then
        if (verify(token(i + 1)%text, '0123456789') == 0) read (token(i + 1)%text, *, iostat=status) entry%first
      end if
      if (status /= 0 .or. entry%first < 1) then
        call problems%add(entry%line, place, 'the index in () must be one whole number from 1')
        entry%bad = .true.
      end if
      do while (token(i)%kind /= is_equals)
        i = i + 1
      end do
    end if
    i = i + 1
    allocate (entry%value(4))
    value_due = .true.
    do while (i < size(token) .and. .not. starts_entry(token, i))
      select case (token(i)%kind)
      case (is_word, is_string)
        call add_value(token, i, entry)
        value_due = .false.
      case (is_comma)
        if (value_due) then
          call problems%add(token(i)%line, place, 'no value before a comma')
          entry%bad = .true.
        end if
        value_due = .true.
      case default
        call problems%add(token(i)%line, place, 'unexpected '''//token(i)%text//''' among the values')
        entry%bad = .true.
      end select
      i = i + 1
    end do
    if (entry%n == 0 .and. .not. entry%bad) then
      call problems%add(entry%line, place, 'no value behind ''=''')
      entry%bad = .true.
    end if
  end subroutine parse_entry

  ! Value at token i, with a repeat count `3*` in the same word or, before a text, in a word that touches it.
  subroutine add_value(token, i, entry)
    type(token_type), intent(in) :: token(:)
    integer, intent(inout) :: i
    type(entry_type), intent(inout) :: entry
    type(value_type), allocatable :: larger(:)
    integer :: star, status
    if (entry%n == size(entry%value)) then
      allocate (larger(2*entry%n))
      larger(1:entry%n) = entry%value
      call move_alloc(larger, entry%value)
    end if
    entry%n = entry%n + 1
    associate (value => entry%value(entry%n))
      value%repeats = 1
      value%quoted = token(i)%kind == is_string
      value%text = token(i)%text
      entry%bad = entry%bad .or. token(i)%bad
      star = 0
      if (.not. value%quoted) star = index(value%text, '*')
      if (star > 1) then
        if (verify(value%text(1:star - 1), '0123456789') == 0) then
          read (value%text(1:star - 1), *, iostat=status) value%repeats
          if (status == 0 .and. value%repeats > 0) then
            value%text = value%text(star + 1:)
          else
            value%repeats = 1
          end if
          if (value%text == '' .and. token(i + 1)%kind == is_string .and. token(i + 1)%touches) then
            i = i + 1
            value%quoted = .true.
            value%text = token(i)%text
            entry%bad = entry%bad .or. token(i)%bad
          end if
        end if
      end if
    end associate
  end subroutine add_value

  ! Goes to the next character that is neither blank nor in a comment.
  subroutine skip_blanks(reader)
    type(reader_type), intent(inout) :: reader
    logical :: in_comment
    in_comment = .false.
    do while (reader%at <= len(reader%text))
      associate (c => reader%text(reader%at:reader%at))
        if (c == lf) then
          in_comment = .false.
          reader%line = reader%line + 1
        else if (c == '!') then
          in_comment = .true.
        else if (.not. in_comment .and. iachar(c) > 32) then
          return
        end if
      end associate
      reader%at = reader%at + 1
    end do
  end subroutine skip_blanks

  pure logical function is_name_character(c)
    character, intent(in) :: c
    is_name_character = verify(c, 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_') == 0
  end function is_name_character

end module deck_scan
