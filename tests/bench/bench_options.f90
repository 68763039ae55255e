!> What flow_bench was asked for on its command line.
module bench_options
  use, intrinsic :: iso_fortran_env, only: error_unit
  use kinds, only: wp
  implicit none
  private
  public :: read_options, wanted

  integer, parameter :: longest = 400

  type, public :: options_type
    character(16) :: command = '' !< accuracy, speed, stability, particles or list
    character(48), allocatable :: cases(:), schemes(:) !< none: all; those of the command
    integer, allocatable :: cells(:) !< along x; none: each problem's own
    real(wp), allocatable :: cfl(:)
    logical :: quick = .false. !< no long problems, coarse meshes, few windows
    logical :: valid = .true.
  end type options_type

  character(*), parameter :: usage = &
    'usage: flow_bench accuracy|speed|stability|particles|list [--case A,B] [--schemes A,B] [--cells N,M] [--cfl X,Y] [--quick]'

contains

  !> Not valid, and said so, if there is anything that is not understood.
  function read_options() result(options)
    type(options_type) :: options
    character(longest) :: word, value
    integer :: i
    allocate (options%cases(0), options%schemes(0), options%cells(0), options%cfl(0))
    call get_command_argument(1, options%command)
    options%valid = any(options%command == [character(16) :: 'accuracy', 'speed', 'stability', 'particles', 'list'])
    i = 2
    do while (i <= command_argument_count() .and. options%valid)
      call get_command_argument(i, word)
      call get_command_argument(i + 1, value)
      i = i + merge(1, 2, word == '--quick')
      select case (word)
      case ('--quick'); options%quick = .true.
      case ('--case'); options%cases = split(value)
      case ('--schemes'); options%schemes = split(value)
      case ('--cells'); options%cells = nint(numbers(split(value)))
      case ('--cfl'); options%cfl = numbers(split(value))
      case default
        options%valid = .false.
      end select
    end do
    if (.not. options%valid) write (error_unit, '(a)') usage
  end function read_options

  !> Whether a name is in a list, or the list empty.
  pure logical function wanted(name, list)
    character(*), intent(in) :: name
    character(48), intent(in) :: list(:)
    wanted = size(list) == 0 .or. any(list == name)
  end function wanted

  pure function split(text) result(words)
    character(*), intent(in) :: text
    character(48), allocatable :: words(:)
    character(:), allocatable :: rest
    integer :: comma
    allocate (words(0))
    rest = trim(text)//','
    do while (len(rest) > 0)
      comma = index(rest, ',')
      if (comma > 1) words = [character(48) :: words, rest(:comma - 1)]
      rest = rest(comma + 1:)
    end do
  end function split

  pure function numbers(words) result(values)
    character(48), intent(in) :: words(:)
    real(wp) :: values(size(words))
    integer :: i, status
    values = 0
    do i = 1, size(words)
      read (words(i), *, iostat=status) values(i)
    end do
  end function numbers

end module bench_options
