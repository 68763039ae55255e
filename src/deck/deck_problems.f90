!> A list of what is wrong with a deck, so that all of it is told at once, in the order of the lines.
module deck_problems
  use text, only: str, join, nearest_name
  implicit none
  private
  public :: nearest_or_allowed

  type :: problem_type
    integer :: line = 0
    character(:), allocatable :: message
  end type problem_type

  !> Problems of one deck. `file` is the name before the line number, which `add` can replace.
  type, public :: problem_list
    character(:), allocatable :: file
    integer :: n = 0
    type(problem_type), allocatable, private :: problem(:)
  contains
    procedure :: add
    procedure :: message
    procedure :: all_messages
  end type problem_list

contains

  !> Notes one problem. line 0: none can be named. Problems of another file stand before those of the deck.
  subroutine add(self, line, place, reason, file)
    class(problem_list), intent(inout) :: self
    integer, intent(in) :: line
    character(*), intent(in) :: place !< '&group key', or empty
    character(*), intent(in) :: reason
    character(*), intent(in), optional :: file !< instead of the deck's
    type(problem_type), allocatable :: larger(:)
    type(problem_type) :: new
    integer :: i
    if (.not. allocated(self%file)) self%file = 'deck'
    if (.not. allocated(self%problem)) allocate (self%problem(8))
    new%message = self%file
    if (present(file)) new%message = file
    if (line > 0) new%message = new%message//':'//str(line)
    new%message = new%message//': '
    if (place /= '') new%message = new%message//trim(place)//': '
    new%message = new%message//reason
    new%line = merge(0, line, present(file))
    do i = 1, self%n
      if (self%problem(i)%message == new%message) return
    end do
    if (self%n == size(self%problem)) then
      allocate (larger(2*self%n))
      larger(1:self%n) = self%problem
      call move_alloc(larger, self%problem)
    end if
    ! insertion behind all that have the same line or an earlier one
    i = self%n
    do while (i > 0)
      if (self%problem(i)%line <= new%line) exit
      self%problem(i + 1) = self%problem(i)
      i = i - 1
    end do
    self%problem(i + 1) = new
    self%n = self%n + 1
  end subroutine add

  !> The text of problem i.
  pure function message(self, i)
    class(problem_list), intent(in) :: self
    integer, intent(in) :: i
    character(:), allocatable :: message
    message = self%problem(i)%message
  end function message

  !> Every problem on a line of its own.
  pure function all_messages(self) result(lines)
    class(problem_list), intent(in) :: self
    character(:), allocatable :: lines
    integer :: i
    lines = ''
    do i = 1, self%n
      if (i > 1) lines = lines//new_line('a')
      lines = lines//self%problem(i)%message
    end do
  end function all_messages

  !> What to say behind a wrong word: the nearest right one, or else what is allowed if the list is short enough to read.
  pure function nearest_or_allowed(word, candidates, what) result(advice)
    character(*), intent(in) :: word
    character(*), intent(in) :: candidates(:)
    character(*), intent(in) :: what !< kind of the candidates, in the plural
    character(:), allocatable :: advice
    character(:), allocatable :: nearest
    integer, parameter :: readable = 20
    nearest = nearest_name(word, candidates)
    advice = ''
    if (nearest /= '') advice = '; did you mean '''//nearest//'''?'
    if (size(candidates) == 0) then
      advice = '; there are no '//what
    else if (size(candidates) <= readable .and. (nearest == '' .or. size(candidates) <= 8)) then
      advice = advice//' ('//what//': '//join(candidates, ', ')//')'
    end if
  end function nearest_or_allowed

end module deck_problems
