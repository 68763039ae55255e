!> Von Mises plasticity with a constant yield stress.
module perfect_plasticity
  use kinds, only: wp
  implicit none
  private
  public :: perfect_yield

contains

  !> The yield stress of n particles.
  pure subroutine perfect_yield(n, yield_stress, yield)
    integer, intent(in) :: n
    real(wp), intent(in) :: yield_stress
    real(wp), intent(out) :: yield(n)
    yield = yield_stress
  end subroutine perfect_yield

end module perfect_plasticity
