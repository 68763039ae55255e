!> HLLC fluxes on a row of faces (paper eq. 11), wave speeds of Davis: the fastest of both cells to either side.
!> The upwind side of the contact is chosen first and one star state computed. With chi = r*/r across the wave on that side, every
!> partial density is compressed by chi, volume fractions ride the contact, and each material's energy follows its
!> Hugoniot, e* - e = (p* + p)/2 (1/r - 1/r*), with the star pressure of the mixture: then the material energies add up to
!> the energy of HLLC's own star state exactly. One face velocity serves all terms that are not conserved.
module riemann
  use kinds, only: wp
  use flow_layout, only: layout_type
  use equation_of_state, only: eos_type
  use riemann_two_materials, only: hllc_two_materials
  implicit none
  private
  public :: hllc_single, hllc_materials, close_faces

contains

  !> Fluxes of one material. left, right: reconstructed rows on both sides of the faces; c_left, c_right: sound speeds of the cells
  !> on both sides; normal: rows of the velocities normal to the face and along it; flux: rows as in flow_layout; wave: scratch.
  pure subroutine hllc_single(n, ld, layout, eos, normal, left, c_left, right, c_right, flux, wave)
    integer, intent(in) :: n, ld, normal(3)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: left(ld, *), c_left(n), right(ld, *), c_right(n)
    real(wp), intent(inout) :: flux(ld, 5), wave(ld, 5)
    if (eos%is_gas) then
      call gas_fluxes(n, ld, normal(1), normal(2), normal(3), eos%over_g, eos%rest_energy, &
        left, c_left, right, c_right, flux)
    else
      call stored_energy_fluxes(n, ld, normal(1), normal(2), normal(3), layout%energy(1), left, c_left, right, c_right, &
        flux, wave)
    end if
  end subroutine hllc_single

  pure subroutine gas_fluxes(n, ld, u, v, w, over_g, q, left, c_left, right, c_right, flux)
    integer, intent(in) :: n, ld, u, v, w
    real(wp), intent(in) :: over_g, q, left(ld, 5), c_left(n), right(ld, 5), c_right(n)
    real(wp), intent(out) :: flux(ld, 5)
    integer, parameter :: r = 1, p = 5
    real(wp) :: c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, v_up, w_up, p_up, gap, inverse
    real(wp) :: contact, chi, p_star, p_face, u_face, mass, work
    logical :: from_left, star
    integer :: i
    !$omp simd private(c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, v_up, w_up, p_up, gap, inverse, &
    !$omp   contact, chi, p_star, p_face, u_face, mass, work, from_left, star)
    do i = 1, n
      c = max(c_left(i), c_right(i))
      s_left = min(left(i, u), right(i, u)) - c
      s_right = max(left(i, u), right(i, u)) + c
      m_left = left(i, r)*(s_left - left(i, u))
      m_right = right(i, r)*(s_right - right(i, u))
      push = right(i, p) - left(i, p) + m_left*left(i, u) - m_right*right(i, u)
      weight = m_left - m_right
      from_left = push < 0 ! weight is negative: the contact moves to the right
      s = merge(s_left, s_right, from_left)
      m = merge(m_left, m_right, from_left)
      r_up = merge(left(i, r), right(i, r), from_left)
      u_up = merge(left(i, u), right(i, u), from_left)
      v_up = merge(left(i, v), right(i, v), from_left)
      w_up = merge(left(i, w), right(i, w), from_left)
      p_up = merge(left(i, p), right(i, p), from_left)
      gap = s*weight - push
      inverse = 1/(weight*gap)
      contact = push*inverse*gap
      star = s*push >= 0 ! the outer wave runs against the contact: the face lies in the star region
      chi = merge((s - u_up)*(weight*weight*inverse), 1.0_wp, star)
      p_star = p_up + m*(contact - u_up)
      u_face = merge(contact, u_up, star)
      p_face = merge(p_star, p_up, star)
      work = 0.5_wp*(p_star + p_up)*(chi - 1)
      mass = r_up*(chi*u_face)
      flux(i, r) = mass
      flux(i, u) = mass*u_face + p_face
      flux(i, v) = mass*v_up
      flux(i, w) = mass*w_up
      flux(i, p) = u_face*(chi*(p_up*over_g + q) + work + p_face) &
        + 0.5_wp*mass*(u_face*u_face + v_up*v_up + w_up*w_up)
    end do
  end subroutine gas_fluxes

  !> As gas_fluxes, with the energy per volume taken from its own row e.
  pure subroutine stored_energy_fluxes(n, ld, u, v, w, e, left, c_left, right, c_right, flux, wave)
    integer, intent(in) :: n, ld, u, v, w, e
    real(wp), intent(in) :: left(ld, *), c_left(n), right(ld, *), c_right(n)
    real(wp), intent(inout) :: flux(ld, 5), wave(ld, 5)
    logical :: from_left
    integer :: i
    call contact_fluxes(n, ld, 1, u, v, w, 5, u, v, w, 5, left, c_left, right, c_right, flux, wave)
    !$omp simd private(from_left)
    do i = 1, n
      from_left = wave(i, 1) < 0
      flux(i, 1) = wave(i, 5)
      flux(i, 5) = flux(i, 5) + wave(i, 3)*(wave(i, 2)*merge(left(i, e), right(i, e), from_left) + wave(i, 4))
    end do
  end subroutine stored_energy_fluxes

  !> Fluxes of N materials, as hllc_single; wave, partial and fractions are work space.
  !> The density of the mixture is reconstructed as a whole and the materials share its flux in proportion to their own
  !> reconstructed partial densities, so that a mixture of equal materials flows as one of them.
  pure subroutine hllc_materials(n, ld, n_materials, layout, eos, normal, left, c_left, right, c_right, flux, wave, partial, &
      fractions)
    integer, intent(in) :: n, ld, n_materials, normal(3)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(n_materials)
    real(wp), intent(in) :: left(ld, *), c_left(n), right(ld, *), c_right(n)
    real(wp), intent(inout) :: flux(ld, *), wave(ld, 7), partial(ld, n_materials), fractions(ld, n_materials)
    integer :: first, u, e, k
    if (n_materials == 2) then
      call hllc_two_materials(n, ld, layout, eos, normal, left, c_left, right, c_right, flux, wave)
      return
    end if
    first = layout%momentum_flux - layout%velocity_row
    u = layout%face_velocity_flux
    e = layout%energy_flux
    call contact_fluxes(n, ld, layout%density_row, normal(1), normal(2), normal(3), layout%pressure_row, &
      normal(1) + first, normal(2) + first, normal(3) + first, e, left, c_left, right, c_right, flux, wave)
    call upwind_rows(n, ld, wave, left(1, layout%pressure_row), right(1, layout%pressure_row), flux(1, u))
    call share_mass(n, ld, n_materials, wave, left, right, partial, wave(1, 7), flux)
    call upwind_fractions(n, ld, n_materials, wave(1, 1), left(1, layout%first_fraction_row), &
      right(1, layout%first_fraction_row), wave(1, 7), fractions)
    do k = 1, n_materials
      call ride_contact(n, flux(1, u), fractions(1, k), flux(1, layout%first_fraction_flux + k - 1))
    end do
    do k = 1, n_materials
      associate (f => layout%first_material_energy_flux + k - 1, row => layout%energy(k))
        if (row == 0) then
          call gas_energy_flux(n, eos(k)%over_g, eos(k)%rest_energy, wave(1, 6), fractions(1, k), &
            wave, ld, flux(1, f), flux(1, e))
        else
          call stored_energy_flux(n, left(1, row), right(1, row), fractions(1, k), wave, ld, flux(1, f), flux(1, e))
        end if
      end associate
    end do
  end subroutine hllc_materials

  !> What all materials share: momentum fluxes (rows mu, mv, mw), the part of the energy flux (row e) that is not internal energy,
  !> and wave = sign of the contact (negative: from the left), chi, face velocity, work of compression, mass flux of the mixture.
  pure subroutine contact_fluxes(n, ld, r, u, v, w, p, mu, mv, mw, e, left, c_left, right, c_right, flux, wave)
    integer, intent(in) :: n, ld, r, u, v, w, p, mu, mv, mw, e
    real(wp), intent(in) :: left(ld, *), c_left(n), right(ld, *), c_right(n)
    real(wp), intent(inout) :: flux(ld, *), wave(ld, 5)
    real(wp) :: c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, v_up, w_up, p_up, gap, inverse
    real(wp) :: contact, chi, p_star, p_face, u_face, mass
    logical :: from_left, star
    integer :: i
    !$omp simd private(c, s_left, s_right, m_left, m_right, push, weight, s, m, r_up, u_up, v_up, w_up, p_up, gap, inverse, &
    !$omp   contact, chi, p_star, p_face, u_face, mass, from_left, star)
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
      r_up = merge(left(i, r), right(i, r), from_left)
      u_up = merge(left(i, u), right(i, u), from_left)
      v_up = merge(left(i, v), right(i, v), from_left)
      w_up = merge(left(i, w), right(i, w), from_left)
      p_up = merge(left(i, p), right(i, p), from_left)
      gap = s*weight - push
      inverse = 1/(weight*gap)
      contact = push*inverse*gap
      star = s*push >= 0
      chi = merge((s - u_up)*(weight*weight*inverse), 1.0_wp, star)
      p_star = p_up + m*(contact - u_up)
      u_face = merge(contact, u_up, star)
      p_face = merge(p_star, p_up, star)
      mass = r_up*(chi*u_face)
      wave(i, 5) = mass
      flux(i, mu) = mass*u_face + p_face
      flux(i, mv) = mass*v_up
      flux(i, mw) = mass*w_up
      flux(i, e) = u_face*p_face + 0.5_wp*mass*(u_face*u_face + v_up*v_up + w_up*w_up)
      wave(i, 1) = push
      wave(i, 2) = chi
      wave(i, 3) = u_face
      wave(i, 4) = 0.5_wp*(p_star + p_up)*(chi - 1)
    end do
  end subroutine contact_fluxes

  pure subroutine take_upwind(n, push, left, right, upwind, total)
    integer, intent(in) :: n
    real(wp), intent(in) :: push(n), left(n), right(n)
    real(wp), intent(out) :: upwind(n)
    real(wp), intent(inout) :: total(n)
    integer :: i
    !$omp simd
    do i = 1, n
      upwind(i) = merge(left(i), right(i), push(i) < 0)
      total(i) = total(i) + upwind(i)
    end do
  end subroutine take_upwind

  !> Face velocity as a flux, and the upwind pressure in wave(:, 6).
  pure subroutine upwind_rows(n, ld, wave, left, right, u_face)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: left(n), right(n)
    real(wp), intent(inout) :: wave(ld, 6), u_face(n)
    integer :: i
    !$omp simd
    do i = 1, n
      wave(i, 6) = merge(left(i), right(i), wave(i, 1) < 0)
      u_face(i) = wave(i, 3)
    end do
  end subroutine upwind_rows

  pure subroutine share_mass(n, ld, n_materials, wave, left, right, partial, total, flux)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: wave(ld, 6), left(ld, n_materials), right(ld, n_materials)
    real(wp), intent(inout) :: partial(ld, n_materials), total(n), flux(ld, n_materials)
    integer :: i, k
    total(:n) = 0
    do k = 1, n_materials
      call take_upwind(n, wave(1, 1), left(1, k), right(1, k), partial(1, k), total)
    end do
    !$omp simd
    do i = 1, n
      total(i) = wave(i, 5)/total(i)
    end do
    do k = 1, n_materials
      !$omp simd
      do i = 1, n
        flux(i, k) = partial(i, k)*total(i)
      end do
    end do
  end subroutine share_mass

  !> Fractions of three or more materials on the upwind side, scaled to fill the face: their limiters differ.
  pure subroutine upwind_fractions(n, ld, n_materials, push, left, right, total, fractions)
    integer, intent(in) :: n, ld, n_materials
    real(wp), intent(in) :: push(n), left(ld, n_materials), right(ld, n_materials)
    real(wp), intent(inout) :: total(n), fractions(ld, n_materials)
    integer :: i, k
    total(:n) = 0
    do k = 1, n_materials
      call take_upwind(n, push, left(1, k), right(1, k), fractions(1, k), total)
    end do
    !$omp simd
    do i = 1, n
      total(i) = 1/total(i)
    end do
    do k = 1, n_materials
      !$omp simd
      do i = 1, n
        fractions(i, k) = fractions(i, k)*total(i)
      end do
    end do
  end subroutine upwind_fractions

  pure subroutine ride_contact(n, u_face, fraction, flux)
    integer, intent(in) :: n
    real(wp), intent(in) :: u_face(n), fraction(n)
    real(wp), intent(out) :: flux(n)
    integer :: i
    !$omp simd
    do i = 1, n
      flux(i) = fraction(i)*u_face(i)
    end do
  end subroutine ride_contact

  pure subroutine gas_energy_flux(n, over_g, q, p, fraction, wave, ld, flux, total)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: over_g, q, p(n), fraction(n), wave(ld, 4)
    real(wp), intent(out) :: flux(n)
    real(wp), intent(inout) :: total(n)
    integer :: i
    !$omp simd
    do i = 1, n
      flux(i) = wave(i, 3)*(fraction(i)*(wave(i, 2)*(p(i)*over_g + q) + wave(i, 4)))
      total(i) = total(i) + flux(i)
    end do
  end subroutine gas_energy_flux

  pure subroutine stored_energy_flux(n, left, right, fraction, wave, ld, flux, total)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: left(n), right(n), fraction(n), wave(ld, 4)
    real(wp), intent(out) :: flux(n)
    real(wp), intent(inout) :: total(n)
    integer :: i
    !$omp simd
    do i = 1, n
      flux(i) = wave(i, 3)*(wave(i, 2)*merge(left(i), right(i), wave(i, 1) < 0) + fraction(i)*wave(i, 4))
      total(i) = total(i) + flux(i)
    end do
  end subroutine stored_energy_flux

  !> Makes a wall of each face with a closed cell (0 in open) on either side: no flux but the pressure of the open cell, and that
  !> pressure is returned in force, positive where it pushes a closed cell on the upper side, negative on the lower.
  pure subroutine close_faces(n, ld, n_fluxes, momentum, open_left, p_left, open_right, p_right, flux, force)
    integer, intent(in) :: n, ld, n_fluxes, momentum
    real(wp), intent(in) :: open_left(n), p_left(n), open_right(n), p_right(n)
    real(wp), intent(inout) :: flux(ld, n_fluxes)
    real(wp), intent(out) :: force(n)
    integer :: i, v
    do v = 1, n_fluxes
      !$omp simd
      do i = 1, n
        flux(i, v) = merge(flux(i, v), 0.0_wp, open_left(i)*open_right(i) > 0)
      end do
    end do
    do i = 1, n
      force(i) = 0
      if (open_left(i)*open_right(i) > 0) cycle
      if (open_left(i) > 0) then
        force(i) = p_left(i)
        flux(i, momentum) = p_left(i)
      else if (open_right(i) > 0) then
        force(i) = -p_right(i)
        flux(i, momentum) = p_right(i)
      end if
    end do
  end subroutine close_faces

end module riemann
