!> Checks that need more than one key, and defaults that follow from other groups.
module deck_check
  use kinds, only: wp
  use constants, only: unset
  use deck_check_flow, only: check_flow
  use deck_check_geometry, only: check_geometry
  use deck_check_material, only: check_material, check_name, check_cells_of_cracks
  use deck_check_material_test, only: check_material_tests
  use deck_check_shape, only: check_point
  use deck_check_solid, only: check_solid
  use deck_check_start, only: check_starts
  use deck_keys, only: key_table, key_type, kind_real, word_length
  use deck_problems, only: problem_list, group_place
  use deck_tables, only: find_table
  use deck_types, only: deck_type, find_material
  use text, only: lowercase, str
  use units, only: decimal_exponent, unit_label, unit_system_names
  implicit none
  private
  public :: check_deck

  character, parameter :: axis_name(3) = ['x', 'y', 'z']

contains

  !> Checks the whole deck and fills in the defaults that depend on other keys. problems: mistakes; warnings: doubts.
  subroutine check_deck(deck, tables, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:) !< of the deck's groups
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i
    logical :: has_scene
    deck%has_flow = size(deck%region) + size(deck%charge) > 0
    deck%has_solid = size(deck%body) > 0
    has_scene = deck%has_flow .or. deck%has_solid .or. size(deck%material_test) == 0
    do i = 1, size(tables)
      ! tests of materials need no mesh and no end
      if (.not. has_scene .and. (tables(i)%group == 'mesh' .or. tables(i)%group == 'run')) cycle
      call check_required(tables(i), problems)
      call check_usual(tables(i), trim(deck%run%units), warnings)
    end do
    if (has_scene .and. .not. (deck%has_flow .or. deck%has_solid)) call problems%add(0, '', &
      'nothing to compute: the deck has no &region, no &charge and no &body, nor a &material_test')
    call check_mesh(deck, tables(find_table(tables, 'mesh', 1)), problems)
    call check_geometry(deck, tables, problems)
    call check_boundary(deck, tables(find_table(tables, 'boundary', 1)), problems)
    do i = 1, size(deck%material)
      call check_material(deck%material(i), trim(deck%run%units), tables(find_table(tables, 'material', i)), problems, warnings)
    end do
    if (deck%has_solid .and. all(deck%mesh%upper > deck%mesh%lower)) then
      do i = 1, size(deck%material)
        call check_cells_of_cracks(deck%material(i), minval(deck%mesh%cell_size(), deck%mesh%active()), &
          tables(find_table(tables, 'material', i)), warnings)
      end do
    end if
    call check_material_names(deck, tables, problems)
    if (deck%has_flow) call check_flow(deck, tables, problems, warnings)
    call check_solid(deck, tables, problems, warnings)
    call check_starts(deck, tables, problems, warnings)
    call check_material_tests(deck, tables, problems, warnings)
    do i = 1, size(deck%gauge)
      call check_gauge(deck, i, tables(find_table(tables, 'gauge', i)), problems)
    end do
    call warn_of_idle_materials(deck, tables, warnings)
    call check_snapshot_times(deck%output%snapshot_times, tables(find_table(tables, 'output', 1)), problems)
    if (deck%output%directory == '') deck%output%directory = 'runs/'//deck%name
  end subroutine check_deck

  subroutine check_required(table, problems)
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer :: k
    do k = 1, table%n
      if (.not. table%key(k)%required .or. any(table%key(k)%given)) cycle
      if (table%line == 0 .and. .not. any(table%key(1:table%n)%from_option)) then
        call problems%add(0, group_place(table, ''), 'the group is missing; it must give '//trim(table%key(k)%name))
      else
        call problems%add_at_key(table, '', trim(table%key(k)%name)//' is missing')
      end if
    end do
  end subroutine check_required

  ! Numbers that are far from what they measure: mostly they stand in another unit system than the deck says.
  subroutine check_usual(table, system, warnings)
    type(key_table), intent(in) :: table
    character(*), intent(in) :: system
    type(problem_list), intent(inout) :: warnings
    integer :: k, i
    if (system == 'none') return
    do k = 1, table%n
      if (table%key(k)%kind /= kind_real) cycle
      do i = 1, table%key(k)%n
        if (.not. table%key(k)%given(i) .or. .not. table%key(k)%real_element(i) > unset) cycle
        if (usual_in(table%key(k), table%key(k)%real_element(i), system)) cycle
        call warnings%add_at_key(table, trim(table%key(k)%name), &
          doubt(table%key(k), table%key(k)%real_element(i), system))
        exit
      end do
    end do
  end subroutine check_usual

  ! Zero passes: where it must not be, the range says so.
  pure logical function usual_in(key, value, system)
    type(key_type), intent(in) :: key
    real(wp), intent(in) :: value
    character(*), intent(in) :: system
    real(wp) :: si
    si = in_si(key, value, system)
    usual_in = (si >= key%usual(1) .and. si <= key%usual(2)) .or. abs(value) <= 0.0_wp
  end function usual_in

  pure real(wp) function in_si(key, value, system) result(si)
    type(key_type), intent(in) :: key
    real(wp), intent(in) :: value
    character(*), intent(in) :: system
    integer :: n
    n = decimal_exponent(key%dimension, system)
    si = huge(1.0_wp)
    if (abs(value) < 1e200_wp) si = value*10.0_wp**(-n)
  end function in_si

  ! What the number would be in SI, and in which system it would be usual.
  pure function doubt(key, value, system) result(reason)
    type(key_type), intent(in) :: key
    real(wp), intent(in) :: value
    character(*), intent(in) :: system
    character(:), allocatable :: reason
    real(wp) :: si
    integer :: i
    reason = brief(value)//' '//trim(unit_label(key%dimension, system))
    if (system /= 'SI' .and. any(key%dimension(1:3) /= 0)) reason = reason//' is '//brief(in_si(key, value, system))// &
      ' '//trim(unit_label(key%dimension, 'SI'))//','
    reason = reason//' outside of what is usual ('//brief(key%usual(1))//' to '//brief(key%usual(2))//' '// &
      trim(unit_label(key%dimension, 'SI'))//')'
    do i = 1, size(unit_system_names)
      if (unit_system_names(i) == system .or. unit_system_names(i) == 'none') cycle
      if (.not. usual_in(key, value, trim(unit_system_names(i)))) cycle
      si = in_si(key, value, trim(unit_system_names(i)))
      reason = reason//'; '//brief(value)//' '//trim(unit_label(key%dimension, trim(unit_system_names(i))))// &
        ' would be '//brief(si*10.0_wp**decimal_exponent(key%dimension, system))//' in '//system
      return
    end do
  end function doubt

  pure function brief(value)
    real(wp), intent(in) :: value
    character(:), allocatable :: brief
    character(24) :: buffer
    write (buffer, '(es12.3)') value
    if (abs(value) >= 1e-3_wp .and. abs(value) < 1e6_wp) write (buffer, '(f20.6)') value
    brief = trim(adjustl(buffer))
    if (index(brief, 'E') > 0) return
    do while (brief(len(brief):) == '0')
      brief = brief(1:len(brief) - 1)
    end do
    if (brief(len(brief):) == '.') brief = brief(1:len(brief) - 1)
  end function brief

  subroutine check_mesh(deck, table, problems)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: complete
    integer :: d
    associate (mesh => deck%mesh)
      if (table%is_bad('cells')) return
      if (table%is_given('cells') .and. .not. mesh%cells(1) > 1) call problems%add_at_key(table, 'cells', &
        'x must have more than one cell')
      if (mesh%cells(3) > 1 .and. mesh%cells(2) == 1) call problems%add_at_key(table, 'cells', &
        'y must have more than one cell where z has')
      ! a dimension of one cell has size 1: all figures are per unit of length there
      where (.not. mesh%active())
        mesh%lower = 0
        mesh%upper = 1
      end where
      complete = table%is_given('upper')
      if (complete) call check_point(mesh%upper, mesh%upper, 'upper', mesh, table, problems, complete)
      do d = 1, 3
        if (mesh%brick(d) > 0) then
          if (mod(mesh%cells(d), mesh%brick(d)) /= 0) then
            call problems%add_at_key(table, 'brick', str(mesh%brick(d))//' does not divide the '//str(mesh%cells(d))// &
              ' cells in '//axis_name(d))
          else if (mesh%brick(d) < 2 .and. mesh%cells(d) > 1) then
            call problems%add_at_key(table, 'brick', 'a brick has at least 2 cells in '//axis_name(d))
          end if
        end if
        if (complete .and. mesh%upper(d) <= mesh%lower(d)) call problems%add_at_key(table, 'upper', &
          'upper is not above lower in '//axis_name(d))
      end do
    end associate
  end subroutine check_mesh

  ! Periodic faces come in pairs. Faces of a dimension of one cell are symmetry planes, whatever the deck says.
  subroutine check_boundary(deck, table, problems)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    associate (b => deck%boundary)
      call check_pair('x', b%x_low, b%x_high, b%solid_x_low, b%solid_x_high, deck%mesh%cells(1) > 1)
      call check_pair('y', b%y_low, b%y_high, b%solid_y_low, b%solid_y_high, deck%mesh%cells(2) > 1)
      call check_pair('z', b%z_low, b%z_high, b%solid_z_low, b%solid_z_high, deck%mesh%cells(3) > 1)
    end associate
  contains
    subroutine check_pair(axis, low, high, solid_low, solid_high, computed)
      character, intent(in) :: axis
      character(*), intent(inout) :: low, high, solid_low, solid_high
      logical, intent(in) :: computed
      if (.not. computed) then
        low = 'symmetry'
        high = 'symmetry'
        solid_low = 'symmetry'
        solid_high = 'symmetry'
      else if (table%is_bad(axis//'_low') .or. table%is_bad(axis//'_high')) then
        return
      else if (low == 'periodic' .and. high /= 'periodic') then
        call problems%add_at_key(table, axis//'_low', axis//'_high must be ''periodic'' too')
      else if (high == 'periodic' .and. low /= 'periodic') then
        call problems%add_at_key(table, axis//'_high', axis//'_low must be ''periodic'' too')
      end if
      if (solid_low == '') solid_low = solid_default(low)
      if (solid_high == '') solid_high = solid_default(high)
    end subroutine check_pair
  end subroutine check_boundary

  pure function solid_default(flow_face) result(kind)
    character(*), intent(in) :: flow_face
    character(word_length) :: kind
    kind = 'free'
    if (flow_face == 'symmetry') kind = 'symmetry'
  end function solid_default

  subroutine check_snapshot_times(times, table, problems)
    real(wp), intent(in) :: times(:)
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer :: n
    n = count(times > unset)
    if (any(times(1:n) <= unset)) then
      call problems%add_at_key(table, 'snapshot_times', 'a time is left out in between')
    else if (any(times(2:n) <= times(1:n - 1))) then
      call problems%add_at_key(table, 'snapshot_times', 'the times must rise')
    end if
  end subroutine check_snapshot_times

  subroutine check_material_names(deck, tables, problems)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems
    integer :: i, first
    do i = 1, size(deck%material)
      first = find_material(deck, deck%material(i)%name)
      if (first == i .or. deck%material(i)%name == '') cycle
      call problems%add_at_key(tables(find_table(tables, 'material', i)), 'name', 'there is a material '''// &
        trim(deck%material(i)%name)//''' on line '//str(deck%material(first)%line)//' already')
    end do
  end subroutine check_material_names

  subroutine check_gauge(deck, i, table, problems)
    type(deck_type), intent(inout) :: deck
    integer, intent(in) :: i
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: complete
    integer :: j
    associate (gauge => deck%gauge(i))
      call check_name(gauge%name, table, problems)
      do j = 1, i - 1
        if (gauge%name == '' .or. lowercase(deck%gauge(j)%name) /= lowercase(gauge%name)) cycle
        call problems%add_at_key(table, 'name', 'there is a gauge '''//trim(gauge%name)//''' on line '// &
          str(deck%gauge(j)%line)//' already')
        exit
      end do
      if (gauge%kind == 'flow' .and. .not. deck%has_flow) call problems%add_at_key(table, 'kind', &
        'a gauge of kind ''flow'' needs a flow, and the deck has no &region')
      if (gauge%kind == 'solid' .and. .not. deck%has_solid) call problems%add_at_key(table, 'kind', &
        'a gauge of kind ''solid'' needs a solid, and the deck has no &body')
      if (.not. table%is_given('position')) return
      complete = .true.
      call check_point(gauge%position, [0.5_wp, 0.5_wp, 0.5_wp], 'position', deck%mesh, table, problems, complete)
      if (.not. complete .or. .not. all(deck%mesh%upper > unset)) return
      if (any(gauge%position < deck%mesh%lower .or. gauge%position > deck%mesh%upper)) &
        call problems%add_at_key(table, 'position', 'lies outside of the domain')
    end associate
  end subroutine check_gauge

  subroutine warn_of_idle_materials(deck, tables, warnings)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: warnings
    integer :: i
    do i = 1, size(deck%material)
      associate (name => deck%material(i)%name)
        if (name == '') cycle
        if (any(deck%region%material == name) .or. any(deck%charge%explosive == name) .or. any(deck%body%material == name) &
            .or. any(deck%reinforcement%material == name) .or. deck%boundary%inflow_material == name &
            .or. any(deck%material_test%material == name)) cycle
        call warnings%add_at_key(tables(find_table(tables, 'material', i)), 'name', 'material '''//trim(name)// &
          ''' is not used')
      end associate
    end do
  end subroutine warn_of_idle_materials

end module deck_check
