!> One step of the material point method, MUSL: the stress follows from the velocity field of the moved particles.
!>
!> Between steps the nodes always hold what the particles project on them: mass, velocity (supports applied) and this brick's
!> part of the internal force. So the coupling may read node velocities at any time, and a step starts from the nodes.
module solid_step
  use blocks, only: block
  use halo, only: halo_type, add
  use kinds, only: wp
  use mesh, only: mesh_type
  use migration, only: route_particle, exchange_particles, outbox_type
  use particles, only: particle_block, cell_of_particle
  use solid_state, only: solid_type, limit_type, frame_of, match_nodes, brick_particles, book_impulse, book_coupling_impulse, &
    book_coupling_work, book_gravity_impulse, n_supports
  use stress_update, only: update_stress, signal_speeds
  use supports, only: hold_nodes, sum_held
  use cell_functions, only: cell_frame, chunk
  use gather, only: update_velocity, gather_motion
  use scatter, only: scatter_particles, sum_functions
  implicit none
  private
  public :: project_solid, advance_solid

  !> Cells of a brick that carry a coupling force.
  type :: loaded_cells
    integer :: n = 0
    integer, allocatable :: cell(:, :) !< (3, n)
    real(wp), allocatable :: force(:, :) !< (3, n) per particle
    real(wp), allocatable :: weight(:, :) !< (8, n) sum of each node's function over the cell's particles
  end type loaded_cells

