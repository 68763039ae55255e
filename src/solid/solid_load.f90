!> Forces from outside on the particles of a cell, and the velocity that the outside sees there.
module solid_load
  use blocks, only: block
  use cell_functions, only: cell_frame
  use kinds, only: wp
  use mesh, only: mesh_type
  use solid_state, only: solid_type, frame_of, book_coupling_impulse, book_coupling_work
  use tensor_functions, only: functions_of, line_functions
  use tensor_scatter, only: sum_tensor
  implicit none
  private
  public :: apply_load, book_load, cell_velocity

  !> Cells of a brick that carry a load.
  type, public :: loaded_cells
    integer :: n = 0
    integer, allocatable :: cell(:, :) !< (3, n)
    real(wp), allocatable :: force(:, :) !< (3, n) per particle
    real(wp), allocatable :: weight(:, :, :, :, :) !< (3, 3, 3, field, n) sum of each node's function over the cell's particles
  end type loaded_cells

contains

  !> Adds the load to this brick's part of the node forces.
  subroutine apply_load(mesh, solid, b, load, loaded)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: b
    type(block), intent(in) :: load
    type(loaded_cells), intent(inout) :: loaded
    type(cell_frame) :: frame
    integer :: i, j, k, d, cell, set, n, field, last(3), pass
    frame = frame_of(mesh, solid%order, b)
    do pass = 1, 2
      n = 0
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            if (.not. (solid%count(b)%a(i, 1, j, k) > 0 .and. any(abs(load%a(i, 1:3, j, k)) > 0))) cycle
            n = n + 1
            if (pass == 1) cycle
            loaded%cell(:, n) = [i, j, k]
            loaded%force(:, n) = load%a(i, 1:3, j, k)/solid%count(b)%a(i, 1, j, k)
          end do
        end do
      end do
      if (pass == 1) allocate (loaded%cell(3, n), loaded%force(3, n), loaded%weight(3, 3, 3, solid%n_fields, n))
    end do
    loaded%n = n
    loaded%weight = 0
    do n = 1, loaded%n
      i = loaded%cell(1, n)
      j = loaded%cell(2, n)
      k = loaded%cell(3, n)
      cell = i + mesh%brick_cells(1)*(j - 1 + mesh%brick_cells(2)*(k - 1))
      do set = 1, solid%n_sets
        associate (blk => solid%block(set, b))
          if (blk%n > 0) call sum_tensor(frame, [i, j, k], blk%capacity, size(blk%f, 2), blk%f, blk%cell_start(cell), &
            blk%cell_start(cell + 1) - 1, loaded%weight(:, :, :, solid%field_of_set(set), n))
        end associate
      end do
      last = functions_in(frame, [i, j, k])
      do field = 1, solid%n_fields
        if (.not. allocated(solid%force(field, b)%a) .or. field == solid%rigid_field) cycle
        do d = 1, 3
          associate (at => solid%force(field, b)%a(i - 1:i - 2 + last(1), d, j - 1:j - 2 + last(2), k - 1:k - 2 + last(3)))
            at = at + loaded%force(d, n)*loaded%weight(:last(1), :last(2), :last(3), field, n)
          end associate
        end do
      end do
    end do
  end subroutine apply_load

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
          associate (weight => loaded%weight(:last(1), :last(2), :last(3), field, n), to => [i, j, k] - 2 + last, &
                     node => solid%node(field, b)%a, change => solid%force(field, b)%a)
            impulse(d) = impulse(d) + dt*loaded%force(d, n)*sum(weight)
            work = work + dt*loaded%force(d, n)*sum(weight*(node(i - 1:to(1), d + 1, j - 1:to(2), k - 1:to(3)) &
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
