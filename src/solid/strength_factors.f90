!> Particles stronger or weaker than their material, by similarity: stress over the factor on the strength, strain times
!> the factor on the stiffness over that on the strength, and the constitutive model need not know.
!>
!> With strength a and stiffness b a model of modulus E and strength Y is asked for stress/a at strain b/a, which makes it one of
!> modulus b E and strength a Y; strains at peak and failure go with a/b and fracture energies with a^2/b. Thermal
!> energies stay what they are. Between to_reference and from_reference all arrays of a step are those of the material itself.
module strength_factors
  use cell_functions, only: chunk
  use constants, only: third
  use kinds, only: wp
  implicit none
  private
  public :: factors_of, to_reference, from_reference, reference_compression

  real(wp), parameter :: thinnest = 0.999_wp !< no density below a thousandth of that at rest is asked for

contains

  !> The factors of n particles: strength a, stiffness b. at: their columns, 0 where there is none.
  pure subroutine factors_of(n, capacity, f, first, at_strength, at_stiffness, a, b)
    integer, intent(in) :: n, capacity, first, at_strength, at_stiffness
    real(wp), intent(in) :: f(capacity, *)
    real(wp), intent(out) :: a(chunk), b(chunk)
    integer :: i
    a(:n) = 1
    b(:n) = 1
    if (at_strength > 0) then
      do i = 1, n
        a(i) = f(first + i - 1, at_strength)
      end do
    end if
    if (at_stiffness > 0) then
      do i = 1, n
        b(i) = f(first + i - 1, at_stiffness)
      end do
    end if
  end subroutine factors_of

  !> Before the model. g: velocity gradient times dt; the other arrays as in stress_update; work: plastic work to come back to.
  pure subroutine to_reference(n, a, b, shear_modulus, g, t, trial, power, shear, strain, old_pressure, compression, viscosity, &
      energy, plastic_strain, plastic_work, work)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(chunk), b(chunk), shear_modulus, g(chunk, 9), plastic_work(n)
    real(wp), intent(inout) :: t(chunk, 6)
    real(wp), intent(inout), dimension(n) :: trial, power, shear, strain, old_pressure, compression, viscosity, energy, &
      plastic_strain
    real(wp), intent(out) :: work(n)
    real(wp) :: per, similar, more, trace, d1, d2, d3, d4, d5, d6
    integer :: i
    !$omp simd private(per, similar, more, trace, d1, d2, d3, d4, d5, d6)
    do i = 1, n
      per = 1/a(i)
      similar = b(i)*per
      more = 2*shear_modulus*(b(i) - 1)
      trace = (g(i, 1) + g(i, 5) + g(i, 9))*third
      d1 = g(i, 1) - trace
      d2 = g(i, 5) - trace
      d3 = g(i, 9) - trace
      d4 = 0.5_wp*(g(i, 6) + g(i, 8))
      d5 = 0.5_wp*(g(i, 3) + g(i, 7))
      d6 = 0.5_wp*(g(i, 2) + g(i, 4))
      t(i, 1) = (t(i, 1) + more*d1)*per
      t(i, 2) = (t(i, 2) + more*d2)*per
      t(i, 3) = (t(i, 3) + more*d3)*per
      t(i, 4) = (t(i, 4) + more*d4)*per
      t(i, 5) = (t(i, 5) + more*d5)*per
      t(i, 6) = (t(i, 6) + more*d6)*per
      power(i) = (t(i, 1)*d1 + t(i, 2)*d2 + t(i, 3)*d3) + 2*(t(i, 4)*d4 + t(i, 5)*d5 + t(i, 6)*d6)
      trial(i) = sqrt(1.5_wp*((t(i, 1)*t(i, 1) + t(i, 2)*t(i, 2) + t(i, 3)*t(i, 3)) &
        + 2*(t(i, 4)*t(i, 4) + t(i, 5)*t(i, 5) + t(i, 6)*t(i, 6))))
      shear(i) = shear(i)*similar
      strain(i) = strain(i)*similar
      compression(i) = max(compression(i)*similar, -thinnest)
      old_pressure(i) = old_pressure(i)*per
      viscosity(i) = viscosity(i)*per
      energy(i) = energy(i)*per
      plastic_strain(i) = plastic_strain(i)*similar
      work(i) = plastic_work(i)
    end do
  end subroutine to_reference

  !> After the model.
  pure subroutine from_reference(n, a, b, work, t, power, shear, old_pressure, viscosity, pressure, energy, plastic_strain, &
      plastic_work)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(chunk), b(chunk), work(n)
    real(wp), intent(inout) :: t(chunk, 6)
    real(wp), intent(inout), dimension(n) :: power, shear, old_pressure, viscosity, pressure, energy, plastic_strain, plastic_work
    real(wp) :: similar
    integer :: i
    !$omp simd private(similar)
    do i = 1, n
      similar = a(i)/b(i)
      t(i, 1) = t(i, 1)*a(i)
      t(i, 2) = t(i, 2)*a(i)
      t(i, 3) = t(i, 3)*a(i)
      t(i, 4) = t(i, 4)*a(i)
      t(i, 5) = t(i, 5)*a(i)
      t(i, 6) = t(i, 6)*a(i)
      power(i) = power(i)*a(i)
      shear(i) = shear(i)*a(i)
      old_pressure(i) = old_pressure(i)*a(i)
      viscosity(i) = viscosity(i)*a(i)
      pressure(i) = pressure(i)*a(i)
      energy(i) = energy(i)*a(i)
      plastic_strain(i) = plastic_strain(i)*similar
      plastic_work(i) = work(i) + (plastic_work(i) - work(i))*a(i)*similar
    end do
  end subroutine from_reference

  !> The compression that the model has seen.
  pure subroutine reference_compression(n, a, b, compression)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(chunk), b(chunk)
    real(wp), intent(inout) :: compression(n)
    integer :: i
    !$omp simd
    do i = 1, n
      compression(i) = max(compression(i)*b(i)/a(i), -thinnest)
    end do
  end subroutine reference_compression

end module strength_factors
