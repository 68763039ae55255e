!> What a mesh whose x is a radius allows, and its defaults.
module deck_check_geometry
  use deck_keys, only: key_table
  use deck_problems, only: problem_list
  use deck_tables, only: find_table
  use deck_types, only: deck_type
  use kinds, only: wp
  implicit none
  private
  public :: check_geometry

contains

  !> Checks a cylindrical or spherical mesh and what lies in it. The face at radius 0 becomes 'symmetry', and the axis of a cylinder
  !> that does not say otherwise that of the mesh.
  subroutine check_geometry(deck, tables, problems)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems
    integer :: i
    if (deck%mesh%radial_power() == 0) return
    call check_directions(deck, tables(find_table(tables, 'mesh', 1)), problems)
    call check_faces(deck, tables(find_table(tables, 'boundary', 1)), problems)
    if (abs(deck%flow%gravity(1)) > 0) call problems%add_at_key(tables(find_table(tables, 'flow', 1)), 'gravity', &
      'has no direction x, which is a radius of the mesh')
    do i = 1, size(deck%charge)
      call check_place(deck, i, tables(find_table(tables, 'charge', i)), problems)
    end do
  end subroutine check_geometry

  subroutine check_directions(deck, table, problems)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    associate (mesh => deck%mesh)
      if (mesh%radial_power() == 2 .and. any(mesh%cells(2:) > 1)) then
        call problems%add_at_key(table, 'cells', 'a spherical mesh has cells in x only')
      else if (mesh%cells(3) > 1) then
        call problems%add_at_key(table, 'cells', 'a cylindrical mesh has cells in x and y only: y is along the axis')
      end if
      if (mesh%lower(1) < 0) call problems%add_at_key(table, 'lower', 'x is a radius: it must be at least 0')
      if (size(deck%body) > 0) call problems%add_at_key(table, 'geometry', 'bodies need a mesh that is ''cartesian''')
    end associate
  end subroutine check_directions

  subroutine check_faces(deck, table, problems)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    character(6), parameter :: faces(2) = [character(6) :: 'x_low', 'x_high']
    integer :: side
    do side = 1, 2
      if (deck%boundary%flow_face(1, side) == 'periodic') call problems%add_at_key(table, trim(faces(side)), &
        'x is a radius, which has no period')
    end do
    if (deck%mesh%lower(1) > 0) return
    if (.not. table%is_given('x_low')) deck%boundary%x_low = 'symmetry'
    if (deck%boundary%x_low /= 'symmetry' .and. deck%boundary%x_low /= 'periodic') call problems%add_at_key(table, 'x_low', &
      'must be ''symmetry'' where the radius is 0')
  end subroutine check_faces

  ! A charge turns about the axis or centre: where it does not lie on it, it would be a ring or a shell.
  subroutine check_place(deck, i, table, problems)
    type(deck_type), intent(inout) :: deck
    integer, intent(in) :: i
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: axisymmetric
    axisymmetric = deck%mesh%radial_power() == 1 .and. deck%mesh%cells(2) > 1
    associate (charge => deck%charge(i))
      if (table%is_given('center') .and. .not. abs(charge%center(1)) <= 0) call problems%add_at_key(table, 'center', &
        'a charge lies at radius x = 0 of a mesh that is '''//trim(deck%mesh%geometry)//'''')
      if (charge%shape == 'box') then
        call problems%add_at_key(table, 'shape', 'a ''box'' needs a mesh that is ''cartesian''')
      else if (charge%shape == 'cylinder' .and. deck%mesh%radial_power() == 2) then
        call problems%add_at_key(table, 'shape', 'a ''cylinder'' has no place in a spherical mesh')
      else if (charge%shape == 'cylinder' .and. axisymmetric) then
        if (.not. table%is_given('axis')) charge%axis = [0.0_wp, 1.0_wp, 0.0_wp]
        if (any(abs(charge%axis([1, 3])) > 0)) call problems%add_at_key(table, 'axis', &
          'must be along y, the axis of the mesh')
      end if
    end associate
  end subroutine check_place

end module deck_check_geometry
