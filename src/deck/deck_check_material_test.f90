!> Checks of the material tests.
module deck_check_material_test
  use constants, only: unset
  use deck_check_material, only: check_name
  use deck_keys, only: key_table
  use deck_problems, only: problem_list, nearest_or_allowed
  use deck_tables, only: find_table
  use deck_types, only: deck_type, find_material
  use kinds, only: wp
  use text, only: lowercase, str
  use units, only: from_si
  implicit none
  private
  public :: check_material_tests

contains

  !> Checks every segment; material and length of later ones default to those of the first of their name.
  subroutine check_material_tests(deck, tables, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i
    do i = 1, size(deck%material_test)
      call check_segment(deck, i, tables(find_table(tables, 'material_test', i)), problems, warnings)
    end do
  end subroutine check_material_tests

  subroutine check_segment(deck, i, table, problems, warnings)
    type(deck_type), intent(inout) :: deck
    integer, intent(in) :: i
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    integer :: first, m
    associate (test => deck%material_test(i))
      call check_name(test%name, table, problems)
      first = 1
      do while (lowercase(deck%material_test(first)%name) /= lowercase(test%name))
        first = first + 1
      end do
      if (first < i) then
        if (test%material == '') test%material = deck%material_test(first)%material
        if (.not. table%is_given('length')) test%length = deck%material_test(first)%length
        if (lowercase(test%material) /= lowercase(deck%material_test(first)%material)) call problems%add_at_key(table, 'material', &
          'the first segment of '''//trim(test%name)//''', on line '//str(deck%material_test(first)%line)// &
          ', has another one: '//trim(deck%material_test(first)%material))
      else if (test%material == '' .and. .not. table%is_given('material')) then
        call problems%add_at_key(table, '', 'material is missing')
      end if
      if (.not. test%length > unset) test%length = from_si(0.01_wp, 0, 1, 0, trim(deck%run%units))
      m = find_material(deck, test%material)
      if (test%material /= '' .and. m == 0) then
        call problems%add_at_key(table, 'material', 'there is no material '''//trim(test%material)//''''// &
          nearest_or_allowed(trim(test%material), deck%material%name, 'materials'))
      else if (m > 0) then
        if (deck%material(m)%model == '') call problems%add_at_key(table, 'material', 'material '''//trim(test%material)// &
          ''' has no model')
        if (deck%material(m)%model == 'rigid') call problems%add_at_key(table, 'material', 'a rigid material has no stress')
        if (deck%material(m)%model == 'fluid' .and. (test%path == 'uniaxial_stress' .or. test%path == 'triaxial')) &
          call problems%add_at_key(table, 'path', 'a fluid has no lateral stress of its own')
      end if
      if (abs(test%strain) <= 0) call problems%add_at_key(table, 'strain', 'the segment has no length')
      if (test%path == 'gradient' .and. maxval(abs(test%gradient)) <= 0) call problems%add_at_key(table, 'path', &
        'path = ''gradient'' also needs gradient')
      if (test%path /= 'gradient' .and. table%is_given('gradient')) call warnings%add_at_key(table, 'gradient', &
        'has no effect with path = '''//trim(test%path)//'''')
      if (test%path /= 'hydrostatic' .and. table%is_given('pressure')) call warnings%add_at_key(table, 'pressure', &
        'has no effect with path = '''//trim(test%path)//''': triaxial holds what the segment before has reached')
      if (test%path == 'hydrostatic' .and. table%is_given('pressure') .and. test%pressure*test%strain > 0) &
        call problems%add_at_key(table, 'pressure', 'is not reached with a strain of this sign (extension is positive)')
    end associate
  end subroutine check_segment

end module deck_check_material_test
