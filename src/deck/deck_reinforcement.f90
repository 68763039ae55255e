!> &reinforcement (repeated): a row of parallel bars that replace the particles they cover.
module deck_reinforcement
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length
  implicit none
  private
  public :: reinforcement_keys

  type, public :: reinforcement_group
    character(word_length) :: body = '' !< name of the body that holds the bars
    character(word_length) :: material = ''
    real(wp) :: diameter = unset
    real(wp) :: start(3) = unset, end(3) = unset !< axis of the first bar
    integer :: count = 1 !< number of bars
    real(wp) :: step(3) = 0 !< from one bar to the next
    real(wp) :: spacing = 0 !< of the particles, 0: as the body
    integer :: line = 0
  end type reinforcement_group

contains

  subroutine reinforcement_keys(group, table)
    type(reinforcement_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('reinforcement', group%line)
    call table%add('body', group%body, required=.true.)
    call table%add('material', group%material, required=.true.)
    call table%add('diameter', group%diameter, of_length, more_than=0.0_wp, required=.true.)
    call table%add('start', group%start, of_length, required=.true.)
    call table%add('end', group%end, of_length, required=.true.)
    call table%add('count', group%count, at_least=1)
    call table%add('step', group%step, of_length)
    call table%add('spacing', group%spacing, of_length, at_least=0.0_wp)
  end subroutine reinforcement_keys

end module deck_reinforcement
