!> The command line: brisance DECK [options].
module options
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp
  use text, only: append, nearest_name
  implicit none
  private
  public :: read_options, usage

  !> What the user asked for beside the deck.
  type, public :: options_type
    character(:), allocatable :: deck !< path of the deck
    character(:), allocatable :: output !< output folder; empty: from the deck
    character(:), allocatable :: restart_file !< empty: the newest in the output folder
    logical :: restart = .false.
    logical :: check = .false. !< print the plan and stop
    logical :: material_test = .false. !< run the material tests of the deck instead of its scene
    logical :: quiet = .false.
    logical :: help = .false.
    logical :: version = .false.
    real(wp) :: until = huge(1.0_wp) !< earlier end time
    integer :: steps = huge(1) !< fewer steps, counted from the start of this run
    real(wp) :: wall_limit = 0 !< seconds, 0 none
    character(256), allocatable :: overrides(:) !< group%name=value
  end type options_type

  character(*), parameter :: known(11) = [character(15) :: '--check', '--material-test', '--restart', '--output', '--until', &
                                          '--steps', '--set', '--quiet', '--wall-limit', '--help', '--version']

contains

  !> How to call the program.
  function usage() result(lines)
    character(:), allocatable :: lines
    lines = 'usage: brisance DECK [options]'//new_line('a')// &
      '  --check              read and check the deck, print the plan, run nothing'//new_line('a')// &
      '  --material-test      run the material tests of the deck, write their curves, and stop'//new_line('a')// &
      '  --restart[=FILE]     go on from FILE, or from the newest restart file of the output folder'//new_line('a')// &
      '  --output DIR         output folder (default: from the deck, else runs/<deck name>)'//new_line('a')// &
      '  --until TIME         end at this time, if it is before the end time of the deck'//new_line('a')// &
      '  --steps N            end after N steps'//new_line('a')// &
      '  --set GROUP%KEY=VALUE  override a key of the deck; may be repeated'//new_line('a')// &
      '  --wall-limit SECONDS write a restart file and stop with status 4 before this much time has passed'//new_line('a')// &
      '  --quiet              print warnings and errors only'//new_line('a')// &
      'exit status: 0 done; 2 bad deck or option; 3 the computation failed; 4 stopped after writing a restart file'
  end function usage

  !> Reads the arguments; fatal (bad input) on a mistake, with the nearest right name.
  function read_options() result(options)
    type(options_type) :: options
    integer :: i
    character(:), allocatable :: argument, name, value
    options%deck = ''
    options%output = ''
    options%restart_file = ''
    allocate (options%overrides(0))
    i = 0
    do while (i < command_argument_count())
      i = i + 1
      argument = get_argument(i)
      if (index(argument, '--') /= 1) then
        if (len(options%deck) > 0) call fatal('two decks are given: '//options%deck//' and '//argument, exit_bad_input)
        options%deck = argument
        cycle
      end if
      call split_option(argument, name, value)
      select case (name)
      case ('--check'); options%check = .true.
      case ('--material-test'); options%material_test = .true.
      case ('--quiet'); options%quiet = .true.
      case ('--help'); options%help = .true.
      case ('--version'); options%version = .true.
      case ('--restart')
        options%restart = .true.
        options%restart_file = value
      case ('--output', '--until', '--steps', '--set', '--wall-limit')
        if (index(argument, '=') == 0 .or. name == '--set' .and. len(value) == 0) then
          i = i + 1
          if (i > command_argument_count()) call fatal('option '//name//' needs a value', exit_bad_input)
          value = get_argument(i)
        end if
        call store_value(options, name, value)
      case default
        call fatal('unknown option '//name//did_you_mean(nearest_name(name, known)), exit_bad_input)
      end select
    end do
    if (len(options%deck) == 0 .and. .not. (options%help .or. options%version)) &
      call fatal('no deck is given'//new_line('a')//usage(), exit_bad_input)
  end function read_options

  subroutine store_value(options, name, value)
    type(options_type), intent(inout) :: options
    character(*), intent(in) :: name, value
    integer :: status
    status = 0
    select case (name)
    case ('--output'); options%output = value
    case ('--until'); read (value, *, iostat=status) options%until
    case ('--steps'); read (value, *, iostat=status) options%steps
    case ('--wall-limit'); read (value, *, iostat=status) options%wall_limit
    case ('--set')
      call append(options%overrides, value)
    end select
    if (status /= 0) call fatal('option '//name//': "'//value//'" is not a number', exit_bad_input)
  end subroutine store_value

  !> '--name=value' in its two parts; the value is empty where there is none.
  subroutine split_option(argument, name, value)
    character(*), intent(in) :: argument
    character(:), allocatable, intent(out) :: name, value
    integer :: equals
    equals = index(argument, '=')
    if (equals == 0) equals = len(argument) + 1
    name = argument(:equals - 1)
    value = argument(min(equals + 1, len(argument) + 1):)
  end subroutine split_option

  function did_you_mean(name) result(hint)
    character(*), intent(in) :: name
    character(:), allocatable :: hint
    hint = ''
    if (len(name) > 0) hint = ' (did you mean '//name//'?)'
  end function did_you_mean

  function get_argument(i) result(argument)
    integer, intent(in) :: i
    character(:), allocatable :: argument
    integer :: length
    call get_command_argument(i, length=length)
    allocate (character(length) :: argument)
    call get_command_argument(i, argument)
  end function get_argument

end module options
