!> Makes the solid of a deck: materials, bodies with holes and reinforcement, supports.
module solid_setup
  use contact_fields, only: choose_fields
  use deck_types, only: deck_type, body_group, reinforcement_group, unset, find_material, find_body, word_length
  use errors, only: fatal, exit_bad_input
  use heterogeneity, only: claim_factors, set_factors
  use kinds, only: wp
  use mesh, only: mesh_type
  use particle_fluid, only: fluid_energy, fluid_energy_at, fluid_rest_pressure
  use particle_generation, only: piece_type, body_lattice, bar_lattice, generate_particles
  use particles, only: allocate_particles, n_load_columns
  use rigid_bodies, only: start_rigid
  use rigid_motion, only: rigid_body
  use solid_material, only: make_solid_material, claim_columns, model_fluid, model_rigid
  use solid_shapes, only: shape_type, box_shape, sphere_shape, cylinder_shape, ogive_shape
  use solid_state, only: solid_type, n_books, face_free, face_symmetry, face_clamped, clamp_box, n_cells_of, scheme_musl, &
    scheme_usl, scheme_usf, n_contact_books, contact_pair
  use supports, only: find_supports
  implicit none
  private
  public :: setup_solid, allocate_solid

contains

  !> Builds the solid; project_solid must follow. pieces: what was made of each shape, for the report; loaded: particles shall carry
  !> forces from outside (default: no).
  !> Errors in the deck that only the mesh shows (a body that misses the domain) are fatal.
  subroutine setup_solid(mesh, deck, solid, pieces, loaded)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(out) :: solid
    type(piece_type), allocatable, intent(out) :: pieces(:)
    logical, intent(in), optional :: loaded
    integer, allocatable :: used(:), field(:)
    integer :: i
    solid%present = size(deck%body) > 0
    solid%cfl = deck%solid%cfl
    solid%gravity = merge(deck%solid%gravity, 0.0_wp, mesh%active)
    call choose_numerics(mesh, deck, solid)
    call number_bodies(deck, solid)
    call choose_contacts(deck, solid, field)
    call choose_materials(deck, field, solid, used)
    if (present(loaded)) call claim_forces(loaded, solid)
    call claim_factors(deck, used, solid)
    call list_rigid(mesh, deck, used, solid)
    call set_supports(mesh, deck, solid)
    call allocate_solid(mesh, solid)
    call make_pieces(mesh, deck, used, field, solid, pieces)
    call generate_particles(mesh, solid, pieces)
    call set_factors(mesh, deck, used, deck%body%number, pieces, solid)
    call start_rigid(mesh, solid)
  end subroutine setup_solid

  !> Empty particle blocks, books at zero, held nodes: all that follows from the mesh, the materials and the supports.
  subroutine allocate_solid(mesh, solid)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer :: b, set, n
    n = n_books
    if (allocated(solid%pair)) then
      n = n + n_contact_books*size(solid%pair)
      allocate (solid%surface(solid%n_fields, mesh%n_local), solid%meeting(mesh%n_local))
    end if
    allocate (solid%block(solid%n_sets, mesh%n_local), solid%count(mesh%n_local), solid%support(mesh%n_local))
    allocate (solid%node(solid%n_fields, mesh%n_local), solid%force(solid%n_fields, mesh%n_local))
    allocate (solid%mapped(solid%n_fields, mesh%n_local))
    allocate (solid%limit(solid%n_sets, mesh%n_local))
    allocate (solid%books(n, mesh%n_local), source=0.0_wp)
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        call allocate_particles(solid%block(set, b), n_cells_of(mesh), solid%material(set)%n_field)
      end do
    end do
    call find_supports(mesh, solid)
  end subroutine allocate_solid

  !> Functions, transfer and scheme.
  subroutine choose_numerics(mesh, deck, solid)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(inout) :: solid
    if (deck%solid%shape == 'quadratic') solid%order = 2
    if (any(mesh%active .and. mesh%brick_cells < solid%order)) call fatal('mesh%brick: the quadratic shape needs bricks of two '// &
      'cells or more', exit_bad_input)
    solid%flip = deck%solid%flip
    if (deck%solid%transfer == 'apic') solid%flip = 0
    select case (deck%solid%scheme)
    case ('usl')
      solid%scheme = scheme_usl
    case ('usf')
      solid%scheme = scheme_usf
    case default
      solid%scheme = scheme_musl
    end select
  end subroutine choose_numerics

  !> Velocity fields of the bodies, by their numbers, from the contacts of the deck. Of several for the same two the last holds.
  subroutine choose_contacts(deck, solid, field)
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(inout) :: solid
    integer, allocatable, intent(out) :: field(:)
    type(contact_pair), allocatable :: pair(:)
    real(wp) :: friction(solid%n_bodies, solid%n_bodies)
    integer :: c, i, j, one, two
    allocate (field(solid%n_bodies), source=1)
    if (.not. allocated(deck%contact)) return
    friction = -1
    do c = 1, size(deck%contact)
      one = body_number(deck, deck%contact(c)%body_1)
      two = body_number(deck, deck%contact(c)%body_2)
      do j = 1, solid%n_bodies
        do i = 1, solid%n_bodies
          if (i == j .or. (one > 0 .and. one /= i) .or. (two > 0 .and. two /= j)) cycle
          friction(i, j) = deck%contact(c)%friction
          friction(j, i) = deck%contact(c)%friction
        end do
      end do
    end do
    call choose_fields(friction, solid%body_name(:solid%n_bodies), field, pair)
    solid%n_fields = maxval([1, field])
    if (size(pair) > 0) call move_alloc(pair, solid%pair)
  end subroutine choose_contacts

  !> One set per material that a body or a reinforcement names and velocity field of the body, in the order of their first use.
  !> field: by body number; used: material of the deck of each set.
  subroutine choose_materials(deck, field, solid, used)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: field(:)
    type(solid_type), intent(inout) :: solid
    integer, allocatable, intent(out) :: used(:)
    integer :: i, m
    allocate (used(0), solid%field_of_set(0))
    do i = 1, size(deck%body)
      m = find_material(deck, deck%body(i)%material)
      if (m == 0) call fatal("body '"//trim(deck%body(i)%name)//"': no material '"//trim(deck%body(i)%material)//"'", &
        exit_bad_input)
      call use_material(m, field(deck%body(i)%number))
    end do
    do i = 1, size(deck%reinforcement)
      m = find_material(deck, deck%reinforcement(i)%material)
      if (m == 0) call fatal("reinforcement: no material '"//trim(deck%reinforcement(i)%material)//"'", exit_bad_input)
      if (find_body(deck, deck%reinforcement(i)%body) == 0) call fatal("reinforcement: no body '"// &
        trim(deck%reinforcement(i)%body)//"'", exit_bad_input)
      call use_material(m, field(body_number(deck, deck%reinforcement(i)%body)))
    end do
    solid%n_sets = size(used)
    allocate (solid%material(size(used)), solid%material_of_set(size(used)))
    allocate (solid%at_affine(size(used)), solid%at_force(size(used)), source=0)
    do i = 1, size(used)
      m = findloc(used, used(i), dim=1)
      if (m < i) then
        solid%material_of_set(i) = solid%material_of_set(m)
      else
        solid%material_of_set(i) = maxval([0, solid%material_of_set(:i - 1)]) + 1
      end if
      solid%material(i) = make_solid_material(deck%material(used(i)), deck%solid%bulk_viscosity)
      if (deck%solid%transfer == 'apic' .and. solid%material(i)%model /= model_rigid) &
        call claim_columns(solid%material(i), 9, solid%at_affine(i))
    end do
    if (deck%output%loads) then
      allocate (solid%at_load(size(used)))
      do i = 1, size(used)
        call claim_columns(solid%material(i), n_load_columns, solid%at_load(i))
      end do
    end if
    if (.not. any(solid%material%model == model_rigid)) return
    if (.not. all(solid%material%model == model_rigid)) solid%n_fields = solid%n_fields + 1
    solid%rigid_field = solid%n_fields
    where (solid%material%model == model_rigid) solid%field_of_set = solid%rigid_field

  contains

    subroutine use_material(material, its_field)
      integer, intent(in) :: material, its_field
      if (any(used == material .and. solid%field_of_set == its_field)) return
      used = [used, material]
      solid%field_of_set = [solid%field_of_set, its_field]
    end subroutine use_material

  end subroutine choose_materials

  !> Columns for forces from outside; rigid bodies feel theirs as a whole.
  subroutine claim_forces(loaded, solid)
    logical, intent(in) :: loaded
    type(solid_type), intent(inout) :: solid
    integer :: set
    if (.not. loaded) return
    do set = 1, solid%n_sets
      if (solid%material(set)%model /= model_rigid) call claim_columns(solid%material(set), 3, solid%at_force(set))
    end do
  end subroutine claim_forces

  !> Bodies are numbered by their names in the order of the deck.
  subroutine number_bodies(deck, solid)
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(inout) :: solid
    integer :: i
    allocate (solid%body_name(size(deck%body)))
    do i = 1, size(deck%body)
      if (deck%body(i)%first /= i) cycle
      solid%n_bodies = solid%n_bodies + 1
      solid%body_name(solid%n_bodies) = deck%body(i)%name
    end do
    solid%body_name = solid%body_name(:solid%n_bodies) ! several shapes may be one body
  end subroutine number_bodies

  !> The rigid bodies in the order of the deck and what each is free to do; in directions without cells there is no motion.
  subroutine list_rigid(mesh, deck, used, solid)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:)
    type(solid_type), intent(inout) :: solid
    type(rigid_body) :: rigid
    integer :: i, d, set
    allocate (solid%rigid(0), solid%rigid_of_body(solid%n_bodies))
    solid%rigid_of_body = 0
    do i = 1, size(deck%body)
      set = findloc(used, find_material(deck, deck%body(i)%material), dim=1)
      if (solid%material(set)%model /= model_rigid .or. deck%body(i)%first /= i) cycle
      rigid%body = deck%body(i)%number
      do d = 1, 3
        rigid%free(d) = mesh%active(d) .and. index(deck%body(i)%fixed, 'xyz'(d:d)) == 0
        rigid%free_axis(d) = all(mesh%active .or. [1, 2, 3] == d) .and. index(deck%body(i)%fixed_rotation, 'xyz'(d:d)) == 0
      end do
      rigid%angular_velocity = deck%body(i)%angular_velocity
      solid%rigid = [solid%rigid, rigid]
      solid%rigid_of_body(rigid%body) = size(solid%rigid)
    end do
  end subroutine list_rigid

  !> Number of the body of this name, 0 if there is none.
  pure integer function body_number(deck, name) result(number)
    type(deck_type), intent(in) :: deck
    character(*), intent(in) :: name
    integer :: i
    number = 0
    i = find_body(deck, name)
    if (i > 0) number = deck%body(i)%number
  end function body_number

  subroutine set_supports(mesh, deck, solid)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(inout) :: solid
    type(shape_type) :: shape
    type(clamp_box) :: part
    integer :: d, side, i, c
    do d = 1, 3
      do side = 1, 2
        select case (deck%boundary%solid_face(d, side))
        case ('symmetry')
          solid%face(side, d) = face_symmetry
        case ('clamped')
          solid%face(side, d) = face_clamped
        case default
          solid%face(side, d) = face_free
        end select
      end do
    end do
    allocate (solid%clamp(0))
    do c = 1, size(deck%clamp)
      associate (clamp => deck%clamp(c))
        part%lower = clamp%lower
        part%upper = clamp%upper
        part%fixed = [index(clamp%fixed, 'x') > 0, index(clamp%fixed, 'y') > 0, index(clamp%fixed, 'z') > 0]
        if (clamp%body == '') then
          solid%clamp = [solid%clamp, part]
          cycle
        end if
        ! a clamp of one body holds the nodes around that body's shapes only
        do i = 1, size(deck%body)
          if (deck%body(i)%first /= find_body(deck, clamp%body)) cycle
          shape = deck_shape(mesh, deck%body(i)%shape, deck%body(i)%lower, deck%body(i)%upper, deck%body(i)%center, &
            deck%body(i)%radius, deck%body(i)%start, deck%body(i)%end, deck%body(i)%caliber_radius_head)
          solid%clamp = [solid%clamp, clamp_box(max(clamp%lower, shape%lower - mesh%spacing), &
            min(clamp%upper, shape%upper + mesh%spacing), part%fixed)]
        end do
      end associate
    end do
  end subroutine set_supports

  function deck_shape(mesh, kind, lower, upper, center, radius, start, end, head) result(shape)
    type(mesh_type), intent(in) :: mesh
    character(*), intent(in) :: kind
    real(wp), intent(in) :: lower(3), upper(3), center(3), radius, start(3), end(3), head
    type(shape_type) :: shape
    select case (kind)
    case ('box')
      shape = box_shape(lower, upper, mesh%active)
    case ('sphere')
      shape = sphere_shape(center, radius, mesh%active)
    case ('cylinder')
      shape = cylinder_shape(start, end, radius, mesh%active)
    case ('ogive')
      shape = ogive_shape(start, end, radius, head, mesh%active)
    case default
      call fatal("solid: no shape '"//trim(kind)//"'", exit_bad_input)
    end select
  end function deck_shape

  !> Bodies in the order of the deck, then bars. A shape gives way to earlier shapes of its body, to the body's holes and bars;
  !> a bar gives way to earlier bars.
  subroutine make_pieces(mesh, deck, used, field, solid, pieces)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:), field(:)
    type(solid_type), intent(in) :: solid
    type(piece_type), allocatable, intent(out) :: pieces(:)
    type(shape_type), allocatable :: bar(:), cut(:), shape(:)
    integer, allocatable :: owner(:), group(:)
    real(wp) :: pressure
    integer :: i, j, n
    call list_bars(mesh, deck, bar, owner, group)
    allocate (shape(size(deck%body)), pieces(size(deck%body) + size(bar)))
    do i = 1, size(deck%body)
      associate (body => deck%body(i), piece => pieces(i))
        shape(i) = deck_shape(mesh, body%shape, body%lower, body%upper, body%center, body%radius, body%start, body%end, &
          body%caliber_radius_head)
        allocate (cut(0))
        do j = 1, i - 1
          if (deck%body(j)%first == body%first) cut = [cut, shape(j)]
        end do
        do j = 1, size(deck%hole)
          if (find_body(deck, deck%hole(j)%body) /= body%first) cycle
          cut = [cut, deck_shape(mesh, deck%hole(j)%shape, deck%hole(j)%lower, deck%hole(j)%upper, deck%hole(j)%center, &
            deck%hole(j)%radius, deck%hole(j)%start, deck%hole(j)%end, deck%hole(j)%caliber_radius_head)]
        end do
        do j = 1, size(bar)
          if (owner(j) == body%first) cut = [cut, bar(j)]
        end do
        piece%name = body%name
        piece%shape = shape(i)
        call move_alloc(cut, piece%cut)
        piece%lattice = body_lattice(mesh, shape(i), body%spacing)
        piece%body = body%number
        piece%set = set_of(body%material, piece%body)
        piece%velocity = body%velocity
        piece%velocity_gradient = body%velocity_gradient
      end associate
    end do
    n = size(deck%body)
    do i = 1, size(bar)
      associate (bars => deck%reinforcement(group(i)), body => deck%body(owner(i)), piece => pieces(n + i))
        allocate (cut(0))
        do j = 1, i - 1
          if (owner(j) == owner(i)) cut = [cut, bar(j)]
        end do
        piece%name = trim(body%name)//' reinforcement'
        piece%shape = bar(i)
        call move_alloc(cut, piece%cut)
        piece%lattice = bar_lattice(mesh, bar(i), merge(bars%spacing, body%spacing, bars%spacing > 0))
        piece%body = body%number
        piece%set = set_of(bars%material, piece%body)
        piece%velocity = body%velocity
        piece%velocity_gradient = body%velocity_gradient
      end associate
    end do
    do i = 1, size(pieces)
      pressure = unset
      if (i <= size(deck%body)) pressure = deck%body(i)%pressure
      call set_fluid_state(deck, solid, pressure, pieces(i))
    end do

  contains

    !> Set of a material in a body; rigid ones are all in the field of the rigid.
    integer function set_of(material, body)
      character(*), intent(in) :: material
      integer, intent(in) :: body
      set_of = findloc(used == find_material(deck, material) .and. (solid%field_of_set == field(body) .or. &
                                                                    solid%material%model == model_rigid), .true., dim=1)
    end function set_of

  end subroutine make_pieces

  !> All bars that touch the domain; owner: first body group of their body; group: their reinforcement group.
  subroutine list_bars(mesh, deck, bar, owner, group)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(shape_type), allocatable, intent(out) :: bar(:)
    integer, allocatable, intent(out) :: owner(:), group(:)
    type(shape_type) :: shape
    integer :: i, j
    allocate (bar(0), owner(0), group(0))
    do i = 1, size(deck%reinforcement)
      associate (bars => deck%reinforcement(i))
        if (find_body(deck, bars%body) == 0) call fatal("reinforcement: no body '"//trim(bars%body)//"'", exit_bad_input)
        do j = 0, bars%count - 1
          shape = cylinder_shape(bars%start + j*bars%step, bars%end + j*bars%step, 0.5_wp*bars%diameter, mesh%active)
          if (any(mesh%active .and. (shape%upper <= mesh%lower .or. shape%lower >= mesh%upper))) cycle
          bar = [bar, shape]
          owner = [owner, find_body(deck, bars%body)]
          group = [group, i]
        end do
      end associate
    end do
  end subroutine list_bars

  !> Fluids start at the pressure that is asked of them; where that is unset, at the energy of the explosive, or at the deck's
  !> ambient pressure.
  subroutine set_fluid_state(deck, solid, pressure, piece)
    type(deck_type), intent(in) :: deck
    type(solid_type), intent(in) :: solid
    real(wp), intent(in) :: pressure
    type(piece_type), intent(inout) :: piece
    real(wp) :: ambient
    associate (m => solid%material(piece%set))
      if (m%model /= model_fluid) return
      ambient = 0
      if (deck%flow%ambient_pressure > unset) ambient = deck%flow%ambient_pressure
      piece%energy = fluid_energy(m%eos, m%density, ambient)
      if (pressure > unset) piece%energy = fluid_energy_at(m%eos, m%density, pressure)
      piece%pressure = fluid_rest_pressure(m%eos, m%density, piece%energy)
    end associate
  end subroutine set_fluid_state

end module solid_setup
