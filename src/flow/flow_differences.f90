!> What fluxes and gravity take from a row of cells in a whole step.
module flow_differences
  use flow_layout, only: layout_type
  use kinds, only: wp
  implicit none
  private
  public :: difference_fluxes, difference_radial_fluxes, add_gravity

contains

  !> What the fluxes of the active directions take from a row of cells in a whole step. last: the last of them; rates of the
  !> inactive ones are 0.
  pure subroutine difference_fluxes(n, ld, n_fluxes, last, rate, x, y_low, y_high, z_low, z_high, d)
    integer, intent(in) :: n, ld, n_fluxes, last
    real(wp), intent(in) :: rate(3)
    real(wp), intent(in), dimension(ld, n_fluxes) :: x, y_low, y_high, z_low, z_high
    real(wp), intent(inout) :: d(ld, n_fluxes)
    integer :: i, v
    do v = 1, n_fluxes
      select case (last)
      case (1)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v))
        end do
      case (2)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v)) + rate(2)*(y_high(i, v) - y_low(i, v))
        end do
      case (3)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v)) + rate(2)*(y_high(i, v) - y_low(i, v)) &
            + rate(3)*(z_high(i, v) - z_low(i, v))
        end do
      end select
    end do
  end subroutine difference_fluxes

  !> The same where x is a radius. rate_low, rate_high: time step times area over volume at the faces across x, for each cell;
  !> rate(2): of the faces across y. The pressure p of the cell is taken off the momentum along x (flux row momentum) before the
  !> areas differ, so that fluid at rest stays so to the last bit.
  pure subroutine difference_radial_fluxes(n, ld, n_fluxes, last, momentum, rate_low, rate_high, rate, p, x, y_low, y_high, d)
    integer, intent(in) :: n, ld, n_fluxes, last, momentum
    real(wp), intent(in) :: rate_low(n), rate_high(n), rate(3), p(n)
    real(wp), intent(in), dimension(ld, n_fluxes) :: x, y_low, y_high
    real(wp), intent(inout) :: d(ld, n_fluxes)
    integer :: i, v
    do v = 1, n_fluxes
      if (v == momentum) then
        !$omp simd
        do i = 1, n
          d(i, v) = rate_high(i)*(x(i + 1, v) - p(i)) - rate_low(i)*(x(i, v) - p(i))
        end do
      else
        !$omp simd
        do i = 1, n
          d(i, v) = rate_high(i)*x(i + 1, v) - rate_low(i)*x(i, v)
        end do
      end if
      if (last == 1) cycle
      !$omp simd
      do i = 1, n
        d(i, v) = d(i, v) + rate(2)*(y_high(i, v) - y_low(i, v))
      end do
    end do
  end subroutine difference_radial_fluxes

  !> Momentum and work of gravity.
  pure subroutine add_gravity(n, ld, layout, dt, gravity, from, d)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: dt, gravity(3), from(ld, *)
    real(wp), intent(inout) :: d(ld, *)
    integer :: i, q, r, u, m, e
    r = layout%density_row; u = layout%velocity_row - 1; m = layout%momentum_flux - 1; e = layout%energy_flux
    do q = 1, 3
      do i = 1, n
        d(i, m + q) = d(i, m + q) - dt*gravity(q)*from(i, r)
        d(i, e) = d(i, e) - dt*gravity(q)*from(i, r)*from(i, u + q)
      end do
    end do
  end subroutine add_gravity

end module flow_differences
