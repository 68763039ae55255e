!> Fragments: what of the solid still hangs together.
!>
!> Sound particles (damage below a bound, no fluids) of one body hang together where they are nearer than `reach` times the mean of
!> their spacings at rest, whatever bricks and ranks they are in; a fragment is all that hangs together so. Each brick finds
!> its parts of fragments and their sums; the root joins the parts across the borders of bricks. Sums run by particle in each brick
!> and then over bricks along the curve, so every figure has the same bits on any number of ranks.
module fragments
  use constants, only: pi
  use kinds, only: wp
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_DOUBLE_PRECISION, MPI_Gather, MPI_Gatherv, MPI_INTEGER, MPI_MAX, MPI_Scatterv
  use parallel, only: is_root, n_ranks, world
  use particle_links, only: point_set, link_points, number_groups
  use particles, only: at_position, at_velocity, at_mass, at_damage
  use reductions, only: reduce_sum
  use solid_material, only: model_fluid
  use solid_state, only: solid_type, sum_by_material
  implicit none
  private
  public :: find_fragments

  !> One fragment, in the units of the deck.
  type, public :: fragment_type
    integer :: body = 0
    integer :: particles = 0
    integer :: first_id = 0 !< least number of its particles
    real(wp) :: mass = 0
    real(wp) :: volume = 0 !< at rest
    real(wp) :: position(3) = 0 !< of the centre of mass
    real(wp) :: velocity(3) = 0 !< of the centre of mass
    real(wp) :: spin(3) = 0 !< angular momentum about the centre of mass
    real(wp) :: kinetic_energy = 0
    real(wp) :: lower(3) = 0, upper(3) = 0 !< box around its particles
    real(wp) :: spacing = 0 !< mean spacing of its particles at rest
    real(wp) :: diameter = 0 !< of the sphere (disc, length) of the same volume at rest
    real(wp), allocatable :: material_mass(:) !< by material
  end type fragment_type

  type, public :: fragment_list
    type(fragment_type), allocatable :: fragment(:) !< the heaviest first; size 0 but on the root
    real(wp) :: loose_mass = 0 !< of the particles that belong to none
    integer :: loose = 0 !< their number
  end type fragment_list

  ! sums of a part; behind them the mass by set
  integer, parameter :: at_count = 1, at_sum_mass = 2, at_sum_volume = 3, at_moment = 4, at_momentum = 7, at_angular = 10, &
    at_kinetic = 13, at_lower = 14, at_upper = 17, at_body = 20, at_id = 21, n_sums = 21
  integer, parameter :: width = 6 !< numbers of a particle at a border: position, spacing, body, part

  !> Parts of fragments of the local bricks, brick after brick, and their particles at the borders of bricks.
  type :: parts_type
    integer :: n = 0, n_border = 0
    real(wp), allocatable :: sums(:, :) !< (n_sums + sets, n)
    real(wp), allocatable :: border(:, :) !< (width, n_border)
  end type parts_type

