!> Runs of the program from tests: call it, look at its exit status and at what it wrote.
module program_runs
  use text, only: str
  implicit none
  private
  public :: run_deck, summary_value, same_file, deck_path, scratch_folder

contains

  !> Path of a deck of input/.
  function deck_path(name) result(path)
    character(*), intent(in) :: name
    character(:), allocatable :: path
    path = environment('BRISANCE_SOURCE')//'/input/'//name//'.nml'
  end function deck_path

  !> A folder of that name for the output of a test, empty at first.
  function scratch_folder(name) result(folder)
    character(*), intent(in) :: name
    character(:), allocatable :: folder
    folder = 'test_output/'//name
    call execute_command_line('rm -rf '//folder//' && mkdir -p '//folder)
  end function scratch_folder

  !> Runs a deck on a number of ranks; the exit status of the program.
  integer function run_deck(deck, folder, ranks, arguments) result(status)
    character(*), intent(in) :: deck, folder, arguments
    integer, intent(in) :: ranks
    call execute_command_line(environment('MPIEXEC')//' -n '//str(ranks)//' '//environment('BRISANCE_EXE')//' '//deck// &
                              ' --output '//folder//' '//arguments//' >> '//folder//'.log 2>&1', exitstat=status)
  end function run_deck

  !> The text that stands behind a key in the summary of a run; empty where there is none.
  function summary_value(folder, key) result(value)
    character(*), intent(in) :: folder, key
    character(:), allocatable :: value
    character(512) :: line
    integer :: unit, status, at
    value = ''
    open (newunit=unit, file=folder//'/summary.json', status='old', action='read', iostat=status)
    if (status /= 0) return
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      at = index(line, '"'//key//'":')
      if (at == 0) cycle
      value = trim(adjustl(line(at + len(key) + 3:)))
      exit
    end do
    close (unit)
    if (len(value) > 0) then
      if (value(len(value):) == ',') value = value(:len(value) - 1)
    end if
  end function summary_value

  !> True if both files exist and hold the same bytes.
  logical function same_file(a, b)
    character(*), intent(in) :: a, b
    integer :: status
    call execute_command_line('cmp -s '//a//' '//b, exitstat=status)
    same_file = status == 0
  end function same_file

  function environment(name) result(value)
    character(*), intent(in) :: name
    character(:), allocatable :: value
    integer :: length
    call get_environment_variable(name, length=length)
    allocate (character(length) :: value)
    call get_environment_variable(name, value)
  end function environment

end module program_runs
