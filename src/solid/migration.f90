!> Particles that leave their brick: to another brick of this rank, to another rank, or out of the domain.
module migration
  use kinds, only: wp
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_DOUBLE_PRECISION, MPI_Get_count, MPI_Irecv, MPI_Isend, MPI_Probe, MPI_Recv, MPI_Request, MPI_Status, &
    MPI_STATUSES_IGNORE, MPI_STATUS_IGNORE, MPI_Waitall
  use parallel, only: world, my_rank => rank, n_ranks
  use particle_checks, only: in_reach, particle_error
  use particles, only: at_position, at_velocity, at_mass, at_energy, append_particle, note_moved, sort_particles, particle_block
  use solid_material, only: model_rigid
  use solid_state, only: solid_type, cell_coordinate, face_free, book_lost_mass, book_lost_momentum, book_lost_kinetic, &
    book_lost_internal, book_lost_count, book_coupling_impulse
  implicit none
  private
  public :: route_particle, exchange_particles

  integer, parameter :: tag = 21
  integer, parameter :: header = 5 !< set, brick, cell, id, body

  !> Particles on their way, one stream of numbers per rank they go to.
  type :: stream_type
    integer :: n = 0
    real(wp), allocatable :: a(:)
  end type stream_type

  type, public :: outbox_type
    private
    type(stream_type), allocatable :: stream(:) !< by rank, from 0
  end type outbox_type

