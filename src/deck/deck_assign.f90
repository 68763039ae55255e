!> Puts the values of a scanned group into the group's type, through its table of keys, and notes each that does not fit.
module deck_assign
  use kinds, only: wp, i8
  use deck_keys, only: key_table, key_type, kind_real, kind_integer, kind_logical, kind_text
  use deck_problems, only: problem_list, group_place, nearest_or_allowed
  use deck_scan, only: scanned_group, entry_type, value_type
  use text, only: lowercase, str
  implicit none
  private
  public :: assign_group, exact_text

  ! Numbers from 10**101 and below 10**(-100) are refused: they would be read as infinity or as zero, or their squares would.
  integer, parameter :: largest_exponent = 100

contains

  !> Assigns all entries. others: tables of all groups, to tell where a key belongs that this group does not have.
  subroutine assign_group(group, table, others, problems)
    type(scanned_group), intent(in) :: group
    type(key_table), intent(inout) :: table
    type(key_table), intent(in) :: others(:)
    type(problem_list), intent(inout) :: problems
    integer :: i, k
    do i = 1, group%n
      k = table%find(group%entry(i)%key)
      if (k == 0) then
        call report(group%entry(i), table, 'there is no such key in &'//trim(table%group)// &
          advice_for_unknown(group%entry(i)%key, table, others), problems)
      else
        call assign_entry(group%entry(i), table, table%key(k), problems)
      end if
    end do
  end subroutine assign_group

  pure function advice_for_unknown(name, table, others) result(advice)
    character(*), intent(in) :: name
    type(key_table), intent(in) :: table
    type(key_table), intent(in) :: others(:)
    character(:), allocatable :: advice
    integer :: i
    advice = nearest_or_allowed(name, table%key(1:table%n)%name, 'keys')
    do i = 1, size(others)
      if (others(i)%find(name) > 0 .and. index(advice, 'did you mean') == 0) then
        advice = '; it is a key of &'//trim(others(i)%group)
        return
      end if
    end do
  end function advice_for_unknown

  subroutine assign_entry(entry, table, key, problems)
    type(entry_type), intent(in) :: entry
    type(key_table), intent(in) :: table
    type(key_type), intent(inout) :: key
    type(problem_list), intent(inout) :: problems
    character(:), allocatable :: reason
    integer :: i, j, repeat, n_given
    logical :: ok
    n_given = 0
    do i = 1, entry%n
      n_given = min(n_given + entry%value(i)%repeats, 1000)
    end do
    reason = ''
    if (entry%first > 0 .and. key%n == 1) then
      reason = 'is one value and takes no index'
    else if (entry%first > key%n) then
      reason = 'the index goes from 1 to '//str(key%n)
    else if (.not. entry%bad .and. max(entry%first, 1) - 1 + n_given > key%n) then
      reason = too_many_values(entry, key, n_given)
    else if (repeated(entry, key, n_given)) then
      reason = 'given twice in this group, first on line '//str(key%line)
    end if
    if (.not. any(key%given)) key%line = entry%line
    if (allocated(entry%option)) key%from_option = .true.
    if (reason /= '') call report(entry, table, reason, problems)
    if (reason /= '' .or. entry%bad) then
      key%bad = .true.
      key%given = .true. ! what cannot be used is not missing as well
      return
    end if
    j = max(entry%first, 1)
    do i = 1, entry%n
      do repeat = 1, entry%value(i)%repeats
        key%given(j) = .true.
        call assign_value(entry, entry%value(i), table, key, j, ok, problems)
        key%bad = key%bad .or. .not. ok
        if (.not. ok) return
        j = j + 1
      end do
    end do
  end subroutine assign_entry

  pure function too_many_values(entry, key, n_given) result(reason)
    type(entry_type), intent(in) :: entry
    type(key_type), intent(in) :: key
    integer, intent(in) :: n_given
    character(:), allocatable :: reason
    reason = 'too many values: '//str(n_given)//' given, '//str(key%n - max(entry%first, 1) + 1)//' expected'
    if (key%kind == kind_text .and. .not. all(entry%value(1:entry%n)%quoted)) then
      reason = reason//'; a text stands in quotes'
    else if (key%kind == kind_real .and. key%n == 1 .and. n_given == 2) then
      reason = reason//'; the decimal sign is a point'
    end if
  end function too_many_values

  ! A command line option replaces what the deck has; the deck itself says a thing once.
  pure logical function repeated(entry, key, n_given)
    type(entry_type), intent(in) :: entry
    type(key_type), intent(in) :: key
    integer, intent(in) :: n_given
    integer :: first, last
    first = max(entry%first, 1)
    last = min(first - 1 + max(n_given, 1), key%n)
    repeated = any(key%given(first:last)) .and. .not. allocated(entry%option)
  end function repeated

  subroutine assign_value(entry, value, table, key, element, ok, problems)
    type(entry_type), intent(in) :: entry
    type(value_type), intent(in) :: value
    type(key_table), intent(in) :: table
    type(key_type), intent(inout) :: key
    integer, intent(in) :: element
    logical, intent(out) :: ok
    type(problem_list), intent(inout) :: problems
    character(:), allocatable :: reason
    select case (key%kind)
    case (kind_real)
      call assign_real(value, key, element, reason)
    case (kind_integer)
      call assign_integer(value, key, element, reason)
    case (kind_logical)
      call assign_logical(value, key, reason)
    case default
      call assign_text(value, key, reason)
    end select
    ok = reason == ''
    if (.not. ok) call report(entry, table, reason, problems)
  end subroutine assign_value

  subroutine assign_real(value, key, element, reason)
    type(value_type), intent(in) :: value
    type(key_type), intent(in) :: key
    integer, intent(in) :: element
    character(:), allocatable, intent(out) :: reason
    real(wp) :: number
    integer :: exponent, status
    reason = number_expected(value, 'a number')
    if (reason /= '') return
    call number_form(value%text, status, exponent)
    if (status == 1) then
      reason = ''''//value%text//''' is not a number'
    else if (exponent > largest_exponent) then
      reason = value%text//' is too large (at most 1e'//str(largest_exponent)//')'
    else if (exponent < -largest_exponent) then
      reason = value%text//' is too small (0 or at least 1e-'//str(largest_exponent)//')'
    end if
    if (reason /= '') return
    read (value%text, *, iostat=status) number
    if (status /= 0) then
      reason = ''''//value%text//''' is not a number'
      return
    end if
    if (out_of_range(number, key)) then
      reason = value%text//' is out of range: '//range_text(key)
      return
    end if
    call key%set_real(element, number)
  end subroutine assign_real

  subroutine assign_integer(value, key, element, reason)
    type(value_type), intent(in) :: value
    type(key_type), intent(in) :: key
    integer, intent(in) :: element
    character(:), allocatable, intent(out) :: reason
    integer(i8) :: number
    integer :: status, exponent, first
    reason = number_expected(value, 'a whole number')
    if (reason /= '') return
    first = 1
    if (index('+-', value%text(1:1)) > 0) first = 2
    if (verify(value%text(first:), '0123456789') /= 0 .or. len(value%text) < first) then
      call number_form(value%text, status, exponent)
      reason = ''''//value%text//''' is not a whole number'
      if (status == 0) reason = 'a whole number is expected, not '//value%text//' (no point, no exponent)'
      return
    end if
    status = 1
    if (len(value%text) <= 18) read (value%text, *, iostat=status) number
    if (status == 0) then
      if (abs(number) > huge(1)) status = 1
    end if
    if (status /= 0) then
      reason = value%text//' is too large for a whole number (at most '//str(huge(1))//')'
    else if (out_of_range(real(number, wp), key)) then
      reason = value%text//' is out of range: '//range_text(key)
    else
      call key%set_integer(element, int(number))
    end if
  end subroutine assign_integer

  subroutine assign_logical(value, key, reason)
    type(value_type), intent(in) :: value
    type(key_type), intent(in) :: key
    character(:), allocatable, intent(out) :: reason
    reason = ''
    select case (lowercase(value%text))
    case ('.true.', 'true', 't', '.t.')
      key%logical_value = .true.
    case ('.false.', 'false', 'f', '.f.')
      key%logical_value = .false.
    case default
      reason = ''''//value%text//''' is neither .true. nor .false.'
    end select
    if (value%quoted .and. reason == '') reason = '.true. and .false. stand without quotes'
  end subroutine assign_logical

  subroutine assign_text(value, key, reason)
    type(value_type), intent(in) :: value
    type(key_type), intent(in) :: key
    character(:), allocatable, intent(out) :: reason
    integer :: i
    reason = ''
    if (.not. value%quoted) then
      reason = 'a text stands in quotes: '''//value%text//''''
    else if (len_trim(value%text) > len(key%text_value)) then
      reason = 'the text has '//str(len_trim(value%text))//' characters, at most '//str(len(key%text_value))//' fit'
    else if (scan(value%text, control_characters()) > 0) then
      reason = 'the text holds a tab or another control character'
    else if (allocated(key%allowed)) then
      do i = 1, size(key%allowed)
        if (lowercase(trim(value%text)) == lowercase(trim(key%allowed(i)))) then
          key%text_value = key%allowed(i)
          return
        end if
      end do
      reason = ''''//value%text//''' is not known'//nearest_or_allowed(value%text, pack(key%allowed, key%allowed /= ''), &
        'allowed')
    else
      key%text_value = value%text
    end if
  end subroutine assign_text

  pure function control_characters() result(set)
    character(31) :: set
    integer :: i
    do i = 1, 31
      set(i:i) = achar(i)
    end do
  end function control_characters

  pure function number_expected(value, what) result(reason)
    type(value_type), intent(in) :: value
    character(*), intent(in) :: what
    character(:), allocatable :: reason
    reason = ''
    if (value%quoted) then
      reason = what//' is expected, not a text in quotes: '''//value%text//''''
    else if (value%text == '') then
      reason = what//' is expected behind the repeat count'
    end if
  end function number_expected

  ! status 0 if the text has the form of a number; exponent: decimal exponent of its first digit that counts (0 for zero).
  pure subroutine number_form(number, status, exponent)
    character(*), intent(in) :: number
    integer, intent(out) :: status, exponent
    integer :: i, point, first_digit, n_digits, mantissa_end, power
    status = 1
    exponent = 0
    mantissa_end = scan(number, 'eEdDqQ') - 1
    if (mantissa_end < 0) mantissa_end = len(number)
    point = 0
    first_digit = 0
    n_digits = 0
    do i = 1, mantissa_end
      select case (number(i:i))
      case ('0':'9')
        n_digits = n_digits + 1
        if (first_digit == 0 .and. number(i:i) /= '0') first_digit = i
      case ('.')
        if (point > 0) return
        point = i
      case ('+', '-')
        if (i > 1) return
      case default
        return
      end select
    end do
    if (n_digits == 0) return
    if (point == 0) point = mantissa_end + 1
    power = 0
    if (mantissa_end < len(number)) then
      i = mantissa_end + 2
      if (i > len(number)) return
      if (index('+-', number(i:i)) > 0) i = i + 1
      if (i > len(number)) return
      if (verify(number(i:), '0123456789') /= 0) return
      power = 99999
      if (len(number) - i < 5) read (number(i:), *) power
      if (number(mantissa_end + 2:mantissa_end + 2) == '-') power = -power
    end if
    status = 0
    if (first_digit == 0) return
    exponent = power + point - first_digit
    if (first_digit < point) exponent = exponent - 1
  end subroutine number_form

  pure logical function out_of_range(number, key)
    real(wp), intent(in) :: number
    type(key_type), intent(in) :: key
    out_of_range = number < key%low .or. number > key%high .or. (number <= key%low .and. key%low_open) .or. &
      (number >= key%high .and. key%high_open)
  end function out_of_range

  pure function range_text(key) result(range)
    type(key_type), intent(in) :: key
    character(:), allocatable :: range
    logical :: has_low, has_high
    has_low = key%low > -huge(1.0_wp)
    has_high = key%high < huge(1.0_wp)
    range = ''
    if (has_low .and. key%low_open) range = 'more than '//exact_text(key%low)
    if (has_low .and. .not. key%low_open) range = 'at least '//exact_text(key%low)
    if (has_low .and. has_high) range = range//' and '
    if (has_high .and. key%high_open) range = range//'less than '//exact_text(key%high)
    if (has_high .and. .not. key%high_open) range = range//'at most '//exact_text(key%high)
  end function range_text

  !> The shortest text that reads back as the same number, bit for bit: 0.25, 1630.0, 3.712e11.
  pure function exact_text(number) result(short)
    real(wp), intent(in) :: number
    character(:), allocatable :: short
    character(40) :: buffer, format
    real(wp) :: back
    integer :: decimals, power, letter
    do decimals = 0, 16
      write (format, '(a,i0,a)') '(es40.', decimals, 'e4)'
      write (buffer, format) number
      read (buffer, *) back
      if (abs(back - number) <= 0.0_wp) exit
    end do
    letter = scan(buffer, 'E')
    read (buffer(letter + 1:), *) power
    if (power >= -3 .and. power <= 5) then
      write (format, '(a,i0,a)') '(f40.', max(decimals - power, 1), ')'
      write (buffer, format) number
      short = trim(adjustl(buffer))
    else
      short = trim(adjustl(buffer(1:letter - 1)))
      if (short(len(short):) == '.') short = short//'0'
      short = short//'e'//str(power)
    end if
  end function exact_text

  ! Notes a problem at the place of an entry.
  subroutine report(entry, table, reason, problems)
    type(entry_type), intent(in) :: entry
    type(key_table), intent(in) :: table
    character(*), intent(in) :: reason
    type(problem_list), intent(inout) :: problems
    if (allocated(entry%option)) then
      call problems%add(0, group_place(table, entry%key), reason, file='--set '//entry%option)
    else
      call problems%add(entry%line, group_place(table, entry%key), reason)
    end if
  end subroutine report

end module deck_assign
