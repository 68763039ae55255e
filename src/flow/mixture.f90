!> The state of one cell, scalar and slow: for the start, the boundary, repairs and diagnostics. The stage has its own rows.
module mixture
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use kinds, only: wp
  implicit none
  private
  public :: cell_from, close_cell, cell_fractions, cell_energies

contains

  !> State of a cell from phase densities r, fractions a (sum 1), velocity and pressure.
  pure function cell_from(layout, eos, r, a, velocity, p) result(cell)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    real(wp), intent(in) :: r(:), a(:), velocity(3), p
    real(wp) :: cell(layout%n_rows)
    integer :: k
    cell = 0
    do k = 1, layout%n_materials
      cell(k) = a(k)*r(k)
      if (k <= layout%n_fractions) cell(layout%fraction(k)) = a(k)
    end do
    cell(layout%velocity_row:layout%velocity_row + 2) = velocity
    cell(layout%pressure_row) = p
    call close_cell(layout, eos, cell)
  end function cell_from

  !> Density, stored energies and sound speed from the other rows of a cell.
  pure subroutine close_cell(layout, eos, cell)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    real(wp), intent(inout) :: cell(:)
    real(wp) :: a(layout%n_materials), e(layout%n_materials), p, bulk
    integer :: k, n
    n = layout%n_materials
    p = cell(layout%pressure_row)
    cell(layout%density_row) = sum(cell(:n))
    a = cell_fractions(layout, cell)
    bulk = 0
    do k = 1, n
      bulk = bulk + cell(k)*eos(k)%sound_speed_squared(cell(k)/a(k), p)
      if (layout%energy(k) == 0) cycle
      e(k) = cell(k)*eos(k)%energy(cell(k)/a(k), p)
      cell(layout%energy(k)) = e(k)
    end do
    cell(layout%sound_speed_row) = sqrt(abs(bulk)/cell(layout%density_row))
    if (bulk < 0) cell(layout%sound_speed_row) = 0
  end subroutine close_cell

  !> Volume fractions of all materials.
  pure function cell_fractions(layout, cell) result(a)
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: cell(:)
    real(wp) :: a(layout%n_materials)
    integer :: k
    a = 1
    do k = 1, layout%n_fractions
      a(k) = cell(layout%fraction(k))
    end do
    if (layout%n_materials == 2) a(2) = 1 - a(1)
  end function cell_fractions

  !> Internal energies of all materials per volume of the cell, as the stage counts them: of gases without their offset.
  pure function cell_energies(layout, eos, cell) result(e)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    real(wp), intent(in) :: cell(:)
    real(wp) :: e(layout%n_materials), a(layout%n_materials)
    integer :: k
    a = cell_fractions(layout, cell)
    do k = 1, layout%n_materials
      if (layout%energy(k) > 0) then
        e(k) = cell(layout%energy(k))
      else
        e(k) = a(k)*(cell(layout%pressure_row)/eos(k)%grueneisen + eos(k)%rest_energy)
      end if
    end do
  end function cell_energies

end module mixture
