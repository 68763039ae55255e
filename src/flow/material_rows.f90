!> Building blocks of a stage with three or more materials (two: two_material_rows), each a loop over a row of cells: fractions and
!> energies of all materials from the stored state, their transport, and their bounds.
module material_rows
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  implicit none
  private
  public :: all_fractions, all_energies, advance, advance_masses, advance_momentum, advance_total_energy, &
    advance_fractions, advance_energies, bound_masses, bound_fractions, bound_energies

  real(wp), parameter, public :: smallest_mass = 1e-40_wp !< of a material per volume: keeps its density positive
  !> A fraction this far below 0 counts as a repair; nearer ones are the truncation of a trace.
  real(wp), parameter, public :: clip_tolerance = 1e-6_wp

contains

  !> Fractions of three or more materials. stored: the rows of the state.
  pure subroutine all_fractions(n, ld, n_materials, stored, a)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: stored(ld, *)
    real(wp), intent(inout) :: a(ld, n_materials)
    integer :: i, k
    do k = 1, n_materials
      !$omp simd
      do i = 1, n
        a(i, k) = stored(i, k)
      end do
    end do
  end subroutine all_fractions

  !> Energies of all materials per volume of the cell, and their sum. state: rows of the state.
  pure subroutine all_energies(n, ld, n_materials, layout, eos, state, a, e, total)
    integer, intent(in) :: n, ld, n_materials
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: state(ld, *), a(ld, n_materials)
    real(wp), intent(inout) :: e(ld, n_materials), total(n)
    real(wp) :: over_g, q
    integer :: i, k, p, row
    p = layout%pressure_row
    do k = 1, n_materials
      row = layout%energy_row(k)
      if (row > 0) then
        !$omp simd
        do i = 1, n
          e(i, k) = state(i, row)
        end do
      else
        over_g = eos(k)%over_g
        q = eos(k)%rest_energy
        !$omp simd
        do i = 1, n
          e(i, k) = a(i, k)*(state(i, p)*over_g + q)
        end do
      end if
    end do
    !$omp simd
    do i = 1, n
      total(i) = e(i, 1) + e(i, 2)
    end do
    do k = 3, n_materials
      total(:n) = total(:n) + e(:n, k)
    end do
  end subroutine all_energies

  !> new = start + part (from - start - d): a stage of the convex Runge-Kutta scheme.
  pure subroutine advance(n, part, d, from, start, new)
    integer, intent(in) :: n
    real(wp), intent(in) :: part, d(n), from(n), start(n)
    real(wp), intent(out) :: new(n)
    integer :: i
    !$omp simd
    do i = 1, n
      new(i) = start(i) + part*((from(i) - start(i)) - d(i))
    end do
  end subroutine advance

  !> Partial densities of all materials.
  pure subroutine advance_masses(n, ld, n_materials, part, d, from, start, m)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: part, d(ld, n_materials), from(ld, n_materials), start(ld, n_materials)
    real(wp), intent(inout) :: m(ld, n_materials)
    integer :: k
    do k = 1, n_materials
      call advance(n, part, d(1, k), from(1, k), start(1, k), m(1, k))
    end do
  end subroutine advance_masses

  pure subroutine advance_momentum(n, ld, part, d, r1, u1, r0, u0, momentum)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: part, d(ld, 3), r1(n), u1(ld, 3), r0(n), u0(ld, 3)
    real(wp), intent(inout) :: momentum(ld, 3)
    integer :: i, k
    do k = 1, 3
      !$omp simd
      do i = 1, n
        momentum(i, k) = r0(i)*u0(i, k) + part*((r1(i)*u1(i, k) - r0(i)*u0(i, k)) - d(i, k))
      end do
    end do
  end subroutine advance_momentum

  !> e0, e1: internal energy per volume at the start of the step and in the state that the fluxes belong to.
  pure subroutine advance_total_energy(n, ld, part, d, e1, r1, u1, e0, r0, u0, total)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: part, d(n), e1(n), r1(n), u1(ld, 3), e0(n), r0(n), u0(ld, 3)
    real(wp), intent(out) :: total(n)
    real(wp) :: start, from
    integer :: i
    !$omp simd private(start, from)
    do i = 1, n
      start = e0(i) + 0.5_wp*r0(i)*(u0(i, 1)*u0(i, 1) + u0(i, 2)*u0(i, 2) + u0(i, 3)*u0(i, 3))
      from = e1(i) + 0.5_wp*r1(i)*(u1(i, 1)*u1(i, 1) + u1(i, 2)*u1(i, 2) + u1(i, 3)*u1(i, 3))
      total(i) = start + part*((from - start) - d(i))
    end do
  end subroutine advance_total_energy

  !> da/dt + div(a u) - a div u = 0 for the fractions of three or more materials.
  !> d_velocity: time step times div u.
  pure subroutine advance_fractions(n, ld, n_materials, part, d, d_velocity, from, start, a)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: part, d(ld, *), d_velocity(n), from(ld, n_materials), start(ld, n_materials)
    real(wp), intent(inout) :: a(ld, n_materials)
    integer :: i, k
    do k = 1, n_materials
      !$omp simd
      do i = 1, n
        a(i, k) = start(i, k) + part*((from(i, k) - start(i, k)) - (d(i, k) - from(i, k)*d_velocity(i)))
      end do
    end do
  end subroutine advance_fractions

  !> dE_k/dt + div(E_k u) + a_k p div u = 0.
  pure subroutine advance_energies(n, ld, n_materials, part, d, d_velocity, p, a, from, start, e)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: part, d(ld, n_materials), d_velocity(n), p(n), a(ld, n_materials), from(ld, n_materials), &
      start(ld, n_materials)
    real(wp), intent(inout) :: e(ld, n_materials)
    integer :: i, k
    do k = 1, n_materials
      !$omp simd
      do i = 1, n
        e(i, k) = start(i, k) + part*((from(i, k) - start(i, k)) - (d(i, k) + a(i, k)*(p(i)*d_velocity(i))))
      end do
    end do
  end subroutine advance_energies

  !> Keeps masses positive and sums them to the density of the mixture. n_negative: masses that were negative.
  pure subroutine bound_masses(n, ld, n_materials, m, density, n_negative)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(inout) :: m(ld, n_materials), density(n)
    integer, intent(out) :: n_negative
    real(wp) :: negative
    integer :: i, k
    negative = 0
    do k = 1, n_materials
      !$omp simd reduction(+:negative)
      do i = 1, n
        negative = negative + merge(1.0_wp, 0.0_wp, m(i, k) < 0)
        m(i, k) = max(m(i, k), smallest_mass)
      end do
    end do
    n_negative = nint(negative)
    !$omp simd
    do i = 1, n
      density(i) = m(i, 1) + m(i, 2)
    end do
    do k = 3, n_materials
      density(:n) = density(:n) + m(:n, k)
    end do
  end subroutine bound_masses

  !> Keeps each fraction at the trace or above and their sum at 1.
  !> n_clipped: cells with a fraction below 0 by more than the tolerance.
  pure subroutine bound_fractions(n, ld, n_materials, trace, a, n_clipped)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: trace
    real(wp), intent(inout) :: a(ld, n_materials)
    integer, intent(out) :: n_clipped
    real(wp), parameter :: round_off = 1e-14_wp
    real(wp) :: clipped, excess, scale
    integer :: i
    clipped = 0
    if (n_materials == 2) then
      !$omp simd reduction(+:clipped)
      do i = 1, n
        clipped = clipped + merge(1.0_wp, 0.0_wp, min(a(i, 1), a(i, 2)) < -clip_tolerance)
        a(i, 1) = min(max(a(i, 1), trace), 1 - trace)
        a(i, 2) = 1 - a(i, 1)
      end do
    else
      do i = 1, n
        excess = sum(a(i, :)) - 1
        if (all(a(i, :) >= trace) .and. abs(excess) < round_off) cycle
        if (any(a(i, :) < -clip_tolerance)) clipped = clipped + 1
        a(i, :) = max(a(i, :), trace)
        excess = sum(a(i, :)) - 1
        scale = 1 - excess/sum(a(i, :) - trace)
        a(i, :) = trace + (a(i, :) - trace)*scale
      end do
    end if
    n_clipped = nint(clipped)
  end subroutine bound_fractions

  !> Keeps the own pressure of each gas above its lowest by floor_pressure, before relaxation.
  pure subroutine bound_energies(n, ld, n_materials, eos, floor_pressure, a, e)
    integer, intent(in) :: n, ld, n_materials
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: floor_pressure, a(ld, n_materials)
    real(wp), intent(inout) :: e(ld, n_materials)
    real(wp) :: least
    integer :: i, k
    do k = 1, n_materials
      if (.not. eos(k)%is_gas) cycle
      least = eos(k)%gas%p_infinity + floor_pressure/eos(k)%grueneisen
      !$omp simd
      do i = 1, n
        e(i, k) = max(e(i, k), a(i, k)*least)
      end do
    end do
  end subroutine bound_energies

end module material_rows
