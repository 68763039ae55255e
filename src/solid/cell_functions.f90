!> Where the cells of a brick lie, and the trilinear functions of one cell. Module tensor_functions has the others.
!>
!> Nodes of a cell are counted x fastest: 1 = (0,0,0), 2 = (1,0,0), 3 = (0,1,0) ... 8 = (1,1,1).
!>
!> Coordinates in a cell are kept `edge` away from its faces. A particle within that distance of a face is seen slightly
!> inside, which bounds node masses from below: force/mass of a node that a particle barely touches stays finite, no node
!> needs to be cut off, and what the particles get is what the nodes have, to round-off.
module cell_functions
  use kinds, only: wp
  implicit none
  private
  public :: weights, trilinear

  real(wp), parameter, public :: edge = 1e-4_wp !< smallest distance to a cell face that the functions see, in cells
  integer, parameter, public :: chunk = 256 !< particles per call of constitutive kernels at most
  integer, parameter, public :: piece = 64 !< particles of a cell treated at a time

  !> Where the cells of a brick lie: cell coordinate of x = (x - lower)*inverse - offset - (i - 1).
  type, public :: cell_frame
    real(wp) :: lower(3) = 0 !< low corner of the domain
    real(wp) :: inverse(3) = 1 !< 1/spacing
    integer :: offset(3) = 0 !< cells of the domain before the brick
    integer :: n(3) = 1 !< cells of the brick
    integer :: order = 1 !< of the functions: 1 linear, 2 quadratic
    integer :: last(3) = 1 !< last node of the brick, the first being 0
    logical :: active(3) = .true. !< directions with more than one cell
    logical :: at_low(3) = .false., at_high(3) = .false. !< the brick ends at this face of the domain
  end type cell_frame

contains

  !> The two linear functions of each direction for n particles of a cell: (:,1) of the low node, (:,2) of the high node.
  pure subroutine weights(frame, n, cell, x, y, z, wx, wy, wz)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: n, cell(3)
    real(wp), intent(in) :: x(n), y(n), z(n)
    real(wp), intent(out) :: wx(piece, 2), wy(piece, 2), wz(piece, 2)
    call linear(n, x, frame%lower(1), frame%inverse(1), real(frame%offset(1) + cell(1) - 1, wp), wx)
    call linear(n, y, frame%lower(2), frame%inverse(2), real(frame%offset(2) + cell(2) - 1, wp), wy)
    call linear(n, z, frame%lower(3), frame%inverse(3), real(frame%offset(3) + cell(3) - 1, wp), wz)
  end subroutine weights

  pure subroutine linear(n, x, lower, inverse, origin, w)
    integer, intent(in) :: n
    real(wp), intent(in) :: x(n), lower, inverse, origin
    real(wp), intent(out) :: w(piece, 2)
    integer :: q
    !$omp simd
    do q = 1, n
      w(q, 2) = min(max((x(q) - lower)*inverse - origin, edge), 1 - edge)
      w(q, 1) = 1 - w(q, 2)
    end do
  end subroutine linear

  !> Coefficients 1, x, y, z, xy, xz, yz, xyz of the trilinear functions that variables first+1..first+3 of a node field have in
  !> cell (i, j, k).
  pure subroutine trilinear(n, n_var, a, first, i, j, k, c)
    integer, intent(in) :: n(3), n_var, first, i, j, k
    real(wp), intent(in) :: a(0:n(1), n_var, 0:n(2), 0:n(3))
    real(wp), intent(out) :: c(8, 3)
    real(wp) :: v1, v2, v3, v4, v5, v6, v7, v8
    integer :: d
    do d = 1, 3
      v1 = a(i - 1, first + d, j - 1, k - 1)
      v2 = a(i, first + d, j - 1, k - 1)
      v3 = a(i - 1, first + d, j, k - 1)
      v4 = a(i, first + d, j, k - 1)
      v5 = a(i - 1, first + d, j - 1, k)
      v6 = a(i, first + d, j - 1, k)
      v7 = a(i - 1, first + d, j, k)
      v8 = a(i, first + d, j, k)
      c(1, d) = v1
      c(2, d) = v2 - v1
      c(3, d) = v3 - v1
      c(4, d) = v5 - v1
      c(5, d) = (v4 - v3) - (v2 - v1)
      c(6, d) = (v6 - v5) - (v2 - v1)
      c(7, d) = (v7 - v5) - (v3 - v1)
      c(8, d) = ((v8 - v7) - (v6 - v5)) - ((v4 - v3) - (v2 - v1))
    end do
  end subroutine trilinear

end module cell_functions
