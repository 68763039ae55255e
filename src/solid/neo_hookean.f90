!> Neo-Hookean hyperelasticity: rubber, and any elastic solid at large strain without the drift of rates.
!>
!> Per volume at rest W = G/2 (tr b' - 3) + K/4 (J**2 - 1 - 2 ln J), b' = b/det(b)**(1/3) the left Cauchy-Green tensor without its
!> volume change and J = r0/r (Simo & Hughes, Computational Inelasticity, 1998, section 9.2). So the deviator is G/J dev b', and the
!> pressure K/2 (1/J - J). The energy of a particle is W plus the heat of the viscosity: a closed path gives all back.
module neo_hookean
  use cell_functions, only: chunk
  use constants, only: third
  use kinds, only: wp
  implicit none
  private
  public :: neo_hookean_stress, neo_hookean_modulus

contains

  !> Advances n particles. b: (capacity, 6) columns of this model, b' less the unit tensor in the order of the stress.
  !>
  !> With g = dt dv/dx the deformation of the step is (1 - g/2)**-1 (1 + g/2): exactly a rotation where the motion is one.
  pure subroutine neo_hookean_stress(n, bulk, shear, density, g, mass, old_volume, new_volume, new_viscosity, capacity, b, volume, &
      energy, viscosity, s1, s2, s3, s4, s5, s6)
    integer, intent(in) :: n, capacity
    real(wp), intent(in) :: bulk, shear, density, g(chunk, 9)
    real(wp), intent(in), dimension(n) :: mass, old_volume, new_volume, new_viscosity
    real(wp), intent(inout) :: b(capacity, 6)
    real(wp), intent(inout), dimension(n) :: volume, energy
    real(wp), intent(out), dimension(n) :: viscosity, s1, s2, s3, s4, s5, s6
    real(wp), dimension(chunk) :: before, after
    real(wp) :: f(chunk, 9)
    call stored_energy(n, bulk, shear, density, mass, old_volume, b(1, 1), b(1, 2), b(1, 3), before)
    call deformation(n, g, f)
    call push_forward(n, f, b(1, 1), b(1, 2), b(1, 3), b(1, 4), b(1, 5), b(1, 6))
    call stored_energy(n, bulk, shear, density, mass, new_volume, b(1, 1), b(1, 2), b(1, 3), after)
    call set_stress(n, bulk, shear, density, mass, old_volume, new_volume, new_viscosity, before, after, b(1, 1), b(1, 2), &
      b(1, 3), b(1, 4), b(1, 5), b(1, 6), volume, energy, viscosity, s1, s2, s3, s4, s5, s6)
  end subroutine neo_hookean_stress

  !> (1 - g/2)**-1 (1 + g/2), row by row.
  pure subroutine deformation(n, g, f)
    integer, intent(in) :: n
    real(wp), intent(in) :: g(chunk, 9)
    real(wp), intent(out) :: f(chunk, 9)
    real(wp) :: a11, a12, a13, a21, a22, a23, a31, a32, a33, m11, m12, m13, m21, m22, m23, m31, m32, m33, inverse
    integer :: i
    !$omp simd private(a11, a12, a13, a21, a22, a23, a31, a32, a33, m11, m12, m13, m21, m22, m23, m31, m32, m33, inverse)
    do i = 1, n
      a11 = 0.5_wp*g(i, 1)
      a12 = 0.5_wp*g(i, 2)
      a13 = 0.5_wp*g(i, 3)
      a21 = 0.5_wp*g(i, 4)
      a22 = 0.5_wp*g(i, 5)
      a23 = 0.5_wp*g(i, 6)
      a31 = 0.5_wp*g(i, 7)
      a32 = 0.5_wp*g(i, 8)
      a33 = 0.5_wp*g(i, 9)
      m11 = (1 - a22)*(1 - a33) - a23*a32
      m12 = a12*(1 - a33) + a13*a32
      m13 = a12*a23 + a13*(1 - a22)
      m21 = a21*(1 - a33) + a23*a31
      m22 = (1 - a11)*(1 - a33) - a13*a31
      m23 = (1 - a11)*a23 + a13*a21
      m31 = a21*a32 + (1 - a22)*a31
      m32 = (1 - a11)*a32 + a12*a31
      m33 = (1 - a11)*(1 - a22) - a12*a21
      inverse = 1/((1 - a11)*m11 - a12*m21 - a13*m31)
      f(i, 1) = (m11*(1 + a11) + m12*a21 + m13*a31)*inverse
      f(i, 2) = (m11*a12 + m12*(1 + a22) + m13*a32)*inverse
      f(i, 3) = (m11*a13 + m12*a23 + m13*(1 + a33))*inverse
      f(i, 4) = (m21*(1 + a11) + m22*a21 + m23*a31)*inverse
      f(i, 5) = (m21*a12 + m22*(1 + a22) + m23*a32)*inverse
      f(i, 6) = (m21*a13 + m22*a23 + m23*(1 + a33))*inverse
      f(i, 7) = (m31*(1 + a11) + m32*a21 + m33*a31)*inverse
      f(i, 8) = (m31*a12 + m32*(1 + a22) + m33*a32)*inverse
      f(i, 9) = (m31*a13 + m32*a23 + m33*(1 + a33))*inverse
    end do
  end subroutine deformation

  !> b' of the end of the step: f b' f^T without its volume change.
  pure subroutine push_forward(n, f, b1, b2, b3, b4, b5, b6)
    integer, intent(in) :: n
    real(wp), intent(in) :: f(chunk, 9)
    real(wp), intent(inout), dimension(n) :: b1, b2, b3, b4, b5, b6
    real(wp) :: x, y, z, h11, h12, h13, h21, h22, h23, h31, h32, h33, c1, c2, c3, c4, c5, c6, scale
    integer :: i
    !$omp simd private(x, y, z, h11, h12, h13, h21, h22, h23, h31, h32, h33, c1, c2, c3, c4, c5, c6, scale)
    do i = 1, n
      x = 1 + b1(i)
      y = 1 + b2(i)
      z = 1 + b3(i)
      h11 = f(i, 1)*x + f(i, 2)*b6(i) + f(i, 3)*b5(i)
      h12 = f(i, 1)*b6(i) + f(i, 2)*y + f(i, 3)*b4(i)
      h13 = f(i, 1)*b5(i) + f(i, 2)*b4(i) + f(i, 3)*z
      h21 = f(i, 4)*x + f(i, 5)*b6(i) + f(i, 6)*b5(i)
      h22 = f(i, 4)*b6(i) + f(i, 5)*y + f(i, 6)*b4(i)
      h23 = f(i, 4)*b5(i) + f(i, 5)*b4(i) + f(i, 6)*z
      h31 = f(i, 7)*x + f(i, 8)*b6(i) + f(i, 9)*b5(i)
      h32 = f(i, 7)*b6(i) + f(i, 8)*y + f(i, 9)*b4(i)
      h33 = f(i, 7)*b5(i) + f(i, 8)*b4(i) + f(i, 9)*z
      c1 = h11*f(i, 1) + h12*f(i, 2) + h13*f(i, 3)
      c2 = h21*f(i, 4) + h22*f(i, 5) + h23*f(i, 6)
      c3 = h31*f(i, 7) + h32*f(i, 8) + h33*f(i, 9)
      c4 = h21*f(i, 7) + h22*f(i, 8) + h23*f(i, 9)
      c5 = h11*f(i, 7) + h12*f(i, 8) + h13*f(i, 9)
      c6 = h11*f(i, 4) + h12*f(i, 5) + h13*f(i, 6)
      scale = c1*(c2*c3 - c4*c4) - c6*(c6*c3 - c4*c5) + c5*(c6*c4 - c2*c5)
      scale = exp(-third*log(scale))
      b1(i) = c1*scale - 1
      b2(i) = c2*scale - 1
      b3(i) = c3*scale - 1
      b4(i) = c4*scale
      b5(i) = c5*scale
      b6(i) = c6*scale
    end do
  end subroutine push_forward

  !> Strain energy of n particles.
  pure subroutine stored_energy(n, bulk, shear, density, mass, volume, b1, b2, b3, energy)
    integer, intent(in) :: n
    real(wp), intent(in) :: bulk, shear, density
    real(wp), intent(in), dimension(n) :: mass, volume, b1, b2, b3
    real(wp), intent(out) :: energy(n)
    real(wp) :: rest, j
    integer :: i
    !$omp simd private(rest, j)
    do i = 1, n
      rest = mass(i)/density
      j = volume(i)/rest
      energy(i) = rest*(0.5_wp*shear*(b1(i) + b2(i) + b3(i)) + 0.25_wp*bulk*(j*j - 1 - 2*log(j)))
    end do
  end subroutine stored_energy

  pure subroutine set_stress(n, bulk, shear, density, mass, old_volume, new_volume, new_viscosity, before, after, b1, b2, b3, b4, &
      b5, b6, volume, energy, viscosity, s1, s2, s3, s4, s5, s6)
    integer, intent(in) :: n
    real(wp), intent(in) :: bulk, shear, density
    real(wp), intent(in), dimension(n) :: mass, old_volume, new_volume, new_viscosity, before, after, b1, b2, b3, b4, b5, b6
    real(wp), intent(inout), dimension(n) :: volume, energy
    real(wp), intent(out), dimension(n) :: viscosity, s1, s2, s3, s4, s5, s6
    real(wp) :: j, factor, mean, pressure
    integer :: i
    !$omp simd private(j, factor, mean, pressure)
    do i = 1, n
      j = new_volume(i)*density/mass(i)
      factor = shear/j
      mean = (b1(i) + b2(i) + b3(i))*third
      pressure = 0.5_wp*bulk*(1/j - j)
      s1(i) = factor*(b1(i) - mean) - pressure
      s2(i) = factor*(b2(i) - mean) - pressure
      s3(i) = factor*(b3(i) - mean) - pressure
      s4(i) = factor*b4(i)
      s5(i) = factor*b5(i)
      s6(i) = factor*b6(i)
    end do
    !$omp simd
    do i = 1, n
      energy(i) = energy(i) + (after(i) - before(i)) + new_viscosity(i)*(old_volume(i) - new_volume(i))
      viscosity(i) = new_viscosity(i)
      volume(i) = new_volume(i)
    end do
  end subroutine set_stress

  !> r0 times dp/dr of n particles plus what large stretches add to 4/3 G, for the sound speed: K/2 (J**2 + 1) r0/r and
  !> G (tr b' - 3) r0/r, r0/r = J.
  pure subroutine neo_hookean_modulus(n, bulk, shear, density, mass, volume, b1, b2, b3, modulus)
    integer, intent(in) :: n
    real(wp), intent(in) :: bulk, shear, density
    real(wp), intent(in), dimension(n) :: mass, volume, b1, b2, b3
    real(wp), intent(out) :: modulus(n)
    real(wp) :: j
    integer :: i
    !$omp simd private(j)
    do i = 1, n
      j = volume(i)*density/mass(i)
      modulus(i) = 0.5_wp*bulk*(j*j + 1) + shear*(b1(i) + b2(i) + b3(i))
    end do
  end subroutine neo_hookean_modulus

end module neo_hookean
