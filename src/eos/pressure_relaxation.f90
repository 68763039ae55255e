!> Instantaneous pressure relaxation of the materials of a cell (paper eqs. 14, 15): volume fractions a_k and one pressure p
!> with  e_k(r_k, p) - e_k0 + p (1/r_k - 1/r_k0) = 0  and  sum a_k = 1, at fixed partial densities m_k = a_k r_k.
!> Per volume of the cell, with E_k = m_k e_k:  a_k (p - f_k)/g_k + p (a_k - a_k0) = E_k0,  f_k = f(m_k/a_k).
!> For a gas this gives a_k(p) at once; the fractions of other materials are unknowns beside p.
!> All is written in deviations from the fractions and from a start pressure: what is in equilibrium there keeps every bit.
module pressure_relaxation
  use kinds, only: wp
  use equation_of_state, only: eos_type, max_materials, is_jwl
  use relaxation_fallback, only: relax_cell
  implicit none
  private
  public :: relax_two_gases, relax_materials, relax_cell

  integer, parameter :: max_iterations = 12
  integer, parameter :: surplus = 1, stiffness = 2, moving = 3, volume = 4 !< columns of the work space
  integer, parameter :: softness = volume !< the part of the stiffness that soft materials have, beside condensed matter
  real(wp), parameter :: step_tolerance = 1e-6_wp !< of the last Newton step, relative; the error left is about its square

