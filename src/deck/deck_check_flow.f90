!> Checks of what the flow starts from: regions, charges, the inflow state.
module deck_check_flow
  use kinds, only: wp
  use constants, only: unset
  use deck_assign, only: exact_text
  use deck_check_detonation, only: check_detonation
  use deck_check_shape, only: check_point, check_shape, inside_shape, shape_type
  use deck_keys, only: key_table
  use deck_problems, only: problem_list, nearest_or_allowed
  use deck_tables, only: find_table
  use deck_types, only: deck_type, find_material, charge_group, region_group
  use text, only: str
  use units, only: to_si
  implicit none
  private
  public :: check_flow, refer_to_material

  integer, parameter :: most_flow_materials = 8

contains

  !> Checks all that has to do with the flow, and fills in densities of regions and the ambient pressure.
  subroutine check_flow(deck, tables, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    type(shape_type), allocatable :: shapes(:)
    integer :: i
    allocate (shapes(size(deck%region)))
    do i = 1, size(deck%region)
      call check_region(deck, deck%region(i), shapes(i), tables(find_table(tables, 'region', i)), problems, warnings)
    end do
    do i = 1, size(deck%charge)
      call check_charge(deck, deck%charge(i), tables(find_table(tables, 'charge', i)), problems)
    end do
    call check_inflow(deck, tables(find_table(tables, 'boundary', 1)), problems, warnings)
    if (problems%n == 0) call check_cover(deck, shapes, tables, problems)
    call count_materials(deck, problems)
    if (.not. deck%flow%ambient_pressure > unset) then
      if (size(deck%region) > 0) deck%flow%ambient_pressure = deck%region(1)%pressure
      do i = 1, size(deck%region)
        if (deck%region(i)%shape == 'all') deck%flow%ambient_pressure = deck%region(i)%pressure
      end do
    end if
    call check_detonation(deck, tables, problems, warnings)
  end subroutine check_flow

  !> Looks a material up by the name under a key. The name takes the spelling of the material; i is 0 if there is none.
  subroutine refer_to_material(deck, name, key, table, problems, i)
    type(deck_type), intent(in) :: deck
    character(*), intent(inout) :: name
    character(*), intent(in) :: key
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer, intent(out) :: i
    i = 0
    if (name == '') then
      if (table%is_given(key) .and. .not. table%incomplete) call problems%add_at_key(table, key, 'the name is empty')
      return
    end if
    i = find_material(deck, name)
    if (i > 0) then
      name = deck%material(i)%name
    else
      call problems%add_at_key(table, key, 'no &material has the name '''//trim(name)//''''// &
        nearest_or_allowed(name, deck%material%name, 'materials'))
    end if
  end subroutine refer_to_material

  ! The same for a material that must flow.
  subroutine refer_to_fluid(deck, name, key, table, problems, i)
    type(deck_type), intent(in) :: deck
    character(*), intent(inout) :: name
    character(*), intent(in) :: key
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer, intent(out) :: i
    call refer_to_material(deck, name, key, table, problems, i)
    if (i == 0) return
    if (deck%material(i)%eos /= '' .or. deck%material(i)%model == '') return ! without both it was reported
    call problems%add_at_key(table, key, 'material '''//trim(name)//''' has no eos: it cannot flow')
    i = 0
  end subroutine refer_to_fluid

  subroutine check_region(deck, region, shape, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(region_group), intent(inout) :: region
    type(shape_type), intent(out) :: shape
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i
    shape = shape_type(region%shape, region%lower, region%upper, region%center, region%radius, region%start, region%end, &
      region%point, region%normal)
    call check_shape(shape, deck%mesh, table, problems, warnings)
    region%lower = shape%lower
    region%upper = shape%upper
    region%center = shape%center
    region%start = shape%start
    region%end = shape%end
    region%point = shape%point
    region%normal = shape%normal
    call refer_to_fluid(deck, region%material, 'material', table, problems, i)
    if (i == 0) return
    if (.not. table%is_given('density')) then
      region%density = deck%material(i)%density
      if (.not. region%density > unset) then
        call problems%add_at_key(table, 'density', 'must be given, as material '''//trim(region%material)//''' has none')
        return
      end if
    end if
    call check_state(deck, i, region%density, region%pressure, 'pressure', table, problems, warnings)
  end subroutine check_region

  ! Pressure and density of a fluid are possible, and together make sense.
  subroutine check_state(deck, i, density, pressure, key, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: i !< the material
    real(wp), intent(in) :: density, pressure
    character(*), intent(in) :: key !< of the pressure
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    real(wp) :: stiffness, speed
    if (.not. (pressure > unset .and. density > unset)) return
    associate (material => deck%material(i))
      stiffness = 0
      if (material%eos == 'stiffened_gas') stiffness = max(material%p_infinity, 0.0_wp)
      if (pressure <= -stiffness) then
        call problems%add_at_key(table, key, 'must be more than '//exact_text(0.0_wp - stiffness)//' in material '''// &
          trim(material%name)//'''')
        return
      end if
      if (deck%run%units == 'none' .or. material%eos == 'jwl' .or. .not. material%gamma > unset) return
      speed = sqrt(material%gamma*(to_si(pressure, 1, -1, -2, deck%run%units) + to_si(stiffness, 1, -1, -2, deck%run%units)) &
        /to_si(density, 1, -3, 0, deck%run%units))
      if (speed < 1.0_wp .or. speed > 5e4_wp) call warnings%add_at_key(table, key, 'with this density gives sound a speed of '// &
        str(speed, 3)//' m/s: are both in the units '//trim(deck%run%units)//'?')
    end associate
  end subroutine check_state

  subroutine check_charge(deck, charge, table, problems)
    type(deck_type), intent(in) :: deck
    type(charge_group), intent(inout) :: charge
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: complete
    integer :: i
    call refer_to_material(deck, charge%explosive, 'explosive', table, problems, i)
    if (i > 0) then
      if (deck%material(i)%eos /= 'jwl') call problems%add_at_key(table, 'explosive', 'material '''// &
        trim(charge%explosive)//''' is no explosive: its eos is not ''jwl''')
    end if
    complete = .true.
    if (table%is_given('center')) call check_point(charge%center, 0.5_wp*deck%mesh%lower + 0.5_wp*deck%mesh%upper, 'center', &
      deck%mesh, table, problems, complete)
    if (charge%shape == 'cylinder') then
      if (.not. any(abs(charge%axis) > 0.0_wp)) call problems%add_at_key(table, 'axis', 'the axis has no length')
    else
      call refuse(table, [character(18) :: 'axis', 'length_to_diameter'], 'belongs to shape ''cylinder''', problems)
    end if
    if (charge%shape /= 'box') call refuse(table, [character(18) :: 'proportions'], 'belongs to shape ''box''', problems)
    if (.not. complete) return
    if (any(deck%mesh%active() .and. deck%mesh%upper > unset .and. charge%center > unset .and. &
            (charge%center < deck%mesh%lower .or. charge%center > deck%mesh%upper))) &
      call problems%add_at_key(table, 'center', 'lies outside of the domain')
  end subroutine check_charge

  ! Keys of another shape than the one asked for; at their default they say nothing.
  subroutine refuse(table, keys, reason, problems)
    type(key_table), intent(in) :: table
    character(*), intent(in) :: keys(:)
    character(*), intent(in) :: reason
    type(problem_list), intent(inout) :: problems
    real(wp) :: element(3)
    integer :: i, k, j
    do i = 1, size(keys)
      if (.not. table%is_given(trim(keys(i)))) cycle
      k = table%find(trim(keys(i)))
      element = 1
      do j = 1, table%key(k)%n
        element(j) = table%key(k)%real_element(j)
      end do
      if (keys(i) == 'axis' .and. all(abs(element - [0.0_wp, 0.0_wp, 1.0_wp]) <= 0.0_wp)) cycle
      if (keys(i) /= 'axis' .and. all(abs(element - 1.0_wp) <= 0.0_wp)) cycle
      call problems%add_at_key(table, trim(keys(i)), reason)
    end do
  end subroutine refuse

  subroutine check_inflow(deck, table, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    character(16), parameter :: keys(4) = [character(16) :: 'inflow_material', 'inflow_density', 'inflow_pressure', &
      'inflow_velocity']
    logical :: wanted
    integer :: i, d, k
    wanted = .false.
    do d = 1, 3
      do i = 1, 2
        wanted = wanted .or. (deck%boundary%flow_face(d, i) == 'inflow' .and. deck%mesh%cells(d) > 1)
      end do
    end do
    if (.not. wanted) then
      do i = 1, 4
        k = table%find(trim(keys(i)))
        if (table%is_given(trim(keys(i))) .and. (i > 1 .or. deck%boundary%inflow_material /= '')) &
          call warnings%add_at_key(table, trim(keys(i)), 'has no effect, as no face is ''inflow''')
      end do
      return
    end if
    do i = 1, 4
      if (.not. table%is_given(trim(keys(i)))) call problems%add_at_key(table, trim(keys(i)), &
        trim(keys(i))//' is missing: a face is ''inflow''')
    end do
    if (size(deck%region) + size(deck%charge) == 0) return
    where (.not. deck%mesh%active() .and. .not. deck%boundary%inflow_velocity > unset) deck%boundary%inflow_velocity = 0
    if (any(.not. deck%boundary%inflow_velocity > unset)) then
      k = table%find('inflow_velocity')
      if (table%is_given('inflow_velocity') .and. .not. all(table%key(k)%given .or. .not. deck%mesh%active())) &
        call problems%add_at_key(table, 'inflow_velocity', 'a number for each computed direction is expected')
    end if
    call refer_to_fluid(deck, deck%boundary%inflow_material, 'inflow_material', table, problems, i)
    if (i > 0) call check_state(deck, i, deck%boundary%inflow_density, deck%boundary%inflow_pressure, 'inflow_pressure', &
      table, problems, warnings)
  end subroutine check_inflow

  ! Every cell must start from some region. Looked at in up to 48 cells a direction, the outermost included.
  subroutine check_cover(deck, shapes, tables, problems)
    type(deck_type), intent(in) :: deck
    type(shape_type), intent(in) :: shapes(:)
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems
    integer, parameter :: most = 48
    real(wp) :: h(3), point(3)
    integer :: n(3), i, j, k, s, line
    if (any(shapes%kind == 'all')) return
    line = 0
    if (size(shapes) > 0) line = tables(find_table(tables, 'region', 1))%line
    if (size(shapes) == 0) then
      call problems%add(tables(find_table(tables, 'charge', 1))%line, '&charge', &
        'a charge needs a &region around it: begin with shape = ''all''')
      return
    end if
    h = deck%mesh%cell_size()
    n = min(deck%mesh%cells, most)
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          point = deck%mesh%lower + h*(spread_index([i, j, k], n, deck%mesh%cells) + 0.5_wp)
          do s = 1, size(shapes)
            if (inside_shape(shapes(s), point)) exit
          end do
          if (s <= size(shapes)) cycle
          call problems%add(line, '&region', 'no region holds the point ('//str(point(1), 4)//', '//str(point(2), 4)//', '// &
            str(point(3), 4)//'): begin with a region of shape = ''all''')
          return
        end do
      end do
    end do
  end subroutine check_cover

  ! Cell (from 0) number i of n that are spread over all of them.
  elemental integer function spread_index(i, n, cells)
    integer, intent(in) :: i, n, cells
    spread_index = 0
    if (n > 1) spread_index = int(real(i - 1, wp)/(n - 1)*(cells - 1))
  end function spread_index

  subroutine count_materials(deck, problems)
    type(deck_type), intent(in) :: deck
    type(problem_list), intent(inout) :: problems
    logical :: flows(size(deck%material))
    integer :: i
    flows = .false.
    do i = 1, size(deck%region)
      call note(deck%region(i)%material)
    end do
    do i = 1, size(deck%charge)
      call note(deck%charge(i)%explosive)
    end do
    call note(deck%boundary%inflow_material)
    if (count(flows) > most_flow_materials) call problems%add(0, '', str(count(flows))//' materials flow, at most '// &
      str(most_flow_materials)//' can')
  contains
    subroutine note(name)
      character(*), intent(in) :: name
      integer :: m
      m = find_material(deck, name)
      if (m > 0) flows(m) = .true.
    end subroutine note
  end subroutine count_materials

end module deck_check_flow
