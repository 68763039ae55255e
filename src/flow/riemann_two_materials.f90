!> HLLC fluxes of two materials on a row of faces: what hllc_materials in riemann does for any number, in two loops.
module riemann_two_materials
  use kinds, only: wp
  use flow_layout, only: layout_type
  use equation_of_state, only: eos_type
  implicit none
  private
  public :: hllc_two_materials

contains

  !> Arguments as hllc_materials in riemann. wave: sign of the contact (negative: from the left), chi, pressure on the face, work of
  !> compression, mass flux.
  pure subroutine hllc_two_materials(n, ld, layout, eos, normal, left, c_left, right, c_right, flux, wave)
    integer, intent(in) :: n, ld, normal(3)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(2)
    real(wp), intent(in) :: left(ld, *), c_left(n), right(ld, *), c_right(n)
    real(wp), intent(inout) :: flux(ld, *), wave(ld, 5)
    real(wp) :: over_g(2), rest(2)
    integer :: k, r, p, u, e
    r = layout%density_row
    p = layout%pressure_row
    u = layout%face_velocity_flux
    e = layout%first_material_energy_flux
    over_g = merge(eos%over_g, 0.0_wp, eos%is_gas)
    rest = merge(eos%rest_energy, 0.0_wp, eos%is_gas)
    call contact_of(n, left(1, r), left(1, normal(1)), left(1, p), c_left, right(1, r), right(1, normal(1)), right(1, p), &
      c_right, wave, wave(1, 2), wave(1, 3), wave(1, 4), wave(1, 5), flux(1, u))
    call fluxes_of(n, ld, normal(2), normal(3), p, layout%first_fraction_row, over_g(1), rest(1), over_g(2), rest(2), left, right, &
      wave, flux(1, u), flux, flux(1, normal(1)), flux(1, normal(2)), flux(1, normal(3)), flux(1, layout%energy_flux), &
      flux(1, layout%first_fraction_flux), flux(1, e), flux(1, e + 1))
    do k = 1, 2
      if (layout%energy_row(k) > 0) call add_stored(n, left(1, layout%energy_row(k)), right(1, layout%energy_row(k)), wave, &
        wave(1, 2), flux(1, u), flux(1, e + k - 1), flux(1, layout%energy_flux))
    end do
  end subroutine hllc_two_materials

  !> What the waves of the mixture do to the face.
  pure subroutine contact_of(n, r_left, u_left, p_left, c_left, r_right, u_right, p_right, c_right, contact, chi, p_face, work, &
      mass, u_face)
    integer, intent(in) :: n
    real(wp), intent(in), dimension(n) :: r_left, u_left, p_left, c_left, r_right, u_right, p_right, c_right
    real(wp), intent(out), dimension(n) :: contact, chi, p_face, work, mass, u_face
    real(wp) :: c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, p_up, gap, inverse, speed, p_star
    real(wp) :: squeeze, u
    logical :: from_left, star
    integer :: i
    !$omp simd private(c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, p_up, gap, inverse, speed, p_star, &
    !$omp   squeeze, u, from_left, star)
    do i = 1, n
      c = max(c_left(i), c_right(i))
      s_left = min(u_left(i), u_right(i)) - c
      s_right = max(u_left(i), u_right(i)) + c
      m_left = r_left(i)*(s_left - u_left(i))
      m_right = r_right(i)*(s_right - u_right(i))
      push = p_right(i) - p_left(i) + m_left*u_left(i) - m_right*u_right(i)
      weight = m_left - m_right
      from_left = push < 0 ! weight is negative: the contact moves to the right
      s = merge(s_left, s_right, from_left)
      m = merge(m_left, m_right, from_left)
      r_up = merge(r_left(i), r_right(i), from_left)
      u_up = merge(u_left(i), u_right(i), from_left)
      p_up = merge(p_left(i), p_right(i), from_left)
      gap = s*weight - push
      inverse = 1/(weight*gap)
      speed = push*inverse*gap
      star = s*push >= 0
      squeeze = merge((s - u_up)*(weight*weight*inverse), 1.0_wp, star)
      p_star = p_up + m*(speed - u_up)
      u = merge(speed, u_up, star)
      contact(i) = push
      chi(i) = squeeze
      p_face(i) = merge(p_star, p_up, star)
      work(i) = 0.5_wp*(p_star + p_up)*(squeeze - 1)
      mass(i) = r_up*(squeeze*u)
      u_face(i) = u
    end do
  end subroutine contact_of

  !> All fluxes, without the energy of materials that have a row of their own (over_g and q are 0 there).
  pure subroutine fluxes_of(n, ld, v, w, p, a, og1, q1, og2, q2, left, right, wave, u_face, mass, along_u, along_v, along_w, &
      total, fraction, energy1, energy2)
    integer, intent(in) :: n, ld, v, w, p, a
    real(wp), intent(in) :: og1, q1, og2, q2, left(ld, *), right(ld, *), wave(ld, 5), u_face(n)
    real(wp), intent(out), dimension(n) :: along_u, along_v, along_w, total, fraction, energy1, energy2
    real(wp), intent(inout) :: mass(ld, 2)
    real(wp) :: m1, m2, first, share, p_up, v_up, w_up, e1, e2, u, whole
    logical :: from_left
    integer :: i
    !$omp simd private(m1, m2, first, share, p_up, v_up, w_up, e1, e2, u, whole, from_left)
    do i = 1, n
      from_left = wave(i, 1) < 0
      u = u_face(i)
      whole = wave(i, 5)
      m1 = merge(left(i, 1), right(i, 1), from_left)
      m2 = merge(left(i, 2), right(i, 2), from_left)
      v_up = merge(left(i, v), right(i, v), from_left)
      w_up = merge(left(i, w), right(i, w), from_left)
      p_up = merge(left(i, p), right(i, p), from_left)
      first = merge(left(i, a), right(i, a), from_left)
      share = whole/(m1 + m2)
      mass(i, 1) = m1*share
      mass(i, 2) = m2*share
      along_u(i) = whole*u + wave(i, 3)
      along_v(i) = whole*v_up
      along_w(i) = whole*w_up
      e1 = u*(first*(wave(i, 2)*(p_up*og1 + q1) + wave(i, 4)))
      e2 = u*((1 - first)*(wave(i, 2)*(p_up*og2 + q2) + wave(i, 4)))
      total(i) = (u*wave(i, 3) + 0.5_wp*whole*(u*u + v_up*v_up + w_up*w_up)) + e1 + e2
      fraction(i) = first*u
      energy1(i) = e1
      energy2(i) = e2
    end do
  end subroutine fluxes_of

  !> The energy of a material that has its own row, compressed with the mixture.
  pure subroutine add_stored(n, left, right, contact, chi, u_face, energy, total)
    integer, intent(in) :: n
    real(wp), intent(in), dimension(n) :: left, right, contact, chi, u_face
    real(wp), intent(inout), dimension(n) :: energy, total
    real(wp) :: stored
    integer :: i
    !$omp simd private(stored)
    do i = 1, n
      stored = u_face(i)*(chi(i)*merge(left(i), right(i), contact(i) < 0))
      energy(i) = energy(i) + stored
      total(i) = total(i) + stored
    end do
  end subroutine add_stored

end module riemann_two_materials