contains

  !> Finds where particle index of a block belongs now and notes it; what leaves the brick goes to the outbox.
  !>
  !> Faces that are not free cannot be crossed: a particle there stays in the last cell. Periodic faces shift the position, from
  !> which the cell then follows, so that cells always follow from positions alone (after a restart as well).
  subroutine route_particle(mesh, solid, set, local, index, cell, outbox)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: set, local, index
    integer, intent(in) :: cell !< cell of the brick that it was in
    type(outbox_type), intent(inout) :: outbox
    integer :: global, location, local_cell(3), step(3), target, d, new_cell
    logical :: outside
    associate (blk => solid%block(set, local), brick => mesh%brick(mesh%local(local)))
      if (.not. in_reach(mesh, blk%f(index, at_position:at_position + 2))) &
        call particle_error(mesh, solid, set, local, index, 'is nowhere near the domain')
      outside = .false.
      do d = 1, 3
        if (mesh%periodic(d)) call wrap(mesh, d, blk%f(index, at_position + d - 1))
        global = cell_coordinate(mesh, d, blk%f(index, at_position + d - 1))
        if (global < 0) outside = outside .or. (solid%face(1, d) == face_free .and. mesh%active(d))
        if (global >= mesh%cells(d)) outside = outside .or. (solid%face(2, d) == face_free .and. mesh%active(d))
        global = min(max(global, 0), mesh%cells(d) - 1)
        location = global/mesh%brick_cells(d)
        local_cell(d) = global - location*mesh%brick_cells(d)
        step(d) = location - brick%location(d)
        if (mesh%periodic(d) .and. abs(step(d)) > 1) step(d) = step(d) - sign(mesh%bricks(d), step(d))
      end do
      if (outside) then
        call book_loss(blk%f(index, :), solid%material(set)%model == model_rigid, solid%books(:, local))
        if (solid%at_force(set) > 0) call book_rest(blk%f(index, solid%at_force(set):solid%at_force(set) + 2), solid%load_left, &
          solid%books(:, local))
        call note_moved(blk, index, 0)
        return
      end if
      if (any(abs(step) > 1)) call particle_error(mesh, solid, set, local, index, 'crossed a whole brick in one step')
      new_cell = 1 + local_cell(1) + mesh%brick_cells(1)*(local_cell(2) + mesh%brick_cells(2)*local_cell(3))
      if (all(step == 0)) then
        if (new_cell /= cell) call note_moved(blk, index, new_cell)
        return
      end if
      target = brick%neighbour(step(1), step(2), step(3))
      call pack_particle(mesh, blk, set, target, new_cell, index, outbox)
      call note_moved(blk, index, 0)
    end associate
  end subroutine route_particle

  !> Brings a position back into a periodic domain.
  pure subroutine wrap(mesh, d, x)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: d
    real(wp), intent(inout) :: x
    if (cell_coordinate(mesh, d, x) < 0) then
      x = x + (mesh%upper(d) - mesh%lower(d))
    else if (cell_coordinate(mesh, d, x) >= mesh%cells(d)) then
      x = x - (mesh%upper(d) - mesh%lower(d))
    end if
  end subroutine wrap

  !> rigid: the momentum is still that of the particle's body.
  subroutine book_loss(fields, rigid, books)
    real(wp), intent(in) :: fields(:)
    logical, intent(in) :: rigid
    real(wp), intent(inout) :: books(:)
    associate (m => fields(at_mass), v => fields(at_velocity:at_velocity + 2))
      books(book_lost_mass) = books(book_lost_mass) + m
      if (.not. rigid) books(book_lost_momentum:book_lost_momentum + 2) = books(book_lost_momentum:book_lost_momentum + 2) + m*v
      books(book_lost_kinetic) = books(book_lost_kinetic) + 0.5_wp*m*sum(v**2)
      books(book_lost_internal) = books(book_lost_internal) + fields(at_energy)
      books(book_lost_count) = books(book_lost_count) + 1
    end associate
  end subroutine book_loss

  !> What is left of the impulse of the force on a particle leaves with it.
  subroutine book_rest(force, load_left, books)
    real(wp), intent(in) :: force(3), load_left
    real(wp), intent(inout) :: books(:)
    associate (lost => books(book_lost_momentum:book_lost_momentum + 2), &
               given => books(book_coupling_impulse:book_coupling_impulse + 2))
      lost = lost + load_left*force
      given = given + load_left*force
    end associate
  end subroutine book_rest

  subroutine pack_particle(mesh, blk, set, target, cell, index, outbox)
    type(mesh_type), intent(in) :: mesh
    type(particle_block), intent(in) :: blk
    integer, intent(in) :: set, target, cell, index
    type(outbox_type), intent(inout) :: outbox
    real(wp), allocatable :: longer(:)
    integer :: n
    if (.not. allocated(outbox%stream)) allocate (outbox%stream(0:n_ranks - 1))
    n = header + size(blk%f, 2)
    associate (s => outbox%stream(mesh%brick(target)%rank))
      if (.not. allocated(s%a)) allocate (s%a(64*n))
      if (s%n + n > size(s%a)) then
        allocate (longer(2*size(s%a)))
        longer(:s%n) = s%a(:s%n)
        call move_alloc(longer, s%a)
      end if
      s%a(s%n + 1:s%n + header) = [real(wp) :: set, target, cell, blk%id(index), blk%body(index)]
      s%a(s%n + header + 1:s%n + n) = blk%f(index, :)
      s%n = s%n + n
    end associate
  end subroutine pack_particle

  !> Delivers the outbox, one message to each rank that owns a neighbouring brick, then sorts every block that changed.
  subroutine exchange_particles(mesh, solid, outbox)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(outbox_type), intent(inout) :: outbox
    type(MPI_Request) :: request(n_ranks)
    type(MPI_Status) :: status
    logical :: near(0:n_ranks - 1)
    integer, allocatable :: local_index(:)
    real(wp), allocatable :: incoming(:)
    integer :: other, n, n_requests, b, set
    if (.not. allocated(outbox%stream)) allocate (outbox%stream(0:n_ranks - 1))
    allocate (local_index(size(mesh%brick)), source=0)
    do b = 1, mesh%n_local
      local_index(mesh%local(b)) = b
    end do
    near = neighbour_ranks(mesh)
    n_requests = 0
    do other = 0, n_ranks - 1
      associate (s => outbox%stream(other))
        if (.not. allocated(s%a)) allocate (s%a(1))
        if (other == my_rank) then
          call deliver(solid, local_index, s%a(:s%n))
        else if (near(other)) then
          n_requests = n_requests + 1
          call MPI_Isend(s%a, s%n, MPI_DOUBLE_PRECISION, other, tag, world, request(n_requests))
        end if
      end associate
    end do
    do other = 0, n_ranks - 1
      if (.not. near(other)) cycle
      call MPI_Probe(other, tag, world, status)
      call MPI_Get_count(status, MPI_DOUBLE_PRECISION, n)
      allocate (incoming(max(n, 1)))
      call MPI_Recv(incoming, n, MPI_DOUBLE_PRECISION, other, tag, world, MPI_STATUS_IGNORE)
      call deliver(solid, local_index, incoming(:n))
      deallocate (incoming)
    end do
    call MPI_Waitall(n_requests, request(:n_requests), MPI_STATUSES_IGNORE)
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        call sort_particles(solid%block(set, b), solid%space)
      end do
    end do
  end subroutine exchange_particles

  !> Other ranks that own a neighbour of a brick of this rank.
  function neighbour_ranks(mesh) result(near)
    type(mesh_type), intent(in) :: mesh
    logical :: near(0:n_ranks - 1)
    integer :: b, i, j, k, target
    near = .false.
    do b = 1, mesh%n_local
      do k = -1, 1
        do j = -1, 1
          do i = -1, 1
            target = mesh%brick(mesh%local(b))%neighbour(i, j, k)
            if (target > 0) near(mesh%brick(target)%rank) = .true.
          end do
        end do
      end do
    end do
    near(my_rank) = .false.
  end function neighbour_ranks

  subroutine deliver(solid, local_index, stream)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: local_index(:)
    real(wp), intent(in) :: stream(:)
    integer :: at, n, set, local
    at = 0
    do while (at < size(stream))
      set = nint(stream(at + 1))
      local = local_index(nint(stream(at + 2)))
      n = size(solid%block(set, local)%f, 2)
      call append_particle(solid%block(set, local), nint(stream(at + 4)), nint(stream(at + 5)), &
        stream(at + header + 1:at + header + n), nint(stream(at + 3)))
      at = at + header + n
    end do
  end subroutine deliver

end module migration
