!> Von Mises plasticity with linear isotropic hardening: s_y + H e_p, up to an ultimate stress.
module linear_hardening
  use kinds, only: wp
  implicit none
  private
  public :: linear_yield

contains

  !> The yield stress of n particles at their present plastic strain; the return to it adds H times the increment.
  pure subroutine linear_yield(n, yield_stress, hardening_modulus, plastic_strain, yield)
    integer, intent(in) :: n
    real(wp), intent(in) :: yield_stress, hardening_modulus, plastic_strain(n)
    real(wp), intent(out) :: yield(n)
    integer :: i
    !$omp simd
    do i = 1, n
      yield(i) = yield_stress + hardening_modulus*plastic_strain(i)
    end do
  end subroutine linear_yield

end module linear_hardening
