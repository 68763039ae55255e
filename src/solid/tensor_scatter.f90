!> Particles to nodes by any functions that are products of lines (module tensor_functions), with or without an affine velocity.
!>
!> Inner loops run over the products of the functions along y and z (lanes); those along x stand outside.
module tensor_scatter
  use cell_functions, only: cell_frame
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress, at_viscosity
  use tensor_functions, only: functions_of, make_lanes, line_functions, lane_functions, most_lanes
  implicit none
  private
  public :: scatter_by_tensor, add_momentum_by_tensor, sum_tensor

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
    type(line_functions) :: x, y, z
    type(lane_functions) :: lanes
    real(wp) :: momentum(most_lanes, 4, 3), push(most_lanes, 3, 3)
    integer :: i, j, k, cell, first, n
    cell = 0
    do k = 1, frame%n(3)
      z = functions_of(frame, 3, k)
      do j = 1, frame%n(2)
        y = functions_of(frame, 2, j)
        call make_lanes(y, z, lanes)
        do i = 1, frame%n(1)
          cell = cell + 1
          first = cell_start(cell)
          n = cell_start(cell + 1) - first
          if (n == 0) cycle
          x = functions_of(frame, 1, i)
          call sum_momentum(n, x, y, z, lanes, affine, capacity, f(first, 1), momentum)
          call sum_force(n, x, y, z, lanes, capacity, f(first, 1), push)
          call add_to_nodes(frame%last, 4, 0, 4, x%n, y%n, z%n, momentum, i, j, k, node)
          call add_to_nodes(frame%last, 3, 0, 3, x%n, y%n, z%n, push, i, j, k, force)
        end do
      end do
    end do
  end subroutine scatter_by_tensor

  !> Adds the momenta of the n particles of a cell to the nodes. f: their first row.
  pure subroutine add_momentum_by_tensor(frame, x, y, z, lanes, n, affine, capacity, f, i, j, k, node)
    type(cell_frame), intent(in) :: frame
    type(line_functions), intent(in) :: x, y, z
    type(lane_functions), intent(in) :: lanes
    integer, intent(in) :: n, affine, capacity, i, j, k
    real(wp), intent(in) :: f(capacity, *)
    real(wp), intent(inout) :: node(0:frame%last(1), 3, 0:frame%last(2), 0:frame%last(3))
    real(wp) :: momentum(most_lanes, 4, 3)
    call sum_momentum(n, x, y, z, lanes, affine, capacity, f, momentum)
    call add_to_nodes(frame%last, 3, 1, 4, x%n, y%n, z%n, momentum, i, j, k, node)
  end subroutine add_momentum_by_tensor

  !> Adds columns skip+1..n_part of the sums of a cell to variables 1, 2, ... of its nodes.
  pure subroutine add_to_nodes(last, n_var, skip, n_part, n_x, n_y, n_z, part, i, j, k, a)
    integer, intent(in) :: last(3), n_var, skip, n_part, n_x, n_y, n_z, i, j, k
    real(wp), intent(in) :: part(most_lanes, n_part, 3)
    real(wp), intent(inout) :: a(0:last(1), n_var, 0:last(2), 0:last(3))
    integer :: b, c, v, s, l
    l = 0
    do c = 1, n_z
      do b = 1, n_y
        l = l + 1
        do v = 1, n_var
          do s = 1, n_x
            a(i - 2 + s, v, j - 2 + b, k - 2 + c) = a(i - 2 + s, v, j - 2 + b, k - 2 + c) + part(l, skip + v, s)
          end do
        end do
      end do
    end do
  end subroutine add_to_nodes

  !> Mass and momentum at the nodes of a cell: total(lane, variable, function along x).
  pure subroutine sum_momentum(n, x, y, z, lanes, affine, capacity, f, total)
    integer, intent(in) :: n, affine, capacity
    type(line_functions), intent(in) :: x, y, z
    type(lane_functions), intent(in) :: lanes
    real(wp), intent(in) :: f(capacity, *)
    real(wp), intent(out) :: total(most_lanes, 4, 3)
    real(wp) :: t(3), bump(2, 3), w(most_lanes), m, u(3), c(3, 3), v(3), part
    integer :: q, a, d, l, n_lane
    n_lane = lanes%n
    total = 0
    do q = 1, n
      t = [coordinate(x, f(q, at_position)), coordinate(y, f(q, at_position + 1)), coordinate(z, f(q, at_position + 2))]
      bump(:, 1) = bumps(x, t(1))
      bump(:, 2) = bumps(y, t(2))
      bump(:, 3) = bumps(z, t(3))
      u = [f(q, at_velocity), f(q, at_velocity + 1), f(q, at_velocity + 2)]
      if (affine > 0) then
        do d = 1, 3
          c(d, 1) = f(q, affine + 3*d - 3)/x%inverse
          c(d, 2) = f(q, affine + 3*d - 2)/y%inverse
          c(d, 3) = f(q, affine + 3*d - 1)/z%inverse
        end do
        u = u - (c(:, 2)*t(2) + c(:, 3)*t(3))
      end if
      !$omp simd
      do l = 1, n_lane
        w(l) = (lanes%y(l, 0) + (lanes%y(l, 1)*bump(1, 2) + lanes%y(l, 2)*bump(2, 2))) &
          *(lanes%z(l, 0) + (lanes%z(l, 1)*bump(1, 3) + lanes%z(l, 2)*bump(2, 3)))
      end do
      do a = 1, x%n
        m = f(q, at_mass)*(x%p(0, a) + (x%p(1, a)*bump(1, 1) + x%p(2, a)*bump(2, 1)))
        if (affine > 0) then
          v = u + c(:, 1)*(x%at(a) - t(1))
          !$omp simd private(part)
          do l = 1, n_lane
            part = m*w(l)
            total(l, 1, a) = total(l, 1, a) + part
            total(l, 2, a) = total(l, 2, a) + part*(v(1) + (c(1, 2)*lanes%at_y(l) + c(1, 3)*lanes%at_z(l)))
            total(l, 3, a) = total(l, 3, a) + part*(v(2) + (c(2, 2)*lanes%at_y(l) + c(2, 3)*lanes%at_z(l)))
            total(l, 4, a) = total(l, 4, a) + part*(v(3) + (c(3, 2)*lanes%at_y(l) + c(3, 3)*lanes%at_z(l)))
          end do
        else
          !$omp simd private(part)
          do l = 1, n_lane
            part = m*w(l)
            total(l, 1, a) = total(l, 1, a) + part
            total(l, 2, a) = total(l, 2, a) + part*u(1)
            total(l, 3, a) = total(l, 3, a) + part*u(2)
            total(l, 4, a) = total(l, 4, a) + part*u(3)
          end do
        end if
      end do
    end do
  end subroutine sum_momentum

  !> Internal force at the nodes of a cell: total(lane, component, function along x).
  pure subroutine sum_force(n, x, y, z, lanes, capacity, f, total)
    integer, intent(in) :: n, capacity
    type(line_functions), intent(in) :: x, y, z
    type(lane_functions), intent(in) :: lanes
    real(wp), intent(in) :: f(capacity, *)
    real(wp), intent(out) :: total(most_lanes, 3, 3)
    real(wp) :: bump(2, 3), slope(2, 3), w(most_lanes), slope_y(most_lanes), slope_z(most_lanes)
    real(wp) :: v, s1, s2, s3, s4, s5, s6, wx, gx, f2, f3, f4, f5, f6, g1, g2, g3, wy, wz
    integer :: q, a, l, n_lane
    n_lane = lanes%n
    total = 0
    do q = 1, n
      call bumps_and_slopes(x, f(q, at_position), bump(:, 1), slope(:, 1))
      call bumps_and_slopes(y, f(q, at_position + 1), bump(:, 2), slope(:, 2))
      call bumps_and_slopes(z, f(q, at_position + 2), bump(:, 3), slope(:, 3))
      !$omp simd private(wy, wz)
      do l = 1, n_lane
        wy = lanes%y(l, 0) + (lanes%y(l, 1)*bump(1, 2) + lanes%y(l, 2)*bump(2, 2))
        wz = lanes%z(l, 0) + (lanes%z(l, 1)*bump(1, 3) + lanes%z(l, 2)*bump(2, 3))
        w(l) = wy*wz
        slope_y(l) = (lanes%y(l, 1)*slope(1, 2) + lanes%y(l, 2)*slope(2, 2))*wz
        slope_z(l) = wy*(lanes%z(l, 1)*slope(1, 3) + lanes%z(l, 2)*slope(2, 3))
      end do
      v = -f(q, at_volume)
      s1 = v*(f(q, sxx) - f(q, at_viscosity))
      s2 = v*(f(q, syy) - f(q, at_viscosity))
      s3 = v*(f(q, szz) - f(q, at_viscosity))
      s4 = v*f(q, syz)
      s5 = v*f(q, sxz)
      s6 = v*f(q, sxy)
      do a = 1, x%n
        wx = x%p(0, a) + (x%p(1, a)*bump(1, 1) + x%p(2, a)*bump(2, 1))
        gx = x%p(1, a)*slope(1, 1) + x%p(2, a)*slope(2, 1)
        g1 = gx*s1
        g2 = gx*s6
        g3 = gx*s5
        f2 = wx*s2
        f3 = wx*s3
        f4 = wx*s4
        f5 = wx*s5
        f6 = wx*s6
        !$omp simd
        do l = 1, n_lane
          total(l, 1, a) = total(l, 1, a) + ((g1*w(l) + f6*slope_y(l)) + f5*slope_z(l))
          total(l, 2, a) = total(l, 2, a) + ((g2*w(l) + f2*slope_y(l)) + f4*slope_z(l))
          total(l, 3, a) = total(l, 3, a) + ((g3*w(l) + f4*slope_y(l)) + f3*slope_z(l))
        end do
      end do
    end do
  end subroutine sum_force

  !> Coordinate in the cell along one direction.
  pure real(wp) function coordinate(functions, x)
    type(line_functions), intent(in) :: functions
    real(wp), intent(in) :: x
    coordinate = min(max((x - functions%lower)*functions%inverse - functions%origin, functions%least), functions%most)
  end function coordinate

  !> What the functions are made of: u, v of line_functions.
  pure function bumps(functions, t)
    type(line_functions), intent(in) :: functions
    real(wp), intent(in) :: t
    real(wp) :: bumps(2)
    bumps(1) = (1 - t)*(functions%linear + functions%quadratic*(1 - t))
    bumps(2) = t*(functions%linear + functions%quadratic*t)
  end function bumps

  pure subroutine bumps_and_slopes(functions, x, bump, slope)
    type(line_functions), intent(in) :: functions
    real(wp), intent(in) :: x
    real(wp), intent(out) :: bump(2), slope(2)
    real(wp) :: t
    t = coordinate(functions, x)
    bump = bumps(functions, t)
    slope(1) = -(functions%linear + 2*functions%quadratic*(1 - t))*functions%inverse
    slope(2) = (functions%linear + 2*functions%quadratic*t)*functions%inverse
  end subroutine bumps_and_slopes

  !> Sum of each node's function over the particles of one cell, for loads. total(function along x, y, z).
  pure subroutine sum_tensor(frame, cell, capacity, n_field, f, first, last, total)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: cell(3), capacity, n_field, first, last
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(inout) :: total(3, 3, 3)
    type(line_functions) :: line(3)
    real(wp) :: bump(2), w(3, 3)
    integer :: q, d, a, b, c
    do d = 1, 3
      line(d) = functions_of(frame, d, cell(d))
    end do
    do q = first, last
      do d = 1, 3
        bump = bumps(line(d), coordinate(line(d), f(q, at_position + d - 1)))
        w(:, d) = line(d)%p(0, :) + (line(d)%p(1, :)*bump(1) + line(d)%p(2, :)*bump(2))
      end do
      do c = 1, 3
        do b = 1, 3
          do a = 1, 3
            total(a, b, c) = total(a, b, c) + (w(a, 1)*w(b, 2))*w(c, 3)
          end do
        end do
      end do
    end do
  end subroutine sum_tensor

end module tensor_scatter
