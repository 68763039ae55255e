!> Pressure relaxation of one cell between brackets: slow, and sure for any positive masses and fractions. Both unknowns, pressure
!> and each fraction at it, are found by the Illinois variant of the false position, with a bisection after every second step.
module relaxation_fallback
  use kinds, only: wp
  use equation_of_state, only: eos_type
  implicit none
  private
  public :: relax_cell

  integer, parameter :: most_steps = 200

contains

  !> Relaxes the materials of one cell. m, e: partial densities and energies per volume of the cell (of gases without offset);
  !> a: fractions, in and out, sum 1; p: relaxed pressure. The pressure lies between those of the materials; a material below
  !> its lowest pressure is lifted to it.
  pure subroutine relax_cell(eos, m, e, a, p)
    type(eos_type), intent(in) :: eos(:)
    real(wp), intent(in) :: m(:), e(:)
    real(wp), intent(inout) :: a(:)
    real(wp), intent(out) :: p
    real(wp), dimension(size(eos)) :: energy, own, floor
    real(wp) :: lowest, low, high, above, below, surplus, x
    integer :: i, k, side
    lowest = -huge(1.0_wp)
    do k = 1, size(eos)
      floor(k) = eos(k)%lowest_pressure(m(k)/a(k))
      own(k) = pressure_of(eos(k), m(k), a(k), e(k))
      lowest = max(lowest, merge(-eos(k)%gas%p_infinity, 0.0_wp, eos(k)%is_gas))
    end do
    high = max(maxval(own), maxval(floor), lowest)
    own = max(own, floor + 1e-12_wp*max(high - lowest, maxval(abs(own))) + tiny(1.0_wp))
    do k = 1, size(eos)
      energy(k) = a(k)*(own(k) - reference(eos(k), m(k)/a(k)))/eos(k)%grueneisen
    end do
    low = minval(own)
    high = maxval(own)
    if (low <= lowest) low = lowest + 1e-12_wp*(high - lowest)
    ! in logarithms, where gases are straight lines
    low = log(low - lowest)
    high = log(high - lowest)
    above = log(total(lowest + exp(low)))
    below = log(total(lowest + exp(high)))
    x = 0.5_wp*(low + high)
    side = 0
    do i = 1, most_steps
      x = 0.5_wp*(low + high)
      if (mod(i, 3) > 0 .and. above > below) x = low + (high - low)*above/(above - below)
      if (x <= low .or. x >= high) exit
      surplus = log(total(lowest + exp(x)))
      if (surplus > 0) then
        low = x
        above = surplus
        if (side == 1) below = 0.5_wp*below
        side = 1
      else
        high = x
        below = surplus
        if (side == -1) above = 0.5_wp*above
        side = -1
      end if
      if (abs(surplus) <= epsilon(1.0_wp)) exit
    end do
    p = lowest + exp(x)
    do k = 1, size(eos)
      a(k) = fraction_at(eos(k), m(k), a(k), energy(k), p)
    end do
    a = a/sum(a)
  contains
    pure real(wp) function total(trial)
      real(wp), intent(in) :: trial
      integer :: j
      total = 0
      do j = 1, size(eos)
        total = total + fraction_at(eos(j), m(j), a(j), energy(j), trial)
      end do
    end function total
  end subroutine relax_cell

  !> f(r); energies of gases are counted from their offset.
  pure real(wp) function reference(eos, r)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r
    if (eos%is_gas) then
      reference = -eos%gas%gamma*eos%gas%p_infinity
    else
      reference = eos%pressure(r, 0.0_wp)
    end if
  end function reference

  pure real(wp) function pressure_of(eos, m, a, e)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: m, a, e
    pressure_of = reference(eos, m/a) + eos%grueneisen*e/a
  end function pressure_of

  !> Fraction that a material takes at pressure p, from fraction a0 and energy e0 under the work of p.
  pure real(wp) function fraction_at(eos, m, a0, e0, p) result(a)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: m, a0, e0, p
    real(wp) :: g, low, high, below, above, missing
    integer :: i, side
    g = eos%grueneisen
    if (eos%is_gas) then
      a = g*(e0 + p*a0)/(eos%gas%gamma*(p + eos%gas%p_infinity))
      return
    end if
    low = a0*g/(1 + g)
    high = a0
    do i = 1, 200
      if (missing_work(high) >= 0) exit
      low = high
      high = 2*high
    end do
    below = missing_work(low)
    above = missing_work(high)
    a = high
    side = 0
    do i = 1, most_steps
      a = 0.5_wp*(low + high)
      if (mod(i, 3) > 0 .and. above > below) a = low - (high - low)*below/(above - below)
      if (a <= low .or. a >= high) exit
      missing = missing_work(a)
      if (missing < 0) then
        low = a
        below = missing
        if (side == -1) above = 0.5_wp*above
        side = -1
      else
        high = a
        above = missing
        if (side == 1) below = 0.5_wp*below
        side = 1
      end if
      if (abs(missing) <= epsilon(1.0_wp)*abs(e0)) exit
    end do
  contains
    pure real(wp) function missing_work(trial)
      real(wp), intent(in) :: trial
      missing_work = trial*(p - reference(eos, m/trial))/g + p*(trial - a0) - e0
    end function missing_work
  end function fraction_at

end module relaxation_fallback
