!> Where shocks are, seen in all directions, and the dissipation of shear waves there that cures carbuncle and odd-even decoupling.
!> A shock along the mesh is unstable under HLLC because the faces across its front add no dissipation: nothing flows through them
!> and there is no jump. HLLC without its shear wave (Shen, Yan & Yuan, J. Comput. Phys. 309, 2016) is stable and still keeps
!> contacts and material interfaces. Here the shear wave fades only where the sensor sees a shock, so shear layers stay sharp
!> elsewhere.
module shock_sensor
  use kinds, only: wp
  implicit none
  private
  public :: sense_shocks, dissipate_shear

  !> The sensor is the pressure difference of the two neighbours over r c**2 of the cell, the largest of all directions; shear
  !> dissipation starts at the first number and is complete at the second.
  real(wp), parameter :: onset = 0.1_wp, complete = 0.4_wp

contains

  !> Part of the shear dissipation, 0 to 1, in each of n cells of a row. stride: distance of neighbours in the three directions, 0
  !> in those that are not active; p: pressure of the first cell stands at p(1); r, c: density and sound speed. highest: of the row.
  pure subroutine sense_shocks(n, stride, reach, p, r, c, part, highest)
    integer, intent(in) :: n, stride(3), reach
    real(wp), intent(in) :: p(1 - reach:*), r(n), c(n)
    real(wp), intent(inout) :: part(n)
    real(wp), intent(out) :: highest
    real(wp) :: jump, stiffness
    integer :: i, x, y, z
    x = stride(1)
    y = stride(2)
    z = stride(3)
    highest = 0
    !$omp simd private(jump, stiffness) reduction(max:highest)
    do i = 1, n
      jump = max(max(abs(p(i + x) - p(i - x)), abs(p(i + y) - p(i - y))), abs(p(i + z) - p(i - z)))
      stiffness = r(i)*c(i)*c(i)
      part(i) = min(max(jump - onset*stiffness, 0.0_wp)/((complete - onset)*stiffness), 1.0_wp)
      highest = max(highest, part(i))
    end do
  end subroutine sense_shocks

  !> Adds to HLLC fluxes what the faded shear wave changes: with q = part of the shear dissipation, the velocities along the face
  !> become v = (1 - q) v_upwind + q v_hll in the star region. Arguments as contact_fluxes in module riemann; part_left,
  !> part_right: of the cells on both sides; mass: sum of the mass fluxes.
  pure subroutine dissipate_shear(n, ld, r, u, v, w, p, mv, mw, e, left, c_left, part_left, right, c_right, part_right, mass, flux)
    integer, intent(in) :: n, ld, r, u, v, w, p, mv, mw, e
    real(wp), intent(in) :: left(ld, *), c_left(n), part_left(n), right(ld, *), c_right(n), part_right(n), mass(n)
    real(wp), intent(inout) :: flux(ld, *)
    real(wp) :: c, s_left, s_right, m_left, m_right, push, weight, s, m, across, rate, v_up, w_up, dv, dw
    logical :: from_left
    integer :: i
    !$omp simd private(c, s_left, s_right, m_left, m_right, push, weight, s, m, across, rate, v_up, w_up, dv, dw, from_left)
    do i = 1, n
      c = max(c_left(i), c_right(i))
      s_left = min(left(i, u), right(i, u)) - c
      s_right = max(left(i, u), right(i, u)) + c
      m_left = left(i, r)*(s_left - left(i, u))
      m_right = right(i, r)*(s_right - right(i, u))
      push = right(i, p) - left(i, p) + m_left*left(i, u) - m_right*right(i, u)
      weight = m_left - m_right
      from_left = push < 0
      s = merge(s_left, s_right, from_left)
      m = merge(m_left, m_right, from_left)
      across = -merge(m_right, m_left, from_left) ! v_hll - v_upwind = across (v_right - v_left)/weight
      across = merge(across, 0.0_wp, s*push >= 0)*max(part_left(i), part_right(i))/weight
      v_up = merge(left(i, v), right(i, v), from_left)
      w_up = merge(left(i, w), right(i, w), from_left)
      dv = across*(right(i, v) - left(i, v))
      dw = across*(right(i, w) - left(i, w))
      rate = mass(i) + m
      flux(i, mv) = flux(i, mv) + rate*dv
      flux(i, mw) = flux(i, mw) + rate*dw
      flux(i, e) = flux(i, e) + rate*(dv*(v_up + 0.5_wp*dv) + dw*(w_up + 0.5_wp*dw))
    end do
  end subroutine dissipate_shear

end module shock_sensor
