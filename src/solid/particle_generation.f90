!> Fills shapes with particles on lattices and gives each particle to the brick that holds it.
!>
!> Every rank walks the same lattices in the same order, so numbers are the same on any number of ranks. Volumes are scaled by one
!> factor per shape, so that its mass is density times its volume, whatever the lattice caught of it.
module particle_generation
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress, at_energy, append_particle, sort_particles
  use solid_shapes, only: shape_type, remaining_volume
  use solid_state, only: solid_type, cell_coordinate
  use text, only: str
  implicit none
  private
  public :: body_lattice, bar_lattice, generate_particles, table_bricks, place_particle, sort_solid

  !> Points origin + sum (i_d - 1/2) step_d axis_d, i_d = 1..n_d.
  type, public :: lattice_type
    real(wp) :: origin(3) = 0
    real(wp) :: axis(3, 3) = 0 !< unit vectors in columns
    real(wp) :: step(3) = 1
    integer :: n(3) = 0
    logical :: aligned = .true. !< the axes are coordinate directions
  end type lattice_type

  !> One shape to be filled, what is cut out of it, and what its particles are made of.
  type, public :: piece_type
    character(64) :: name = ''
    type(shape_type) :: shape
    type(shape_type), allocatable :: cut(:)
    type(lattice_type) :: lattice
    integer :: set = 0, body = 0
    real(wp) :: velocity(3) = 0 !< at the origin of the domain's coordinates
    real(wp) :: velocity_gradient(3) = 0 !< diagonal of the gradient
    real(wp) :: pressure = 0 !< at the start
    real(wp) :: energy = 0 !< per mass, at the start
    integer :: count = 0 !< particles made
    real(wp) :: volume = 0 !< of the shape in the domain without what is cut out
    real(wp) :: scale = 1 !< volume of a particle over that of its lattice cell
  end type piece_type

