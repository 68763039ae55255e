!> MUSCL reconstruction: a limited slope of each primitive variable in each cell.
!> The kernels of this and the other reconstructions take a row of cells and a stride: q(i + stride) is the next cell in the
!> direction of the sweep, whichever direction that is. They give low, the value at the lower face of each cell, and high, at the
!> upper one.
module muscl
  use flow_scheme, only: venkatakrishnan, minmod, van_leer
  use kinds, only: wp
  implicit none
  private
  public :: reconstruct_muscl

contains

  !> Face values of n cells and all variables. q: first cell of variable 1 stands at q(1), the next variable ld further on;
  !> eps2: square of the differences that are noise, by variable (limiter venkatakrishnan only).
  pure subroutine reconstruct_muscl(limiter, n, ld, n_var, stride, eps2, q, low, high)
    integer, intent(in) :: limiter, n, ld, n_var, stride
    real(wp), intent(in) :: eps2(n_var), q(1 - stride:*)
    real(wp), intent(inout) :: low(ld, n_var), high(ld, n_var)
    integer :: v, first
    do v = 1, n_var
      first = (v - 1)*ld
      select case (limiter)
      case (venkatakrishnan)
        call venkatakrishnan_row(n, eps2(v), q(first + 1 - stride), q(first + 1), q(first + 1 + stride), low(1, v), high(1, v))
      case (minmod)
        call minmod_row(n, q(first + 1 - stride), q(first + 1), q(first + 1 + stride), low(1, v), high(1, v))
      case (van_leer)
        call van_leer_row(n, q(first + 1 - stride), q(first + 1), q(first + 1 + stride), low(1, v), high(1, v))
      case default
        call third_order_row(n, q(first + 1 - stride), q(first + 1), q(first + 1 + stride), low(1, v), high(1, v))
      end select
    end do
  end subroutine reconstruct_muscl

  !> The limiter of the paper (Ni et al. 2022, eqs. 8 and 9). With x the difference across the face and y the one across the other
  !> face, half the limited difference of eq. (9) is (2x + y)(x y + eps**2)/(4 x**2 - 2 x y + 4 y**2 + 6 eps**2) where x y > 0,
  !> else 0: third order where smooth.
  pure subroutine venkatakrishnan_row(n, eps2, below, here, above, low, high)
    integer, intent(in) :: n
    real(wp), intent(in) :: eps2, below(n), here(n), above(n)
    real(wp), intent(inout) :: low(n), high(n)
    real(wp) :: noise, x, y, xy, s, slope
    integer :: i
    noise = eps2 ! a load of it in the loop would keep the loop scalar
    !$omp simd private(x, y, xy, s, slope)
    do i = 1, n
      x = above(i) - here(i)
      y = here(i) - below(i)
      xy = x*y
      s = x + y
      slope = merge((xy + noise)/(4*(s*s) + (6*noise - 10*xy)), 0.0_wp, xy > 0)
      high(i) = here(i) + (s + x)*slope
      low(i) = here(i) - (s + y)*slope
    end do
  end subroutine venkatakrishnan_row

  !> Second order, the most diffusive.
  pure subroutine minmod_row(n, below, here, above, low, high)
    integer, intent(in) :: n
    real(wp), intent(in) :: below(n), here(n), above(n)
    real(wp), intent(inout) :: low(n), high(n)
    real(wp) :: x, y, slope
    integer :: i
    !$omp simd private(x, y, slope)
    do i = 1, n
      x = above(i) - here(i)
      y = here(i) - below(i)
      slope = 0.5_wp*(max(min(x, y), 0.0_wp) + min(max(x, y), 0.0_wp))
      high(i) = here(i) + slope
      low(i) = here(i) - slope
    end do
  end subroutine minmod_row

  !> Harmonic mean of the differences (van Leer 1974), second order.
  pure subroutine van_leer_row(n, below, here, above, low, high)
    integer, intent(in) :: n
    real(wp), intent(in) :: below(n), here(n), above(n)
    real(wp), intent(inout) :: low(n), high(n)
    real(wp), parameter :: nothing = 1e-200_wp !< keeps 0/0 away
    real(wp) :: x, y, s, slope
    integer :: i
    !$omp simd private(x, y, s, slope)
    do i = 1, n
      x = above(i) - here(i)
      y = here(i) - below(i)
      s = x + y
      slope = max(x*y, 0.0_wp)*s/(s*s + nothing)
      high(i) = here(i) + slope
      low(i) = here(i) - slope
    end do
  end subroutine van_leer_row

  !> The third-order upwind value (2x + y)/6 away from the cell value (Koren 1993), kept between 0 and the difference across the
  !> face, and within twice the one across the other face: the monotonicity bound of Suresh & Huynh 1997 with alpha = 2.
  pure subroutine third_order_row(n, below, here, above, low, high)
    integer, intent(in) :: n
    real(wp), intent(in) :: below(n), here(n), above(n)
    real(wp), intent(inout) :: low(n), high(n)
    real(wp), parameter :: sixth = 1.0_wp/6
    real(wp) :: x, y, size_x, size_y, s, unit
    integer :: i
    !$omp simd private(x, y, size_x, size_y, s, unit)
    do i = 1, n
      x = above(i) - here(i)
      y = here(i) - below(i)
      size_x = abs(x)
      size_y = abs(y)
      s = size_x + size_y
      unit = merge(sign(1.0_wp, x), 0.0_wp, x*y > 0)
      high(i) = here(i) + unit*min(min(sixth*(s + size_x), size_x), 2*size_y)
      low(i) = here(i) - unit*min(min(sixth*(s + size_y), size_y), 2*size_x)
    end do
  end subroutine third_order_row

end module muscl