contains

  !> Particles to nodes: mass, velocity with supports, internal force; the counts of particles; the fastest signals.
  !> To be called once at the start and after a restart; advance_solid does it at the end of each step.
  subroutine project_solid(mesh, halo, solid)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    type(cell_frame) :: frame
    integer :: b, set
    call match_nodes(mesh, solid)
    do b = 1, mesh%n_local
      solid%limit(:, b) = limit_type()
      if (.not. allocated(solid%node(b)%a)) cycle
      frame = frame_of(mesh, b)
      solid%node(b)%a = 0
      solid%force(b)%a = 0
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          if (blk%n == 0) cycle
          call scatter_particles(frame, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, solid%node(b)%a, solid%force(b)%a)
          call find_limit(solid, set, blk, solid%limit(set, b))
        end associate
      end do
      call count_particles(solid%block(:, b), mesh%brick_cells, solid%count(b))
      solid%support(b)%total_mass = sum(solid%node(b)%a(:, 1, :, :))
      solid%support(b)%mass = sum_held(solid%support(b), 1, 1, solid%node(b))
      solid%support(b)%momentum = sum_held(solid%support(b), 1, 0, solid%node(b))
    end do
    call add(mesh, halo, solid%node, 4)
    do b = 1, mesh%n_local
      if (.not. allocated(solid%node(b)%a)) cycle
      call divide_by_mass(solid%node(b)%a(:, 1, :, :), solid%node(b)%a(:, 2:4, :, :))
      call hold_nodes(solid%support(b), 1, solid%node(b))
    end do
  end subroutine project_solid

  !> Advances the solid by dt.
  !>
  !> load: force on each cell of a brick (3 variables, any ghosts; unallocated: none), shared equally by the cell's particles of all
  !> sets and held constant over the step; cells without particles must carry none. Its impulse and work go to the books.
  subroutine advance_solid(mesh, halo, solid, dt, load)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    type(block), intent(in), optional :: load(:)
    type(loaded_cells) :: loaded(mesh%n_local)
    type(outbox_type) :: outbox
    type(cell_frame) :: frame
    integer :: b, set
    do b = 1, mesh%n_local
      if (.not. allocated(solid%node(b)%a)) cycle
      if (present(load)) then
        if (allocated(load(b)%a)) call apply_load(mesh, solid, b, load(b), loaded(b))
      end if
      call book_supports(solid, b, dt)
    end do
    call add(mesh, halo, solid%force, 3)
    do b = 1, mesh%n_local
      if (.not. allocated(solid%node(b)%a)) cycle
      call accelerate(dt, solid%gravity, solid%node(b)%a, solid%force(b)%a)
      call hold_nodes(solid%support(b), 0, solid%force(b))
      call add_change(solid%node(b)%a, solid%force(b)%a)
      call book_load(solid, b, dt, loaded(b))
      frame = frame_of(mesh, b)
      solid%mapped(b)%a = 0
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          if (blk%n > 0) call update_velocity(frame, solid%flip, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, &
            solid%force(b)%a, solid%node(b)%a, solid%mapped(b)%a)
        end associate
      end do
    end do
    call add(mesh, halo, solid%mapped, 3)
    do b = 1, mesh%n_local
      if (.not. allocated(solid%node(b)%a)) cycle
      call divide_by_mass(solid%node(b)%a(:, 1, :, :), solid%mapped(b)%a)
      call hold_nodes(solid%support(b), 0, solid%mapped(b))
      do set = 1, solid%n_sets
        if (solid%block(set, b)%n > 0) call move_and_strain(mesh, solid, dt, set, b, outbox)
      end do
    end do
    call exchange_particles(mesh, solid, outbox)
    call project_solid(mesh, halo, solid)
  end subroutine advance_solid

  !> Positions, stresses and states of one set of one brick; particles that changed cell are routed.
  subroutine move_and_strain(mesh, solid, dt, set, b, outbox)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    integer, intent(in) :: set, b
    type(outbox_type), intent(inout) :: outbox
    type(cell_frame) :: frame
    real(wp) :: gradient(chunk, 9), length
    integer :: first, last, cell, n_moved, moved(chunk), i
    frame = frame_of(mesh, b)
    length = minval(mesh%spacing, mesh%active)
    cell = 1
    do first = 1, solid%block(set, b)%n, chunk
      associate (blk => solid%block(set, b))
        last = min(first + chunk - 1, blk%n)
        call gather_motion(frame, dt, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, first, last, cell, solid%node(b)%a, &
          solid%mapped(b)%a, gradient, n_moved, moved)
        call update_stress(solid%material(set), dt, length, last - first + 1, blk%capacity, size(blk%f, 2), blk%f, first, gradient)
      end associate
      do i = 1, n_moved
        call route_particle(mesh, solid, set, b, moved(i), cell_of_particle(solid%block(set, b), moved(i)), outbox)
      end do
    end do
  end subroutine move_and_strain

  !> The fastest signal of a block; of equal ones the first.
  pure subroutine find_limit(solid, set, blk, limit)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: set
    type(particle_block), intent(in) :: blk
    type(limit_type), intent(out) :: limit
    real(wp) :: signal(chunk), largest
    integer :: first, n, i
    do first = 1, blk%n, chunk
      n = min(chunk, blk%n - first + 1)
      call signal_speeds(solid%material(set), n, blk%capacity, size(blk%f, 2), blk%f, first, signal)
      largest = 0
      !$omp simd reduction(max:largest)
      do i = 1, n
        largest = max(largest, signal(i))
      end do
      if (largest <= limit%signal) cycle
      limit%signal = largest
      do i = n, 1, -1
        if (signal(i) >= largest) limit%index = first + i - 1
      end do
    end do
  end subroutine find_limit

  pure subroutine count_particles(blocks, n, counts)
    type(particle_block), intent(in) :: blocks(:)
    integer, intent(in) :: n(3)
    type(block), intent(inout) :: counts
    integer :: i, j, k, cell, set
    counts%a = 0
    do set = 1, size(blocks)
      if (blocks(set)%n == 0) cycle
      cell = 0
      do k = 1, n(3)
        do j = 1, n(2)
          do i = 1, n(1)
            cell = cell + 1
            counts%a(i, 1, j, k) = counts%a(i, 1, j, k) + real(blocks(set)%cell_start(cell + 1) - blocks(set)%cell_start(cell), wp)
          end do
        end do
      end do
    end do
  end subroutine count_particles

  !> Momentum to velocity; zero where there is no mass.
  pure subroutine divide_by_mass(mass, momentum)
    real(wp), intent(in) :: mass(:, :, :)
    real(wp), intent(inout) :: momentum(:, :, :, :)
    real(wp) :: inverse
    integer :: i, j, k
    do k = 1, size(mass, 3)
      do j = 1, size(mass, 2)
        !$omp simd private(inverse)
        do i = 1, size(mass, 1)
          inverse = merge(1/max(mass(i, j, k), tiny(1.0_wp)), 0.0_wp, mass(i, j, k) > 0)
          momentum(i, 1, j, k) = momentum(i, 1, j, k)*inverse
          momentum(i, 2, j, k) = momentum(i, 2, j, k)*inverse
          momentum(i, 3, j, k) = momentum(i, 3, j, k)*inverse
        end do
      end do
    end do
  end subroutine divide_by_mass

  !> Force to velocity change of the step.
  pure subroutine accelerate(dt, gravity, node, force)
    real(wp), intent(in) :: dt, gravity(3), node(:, :, :, :)
    real(wp), intent(inout) :: force(:, :, :, :)
    real(wp) :: inverse, weight
    integer :: i, j, k, d
    do k = 1, size(node, 4)
      do j = 1, size(node, 3)
        do d = 1, 3
          weight = dt*gravity(d)
          !$omp simd private(inverse)
          do i = 1, size(node, 1)
            inverse = merge(dt/max(node(i, 1, j, k), tiny(1.0_wp)), 0.0_wp, node(i, 1, j, k) > 0)
            force(i, d, j, k) = force(i, d, j, k)*inverse + merge(weight, 0.0_wp, node(i, 1, j, k) > 0)
          end do
        end do
      end do
    end do
  end subroutine accelerate

  pure subroutine add_change(node, change)
    real(wp), intent(inout) :: node(:, :, :, :)
    real(wp), intent(in) :: change(:, :, :, :)
    node(:, 2:4, :, :) = node(:, 2:4, :, :) + change
  end subroutine add_change

  !> Adds the coupling force to this brick's part of the node forces.
  subroutine apply_load(mesh, solid, b, load, loaded)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    type(block), intent(in) :: load
    type(loaded_cells), intent(inout) :: loaded
    type(cell_frame) :: frame
    real(wp) :: weight(8)
    integer :: i, j, k, l, m, cell, set, n
    frame = frame_of(mesh, b)
    n = 0
    do k = 1, mesh%brick_cells(3)
      do j = 1, mesh%brick_cells(2)
        do i = 1, mesh%brick_cells(1)
          if (solid%count(b)%a(i, 1, j, k) > 0 .and. any(abs(load%a(i, 1:3, j, k)) > 0)) n = n + 1
        end do
      end do
    end do
    allocate (loaded%cell(3, n), loaded%force(3, n), loaded%weight(8, n))
    loaded%n = n
    n = 0
    do k = 1, mesh%brick_cells(3)
      do j = 1, mesh%brick_cells(2)
        do i = 1, mesh%brick_cells(1)
          if (.not. (solid%count(b)%a(i, 1, j, k) > 0 .and. any(abs(load%a(i, 1:3, j, k)) > 0))) cycle
          cell = i + mesh%brick_cells(1)*(j - 1 + mesh%brick_cells(2)*(k - 1))
          n = n + 1
          weight = 0
          do set = 1, solid%n_sets
            associate (blk => solid%block(set, b))
              if (blk%n > 0) call sum_functions(frame, [i, j, k], blk%capacity, size(blk%f, 2), blk%f, blk%cell_start(cell), &
                blk%cell_start(cell + 1) - 1, weight)
            end associate
          end do
          loaded%cell(:, n) = [i, j, k]
          loaded%force(:, n) = load%a(i, 1:3, j, k)/solid%count(b)%a(i, 1, j, k)
          loaded%weight(:, n) = weight
          do l = 1, 8
            do m = 1, 3
              associate (at => solid%force(b)%a(i - 1 + iand(l - 1, 1), m, j - 1 + iand((l - 1)/2, 1), k - 1 + (l - 1)/4))
                at = at + weight(l)*loaded%force(m, n)
              end associate
            end do
          end do
        end do
      end do
    end do
  end subroutine apply_load

  !> Impulse and work of the coupling force, with the mean node velocity of the step.
  subroutine book_load(solid, b, dt, loaded)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: dt
    type(loaded_cells), intent(in) :: loaded
    real(wp) :: work, impulse(3)
    integer :: n, l, m, i, j, k
    work = 0
    impulse = 0
    do n = 1, loaded%n
      do l = 1, 8
        i = loaded%cell(1, n) - 1 + iand(l - 1, 1)
        j = loaded%cell(2, n) - 1 + iand((l - 1)/2, 1)
        k = loaded%cell(3, n) - 1 + (l - 1)/4
        do m = 1, 3
          impulse(m) = impulse(m) + dt*loaded%weight(l, n)*loaded%force(m, n)
          work = work + dt*loaded%weight(l, n)*loaded%force(m, n) &
            *(solid%node(b)%a(i, m + 1, j, k) - 0.5_wp*solid%force(b)%a(i, m, j, k))
        end do
      end do
    end do
    associate (books => solid%books(:, b))
      books(book_coupling_impulse:book_coupling_impulse + 2) = books(book_coupling_impulse:book_coupling_impulse + 2) + impulse
      books(book_coupling_work) = books(book_coupling_work) + work
    end associate
  end subroutine book_load

  !> Impulses of the supports and of gravity in this step, from this brick's part of the node forces and masses.
  subroutine book_supports(solid, b, dt)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: dt
    real(wp) :: impulse(3, n_supports)
    integer :: s
    impulse = -dt*sum_held(solid%support(b), 0, 0, solid%force(b)) - (1 - solid%flip)*solid%support(b)%momentum
    do s = 1, n_supports
      impulse(:, s) = impulse(:, s) - dt*solid%gravity*solid%support(b)%mass(:, s)
    end do
    associate (books => solid%books(:, b))
      books(book_impulse:book_impulse + 3*n_supports - 1) = books(book_impulse:book_impulse + 3*n_supports - 1) &
        + reshape(impulse, [3*n_supports])
      if (any(abs(solid%gravity) > 0)) books(book_gravity_impulse:book_gravity_impulse + 2) = &
        books(book_gravity_impulse:book_gravity_impulse + 2) + dt*solid%gravity*solid%support(b)%total_mass
    end associate
  end subroutine book_supports

end module solid_step
