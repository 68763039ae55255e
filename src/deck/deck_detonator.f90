!> &detonator (repeated): where and when a programmed charge is lit.
module deck_detonator
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length, of_time
  implicit none
  private
  public :: detonator_keys

  type, public :: detonator_group
    integer :: charge = 0 !< number of the &charge in the deck, 0: every programmed one
    character(word_length) :: shape = 'point' !< 'point', 'line', 'plane': lit all at once
    real(wp) :: position(3) = unset !< the point, the start of the line, a point of the plane
    real(wp) :: end(3) = unset !< of the line
    real(wp) :: normal(3) = unset !< of the plane, to either side
    real(wp) :: time = 0
    integer :: line = 0
  end type detonator_group

contains

  subroutine detonator_keys(group, table)
    type(detonator_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('detonator', group%line)
    call table%add('charge', group%charge, at_least=0)
    call table%add('shape', group%shape, [character(word_length) :: 'point', 'line', 'plane'])
    call table%add('position', group%position, of_length, required=.true.)
    call table%add('end', group%end, of_length)
    call table%add('normal', group%normal)
    call table%add('time', group%time, of_time, at_least=0.0_wp)
  end subroutine detonator_keys

end module deck_detonator
