!> Strings: numbers to text, lower case, lists, and the nearest right name for a wrong one.
module text
  use kinds, only: wp, i8
  implicit none
  private
  public :: str, lowercase, nearest_name, edit_distance, join, append

  !> A number or a logical as short text.
  interface str
    module procedure str_integer, str_long, str_real, str_logical
  end interface str

contains

  pure function str_integer(value) result(string)
    integer, intent(in) :: value
    character(:), allocatable :: string
    character(16) :: buffer
    write (buffer, '(i0)') value
    string = trim(buffer)
  end function str_integer

  pure function str_long(value) result(string)
    integer(i8), intent(in) :: value
    character(:), allocatable :: string
    character(24) :: buffer
    write (buffer, '(i0)') value
    string = trim(buffer)
  end function str_long

  !> The shortest text with this many significant digits (default 6; 17 keeps every bit): 0.0125, 75, 1.3e-06.
  pure function str_real(value, digits) result(string)
    real(wp), intent(in) :: value
    integer, intent(in), optional :: digits
    character(:), allocatable :: string
    character(40) :: buffer, format
    integer :: n, decimals
    n = 6
    if (present(digits)) n = digits
    if (abs(value) >= 1e-3_wp .and. abs(value) < 1e6_wp) then
      decimals = max(n - 1 - floor(log10(abs(value))), 0)
      write (format, '(a,i0,a)') '(f0.', decimals, ')'
      write (buffer, format) value
      string = trim(without_zeros(buffer))
      if (string(1:1) == '.') string = '0'//string
      if (len(string) > 1) then
        if (string(1:2) == '-.') string = '-0'//string(2:)
      end if
    else if (abs(value) <= 0) then
      string = '0'
    else
      write (format, '(a,i0,a)') '(es40.', n - 1, 'e3)'
      write (buffer, format) value
      buffer = adjustl(buffer)
      string = trim(without_zeros(buffer(:scan(buffer, 'E') - 1)))//exponent_text(buffer(scan(buffer, 'E') + 1:))
    end if
  end function str_real

  !> A number without the zeros that end its decimals, nor the point if nothing is left of them.
  pure function without_zeros(number) result(short)
    character(*), intent(in) :: number
    character(:), allocatable :: short
    short = trim(adjustl(number))
    if (index(short, '.') == 0) return
    do while (short(len(short):) == '0')
      short = short(:len(short) - 1)
    end do
    if (short(len(short):) == '.') short = short(:len(short) - 1)
  end function without_zeros

  !> 'e-06' from '-006'; nothing for a number that has no exponent (infinite, not a number).
  pure function exponent_text(exponent) result(short)
    character(*), intent(in) :: exponent
    character(:), allocatable :: short
    integer :: value, status
    character(8) :: buffer
    short = ''
    read (exponent, *, iostat=status) value
    if (status /= 0) return
    write (buffer, '(i0.2)') abs(value)
    short = 'e'//trim(merge('-', '+', value < 0))//trim(buffer)
  end function exponent_text

  pure function str_logical(value) result(string)
    logical, intent(in) :: value
    character(:), allocatable :: string
    string = trim(merge('true ', 'false', value))
  end function str_logical

  !> The string with A-Z made a-z.
  pure function lowercase(string) result(lower)
    character(*), intent(in) :: string
    character(len(string)) :: lower
    integer :: i, c
    do i = 1, len(string)
      c = iachar(string(i:i))
      if (c >= iachar('A') .and. c <= iachar('Z')) c = c + 32
      lower(i:i) = achar(c)
    end do
  end function lowercase

  !> Number of single-character insertions, deletions and substitutions that turn a into b (Levenshtein).
  pure integer function edit_distance(a, b) result(distance)
    character(*), intent(in) :: a, b
    integer :: row(0:len_trim(b)), i, j, diagonal, above
    row = [(j, j=0, len_trim(b))]
    do i = 1, len_trim(a)
      diagonal = row(0)
      row(0) = i
      do j = 1, len_trim(b)
        above = row(j)
        row(j) = min(above + 1, row(j - 1) + 1, diagonal + merge(0, 1, a(i:i) == b(j:j)))
        diagonal = above
      end do
    end do
    distance = row(len_trim(b))
  end function edit_distance

  !> The candidate closest to name, or an empty string if none is near (more than a third of its letters differ).
  pure function nearest_name(name, candidates) result(nearest)
    character(*), intent(in) :: name
    character(*), intent(in) :: candidates(:)
    character(:), allocatable :: nearest
    integer :: i, distance, best
    nearest = ''
    best = max(2, len_trim(name)/3) + 1
    do i = 1, size(candidates)
      distance = edit_distance(lowercase(name), lowercase(candidates(i)))
      if (distance < best) then
        best = distance
        nearest = trim(candidates(i))
      end if
    end do
  end function nearest_name

  !> The strings of a list, trimmed, with a separator between them.
  pure function join(list, separator) result(string)
    character(*), intent(in) :: list(:)
    character(*), intent(in) :: separator
    character(:), allocatable :: string
    integer :: i
    string = ''
    do i = 1, size(list)
      if (i > 1) string = string//separator
      string = string//trim(list(i))
    end do
  end function join

  !> Adds a string to a list, cut or filled up to the length of its strings.
  pure subroutine append(list, string)
    character(*), allocatable, intent(inout) :: list(:)
    character(*), intent(in) :: string
    character(len(list)), allocatable :: longer(:)
    integer :: n
    n = size(list)
    allocate (longer(n + 1))
    longer(:n) = list
    longer(n + 1) = string
    call move_alloc(longer, list)
  end subroutine append

end module text
