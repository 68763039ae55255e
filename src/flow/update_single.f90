!> End of a Runge-Kutta stage for a row of cells with one material: conserved variables rebuilt from the stored primitive ones,
!> advanced, and turned back. Convex combination and pressure are written as deviations from the start of the step: where
!> nothing flows, every bit stays.
module update_single
  use kinds, only: wp
  use equation_of_state, only: eos_type
  implicit none
  private
  public :: update_gas, update_stored_energy

contains

  !> One gas, rows density, velocity, pressure, c. start: state at the start of the step; from: state that the fluxes belong to;
  !> d: what the fluxes take from each cell in the whole time step; new = start + part (from - start - d).
  !> n_bad: cells whose pressure is not above lowest or whose c is not a positive number.
  pure subroutine update_gas(n, ld, eos, part, lowest, d, from, start, new, n_bad)
    integer, intent(in) :: n, ld
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: part, lowest, d(ld, *), from(ld, *), start(ld, *)
    real(wp), intent(inout) :: new(ld, *)
    integer, intent(out) :: n_bad
    real(wp) :: g, over_g, q, gamma, stiff, r0, r1, e0, k0, k1, density, mx, my, mz, total, inverse, u, v, w, p, c2, bad
    integer :: i
    g = eos%grueneisen; over_g = eos%over_g; q = eos%rest_energy; gamma = eos%gas%gamma; stiff = eos%gas%p_infinity
    bad = 0
    !$omp simd private(r0, r1, e0, k0, k1, density, mx, my, mz, total, inverse, u, v, w, p, c2) reduction(+:bad)
    do i = 1, n
      r0 = start(i, 1)
      r1 = from(i, 1)
      density = r0 + part*((r1 - r0) - d(i, 1))
      mx = r0*start(i, 2) + part*((r1*from(i, 2) - r0*start(i, 2)) - d(i, 2))
      my = r0*start(i, 3) + part*((r1*from(i, 3) - r0*start(i, 3)) - d(i, 3))
      mz = r0*start(i, 4) + part*((r1*from(i, 4) - r0*start(i, 4)) - d(i, 4))
      e0 = start(i, 5)*over_g + q
      k0 = 0.5_wp*r0*(start(i, 2)*start(i, 2) + start(i, 3)*start(i, 3) + start(i, 4)*start(i, 4))
      k1 = 0.5_wp*r1*(from(i, 2)*from(i, 2) + from(i, 3)*from(i, 3) + from(i, 4)*from(i, 4))
      total = (e0 + k0) + part*(((from(i, 5)*over_g + q + k1) - (e0 + k0)) - d(i, 5))
      inverse = 1/density
      u = mx*inverse
      v = my*inverse
      w = mz*inverse
      p = start(i, 5) + g*((total - 0.5_wp*(mx*u + my*v + mz*w)) - e0)
      c2 = gamma*(p + stiff)*inverse
      new(i, 1) = density
      new(i, 2) = u
      new(i, 3) = v
      new(i, 4) = w
      new(i, 5) = p
      new(i, 6) = sign(sqrt(abs(c2)), c2) ! negative where there is none: repair_brick sees it
      bad = bad + merge(0.0_wp, 1.0_wp, p > lowest .and. c2 > 0 .and. c2 < huge(1.0_wp))
    end do
    n_bad = nint(bad)
  end subroutine update_gas

  !> One material of any equation of state, rows density, velocity, pressure, energy per volume, c. work: scratch.
  pure subroutine update_stored_energy(n, ld, eos, part, lowest, d, from, start, new, n_bad, work)
    integer, intent(in) :: n, ld
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: part, lowest, d(ld, *), from(ld, *), start(ld, *)
    real(wp), intent(inout) :: new(ld, *), work(ld, 5)
    integer, intent(out) :: n_bad
    real(wp) :: g, r0, r1, k0, k1, density, mx, my, mz, total, inverse, u, v, w, p, c2, bad
    integer :: i, n_whole
    n_whole = 8*((n + 7)/8)
    g = eos%grueneisen
    !$omp simd private(r0, r1, k0, k1, density, mx, my, mz, total, inverse, u, v, w)
    do i = 1, n
      r0 = start(i, 1)
      r1 = from(i, 1)
      density = r0 + part*((r1 - r0) - d(i, 1))
      mx = r0*start(i, 2) + part*((r1*from(i, 2) - r0*start(i, 2)) - d(i, 2))
      my = r0*start(i, 3) + part*((r1*from(i, 3) - r0*start(i, 3)) - d(i, 3))
      mz = r0*start(i, 4) + part*((r1*from(i, 4) - r0*start(i, 4)) - d(i, 4))
      k0 = 0.5_wp*r0*(start(i, 2)*start(i, 2) + start(i, 3)*start(i, 3) + start(i, 4)*start(i, 4))
      k1 = 0.5_wp*r1*(from(i, 2)*from(i, 2) + from(i, 3)*from(i, 3) + from(i, 4)*from(i, 4))
      total = (start(i, 6) + k0) + part*(((from(i, 6) + k1) - (start(i, 6) + k0)) - d(i, 5))
      inverse = 1/density
      u = mx*inverse
      v = my*inverse
      w = mz*inverse
      new(i, 1) = density
      new(i, 2) = u
      new(i, 3) = v
      new(i, 4) = w
      new(i, 6) = total - 0.5_wp*(mx*u + my*v + mz*w)
      work(i, 1) = density
    end do
    ! whole vectors only: a remainder would take the scalar exponential, whose last bit may differ
    work(n + 1:n_whole, 1) = work(n, 1)
    work(:n_whole, 2) = 1
    call eos%reference_rows(n_whole, work(:, 1), work(:, 2), work(:, 3), work(:, 4), work(:, 5))
    bad = 0
    !$omp simd private(p, c2) reduction(+:bad)
    do i = 1, n
      p = work(i, 4) + g*new(i, 6)
      c2 = (work(i, 5) + p - work(i, 4) + g*p)/work(i, 1)
      new(i, 5) = p
      new(i, 7) = sign(sqrt(abs(c2)), c2) ! negative where there is none: repair_brick sees it
      bad = bad + merge(0.0_wp, 1.0_wp, p > lowest .and. c2 > 0 .and. c2 < huge(1.0_wp))
    end do
    n_bad = nint(bad)
  end subroutine update_stored_energy

end module update_single
