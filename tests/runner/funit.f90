!> The assertions of pFUnit that the tests use, and the bookkeeping of a test program, for machines without pFUnit.
!> A test stops at its first failed assertion; the program goes on to the next test, and exits with status 1 if any failed.
!> This module is the one place of the tests that keeps state: the verdict on the test that runs.
module funit
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_is_finite
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: output_unit
  use kinds, only: wp, i8
  use parallel, only: parallel_start, parallel_stop
  implicit none
  private
  public :: assertEqual, assertNotEqual, assertTrue, assertFalse, assertLessThan, assertLessThanOrEqual, assertGreaterThan, &
            assertGreaterThanOrEqual, assertRelativelyEqual, assertIsNan, assertIsFinite
  public :: start_tests, begin_test, end_test, finish_tests, test_failed

  !> Equal: exactly, or within tolerance (absolute, for reals). Arrays: expected may be a scalar. Not-a-number equals nothing.
  interface assertEqual
    module procedure equal_int, equal_long, equal_int_long, equal_long_int, equal_real, equal_int_real, equal_string, equal_logical
    module procedure equal_ints, equal_longs, equal_reals, equal_strings, equal_logicals
    module procedure equal_int_ints, equal_real_reals
  end interface assertEqual
  interface assertNotEqual
    module procedure not_equal_int, not_equal_real, not_equal_string
  end interface assertNotEqual
  interface assertLessThan
    module procedure less_int, less_long, less_real
  end interface assertLessThan
  interface assertLessThanOrEqual
    module procedure less_equal_int, less_equal_long, less_equal_real
  end interface assertLessThanOrEqual
  interface assertGreaterThan
    module procedure greater_int, greater_long, greater_real
  end interface assertGreaterThan
  interface assertGreaterThanOrEqual
    module procedure greater_equal_int, greater_equal_long, greater_equal_real
  end interface assertGreaterThanOrEqual
  !> abs(actual - expected) <= tolerance*abs(expected), for every element.
  interface assertRelativelyEqual
    module procedure relative_real, relative_reals
  end interface assertRelativelyEqual

  interface
    subroutine c_exit(status) bind(c, name='exit')
      import :: c_int
      integer(c_int), value :: status
    end subroutine c_exit
  end interface

  character(:), allocatable :: module_name, file_name, test_name
  logical :: failed = .false.
  integer :: n_passed = 0, n_failed = 0

