!> &clamp (repeated): nodes in a box whose velocity is held at zero in some directions.
module deck_clamp
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length
  implicit none
  private
  public :: clamp_keys

  type, public :: clamp_group
    real(wp) :: lower(3) = unset, upper(3) = unset
    character(word_length) :: fixed = 'xyz' !< directions that are held
    character(word_length) :: body = '' !< '': every body
    integer :: line = 0
  end type clamp_group

contains

  subroutine clamp_keys(group, table)
    type(clamp_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('clamp', group%line)
    call table%add('lower', group%lower, of_length, required=.true.)
    call table%add('upper', group%upper, of_length, required=.true.)
    call table%add('fixed', group%fixed, [character(word_length) :: 'x', 'y', 'z', 'xy', 'xz', 'yz', 'xyz'])
    call table%add('body', group%body)
  end subroutine clamp_keys

end module deck_clamp
