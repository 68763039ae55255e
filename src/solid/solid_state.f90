!> The state of the solid on this rank: particles by set (material) and brick, node fields, supports, books.
module solid_state
  use blocks, only: block, allocate_nodes, allocate_cells
  use halo, only: last_node
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: particle_block, sort_space
  use rigid_motion, only: rigid_body
  use solid_material, only: solid_material_type
  use cell_functions, only: cell_frame
  implicit none
  private
  public :: frame_of, n_cells_of, cell_coordinate, brick_particles, field_particles, match_nodes, materials_of_sets, &
    material_names, sum_by_material

  !> When the stress is updated: with the velocities that start the step (USF), that end it (USL), or that are mapped back from the
  !> particles at its end (MUSL).
  integer, parameter, public :: scheme_musl = 1, scheme_usl = 2, scheme_usf = 3

  !> What a face of the domain does to the solid.
  integer, parameter, public :: face_free = 0, face_symmetry = 1, face_clamped = 2

  !> Impulses are booked by support: domain faces x low, x high, y low ... z high as 1..6, clamps as 7.
  integer, parameter, public :: n_supports = 7
  integer, parameter, public :: book_impulse = 1 !< first of 3*n_supports: impulse of each support on the solid
  integer, parameter, public :: book_coupling_impulse = 22 !< first of 3: impulse of the coupling force
  integer, parameter, public :: book_coupling_work = 25 !< work of the coupling force on the solid
  integer, parameter, public :: book_lost_mass = 26 !< of particles that left the domain
  integer, parameter, public :: book_lost_momentum = 27 !< first of 3
  integer, parameter, public :: book_lost_kinetic = 30, book_lost_internal = 31
  integer, parameter, public :: book_lost_count = 32
  integer, parameter, public :: book_gravity_impulse = 33 !< first of 3
  integer, parameter, public :: n_books = 35 !< contact adds n_contact_books for each pair
  integer, parameter, public :: book_contact_impulse = 1 !< first of 3 behind n_books: impulse on the first field of a pair
  integer, parameter, public :: book_contact_work = 4 !< likewise: work of a pair's friction, lost to the motion
  integer, parameter, public :: n_contact_books = 4

  !> A velocity component of a node that is held at zero.
  type, public :: held_type
    integer :: node(3) = 0 !< indices in the brick, from 0
    integer :: direction = 0
    integer :: support = 0 !< 1..n_supports
  end type held_type

  !> All that holds nodes of one brick.
  type, public :: support_list
    type(held_type), allocatable :: held(:)
    real(wp) :: total_mass = 0 !< of the brick's particles
    real(wp) :: mass(3, n_supports) = 0 !< this brick's part of the mass held, by component and support
    real(wp) :: momentum(3, n_supports) = 0 !< likewise, momentum before it was held
  end type support_list

  !> A box in which nodes are clamped.
  type, public :: clamp_box
    real(wp) :: lower(3) = 0, upper(3) = 0
    logical :: fixed(3) = .true.
  end type clamp_box

  !> The fastest signal of the particles: what limits the time step.
  type, public :: limit_type
    real(wp) :: signal = 0 !< c + |v|
    integer :: index = 0 !< of the particle in its block
  end type limit_type

  integer, parameter, public :: contact_open = 0, contact_slip = 1, contact_stick = 2

  !> Two velocity fields that touch with friction.
  type, public :: contact_pair
    integer :: field(2) = 0
    real(wp) :: friction = 0
    character(64) :: name = '' !< of their bodies, for people
  end type contact_pair

  !> Nodes of a brick that two fields or more share, and what lies around them. See module contact_surfaces.
  type, public :: contact_nodes
    integer, allocatable :: node(:, :) !< (3, n) indices in the brick, from 0
    real(wp), allocatable :: share(:, :) !< (field, n) this brick's part of the volume
    real(wp), allocatable :: normal(:, :, :) !< (3, pair, n) from the first field to the second
    integer, allocatable :: state(:, :) !< (pair, n) what the contact did in this step: contact_open, contact_slip, contact_stick
  end type contact_nodes

  type, public :: solid_type
    logical :: present = .false. !< the scene has a solid
    integer :: n_sets = 0
    type(solid_material_type), allocatable :: material(:) !< of each set
    integer, allocatable :: material_of_set(:) !< sets of one material that are in several fields have the same number
    integer :: n_bodies = 0
    character(64), allocatable :: body_name(:)
    integer :: n_particles = 0 !< in the scene at the start
    type(particle_block), allocatable :: block(:, :) !< (set, local brick)
    integer :: n_fields = 1 !< velocity fields: sets of the same field stick together
    integer, allocatable :: field_of_set(:)
    integer :: rigid_field = 0 !< that of the rigid bodies, 0: there are none
    type(rigid_body), allocatable :: rigid(:)
    integer, allocatable :: rigid_of_body(:) !< index in rigid of each body, 0: not rigid
    type(block), allocatable :: node(:, :) !< (field, local brick) mass and velocity of nodes (4); unallocated: no particles
    type(block), allocatable :: force(:, :) !< force, later velocity change of the nodes (3)
    type(block), allocatable :: mapped(:, :) !< velocity that strains the particles (3)
    type(contact_pair), allocatable :: pair(:) !< fields that touch; the others stick where they meet. Unallocated: none touch
    type(block), allocatable :: surface(:, :) !< (field, local brick) with contact: see module contact_surfaces (7)
    type(contact_nodes), allocatable :: meeting(:) !< by local brick, with contact
    type(block), allocatable :: count(:) !< particles of all sets per cell (1, no ghosts)
    type(support_list), allocatable :: support(:) !< by local brick
    type(limit_type), allocatable :: limit(:, :) !< (set, local brick)
    real(wp), allocatable :: books(:, :) !< (n_books, local brick), summed since the start
    type(sort_space) :: space !< scratch of the sorts
    integer :: face(2, 3) = face_free !< what the low and high faces do
    type(clamp_box), allocatable :: clamp(:)
    real(wp) :: cfl = 0.5_wp
    real(wp) :: gravity(3) = 0
    integer :: order = 1 !< of the functions: 1 linear, 2 quadratic; also the layers of nodes that neighbours share
    integer :: scheme = scheme_musl
    real(wp) :: flip = 1 !< part of FLIP, the rest is PIC; 0 with APIC
    integer, allocatable :: at_affine(:) !< by set: first of 9 columns of the affine matrix dv_i/dx_j, row by row; 0 without APIC
    integer, allocatable :: at_load(:) !< by set: first column of the loads that its particles have felt; unallocated: not asked for
    integer, allocatable :: at_force(:) !< by set: first of 3 columns of the force from outside on each particle; 0: no such columns
    real(wp) :: load_left = 0 !< time over which those forces are still to act
    integer :: step = 0 !< of the scene, for messages
    real(wp) :: time = 0 !< likewise
    character(:), allocatable :: limiter !< what limits the time step, likewise
  end type solid_type

