!> End of a Runge-Kutta stage for a row of cells with N materials: conserved variables rebuilt from the stored primitive ones and
!> advanced, fractions and material energies transported (paper eq. 13), pressures relaxed (eq. 15), and the pressure reset
!> from the conserved total energy with the equation of state of the mixture at the relaxed fractions (Saurel 2009, step 3).
!> Everything is written as deviations from the start of the step: where nothing flows, every bit stays.
module update_materials
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use material_rows, only: all_fractions, all_energies, advance_masses, advance_momentum, advance_total_energy, &
    advance_fractions, advance_energies, bound_masses, bound_fractions, bound_energies
  use pressure_relaxation, only: relax_two_gases, relax_materials
  use two_material_rows, only: transport_two, close_two_gases
  implicit none
  private
  public :: update_row

  !> Work space of a row; all arrays (ld, N) or (ld, fixed).
  type, public :: row_scratch
    real(wp), allocatable :: m(:, :), a(:, :), e(:, :) !< new masses, fractions, energies of the materials
    real(wp), allocatable :: a_from(:, :), e_from(:, :), a_start(:, :), e_start(:, :)
    real(wp), allocatable :: f(:, :), r_df(:, :) !< of f(r) and r df/dr
    real(wp), allocatable :: conserved(:, :) !< momentum, total energy, density, internal energy of from and of start
    real(wp), allocatable :: relaxation(:, :), step(:, :), response(:, :), before(:, :)
  end type row_scratch

  !> What went on in a row of cells that is worth counting.
  type, public :: row_report
    integer :: negative_masses = 0, clipped_fractions = 0, fallbacks = 0
    integer :: cell = 0 !< a cell that needed it
    integer :: bad = 0 !< cells whose pressure or sound speed is no positive number
  end type row_report