contains

  !> To be called by all ranks. bound: particles of at least this damage belong to no fragment. label: fragment of each particle of
  !> this rank, brick after brick and set after set, 0 for none.
  subroutine find_fragments(mesh, solid, reach, bound, list, label)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    real(wp), intent(in) :: reach, bound
    type(fragment_list), intent(out) :: list
    integer, allocatable, intent(out) :: label(:)
    type(parts_type) :: parts
    integer, allocatable :: number(:)
    real(wp) :: largest, loose(2, mesh%n_local), total(2)
    integer :: b, place, i
    largest = largest_spacing(mesh, solid)
    allocate (label(sum(solid%block%n)), source=0)
    allocate (parts%sums(n_sums + solid%n_sets, 0), parts%border(width, 0))
    place = 0
    do b = 1, mesh%n_local
      call find_parts(mesh, solid, b, reach, largest, bound, parts, label(place + 1:place + sum(solid%block(:, b)%n)), loose(:, b))
      place = place + sum(solid%block(:, b)%n)
    end do
    call reduce_sum(mesh, loose, total)
    list%loose = nint(total(1))
    list%loose_mass = total(2)
    call join_parts(mesh, solid%n_sets, reach, largest, parts, list, number)
    do i = 1, size(label)
      if (label(i) > 0) label(i) = number(label(i))
    end do
    if (.not. allocated(list%fragment)) return
    do i = 1, size(list%fragment)
      list%fragment(i)%material_mass = sum_by_material(solid, list%fragment(i)%material_mass)
    end do
  end subroutine find_fragments

  !> The largest spacing at rest of all particles.
  real(wp) function largest_spacing(mesh, solid) result(largest)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    real(wp) :: mine
    integer :: b, set
    mine = tiny(1.0_wp)
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          if (blk%n > 0) mine = max(mine, rest_spacing(mesh, maxval(blk%f(:blk%n, at_mass))/solid%material(set)%density))
        end associate
      end do
    end do
    call MPI_Allreduce(mine, largest, 1, MPI_DOUBLE_PRECISION, MPI_MAX, world)
  end function largest_spacing

  elemental real(wp) function rest_spacing(mesh, volume)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: volume
    rest_spacing = volume**(1.0_wp/mesh%dimensions)
  end function rest_spacing

  !> Adds the parts of one brick. label: part of each of its particles; loose: number and mass of those without.
  subroutine find_parts(mesh, solid, b, reach, largest, bound, parts, label, loose)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: reach, largest, bound
    type(parts_type), intent(inout) :: parts
    integer, intent(out) :: label(:)
    real(wp), intent(out) :: loose(2)
    type(point_set) :: points
    integer, allocatable :: parent(:), number(:), set_of(:), index(:)
    real(wp), allocatable :: sums(:, :)
    integer :: set, i, place, n, n_parts
    n = size(label)
    label = 0
    loose = 0
    allocate (points%position(3, n), points%size(n), points%kind(n), points%member(n), set_of(n), index(n))
    place = 0
    do set = 1, solid%n_sets
      associate (blk => solid%block(set, b), m => solid%material(set))
        do i = 1, blk%n
          place = place + 1
          if (m%model == model_fluid) cycle
          if (blk%f(i, at_damage) >= bound) then
            loose = loose + [1.0_wp, blk%f(i, at_mass)]
            cycle
          end if
          points%n = points%n + 1
          label(place) = points%n
          points%position(:, points%n) = blk%f(i, at_position:at_position + 2)
          points%size(points%n) = rest_spacing(mesh, blk%f(i, at_mass)/m%density)
          points%kind(points%n) = blk%body(i)
          points%member(points%n) = points%n
          set_of(points%n) = set
          index(points%n) = i
        end do
      end associate
    end do
    parent = [(i, i=1, points%n)]
    call link_points(points, mesh%active, reach, largest, parent)
    allocate (number(points%n))
    call number_groups(parent, number, n_parts)
    allocate (sums(n_sums + solid%n_sets, n_parts), source=0.0_wp)
    do i = 1, points%n
      associate (blk => solid%block(set_of(i), b))
        call add_particle(blk%f(index(i), :), solid%material(set_of(i))%density, set_of(i), blk%body(index(i)), &
          blk%id(index(i)), sums(:, number(i)))
      end associate
    end do
    call add_border(mesh, b, reach*largest, points, parts%n + number, parts)
    where (label > 0) label = parts%n + number(max(label, 1))
    parts%sums = reshape([parts%sums, sums], [size(sums, 1), parts%n + n_parts])
    parts%n = parts%n + n_parts
  end subroutine find_parts

  pure subroutine add_particle(f, density, set, body, id, sums)
    real(wp), intent(in) :: f(:), density
    integer, intent(in) :: set, body, id
    real(wp), intent(inout) :: sums(:)
    real(wp) :: x(3), v(3), m
    x = f(at_position:at_position + 2)
    v = f(at_velocity:at_velocity + 2)
    m = f(at_mass)
    if (sums(at_count) <= 0) then
      sums(at_lower:at_lower + 2) = x
      sums(at_upper:at_upper + 2) = x
      sums(at_body) = body
      sums(at_id) = id
    end if
    sums(at_count) = sums(at_count) + 1
    sums(at_sum_mass) = sums(at_sum_mass) + m
    sums(at_sum_volume) = sums(at_sum_volume) + m/density
    sums(at_moment:at_moment + 2) = sums(at_moment:at_moment + 2) + m*x
    sums(at_momentum:at_momentum + 2) = sums(at_momentum:at_momentum + 2) + m*v
    sums(at_angular:at_angular + 2) = sums(at_angular:at_angular + 2) + m*cross(x, v)
    sums(at_kinetic) = sums(at_kinetic) + 0.5_wp*m*dot_product(v, v)
    sums(at_lower:at_lower + 2) = min(sums(at_lower:at_lower + 2), x)
    sums(at_upper:at_upper + 2) = max(sums(at_upper:at_upper + 2), x)
    sums(at_id) = min(sums(at_id), real(id, wp))
    sums(n_sums + set) = sums(n_sums + set) + m
  end subroutine add_particle

  pure function cross(a, b) result(c)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: c(3)
    c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross

  !> Notes the particles that may be linked to one in another brick: those within the distance of a face that has something behind it.
  subroutine add_border(mesh, b, distance, points, part, parts)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b, part(:)
    real(wp), intent(in) :: distance
    type(point_set), intent(in) :: points
    type(parts_type), intent(inout) :: parts
    real(wp) :: border(width, points%n), low(3), high(3)
    integer :: i, n
    n = 0
    associate (brick => mesh%brick(mesh%local(b)))
      low = merge(brick%origin + distance, -huge(1.0_wp), mesh%active .and. .not. brick%at_low)
      high = merge(brick%origin + mesh%brick_cells*mesh%spacing - distance, huge(1.0_wp), mesh%active .and. .not. brick%at_high)
    end associate
    do i = 1, points%n
      if (all(points%position(:, i) > low .and. points%position(:, i) < high)) cycle
      n = n + 1
      border(:, n) = [points%position(:, i), points%size(i), real(points%kind(i), wp), real(part(i), wp)]
    end do
    parts%border = reshape([parts%border, border(:, :n)], [width, parts%n_border + n])
    parts%n_border = parts%n_border + n
  end subroutine add_border

  !> Joins parts across bricks on the root. number: fragment of each part of this rank.
  subroutine join_parts(mesh, n_sets, reach, largest, parts, list, number)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: n_sets
    real(wp), intent(in) :: reach, largest
    type(parts_type), intent(in) :: parts
    type(fragment_list), intent(inout) :: list
    integer, allocatable, intent(out) :: number(:)
    real(wp), allocatable :: sums(:, :), border(:, :)
    integer, allocatable :: parent(:), group(:), all_numbers(:)
    integer :: n_parts(0:n_ranks - 1), n_border(0:n_ranks - 1), offset(0:n_ranks - 1), n_groups, r, i, first
    call gather_columns(parts%sums, sums, n_parts)
    call gather_columns(parts%border, border, n_border)
    allocate (number(parts%n), group(size(sums, 2)), all_numbers(size(sums, 2)), list%fragment(0))
    offset = [(sum(n_parts(:r - 1)), r=0, n_ranks - 1)]
    if (is_root()) then
      first = 0
      do r = 0, n_ranks - 1
        border(width, first + 1:first + n_border(r)) = border(width, first + 1:first + n_border(r)) + offset(r)
        first = first + n_border(r)
      end do
      parent = [(i, i=1, size(sums, 2))]
      call link_points(border_points(mesh, reach*largest, border), mesh%active, reach, largest, parent)
      call number_groups(parent, group, n_groups)
      call make_list(mesh, n_sets, sums, group, n_groups, list, all_numbers)
    end if
    call MPI_Scatterv(all_numbers, n_parts, offset, MPI_INTEGER, number, parts%n, MPI_INTEGER, 0, world)
  end subroutine join_parts

  !> Columns of all ranks, in their order, on the root; counts: of each rank, on the root.
  subroutine gather_columns(mine, all_columns, counts)
    real(wp), intent(in) :: mine(:, :)
    real(wp), allocatable, intent(out) :: all_columns(:, :)
    integer, intent(out) :: counts(0:)
    integer :: offsets(0:n_ranks - 1), r
    counts = 0
    call MPI_Gather(size(mine, 2), 1, MPI_INTEGER, counts, 1, MPI_INTEGER, 0, world)
    offsets = [(size(mine, 1)*sum(counts(:r - 1)), r=0, n_ranks - 1)]
    allocate (all_columns(size(mine, 1), sum(counts)))
    call MPI_Gatherv(mine, size(mine), MPI_DOUBLE_PRECISION, all_columns, size(mine, 1)*counts, offsets, MPI_DOUBLE_PRECISION, &
      0, world)
  end subroutine gather_columns

  !> The particles at borders as points that stand for their parts; those at a low periodic face also beyond the high one.
  pure function border_points(mesh, distance, border) result(points)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: distance, border(:, :)
    type(point_set) :: points
    integer :: pass, i, image, d
    logical :: there
    do pass = 1, 2
      points%n = 0
      do i = 1, size(border, 2)
        do image = 0, 7
          there = .true.
          do d = 1, 3
            if (btest(image, d - 1)) there = there .and. mesh%periodic(d) .and. border(d, i) < mesh%lower(d) + distance
          end do
          if (.not. there) cycle
          points%n = points%n + 1
          if (pass == 1) cycle
          points%position(:, points%n) = border(1:3, i)
          do d = 1, 3
            if (btest(image, d - 1)) points%position(d, points%n) = border(d, i) + (mesh%upper(d) - mesh%lower(d))
          end do
          points%size(points%n) = border(4, i)
          points%kind(points%n) = nint(border(5, i))
          points%member(points%n) = nint(border(6, i))
        end do
      end do
      if (pass == 1) allocate (points%position(3, points%n), points%size(points%n), points%kind(points%n), points%member(points%n))
    end do
  end function border_points

  !> Fragments from the sums of their parts, the heaviest first and of equals that with the least particle number.
  subroutine make_list(mesh, n_sets, sums, group, n_groups, list, number)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: n_sets, group(:), n_groups
    real(wp), intent(in) :: sums(:, :)
    type(fragment_list), intent(inout) :: list
    integer, intent(out) :: number(:)
    real(wp) :: total(size(sums, 1), n_groups)
    integer :: order(n_groups), place(n_groups), i, g
    total = 0
    do i = 1, size(group)
      g = group(i)
      if (total(at_count, g) <= 0) then
        total(:, g) = sums(:, i)
        cycle
      end if
      total(at_lower:at_lower + 2, g) = min(total(at_lower:at_lower + 2, g), sums(at_lower:at_lower + 2, i))
      total(at_upper:at_upper + 2, g) = max(total(at_upper:at_upper + 2, g), sums(at_upper:at_upper + 2, i))
      total(at_id, g) = min(total(at_id, g), sums(at_id, i))
      total(:at_lower - 1, g) = total(:at_lower - 1, g) + sums(:at_lower - 1, i)
      total(n_sums + 1:, g) = total(n_sums + 1:, g) + sums(n_sums + 1:, i)
    end do
    order = [(i, i=1, n_groups)]
    call sort_by_mass(total(at_sum_mass, :), total(at_id, :), order)
    place(order) = [(i, i=1, n_groups)]
    number = place(group)
    deallocate (list%fragment)
    allocate (list%fragment(n_groups))
    do i = 1, n_groups
      list%fragment(i) = fragment_of(mesh, n_sets, total(:, order(i)))
    end do
  end subroutine make_list

  pure function fragment_of(mesh, n_sets, total) result(fragment)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: n_sets
    real(wp), intent(in) :: total(:)
    type(fragment_type) :: fragment
    fragment%body = nint(total(at_body))
    fragment%particles = nint(total(at_count))
    fragment%first_id = nint(total(at_id))
    fragment%mass = total(at_sum_mass)
    fragment%volume = total(at_sum_volume)
    fragment%position = total(at_moment:at_moment + 2)/fragment%mass
    fragment%velocity = total(at_momentum:at_momentum + 2)/fragment%mass
    fragment%spin = total(at_angular:at_angular + 2) - fragment%mass*cross(fragment%position, fragment%velocity)
    fragment%kinetic_energy = total(at_kinetic)
    fragment%lower = total(at_lower:at_lower + 2)
    fragment%upper = total(at_upper:at_upper + 2)
    fragment%material_mass = total(n_sums + 1:n_sums + n_sets)
    fragment%spacing = rest_spacing(mesh, fragment%volume/fragment%particles)
    fragment%diameter = fragment%volume
    if (mesh%dimensions == 2) fragment%diameter = sqrt(4*fragment%volume/pi)
    if (mesh%dimensions == 3) fragment%diameter = (6*fragment%volume/pi)**(1.0_wp/3)
  end function fragment_of

  !> Heap sort of the order: falling mass, rising id.
  subroutine sort_by_mass(mass, id, order)
    real(wp), intent(in) :: mass(:), id(:)
    integer, intent(inout) :: order(:)
    integer :: n, last, kept
    n = size(order)
    do last = n/2, 1, -1
      call sift(last, n)
    end do
    do last = n, 2, -1
      kept = order(1)
      order(1) = order(last)
      order(last) = kept
      call sift(1, last - 1)
    end do

  contains

    pure logical function comes_before(i, j)
      integer, intent(in) :: i, j
      comes_before = mass(i) > mass(j)
      if (.not. mass(i) > mass(j) .and. .not. mass(i) < mass(j)) comes_before = id(i) < id(j)
    end function comes_before

    subroutine sift(start, finish)
      integer, intent(in) :: start, finish
      integer :: root, child, kept
      root = start
      do while (2*root <= finish)
        child = 2*root
        if (child < finish) then
          if (comes_before(order(child), order(child + 1))) child = child + 1
        end if
        if (.not. comes_before(order(root), order(child))) exit
        kept = order(root)
        order(root) = order(child)
        order(child) = kept
        root = child
      end do
    end subroutine sift

  end subroutine sort_by_mass

end module fragments
