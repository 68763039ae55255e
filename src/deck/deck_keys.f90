!> The keys of one group of the deck: name, place of the value, dimension, what is allowed.
!> Reading, writing, checking and unit conversion all run over this one table.
module deck_keys
  use kinds, only: wp
  use constants, only: unset
  use units, only: of_nothing
  implicit none
  private

  integer, parameter, public :: kind_real = 1, kind_integer = 2, kind_logical = 3, kind_text = 4
  integer, parameter, public :: word_length = 64 !< of names and of values from a list
  integer, parameter, public :: path_length = 256 !< of titles and paths

  !> One key of one group; the value itself stands in the group that was given to `add`.
  type, public :: key_type
    character(32) :: name = ''
    integer :: kind = 0 !< kind_real ...
    integer :: n = 1 !< number of elements
    logical :: required = .false.
    integer :: dimension(4) = of_nothing !< exponents of mass, length, time, temperature
    real(wp) :: low = -huge(1.0_wp), high = huge(1.0_wp) !< allowed range
    logical :: low_open = .false., high_open = .false. !< the end itself is not allowed
    real(wp) :: usual(2) = [-huge(1.0_wp), huge(1.0_wp)] !< range in SI outside which the number is doubtful
    character(word_length), allocatable :: allowed(:) !< words; unallocated: any text
    integer :: line = 0 !< where the deck gives it, 0 where it does not
    logical :: from_option = .false. !< given on the command line
    logical :: bad = .false. !< what the deck gives cannot be used, and this was noted
    logical, allocatable :: given(:) !< which elements the deck gives
    real(wp), pointer :: real_value => null()
    real(wp), pointer :: real_values(:) => null()
    integer, pointer :: integer_value => null()
    integer, pointer :: integer_values(:) => null()
    logical, pointer :: logical_value => null()
    character(:), pointer :: text_value => null()
  contains
    procedure :: real_element
    procedure :: set_real
    procedure :: integer_element
    procedure :: set_integer
  end type key_type

  !> All keys of one group in the order of its declaration.
  type, public :: key_table
    character(32) :: group = ''
    integer :: index = 1 !< which of the groups of this name
    integer, pointer :: line => null() !< where the group starts (kept in the group), 0 if the deck has none
    logical :: incomplete = .false. !< part of the group could not be read: no check of what it lacks
    integer :: n = 0 !< number of keys
    type(key_type), allocatable :: key(:)
  contains
    procedure :: start
    procedure :: find
    procedure :: is_given
    procedure :: is_bad
    procedure :: line_of
    procedure, private :: add_real, add_reals, add_integer, add_integers, add_logical, add_text
    generic :: add => add_real, add_reals, add_integer, add_integers, add_logical, add_text
  end type key_table

