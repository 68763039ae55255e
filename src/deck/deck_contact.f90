!> &contact (repeated): bodies that may slide along each other and part.
module deck_contact
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  implicit none
  private
  public :: contact_keys

  type, public :: contact_group
    character(word_length) :: body_1 = 'all', body_2 = 'all' !< names of bodies; 'all': every one
    real(wp) :: friction = unset !< coefficient of Coulomb's law
    integer :: line = 0
  end type contact_group

contains

  subroutine contact_keys(group, table)
    type(contact_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('contact', group%line)
    call table%add('body_1', group%body_1)
    call table%add('body_2', group%body_2)
    call table%add('friction', group%friction, at_least=0.0_wp, required=.true.)
  end subroutine contact_keys

end module deck_contact
