!> Forces from outside on the particles, and the velocity that the outside sees in a cell.
!>
!> A force is given by cell at the beginning of a step of the scene. The particles that are there then share it and carry it in
!> columns of their own through all parts of the step, to whatever cell, brick or rank they move: what the outside lost, the solid
!> gets.
module solid_load
  use blocks, only: block
  use cell_functions, only: cell_frame
  use kinds, only: wp
  use mesh, only: mesh_type
  use solid_state, only: solid_type, frame_of, book_coupling_impulse, book_coupling_work
  use tensor_functions, only: functions_of, line_functions
  use tensor_scatter, only: scatter_columns
  implicit none
  private
  public :: load_particles, apply_load, book_load, cell_velocity

  !> Cells of a brick that hold loaded particles.
  type, public :: loaded_cells
    integer :: n = 0
    integer, allocatable :: cell(:, :) !< (3, n)
    real(wp), allocatable :: force(:, :, :, :, :, :) !< (3, 3, 3, component, field, n) on each node of the cell
  end type loaded_cells

contains

  !> Gives the particles the force that advance_solid applies from now on, over the duration in all.
  !> load: force on each cell of a brick (3 variables, any ghosts; unallocated: none), shared equally by the cell's particles of all
  !> sets; cells without particles must carry none. Rigid particles take their share by load_rigid.
  subroutine load_particles(mesh, solid, load, duration)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(block), intent(in) :: load(:)
    real(wp), intent(in) :: duration
    integer :: b, set, i, j, k, d, cell, first, last
    solid%load_left = duration
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%at_force(set) == 0 .or. solid%block(set, b)%n == 0) cycle
        associate (blk => solid%block(set, b), at => solid%at_force(set))
          blk%f(:blk%n, at:at + 2) = 0
          if (.not. allocated(load(b)%a)) cycle
          cell = 0
          do k = 1, mesh%brick_cells(3)
            do j = 1, mesh%brick_cells(2)
              do i = 1, mesh%brick_cells(1)
                cell = cell + 1
                first = blk%cell_start(cell)
                last = blk%cell_start(cell + 1) - 1
                if (last < first .or. .not. any(abs(load(b)%a(i, 1:3, j, k)) > 0)) cycle
                do d = 1, 3
                  blk%f(first:last, at + d - 1) = load(b)%a(i, d, j, k)/solid%count(b)%a(i, 1, j, k)
                end do
              end do
            end do
          end do
        end associate
      end do
    end do
  end subroutine load_particles

  !> Adds the forces of the particles to this brick's part of the node forces.
  subroutine apply_load(mesh, solid, b, loaded)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    type(loaded_cells), intent(inout) :: loaded
    type(cell_frame) :: frame
    logical :: marked(product(mesh%brick_cells))
    integer :: cell, set, n, field, last(3)
    marked = .false.
    do set = 1, solid%n_sets
      if (solid%at_force(set) == 0 .or. solid%block(set, b)%n == 0) cycle
      associate (blk => solid%block(set, b))
        call mark_loaded(blk%capacity, blk%f(:, solid%at_force(set):solid%at_force(set) + 2), blk%cell_start, marked)
      end associate
    end do
    loaded%n = count(marked)
    if (loaded%n == 0) return
    frame = frame_of(mesh, solid%order, b)
    allocate (loaded%cell(3, loaded%n), loaded%force(3, 3, 3, 3, solid%n_fields, loaded%n))
    loaded%force = 0
    n = 0
    do cell = 1, size(marked)
      if (.not. marked(cell)) cycle
      n = n + 1
      loaded%cell(:, n) = 1 + [mod(cell - 1, frame%n(1)), mod((cell - 1)/frame%n(1), frame%n(2)), (cell - 1)/product(frame%n(1:2))]
      do set = 1, solid%n_sets
        if (solid%at_force(set) == 0 .or. solid%block(set, b)%n == 0) cycle
        associate (blk => solid%block(set, b), field => solid%field_of_set(set))
          call scatter_columns(frame, loaded%cell(:, n), solid%at_force(set), blk%capacity, size(blk%f, 2), blk%f, &
            blk%cell_start(cell), blk%cell_start(cell + 1) - 1, loaded%force(:, :, :, :, field, n))
        end associate
      end do
      last = functions_in(frame, loaded%cell(:, n))
      do field = 1, solid%n_fields
        if (.not. allocated(solid%force(field, b)%a) .or. field == solid%rigid_field) cycle
        associate (at => loaded%cell(:, n) - 2, force => solid%force(field, b)%a)
          call add_forces(last, loaded%force(:, :, :, :, field, n), &
            force(at(1) + 1:at(1) + last(1), :, at(2) + 1:at(2) + last(2), at(3) + 1:at(3) + last(3)))
        end associate
      end do
    end do
  end subroutine apply_load

  !> Marks the cells that hold a particle under a force.
  pure subroutine mark_loaded(capacity, force, cell_start, marked)
    integer, intent(in) :: capacity, cell_start(:)
    real(wp), intent(in) :: force(capacity, 3)
    logical, intent(inout) :: marked(:)
    real(wp) :: largest
    integer :: cell, q
    do cell = 1, size(marked)
      largest = 0
      !$omp simd reduction(max:largest)
      do q = cell_start(cell), cell_start(cell + 1) - 1
        largest = max(largest, abs(force(q, 1)), abs(force(q, 2)), abs(force(q, 3)))
      end do
      marked(cell) = marked(cell) .or. largest > 0
    end do
  end subroutine mark_loaded

  pure subroutine add_forces(last, part, force)
    integer, intent(in) :: last(3)
    real(wp), intent(in) :: part(3, 3, 3, 3)
    real(wp), intent(inout) :: force(:, :, :, :)
    integer :: d
    do d = 1, 3
      force(:, d, :, :) = force(:, d, :, :) + part(:last(1), :last(2), :last(3), d)
    end do
  end subroutine add_forces

  !> Impulse and work of the load, with the mean node velocity of the step.
  subroutine book_load(solid, b, dt, frame, loaded)
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: dt
    type(cell_frame), intent(in) :: frame
    type(loaded_cells), intent(in) :: loaded
    real(wp) :: work, impulse(3)
    integer :: n, d, i, j, k, field, last(3)
    work = 0
    impulse = 0
    do n = 1, loaded%n
      i = loaded%cell(1, n)
      j = loaded%cell(2, n)
      k = loaded%cell(3, n)
      last = functions_in(frame, [i, j, k])
      do field = 1, solid%n_fields
        if (.not. allocated(solid%force(field, b)%a) .or. field == solid%rigid_field) cycle ! which has books of its own
        do d = 1, 3
          associate (force => loaded%force(:last(1), :last(2), :last(3), d, field, n), to => [i, j, k] - 2 + last, &
                     node => solid%node(field, b)%a, change => solid%force(field, b)%a)
            impulse(d) = impulse(d) + dt*sum(force)
            work = work + dt*sum(force*(node(i - 1:to(1), d + 1, j - 1:to(2), k - 1:to(3)) &
                                        - 0.5_wp*change(i - 1:to(1), d, j - 1:to(2), k - 1:to(3))))
          end associate
        end do
      end do
    end do
    associate (books => solid%books(:, b))
      books(book_coupling_impulse:book_coupling_impulse + 2) = books(book_coupling_impulse:book_coupling_impulse + 2) + impulse
      books(book_coupling_work) = books(book_coupling_work) + work
    end associate
  end subroutine book_load

  !> Velocity of the solid at the centre of a cell of local brick b that holds particles: with linear functions the mean over the
  !> cell's nodes. Nodes without mass take no part; several fields count by their mass.
  pure function cell_velocity(solid, frame, b, cell) result(velocity)
    type(solid_type), intent(in) :: solid
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: b, cell(3)
    real(wp) :: velocity(3)
    type(line_functions) :: line
    real(wp) :: w(3, 3), weight, total, mass, v(3), half
    integer :: d, i, j, k, field, last(3)
    do d = 1, 3
      line = functions_of(frame, d, cell(d))
      last(d) = line%n
      half = 0.5_wp*(line%linear + 0.5_wp*line%quadratic)
      w(:, d) = line%p(0, :) + half*(line%p(1, :) + line%p(2, :))
    end do
    velocity = 0
    total = 0
    do k = 1, last(3)
      do j = 1, last(2)
        do i = 1, last(1)
          mass = 0
          v = 0
          do field = 1, solid%n_fields
            if (.not. allocated(solid%node(field, b)%a)) cycle
            associate (node => solid%node(field, b)%a(cell(1) - 2 + i, :, cell(2) - 2 + j, cell(3) - 2 + k))
              if (.not. node(1) > 0) cycle
              mass = mass + node(1)
              v = v + (node(1)/mass)*(node(2:4) - v)
            end associate
          end do
          if (.not. mass > 0) cycle
          weight = w(i, 1)*w(j, 2)*w(k, 3)
          total = total + weight
          velocity = velocity + weight*v
        end do
      end do
    end do
    if (total > 0) velocity = velocity/total
  end function cell_velocity

  !> Number of functions that a cell sees along each direction.
  pure function functions_in(frame, cell) result(n)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: cell(3)
    integer :: n(3)
    type(line_functions) :: line
    integer :: d
    do d = 1, 3
      line = functions_of(frame, d, cell(d))
      n(d) = line%n
    end do
  end function functions_in

end module solid_load
