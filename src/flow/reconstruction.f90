!> MUSCL reconstruction of primitive variables on the faces of a row of cells (paper eqs. 8 and 9).
module reconstruction
  use kinds, only: wp
  implicit none
  private
  public :: reconstruct_venkatakrishnan, reconstruct_minmod, flatten_next_to_closed

  integer, parameter, public :: venkatakrishnan = 1, minmod = 2

contains

  !> Face values of n cells and all variables: low = value at the lower face, high = value at the upper one.
  !> With x the difference across the face and y the one across the other face, half the limited difference of eq. (9) is
  !> (2x + y)(x y + eps**2)/(4 x**2 - 2 x y + 4 y**2 + 6 eps**2) where x y > 0, else 0: third order where smooth.
  !> below, here, above: variables of the lower neighbours, the cells, the upper neighbours; eps2: eps**2 of each variable, in its
  !> units; differences below eps are noise.
  pure subroutine reconstruct_venkatakrishnan(n, ld, n_var, eps2, below, here, above, low, high)
    integer, intent(in) :: n, ld, n_var
    real(wp), intent(in) :: eps2(n_var), below(ld, *), here(ld, *), above(ld, *)
    real(wp), intent(inout) :: low(ld, n_var), high(ld, n_var)
    real(wp) :: x, y, xy, s, slope, noise
    integer :: i, v
    do v = 1, n_var
      noise = eps2(v)
      !$omp simd private(x, y, xy, s, slope)
      do i = 1, n
        x = above(i, v) - here(i, v)
        y = here(i, v) - below(i, v)
        xy = x*y
        s = x + y
        slope = merge((xy + noise)/(4*(s*s) + (6*noise - 10*xy)), 0.0_wp, xy > 0)
        high(i, v) = here(i, v) + (s + x)*slope
        low(i, v) = here(i, v) - (s + y)*slope
      end do
    end do
  end subroutine reconstruct_venkatakrishnan

  !> The same with the minmod limiter: second order, no division, more diffusive.
  pure subroutine reconstruct_minmod(n, ld, n_var, below, here, above, low, high)
    integer, intent(in) :: n, ld, n_var
    real(wp), intent(in) :: below(ld, *), here(ld, *), above(ld, *)
    real(wp), intent(inout) :: low(ld, n_var), high(ld, n_var)
    real(wp) :: x, y, slope
    integer :: i, v
    do v = 1, n_var
      !$omp simd private(x, y, slope)
      do i = 1, n
        x = above(i, v) - here(i, v)
        y = here(i, v) - below(i, v)
        slope = 0.5_wp*(max(min(x, y), 0.0_wp) + min(max(x, y), 0.0_wp))
        high(i, v) = here(i, v) + slope
        low(i, v) = here(i, v) - slope
      end do
    end do
  end subroutine reconstruct_minmod

  !> Takes the cell value on both faces where the cell or one of its two neighbours is closed (0 in open).
  pure subroutine flatten_next_to_closed(n, ld, n_var, here, open_below, open_here, open_above, low, high)
    integer, intent(in) :: n, ld, n_var
    real(wp), intent(in) :: here(ld, *), open_below(n), open_here(n), open_above(n)
    real(wp), intent(inout) :: low(ld, n_var), high(ld, n_var)
    logical :: free
    integer :: i, v
    do v = 1, n_var
      !$omp simd private(free)
      do i = 1, n
        free = open_below(i)*open_here(i)*open_above(i) > 0
        low(i, v) = merge(low(i, v), here(i, v), free)
        high(i, v) = merge(high(i, v), here(i, v), free)
      end do
    end do
  end subroutine flatten_next_to_closed

end module reconstruction
