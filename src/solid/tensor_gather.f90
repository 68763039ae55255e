!> Nodes to particles by any functions that are products of lines (module tensor_functions); loops run over particles of a cell.
module tensor_gather
  use cell_functions, only: cell_frame, chunk, piece
  use gather, only: count_outside, list_outside
  use kinds, only: wp
  use particles, only: at_position, at_velocity
  use tensor_functions, only: functions_of, make_lanes, tensor_weights, affine_weights, line_functions, lane_functions, &
    most_lanes
  use tensor_scatter, only: add_momentum_by_tensor, add_row
  implicit none
  private
  public :: update_velocity_by_tensor, gather_motion_by_tensor

contains

  !> Nodes to particles and back, see update_velocity of module gather. affine: first of the 9 columns of the affine matrix C,
  !> 0: none. With it the velocity is that of the nodes, v = sum N v_node, and C = sum N v_node (X - x) D^-1.
  !> again: add the new momenta to `momentum`.
  pure subroutine update_velocity_by_tensor(frame, flip, affine, again, capacity, n_field, f, cell_start, change, node, momentum)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: flip
    logical, intent(in) :: again
    integer, intent(in) :: affine, capacity, n_field, cell_start(:)
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp), intent(in) :: change(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(in) :: node(0:frame%last(1), 4, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(inout) :: momentum(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    type(line_functions) :: x(frame%n(1)), y, z
    type(lane_functions) :: lanes
    real(wp) :: row(most_lanes, 4, 0:frame%last(1) + 2), w(piece, 3, 3), slope(piece, 3, 3)
    integer :: i, j, k, cell, first, last, start, n
    do i = 1, frame%n(1)
      x(i) = functions_of(frame, 1, i)
    end do
    cell = 0
    do k = 1, frame%n(3)
      z = functions_of(frame, 3, k)
      do j = 1, frame%n(2)
        if (cell_start(cell + 1) == cell_start(cell + frame%n(1) + 1)) then
          cell = cell + frame%n(1)
          cycle
        end if
        y = functions_of(frame, 2, j)
        call make_lanes(y, z, lanes)
        row = 0
        do i = 1, frame%n(1)
          cell = cell + 1
          first = cell_start(cell)
          last = cell_start(cell + 1) - 1
          do start = first, last, piece
            n = min(piece, last - start + 1)
            call tensor_weights(x(i), n, f(start, at_position), w(:, :, 1), slope(:, :, 1))
            call tensor_weights(y, n, f(start, at_position + 1), w(:, :, 2), slope(:, :, 2))
            call tensor_weights(z, n, f(start, at_position + 2), w(:, :, 3), slope(:, :, 3))
            call update_cell(frame, flip, affine, x(i), y, z, i, j, k, start, n, w, slope, change, node, capacity, n_field, f)
            if (again) call add_momentum_by_tensor(x(i), y, z, lanes, n, w(:, :, 1), affine, capacity, f(start, 1), &
              row(1, 1, i - 1))
          end do
        end do
        if (again) call add_row(frame%last, 3, 1, 4, y%n, z%n, row, j, k, momentum)
      end do
    end do
  end subroutine update_velocity_by_tensor

  !> New velocities of n <= piece particles from `start` on. w, slope: their functions; slope is used up.
  pure subroutine update_cell(frame, flip, affine, x, y, z, i, j, k, start, n, w, slope, change, node, capacity, n_field, f)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: flip
    type(line_functions), intent(in) :: x, y, z
    integer, intent(in) :: affine, i, j, k, start, n, capacity, n_field
    real(wp), intent(in) :: w(piece, 3, 3)
    real(wp), intent(inout) :: slope(piece, 3, 3)
    real(wp), intent(in) :: change(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(in) :: node(0:frame%last(1), 4, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp) :: v(3, 3, 3), pic(piece)
    integer :: d, q
    if (affine > 0) then
      call affine_weights(x, n, f(start, at_position), w(:, :, 1), slope(:, :, 1))
      call affine_weights(y, n, f(start, at_position + 1), w(:, :, 2), slope(:, :, 2))
      call affine_weights(z, n, f(start, at_position + 2), w(:, :, 3), slope(:, :, 3))
      do d = 1, 3
        call values_of_cell(frame%last, 4, 1 + d, x%n, y%n, z%n, i, j, k, node, v)
        call field_values(n, z%n, v, w, f(start, at_velocity + d - 1))
        call field_gradients(n, z%n, v, w, slope, 1.0_wp, f(start, affine + 3*d - 3), f(start, affine + 3*d - 2), &
          f(start, affine + 3*d - 1))
      end do
      return
    end if
    do d = 1, 3
      call values_of_cell(frame%last, 3, d, x%n, y%n, z%n, i, j, k, change, v)
      call field_values(n, z%n, v, w, pic)
      do q = 1, n
        f(start + q - 1, at_velocity + d - 1) = f(start + q - 1, at_velocity + d - 1) + pic(q)
      end do
      if (flip < 1) then
        call values_of_cell(frame%last, 4, 1 + d, x%n, y%n, z%n, i, j, k, node, v)
        call field_values(n, z%n, v, w, pic)
        do q = 1, n
          f(start + q - 1, at_velocity + d - 1) = flip*f(start + q - 1, at_velocity + d - 1) + (1 - flip)*pic(q)
        end do
      end if
    end do
  end subroutine update_cell

  !> Moves particles and gives gradient increments, see gather_motion of module gather.
  pure subroutine gather_motion_by_tensor(frame, dt, strain_dt, capacity, n_field, f, cell_start, first, last, cell, node, mapped, &
    gradient, n_moved, moved)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: dt, strain_dt
    integer, intent(in) :: capacity, n_field, cell_start(:), first, last
    real(wp), intent(inout) :: f(capacity, n_field)
    integer, intent(inout) :: cell
    real(wp), intent(in) :: node(0:frame%last(1), 4, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(in) :: mapped(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(out) :: gradient(chunk, 9)
    integer, intent(out) :: n_moved, moved(chunk)
    type(line_functions) :: x, y, z
    real(wp) :: w(piece, 3, 3), slope(piece, 3, 3), v(3, 3, 3), step(piece, 3)
    integer :: start, stop_at, n, d, i, j, k, q, outside, row(2)
    n_moved = 0
    row = 0
    start = first
    do
      stop_at = min(cell_start(cell + 1) - 1, last, start + piece - 1)
      n = stop_at - start + 1
      if (n > 0) then
        k = (cell - 1)/(frame%n(1)*frame%n(2)) + 1
        j = mod((cell - 1)/frame%n(1), frame%n(2)) + 1
        i = mod(cell - 1, frame%n(1)) + 1
        x = functions_of(frame, 1, i)
        if (j /= row(1) .or. k /= row(2)) then
          y = functions_of(frame, 2, j)
          z = functions_of(frame, 3, k)
          row = [j, k]
        end if
        call tensor_weights(x, n, f(start, at_position), w(:, :, 1), slope(:, :, 1))
        call tensor_weights(y, n, f(start, at_position + 1), w(:, :, 2), slope(:, :, 2))
        call tensor_weights(z, n, f(start, at_position + 2), w(:, :, 3), slope(:, :, 3))
        q = start - first + 1
        do d = 1, 3
          call values_of_cell(frame%last, 4, 1 + d, x%n, y%n, z%n, i, j, k, node, v)
          call field_values(n, z%n, v, w, step(:, d))
          call values_of_cell(frame%last, 3, d, x%n, y%n, z%n, i, j, k, mapped, v)
          call field_gradients(n, z%n, v, w, slope, strain_dt, gradient(q, 3*d - 2), gradient(q, 3*d - 1), gradient(q, 3*d))
        end do
        call move(n, dt, step, f(start, at_position), f(start, at_position + 1), f(start, at_position + 2))
        call count_outside(n, frame, [x%origin, y%origin, z%origin], f(start, at_position), f(start, at_position + 1), &
          f(start, at_position + 2), outside)
        if (outside > 0) call list_outside(n, frame, [x%origin, y%origin, z%origin], f(start, at_position), &
          f(start, at_position + 1), f(start, at_position + 2), start, n_moved, moved)
      end if
      start = stop_at + 1
      if (start > last) exit
      if (start == cell_start(cell + 1)) cell = cell + 1
    end do
  end subroutine gather_motion_by_tensor

  !> Values of variable `variable` of a node field at the functions of cell (i, j, k); zero beyond the cell's functions.
  pure subroutine values_of_cell(last, n_var, variable, n_x, n_y, n_z, i, j, k, a, v)
    integer, intent(in) :: last(3), n_var, variable, n_x, n_y, n_z, i, j, k
    real(wp), intent(in) :: a(0:last(1), n_var, 0:last(2), 0:last(3))
    real(wp), intent(out) :: v(3, 3, 3)
    integer :: s, b, c
    if (n_x == 3 .and. n_y == 3) then
      do c = 1, n_z
        do b = 1, 3 ! written out: a loop over three would become a call to copy memory
          v(1, b, c) = a(i - 1, variable, j - 2 + b, k - 2 + c)
          v(2, b, c) = a(i, variable, j - 2 + b, k - 2 + c)
          v(3, b, c) = a(i + 1, variable, j - 2 + b, k - 2 + c)
        end do
      end do
    else
      v = 0
      do c = 1, n_z
        do b = 1, n_y
          do s = 1, n_x
            v(s, b, c) = a(i - 2 + s, variable, j - 2 + b, k - 2 + c)
          end do
        end do
      end do
    end if
  end subroutine values_of_cell

  !> Values of a field at n particles.
  pure subroutine field_values(n, n_z, v, w, value)
    integer, intent(in) :: n, n_z
    real(wp), intent(in) :: v(9, 3), w(piece, 3, 3)
    real(wp), intent(out) :: value(n)
    real(wp) :: v1, v2, v3, v4, v5, v6, v7, v8, v9, plane(piece, 3)
    integer :: q, c
    do c = 1, n_z
      v1 = v(1, c); v2 = v(2, c); v3 = v(3, c)
      v4 = v(4, c); v5 = v(5, c); v6 = v(6, c)
      v7 = v(7, c); v8 = v(8, c); v9 = v(9, c)
      !$omp simd
      do q = 1, n
        plane(q, c) = (w(q, 1, 2)*((w(q, 1, 1)*v1 + w(q, 2, 1)*v2) + w(q, 3, 1)*v3) &
          + w(q, 2, 2)*((w(q, 1, 1)*v4 + w(q, 2, 1)*v5) + w(q, 3, 1)*v6)) &
          + w(q, 3, 2)*((w(q, 1, 1)*v7 + w(q, 2, 1)*v8) + w(q, 3, 1)*v9)
      end do
    end do
    call weigh_planes(n, n_z, w(:, :, 3), plane, value)
  end subroutine field_values

  !> Sum of the planes that stand for the functions along z.
  pure subroutine weigh_planes(n, n_z, w, plane, value)
    integer, intent(in) :: n, n_z
    real(wp), intent(in) :: w(piece, 3), plane(piece, 3)
    real(wp), intent(out) :: value(n)
    integer :: q
    select case (n_z)
    case (1)
      !$omp simd
      do q = 1, n
        value(q) = w(q, 1)*plane(q, 1)
      end do
    case (2)
      !$omp simd
      do q = 1, n
        value(q) = w(q, 1)*plane(q, 1) + w(q, 2)*plane(q, 2)
      end do
    case default
      !$omp simd
      do q = 1, n
        value(q) = (w(q, 1)*plane(q, 1) + w(q, 2)*plane(q, 2)) + w(q, 3)*plane(q, 3)
      end do
    end select
  end subroutine weigh_planes

  !> Gradient of a field at n particles times `factor`; slope: derivatives of w, or what stands for them.
  pure subroutine field_gradients(n, n_z, v, w, slope, factor, gx, gy, gz)
    integer, intent(in) :: n, n_z
    real(wp), intent(in) :: v(9, 3), w(piece, 3, 3), slope(piece, 3, 3), factor
    real(wp), intent(out) :: gx(n), gy(n), gz(n)
    real(wp) :: v1, v2, v3, v4, v5, v6, v7, v8, v9, r1, r2, r3
    real(wp), dimension(piece, 3) :: plane_x, plane_y, plane
    integer :: q, c
    do c = 1, n_z
      v1 = factor*v(1, c); v2 = factor*v(2, c); v3 = factor*v(3, c)
      v4 = factor*v(4, c); v5 = factor*v(5, c); v6 = factor*v(6, c)
      v7 = factor*v(7, c); v8 = factor*v(8, c); v9 = factor*v(9, c)
      !$omp simd private(r1, r2, r3)
      do q = 1, n
        plane_x(q, c) = (w(q, 1, 2)*((slope(q, 1, 1)*v1 + slope(q, 2, 1)*v2) + slope(q, 3, 1)*v3) &
          + w(q, 2, 2)*((slope(q, 1, 1)*v4 + slope(q, 2, 1)*v5) + slope(q, 3, 1)*v6)) &
          + w(q, 3, 2)*((slope(q, 1, 1)*v7 + slope(q, 2, 1)*v8) + slope(q, 3, 1)*v9)
        r1 = (w(q, 1, 1)*v1 + w(q, 2, 1)*v2) + w(q, 3, 1)*v3
        r2 = (w(q, 1, 1)*v4 + w(q, 2, 1)*v5) + w(q, 3, 1)*v6
        r3 = (w(q, 1, 1)*v7 + w(q, 2, 1)*v8) + w(q, 3, 1)*v9
        plane_y(q, c) = (slope(q, 1, 2)*r1 + slope(q, 2, 2)*r2) + slope(q, 3, 2)*r3
        plane(q, c) = (w(q, 1, 2)*r1 + w(q, 2, 2)*r2) + w(q, 3, 2)*r3
      end do
    end do
    call weigh_planes(n, n_z, w(:, :, 3), plane_x, gx)
    call weigh_planes(n, n_z, w(:, :, 3), plane_y, gy)
    call weigh_planes(n, n_z, slope(:, :, 3), plane, gz)
  end subroutine field_gradients

  pure subroutine move(n, dt, step, x, y, z)
    integer, intent(in) :: n
    real(wp), intent(in) :: dt, step(piece, 3)
    real(wp), intent(inout) :: x(n), y(n), z(n)
    integer :: q
    !$omp simd
    do q = 1, n
      x(q) = x(q) + dt*step(q, 1)
      y(q) = y(q) + dt*step(q, 2)
      z(q) = z(q) + dt*step(q, 3)
    end do
  end subroutine move

end module tensor_gather
