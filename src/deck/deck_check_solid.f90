!> Checks of bodies, holes, reinforcement, clamps and contacts.
module deck_check_solid
  use kinds, only: wp
  use constants, only: unset
  use deck_check_flow, only: refer_to_material
  use deck_check_material, only: check_name
  use deck_check_shape, only: check_axis, check_point, check_shape, shape_type
  use deck_keys, only: key_table
  use deck_problems, only: problem_list, nearest_or_allowed
  use deck_tables, only: find_table
  use deck_types, only: deck_type, body_group, clamp_group, contact_group, find_body, find_material, &
    number_bodies, heterogeneity_group, hole_group, reinforcement_group
  use text, only: lowercase, str
  implicit none
  private
  public :: check_solid

  character(*), parameter :: only_rigid = 'only a rigid body (model = ''rigid'') has it'

contains

  !> Checks all groups that make the solid. Names of materials and bodies take the spelling of their definition.
  subroutine check_solid(deck, tables, problems, warnings)
    type(deck_type), intent(inout) :: deck
    type(key_table), intent(in) :: tables(:)
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i
    call number_bodies(deck)
    call check_numerics(deck, tables(find_table(tables, 'solid', 1)), problems)
    call check_loads(deck, tables(find_table(tables, 'output', 1)), problems)
    call check_stages(deck, tables(find_table(tables, 'stages', 1)), problems)
    do i = 1, size(deck%body)
      call check_body(deck, deck%body(i), i, tables(find_table(tables, 'body', i)), problems, warnings)
    end do
    do i = 1, size(deck%hole)
      call check_hole(deck, deck%hole(i), tables(find_table(tables, 'hole', i)), problems, warnings)
    end do
    do i = 1, size(deck%reinforcement)
      call check_bars(deck, deck%reinforcement(i), tables(find_table(tables, 'reinforcement', i)), problems, warnings)
    end do
    do i = 1, size(deck%heterogeneity)
      call check_heterogeneity(deck, deck%heterogeneity(i), tables(find_table(tables, 'heterogeneity', i)), problems, warnings)
    end do
    do i = 1, size(deck%clamp)
      call check_clamp(deck, deck%clamp(i), tables(find_table(tables, 'clamp', i)), problems)
    end do
    do i = 1, size(deck%contact)
      call check_contact(deck, deck%contact(i), tables(find_table(tables, 'contact', i)), problems)
    end do
  end subroutine check_solid

  !> Shape and transfer must fit each other.
  subroutine check_numerics(deck, table, problems)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    if (deck%solid%transfer == 'apic') then
      if (deck%solid%shape /= 'quadratic') call problems%add_at_key(table, 'transfer', &
        'transfer = ''apic'' needs shape = ''quadratic'': linear functions make it unstable as particles near the faces of cells')
      if (table%is_given('flip')) call problems%add_at_key(table, 'flip', 'flip belongs to transfer = ''flip''')
    end if
  end subroutine check_numerics

  !> Loads are those of the flow on the solid.
  subroutine check_loads(deck, table, problems)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    if (.not. deck%output%loads) return
    if (.not. (deck%has_flow .and. deck%has_solid) .or. deck%coupling%method == 'none') &
      call problems%add_at_key(table, 'loads', 'there is no load without a flow, a body and a coupling')
  end subroutine check_loads

  !> Stages are those of a scene in which flow and solid meet.
  subroutine check_stages(deck, table, problems)
    type(deck_type), intent(in) :: deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    character(*), parameter :: alone = 'there is no flow that acts on a solid, so none whose load could fade'
    if (deck%stages%solid_end /= 'never' .and. .not. deck%has_solid) call problems%add_at_key(table, 'solid_end', &
      'the deck has no &body that could come to rest')
    if (deck%has_flow .and. deck%has_solid .and. deck%coupling%method /= 'none') return
    if (deck%stages%flow_end /= 'never') call problems%add_at_key(table, 'flow_end', alone)
    if (deck%stages%flow_end_time > unset) call problems%add_at_key(table, 'flow_end_time', alone)
  end subroutine check_stages

  !> Rigid bodies: what only they have, and what they lack.
  subroutine check_rigid(deck, body, i, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(body_group), intent(in) :: body
    integer, intent(in) :: i !< number of the body
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    integer :: m, j
    m = find_material(deck, body%material)
    if (m == 0) return
    if (deck%material(m)%model /= 'rigid') then
      if (body%fixed /= '') call problems%add_at_key(table, 'fixed', only_rigid)
      if (body%fixed_rotation /= '') call problems%add_at_key(table, 'fixed_rotation', only_rigid)
      if (any(abs(body%angular_velocity) > 0.0_wp)) call problems%add_at_key(table, 'angular_velocity', only_rigid)
      return
    end if
    if (any(abs(body%velocity_gradient) > 0.0_wp)) call problems%add_at_key(table, 'velocity_gradient', &
      'a rigid body has none; angular_velocity makes it turn')
    do j = 1, size(deck%reinforcement)
      if (find_body(deck, deck%reinforcement(j)%body) == body%first) call problems%add_at_key(table, 'material', &
        'a rigid body has no reinforcement')
    end do
    do j = 1, size(deck%body)
      if (deck%body(j)%first == body%first) cycle
      if (body%first /= i) cycle
      call warnings%add_at_key(table, 'material', 'a rigid body meets the flow only: it passes through other bodies')
      exit
    end do
  end subroutine check_rigid

  subroutine check_body(deck, body, i, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(body_group), intent(inout) :: body
    integer, intent(in) :: i !< number of the body
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    type(shape_type) :: shape
    integer :: first
    call check_name(body%name, table, problems)
    shape = shape_type(body%shape, body%lower, body%upper, body%center, body%radius, body%start, body%end)
    call check_shape(shape, deck%mesh, table, problems, warnings)
    body%lower = shape%lower
    body%upper = shape%upper
    body%center = shape%center
    body%start = shape%start
    body%end = shape%end
    call refer_to_solid(deck, body%material, table, problems)
    if (body%spacing > unset .and. all(deck%mesh%upper > unset)) then
      if (any(deck%mesh%active() .and. deck%mesh%cell_size() < 0.999999_wp*body%spacing)) call warnings%add_at_key(table, &
        'spacing', 'is more than the cell size: some cells inside the body will hold no particle')
    end if
    if (body%pressure > unset .and. find_material(deck, body%material) > 0) then
      if (deck%material(find_material(deck, body%material))%model /= 'fluid') call problems%add_at_key(table, 'pressure', &
        'only a fluid (model = ''fluid'') starts under a pressure')
    end if
    call check_rigid(deck, body, i, table, problems, warnings)
    first = body%first
    if (first == i .or. first == 0 .or. body%name == '') return
    associate (other => deck%body(first))
      body%name = other%name
      if (find_material(deck, other%material) /= find_material(deck, body%material)) call problems%add_at_key(table, &
        'material', 'body '''//trim(body%name)//''' is of '''//trim(other%material)//''' on line '//str(other%line)// &
        '; parts of the same name are one body')
      if (abs(other%spacing - body%spacing) > 0.0_wp) call problems%add_at_key(table, 'spacing', 'body '''// &
        trim(body%name)//''' has another spacing on line '//str(other%line)//'; parts of the same name are one body')
      if (body%fixed /= '' .or. body%fixed_rotation /= '' .or. any(abs(body%angular_velocity) > 0.0_wp)) &
        call problems%add_at_key(table, '', 'fixed, fixed_rotation and angular_velocity of body '''//trim(body%name)// &
        ''' belong to its first part, on line '//str(other%line))
    end associate
  end subroutine check_body

  subroutine check_hole(deck, hole, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(hole_group), intent(inout) :: hole
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    type(shape_type) :: shape
    shape = shape_type(hole%shape, hole%lower, hole%upper, hole%center, hole%radius, hole%start, hole%end)
    call check_shape(shape, deck%mesh, table, problems, warnings)
    hole%lower = shape%lower
    hole%upper = shape%upper
    hole%center = shape%center
    hole%start = shape%start
    hole%end = shape%end
    call refer_to_body(deck, hole%body, table, problems)
  end subroutine check_hole

  subroutine check_bars(deck, bars, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(reinforcement_group), intent(inout) :: bars
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    real(wp) :: spacing
    logical :: complete
    integer :: i
    complete = table%is_given('start') .and. table%is_given('end')
    if (complete) call check_axis(bars%start, bars%end, deck%mesh, table, problems, complete)
    call refer_to_body(deck, bars%body, table, problems)
    call refer_to_solid(deck, bars%material, table, problems)
    i = find_material(deck, bars%material)
    if (i > 0) then
      if (deck%material(i)%model == 'rigid') call problems%add_at_key(table, 'material', 'reinforcement is never rigid')
    end if
    if (bars%count > 1 .and. .not. any(abs(bars%step) > 0.0_wp)) &
      call problems%add_at_key(table, 'count', str(bars%count)//' bars need a step from one to the next')
    i = find_body(deck, bars%body)
    if (i == 0 .or. .not. bars%diameter > unset) return
    spacing = bars%spacing
    if (spacing <= 0.0_wp) spacing = deck%body(i)%spacing
    if (bars%diameter < spacing) call warnings%add_at_key(table, 'diameter', &
      'is less than the spacing of the particles: give these bars a finer spacing')
  end subroutine check_bars

  subroutine check_heterogeneity(deck, field, table, problems, warnings)
    type(deck_type), intent(in) :: deck
    type(heterogeneity_group), intent(inout) :: field
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    integer :: i, body, material
    if (field%body == '' .and. field%material == '') call problems%add_at_key(table, '', 'body or material must be given')
    if (field%body /= '') call refer_to_body(deck, field%body, table, problems)
    if (field%material /= '') call refer_to_solid(deck, field%material, table, problems)
    where (.not. field%correlation_length > unset) field%correlation_length = field%correlation_length(1)
    body = find_body(deck, field%body)
    material = find_material(deck, field%material)
    if (field%material == '' .and. body > 0) material = find_material(deck, deck%body(body)%material)
    if (material == 0) return
    if (deck%material(material)%model == 'fluid') call problems%add_at_key(table, '', 'material '''// &
      trim(deck%material(material)%name)//''' is a fluid: it has no strength')
    if (deck%material(material)%model == 'rigid') call problems%add_at_key(table, '', 'material '''// &
      trim(deck%material(material)%name)//''' is rigid: it has no strength')
    if (deck%material(material)%model == 'neo_hookean') call problems%add_at_key(table, '', 'material '''// &
      trim(deck%material(material)%name)//''' (neo_hookean) has no strength that could vary')
    if (deck%material(material)%model /= 'fluid' .and. deck%material(material)%eos /= '') call problems%add_at_key(table, '', &
      'material '''//trim(deck%material(material)%name)//''' takes its pressure from an eos, which does not vary')
    do i = 1, size(deck%body)
      if (body > 0 .and. deck%body(i)%first /= body) cycle
      if (find_material(deck, deck%body(i)%material) /= material) cycle
      if (.not. any(deck%mesh%active() .and. field%correlation_length < 2*deck%body(i)%spacing)) cycle
      if (.not. field%correlation_length(1) > unset) cycle
      call warnings%add_at_key(table, 'correlation_length', 'is less than two particles of body '''// &
        trim(deck%body(i)%name)//''', which do not resolve it')
    end do
  end subroutine check_heterogeneity

  subroutine check_clamp(deck, clamp, table, problems)
    type(deck_type), intent(in) :: deck
    type(clamp_group), intent(inout) :: clamp
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical :: complete
    complete = table%is_given('lower') .and. table%is_given('upper')
    if (complete) then
      call check_point(clamp%lower, deck%mesh%lower, 'lower', deck%mesh, table, problems, complete)
      call check_point(clamp%upper, deck%mesh%upper, 'upper', deck%mesh, table, problems, complete)
    end if
    if (complete .and. any(clamp%upper < clamp%lower)) call problems%add_at_key(table, 'upper', 'upper lies below lower')
    if (clamp%body /= '') call refer_to_body(deck, clamp%body, table, problems)
  end subroutine check_clamp

  !> Both must be bodies, and not the same one: a body does not touch itself.
  subroutine check_contact(deck, contact, table, problems)
    type(deck_type), intent(in) :: deck
    type(contact_group), intent(inout) :: contact
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    if (lowercase(trim(contact%body_1)) /= 'all') call refer_to_body(deck, contact%body_1, table, problems, 'body_1')
    if (lowercase(trim(contact%body_2)) /= 'all') call refer_to_body(deck, contact%body_2, table, problems, 'body_2')
    if (lowercase(trim(contact%body_1)) == lowercase(trim(contact%body_2)) .and. lowercase(trim(contact%body_1)) /= 'all') &
      call problems%add_at_key(table, 'body_2', 'body '''//trim(contact%body_2)//''' can''t be in contact with itself')
    if (any(deck%material%model == 'rigid')) &
      call problems%add_at_key(table, 'body_1', 'contact does not know rigid bodies (model = ''rigid'')')
  end subroutine check_contact

  subroutine refer_to_solid(deck, name, table, problems)
    type(deck_type), intent(in) :: deck
    character(*), intent(inout) :: name
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    integer :: i
    call refer_to_material(deck, name, 'material', table, problems, i)
    if (i == 0) return
    if (deck%material(i)%model == '' .and. deck%material(i)%eos /= '') call problems%add_at_key(table, 'material', &
      'material '''//trim(name)//''' has no model: it cannot be a solid (model = ''fluid'' makes particles of its eos)')
  end subroutine refer_to_solid

  !> key: that names the body, `body` if absent.
  subroutine refer_to_body(deck, name, table, problems, key)
    type(deck_type), intent(in) :: deck
    character(*), intent(inout) :: name
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    character(*), intent(in), optional :: key
    character(:), allocatable :: its_key
    integer :: i
    its_key = 'body'
    if (present(key)) its_key = key
    if (name == '' .and. .not. table%is_given(its_key)) return
    i = find_body(deck, name)
    if (i > 0) then
      name = deck%body(i)%name
    else
      call problems%add_at_key(table, its_key, 'no &body has the name '''//trim(name)//''''// &
        nearest_or_allowed(name, deck%body%name, 'bodies'))
    end if
  end subroutine refer_to_body

end module deck_check_solid
