!> Rigid bodies made of particles: model = 'rigid'. Mass, centre and inertia are those of the particles; forces come from the load on
!> the cells that hold them and from gravity; the particles follow the body exactly, since each keeps its place in it.
!>
!> Rigid particles have a velocity field of their own, whose nodes move as the body does: the flow sees the right wall velocity.
!> Supports of the mesh do not hold a rigid body, only its own do.
module rigid_bodies
  use blocks, only: block
  use cell_functions, only: cell_frame
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_mass, at_position, at_velocity
  use reductions, only: reduce_sum
  use rigid_motion, only: rigid_body, push_body, turn_body, find_angular_velocity, velocity_at, cross_product
  use solid_material, only: model_rigid
  use solid_state, only: solid_type, frame_of, book_impulse, book_coupling_impulse, book_coupling_work, n_supports
  use tensor_functions, only: control_point, functions_of, line_functions
  implicit none
  private
  public :: start_rigid, push_rigid, load_rigid, turn_rigid, place_rigid, set_rigid_nodes, pack_rigid, unpack_rigid, &
    all_fixed

  integer, parameter :: n_stored = 28 !< numbers of a body in a restart file

contains

  !> Finds mass, centre, velocity and inertia of the bodies from their particles, and the place of each particle in its body.
  !> What is free and the angular velocity must be set.
  subroutine start_rigid(mesh, solid)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp) :: partial(7, size(solid%rigid), mesh%n_local), total(7*size(solid%rigid)), arm(3), tensor(3, 3), trace
    integer :: b, set, i, r, d
    if (size(solid%rigid) == 0) return
    partial = 0
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%material(set)%model /= model_rigid) cycle
        associate (blk => solid%block(set, b))
          do i = 1, blk%n
            r = solid%rigid_of_body(blk%body(i))
            partial(:, r, b) = partial(:, r, b) + blk%f(i, at_mass)* &
              [1.0_wp, blk%f(i, at_position:at_position + 2), blk%f(i, at_velocity:at_velocity + 2)]
          end do
        end associate
      end do
    end do
    call reduce_sum(mesh, reshape(partial, [7*size(solid%rigid), mesh%n_local]), total)
    do r = 1, size(solid%rigid)
      associate (body => solid%rigid(r), sums => total(7*r - 6:7*r))
        body%mass = sums(1)
        body%center = sums(2:4)/sums(1)
        body%velocity = merge(sums(5:7)/sums(1), 0.0_wp, body%free)
      end associate
    end do
    partial = 0
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%material(set)%model /= model_rigid) cycle
        associate (blk => solid%block(set, b), at => solid%material(set)%at_own)
          do i = 1, blk%n
            r = solid%rigid_of_body(blk%body(i))
            arm = merge(blk%f(i, at_position:at_position + 2) - solid%rigid(r)%center, 0.0_wp, mesh%active)
            blk%f(i, at:at + 2) = arm
            partial(:6, r, b) = partial(:6, r, b) + blk%f(i, at_mass)* &
              [arm(1)*arm(1), arm(2)*arm(2), arm(3)*arm(3), arm(2)*arm(3), arm(1)*arm(3), arm(1)*arm(2)]
          end do
        end associate
      end do
    end do
    call reduce_sum(mesh, reshape(partial, [7*size(solid%rigid), mesh%n_local]), total)
    do r = 1, size(solid%rigid)
      associate (body => solid%rigid(r), s => total(7*r - 6:7*r))
        tensor = -reshape([s(1), s(6), s(5), s(6), s(2), s(4), s(5), s(4), s(3)], [3, 3])
        trace = s(1) + s(2) + s(3)
        do d = 1, 3
          tensor(d, d) = tensor(d, d) + trace
        end do
        if (dot_product(tensor(:, 1), cross_product(tensor(:, 2), tensor(:, 3))) < 1e-12_wp*trace**3) then
          do d = 1, 3
            tensor(d, d) = tensor(d, d) + 1e-9_wp*trace ! a row of particles has no inertia about itself
          end do
        end if
        body%inertia = tensor
        body%angular_momentum = merge(matmul(tensor, merge(body%angular_velocity, 0.0_wp, body%free_axis)), 0.0_wp, body%free_axis)
        call find_angular_velocity(body)
      end associate
    end do
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%material(set)%model == model_rigid) call set_velocities(solid, set, b)
      end do
    end do
  end subroutine start_rigid

  !> Finds the force on each body and its moment about the centre, which push_rigid applies until this is called again. load: force
  !> on each cell of a brick (3 variables, no ghosts; unallocated: none), shared equally by its particles of all sets.
  subroutine load_rigid(mesh, solid, load)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(block), intent(in) :: load(:)
    real(wp) :: partial(6, size(solid%rigid), mesh%n_local), total(6*size(solid%rigid)), force(3), arm(3)
    integer :: b, set, i, j, k, q, r, cell
    partial = 0
    do b = 1, mesh%n_local
      if (.not. allocated(load(b)%a)) cycle
      do set = 1, solid%n_sets
        if (solid%material(set)%model /= model_rigid .or. solid%block(set, b)%n == 0) cycle
        associate (blk => solid%block(set, b), at => solid%material(set)%at_own)
          cell = 0
          do k = 1, mesh%brick_cells(3)
            do j = 1, mesh%brick_cells(2)
              do i = 1, mesh%brick_cells(1)
                cell = cell + 1
                if (blk%cell_start(cell + 1) == blk%cell_start(cell)) cycle
                force = load(b)%a(i, 1:3, j, k)/solid%count(b)%a(i, 1, j, k)
                if (.not. any(abs(force) > 0)) cycle
                do q = blk%cell_start(cell), blk%cell_start(cell + 1) - 1
                  r = solid%rigid_of_body(blk%body(q))
                  arm = matmul(solid%rigid(r)%rotation, blk%f(q, at:at + 2))
                  partial(:, r, b) = partial(:, r, b) + [force, cross_product(arm, force)]
                end do
              end do
            end do
          end do
        end associate
      end do
    end do
    call reduce_sum(mesh, reshape(partial, [6*size(solid%rigid), mesh%n_local]), total)
    do r = 1, size(solid%rigid)
      solid%rigid(r)%force = total(6*r - 5:6*r - 3)
      solid%rigid(r)%moment = total(6*r - 2:6*r)
    end do
  end subroutine load_rigid

  !> Velocities of the bodies over dt under the forces of load_rigid and gravity; impulse and work go to the books.
  subroutine push_rigid(mesh, solid, dt)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    real(wp) :: held(3), velocity(3), angular_velocity(3)
    integer :: r
    do r = 1, size(solid%rigid)
      associate (body => solid%rigid(r))
        velocity = 0.5_wp*body%velocity
        angular_velocity = 0.5_wp*body%angular_velocity
        call push_body(body, dt, body%force, body%moment, solid%gravity, held)
        velocity = velocity + 0.5_wp*body%velocity
        angular_velocity = angular_velocity + 0.5_wp*body%angular_velocity
        if (mesh%n_local == 0) cycle
        if (mesh%local(1) /= 1) cycle ! booked once, in the first brick of all
        associate (books => solid%books(:, 1), last => book_impulse + 3*n_supports - 1)
          books(last - 2:last) = books(last - 2:last) + held
          books(book_coupling_impulse:book_coupling_impulse + 2) = books(book_coupling_impulse:book_coupling_impulse + 2) &
            + dt*body%force
          books(book_coupling_work) = books(book_coupling_work) &
            + dt*(dot_product(body%force, velocity) + dot_product(body%moment, angular_velocity))
        end associate
      end associate
    end do
  end subroutine push_rigid

  !> Places and orientations of the bodies over dt.
  subroutine turn_rigid(mesh, solid, dt)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    real(wp), intent(in) :: dt
    real(wp) :: length
    integer :: r, d
    do r = 1, size(solid%rigid)
      call turn_body(solid%rigid(r), dt)
      do d = 1, 3
        if (.not. mesh%periodic(d)) cycle
        length = mesh%upper(d) - mesh%lower(d)
        associate (x => solid%rigid(r)%center(d))
          x = x - length*floor((x - mesh%lower(d))/length)
        end associate
      end do
    end do
  end subroutine turn_rigid

  !> Brings the particles of one set of one brick to where their bodies are now.
  subroutine place_rigid(mesh, solid, set, b)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: set, b
    integer :: i
    associate (blk => solid%block(set, b), at => solid%material(set)%at_own)
      do i = 1, blk%n
        associate (body => solid%rigid(solid%rigid_of_body(blk%body(i))))
          if (.not. (any(body%free) .or. any(body%free_axis))) cycle
          blk%f(i, at_position:at_position + 2) = merge(body%center + matmul(body%rotation, blk%f(i, at:at + 2)), &
            blk%f(i, at_position:at_position + 2), mesh%active)
        end associate
      end do
    end associate
    call set_velocities(solid, set, b)
  end subroutine place_rigid

  subroutine set_velocities(solid, set, b)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: set, b
    integer :: i
    associate (blk => solid%block(set, b), at => solid%material(set)%at_own)
      do i = 1, blk%n
        associate (body => solid%rigid(solid%rigid_of_body(blk%body(i))))
          blk%f(i, at_velocity:at_velocity + 2) = velocity_at(body, matmul(body%rotation, blk%f(i, at:at + 2)))
        end associate
      end do
    end associate
  end subroutine set_velocities

  !> Gives the nodes of a brick the velocity of the body whose particles they carry.
  subroutine set_rigid_nodes(mesh, solid, b)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    integer, allocatable :: owner(:, :, :)
    integer :: i, j, k
    call find_owners(mesh, solid, b, owner)
    associate (node => solid%node(solid%rigid_field, b)%a)
      do k = 0, ubound(owner, 3)
        do j = 0, ubound(owner, 2)
          do i = 0, ubound(owner, 1)
            if (owner(i, j, k) > 0) node(i, 2:4, j, k) = node_velocity(mesh, solid, b, owner(i, j, k), [i, j, k])
          end do
        end do
      end do
    end associate
  end subroutine set_rigid_nodes

  pure function node_velocity(mesh, solid, b, r, node) result(velocity)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b, r, node(3)
    real(wp) :: velocity(3), arm(3), length
    type(cell_frame) :: frame
    integer :: d
    frame = frame_of(mesh, solid%order, b)
    do d = 1, 3
      arm(d) = 0
      if (.not. mesh%active(d)) cycle
      arm(d) = control_point(frame, d, node(d)) - solid%rigid(r)%center(d)
      length = mesh%upper(d) - mesh%lower(d)
      if (mesh%periodic(d)) arm(d) = arm(d) - length*anint(arm(d)/length) ! the nearer image
    end do
    velocity = velocity_at(solid%rigid(r), arm)
  end function node_velocity

  !> The body of each node of a brick: that of the particles in the cells around; 0: none here, -1: several, whose nodes keep the mean.
  subroutine find_owners(mesh, solid, b, owner)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b
    integer, allocatable, intent(out) :: owner(:, :, :)
    type(cell_frame) :: frame
    type(line_functions) :: line
    integer :: set, i, j, k, d, q, cell, r, last(3)
    frame = frame_of(mesh, solid%order, b)
    allocate (owner(0:frame%last(1), 0:frame%last(2), 0:frame%last(3)), source=0)
    do set = 1, solid%n_sets
      if (solid%material(set)%model /= model_rigid .or. solid%block(set, b)%n == 0) cycle
      associate (blk => solid%block(set, b))
        cell = 0
        do k = 1, frame%n(3)
          do j = 1, frame%n(2)
            do i = 1, frame%n(1)
              cell = cell + 1
              if (blk%cell_start(cell + 1) == blk%cell_start(cell)) cycle
              do d = 1, 3
                line = functions_of(frame, d, merge(i, merge(j, k, d == 2), d == 1))
                last(d) = line%n
              end do
              associate (at => owner(i - 1:i - 2 + last(1), j - 1:j - 2 + last(2), k - 1:k - 2 + last(3)))
                do q = blk%cell_start(cell), blk%cell_start(cell + 1) - 1
                  r = solid%rigid_of_body(blk%body(q))
                  at = merge(r, merge(at, -1, at == r), at == 0)
                end do
              end associate
            end do
          end do
        end do
      end associate
    end do
  end subroutine find_owners

  !> The state of all bodies as numbers, for a restart file.
  pure function pack_rigid(rigid) result(values)
    type(rigid_body), intent(in) :: rigid(:)
    real(wp), allocatable :: values(:)
    integer :: r
    allocate (values(n_stored*size(rigid)))
    do r = 1, size(rigid)
      values(n_stored*(r - 1) + 1:n_stored*r) = [rigid(r)%mass, rigid(r)%center, rigid(r)%velocity, rigid(r)%angular_momentum, &
        reshape(rigid(r)%rotation, [9]), reshape(rigid(r)%inertia, [9])]
    end do
  end function pack_rigid

  !> Takes back what pack_rigid gave.
  pure subroutine unpack_rigid(values, rigid)
    real(wp), intent(in) :: values(:)
    type(rigid_body), intent(inout) :: rigid(:)
    integer :: r
    do r = 1, size(rigid)
      associate (a => values(n_stored*(r - 1) + 1:n_stored*r), body => rigid(r))
        body%mass = a(1)
        body%center = a(2:4)
        body%velocity = a(5:7)
        body%angular_momentum = a(8:10)
        body%rotation = reshape(a(11:19), [3, 3])
        body%inertia = reshape(a(20:28), [3, 3])
        call find_angular_velocity(body)
      end associate
    end do
  end subroutine unpack_rigid

  !> Every body is rigid and held.
  pure logical function all_fixed(solid)
    type(solid_type), intent(in) :: solid
    integer :: i
    all_fixed = all(solid%material%model == model_rigid)
    if (.not. all_fixed) return
    do i = 1, size(solid%rigid)
      all_fixed = all_fixed .and. .not. (any(solid%rigid(i)%free) .or. any(solid%rigid(i)%free_axis))
    end do
  end function all_fixed

end module rigid_bodies
