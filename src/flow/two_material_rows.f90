!> The end of a Runge-Kutta stage for rows of two materials, written out: what material_rows and update_materials do for any number,
!> in a few loops that keep their sums in registers.
module two_material_rows
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use material_rows, only: smallest_mass, clip_tolerance
  implicit none
  private
  public :: transport_two, close_two_gases

contains

  !> New masses m, fractions a, energies e of both materials (kept within their bounds), and conserved = momentum, total energy,
  !> density; new = start + part (from - start - d). Arguments as update_row in update_materials; n_negative, n_clipped: masses and
  !> fractions below their bounds. work: scratch.
  pure subroutine transport_two(n, ld, layout, eos, part, trace, floor_pressure, d, from, start, m, a, e, conserved, work, &
      n_negative, n_clipped)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(2)
    real(wp), intent(in) :: part, trace, floor_pressure, d(ld, *), from(ld, *), start(ld, *)
    real(wp), intent(inout) :: m(ld, 2), a(ld, 2), e(ld, 2), conserved(ld, 5), work(ld, 2)
    integer, intent(out) :: n_negative, n_clipped
    real(wp) :: over_g(2), rest(2), least(2)
    integer :: k
    do k = 1, 2
      over_g(k) = 0
      rest(k) = 0
      least(k) = -huge(1.0_wp)
      if (.not. eos(k)%is_gas) cycle
      over_g(k) = eos(k)%over_g
      rest(k) = eos(k)%rest_energy
      least(k) = eos(k)%gas%p_infinity + floor_pressure/eos(k)%grueneisen
    end do
    call advance_mass_and_momentum(n, ld, layout%density_row, part, d, from, start, m, conserved, work, n_negative)
    associate (p => layout%pressure_row, r => layout%first_fraction_row, f => layout%first_fraction_flux, &
        g => layout%first_material_energy_flux)
      call advance_fraction_and_energies(n, ld, part, trace, over_g(1), rest(1), least(1), over_g(2), rest(2), least(2), &
        work, d(1, layout%energy_flux), d(1, f), d(1, g), d(1, layout%face_velocity_flux), &
        from(1, p), from(1, r), start(1, p), start(1, r), a, e, conserved(1, 4), n_clipped)
    end associate
    do k = 1, 2
      if (layout%energy_row(k) > 0) call add_stored(n, part, from(1, layout%energy_row(k)), start(1, layout%energy_row(k)), &
        e(1, k), conserved(1, 4))
    end do
  end subroutine transport_two

  !> kinetic(:,1), kinetic(:,2): kinetic energies per volume at start and of from.
  pure subroutine advance_mass_and_momentum(n, ld, r, part, d, from, start, m, conserved, kinetic, n_negative)
    integer, intent(in) :: n, ld, r
    real(wp), intent(in) :: part, d(ld, *), from(ld, *), start(ld, *)
    real(wp), intent(inout) :: m(ld, 2), conserved(ld, 5), kinetic(ld, 2)
    integer, intent(out) :: n_negative
    real(wp) :: m1, m2, r0, r1, negative
    integer :: i
    negative = 0
    !$omp simd private(m1, m2) reduction(+:negative)
    do i = 1, n
      m1 = start(i, 1) + part*((from(i, 1) - start(i, 1)) - d(i, 1))
      m2 = start(i, 2) + part*((from(i, 2) - start(i, 2)) - d(i, 2))
      negative = negative + (merge(1.0_wp, 0.0_wp, m1 < 0) + merge(1.0_wp, 0.0_wp, m2 < 0))
      m(i, 1) = max(m1, smallest_mass)
      m(i, 2) = max(m2, smallest_mass)
      conserved(i, 5) = m(i, 1) + m(i, 2)
    end do
    n_negative = nint(negative)
    !$omp simd private(r0, r1)
    do i = 1, n
      r0 = start(i, r)
      r1 = from(i, r)
      conserved(i, 1) = r0*start(i, 3) + part*((r1*from(i, 3) - r0*start(i, 3)) - d(i, 3))
      conserved(i, 2) = r0*start(i, 4) + part*((r1*from(i, 4) - r0*start(i, 4)) - d(i, 4))
      conserved(i, 3) = r0*start(i, 5) + part*((r1*from(i, 5) - r0*start(i, 5)) - d(i, 5))
      kinetic(i, 1) = 0.5_wp*r0*(start(i, 3)*start(i, 3) + start(i, 4)*start(i, 4) + start(i, 5)*start(i, 5))
      kinetic(i, 2) = 0.5_wp*r1*(from(i, 3)*from(i, 3) + from(i, 4)*from(i, 4) + from(i, 5)*from(i, 5))
    end do
  end subroutine advance_mass_and_momentum

  !> Fractions, energies of both materials and total energy, as far as these follow from the pressure: with over_g and q of 0 the
  !> energy of a material that has its own row is left to add_stored. d_total, d_a, d_e, d_u: of total energy, fraction, energies
  !> and face velocity.
  pure subroutine advance_fraction_and_energies(n, ld, part, trace, og1, q1, least1, og2, q2, least2, kinetic, d_total, d_a, d_e, &
      d_u, p1, a1, p0, a0, a, e, total, n_clipped)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: part, trace, og1, q1, least1, og2, q2, least2, kinetic(ld, 2), d_e(ld, 2)
    real(wp), intent(in), dimension(n) :: d_total, d_a, d_u, p1, a1, p0, a0
    real(wp), intent(inout) :: a(ld, 2), e(ld, 2), total(n)
    integer, intent(out) :: n_clipped
    real(wp) :: clipped, first, f0, f1, s0, s1, e0, e1, work
    integer :: i
    clipped = 0
    !$omp simd private(first, f0, f1, s0, s1, e0, e1, work) reduction(+:clipped)
    do i = 1, n
      first = a0(i) + part*((a1(i) - a0(i)) - (d_a(i) - a1(i)*d_u(i)))
      clipped = clipped + merge(1.0_wp, 0.0_wp, min(first, 1 - first) < -clip_tolerance)
      first = min(max(first, trace), 1 - trace)
      a(i, 1) = first
      a(i, 2) = 1 - first
      f0 = a0(i)*(p0(i)*og1 + q1)
      s0 = (1 - a0(i))*(p0(i)*og2 + q2)
      f1 = a1(i)*(p1(i)*og1 + q1)
      s1 = (1 - a1(i))*(p1(i)*og2 + q2)
      e0 = (f0 + s0) + kinetic(i, 1)
      e1 = (f1 + s1) + kinetic(i, 2)
      total(i) = e0 + part*((e1 - e0) - d_total(i))
      work = p1(i)*d_u(i)
      e(i, 1) = max(f0 + part*((f1 - f0) - (d_e(i, 1) + a1(i)*work)), first*least1)
      e(i, 2) = max(s0 + part*((s1 - s0) - (d_e(i, 2) + (1 - a1(i))*work)), (1 - first)*least2)
    end do
    n_clipped = nint(clipped)
  end subroutine advance_fraction_and_energies

  pure subroutine add_stored(n, part, from, start, e, total)
    integer, intent(in) :: n
    real(wp), intent(in) :: part, from(n), start(n)
    real(wp), intent(inout) :: e(n), total(n)
    real(wp) :: stored
    integer :: i
    !$omp simd private(stored)
    do i = 1, n
      stored = start(i) + part*(from(i) - start(i))
      e(i) = e(i) + stored
      total(i) = total(i) + stored
    end do
  end subroutine add_stored

  !> Velocity, pressure and sound speed of two gases at their relaxed fraction a, as close_row in update_materials.
  pure subroutine close_two_gases(n, ld, layout, eos, trace, lowest, p_start, m, a, conserved, new, n_bad)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(2)
    real(wp), intent(in) :: trace, lowest, p_start(n), m(ld, 2), a(n), conserved(ld, 5)
    real(wp), intent(inout) :: new(ld, *)
    integer, intent(out) :: n_bad
    real(wp) :: bad, first, second, over_g, inverse, u, v, w, p, c2, inside
    real(wp) :: og1, og2, q1, q2, wide1, wide2, stiff1, stiff2
    integer :: i, pressure, fraction, density, sound
    pressure = layout%pressure_row; fraction = layout%first_fraction_row
    density = layout%density_row; sound = layout%sound_speed_row
    og1 = eos(1)%over_g; q1 = eos(1)%rest_energy; wide1 = 1 + eos(1)%grueneisen
    og2 = eos(2)%over_g; q2 = eos(2)%rest_energy; wide2 = 1 + eos(2)%grueneisen
    stiff1 = eos(1)%gas%gamma*eos(1)%gas%p_infinity
    stiff2 = eos(2)%gas%gamma*eos(2)%gas%p_infinity
    bad = 0
    !$omp simd private(first, second, over_g, inverse, u, v, w, p, c2, inside) reduction(+:bad)
    do i = 1, n
      first = min(max(a(i), trace), 1 - trace)
      second = 1 - first
      over_g = first*og1 + second*og2
      inside = first*(p_start(i)*og1 + q1) + second*(p_start(i)*og2 + q2)
      inverse = 1/conserved(i, 5)
      u = conserved(i, 1)*inverse
      v = conserved(i, 2)*inverse
      w = conserved(i, 3)*inverse
      p = p_start(i) + ((conserved(i, 4) - 0.5_wp*(conserved(i, 1)*u + conserved(i, 2)*v + conserved(i, 3)*w)) - inside)/over_g
      c2 = (p*(first*wide1 + second*wide2) + (first*stiff1 + second*stiff2))*inverse
      new(i, 1) = m(i, 1)
      new(i, 2) = m(i, 2)
      new(i, 3) = u
      new(i, 4) = v
      new(i, 5) = w
      new(i, pressure) = p
      new(i, fraction) = first
      new(i, density) = conserved(i, 5)
      new(i, sound) = sign(sqrt(abs(c2)), c2) ! negative where there is none: repair_brick sees it
      bad = bad + merge(0.0_wp, 1.0_wp, p > lowest .and. c2 > 0 .and. c2 < huge(1.0_wp))
    end do
    n_bad = nint(bad)
  end subroutine close_two_gases

end module two_material_rows
