!> &output: what is written, where, and how often.
module deck_output
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, path_length
  use units, only: of_time
  implicit none
  private
  public :: output_keys

  type, public :: output_group
    character(path_length) :: directory = '' !< set by the checks to runs/<deck name>
    real(wp) :: snapshot_interval = 0 !< time, 0: only first and last
    real(wp) :: snapshot_times(50) = unset !< more snapshots, at these times
    real(wp) :: gauge_interval = 0 !< time, 0: every step
    integer :: history_interval = 1 !< steps
    real(wp) :: restart_interval = 0 !< time, 0: only when stopped
    logical :: peak_maps = .true.
    logical :: flow_snapshots = .true.
    logical :: solid_snapshots = .true.
    logical :: fragments = .false. !< of the solid, counted with each snapshot
    real(wp) :: fragment_reach = 1.8_wp !< distance over spacing up to which particles hang together
    real(wp) :: fragment_damage = 1 !< particles of at least this damage belong to no fragment
    logical :: loads = .false. !< of the flow on each body: their history, and maps on its surface
    integer :: line = 0
  end type output_group

contains

  subroutine output_keys(group, table)
    type(output_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('output', group%line)
    call table%add('directory', group%directory)
    call table%add('snapshot_interval', group%snapshot_interval, of_time, at_least=0.0_wp)
    call table%add('snapshot_times', group%snapshot_times, of_time, at_least=0.0_wp)
    call table%add('gauge_interval', group%gauge_interval, of_time, at_least=0.0_wp)
    call table%add('history_interval', group%history_interval, at_least=1)
    call table%add('restart_interval', group%restart_interval, of_time, at_least=0.0_wp)
    call table%add('peak_maps', group%peak_maps)
    call table%add('flow_snapshots', group%flow_snapshots)
    call table%add('solid_snapshots', group%solid_snapshots)
    call table%add('fragments', group%fragments)
    call table%add('fragment_reach', group%fragment_reach, more_than=1.0_wp, at_most=10.0_wp)
    call table%add('fragment_damage', group%fragment_damage, more_than=0.0_wp)
    call table%add('loads', group%loads)
  end subroutine output_keys

end module deck_output