contains

  !> start: state at the start of the step; from: state that the fluxes belong to; d: what the fluxes take from each cell in the
  !> whole step; new = start + part (from - start - d). first: from and start are the same. trace: smallest fraction;
  !> floor_pressure: smallest distance from a gas's lowest pressure; lowest: pressures at or below it are bad.
  subroutine update_row(n, ld, layout, eos, first, part, trace, floor_pressure, lowest, d, from, start, new, s, report)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    logical, intent(in) :: first
    real(wp), intent(in) :: part, trace, floor_pressure, lowest, d(ld, *), from(ld, *), start(ld, *)
    real(wp), intent(inout) :: new(ld, *)
    type(row_scratch), intent(inout) :: s
    type(row_report), intent(out) :: report
    integer :: nm
    nm = layout%n_materials
    if (nm == 2) then
      call transport_two(n, ld, layout, eos, part, trace, floor_pressure, d, from, start, s%m, s%a, s%e, s%conserved, &
        s%relaxation, report%negative_masses, report%clipped_fractions)
    else
      call energies_of(n, ld, nm, layout, eos, from, s%a_from, s%e_from, s%conserved(1, 6))
      if (first) then
        call transport(n, ld, nm, layout, part, d, from, s%a_from, s%e_from, s%conserved(1, 6), &
          from, s%a_from, s%e_from, s%conserved(1, 6), s%m, s%a, s%e, s%conserved)
      else
        call energies_of(n, ld, nm, layout, eos, start, s%a_start, s%e_start, s%conserved(1, 7))
        call transport(n, ld, nm, layout, part, d, from, s%a_from, s%e_from, s%conserved(1, 6), &
          start, s%a_start, s%e_start, s%conserved(1, 7), s%m, s%a, s%e, s%conserved)
      end if
      call bound_masses(n, ld, nm, s%m, s%conserved(1, 5), report%negative_masses)
      call bound_fractions(n, ld, nm, trace, s%a, report%clipped_fractions)
      call bound_energies(n, ld, nm, eos, floor_pressure, s%a, s%e)
    end if
    if (nm == 2 .and. all(eos%is_gas)) then
      call relax_two_gases(n, ld, eos(1), eos(2), start(1, layout%pressure_row), s%e, s%a)
      call close_two_gases(n, ld, layout, eos, trace, lowest, start(1, layout%pressure_row), s%m, s%a, s%conserved, new, &
        report%bad)
      if (report%negative_masses + report%clipped_fractions > 0) report%cell = minloc(s%a(:n, 1), dim=1)
      return
    end if
    call relax(n, ld, nm, layout, eos, start, s, report%fallbacks)
    if (report%negative_masses + report%clipped_fractions + report%fallbacks > 0) report%cell = &
      minloc(minval(s%a(:n, :), dim=2), dim=1)
    call bound_fractions(n, ld, nm, trace, s%a, report%bad)
    call close_row(n, ld, nm, layout, eos, lowest, start, s%m, s%a, s%conserved, s%f, s%r_df, s%relaxation, new, report%bad)
  end subroutine update_row

  pure subroutine energies_of(n, ld, n_materials, layout, eos, state, a, e, total)
    integer, intent(in) :: n, ld, n_materials
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: state(ld, *)
    real(wp), intent(inout) :: a(ld, n_materials), e(ld, n_materials), total(n)
    call all_fractions(n, ld, n_materials, state(1, layout%first_fraction_row), a)
    call all_energies(n, ld, n_materials, layout, eos, state, a, e, total)
  end subroutine energies_of

  pure subroutine transport(n, ld, n_materials, layout, part, d, from, a_from, e_from, total_from, &
      start, a_start, e_start, total_start, m, a, e, conserved)
    integer, intent(in) :: n, ld, n_materials
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: part, d(ld, *), from(ld, *), start(ld, *), total_from(n), total_start(n)
    real(wp), intent(in), dimension(ld, n_materials) :: a_from, e_from, a_start, e_start
    real(wp), intent(inout), dimension(ld, n_materials) :: m, a, e
    real(wp), intent(inout) :: conserved(ld, 5)
    integer :: r, u, du
    r = layout%density_row
    u = layout%velocity_row
    du = layout%face_velocity_flux
    call advance_masses(n, ld, n_materials, part, d, from, start, m)
    call advance_momentum(n, ld, part, d(1, layout%momentum_flux), from(1, r), from(1, u), start(1, r), start(1, u), &
      conserved)
    call advance_total_energy(n, ld, part, d(1, layout%energy_flux), total_from, from(1, r), from(1, u), &
      total_start, start(1, r), start(1, u), conserved(1, 4))
    call advance_fractions(n, ld, n_materials, part, d(1, layout%first_fraction_flux), d(1, du), a_from, a_start, a)
    call advance_energies(n, ld, n_materials, part, d(1, layout%first_material_energy_flux), d(1, du), &
      from(1, layout%pressure_row), a_from, e_from, e_start, e)
  end subroutine transport

  pure subroutine relax(n, ld, n_materials, layout, eos, start, s, n_fallback)
    integer, intent(in) :: n, ld, n_materials
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: start(ld, *)
    type(row_scratch), intent(inout) :: s
    integer, intent(out) :: n_fallback
    integer :: n_whole, k
    n_fallback = 0
    ! whole vectors only: a remainder would take the scalar exponential, whose last bit may differ
    n_whole = 8*((n + 7)/8)
    s%relaxation(:n, 7) = start(:n, layout%pressure_row)
    s%relaxation(n + 1:n_whole, 7) = s%relaxation(n, 7)
    do k = 1, n_materials
      s%m(n + 1:n_whole, k) = s%m(n, k)
      s%a(n + 1:n_whole, k) = s%a(n, k)
      s%e(n + 1:n_whole, k) = s%e(n, k)
    end do
    call relax_materials(n_whole, ld, n_materials, eos, s%m, s%e, s%relaxation(1, 7), s%a, s%relaxation(1, 8), n_fallback, &
      s%before, s%step, s%response, s%f, s%r_df, s%relaxation)
  end subroutine relax

  !> Velocity, pressure and sound speed of the new state. The pressure is the one that gives the materials, at their relaxed
  !> fractions, the internal energy that the conserved total energy leaves.
  pure subroutine close_row(n, ld, n_materials, layout, eos, lowest, start, m, a, conserved, f, r_df, work, new, n_bad)
    integer, intent(in) :: n, ld, n_materials
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: lowest, start(ld, *), conserved(ld, 5)
    real(wp), intent(inout) :: m(ld, n_materials), a(ld, n_materials)
    real(wp), intent(inout) :: f(ld, n_materials), r_df(ld, n_materials), work(ld, 5), new(ld, *)
    integer, intent(out) :: n_bad
    real(wp) :: bad, over_g, q, g, u, v, w, inverse, c2, stiff
    integer :: i, k, p, r, ux, c, n_whole
    p = layout%pressure_row; r = layout%density_row; ux = layout%velocity_row; c = layout%sound_speed_row
    do k = 1, n_materials
      g = eos(k)%grueneisen
      over_g = eos(k)%over_g
      if (k == 1) work(:n, :4) = 0
      if (eos(k)%is_gas) then
        q = eos(k)%rest_energy
        stiff = eos(k)%gas%gamma*eos(k)%gas%p_infinity
        !$omp simd
        do i = 1, n
          work(i, 1) = work(i, 1) + a(i, k)*(start(i, p)*over_g + q)
          work(i, 2) = work(i, 2) + a(i, k)*over_g
          work(i, 3) = work(i, 3) + a(i, k)*(1 + g)
          work(i, 4) = work(i, 4) + a(i, k)*stiff
          new(i, k) = m(i, k)
        end do
      else
        n_whole = 8*((n + 7)/8)
        m(n + 1:n_whole, k) = m(n, k)
        a(n + 1:n_whole, k) = a(n, k)
        call eos(k)%reference_rows(n_whole, m(:, k), a(:, k), work(:, 5), f(:, k), r_df(:, k))
        !$omp simd
        do i = 1, n
          work(i, 1) = work(i, 1) + a(i, k)*(start(i, p) - f(i, k))*over_g
          work(i, 2) = work(i, 2) + a(i, k)*over_g
          work(i, 3) = work(i, 3) + a(i, k)*(1 + g)
          work(i, 4) = work(i, 4) + a(i, k)*(r_df(i, k) - f(i, k))
          new(i, k) = m(i, k)
        end do
      end if
      if (k <= layout%n_fractions) new(:n, layout%fraction(k)) = a(:n, k)
    end do
    bad = 0
    !$omp simd private(u, v, w, inverse, c2) reduction(+:bad)
    do i = 1, n
      inverse = 1/conserved(i, 5)
      u = conserved(i, 1)*inverse
      v = conserved(i, 2)*inverse
      w = conserved(i, 3)*inverse
      new(i, r) = conserved(i, 5)
      new(i, ux) = u
      new(i, ux + 1) = v
      new(i, ux + 2) = w
      new(i, p) = start(i, p) + ((conserved(i, 4) &
        - 0.5_wp*(conserved(i, 1)*u + conserved(i, 2)*v + conserved(i, 3)*w)) - work(i, 1))/work(i, 2)
      c2 = (new(i, p)*work(i, 3) + work(i, 4))*inverse
      new(i, c) = sign(sqrt(abs(c2)), c2) ! negative where there is none: repair_brick sees it
      bad = bad + merge(0.0_wp, 1.0_wp, new(i, p) > lowest .and. c2 > 0 .and. c2 < huge(1.0_wp))
    end do
    n_bad = nint(bad)
    do k = 1, n_materials
      if (layout%energy_row(k) == 0) cycle
      over_g = eos(k)%over_g
      !$omp simd
      do i = 1, n
        new(i, layout%energy_row(k)) = a(i, k)*(new(i, p) - f(i, k))*over_g
      end do
    end do
  end subroutine close_row

end module update_materials
