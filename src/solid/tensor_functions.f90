!> The functions of a cell as products of one polynomial per direction: linear ones or quadratic B-splines.
!>
!> The spans of the splines are the cells, so all particles of a cell see the same three functions per direction. Function i of a
!> brick is centred in its cell i; cell i sees functions i-1, i, i+1. Knots are repeated at faces of the domain (open knots): there
!> the outermost function is 1 on the face and all others are 0, so to hold it is to hold the face. In cell coordinates t
!>
!>   w1 = s (1 - t)^2,  w3 = s' t^2,  w2 = 1 - w1 - w3,   s, s' = 1 at a face of the domain, else 1/2.
!>
!> A linear field comes out exactly where its values are taken at the control points (Greville's abscissae): centres of cells, and
!> the faces of the domain. In an inactive direction the quadratic shape has one constant function.
!>
!> All are sums of 1 and of what falls to zero at the high and at the low end of the cell, u = (1 - t)^m and v = t^m, with the order
!> m of the functions: without loss of digits, so that a node which a particle barely touches gets a mass that is small but right.
module tensor_functions
  use cell_functions, only: cell_frame, edge, piece
  use kinds, only: wp
  implicit none
  private
  public :: functions_of, make_lanes, tensor_bumps, tensor_weights, affine_weights, control_point

  integer, parameter, public :: most_lanes = 12 !< products of the functions along y and z, padded to whole vectors

  !> The functions of one cell along one direction, in the cell coordinate t.
  type, public :: line_functions
    integer :: n = 1
    real(wp) :: p(0:2, 3) = 0 !< w_a = p(0,a) + p(1,a) u + p(2,a) v; none beyond n
    real(wp) :: linear = 0, quadratic = 1 !< u = r (linear + quadratic r), r = 1 - t; v = t (linear + quadratic t)
    real(wp) :: at(3) = 0 !< control points
    real(wp) :: lower = 0, inverse = 1, origin = 0 !< t = (x - lower)*inverse - origin
    real(wp) :: least = 0, most = 1 !< t is kept between these
  end type line_functions

  !> Products of the functions along y and z, y fastest; the rest of the lanes are empty.
  type, public :: lane_functions
    real(wp) :: y(most_lanes, 0:2) = 0, z(most_lanes, 0:2) = 0 !< polynomials as in line_functions
    real(wp) :: at_y(most_lanes) = 0, at_z(most_lanes) = 0
  end type lane_functions

contains

  !> Functions of cell i of a brick along direction d.
  pure function functions_of(frame, d, i) result(functions)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: d, i
    type(line_functions) :: functions
    real(wp) :: low, high
    functions%lower = frame%lower(d)
    functions%inverse = frame%inverse(d)
    functions%origin = real(frame%offset(d) + i - 1, wp)
    if (frame%order == 1) then
      functions%n = 2
      functions%p(:, 1) = [0, 1, 0]
      functions%p(:, 2) = [0, 0, 1]
      functions%linear = 1
      functions%quadratic = 0
      functions%at(2) = 1
      functions%least = edge
      functions%most = 1 - edge
    else if (frame%active(d)) then
      low = 0.5_wp
      high = 0.5_wp
      functions%at = [-0.5_wp, 0.5_wp, 1.5_wp]
      if (frame%at_low(d) .and. i == 1) then
        low = 1
        functions%at(1) = 0
      end if
      if (frame%at_high(d) .and. i == frame%n(d)) then
        high = 1
        functions%at(3) = 1
      end if
      functions%n = 3
      functions%p(:, 1) = [0.0_wp, low, 0.0_wp]
      functions%p(:, 2) = [1.0_wp, -low, -high]
      functions%p(:, 3) = [0.0_wp, 0.0_wp, high]
    else
      functions%p(0, 1) = 1
      functions%at(1) = 0.5_wp
    end if
  end function functions_of

  !> Position along direction d of node i of a brick.
  pure real(wp) function control_point(frame, d, i) result(x)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: d, i
    real(wp) :: coordinate
    coordinate = frame%offset(d) + i
    if (frame%order == 2) then
      coordinate = coordinate - 0.5_wp
      if (.not. frame%active(d)) coordinate = 0.5_wp
      if (frame%active(d) .and. frame%at_low(d) .and. i == 0) coordinate = 0
      if (frame%active(d) .and. frame%at_high(d) .and. i == frame%n(d) + 1) coordinate = frame%offset(d) + frame%n(d)
    end if
    x = frame%lower(d) + coordinate/frame%inverse(d)
  end function control_point

  pure subroutine make_lanes(y, z, lanes)
    type(line_functions), intent(in) :: y, z
    type(lane_functions), intent(out) :: lanes
    integer :: b, c, l
    l = 0
    do c = 1, z%n
      do b = 1, y%n
        l = l + 1
        lanes%y(l, :) = y%p(:, b)
        lanes%z(l, :) = z%p(:, c)
        lanes%at_y(l) = y%at(b)
        lanes%at_z(l) = z%at(c)
      end do
    end do
  end subroutine make_lanes

  !> What the functions along one direction are made of, for n particles: cell coordinates t, bumps u and v, and their derivatives.
  pure subroutine tensor_bumps(functions, n, x, t, bump, slope)
    type(line_functions), intent(in) :: functions
    integer, intent(in) :: n
    real(wp), intent(in) :: x(n)
    real(wp), intent(out) :: t(n), bump(piece, 2), slope(piece, 2)
    real(wp) :: linear, quadratic, lower, inverse, origin, least, most
    integer :: q
    linear = functions%linear
    quadratic = functions%quadratic
    lower = functions%lower
    inverse = functions%inverse
    origin = functions%origin
    least = functions%least
    most = functions%most
    !$omp simd
    do q = 1, n
      t(q) = min(max((x(q) - lower)*inverse - origin, least), most)
      bump(q, 1) = (1 - t(q))*(linear + quadratic*(1 - t(q)))
      bump(q, 2) = t(q)*(linear + quadratic*t(q))
      slope(q, 1) = -(linear + 2*quadratic*(1 - t(q)))*inverse
      slope(q, 2) = (linear + 2*quadratic*t(q))*inverse
    end do
  end subroutine tensor_bumps

  !> Functions and derivatives along one direction for n particles; zero beyond the cell's number of functions.
  pure subroutine tensor_weights(functions, n, x, w, slope)
    type(line_functions), intent(in) :: functions
    integer, intent(in) :: n
    real(wp), intent(in) :: x(n)
    real(wp), intent(out) :: w(piece, 3), slope(piece, 3)
    real(wp) :: t, u, v, du, dv, p(0:2, 3), linear, quadratic, lower, inverse, origin, least, most
    integer :: q
    p = functions%p
    linear = functions%linear
    quadratic = functions%quadratic
    lower = functions%lower
    inverse = functions%inverse
    origin = functions%origin
    least = functions%least
    most = functions%most
    !$omp simd private(t, u, v, du, dv)
    do q = 1, n
      t = min(max((x(q) - lower)*inverse - origin, least), most)
      u = (1 - t)*(linear + quadratic*(1 - t))
      v = t*(linear + quadratic*t)
      du = -(linear + 2*quadratic*(1 - t))*inverse
      dv = (linear + 2*quadratic*t)*inverse
      w(q, 1) = p(0, 1) + (p(1, 1)*u + p(2, 1)*v)
      w(q, 2) = p(0, 2) + (p(1, 2)*u + p(2, 2)*v)
      w(q, 3) = p(0, 3) + (p(1, 3)*u + p(2, 3)*v)
      slope(q, 1) = p(1, 1)*du + p(2, 1)*dv
      slope(q, 2) = p(1, 2)*du + p(2, 2)*dv
      slope(q, 3) = p(1, 3)*du + p(2, 3)*dv
    end do
  end subroutine tensor_weights

  !> What the affine matrix is summed with: w_a (X_a - x)/D with D = sum w_a (X_a - x)^2, h^2/4 for the quadratic shape away from
  !> the faces of the domain. For linear functions these are the slopes.
  pure subroutine affine_weights(functions, n, x, w, affine)
    type(line_functions), intent(in) :: functions
    integer, intent(in) :: n
    real(wp), intent(in) :: x(n), w(piece, 3)
    real(wp), intent(out) :: affine(piece, 3)
    real(wp) :: t, d1, d2, d3, factor, at(3), lower, inverse, origin, least, most
    integer :: q
    if (functions%n == 1) then
      affine(:n, :) = 0
      return
    end if
    at = functions%at
    lower = functions%lower
    inverse = functions%inverse
    origin = functions%origin
    least = functions%least
    most = functions%most
    !$omp simd private(t, d1, d2, d3, factor)
    do q = 1, n
      t = min(max((x(q) - lower)*inverse - origin, least), most)
      d1 = at(1) - t
      d2 = at(2) - t
      d3 = at(3) - t
      factor = inverse/max(w(q, 1)*d1*d1 + w(q, 2)*d2*d2 + w(q, 3)*d3*d3, 1e-12_wp)
      affine(q, 1) = w(q, 1)*d1*factor
      affine(q, 2) = w(q, 2)*d2*factor
      affine(q, 3) = w(q, 3)*d3*factor
    end do
  end subroutine affine_weights

end module tensor_functions