contains

  !> The lattice of a body: it fits the shape's bounding box in the domain, with the spacing nearest to the one asked for.
  pure function body_lattice(mesh, shape, spacing) result(lattice)
    type(mesh_type), intent(in) :: mesh
    type(shape_type), intent(in) :: shape
    real(wp), intent(in) :: spacing
    type(lattice_type) :: lattice
    real(wp) :: low(3), high(3)
    integer :: d
    low = merge(max(mesh%lower, shape%lower), mesh%lower, mesh%active)
    high = merge(min(mesh%upper, shape%upper), mesh%upper, mesh%active)
    if (any(high <= low)) return
    lattice%n = merge(max(1, nint((high - low)/spacing)), 1, mesh%active)
    lattice%origin = low
    lattice%step = (high - low)/lattice%n
    do d = 1, 3
      lattice%axis(d, d) = 1
    end do
  end function body_lattice

  !> The lattice of a bar: along its axis, and square across it.
  pure function bar_lattice(mesh, shape, spacing) result(lattice)
    type(mesh_type), intent(in) :: mesh
    type(shape_type), intent(in) :: shape
    real(wp), intent(in) :: spacing
    type(lattice_type) :: lattice
    real(wp) :: first(3)
    integer :: d, across
    if (shape%endless .or. mesh%dimensions == 1) then
      lattice = body_lattice(mesh, shape, spacing)
      return
    end if
    lattice%axis(:, 3) = shape%axis
    first = 0
    if (mesh%dimensions == 2) then
      first(findloc(mesh%active, .false., dim=1)) = 1
    else
      across = minloc(abs(shape%axis), dim=1)
      first(across) = 1
      first = first - shape%axis(across)*shape%axis
      first = first/norm2(first)
    end if
    lattice%axis(:, 2) = first
    lattice%axis(:, 1) = cross_product(first, shape%axis)
    lattice%n = [nint(2*shape%radius/spacing), nint(2*shape%radius/spacing), nint(shape%length/spacing)]
    if (mesh%dimensions == 2) lattice%n(2) = 1
    lattice%n = max(lattice%n, 1)
    lattice%step = [2*shape%radius, 2*shape%radius, shape%length]/lattice%n
    if (mesh%dimensions == 2) lattice%step(2) = 1
    lattice%origin = shape%center - shape%radius*lattice%axis(:, 1)
    if (mesh%dimensions == 3) lattice%origin = lattice%origin - shape%radius*lattice%axis(:, 2)
    lattice%aligned = .true.
    do d = 1, 3
      lattice%aligned = lattice%aligned .and. count(abs(lattice%axis(:, d)) > 1e-12_wp) == 1
    end do
  end function bar_lattice

  pure function cross_product(a, b) result(c)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: c(3)
    c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross_product

  !> Makes the particles of all pieces. The sets of solid must be there and empty; on return they are sorted.
  subroutine generate_particles(mesh, solid, pieces)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(piece_type), intent(inout) :: pieces(:)
    integer, allocatable :: local_at(:, :, :)
    integer :: i, id
    real(wp) :: caught
    call table_bricks(mesh, local_at)
    id = 0
    do i = 1, size(pieces)
      call fill_piece(mesh, solid, pieces(i), local_at, .false., id, caught)
      if (pieces(i)%count == 0) call fatal("body '"//trim(pieces(i)%name)// &
        "': no particle lies in it; it is outside the domain, "// &
        'covered by other shapes, or thinner than its spacing', exit_bad_input)
      pieces(i)%volume = remaining_volume(pieces(i)%shape, pieces(i)%cut, mesh%lower, mesh%upper, minval(pieces(i)%lattice%step))
      pieces(i)%scale = pieces(i)%volume/caught
      call fill_piece(mesh, solid, pieces(i), local_at, .true., id, caught)
    end do
    solid%n_particles = id
    call sort_solid(solid)
  end subroutine generate_particles

  !> Local index of the brick at each place of the domain, 0 where another rank owns it.
  subroutine table_bricks(mesh, local_at)
    type(mesh_type), intent(in) :: mesh
    integer, allocatable, intent(out) :: local_at(:, :, :)
    integer :: b
    allocate (local_at(0:mesh%bricks(1) - 1, 0:mesh%bricks(2) - 1, 0:mesh%bricks(3) - 1), source=0)
    do b = 1, mesh%n_local
      associate (at => mesh%brick(mesh%local(b))%location)
        local_at(at(1), at(2), at(3)) = b
      end associate
    end do
  end subroutine table_bricks

  !> Puts a particle, all of its fields given, in the brick that holds its position; one of another rank is dropped.
  !> For generation and restart; sort_solid must follow. local_at: from table_bricks.
  subroutine place_particle(mesh, solid, local_at, set, id, body, fields)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: local_at(0:, 0:, 0:), set, id, body
    real(wp), intent(in) :: fields(:)
    integer :: cell(3), location(3), local, d
    do d = 1, 3
      cell(d) = min(max(cell_coordinate(mesh, d, fields(at_position + d - 1)), 0), mesh%cells(d) - 1)
    end do
    location = cell/mesh%brick_cells
    local = local_at(location(1), location(2), location(3))
    if (local == 0) return
    cell = cell - location*mesh%brick_cells
    call append_particle(solid%block(set, local), id, body, fields, &
      1 + cell(1) + mesh%brick_cells(1)*(cell(2) + mesh%brick_cells(2)*cell(3)))
  end subroutine place_particle

  !> Sorts all blocks after particles were placed.
  subroutine sort_solid(solid)
    type(solid_type), intent(inout) :: solid
    integer :: b, set
    do b = 1, size(solid%block, 2)
      do set = 1, solid%n_sets
        call sort_particles(solid%block(set, b), solid%space)
      end do
    end do
  end subroutine sort_solid

  !> Walks the lattice of one piece: counts points and sums the volume of their lattice cells, or makes the particles.
  subroutine fill_piece(mesh, solid, piece, local_at, make, id, caught)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(piece_type), intent(inout) :: piece
    integer, intent(in) :: local_at(0:, 0:, 0:)
    logical, intent(in) :: make
    integer, intent(inout) :: id
    real(wp), intent(out) :: caught
    real(wp) :: point(3), volume
    integer :: i, j, k
    logical :: inside
    caught = 0
    piece%count = 0
    associate (lattice => piece%lattice)
      do k = 1, lattice%n(3)
        do j = 1, lattice%n(2)
          do i = 1, lattice%n(1)
            point = lattice%origin + matmul(lattice%axis, ([i, j, k] - 0.5_wp)*lattice%step)
            if (.not. kept(piece, point)) cycle
            volume = product(lattice%step)
            call clip(mesh, lattice, point, volume, inside)
            if (.not. inside) cycle
            piece%count = piece%count + 1
            caught = caught + volume
            if (.not. make) cycle
            id = id + 1
            call make_particle(mesh, solid, piece, local_at, id, point, volume*piece%scale)
          end do
        end do
      end do
    end associate
  end subroutine fill_piece

  pure logical function kept(piece, point)
    type(piece_type), intent(in) :: piece
    real(wp), intent(in) :: point(3)
    integer :: c
    kept = piece%shape%holds(point)
    if (.not. kept) return
    do c = 1, size(piece%cut)
      if (piece%cut(c)%holds(point)) then
        kept = .false.
        return
      end if
    end do
  end function kept

  !> Cuts the lattice cell around a point at the faces of the domain; the point moves to the middle of what is left.
  pure subroutine clip(mesh, lattice, point, volume, inside)
    type(mesh_type), intent(in) :: mesh
    type(lattice_type), intent(in) :: lattice
    real(wp), intent(inout) :: point(3), volume
    logical, intent(out) :: inside
    real(wp) :: reach, low, high
    integer :: d
    inside = .true.
    do d = 1, 3
      if (.not. mesh%active(d)) then
        point(d) = 0.5_wp*(mesh%lower(d) + mesh%upper(d))
      else if (lattice%aligned) then
        reach = 0.5_wp*lattice%step(maxloc(abs(lattice%axis(d, :)), dim=1))
        if (point(d) - reach >= mesh%lower(d) .and. point(d) + reach <= mesh%upper(d)) cycle
        low = max(point(d) - reach, mesh%lower(d))
        high = min(point(d) + reach, mesh%upper(d))
        if (high - low <= 1e-6_wp*reach) inside = .false.
        if (high - low >= (2 - 1e-9_wp)*reach) cycle
        volume = volume*(high - low)/(2*reach)
        point(d) = 0.5_wp*(low + high)
      else if (point(d) < mesh%lower(d) .or. point(d) > mesh%upper(d)) then
        inside = .false.
      end if
    end do
  end subroutine clip

  subroutine make_particle(mesh, solid, piece, local_at, id, point, volume)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(piece_type), intent(in) :: piece
    integer, intent(in) :: local_at(0:, 0:, 0:), id
    real(wp), intent(in) :: point(3), volume
    real(wp) :: fields(solid%material(piece%set)%n_field)
    fields = 0
    fields(at_position:at_position + 2) = point
    fields(at_velocity:at_velocity + 2) = merge(piece%velocity + piece%velocity_gradient*point, 0.0_wp, mesh%active)
    fields(at_volume) = volume
    fields(at_mass) = solid%material(piece%set)%density*volume
    fields(at_stress:at_stress + 2) = -piece%pressure
    fields(at_energy) = piece%energy*fields(at_mass)
    call place_particle(mesh, solid, local_at, piece%set, id, piece%body, fields)
  end subroutine make_particle

end module particle_generation
