!> A quantity over time, kept at times that grow by a fixed ratio: enough to ask what its second half was like.
module time_record
  use kinds, only: wp
  implicit none
  private

  real(wp), parameter :: ratio = 1.02_wp !< of the ages of two entries

  type, public :: record_type
    real(wp) :: start = -huge(1.0_wp) !< time from which age counts; not begun: -huge
    real(wp), allocatable :: age(:), value(:) !< rising ages
  contains
    procedure :: has_begun
    procedure :: note
    procedure :: second_half
    procedure :: value_at
  end type record_type

contains

  pure logical function has_begun(self)
    class(record_type), intent(in) :: self
    has_begun = self%start > -huge(1.0_wp)
  end function has_begun

  !> Notes a value; the first call begins the record. A value is kept if the record has aged enough since the last one.
  pure subroutine note(self, time, value)
    class(record_type), intent(inout) :: self
    real(wp), intent(in) :: time, value
    real(wp) :: age
    if (.not. self%has_begun()) then
      self%start = time
      self%age = [0.0_wp]
      self%value = [value]
      return
    end if
    age = time - self%start
    if (age < ratio*self%age(size(self%age))) return
    self%age = [self%age, age]
    self%value = [self%value, value]
  end subroutine note

  !> Index of the first entry in the second half of the record's age at this time.
  pure integer function second_half(self, time) result(first)
    class(record_type), intent(in) :: self
    real(wp), intent(in) :: time
    do first = 1, size(self%age) - 1
      if (self%age(first) >= 0.5_wp*(time - self%start)) return
    end do
    first = size(self%age)
  end function second_half

  !> Value at half of the age at this time, or the last one kept before it.
  pure real(wp) function value_at(self, half_of)
    class(record_type), intent(in) :: self
    real(wp), intent(in) :: half_of
    integer :: first
    first = self%second_half(half_of)
    if (self%age(first) > 0.5_wp*(half_of - self%start)) first = max(1, first - 1)
    value_at = self%value(first)
  end function value_at

end module time_record
