!> &run: the clock, the unit system and the title.
module deck_run
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length, path_length
  use units, only: of_time, unit_system_names
  implicit none
  private
  public :: run_keys

  type, public :: run_group
    character(path_length) :: title = ''
    character(word_length) :: units = 'SI' !< one of unit_system_names
    real(wp) :: end_time = unset
    integer :: max_steps = huge(1)
    real(wp) :: wall_limit = 0 !< seconds of wall time, 0: none
    integer :: report_interval = 100 !< steps
    integer :: line = 0 !< of the group in the deck
  end type run_group

contains

  !> The keys of the group, in a table that points at its components.
  subroutine run_keys(group, table)
    type(run_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('run', group%line)
    call table%add('title', group%title)
    call table%add('units', group%units, allowed=unit_system_names)
    call table%add('end_time', group%end_time, of_time, more_than=0.0_wp, usual=[1e-9_wp, 1e3_wp], required=.true.)
    call table%add('max_steps', group%max_steps, at_least=0)
    call table%add('wall_limit', group%wall_limit, at_least=0.0_wp)
    call table%add('report_interval', group%report_interval, at_least=1)
  end subroutine run_keys

end module deck_run
