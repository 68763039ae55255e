!> Face values where the reconstruction must not reach: beside closed cells, and at faces of cells that are redone in first order.
module face_states
  use kinds, only: wp
  implicit none
  private
  public :: all_open, flatten_next_to_closed, replace_near_closed, take_cell_values

contains

  !> True if no cell of some rows is closed (0 in open). n: cells; rows, stride: their number and distance; open: first cell of
  !> the first.
  pure logical function all_open(n, rows, stride, open)
    integer, intent(in) :: n, rows, stride
    real(wp), intent(in) :: open(*)
    real(wp) :: least
    integer :: i, r
    least = 1
    do r = 0, rows - 1
      !$omp simd reduction(min:least)
      do i = 1, n
        least = min(least, open(i + r*stride))
      end do
    end do
    all_open = least > 0
  end function all_open

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

  !> Takes the values of a narrower reconstruction where a cell two away is closed.
  pure subroutine replace_near_closed(n, ld, n_var, open_below, open_above, narrow_low, narrow_high, low, high)
    integer, intent(in) :: n, ld, n_var
    real(wp), intent(in) :: open_below(n), open_above(n), narrow_low(ld, n_var), narrow_high(ld, n_var)
    real(wp), intent(inout) :: low(ld, n_var), high(ld, n_var)
    logical :: free
    integer :: i, v
    do v = 1, n_var
      !$omp simd private(free)
      do i = 1, n
        free = open_below(i)*open_above(i) > 0
        low(i, v) = merge(low(i, v), narrow_low(i, v), free)
        high(i, v) = merge(high(i, v), narrow_high(i, v), free)
      end do
    end do
  end subroutine replace_near_closed

  !> Takes the cell values on both sides of faces that have a cell on either side whose trouble is above a level.
  pure subroutine take_cell_values(n, ld, n_var, level, troubled_left, troubled_right, cells_left, cells_right, left, right)
    integer, intent(in) :: n, ld, n_var
    real(wp), intent(in) :: level, troubled_left(n), troubled_right(n), cells_left(ld, *), cells_right(ld, *)
    real(wp), intent(inout) :: left(ld, *), right(ld, *)
    integer :: i, v
    do v = 1, n_var
      !$omp simd
      do i = 1, n
        left(i, v) = merge(cells_left(i, v), left(i, v), max(troubled_left(i), troubled_right(i)) > level)
        right(i, v) = merge(cells_right(i, v), right(i, v), max(troubled_left(i), troubled_right(i)) > level)
      end do
    end do
  end subroutine take_cell_values

end module face_states
