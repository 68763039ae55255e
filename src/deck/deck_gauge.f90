!> &gauge (repeated): a point whose history is written.
module deck_gauge
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length
  implicit none
  private
  public :: gauge_keys

  type, public :: gauge_group
    character(word_length) :: name = ''
    character(word_length) :: kind = 'flow' !< 'flow': stays; 'solid': moves with the nearest particle
    real(wp) :: position(3) = unset
    integer :: line = 0
  end type gauge_group

contains

  subroutine gauge_keys(group, table)
    type(gauge_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('gauge', group%line)
    call table%add('name', group%name, required=.true.)
    call table%add('kind', group%kind, [character(word_length) :: 'flow', 'solid'])
    call table%add('position', group%position, of_length, required=.true.)
  end subroutine gauge_keys

end module deck_gauge
