!> One step of the material point method. MUSL: the stress follows from the velocity field of the moved particles; USL and USF
!> take the node velocities at the end and at the beginning of the step.
!>
!> Between steps the nodes always hold what the particles project on them: mass, velocity (supports applied) and this brick's
!> part of the internal force. So the coupling may read node velocities at any time, and a step starts from the nodes.
module solid_step
  use blocks, only: block, allocate_nodes
  use cell_functions, only: cell_frame, chunk
  use contact, only: meet_fields, keep_contact
  use contact_surfaces, only: find_surfaces
  use halo, only: halo_type, add, last_node
  use kinds, only: wp
  use mesh, only: mesh_type
  use middle_gradient, only: center_gradient
  use migration, only: route_particle, exchange_particles, outbox_type
  use particle_checks, only: check_particles
  use particles, only: particle_block, cell_of_particle
  use rigid_bodies, only: push_rigid, turn_rigid, place_rigid, set_rigid_nodes
  use solid_load, only: loaded_cells, apply_load, book_load
  use solid_material, only: model_fluid, model_rigid
  use solid_state, only: solid_type, limit_type, frame_of, match_nodes, book_impulse, book_gravity_impulse, n_supports, &
    scheme_musl, scheme_usf
  use solid_time_step, only: find_limit
  use stress_update, only: update_stress
  use supports, only: hold_nodes, sum_held
  use transfer, only: particles_to_nodes, nodes_to_particles, move_particles
  implicit none
  private
  public :: project_solid, advance_solid

