!> Nodes and weights of Gauss and Legendre on panels (Abramowitz & Stegun 1972, 25.4.29).
module gauss_quadrature
  use kinds, only: wp
  implicit none
  private
  public :: gauss_rule

contains

  !> Nodes and weights for integrals over (from, to) cut into equal panels of 8 nodes each; size of both: 8*panels.
  pure subroutine gauss_rule(from, to, node, weight)
    real(wp), intent(in) :: from, to
    real(wp), intent(out) :: node(:), weight(:)
    real(wp), parameter :: x(4) = [0.1834346424956498049394761_wp, 0.5255324099163289858177390_wp, &
      0.7966664774136267395915539_wp, 0.9602898564975362316835609_wp]
    real(wp), parameter :: w(4) = [0.3626837833783619829651504_wp, 0.3137066458778872873379622_wp, &
      0.2223810344533744705443560_wp, 0.1012285362903762591525314_wp]
    real(wp) :: half
    integer :: i, first
    half = (to - from)/(2*(size(node)/8))
    do i = 1, size(node)/8
      first = 8*(i - 1)
      node(first + 1:first + 8) = from + half*(2*i - 1 + [-x(4:1:-1), x])
      weight(first + 1:first + 8) = half*[w(4:1:-1), w]
    end do
  end subroutine gauss_rule

end module gauss_quadrature