contains

  !> Empties the table for the group of this name, whose line in the deck stands in `line`.
  subroutine start(self, group, line)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: group
    integer, intent(inout), target :: line
    self%group = group
    self%index = 1
    self%line => line
    self%incomplete = .false.
    self%n = 0
    if (allocated(self%key)) deallocate (self%key)
    allocate (self%key(16))
  end subroutine start

  !> Number of the key with this name (lower case), 0 if there is none.
  pure integer function find(self, name)
    class(key_table), intent(in) :: self
    character(*), intent(in) :: name
    do find = 1, self%n
      if (self%key(find)%name == name) return
    end do
    find = 0
  end function find

  !> True if the deck gives the key (not only its default).
  pure logical function is_given(self, name)
    class(key_table), intent(in) :: self
    character(*), intent(in) :: name
    integer :: i
    i = self%find(name)
    is_given = .false.
    if (i > 0) is_given = any(self%key(i)%given)
  end function is_given

  !> True if what the deck gives for the key could not be used.
  pure logical function is_bad(self, name)
    class(key_table), intent(in) :: self
    character(*), intent(in) :: name
    integer :: i
    i = self%find(name)
    is_bad = .false.
    if (i > 0) is_bad = self%key(i)%bad
  end function is_bad

  !> Line of the key, or of its group where the deck does not give the key.
  pure integer function line_of(self, name) result(line)
    class(key_table), intent(in) :: self
    character(*), intent(in) :: name
    integer :: i
    line = self%line
    i = self%find(name)
    if (i == 0) return
    if (any(self%key(i)%given)) line = self%key(i)%line
  end function line_of

  subroutine add_real(self, name, value, dimension, more_than, at_least, less_than, at_most, usual, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    real(wp), intent(inout), target :: value
    integer, intent(in), optional :: dimension(4)
    real(wp), intent(in), optional :: more_than, at_least, less_than, at_most, usual(2)
    logical, intent(in), optional :: required
    call append(self, name, kind_real, 1, required)
    self%key(self%n)%real_value => value
    call set_range(self%key(self%n), dimension, more_than, at_least, less_than, at_most, usual)
  end subroutine add_real

  subroutine add_reals(self, name, value, dimension, more_than, at_least, less_than, at_most, usual, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    real(wp), intent(inout), target :: value(:)
    integer, intent(in), optional :: dimension(4)
    real(wp), intent(in), optional :: more_than, at_least, less_than, at_most, usual(2)
    logical, intent(in), optional :: required
    call append(self, name, kind_real, size(value), required)
    self%key(self%n)%real_values => value
    call set_range(self%key(self%n), dimension, more_than, at_least, less_than, at_most, usual)
  end subroutine add_reals

  subroutine add_integer(self, name, value, at_least, at_most, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    integer, intent(inout), target :: value
    integer, intent(in), optional :: at_least, at_most
    logical, intent(in), optional :: required
    call append(self, name, kind_integer, 1, required)
    self%key(self%n)%integer_value => value
    if (present(at_least)) self%key(self%n)%low = real(at_least, wp)
    if (present(at_most)) self%key(self%n)%high = real(at_most, wp)
  end subroutine add_integer

  subroutine add_integers(self, name, value, at_least, at_most, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    integer, intent(inout), target :: value(:)
    integer, intent(in), optional :: at_least, at_most
    logical, intent(in), optional :: required
    call append(self, name, kind_integer, size(value), required)
    self%key(self%n)%integer_values => value
    if (present(at_least)) self%key(self%n)%low = real(at_least, wp)
    if (present(at_most)) self%key(self%n)%high = real(at_most, wp)
  end subroutine add_integers

  subroutine add_logical(self, name, value)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    logical, intent(inout), target :: value
    call append(self, name, kind_logical, 1)
    self%key(self%n)%logical_value => value
  end subroutine add_logical

  subroutine add_text(self, name, value, allowed, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    character(*), intent(inout), target :: value
    character(*), intent(in), optional :: allowed(:) !< words; the empty word must be listed where it is allowed
    logical, intent(in), optional :: required
    call append(self, name, kind_text, 1, required)
    self%key(self%n)%text_value => value
    if (present(allowed)) then
      allocate (self%key(self%n)%allowed(size(allowed)))
      self%key(self%n)%allowed(:) = allowed
    end if
  end subroutine add_text

  subroutine append(self, name, kind, n, required)
    class(key_table), intent(inout) :: self
    character(*), intent(in) :: name
    integer, intent(in) :: kind, n
    logical, intent(in), optional :: required
    type(key_type), allocatable :: larger(:)
    if (self%n == size(self%key)) then
      allocate (larger(2*self%n))
      larger(1:self%n) = self%key
      call move_alloc(larger, self%key)
    end if
    self%n = self%n + 1
    self%key(self%n)%name = name
    self%key(self%n)%kind = kind
    self%key(self%n)%n = n
    allocate (self%key(self%n)%given(n), source=.false.)
    if (present(required)) self%key(self%n)%required = required
  end subroutine append

  subroutine set_range(key, dimension, more_than, at_least, less_than, at_most, usual)
    type(key_type), intent(inout) :: key
    integer, intent(in), optional :: dimension(4)
    real(wp), intent(in), optional :: more_than, at_least, less_than, at_most, usual(2)
    if (present(dimension)) key%dimension = dimension
    if (present(at_least)) key%low = at_least
    if (present(at_most)) key%high = at_most
    if (present(usual)) key%usual = usual
    if (present(more_than)) then
      key%low = more_than
      key%low_open = .true.
    end if
    if (present(less_than)) then
      key%high = less_than
      key%high_open = .true.
    end if
  end subroutine set_range

  pure real(wp) function real_element(self, i)
    class(key_type), intent(in) :: self
    integer, intent(in) :: i
    real_element = unset
    if (associated(self%real_value)) real_element = self%real_value
    if (associated(self%real_values)) real_element = self%real_values(i)
  end function real_element

  subroutine set_real(self, i, value)
    class(key_type), intent(in) :: self
    integer, intent(in) :: i
    real(wp), intent(in) :: value
    if (associated(self%real_value)) self%real_value = value
    if (associated(self%real_values)) self%real_values(i) = value
  end subroutine set_real

  pure integer function integer_element(self, i)
    class(key_type), intent(in) :: self
    integer, intent(in) :: i
    integer_element = 0
    if (associated(self%integer_value)) integer_element = self%integer_value
    if (associated(self%integer_values)) integer_element = self%integer_values(i)
  end function integer_element

  subroutine set_integer(self, i, value)
    class(key_type), intent(in) :: self
    integer, intent(in) :: i
    integer, intent(in) :: value
    if (associated(self%integer_value)) self%integer_value = value
    if (associated(self%integer_values)) self%integer_values(i) = value
  end subroutine set_integer

end module deck_keys