contains

  !> Particles to nodes: mass, velocity with supports, internal force; the counts of particles; the fastest signals.
  !> To be called once at the start and after a restart; advance_solid does it at the end of each step.
  subroutine project_solid(mesh, halo, solid)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    integer :: b, set, field
    call match_nodes(mesh, solid)
    do b = 1, mesh%n_local
      solid%limit(:, b) = limit_type()
      if (.not. allocated(solid%count(b)%a)) cycle
      do set = 1, solid%n_sets
        if (solid%block(set, b)%n == 0) cycle
        call check_particles(mesh, solid, set, b)
        call find_limit(mesh, solid, set, b)
      end do
      call count_particles(solid%block(:, b), mesh%brick_cells, solid%count(b))
      call scatter_brick(mesh, solid, b)
      associate (support => solid%support(b))
        support%total_mass = 0
        support%mass = 0
        support%momentum = 0
        do field = 1, solid%n_fields
          if (.not. allocated(solid%node(field, b)%a)) cycle
          support%total_mass = support%total_mass + sum(solid%node(field, b)%a(:, 1, :, :))
          if (field == solid%rigid_field) cycle ! held by supports of their own
          support%mass = support%mass + sum_held(support, 1, 1, solid%node(field, b))
          support%momentum = support%momentum + sum_held(support, 1, 0, solid%node(field, b))
        end do
      end associate
    end do
    do field = 1, solid%n_fields
      call add(mesh, halo, solid%node(field, :), 4, solid%order)
      do b = 1, mesh%n_local
        if (.not. allocated(solid%node(field, b)%a)) cycle
        call divide_by_mass(solid%node(field, b)%a(:, 1, :, :), solid%node(field, b)%a(:, 2:4, :, :))
        call hold_nodes(solid%support(b), 1, solid%node(field, b))
        if (field == solid%rigid_field) call set_rigid_nodes(mesh, solid, b)
      end do
    end do
  end subroutine project_solid

  !> This brick's part of mass, momentum and internal force.
  subroutine scatter_brick(mesh, solid, b)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    type(cell_frame) :: frame
    integer :: set, field
    frame = frame_of(mesh, solid%order, b)
    do field = 1, solid%n_fields
      if (.not. allocated(solid%node(field, b)%a)) cycle
      solid%node(field, b)%a = 0
      solid%force(field, b)%a = 0
    end do
    do set = 1, solid%n_sets
      field = solid%field_of_set(set)
      if (solid%block(set, b)%n > 0) call particles_to_nodes(frame, solid%at_affine(set), solid%block(set, b), &
        solid%node(field, b)%a, solid%force(field, b)%a)
    end do
  end subroutine scatter_brick

  !> Advances the solid by dt, under the forces of load_particles while their time lasts; impulse and work of these go to the books.
  subroutine advance_solid(mesh, halo, solid, dt)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    type(loaded_cells) :: loaded(mesh%n_local)
    type(outbox_type) :: outbox
    integer :: b, set, field
    logical :: has_load
    has_load = solid%load_left > 0.5_wp*dt ! what round-off leaves of the time is none
    if (allocated(solid%pair)) call find_surfaces(mesh, halo, solid)
    if (solid%scheme == scheme_usf) call strain_first(mesh, solid, dt)
    do b = 1, mesh%n_local
      if (.not. allocated(solid%count(b)%a)) cycle
      if (has_load) call apply_load(mesh, solid, b, loaded(b))
      call book_supports(solid, b, dt)
    end do
    if (solid%rigid_field > 0) call push_rigid(mesh, solid, dt)
    do field = 1, solid%n_fields
      if (field == solid%rigid_field) cycle
      call add(mesh, halo, solid%force(field, :), 3, solid%order)
      do b = 1, mesh%n_local
        if (.not. allocated(solid%node(field, b)%a)) cycle
        call accelerate(dt, solid%gravity, solid%node(field, b)%a, solid%force(field, b)%a)
        call hold_nodes(solid%support(b), 0, solid%force(field, b))
        call add_change(solid%node(field, b)%a, solid%force(field, b)%a)
      end do
    end do
    if (allocated(solid%pair)) then
      do b = 1, mesh%n_local
        call meet_fields(mesh, solid, b, solid%meeting(b), 1, solid%node(:, b), solid%force(:, b), solid%books(:, b))
      end do
    end if
    do b = 1, mesh%n_local
      if (.not. allocated(solid%count(b)%a)) cycle
      call book_load(solid, b, dt, frame_of(mesh, solid%order, b), loaded(b))
      call change_velocities(mesh, solid, b)
    end do
    if (has_load) solid%load_left = solid%load_left - dt
    call find_straining_velocity(mesh, halo, solid)
    if (solid%rigid_field > 0) call turn_rigid(mesh, solid, dt)
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%block(set, b)%n == 0) cycle
        if (solid%material(set)%model == model_rigid) then
          call place_rigid(mesh, solid, set, b)
          call route_all(mesh, solid, set, b, outbox)
        else if (solid%scheme == scheme_usf) then
          call move_and_strain(mesh, solid, dt, 0.0_wp, set, b, outbox)
        else
          call move_and_strain(mesh, solid, dt, dt, set, b, outbox)
        end if
      end do
    end do
    call exchange_particles(mesh, solid, outbox)
    call project_solid(mesh, halo, solid)
  end subroutine advance_solid

  !> Velocities of the particles of one brick; with MUSL their momenta are mapped back.
  subroutine change_velocities(mesh, solid, b)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    type(cell_frame) :: frame
    integer :: set, field
    frame = frame_of(mesh, solid%order, b)
    do field = 1, solid%n_fields
      if (allocated(solid%mapped(field, b)%a)) solid%mapped(field, b)%a = 0
    end do
    do set = 1, solid%n_sets
      field = solid%field_of_set(set)
      if (field == solid%rigid_field) cycle
      if (solid%block(set, b)%n > 0) call nodes_to_particles(frame, solid%flip, solid%at_affine(set), &
        solid%scheme == scheme_musl, solid%block(set, b), solid%force(field, b)%a, solid%node(field, b)%a, &
        solid%mapped(field, b)%a)
    end do
  end subroutine change_velocities

  !> solid%mapped becomes the velocity that strains the particles: of the mapped momenta, or of the nodes.
  subroutine find_straining_velocity(mesh, halo, solid)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    integer :: b, field
    do field = 1, solid%n_fields
      if (field == solid%rigid_field) cycle
      if (solid%scheme == scheme_musl) call add(mesh, halo, solid%mapped(field, :), 3, solid%order)
      do b = 1, mesh%n_local
        if (.not. allocated(solid%node(field, b)%a)) cycle
        if (solid%scheme == scheme_musl) then
          call divide_by_mass(solid%node(field, b)%a(:, 1, :, :), solid%mapped(field, b)%a)
          call hold_nodes(solid%support(b), 0, solid%mapped(field, b))
        else
          solid%mapped(field, b)%a = solid%node(field, b)%a(:, 2:4, :, :)
        end if
      end do
    end do
    if (allocated(solid%pair) .and. solid%scheme == scheme_musl) then
      do b = 1, mesh%n_local
        call keep_contact(solid%pair, solid%meeting(b), solid%node(:, b), solid%mapped(:, b))
      end do
    end if
  end subroutine find_straining_velocity

  !> USF: stresses from the velocities that start the step, then the internal forces anew.
  subroutine strain_first(mesh, solid, dt)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    type(outbox_type) :: outbox
    type(cell_frame) :: frame
    type(block) :: unused(solid%n_fields)
    integer :: b, set, field
    do b = 1, mesh%n_local
      if (.not. allocated(solid%count(b)%a)) cycle
      frame = frame_of(mesh, solid%order, b)
      do field = 1, solid%n_fields
        if (.not. allocated(solid%node(field, b)%a)) cycle
        solid%mapped(field, b)%a = solid%node(field, b)%a(:, 2:4, :, :)
        solid%force(field, b)%a = 0
        call allocate_nodes(unused(field), last_node(mesh, solid%order), 4)
      end do
      if (allocated(solid%pair)) call meet_fields(mesh, solid, b, solid%meeting(b), 0, solid%mapped(:, b))
      do set = 1, solid%n_sets
        field = solid%field_of_set(set)
        if (solid%block(set, b)%n == 0 .or. field == solid%rigid_field) cycle
        call move_and_strain(mesh, solid, 0.0_wp, dt, set, b, outbox)
        call particles_to_nodes(frame, solid%at_affine(set), solid%block(set, b), unused(field)%a, solid%force(field, b)%a)
      end do
    end do
  end subroutine strain_first

  !> Positions, over dt, and stresses and states, over strain_dt, of one set of one brick; particles that changed cell are routed.
  subroutine move_and_strain(mesh, solid, dt, strain_dt, set, b, outbox)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt, strain_dt
    integer, intent(in) :: set, b
    type(outbox_type), intent(inout) :: outbox
    type(cell_frame) :: frame
    real(wp) :: gradient(chunk, 9), length
    integer :: first, last, cell, n_moved, moved(chunk), i, field
    frame = frame_of(mesh, solid%order, b)
    field = solid%field_of_set(set)
    length = minval(mesh%spacing, mesh%active)
    cell = 1
    do first = 1, solid%block(set, b)%n, chunk
      associate (blk => solid%block(set, b))
        last = min(first + chunk - 1, blk%n)
        call move_particles(frame, solid%at_affine(set), dt, strain_dt, blk, first, last, cell, solid%node(field, b)%a, &
          solid%mapped(field, b)%a, gradient, n_moved, moved)
        if (strain_dt > 0) then
          ! fluids, which keep no shape, are nearer to exact solutions without
          if (solid%material(set)%model /= model_fluid) call center_gradient(last - first + 1, solid%scheme /= scheme_usf, gradient)
          call update_stress(solid%material(set), strain_dt, length, last - first + 1, blk%capacity, size(blk%f, 2), blk%f, first, &
            gradient)
        end if
      end associate
      if (.not. dt > 0) cycle
      do i = 1, n_moved
        call route_particle(mesh, solid, set, b, moved(i), cell_of_particle(solid%block(set, b), moved(i)), outbox)
      end do
    end do
  end subroutine move_and_strain

  !> Finds the cells of all particles of one set of one brick anew.
  subroutine route_all(mesh, solid, set, b, outbox)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: set, b
    type(outbox_type), intent(inout) :: outbox
    integer :: cell, i
    do cell = 1, size(solid%block(set, b)%cell_start) - 1
      do i = solid%block(set, b)%cell_start(cell), solid%block(set, b)%cell_start(cell + 1) - 1
        call route_particle(mesh, solid, set, b, i, cell, outbox)
      end do
    end do
  end subroutine route_all

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
        if (.not. any(mass(:, j, k) > 0)) cycle ! nothing to divide
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
        if (.not. any(node(:, 1, j, k) > 0)) cycle
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
    integer :: j, k
    do k = 1, size(node, 4)
      do j = 1, size(node, 3)
        if (any(node(:, 1, j, k) > 0)) node(:, 2:4, j, k) = node(:, 2:4, j, k) + change(:, :, j, k)
      end do
    end do
  end subroutine add_change

  !> Impulses of the supports and of gravity in this step, from this brick's part of the node forces and masses.
  subroutine book_supports(solid, b, dt)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: dt
    real(wp) :: impulse(3, n_supports)
    integer :: s, field
    impulse = -(1 - solid%flip)*solid%support(b)%momentum
    do field = 1, solid%n_fields
      if (field == solid%rigid_field) cycle
      if (allocated(solid%force(field, b)%a)) impulse = impulse - dt*sum_held(solid%support(b), 0, 0, solid%force(field, b))
    end do
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
