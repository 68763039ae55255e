!> Particles to nodes by any functions that are products of lines (module tensor_functions), with or without an affine velocity.
!>
!> Inner loops run over the products of the functions along y and z (lanes); those along x stand outside. The sums of a row of cells
!> are kept by lane and x until the row is done, so nodes are added to once per row.
module tensor_scatter
  use cell_functions, only: cell_frame, piece
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress, at_viscosity
  use tensor_functions, only: functions_of, make_lanes, tensor_weights, tensor_bumps, line_functions, lane_functions, most_lanes
  implicit none
  private
  public :: scatter_by_tensor, add_momentum_by_tensor, add_row, scatter_columns

  integer, parameter :: sxx = at_stress, syy = at_stress + 1, szz = at_stress + 2
  integer, parameter :: syz = at_stress + 3, sxz = at_stress + 4, sxy = at_stress + 5

contains

  !> Adds mass, momentum and internal force -sum grad N . (stress - q) V of the particles of a brick to its nodes.
  !> affine: first of the 9 columns of the affine matrix C, velocity v + C (X - x) at the control point X; 0: none.
  !> node: (mass, momentum); force: 3 components.
  pure subroutine scatter_by_tensor(frame, affine, capacity, n_field, f, cell_start, node, force)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: affine, capacity, n_field, cell_start(:)
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(inout) :: node(0:frame%last(1), 4, 0:frame%last(2), 0:frame%last(3))
    real(wp), intent(inout) :: force(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    type(line_functions) :: x(frame%n(1)), y, z
    type(lane_functions) :: lanes
    real(wp) :: momentum(most_lanes, 4, 0:frame%last(1) + 2), push(most_lanes, 3, 0:frame%last(1) + 2)
    real(wp) :: w(piece, 3), slope_x(piece, 3), t(piece), bump(piece, 2, 2), slope(piece, 2, 2)
    integer :: i, j, k, cell, first, n
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
        momentum = 0
        push = 0
        do i = 1, frame%n(1)
          cell = cell + 1
          do first = cell_start(cell), cell_start(cell + 1) - 1, piece
            n = min(piece, cell_start(cell + 1) - first)
            call tensor_weights(x(i), n, f(first, at_position), w, slope_x)
            call tensor_bumps(y, n, f(first, at_position + 1), t, bump(:, :, 1), slope(:, :, 1))
            call tensor_bumps(z, n, f(first, at_position + 2), t, bump(:, :, 2), slope(:, :, 2))
            call sum_cell(n, x(i), y, z, lanes, w, bump, affine, capacity, f(first, 1), momentum(1, 1, i - 1))
            call sum_force(n, x(i)%n, lanes, w, slope_x, bump, slope, capacity, f(first, 1), push(1, 1, i - 1))
          end do
        end do
        call add_row(frame%last, 4, 0, 4, y%n, z%n, momentum, j, k, node)
        call add_row(frame%last, 3, 0, 3, y%n, z%n, push, j, k, force)
      end do
    end do
  end subroutine scatter_by_tensor

  !> Adds masses and momenta of n <= piece particles of a cell to the sums of its row. f: their first row; w: their functions
  !> along x.
  pure subroutine add_momentum_by_tensor(x, y, z, lanes, n, w, affine, capacity, f, row)
    type(line_functions), intent(in) :: x, y, z
    type(lane_functions), intent(in) :: lanes
    integer, intent(in) :: n, affine, capacity
    real(wp), intent(in) :: w(piece, 3), f(capacity, *)
    real(wp), intent(inout) :: row(most_lanes, 4, 3)
    real(wp) :: t(piece), bump(piece, 2, 2), unused(piece, 2)
    call tensor_bumps(y, n, f(1, at_position + 1), t, bump(:, :, 1), unused)
    call tensor_bumps(z, n, f(1, at_position + 2), t, bump(:, :, 2), unused)
    call sum_cell(n, x, y, z, lanes, w, bump, affine, capacity, f, row)
  end subroutine add_momentum_by_tensor

  !> Adds columns skip+1, skip+2, ... of the sums of a row of cells to the variables of its nodes.
  pure subroutine add_row(last, n_var, skip, n_part, n_y, n_z, row, j, k, a)
    integer, intent(in) :: last(3), n_var, skip, n_part, n_y, n_z, j, k
    real(wp), intent(in) :: row(most_lanes, n_part, 0:last(1) + 2)
    real(wp), intent(inout) :: a(0:last(1), n_var, 0:last(2), 0:last(3))
    integer :: b, c, v, i, l
    l = 0
    do c = 1, n_z
      do b = 1, n_y
        l = l + 1
        do v = 1, n_var
          do i = 0, last(1)
            a(i, v, j - 2 + b, k - 2 + c) = a(i, v, j - 2 + b, k - 2 + c) + row(l, skip + v, i)
          end do
        end do
      end do
    end do
  end subroutine add_row

  !> Mass and momentum of n <= piece particles at the nodes of their cell: total(lane, variable, function along x).
  !> w: functions along x; bump: what those along y and z are made of.
  pure subroutine sum_cell(n, x, y, z, lanes, w, bump, affine, capacity, f, total)
    integer, intent(in) :: n, affine, capacity
    type(line_functions), intent(in) :: x, y, z
    type(lane_functions), intent(in) :: lanes
    real(wp), intent(in) :: w(piece, 3), bump(piece, 2, 2), f(capacity, *)
    real(wp), intent(inout) :: total(most_lanes, 4, 3)
    real(wp) :: t(piece, 3), unused(piece, 2), other(piece, 2)
    if (affine > 0) then
      call tensor_bumps(x, n, f(1, at_position), t(:, 1), unused, other)
      call tensor_bumps(y, n, f(1, at_position + 1), t(:, 2), unused, other)
      call tensor_bumps(z, n, f(1, at_position + 2), t(:, 3), unused, other)
      call sum_affine(n, x%n, lanes%y, lanes%z, lanes%at_y, lanes%at_z, x%at, 1/[x%inverse, y%inverse, z%inverse], t, w, &
        bump, f(1, at_mass), f(1, at_velocity), f(1, at_velocity + 1), f(1, at_velocity + 2), capacity, f(1, affine), total)
    else
      call sum_momentum(n, x%n, lanes%y, lanes%z, w, bump, f(1, at_mass), f(1, at_velocity), f(1, at_velocity + 1), &
        f(1, at_velocity + 2), total)
    end if
  end subroutine sum_cell

  pure subroutine sum_momentum(n, n_x, y, z, wx, bump, mass, v1, v2, v3, total)
    integer, intent(in) :: n, n_x
    real(wp), intent(in) :: y(most_lanes, 0:2), z(most_lanes, 0:2), wx(piece, 3), bump(piece, 2, 2)
    real(wp), intent(in), dimension(n) :: mass, v1, v2, v3
    real(wp), intent(inout) :: total(most_lanes, 4, 3)
    real(wp) :: w(most_lanes), b1, b2, b3, b4, m, u1, u2, u3, part
    integer :: q, a, l
    do q = 1, n
      b1 = bump(q, 1, 1)
      b2 = bump(q, 2, 1)
      b3 = bump(q, 1, 2)
      b4 = bump(q, 2, 2)
      u1 = v1(q)
      u2 = v2(q)
      u3 = v3(q)
      !$omp simd
      do l = 1, most_lanes
        w(l) = (y(l, 0) + (y(l, 1)*b1 + y(l, 2)*b2))*(z(l, 0) + (z(l, 1)*b3 + z(l, 2)*b4))
      end do
      do a = 1, n_x
        m = mass(q)*wx(q, a)
        !$omp simd private(part)
        do l = 1, most_lanes
          part = m*w(l)
          total(l, 1, a) = total(l, 1, a) + part
          total(l, 2, a) = total(l, 2, a) + part*u1
          total(l, 3, a) = total(l, 3, a) + part*u2
          total(l, 4, a) = total(l, 4, a) + part*u3
        end do
      end do
    end do
  end subroutine sum_momentum

  !> With the velocity v + C (X - x). at_x, at_y, at_z: control points X in cell coordinates; t: particles likewise; h: cell sizes.
  pure subroutine sum_affine(n, n_x, y, z, at_y, at_z, at_x, h, t, wx, bump, mass, v1, v2, v3, capacity, c, total)
    integer, intent(in) :: n, n_x, capacity
    real(wp), intent(in) :: y(most_lanes, 0:2), z(most_lanes, 0:2), at_y(most_lanes), at_z(most_lanes), at_x(3), h(3)
    real(wp), intent(in) :: t(piece, 3), wx(piece, 3), bump(piece, 2, 2), c(capacity, 9)
    real(wp), intent(in), dimension(n) :: mass, v1, v2, v3
    real(wp), intent(inout) :: total(most_lanes, 4, 3)
    real(wp) :: u(most_lanes, 3), w(most_lanes), b1, b2, b3, b4, c1, c2, c3, base, m, part, s1, s2, s3
    integer :: q, a, l, d
    do q = 1, n
      b1 = bump(q, 1, 1)
      b2 = bump(q, 2, 1)
      b3 = bump(q, 1, 2)
      b4 = bump(q, 2, 2)
      !$omp simd
      do l = 1, most_lanes
        w(l) = (y(l, 0) + (y(l, 1)*b1 + y(l, 2)*b2))*(z(l, 0) + (z(l, 1)*b3 + z(l, 2)*b4))
      end do
      do d = 1, 3
        if (d == 1) base = v1(q)
        if (d == 2) base = v2(q)
        if (d == 3) base = v3(q)
        c1 = c(q, 3*d - 2)*h(1)
        c2 = c(q, 3*d - 1)*h(2)
        c3 = c(q, 3*d)*h(3)
        base = base - ((c1*t(q, 1) + c2*t(q, 2)) + c3*t(q, 3))
        !$omp simd
        do l = 1, most_lanes
          u(l, d) = base + (c2*at_y(l) + c3*at_z(l))
        end do
      end do
      do a = 1, n_x
        m = mass(q)*wx(q, a)
        s1 = c(q, 1)*h(1)*at_x(a)
        s2 = c(q, 4)*h(1)*at_x(a)
        s3 = c(q, 7)*h(1)*at_x(a)
        !$omp simd private(part)
        do l = 1, most_lanes
          part = m*w(l)
          total(l, 1, a) = total(l, 1, a) + part
          total(l, 2, a) = total(l, 2, a) + part*(u(l, 1) + s1)
          total(l, 3, a) = total(l, 3, a) + part*(u(l, 2) + s2)
          total(l, 4, a) = total(l, 4, a) + part*(u(l, 3) + s3)
        end do
      end do
    end do
  end subroutine sum_affine

  !> Internal force of n <= piece particles at the nodes of their cell: total(lane, component, function along x).
  pure subroutine sum_force(n, n_x, lanes, w, slope_x, bump, slope, capacity, f, total)
    integer, intent(in) :: n, n_x, capacity
    type(lane_functions), intent(in) :: lanes
    real(wp), intent(in) :: w(piece, 3), slope_x(piece, 3), bump(piece, 2, 2), slope(piece, 2, 2), f(capacity, *)
    real(wp), intent(inout) :: total(most_lanes, 3, 3)
    real(wp) :: flux(piece, 6)
    integer :: q
    !$omp simd
    do q = 1, n
      flux(q, 1) = -f(q, at_volume)*(f(q, sxx) - f(q, at_viscosity))
      flux(q, 2) = -f(q, at_volume)*(f(q, syy) - f(q, at_viscosity))
      flux(q, 3) = -f(q, at_volume)*(f(q, szz) - f(q, at_viscosity))
      flux(q, 4) = -f(q, at_volume)*f(q, syz)
      flux(q, 5) = -f(q, at_volume)*f(q, sxz)
      flux(q, 6) = -f(q, at_volume)*f(q, sxy)
    end do
    call sum_flux(n, n_x, lanes%y, lanes%z, w, slope_x, bump, slope, flux, total)
  end subroutine sum_force

  pure subroutine sum_flux(n, n_x, y, z, wx, slope_x, bump, slope, flux, total)
    integer, intent(in) :: n, n_x
    real(wp), intent(in) :: y(most_lanes, 0:2), z(most_lanes, 0:2), wx(piece, 3), slope_x(piece, 3), bump(piece, 2, 2)
    real(wp), intent(in) :: slope(piece, 2, 2), flux(piece, 6)
    real(wp), intent(inout) :: total(most_lanes, 3, 3)
    real(wp), dimension(most_lanes) :: w, slope_y, slope_z
    real(wp) :: b1, b2, b3, b4, s1, s2, s3, s4, wy, wz, g1, g2, g3, f2, f3, f4, f5, f6
    integer :: q, a, l
    do q = 1, n
      b1 = bump(q, 1, 1)
      b2 = bump(q, 2, 1)
      b3 = bump(q, 1, 2)
      b4 = bump(q, 2, 2)
      s1 = slope(q, 1, 1)
      s2 = slope(q, 2, 1)
      s3 = slope(q, 1, 2)
      s4 = slope(q, 2, 2)
      !$omp simd private(wy, wz)
      do l = 1, most_lanes
        wy = y(l, 0) + (y(l, 1)*b1 + y(l, 2)*b2)
        wz = z(l, 0) + (z(l, 1)*b3 + z(l, 2)*b4)
        w(l) = wy*wz
        slope_y(l) = (y(l, 1)*s1 + y(l, 2)*s2)*wz
        slope_z(l) = wy*(z(l, 1)*s3 + z(l, 2)*s4)
      end do
      do a = 1, n_x
        g1 = slope_x(q, a)*flux(q, 1)
        g2 = slope_x(q, a)*flux(q, 6)
        g3 = slope_x(q, a)*flux(q, 5)
        f2 = wx(q, a)*flux(q, 2)
        f3 = wx(q, a)*flux(q, 3)
        f4 = wx(q, a)*flux(q, 4)
        f5 = wx(q, a)*flux(q, 5)
        f6 = wx(q, a)*flux(q, 6)
        !$omp simd
        do l = 1, most_lanes
          total(l, 1, a) = total(l, 1, a) + ((g1*w(l) + f6*slope_y(l)) + f5*slope_z(l))
          total(l, 2, a) = total(l, 2, a) + ((g2*w(l) + f2*slope_y(l)) + f4*slope_z(l))
          total(l, 3, a) = total(l, 3, a) + ((g3*w(l) + f4*slope_y(l)) + f3*slope_z(l))
        end do
      end do
    end do
  end subroutine sum_flux

  !> Three columns of the particles first..last of one cell, from `at` on, at the nodes of the cell. total(function along x, y, z,
  !> column), added to.
  pure subroutine scatter_columns(frame, cell, at, capacity, n_field, f, first, last, total)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: cell(3), at, capacity, n_field, first, last
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(inout) :: total(3, 3, 3, 3)
    type(line_functions) :: x, y, z
    type(lane_functions) :: lanes
    real(wp) :: w(piece, 3), t(piece), bump(piece, 2, 2), unused(piece, 3), one(piece), row(most_lanes, 4, 3)
    integer :: start, n, a, b, c
    x = functions_of(frame, 1, cell(1))
    y = functions_of(frame, 2, cell(2))
    z = functions_of(frame, 3, cell(3))
    call make_lanes(y, z, lanes)
    one = 1
    row = 0
    do start = first, last, piece
      n = min(piece, last + 1 - start)
      call tensor_weights(x, n, f(start, at_position), w, unused)
      call tensor_bumps(y, n, f(start, at_position + 1), t, bump(:, :, 1), unused(:, 1:2))
      call tensor_bumps(z, n, f(start, at_position + 2), t, bump(:, :, 2), unused(:, 1:2))
      call sum_momentum(n, x%n, lanes%y, lanes%z, w, bump, one, f(start, at), f(start, at + 1), f(start, at + 2), row)
    end do
    do c = 1, z%n
      do b = 1, y%n
        do a = 1, x%n
          total(a, b, c, :) = total(a, b, c, :) + row(b + y%n*(c - 1), 2:4, a)
        end do
      end do
    end do
  end subroutine scatter_columns

end module tensor_scatter
