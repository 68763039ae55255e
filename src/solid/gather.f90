!> Nodes to particles, one brick and one set at a time; inner loops run over the particles of a cell.
module gather
  use cell_functions, only: cell_frame, weights, trilinear, edge, chunk, piece
  use kinds, only: wp
  use particles, only: at_position, at_velocity
  use scatter, only: add_momentum
  implicit none
  private
  public :: update_velocity, gather_motion, count_outside, list_outside

contains

  !> Nodes to particles and back: v = flip (v + sum N dv) + (1 - flip) sum N v_node; with `again` adds the new particle momenta to
  !> momentum (MUSL). change: velocity change dv of the nodes; node: (mass, new velocity).
  pure subroutine update_velocity(frame, flip, again, capacity, n_field, f, cell_start, change, node, momentum)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: flip
    logical, intent(in) :: again
    integer, intent(in) :: capacity, n_field, cell_start(:)
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp), intent(in) :: change(0:frame%n(1), 3, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(in) :: node(0:frame%n(1), 4, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(inout) :: momentum(0:frame%n(1), 3, 0:frame%n(2), 0:frame%n(3))
    real(wp) :: wx(piece, 2), wy(piece, 2), wz(piece, 2), c(8, 3)
    integer :: i, j, k, cell, first, n, d
    cell = 0
    do k = 1, frame%n(3)
      do j = 1, frame%n(2)
        do i = 1, frame%n(1)
          cell = cell + 1
          if (cell_start(cell + 1) == cell_start(cell)) cycle
          call trilinear(frame%n, 3, change, 0, i, j, k, c)
          do first = cell_start(cell), cell_start(cell + 1) - 1, piece
            n = min(piece, cell_start(cell + 1) - first)
            call weights(frame, n, [i, j, k], f(first, at_position), f(first, at_position + 1), f(first, at_position + 2), &
              wx, wy, wz)
            do d = 1, 3
              call add_field(n, c(:, d), wx(:, 2), wy(:, 2), wz(:, 2), f(first, at_velocity + d - 1))
            end do
            if (flip < 1) call blend(frame, flip, n, [i, j, k], node, wx, wy, wz, capacity, n_field, f, first)
            if (again) call add_momentum(frame, n, capacity, f(first, 1), wx, wy, wz, i, j, k, momentum)
          end do
        end do
      end do
    end do
  end subroutine update_velocity

  !> value = value + trilinear function at (x, y, z).
  pure subroutine add_field(n, c, x, y, z, value)
    integer, intent(in) :: n
    real(wp), intent(in) :: c(8), x(n), y(n), z(n)
    real(wp), intent(inout) :: value(n)
    integer :: q
    !$omp simd
    do q = 1, n
      value(q) = value(q) + (((c(8)*z(q) + c(5))*y(q) + (c(6)*z(q) + c(2)))*x(q) + ((c(7)*z(q) + c(3))*y(q) + (c(4)*z(q) + c(1))))
    end do
  end subroutine add_field

  !> The PIC part of the velocity.
  pure subroutine blend(frame, flip, n, cell, node, wx, wy, wz, capacity, n_field, f, first)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: n, cell(3), capacity, n_field, first
    real(wp), intent(in) :: flip, node(0:frame%n(1), 4, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(in) :: wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(inout) :: f(capacity, n_field)
    real(wp) :: c(8, 3), pic(piece)
    integer :: d, i, j, k, q
    i = cell(1)
    j = cell(2)
    k = cell(3)
    call trilinear(frame%n, 4, node, 1, i, j, k, c)
    do d = 1, 3
      pic(:n) = 0
      call add_field(n, c(:, d), wx(:, 2), wy(:, 2), wz(:, 2), pic)
      do q = 1, n
        f(first + q - 1, at_velocity + d - 1) = flip*f(first + q - 1, at_velocity + d - 1) + (1 - flip)*pic(q)
      end do
    end do
  end subroutine blend

  !> Moves particles first..last over dt with the node velocities and gives the gradient increments from the mapped velocities.
  !>
  !> cell: the cell that holds particle first; on return the cell of the last one. gradient(:,3*(i-1)+j) = strain_dt dv_i/dx_j.
  !> moved(:n_moved): particles that are now outside their cell.
  pure subroutine gather_motion(frame, dt, strain_dt, capacity, n_field, f, cell_start, first, last, cell, node, mapped, &
    gradient, n_moved, moved)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: dt, strain_dt
    integer, intent(in) :: capacity, n_field, cell_start(:), first, last
    real(wp), intent(inout) :: f(capacity, n_field)
    integer, intent(inout) :: cell
    real(wp), intent(in) :: node(0:frame%n(1), 4, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(in) :: mapped(0:frame%n(1), 3, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(out) :: gradient(chunk, 9)
    integer, intent(out) :: n_moved, moved(chunk)
    real(wp) :: x(chunk), y(chunk), z(chunk), c(8, 3), o(3)
    integer :: start, stop_at, n, d, i, j, k, q, outside
    n_moved = 0
    start = first
    do
      stop_at = min(cell_start(cell + 1) - 1, last)
      n = stop_at - start + 1
      if (n > 0) then
        k = (cell - 1)/(frame%n(1)*frame%n(2)) + 1
        j = mod((cell - 1)/frame%n(1), frame%n(2)) + 1
        i = mod(cell - 1, frame%n(1)) + 1
        o = real(frame%offset + [i, j, k] - 1, wp)
        call local_coordinate(n, f(start, at_position), frame%lower(1), frame%inverse(1), o(1), x)
        call local_coordinate(n, f(start, at_position + 1), frame%lower(2), frame%inverse(2), o(2), y)
        call local_coordinate(n, f(start, at_position + 2), frame%lower(3), frame%inverse(3), o(3), z)
        q = start - first + 1
        call trilinear(frame%n, 4, node, 1, i, j, k, c)
        c = dt*c
        do d = 1, 3
          call add_field(n, c(:, d), x, y, z, f(start, at_position + d - 1))
        end do
        call trilinear(frame%n, 3, mapped, 0, i, j, k, c)
        c = strain_dt*c
        do d = 1, 3
          call field_gradient(n, c(:, d), frame%inverse, x, y, z, gradient(q, 3*d - 2), gradient(q, 3*d - 1), gradient(q, 3*d))
        end do
        call count_outside(n, frame, o, f(start, at_position), f(start, at_position + 1), f(start, at_position + 2), outside)
        if (outside > 0) call list_outside(n, frame, o, f(start, at_position), f(start, at_position + 1), &
          f(start, at_position + 2), start, n_moved, moved)
      end if
      start = stop_at + 1
      if (start > last) exit
      cell = cell + 1
    end do
  end subroutine gather_motion

  pure subroutine local_coordinate(n, x, lower, inverse, origin, t)
    integer, intent(in) :: n
    real(wp), intent(in) :: x(n), lower, inverse, origin
    real(wp), intent(out) :: t(n)
    integer :: q
    !$omp simd
    do q = 1, n
      t(q) = min(max((x(q) - lower)*inverse - origin, edge), 1 - edge)
    end do
  end subroutine local_coordinate

  pure subroutine field_gradient(n, c, inverse, x, y, z, gx, gy, gz)
    integer, intent(in) :: n
    real(wp), intent(in) :: c(8), inverse(3), x(n), y(n), z(n)
    real(wp), intent(out) :: gx(n), gy(n), gz(n)
    real(wp) :: mixed, hx, hy, hz
    integer :: q
    hx = inverse(1)
    hy = inverse(2)
    hz = inverse(3)
    !$omp simd private(mixed)
    do q = 1, n
      mixed = c(8)*z(q) + c(5)
      gx(q) = (mixed*y(q) + (c(6)*z(q) + c(2)))*hx
      gy(q) = (mixed*x(q) + (c(7)*z(q) + c(3)))*hy
      gz(q) = ((c(8)*x(q) + c(7))*y(q) + (c(6)*x(q) + c(4)))*hz
    end do
  end subroutine field_gradient

  !> Number of particles that are not in the cell whose low corner has the cell coordinates o.
  pure subroutine count_outside(n, frame, o, x, y, z, outside)
    integer, intent(in) :: n
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: o(3), x(n), y(n), z(n)
    integer, intent(out) :: outside
    real(wp) :: farthest, tx, ty, tz
    integer :: q
    farthest = 0
    !$omp simd private(tx, ty, tz) reduction(max:farthest)
    do q = 1, n
      tx = (x(q) - frame%lower(1))*frame%inverse(1)
      ty = (y(q) - frame%lower(2))*frame%inverse(2)
      tz = (z(q) - frame%lower(3))*frame%inverse(3)
      tx = merge(0.0_wp, 1.0_wp, tx >= o(1) .and. tx < o(1) + 1)
      ty = merge(0.0_wp, 1.0_wp, ty >= o(2) .and. ty < o(2) + 1)
      tz = merge(0.0_wp, 1.0_wp, tz >= o(3) .and. tz < o(3) + 1)
      farthest = max(farthest, tx + ty + tz)
    end do
    outside = nint(farthest)
  end subroutine count_outside

  pure subroutine list_outside(n, frame, o, x, y, z, start, n_moved, moved)
    integer, intent(in) :: n, start
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: o(3), x(n), y(n), z(n)
    integer, intent(inout) :: n_moved, moved(chunk)
    real(wp) :: t(3)
    integer :: q
    do q = 1, n
      t = ([x(q), y(q), z(q)] - frame%lower)*frame%inverse
      if (all(t >= o .and. t < o + 1)) cycle
      n_moved = n_moved + 1
      moved(n_moved) = start + q - 1
    end do
  end subroutine list_outside

end module gather
