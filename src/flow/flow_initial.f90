!> The flow at the start of a scene, from its deck: materials, boundary conditions, regions and charges.
module flow_initial
  use afterburn, only: afterburn_type
  use burn, only: set_up_burn, unburnt_energy
  use burn_charges, only: charges_of_deck, is_programmed
  use constants, only: pi
  use deck_types, only: deck_type, find_material, material_group, charge_group, region_group, unset, word_length
  use equation_of_state, only: eos_type
  use eos_check, only: check_eos, shocked_density
  use errors, only: fatal, warn, exit_bad_input
  use flow_filling, only: filling_type, share_of_regions, no_surface_cuts, mixed_cell, trace_density, halvings_for
  use flow_scheme, only: scheme_type, scheme_from_words
  use flow_shapes, only: filled_shape, volume_in_box, shape_all, shape_box, shape_sphere, shape_cylinder, shape_half_space
  use flow_state, only: flow_type, allocate_flow, hold_cells, set_inflow, face_outflow, face_symmetry, face_inflow, face_periodic, &
    face_ambient
  use flow_step, only: settled_state
  use geometry, only: cell_volumes
  use kinds, only: wp
  use log, only: say
  use material_eos, only: eos_of
  use mesh, only: mesh_type
  use mixture, only: cell_from
  use reductions, only: reduce_sum, reduce_min
  use sleeping_bricks, only: sleep_if_uniform, start_in_state
  use text, only: str, lowercase
  implicit none
  private
  public :: setup_flow, flow_scheme_of

  real(wp), parameter :: mass_tolerance = 1e-3_wp !< of a placed charge

