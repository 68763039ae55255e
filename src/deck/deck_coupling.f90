!> &coupling: how flow and solid act on each other.
module deck_coupling
  use deck_keys, only: key_table, word_length
  implicit none
  private
  public :: coupling_keys

  type, public :: coupling_group
    character(word_length) :: method = 'moving_wall' !< or 'lg_cfibm', 'none'
    character(word_length) :: wall = 'slip' !< or 'no_slip'; of moving walls
    integer :: line = 0
  end type coupling_group

contains

  subroutine coupling_keys(group, table)
    type(coupling_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('coupling', group%line)
    call table%add('method', group%method, [character(word_length) :: 'moving_wall', 'lg_cfibm', 'none'])
    call table%add('wall', group%wall, [character(word_length) :: 'slip', 'no_slip'])
  end subroutine coupling_keys

end module deck_coupling