contains

  !> Row of n cells with two gases, in closed form: the pressure solves a quadratic.
  !> e: energies of both per volume; p_start: start pressure; a: fraction of the first gas, in and out.
  pure subroutine relax_two_gases(n, ld, first, second, p_start, e, a)
    integer, intent(in) :: n, ld
    type(eos_type), intent(in) :: first, second
    real(wp), intent(in) :: p_start(ld), e(ld, 2)
    real(wp), intent(inout) :: a(ld)
    real(wp) :: g1, g2, gamma1, gamma2, q1, q2, stiff1, stiff2, over_g1, over_g2
    real(wp) :: excess1, excess2, weight1, weight2, p1, p2, square, linear, constant, root, rise
    integer :: i
    g1 = first%grueneisen; gamma1 = first%gas%gamma; stiff1 = first%gas%p_infinity; q1 = first%rest_energy
    g2 = second%grueneisen; gamma2 = second%gas%gamma; stiff2 = second%gas%p_infinity; q2 = second%rest_energy
    over_g1 = first%over_g; over_g2 = second%over_g
    !$omp simd private(excess1, excess2, weight1, weight2, p1, p2, square, linear, constant, root, rise)
    do i = 1, n
      excess1 = g1*(e(i, 1) - a(i)*(p_start(i)*over_g1 + q1))
      excess2 = g2*(e(i, 2) - (1 - a(i))*(p_start(i)*over_g2 + q2))
      p1 = p_start(i) + stiff1
      p2 = p_start(i) + stiff2
      weight1 = a(i)*gamma2
      weight2 = (1 - a(i))*gamma1
      square = weight1 + weight2
      linear = weight1*p2 + weight2*p1 - gamma2*excess1 - gamma1*excess2
      constant = gamma2*excess1*p2 + gamma1*excess2*p1
      root = max(0.5_wp*(abs(linear) + sqrt(max(linear*linear + 4*square*constant, 0.0_wp))), tiny(1.0_wp))
      rise = merge(constant, root, linear >= 0)/merge(root, square, linear >= 0)
      a(i) = a(i) + (excess1 - a(i)*rise)/(gamma1*(p1 + rise))
    end do
  end subroutine relax_two_gases

  !> Row of n cells with any materials: Newton in (p, a_k), whose matrix has the shape of an arrow, on all cells at once.
  !> A cell that has converged is left alone, so its answer does not depend on the others of its row; one that does not
  !> converge is solved by bisection. m, e: partial densities and energies per volume; a: fractions, in and out;
  !> p_start: start pressure; p: relaxed pressure; n_fallback: cells solved by bisection; the last six are work space.
  pure subroutine relax_materials(n, ld, n_materials, eos, m, e, p_start, a, p, n_fallback, a_start, step, response, f, r_df, work)
    integer, intent(in) :: n, ld, n_materials
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: m(ld, n_materials), e(ld, n_materials), p_start(ld)
    real(wp), intent(inout) :: a(ld, n_materials)
    real(wp), intent(inout) :: p(ld)
    integer, intent(out) :: n_fallback
    real(wp), intent(inout) :: a_start(ld, n_materials), step(ld, n_materials), response(ld, n_materials)
    real(wp), intent(inout) :: f(ld, n_materials), r_df(ld, n_materials), work(ld, 4)
    logical :: soft(n_materials), condensed
    real(wp) :: lowest, unconverged, cell_m(max_materials), cell_e(max_materials), cell_a(max_materials), cell_p
    integer :: iteration, k, i
    lowest = 0
    if (all(eos%is_gas)) lowest = -minval(eos%gas%p_infinity)
    condensed = .not. all(eos%is_gas .or. eos%kind == is_jwl)
    soft = condensed .and. (eos%kind == is_jwl .or. (eos%is_gas .and. .not. eos%gas%p_infinity > 0))
    a_start(:n, :) = a(:n, :)
    work(:n, moving) = 1
    do iteration = 1, max_iterations
      do k = 1, n_materials
        if (.not. eos(k)%is_gas) call eos(k)%reference_rows(n, m(:, k), a(:, k), work(:, volume), f(:, k), r_df(:, k))
      end do
      if (iteration == 1) call guess_pressure(n, ld, n_materials, eos, a, e, f, p_start, work(:, surplus), &
        work(:, stiffness), p)
      if (iteration == 1 .and. condensed) p(:n) = max(p(:n), 0.1_wp*p_start(:n))
      call step_all(n, ld, n_materials, lowest, condensed, soft, eos, e, a_start, p_start, f, r_df, a, p, step, response, &
        work, unconverged)
      if (.not. unconverged > 0) exit
    end do
    do k = 1, n_materials
      if (eos(k)%is_gas) call gas_terms(n, eos(k), e(:, k), p_start, a_start(:, k), p, a(:, k), work(:, surplus), &
        work(:, stiffness))
    end do
    n_fallback = 0
    if (.not. unconverged > 0) return
    do i = 1, n
      if (.not. work(i, moving) > 0) cycle
      n_fallback = n_fallback + 1
      cell_m(:n_materials) = m(i, :)
      cell_e(:n_materials) = e(i, :)
      cell_a(:n_materials) = a_start(i, :)
      call relax_cell(eos, cell_m(:n_materials), cell_e(:n_materials), cell_a(:n_materials), cell_p)
      a(i, :) = cell_a(:n_materials)
      p(i) = cell_p
    end do
  end subroutine relax_materials

  !> One Newton step of all cells and materials.
  pure subroutine step_all(n, ld, n_materials, lowest, condensed, soft, eos, e, a_start, p_start, f, r_df, a, p, step, response, &
      work, unconverged)
    integer, intent(in) :: n, ld, n_materials
    logical, intent(in) :: condensed, soft(n_materials)
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: lowest, p_start(ld)
    real(wp), intent(in), dimension(ld, n_materials) :: e, a_start, f, r_df
    real(wp), intent(inout), dimension(ld, n_materials) :: a, step, response
    real(wp), intent(inout) :: p(ld), work(ld, 4)
    real(wp), intent(out) :: unconverged
    integer :: k, column
    work(:n, surplus) = 0
    work(:n, stiffness) = 0
    work(:n, softness) = 0
    do k = 1, n_materials
      column = merge(softness, stiffness, soft(k))
      if (eos(k)%is_gas) then
        call gas_terms(n, eos(k), e(:, k), p_start, a_start(:, k), p, a(:, k), work(:, surplus), work(:, column))
      else
        call newton_terms(n, eos(k)%grueneisen, e(:, k), a_start(:, k), p, f(:, k), r_df(:, k), a(:, k), &
          step(:, k), response(:, k), work(:, surplus), work(:, column))
      end if
    end do
    if (condensed) then
      call move_pressure_between(n, work(:, moving), work(:, surplus), work(:, stiffness), work(:, softness), p)
    else
      call move_pressure(n, lowest, work(:, moving), work(:, surplus), work(:, stiffness), p)
    end if
    do k = 1, n_materials
      if (.not. eos(k)%is_gas) call move_fraction(n, eos(k)%grueneisen, a_start(:, k), step(:, k), response(:, k), &
        work(:, surplus), work(:, moving), a(:, k))
    end do
    call stop_converged(n, lowest, work(:, surplus), p, work(:, moving), unconverged)
  end subroutine step_all

  !> Pressure that the energies have together before relaxation: near the relaxed one even for unequal materials.
  pure subroutine guess_pressure(n, ld, n_materials, eos, a, e, f, p_start, surplus, capacity, p)
    integer, intent(in) :: n, ld, n_materials
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: a(ld, n_materials), e(ld, n_materials), f(ld, n_materials), p_start(n)
    real(wp), intent(inout) :: surplus(n), capacity(n)
    real(wp), intent(inout) :: p(n)
    real(wp) :: over_g, q
    integer :: i, k
    surplus = 0
    capacity = 0
    do k = 1, n_materials
      over_g = eos(k)%over_g
      q = eos(k)%rest_energy
      if (eos(k)%is_gas) then
        !$omp simd
        do i = 1, n
          surplus(i) = surplus(i) + (e(i, k) - a(i, k)*(p_start(i)*over_g + q))
          capacity(i) = capacity(i) + a(i, k)*over_g
        end do
      else
        !$omp simd
        do i = 1, n
          surplus(i) = surplus(i) + (e(i, k) - a(i, k)*(p_start(i) - f(i, k))*over_g)
          capacity(i) = capacity(i) + a(i, k)*over_g
        end do
      end if
    end do
    !$omp simd
    do i = 1, n
      p(i) = p_start(i) + surplus(i)/capacity(i)
    end do
  end subroutine guess_pressure

  !> Fraction of a gas at pressure p; its growth adds to surplus, minus its slope in p to stiffness.
  pure subroutine gas_terms(n, eos, e, p_start, a_start, p, a, surplus, stiffness)
    integer, intent(in) :: n
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: e(n), p_start(n), a_start(n), p(n)
    real(wp), intent(out) :: a(n)
    real(wp), intent(inout) :: surplus(n), stiffness(n)
    real(wp) :: g, over_g, gamma, stiff, q, excess, growth, inverse
    integer :: i
    g = eos%grueneisen; over_g = eos%over_g; gamma = eos%gas%gamma; stiff = eos%gas%p_infinity; q = eos%rest_energy
    !$omp simd private(excess, growth, inverse)
    do i = 1, n
      excess = g*(e(i) - a_start(i)*(p_start(i)*over_g + q))
      inverse = 1/(gamma*(p(i) + stiff))
      growth = (excess - a_start(i)*(p(i) - p_start(i)))*inverse
      a(i) = a_start(i) + growth
      surplus(i) = surplus(i) + growth
      stiffness(i) = stiffness(i) + (a_start(i) + gamma*growth)*inverse
    end do
  end subroutine gas_terms

  !> Newton step of a fraction at fixed pressure, and its answer to a change of pressure.
  pure subroutine newton_terms(n, g, e, a_start, p, f, r_df, a, step, response, surplus, stiffness)
    integer, intent(in) :: n
    real(wp), intent(in) :: g, e(n), a_start(n), p(n), f(n), r_df(n), a(n)
    real(wp), intent(out) :: step(n), response(n)
    real(wp), intent(inout) :: surplus(n), stiffness(n)
    real(wp) :: over_g, residual, bulk, inverse
    integer :: i
    over_g = 1/g
    !$omp simd private(residual, bulk, inverse)
    do i = 1, n
      residual = a(i)*(p(i) - f(i))*over_g + p(i)*(a(i) - a_start(i)) - e(i)
      bulk = r_df(i) + p(i) - f(i) + g*p(i) ! r c**2
      inverse = 1/max(bulk, 0.1_wp*p(i))
      step(i) = -residual*g*inverse
      response(i) = -(a(i) + g*(a(i) - a_start(i)))*inverse
      surplus(i) = surplus(i) + (a(i) - a_start(i)) + step(i)
      stiffness(i) = stiffness(i) - response(i)
    end do
  end subroutine newton_terms

  !> Pressure step that makes the fractions fill the cell; surplus becomes the step taken.
  pure subroutine move_pressure(n, lowest, moving, surplus, stiffness, p)
    integer, intent(in) :: n
    real(wp), intent(in) :: lowest, moving(n), stiffness(n)
    real(wp), intent(inout) :: surplus(n), p(n)
    real(wp) :: rise
    integer :: i
    !$omp simd private(rise)
    do i = 1, n
      rise = max(surplus(i)/stiffness(i), 0.9_wp*(lowest - p(i)))
      rise = merge(rise, 0.0_wp, moving(i) > 0)
      p(i) = p(i) + rise
      surplus(i) = rise
    end do
  end subroutine move_pressure

  !> The same where condensed matter is beside soft materials: between a firm part, linear in p, and a soft part, like 1/p, the
  !> pressure may have to fall by many orders of ten, when matter that is thinned out lets a trace of gas fill a gap. With the
  !> surplus F, and S p**2/p for the soft part, the step d solves F - S p d/(p + d) - stiffness d = 0, a quadratic whose root
  !> keeps p + d positive. A rise is held to ten times the pressure or the step of Newton's method, which falls short of the root.
  pure subroutine move_pressure_between(n, moving, surplus, stiffness, softness, p)
    integer, intent(in) :: n
    real(wp), intent(in) :: moving(n), stiffness(n), softness(n)
    real(wp), intent(inout) :: surplus(n), p(n)
    real(wp) :: linear, root, rise, newton
    integer :: i
    !$omp simd private(linear, root, rise, newton)
    do i = 1, n
      newton = surplus(i)/(stiffness(i) + softness(i))
      linear = (stiffness(i) + softness(i))*p(i) - surplus(i)
      root = sqrt(max(linear*linear + 4*stiffness(i)*surplus(i)*p(i), 0.0_wp))
      rise = 2*surplus(i)*p(i)/max(abs(linear) + root, tiny(1.0_wp))
      rise = merge(rise, max(newton, 9*p(i)), linear > 0)
      rise = max(min(rise, max(newton, 9*p(i))), -0.999999_wp*p(i))
      rise = merge(rise, 0.0_wp, moving(i) > 0)
      p(i) = p(i) + rise
      surplus(i) = rise
    end do
  end subroutine move_pressure_between

  !> Moves a fraction with the pressure, by no more than keeps it above its limit of compression. A step that is still large
  !> marks the cell as moving with the value 2.
  pure subroutine move_fraction(n, g, a_start, step, response, rise, moving, a)
    integer, intent(in) :: n
    real(wp), intent(in) :: g, a_start(n), step(n), response(n), rise(n)
    real(wp), intent(inout) :: moving(n), a(n)
    real(wp) :: limit, new, densest
    integer :: i
    densest = g/(1 + g)
    !$omp simd private(limit, new)
    do i = 1, n
      limit = 0.5_wp*(a(i) + min(a(i), densest*a_start(i)))
      new = min(max(a(i) + step(i) + response(i)*rise(i), limit), 3*a(i))
      new = merge(new, a(i), moving(i) > 0)
      moving(i) = merge(2.0_wp, moving(i), abs(new - a(i)) > step_tolerance*a(i))
      a(i) = new
    end do
  end subroutine move_fraction

  !> A cell stops when its pressure and all its fractions made a small step. unconverged: 1 if a cell goes on, else 0.
  pure subroutine stop_converged(n, lowest, rise, p, moving, unconverged)
    integer, intent(in) :: n
    real(wp), intent(in) :: lowest, rise(n), p(n)
    real(wp), intent(inout) :: moving(n)
    real(wp), intent(out) :: unconverged
    integer :: i
    unconverged = 0
    !$omp simd reduction(max:unconverged)
    do i = 1, n
      moving(i) = merge(0.0_wp, min(moving(i), 1.0_wp), moving(i) < 2 .and. abs(rise(i)) <= step_tolerance*(p(i) - lowest))
      unconverged = max(unconverged, moving(i))
    end do
  end subroutine stop_converged

end module pressure_relaxation
