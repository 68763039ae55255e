!> Checks of programmed charges and of the detonators that light them.
module deck_check_detonation
  use kinds, only: wp
  use constants, only: unset
  use deck_check_shape, only: check_point
  use deck_keys, only: key_table
  use deck_problems, only: problem_list
  use deck_tables, only: find_table
  use deck_types, only: deck_type, detonator_group
  use text, only: str
  implicit none
  private
  public :: check_detonation

contains

  !> Checks all charges and detonators; the ambient pressure must be known.
  subroutine check_detonation(deck, tables, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i
    do i = 1, size(deck%charge)
      call check_burning(deck, i, tables(find_table(tables, 'charge', i)), problems, warnings)
    end do
    do i = 1, size(deck%detonator)
      call check_detonator(deck, deck%detonator(i), tables(find_table(tables, 'detonator', i)), problems, warnings)
    end do
  end subroutine check_detonation

  ! An explosive burns in one way: its cells know when, not of which charge they are.
  subroutine check_burning(deck, i, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: i
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    integer :: j
    associate (charge => deck%charge(i))
      if (charge%detonation /= 'programmed') then
        if (table%is_given('detonation_speed')) call warnings%add_at_key(table, 'detonation_speed', &
          'has no effect, as detonation is not ''programmed''')
        return
      end if
      do j = 1, i - 1
        if (deck%charge(j)%detonation /= 'programmed' .or. deck%charge(j)%explosive /= charge%explosive) cycle
        if (abs(deck%charge(j)%detonation_speed - charge%detonation_speed) <= 0) cycle
        call problems%add_at_key(table, 'detonation_speed', 'differs from that of the &charge on line '// &
          str(deck%charge(j)%line)//', of the same explosive: give it a &material of its own')
        exit
      end do
      if (problems%n > 0) return
      if (.not. deck%flow%ambient_pressure > 0) call problems%add_at_key(table, 'detonation', &
        'unburnt explosive needs an ambient pressure above 0')
    end associate
  end subroutine check_burning

  subroutine check_detonator(deck, detonator, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(detonator_group), intent(inout) :: detonator
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    logical :: complete
    complete = .true.
    associate (d => detonator)
      if (d%charge > size(deck%charge)) then
        call problems%add_at_key(table, 'charge', 'there is no &charge number '//str(d%charge)//' in the deck')
      else if (d%charge > 0) then
        if (deck%charge(d%charge)%detonation /= 'programmed') call warnings%add_at_key(table, 'charge', &
          'has no effect, as the detonation of this charge is not ''programmed''')
      else if (.not. any(deck%charge%detonation == 'programmed')) then
        call warnings%add_at_key(table, '', 'has no effect, as no charge has detonation = ''programmed''')
      end if
      if (table%is_given('position')) call check_point(d%position, middle(), 'position', deck%mesh, table, problems, complete)
      call check_key('end', 'line')
      call check_key('normal', 'plane')
      if (.not. complete) return
      if (d%shape == 'line') then
        call check_point(d%end, middle(), 'end', deck%mesh, table, problems, complete)
      else if (d%shape == 'plane') then
        call check_point(d%normal, [0.0_wp, 0.0_wp, 0.0_wp], 'normal', deck%mesh, table, problems, complete)
        if (complete .and. .not. any(abs(d%normal) > 0)) call problems%add_at_key(table, 'normal', 'the normal has no length')
      end if
    end associate
  contains
    ! A key that one shape needs and the others do not have.
    subroutine check_key(key, shape)
      character(*), intent(in) :: key, shape
      if (table%is_given(key) .and. detonator%shape /= shape) then
        call problems%add_at_key(table, key, 'belongs to shape '''//shape//'''')
      else if (.not. table%is_given(key) .and. detonator%shape == shape) then
        call problems%add_at_key(table, 'shape', 'a detonator of shape '''//shape//''' also needs '//key)
        complete = .false.
      end if
    end subroutine check_key
    ! In directions that are not computed a place means nothing.
    pure function middle()
      real(wp) :: middle(3)
      middle = 0
      where (deck%mesh%upper > unset) middle = 0.5_wp*deck%mesh%lower + 0.5_wp*deck%mesh%upper
    end function middle
  end subroutine check_detonator

end module deck_check_detonation