contains

  ! ---- the test program

  subroutine start_tests(module, file)
    character(*), intent(in) :: module, file
    call parallel_start()
    module_name = module
    file_name = file
  end subroutine start_tests

  subroutine begin_test(name)
    character(*), intent(in) :: name
    test_name = name
    failed = .false.
    write (output_unit, '(2a)') '  ', name
    flush (output_unit) ! so that the name is there should the test crash
  end subroutine begin_test

  subroutine end_test()
    if (failed) then
      n_failed = n_failed + 1
    else
      n_passed = n_passed + 1
    end if
  end subroutine end_test

  subroutine finish_tests()
    write (output_unit, '(2a,i0,a,i0,a)') module_name, ': ', n_passed, ' passed, ', n_failed, ' failed'
    flush (output_unit)
    call parallel_stop()
    if (n_failed > 0) call c_exit(1_c_int) ! `error stop` would add a backtrace that says nothing of the tests
  end subroutine finish_tests

  !> True when an assertion of the test that runs has failed.
  logical function test_failed()
    test_failed = failed
  end function test_failed

  !> The one place where an assertion fails. what: what was found wrong.
  subroutine verdict(holds, what, message, line)
    logical, intent(in) :: holds
    character(*), intent(in) :: what
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    if (holds .or. failed) return ! only the first failure of a test is told
    failed = .true.
    write (output_unit, '(3a,i0,4a)') '    FAILED at ', file_name, ':', line, ' in ', test_name, ': ', what
    if (present(message)) write (output_unit, '(2a)') '      ', message
    flush (output_unit)
  end subroutine verdict

  ! ---- what the values look like

  pure function show_long(value) result(string)
    integer(i8), intent(in) :: value
    character(:), allocatable :: string
    character(24) :: buffer
    write (buffer, '(i0)') value
    string = trim(buffer)
  end function show_long

  pure function show_int(value) result(string)
    integer, intent(in) :: value
    character(:), allocatable :: string
    string = show_long(int(value, i8))
  end function show_int

  pure function show_real(value) result(string)
    real(wp), intent(in) :: value
    character(:), allocatable :: string
    character(32) :: buffer
    write (buffer, '(es24.16e3)') value
    string = trim(adjustl(buffer))
  end function show_real

  pure function show_logical(value) result(string)
    logical, intent(in) :: value
    character(:), allocatable :: string
    string = trim(merge('true ', 'false', value))
  end function show_logical

  pure function expected_but(expected, actual) result(string)
    character(*), intent(in) :: expected, actual
    character(:), allocatable :: string
    string = 'expected '//expected//', got '//actual
  end function expected_but

  pure function sizes_differ(expected, actual) result(string)
    integer, intent(in) :: expected, actual
    character(:), allocatable :: string
    string = 'expected '//show_int(expected)//' elements, got '//show_int(actual)
  end function sizes_differ

  pure function at_element(element, n_wrong, what) result(string)
    integer, intent(in) :: element, n_wrong
    character(*), intent(in) :: what
    character(:), allocatable :: string
    string = what//' at element '//show_int(element)
    if (n_wrong > 1) string = string//' ('//show_int(n_wrong)//' elements are wrong)'
  end function at_element

  ! ---- assertEqual

  !> Never traps: the difference is taken of finite numbers only.
  elemental logical function near(expected, actual, allowed)
    real(wp), intent(in) :: expected, actual, allowed
    near = .false.
    if (ieee_is_nan(expected) .or. ieee_is_nan(actual) .or. ieee_is_nan(allowed)) return
    near = expected == actual
    if (near .or. .not. ieee_is_finite(expected) .or. .not. ieee_is_finite(actual)) return
    near = abs(0.5_wp*expected - 0.5_wp*actual) <= 0.5_wp*allowed ! halves: no overflow
  end function near

  subroutine equal_real(expected, actual, tolerance, message, line)
    real(wp), intent(in) :: expected, actual
    real(wp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    real(wp) :: allowed
    character(:), allocatable :: what
    allowed = 0
    if (present(tolerance)) allowed = tolerance
    what = expected_but(show_real(expected), show_real(actual))
    if (allowed > 0) what = what//' (tolerance '//show_real(allowed)//')'
    call verdict(near(expected, actual, allowed), what, message, line)
  end subroutine equal_real

  subroutine equal_int_real(expected, actual, tolerance, message, line)
    integer, intent(in) :: expected
    real(wp), intent(in) :: actual
    real(wp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_real(real(expected, wp), actual, tolerance, message, line)
  end subroutine equal_int_real

  subroutine equal_reals(expected, actual, tolerance, message, line)
    real(wp), intent(in) :: expected(:), actual(:)
    real(wp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    real(wp) :: allowed
    integer :: i
    logical :: right(size(actual))
    allowed = 0
    if (present(tolerance)) allowed = tolerance
    if (size(expected) /= size(actual)) then
      call verdict(.false., sizes_differ(size(expected), size(actual)), message, line)
      return
    end if
    right = near(expected, actual, allowed)
    i = findloc(right, .false., dim=1)
    if (i == 0) return
    call verdict(.false., at_element(i, count(.not. right), expected_but(show_real(expected(i)), show_real(actual(i)))), &
                 message, line)
  end subroutine equal_reals

  subroutine equal_real_reals(expected, actual, tolerance, message, line)
    real(wp), intent(in) :: expected, actual(:)
    real(wp), intent(in), optional :: tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_reals(spread(expected, 1, size(actual)), actual, tolerance, message, line)
  end subroutine equal_real_reals

  subroutine equal_long(expected, actual, message, line)
    integer(i8), intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(expected == actual, expected_but(show_long(expected), show_long(actual)), message, line)
  end subroutine equal_long

  subroutine equal_int(expected, actual, message, line)
    integer, intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_long(int(expected, i8), int(actual, i8), message, line)
  end subroutine equal_int

  subroutine equal_int_long(expected, actual, message, line)
    integer, intent(in) :: expected
    integer(i8), intent(in) :: actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_long(int(expected, i8), actual, message, line)
  end subroutine equal_int_long

  subroutine equal_long_int(expected, actual, message, line)
    integer(i8), intent(in) :: expected
    integer, intent(in) :: actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_long(expected, int(actual, i8), message, line)
  end subroutine equal_long_int

  subroutine equal_longs(expected, actual, message, line)
    integer(i8), intent(in) :: expected(:), actual(:)
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    integer :: i
    if (size(expected) /= size(actual)) then
      call verdict(.false., sizes_differ(size(expected), size(actual)), message, line)
      return
    end if
    i = findloc(expected == actual, .false., dim=1)
    if (i == 0) return
    call verdict(.false., at_element(i, count(expected /= actual), expected_but(show_long(expected(i)), show_long(actual(i)))), &
                 message, line)
  end subroutine equal_longs

  subroutine equal_ints(expected, actual, message, line)
    integer, intent(in) :: expected(:), actual(:)
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_longs(int(expected, i8), int(actual, i8), message, line)
  end subroutine equal_ints

  subroutine equal_int_ints(expected, actual, message, line)
    integer, intent(in) :: expected, actual(:)
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call equal_ints(spread(expected, 1, size(actual)), actual, message, line)
  end subroutine equal_int_ints

  subroutine equal_string(expected, actual, message, line)
    character(*), intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(expected == actual, expected_but('"'//expected//'"', '"'//actual//'"'), message, line)
  end subroutine equal_string

  subroutine equal_strings(expected, actual, message, line)
    character(*), intent(in) :: expected(:), actual(:)
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    integer :: i
    if (size(expected) /= size(actual)) then
      call verdict(.false., sizes_differ(size(expected), size(actual)), message, line)
      return
    end if
    i = findloc(expected == actual, .false., dim=1)
    if (i == 0) return
    call verdict(.false., at_element(i, count(expected /= actual), &
                                     expected_but('"'//trim(expected(i))//'"', '"'//trim(actual(i))//'"')), message, line)
  end subroutine equal_strings

  subroutine equal_logical(expected, actual, message, line)
    logical, intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(expected .eqv. actual, expected_but(show_logical(expected), show_logical(actual)), message, line)
  end subroutine equal_logical

  subroutine equal_logicals(expected, actual, message, line)
    logical, intent(in) :: expected(:), actual(:)
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    integer :: i
    if (size(expected) /= size(actual)) then
      call verdict(.false., sizes_differ(size(expected), size(actual)), message, line)
      return
    end if
    i = findloc(expected .eqv. actual, .false., dim=1)
    if (i == 0) return
    call verdict(.false., at_element(i, count(expected .neqv. actual), &
                                     expected_but(show_logical(expected(i)), show_logical(actual(i)))), message, line)
  end subroutine equal_logicals

  ! ---- assertNotEqual

  subroutine not_equal_int(expected, actual, message, line)
    integer, intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(expected /= actual, 'both are '//show_int(actual), message, line)
  end subroutine not_equal_int

  subroutine not_equal_real(expected, actual, message, line)
    real(wp), intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(.not. near(expected, actual, 0.0_wp), 'both are '//show_real(actual), message, line)
  end subroutine not_equal_real

  subroutine not_equal_string(expected, actual, message, line)
    character(*), intent(in) :: expected, actual
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(expected /= actual, 'both are "'//actual//'"', message, line)
  end subroutine not_equal_string

  ! ---- conditions

  subroutine assertTrue(condition, message, line)
    logical, intent(in) :: condition
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(condition, 'expected true, got false', message, line)
  end subroutine assertTrue

  subroutine assertFalse(condition, message, line)
    logical, intent(in) :: condition
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(.not. condition, 'expected false, got true', message, line)
  end subroutine assertFalse

  elemental subroutine compare(a, b, less, equal)
    real(wp), intent(in) :: a, b
    logical, intent(out) :: less, equal
    less = .false.
    equal = .false.
    if (ieee_is_nan(a) .or. ieee_is_nan(b)) return ! nothing holds of it
    less = a < b
    equal = a == b
  end subroutine compare

  subroutine less_real(a, b, message, line)
    real(wp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    logical :: less, equal
    call compare(a, b, less, equal)
    call verdict(less, show_real(a)//' is not less than '//show_real(b), message, line)
  end subroutine less_real

  subroutine less_equal_real(a, b, message, line)
    real(wp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    logical :: less, equal
    call compare(a, b, less, equal)
    call verdict(less .or. equal, show_real(a)//' is not less than or equal to '//show_real(b), message, line)
  end subroutine less_equal_real

  subroutine greater_real(a, b, message, line)
    real(wp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    logical :: less, equal
    call compare(b, a, less, equal)
    call verdict(less, show_real(a)//' is not greater than '//show_real(b), message, line)
  end subroutine greater_real

  subroutine greater_equal_real(a, b, message, line)
    real(wp), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    logical :: less, equal
    call compare(b, a, less, equal)
    call verdict(less .or. equal, show_real(a)//' is not greater than or equal to '//show_real(b), message, line)
  end subroutine greater_equal_real

  subroutine less_long(a, b, message, line)
    integer(i8), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(a < b, show_long(a)//' is not less than '//show_long(b), message, line)
  end subroutine less_long

  subroutine less_equal_long(a, b, message, line)
    integer(i8), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(a <= b, show_long(a)//' is not less than or equal to '//show_long(b), message, line)
  end subroutine less_equal_long

  subroutine greater_long(a, b, message, line)
    integer(i8), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(a > b, show_long(a)//' is not greater than '//show_long(b), message, line)
  end subroutine greater_long

  subroutine greater_equal_long(a, b, message, line)
    integer(i8), intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(a >= b, show_long(a)//' is not greater than or equal to '//show_long(b), message, line)
  end subroutine greater_equal_long

  subroutine less_int(a, b, message, line)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call less_long(int(a, i8), int(b, i8), message, line)
  end subroutine less_int

  subroutine less_equal_int(a, b, message, line)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call less_equal_long(int(a, i8), int(b, i8), message, line)
  end subroutine less_equal_int

  subroutine greater_int(a, b, message, line)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call greater_long(int(a, i8), int(b, i8), message, line)
  end subroutine greater_int

  subroutine greater_equal_int(a, b, message, line)
    integer, intent(in) :: a, b
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call greater_equal_long(int(a, i8), int(b, i8), message, line)
  end subroutine greater_equal_int

  ! ---- relative

  !> The allowed difference; infinite and NaN expectations allow none.
  elemental real(wp) function allowance(expected, tolerance)
    real(wp), intent(in) :: expected, tolerance
    allowance = 0
    if (ieee_is_finite(expected)) allowance = tolerance*abs(expected)
  end function allowance

  subroutine relative_real(expected, actual, tolerance, message, line)
    real(wp), intent(in) :: expected, actual, tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(near(expected, actual, allowance(expected, tolerance)), &
                 expected_but(show_real(expected), show_real(actual))//' (relative tolerance '//show_real(tolerance)//')', &
                 message, line)
  end subroutine relative_real

  subroutine relative_reals(expected, actual, tolerance, message, line)
    real(wp), intent(in) :: expected(:), actual(:), tolerance
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    logical :: right(size(actual))
    integer :: i
    if (size(expected) /= size(actual)) then
      call verdict(.false., sizes_differ(size(expected), size(actual)), message, line)
      return
    end if
    right = near(expected, actual, allowance(expected, tolerance))
    i = findloc(right, .false., dim=1)
    if (i == 0) return
    call verdict(.false., at_element(i, count(.not. right), expected_but(show_real(expected(i)), show_real(actual(i)))), &
                 message, line)
  end subroutine relative_reals

  subroutine assertIsNan(value, message, line)
    real(wp), intent(in) :: value
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(ieee_is_nan(value), expected_but('not-a-number', show_real(value)), message, line)
  end subroutine assertIsNan

  subroutine assertIsFinite(value, message, line)
    real(wp), intent(in) :: value
    character(*), intent(in), optional :: message
    integer, intent(in) :: line
    call verdict(ieee_is_finite(value), expected_but('a finite number', show_real(value)), message, line)
  end subroutine assertIsFinite

end module funit
