!> A list of what is wrong with a deck, so that all of it is told at once, in the order of the lines.
module deck_problems
  use deck_keys, only: key_table
  use text, only: str, join, nearest_name
  implicit none
  private
  public :: group_place, nearest_or_allowed

  type :: problem_type
    integer :: line = 0
    character(:), allocatable :: message
  end type problem_type

  !> Problems of one deck. `file` is the name before the line number, which `add` can replace.
  type, public :: problem_list
    character(:), allocatable :: file
    logical :: has_lines = .true. !< false: line numbers mean nothing (text from the command line)
    integer :: n = 0
    type(problem_type), allocatable, private :: problem(:)
  contains
    procedure :: add
    procedure :: add_at_key
    procedure :: take
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
    character(:), allocatable :: message
    if (.not. allocated(self%file)) self%file = 'deck'
    message = self%file
    if (present(file)) message = file
    if (line > 0 .and. self%has_lines) message = message//':'//str(line)
    message = message//': '
    if (place /= '') message = message//trim(place)//': '
    call insert(self, merge(0, line, present(file)), message//reason)
  end subroutine add

  ! Puts a message behind all that have the same line or an earlier one, unless it is there already.
  subroutine insert(self, line, message)
    class(problem_list), intent(inout) :: self
    integer, intent(in) :: line
    character(*), intent(in) :: message
    type(problem_type), allocatable :: larger(:)
    integer :: i
    if (.not. allocated(self%problem)) allocate (self%problem(8))
    do i = 1, self%n
      if (self%problem(i)%message == message) return
    end do
    if (self%n == size(self%problem)) then
      allocate (larger(2*self%n))
      larger(1:self%n) = self%problem
      call move_alloc(larger, self%problem)
    end if
    i = self%n
    do while (i > 0)
      if (self%problem(i)%line <= line) exit
      self%problem(i + 1) = self%problem(i)
      i = i - 1
    end do
    self%problem(i + 1)%line = line
    self%problem(i + 1)%message = message
    self%n = self%n + 1
  end subroutine insert

  !> Notes a problem with a key (or, with an empty key, a group), where the deck gives it.
  subroutine add_at_key(self, table, key, reason)
    class(problem_list), intent(inout) :: self
    type(key_table), intent(in) :: table
    character(*), intent(in) :: key
    character(*), intent(in) :: reason
    integer :: k
    k = table%find(key)
    if (k > 0) then
      if (table%key(k)%from_option) then
        call self%add(0, group_place(table, key), reason, file='--set')
        return
      end if
    end if
    call self%add(table%line_of(key), group_place(table, key), reason)
  end subroutine add_at_key

  !> Takes over the problems of another list as they are.
  subroutine take(self, other)
    class(problem_list), intent(inout) :: self
    type(problem_list), intent(in) :: other
    integer :: i
    do i = 1, other%n
      call insert(self, 0, other%problem(i)%message)
    end do
  end subroutine take

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

  !> '&group key', with the number of the group if it is not the first of its name.
  pure function group_place(table, key) result(place)
    type(key_table), intent(in) :: table
    character(*), intent(in) :: key
    character(:), allocatable :: place
    place = '&'//trim(table%group)
    if (table%index > 1) place = place//'('//str(table%index)//')'
    if (key /= '') place = place//' '//key
  end function group_place

end module deck_problems