contains

  !> Where the cells of a local brick lie.
  pure function frame_of(mesh, order, local) result(frame)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: order !< of the functions
    integer, intent(in) :: local
    type(cell_frame) :: frame
    frame%lower = mesh%lower
    frame%inverse = 1/mesh%spacing
    frame%offset = mesh%brick(mesh%local(local))%location*mesh%brick_cells
    frame%n = mesh%brick_cells
    frame%order = order
    frame%last = last_node(mesh, order)
    frame%active = mesh%active
    frame%at_low = mesh%brick(mesh%local(local))%at_low
    frame%at_high = mesh%brick(mesh%local(local))%at_high
  end function frame_of

  pure integer function n_cells_of(mesh)
    type(mesh_type), intent(in) :: mesh
    n_cells_of = product(mesh%brick_cells)
  end function n_cells_of

  !> Coordinate of the cell that holds position x in direction d, from 0, not limited to the domain.
  pure integer function cell_coordinate(mesh, d, x)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: d
    real(wp), intent(in) :: x
    cell_coordinate = floor((x - mesh%lower(d))*(1/mesh%spacing(d)))
  end function cell_coordinate

  !> Particles of all sets in a local brick.
  pure integer function brick_particles(solid, local) result(n)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: local
    n = sum(solid%block(:, local)%n)
  end function brick_particles

  !> Particles of all sets of one velocity field in a local brick.
  pure integer function field_particles(solid, field, local) result(n)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: field, local
    n = sum(solid%block(:, local)%n, mask=solid%field_of_set == field)
  end function field_particles

  !> Number of the material of each set, counted in the order of the sets.
  pure function materials_of_sets(solid) result(material)
    type(solid_type), intent(in) :: solid
    integer, allocatable :: material(:)
    integer :: set
    if (allocated(solid%material_of_set)) then
      material = solid%material_of_set
    else
      material = [(set, set=1, solid%n_sets)]
    end if
  end function materials_of_sets

  !> Name of each material, each once.
  pure function material_names(solid) result(name)
    type(solid_type), intent(in) :: solid
    character(len(solid%material%name)), allocatable :: name(:)
    integer :: material(solid%n_sets), m
    material = materials_of_sets(solid)
    name = [(solid%material(findloc(material, m, dim=1))%name, m=1, maxval(material))]
  end function material_names

  !> Values of the sets, summed over those of one material.
  pure function sum_by_material(solid, values) result(total)
    type(solid_type), intent(in) :: solid
    real(wp), intent(in) :: values(:) !< by set
    real(wp), allocatable :: total(:)
    integer :: material(solid%n_sets), set
    material = materials_of_sets(solid)
    allocate (total(maxval(material)), source=0.0_wp)
    do set = 1, solid%n_sets
      total(material(set)) = total(material(set)) + values(set)
    end do
  end function sum_by_material

  !> Node and count arrays exist exactly where there are particles; with contact, those of all fields where there are any.
  subroutine match_nodes(mesh, solid)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, parameter :: no_ghosts(3) = 0
    integer :: b, field, last(3)
    logical :: needed
    last = last_node(mesh, solid%order)
    do b = 1, mesh%n_local
      do field = 1, solid%n_fields
        needed = field_particles(solid, field, b) > 0
        if (allocated(solid%pair)) needed = brick_particles(solid, b) > 0
        if (needed) then
          if (allocated(solid%node(field, b)%a)) cycle
          call allocate_nodes(solid%node(field, b), last, 4)
          call allocate_nodes(solid%force(field, b), last, 3)
          call allocate_nodes(solid%mapped(field, b), last, 3)
          if (allocated(solid%pair)) call allocate_nodes(solid%surface(field, b), last, 7)
        else if (allocated(solid%node(field, b)%a)) then
          deallocate (solid%node(field, b)%a, solid%force(field, b)%a, solid%mapped(field, b)%a)
          if (allocated(solid%pair)) deallocate (solid%surface(field, b)%a)
        end if
      end do
      if (brick_particles(solid, b) == 0) then
        if (allocated(solid%count(b)%a)) deallocate (solid%count(b)%a)
      else if (.not. allocated(solid%count(b)%a)) then
        call allocate_cells(solid%count(b), mesh%brick_cells, no_ghosts, 1, 0.0_wp)
      end if
    end do
  end subroutine match_nodes

end module solid_state
