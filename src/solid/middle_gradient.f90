!> Velocity gradients in the middle of a step.
!>
!> Nodes give the gradient over the positions at one end of the motion of a step. Strains need it over the positions at the middle:
!> with that of the start a body that only turns is not strained at all while each step carries its particles outwards along
!> their tangents, so it grows by (w dt)**2/2 per step; and a stretch of e per step is taken for one that is larger by e/2.
module middle_gradient
  use cell_functions, only: chunk
  use kinds, only: wp
  implicit none
  private
  public :: center_gradient

contains

  !> g becomes g - g g/2 if it belongs to the positions at the start of the motion, g + g g/2 at its end: the gradient of the same
  !> motion over its middle positions, to second order. g(:,3*(i-1)+j) = dt dv_i/dx_j.
  pure subroutine center_gradient(n, at_start, g)
    integer, intent(in) :: n
    logical, intent(in) :: at_start
    real(wp), intent(inout) :: g(chunk, 9)
    real(wp) :: half, g1, g2, g3, g4, g5, g6, g7, g8, g9
    integer :: i
    half = merge(-0.5_wp, 0.5_wp, at_start)
    !$omp simd private(g1, g2, g3, g4, g5, g6, g7, g8, g9)
    do i = 1, n
      g1 = g(i, 1)
      g2 = g(i, 2)
      g3 = g(i, 3)
      g4 = g(i, 4)
      g5 = g(i, 5)
      g6 = g(i, 6)
      g7 = g(i, 7)
      g8 = g(i, 8)
      g9 = g(i, 9)
      g(i, 1) = g1 + half*(g1*g1 + g2*g4 + g3*g7)
      g(i, 2) = g2 + half*(g1*g2 + g2*g5 + g3*g8)
      g(i, 3) = g3 + half*(g1*g3 + g2*g6 + g3*g9)
      g(i, 4) = g4 + half*(g4*g1 + g5*g4 + g6*g7)
      g(i, 5) = g5 + half*(g4*g2 + g5*g5 + g6*g8)
      g(i, 6) = g6 + half*(g4*g3 + g5*g6 + g6*g9)
      g(i, 7) = g7 + half*(g7*g1 + g8*g4 + g9*g7)
      g(i, 8) = g8 + half*(g7*g2 + g8*g5 + g9*g8)
      g(i, 9) = g9 + half*(g7*g3 + g8*g6 + g9*g9)
    end do
  end subroutine center_gradient

end module middle_gradient