contains

  !> Allocates and fills the flow of this rank; charges that are mapped later are left out. Fatal (bad input) where the deck leaves a
  !> cell empty, names a material that does not flow, or a charge's placed mass differs from the asked one.
  subroutine setup_flow(mesh, deck, flow)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(flow_type), intent(inout) :: flow
    integer, allocatable :: used(:)
    type(filling_type), allocatable :: filling(:)
    real(wp), allocatable :: density(:), pressure(:)
    character(word_length), allocatable :: name(:)
    type(eos_type), allocatable :: eos(:)
    integer :: i
    call list_materials(deck, used)
    allocate (name(size(used)), eos(size(used)))
    do i = 1, size(used)
      name(i) = deck%material(used(i))%name
      eos(i) = eos_of(deck%material(used(i)))
    end do
    call allocate_flow(flow, mesh, name, eos, without_cells=.true.)
    flow%sleep = deck%flow%sleep
    flow%cfl = deck%flow%cfl
    flow%scheme = flow_scheme_of(deck)
    flow%trace_fraction = merge(deck%flow%trace_fraction, 0.0_wp, size(used) > 1)
    flow%gravity = merge(deck%flow%gravity, 0.0_wp, mesh%active)
    call set_faces(deck, flow)
    filling = fillings(mesh, deck, used)
    associate (charge => filling(size(deck%region) + 1:))
      call set_up_burn(mesh, flow, charges_of_deck(mesh, deck, charge%shape, charge%material, eos), deck%flow%burn_width)
    end associate
    call set_afterburn(deck, used, flow)
    call reference_states(flow, filling, density, pressure)
    do i = 1, size(used)
      call test_eos(flow, filling, i, density(i), pressure(i))
    end do
    flow%floor_pressure = 1e-9_wp*minval(abs(filling%pressure), abs(filling%pressure) > 0)
    call fill_bricks(mesh, flow, pack(filling, [spread(.true., 1, size(deck%region)), .not. deck%charge%is_mapped()]), &
      density, pressure)
    call weigh_charges(mesh, deck, flow, filling)
    flow%burn_total = unburnt_energy(mesh, flow)
    if (any(flow%face == face_ambient)) call set_ambient(mesh, deck, flow, filling, density, pressure)
    if (any(flow%face == face_inflow)) call prepare_inflow(deck, flow, used, density, pressure)
    call set_noise(mesh, flow)
  end subroutine setup_flow

  !> Afterburn of the materials. Fatal (bad input) where it would begin before all programmed charges have burnt: what has not burnt
  !> would get it too.
  subroutine set_afterburn(deck, used, flow)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:)
    type(flow_type), intent(inout) :: flow
    integer :: i
    do i = 1, size(used)
      associate (group => deck%material(used(i)))
        if (.not. group%afterburn_energy > 0) cycle
        flow%afterburn(i) = afterburn_type(group%afterburn_energy, group%afterburn_start, group%afterburn_end)
        if (flow%burn_energy(i) > 0 .and. group%afterburn_start < flow%burn_end) call fatal('material on line '// &
          str(group%line)//': afterburn_start lies before '//str(flow%burn_end, 4)// &
          ', when all programmed charges have burnt', exit_bad_input)
      end associate
    end do
  end subroutine set_afterburn

  !> The scheme that the deck asks for.
  pure function flow_scheme_of(deck) result(scheme)
    type(deck_type), intent(in) :: deck
    type(scheme_type) :: scheme
    scheme = scheme_from_words(lowercase(trim(deck%flow%reconstruction)), lowercase(trim(deck%flow%limiter)), &
      lowercase(trim(deck%flow%interface)), lowercase(trim(deck%flow%shocks)))
  end function flow_scheme_of

  !> Deck indices of the materials of the flow, in the order of the deck.
  subroutine list_materials(deck, used)
    type(deck_type), intent(in) :: deck
    integer, allocatable, intent(out) :: used(:)
    logical :: is_used(size(deck%material))
    integer :: i
    is_used = .false.
    do i = 1, size(deck%region)
      call use_material(deck%region(i)%material)
    end do
    do i = 1, size(deck%charge)
      call use_material(deck%charge(i)%explosive)
    end do
    if (deck%boundary%inflow_material /= '') call use_material(deck%boundary%inflow_material)
    used = pack([(i, i=1, size(is_used))], is_used)
  contains
    subroutine use_material(name)
      character(*), intent(in) :: name
      integer :: m
      m = find_material(deck, name)
      if (m == 0) then
        call fatal('flow: there is no material '''//trim(name)//'''', exit_bad_input)
      else
        if (deck%material(m)%eos == '') call fatal('flow: material '''//trim(name)//''' has no eos', exit_bad_input)
        is_used(m) = .true.
      end if
    end subroutine use_material
  end subroutine list_materials

  subroutine set_faces(deck, flow)
    type(deck_type), intent(in) :: deck
    type(flow_type), intent(inout) :: flow
    integer :: d, side
    do d = 1, 3
      do side = 1, 2
        select case (lowercase(trim(deck%boundary%flow_face(d, side))))
        case ('symmetry'); flow%face(side, d) = face_symmetry
        case ('inflow'); flow%face(side, d) = face_inflow
        case ('ambient'); flow%face(side, d) = face_ambient
        case ('periodic'); flow%face(side, d) = face_periodic
        case default; flow%face(side, d) = face_outflow
        end select
      end do
    end do
  end subroutine set_faces

  !> Regions, then charges, as shapes with what fills them.
  function fillings(mesh, deck, used) result(filling)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:)
    type(filling_type) :: filling(size(deck%region) + size(deck%charge))
    type(eos_type) :: eos
    integer :: i, n
    n = size(deck%region)
    do i = 1, n
      filling(i)%shape = region_shape(deck%region(i))
      filling(i)%material = findloc(used, find_material(deck, deck%region(i)%material), dim=1)
      filling(i)%density = deck%region(i)%density
      if (.not. filling(i)%density > 0) filling(i)%density = deck%material(used(filling(i)%material))%density
      filling(i)%pressure = deck%region(i)%pressure
      filling(i)%velocity = merge(deck%region(i)%velocity, 0.0_wp, mesh%active)
    end do
    do i = 1, size(deck%charge)
      associate (f => filling(n + i))
        f%material = findloc(used, find_material(deck, deck%charge(i)%explosive), dim=1)
        associate (group => deck%material(used(f%material)))
          f%density = group%density
          eos = eos_of(group)
          f%pressure = eos%pressure(f%density, group%energy_per_volume/group%density)
          if (is_programmed(deck%charge(i))) f%pressure = deck%flow%ambient_pressure
          f%shape = charge_shape(deck%charge(i), deck%charge(i)%mass/group%density, mesh%active, mesh%radial_power)
        end associate
      end associate
    end do
    filling%shape%active(1) = mesh%active(1)
    filling%shape%active(2) = mesh%active(2)
    filling%shape%active(3) = mesh%active(3)
    filling%shape%radial_power = mesh%radial_power
    do i = 1, size(filling)
      filling(i)%halvings = halvings_for(size_of(filling(i)%shape), maxval(mesh%spacing, mesh%active), mesh%dimensions)
    end do
  end function fillings

  !> Shortest length of a shape that a cell must resolve.
  pure real(wp) function size_of(shape)
    type(filled_shape), intent(in) :: shape
    size_of = huge(1.0_wp)
    if (shape%kind == shape_sphere .or. shape%kind == shape_cylinder) size_of = shape%radius
    if (shape%kind == shape_box) size_of = minval(shape%upper - shape%lower, shape%active)
  end function size_of

  pure function region_shape(region) result(shape)
    type(region_group), intent(in) :: region
    type(filled_shape) :: shape
    select case (lowercase(trim(region%shape)))
    case ('box'); shape%kind = shape_box
    case ('sphere'); shape%kind = shape_sphere
    case ('cylinder'); shape%kind = shape_cylinder
    case ('half_space'); shape%kind = shape_half_space
    case default; shape%kind = shape_all
    end select
    if (shape%kind == shape_box) then
      shape%lower = region%lower
      shape%upper = region%upper
    else if (shape%kind == shape_sphere) then
      shape%center = region%center
      shape%radius = region%radius
    else if (shape%kind == shape_cylinder) then
      shape%start = region%start
      shape%end = region%end
      shape%radius = region%radius
    else if (shape%kind == shape_half_space) then
      shape%start = region%point
      shape%normal = region%normal
    end if
  end function region_shape

  !> Shape of a charge of given volume (per length on a 2-D mesh, per area on a 1-D mesh). A radius of the mesh (radial_power) adds
  !> the directions that it turns through: a charge on the axis or at the centre is a body of 3 dimensions, of 2 on a cylindrical
  !> 1-D mesh.
  pure function charge_shape(charge, volume, active, radial_power) result(shape)
    type(charge_group), intent(in) :: charge
    real(wp), intent(in) :: volume
    logical, intent(in) :: active(3)
    integer, intent(in) :: radial_power
    type(filled_shape) :: shape
    real(wp) :: edges(3), axis(3), length, diameter
    integer :: n
    n = count(active) + radial_power
    select case (lowercase(trim(charge%shape)))
    case ('box')
      shape%kind = shape_box
      edges = charge%proportions*(volume/product(charge%proportions, active))**(1.0_wp/n)
      shape%lower = charge%center - 0.5_wp*edges
      shape%upper = charge%center + 0.5_wp*edges
    case ('cylinder')
      shape%kind = shape_cylinder
      axis = charge%axis/norm2(charge%axis)
      length = 0
      if (n == 3) then
        diameter = (4*volume/(pi*charge%length_to_diameter))**(1.0_wp/3)
        length = charge%length_to_diameter*diameter
      else if (norm2(merge(axis, 0.0_wp, active)) < 0.5_wp) then
        diameter = merge(sqrt(4*volume/pi), volume, n == 2) ! the axis is across the mesh: a disc
      else
        axis = merge(axis, 0.0_wp, active)/norm2(merge(axis, 0.0_wp, active)) ! the axis lies in the mesh: a rectangle
        diameter = merge(sqrt(volume/charge%length_to_diameter), volume, n == 2)
        length = merge(charge%length_to_diameter*diameter, volume, n == 2)
      end if
      shape%radius = 0.5_wp*diameter
      shape%start = charge%center - 0.5_wp*length*axis
      shape%end = charge%center + 0.5_wp*length*axis
      if (.not. length > 0) shape%end = shape%start
    case default
      shape%kind = shape_sphere
      shape%center = charge%center
      if (n == 3) shape%radius = (3*volume/(4*pi))**(1.0_wp/3)
      if (n == 2) shape%radius = sqrt(volume/pi)
      if (n == 1) shape%radius = 0.5_wp*volume
    end select
  end function charge_shape

  !> For each material the density and pressure of a state that the deck gives it: its first filling.
  subroutine reference_states(flow, filling, density, pressure)
    type(flow_type), intent(in) :: flow
    type(filling_type), intent(in) :: filling(:)
    real(wp), allocatable, intent(out) :: density(:), pressure(:)
    integer :: k, i
    allocate (density(flow%n_materials), pressure(flow%n_materials))
    do k = 1, flow%n_materials
      i = findloc(filling%material, k, dim=1)
      if (i == 0) i = 1 ! a material that only flows in
      density(k) = filling(i)%density
      pressure(k) = filling(i)%pressure
    end do
  end subroutine reference_states

  !> Warns where the equation of state of material k fails its test, or the scene may press it beyond its reference curve.
  subroutine test_eos(flow, filling, k, density, pressure)
    type(flow_type), intent(in) :: flow
    type(filling_type), intent(in) :: filling(:)
    integer, intent(in) :: k
    real(wp), intent(in) :: density, pressure
    character(:), allocatable :: first
    real(wp) :: highest, densest
    integer :: n
    highest = highest_pressure(flow, filling)
    call check_eos(flow%eos(k), density, abs(pressure), n, first, highest)
    if (n > 0) call warn('material '//flow%material_name(k)//': '//str(n)// &
      ' states of its equation of state fail the test, first '//first)
    densest = shocked_density(flow%eos(k), density, pressure, highest)
    if (densest > flow%eos(k)%largest_density()) call warn('material '//flow%material_name(k)//': a shock to the pressure '// &
      str(highest)//' brings it to the density '//str(densest)//', but its reference curve is good up to '// &
      str(flow%eos(k)%largest_density())//' only')
  end subroutine test_eos

  !> The highest pressure of the first state, of explosive that burns at rest, and of the impact of its fastest parts on each other
  !> with a shock speed of c + 2 u.
  pure real(wp) function highest_pressure(flow, filling)
    type(flow_type), intent(in) :: flow
    type(filling_type), intent(in) :: filling(:)
    real(wp) :: u, r, p
    integer :: i, j
    highest_pressure = maxval(filling%pressure)
    do i = 1, size(filling)
      associate (f => filling(i), eos => flow%eos(filling(i)%material))
        highest_pressure = max(highest_pressure, &
          eos%pressure(f%density, eos%energy(f%density, f%pressure) + flow%burn_energy(f%material)))
      end associate
    end do
    do i = 1, size(filling)
      r = filling(i)%density
      p = filling(i)%pressure
      u = 0
      do j = 1, size(filling)
        u = max(u, 0.5_wp*norm2(filling(j)%velocity - filling(i)%velocity))
      end do
      highest_pressure = max(highest_pressure, &
        p + r*(sqrt(max(flow%eos(filling(i)%material)%sound_speed_squared(r, p), 0.0_wp)) + 2*u)*u)
    end do
  end function highest_pressure

  subroutine fill_bricks(mesh, flow, filling, density, pressure)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: density(:), pressure(:)
    real(wp) :: share(size(filling)), center(3), width(3), cell(flow%layout%n_rows)
    real(wp) :: alone(flow%layout%n_rows, size(filling)) !< state of cells that one filling fills
    logical :: is_filled, is_known(size(filling))
    integer :: b, i, j, k, only
    is_known = .false.
    do b = 1, mesh%n_local
      width = mesh%brick_cells*mesh%spacing
      if (no_surface_cuts(filling, mesh%brick(mesh%local(b))%origin + 0.5_wp*width, width)) then
        call fill_cell(1, 1, 1)
        if (.not. is_filled) return
        call start_in_state(mesh, flow, b, cell)
        cycle
      end if
      call hold_cells(flow, mesh, b)
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            call fill_cell(i, j, k)
            if (.not. is_filled) return
            flow%w(b, flow%current)%a(i, :, j, k) = cell
          end do
        end do
      end do
      call sleep_if_uniform(mesh, flow, b)
    end do

  contains

    !> State of a cell. One that a single filling fills has settled, so that still gas stays as it is to the last bit.
    subroutine fill_cell(i, j, k)
      integer, intent(in) :: i, j, k
      center = mesh%brick(mesh%local(b))%origin + ([i, j, k] - 0.5_wp)*mesh%spacing
      call share_of_regions(filling, center, mesh%spacing, share)
      is_filled = .not. sum(share) < 1 - 1e-6_wp
      if (.not. is_filled) then
        call fatal('region: the cell at '//str(center(1))//' '//str(center(2))//' '//str(center(3))// &
          ' is not filled by any region', exit_bad_input)
      else if (count(share > 0) > 1) then
        cell = mixed_cell(flow%layout, flow%eos, filling, share/sum(share), flow%trace_fraction, density, pressure)
      else
        only = maxloc(share, dim=1)
        if (.not. is_known(only)) alone(:, only) = settled_state(mesh, flow, &
          mixed_cell(flow%layout, flow%eos, filling, share/sum(share), flow%trace_fraction, density, pressure))
        is_known(only) = .true.
        cell = alone(:, only)
      end if
    end subroutine fill_cell

  end subroutine fill_bricks

  !> Compares the placed mass of each charge with the part of the asked mass that lies inside the domain.
  subroutine weigh_charges(mesh, deck, flow, filling)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(flow_type), intent(in) :: flow
    type(filling_type), intent(in) :: filling(:)
    real(wp) :: share(size(filling)), placed(size(deck%charge), mesh%n_local), total(size(deck%charge)), center(3), width(3), &
      inside, volume(mesh%brick_cells(1))
    integer :: b, i, j, k, n, c
    if (all(deck%charge%is_mapped())) return
    n = size(deck%region)
    placed = 0
    do b = 1, mesh%n_local
      volume = cell_volumes(mesh, b)
      width = mesh%brick_cells*mesh%spacing
      center = mesh%brick(mesh%local(b))%origin + 0.5_wp*width
      if (no_surface_cuts(filling, center, width)) then
        call share_of_regions(filling, center, mesh%spacing, share)
        if (.not. any(share(n + 1:) > 0)) cycle
      end if
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            center = mesh%brick(mesh%local(b))%origin + ([i, j, k] - 0.5_wp)*mesh%spacing
            call share_of_regions(filling, center, mesh%spacing, share)
            placed(:, b) = placed(:, b) + share(n + 1:)*filling(n + 1:)%density*volume(i)
          end do
        end do
      end do
    end do
    call reduce_sum(mesh, placed, total)
    do c = 1, size(deck%charge)
      if (deck%charge(c)%is_mapped()) cycle
      inside = filling(n + c)%density*volume_inside(mesh, filling(n + c)%shape)
      call say('charge '//str(c)//' of '//flow%material_name(filling(n + c)%material)//': mass '//str(deck%charge(c)%mass)// &
        ', '//str(inside)//' of it in the domain, '//str(total(c))//' placed'//dimensions_of(filling(n + c)%shape))
      if (.not. abs(total(c) - inside) <= mass_tolerance*inside .or. .not. inside > 0) &
        call fatal('charge '//str(c)//': '//str(total(c))//' of the mass is placed where '//str(inside)// &
        ' lies inside the domain (the mesh is too coarse for it, it is outside, or another charge covers it)', exit_bad_input)
    end do
  end subroutine weigh_charges

  !> Volume of a shape inside the domain, found without the cells: the box around it is halved where the surface cuts it.
  pure real(wp) function volume_inside(mesh, shape)
    type(mesh_type), intent(in) :: mesh
    type(filled_shape), intent(in) :: shape
    integer, parameter :: halvings(3) = [20, 9, 6]
    real(wp) :: lower(3), upper(3), reach(3)
    select case (shape%kind)
    case (shape_sphere)
      lower = shape%center - shape%radius
      upper = shape%center + shape%radius
    case (shape_cylinder)
      reach = shape%radius
      lower = min(shape%start, shape%end) - reach
      upper = max(shape%start, shape%end) + reach
    case default
      lower = shape%lower
      upper = shape%upper
    end select
    lower = merge(max(lower, mesh%lower), 0.0_wp, mesh%active)
    upper = merge(min(upper, mesh%upper), 1.0_wp, mesh%active)
    volume_inside = 0
    if (all(upper > lower)) volume_inside = volume_in_box(shape, 0.5_wp*(lower + upper), upper - lower, &
      halvings(mesh%dimensions))
  end function volume_inside

  function dimensions_of(shape) result(text)
    type(filled_shape), intent(in) :: shape
    character(:), allocatable :: text
    select case (shape%kind)
    case (shape_sphere); text = ', radius '//str(shape%radius)
    case (shape_cylinder); text = ', radius '//str(shape%radius)//', length '//str(norm2(shape%end - shape%start))
    case default
      text = ', edges '//str(shape%upper(1) - shape%lower(1))//' '//str(shape%upper(2) - shape%lower(2))//' '// &
        str(shape%upper(3) - shape%lower(3))
    end select
  end function dimensions_of

  !> The surroundings: the last region that fills all, else the first region.
  subroutine set_ambient(mesh, deck, flow, filling, density, pressure)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(flow_type), intent(inout) :: flow
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: density(:), pressure(:)
    real(wp) :: share(size(filling))
    integer :: i, last
    if (size(deck%region) == 0) return
    last = 1
    do i = 1, size(deck%region)
      if (lowercase(trim(deck%region(i)%shape)) == 'all') last = i
    end do
    share = 0
    share(last) = 1
    flow%ambient = settled_state(mesh, flow, mixed_cell(flow%layout, flow%eos, filling, share, flow%trace_fraction, density, &
      pressure))
  end subroutine set_ambient

  subroutine prepare_inflow(deck, flow, used, density, pressure)
    type(deck_type), intent(in) :: deck
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: used(:)
    real(wp), intent(in) :: density(:), pressure(:)
    real(wp), dimension(flow%n_materials) :: r, a
    integer :: k, m
    m = findloc(used, find_material(deck, deck%boundary%inflow_material), dim=1)
    if (m == 0) call fatal('boundary: an inflow face needs inflow_material', exit_bad_input)
    do k = 1, flow%n_materials
      r(k) = trace_density(flow%eos(k), density(k), pressure(k), deck%boundary%inflow_pressure)
    end do
    r(m) = deck%boundary%inflow_density
    if (.not. r(m) > 0) r(m) = deck%material(used(m))%density
    a = flow%trace_fraction
    a(m) = 1 - flow%trace_fraction*(flow%n_materials - 1)
    call set_inflow(flow, cell_from(flow%layout, flow%eos, r, a, &
      merge(deck%boundary%inflow_velocity, 0.0_wp, deck%boundary%inflow_velocity > unset), deck%boundary%inflow_pressure))
  end subroutine prepare_inflow

  !> The limiter takes velocity differences below 1e-8 of the smallest sound speed as noise; other variables must stay
  !> positive down to traces and have no noise level.
  subroutine set_noise(mesh, flow)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    real(wp) :: slowest, nothing(0)
    integer :: b, c
    c = flow%layout%sound_speed_row
    slowest = huge(1.0_wp)
    associate (n => mesh%brick_cells)
      do b = 1, mesh%n_local
        slowest = min(slowest, minval(flow%w(flow%holder(b), flow%current)%a(1:n(1), c, 1:n(2), 1:n(3))))
      end do
    end associate
    call reduce_min(slowest, nothing)
    flow%eps2(flow%layout%velocity_row:flow%layout%velocity_row + 2) = (1e-8_wp*slowest)**2
  end subroutine set_noise

end module flow_initial
