!> Checks of charges whose blast is computed on a fine mesh of its own before it enters the scene.
module deck_check_start
  use charge_reach, only: ambient_region, charge_radius, dimensions_of_blast, reach_of_charge
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

  real(wp), parameter :: least_reach = 1.5_wp !< charge radii: by then the whole charge has burnt

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
    character(11), parameter :: keys(3) = [character(11) :: 'start_cells', 'start_stop', 'start_file']
    character(:), allocatable :: right
    integer :: i
    associate (charge => deck%charge(c))
      if (.not. charge%is_mapped()) then
        do i = 1, size(keys)
          if (i == 1 .and. charge%start_cells == 0) cycle
          if (i == 3 .and. charge%start_file == '') cycle
          if (table%is_given(trim(keys(i)))) call warnings%add_at_key(table, trim(keys(i)), 'has no effect without start')
        end do
        return
      end if
      if (charge%start_cells > 0 .and. charge%start_cells < 10) call problems%add_at_key(table, 'start_cells', &
        'a charge needs 10 cells in its radius at least')
      if (charge%shape /= 'sphere') call problems%add_at_key(table, 'shape', 'only a ''sphere'' can have a start that is '''// &
        trim(charge%start)//'''')
      right = 'spherical'
      if (dimensions_of_blast(deck) == 2) right = 'cylindrical'
      if (dimensions_of_blast(deck) == 1) then
        call problems%add_at_key(table, 'start', 'a slab of explosive has none: the mesh needs two directions or a radius')
      else if (charge%start /= right) then
        call problems%add_at_key(table, 'start', 'on this mesh the blast is '''//right//'''')
      end if
    end associate
  end subroutine check_keys

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
    radius = charge_radius(deck, c)
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
        associate (d => deck%detonator(i))
          if (d%charge /= 0 .and. d%charge /= c) cycle
          if (d%shape /= 'point' .or. norm2(merge(d%position - charge%center, 0.0_wp, deck%mesh%active())) > 1e-6_wp*radius) &
            call problems%add_at_key(table, 'start', 'must be lit at a point, its centre; the &detonator on line '// &
              str(d%line)//' is another one')
        end associate
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
