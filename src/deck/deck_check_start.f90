!> Checks of charges whose blast is computed on a fine mesh of its own before it enters the scene.
module deck_check_start
  use charge_reach, only: ambient_region, charge_extents, charge_radius, dimensions_of_blast, is_lit_around_axis, &
    is_lit_at_center, least_reach, reach_of_charge, start_axis
  use constants, only: unset
  use deck_keys, only: key_table
  use deck_problems, only: problem_list
  use deck_tables, only: find_table
  use deck_types, only: deck_type
  use kinds, only: wp
  use text, only: str
  implicit none
  private
  public :: check_starts

  character, parameter :: axis_name(3) = ['x', 'y', 'z']

contains

  !> Checks all charges; shapes and materials must have passed their own checks, or nothing is said.
  subroutine check_starts(deck, tables, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    integer :: c
    do c = 1, size(deck%charge)
      call check_keys(deck, c, tables(find_table(tables, 'charge', c)), problems, warnings)
    end do
    if (problems%n > 0 .or. size(deck%charge) == 0) return
    if (.not. any(deck%charge%is_mapped())) return
    call check_surroundings(deck, tables, problems, warnings)
    do c = 1, size(deck%charge)
      associate (table => tables(find_table(tables, 'charge', c)))
        if (deck%charge(c)%is_mapped()) then
          call check_start(deck, c, table, problems)
        else
          call check_other(deck, c, table, problems)
        end if
      end associate
    end do
  end subroutine check_starts

  subroutine check_keys(deck, c, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    character(11), parameter :: keys(4) = [character(11) :: 'start_cells', 'start_stop', 'start_file', 'start_axis']
    character(:), allocatable :: right
    integer :: i
    associate (charge => deck%charge(c))
      do i = 1, size(keys)
        if (i == 1 .and. charge%start_cells == 0) cycle
        if (i == 3 .and. charge%start_file == '') cycle
        if (i == 4 .and. charge%start_axis == '') cycle
        if (table%is_given(trim(keys(i))) .and. .not. charge%is_mapped()) call warnings%add_at_key(table, trim(keys(i)), &
          'has no effect without start')
      end do
      if (.not. charge%is_mapped()) return
      if (charge%start_cells > 0 .and. charge%start_cells < 10) call problems%add_at_key(table, 'start_cells', &
        'a charge needs 10 cells in its radius at least')
      right = 'spherical'
      if (dimensions_of_blast(deck) == 2) right = 'cylindrical'
      if (charge%start == 'axisymmetric') then
        call check_axis(deck, c, table, problems)
        return
      end if
      if (charge%shape /= 'sphere') call problems%add_at_key(table, 'shape', 'only a ''sphere'' can have a start that is '''// &
        trim(charge%start)//'''')
      if (charge%start_axis /= '') call warnings%add_at_key(table, 'start_axis', 'has no effect unless start is ''axisymmetric''')
      if (dimensions_of_blast(deck) == 1) then
        call problems%add_at_key(table, 'start', 'a slab of explosive has none: the mesh needs two directions or a radius')
      else if (charge%start /= right) then
        call problems%add_at_key(table, 'start', 'on this mesh the blast is '''//right//'''')
      end if
    end associate
  end subroutine check_keys

  ! The blast of what turns about an axis of the mesh.
  subroutine check_axis(deck, c, table, problems)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer :: axis
    axis = start_axis(deck, c)
    associate (charge => deck%charge(c), mesh => deck%mesh)
      if (dimensions_of_blast(deck) /= 3 .or. mesh%cells(2) == 1) then
        call problems%add_at_key(table, 'start', 'an ''axisymmetric'' one needs a mesh of three directions, or an axisymmetric one')
      else if (mesh%radial_power() == 1 .and. axis /= 2) then
        call problems%add_at_key(table, 'start_axis', 'must be ''y'', the axis of the mesh')
      end if
      if (charge%shape == 'box') then
        call problems%add_at_key(table, 'shape', 'a ''box'' can have no start that is ''axisymmetric''')
      else if (charge%shape == 'cylinder' .and. norm2(charge%axis) - abs(charge%axis(axis)) > 1e-12_wp*norm2(charge%axis)) then
        call problems%add_at_key(table, 'axis', 'must be along '//axis_name(axis)//', the axis of the start')
      end if
    end associate
  end subroutine check_axis

  ! What holds for the whole scene: all is still until the blasts enter it.
  subroutine check_surroundings(deck, tables, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    integer :: d, side, i
    do d = 1, 3
      do side = 1, 2
        if (deck%boundary%flow_face(d, side) == 'inflow' .and. deck%mesh%cells(d) > 1) call problems%add_at_key( &
          tables(find_table(tables, 'boundary', 1)), '', 'a charge with a start of its own needs still surroundings: no ''inflow''')
      end do
    end do
    do i = 1, size(deck%region)
      if (any(abs(deck%region(i)%velocity) > 0)) call problems%add_at_key(tables(find_table(tables, 'region', i)), 'velocity', &
        'a charge with a start of its own needs still surroundings')
    end do
    if (any(abs(deck%flow%gravity) > 0)) call warnings%add_at_key(tables(find_table(tables, 'flow', 1)), 'gravity', &
      'acts from the time on at which the blast enters the scene')
    do i = 1, size(deck%body)
      associate (body => deck%body(i))
        if (any(abs([body%velocity, body%velocity_gradient, body%angular_velocity]) > 0)) call warnings%add_at_key( &
          tables(find_table(tables, 'body', i)), '', 'moves from the time on at which the blast enters the scene')
      end associate
    end do
  end subroutine check_surroundings

  subroutine check_start(deck, c, table, problems)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    character(:), allocatable :: obstacle
    real(wp) :: reach, radius
    integer :: i
    if (ambient_region(deck, c) == 0) return
    radius = norm2(charge_extents(deck, c))
    if (deck%charge(c)%shape == 'sphere') radius = charge_radius(deck, c)
    call reach_of_charge(deck, c, reach, obstacle)
    associate (charge => deck%charge(c))
      if (reach < least_reach*radius) then
        call problems%add_at_key(table, 'start', 'there is no room for it: 2 cells before '//obstacle// &
          ' the blast has a radius of '//str(reach, 4)//', and the charge one of '//str(radius, 4)//'; at least '// &
          str(least_reach)//' times as much is needed')
      else if (charge%start_stop > unset .and. charge%start_stop > reach) then
        call problems%add_at_key(table, 'start_stop', 'the blast would meet '//obstacle//': at most '//str(reach, 5))
      else if (charge%start_stop > unset .and. charge%start_stop < least_reach*radius) then
        call problems%add_at_key(table, 'start_stop', 'must be at least '//str(least_reach)//' times the radius of the charge, '// &
          str(least_reach*radius, 5))
      end if
      if (charge%detonation /= 'programmed') return
      do i = 1, size(deck%detonator)
        if (all(deck%detonator(i)%charge /= [0, c])) cycle
        if (start_axis(deck, c) > 0) then
          if (.not. is_lit_around_axis(deck, c, i)) call problems%add_at_key(table, 'start', &
            'must be lit on its axis; the &detonator on line '//str(deck%detonator(i)%line)//' lies beside it')
        else if (.not. is_lit_at_center(deck, c, i)) then
          call problems%add_at_key(table, 'start', 'must be lit at a point, its centre; the &detonator on line '// &
            str(deck%detonator(i)%line)//' is another one')
        end if
      end do
    end associate
  end subroutine check_start

  ! A charge that is filled in as it was at the start must not have been lit when the others enter.
  subroutine check_other(deck, c, table, problems)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: later
    integer :: i
    later = .false.
    if (deck%charge(c)%detonation == 'programmed') then
      do i = 1, size(deck%detonator)
        if (deck%detonator(i)%charge /= 0 .and. deck%detonator(i)%charge /= c) cycle
        later = deck%detonator(i)%time > 0
        if (.not. later) exit
      end do
    end if
    if (.not. later) call problems%add_at_key(table, 'start', 'another charge enters the scene some time after the detonation: '// &
      'this one needs a start too, or a &detonator that lights it later')
  end subroutine check_other

end module deck_check_start
