!> &stages: how long each of the solvers is needed.
module deck_stages
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use kinds, only: wp
  use units, only: of_time
  implicit none
  private
  public :: stages_keys

  type, public :: stages_group
    character(word_length) :: solid_start = 'loaded' !< or 'at_once'
    character(word_length) :: flow_end = 'never' !< or 'faded'
    real(wp) :: flow_end_time = unset
    real(wp) :: faded_part = 0.005_wp !< of the load so far, in the second half of its time
    character(word_length) :: solid_end = 'never' !< or 'rest'
    real(wp) :: rest_part = 1e-4_wp !< of the largest kinetic energy, in the second half of the motion
    integer :: line = 0
  end type stages_group

contains

  subroutine stages_keys(group, table)
    type(stages_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('stages', group%line)
    call table%add('solid_start', group%solid_start, [character(word_length) :: 'loaded', 'at_once'])
    call table%add('flow_end', group%flow_end, [character(word_length) :: 'never', 'faded'])
    call table%add('flow_end_time', group%flow_end_time, of_time, more_than=0.0_wp)
    call table%add('faded_part', group%faded_part, more_than=0.0_wp, at_most=0.5_wp)
    call table%add('solid_end', group%solid_end, [character(word_length) :: 'never', 'rest'])
    call table%add('rest_part', group%rest_part, more_than=0.0_wp, at_most=0.5_wp)
  end subroutine stages_keys

end module deck_stages
