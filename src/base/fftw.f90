!> FFTW's own interface for Fortran (www.fftw.org, version 3.3), and what the code needs of it on real arrays in three dimensions.
module fftw
  use, intrinsic :: iso_c_binding
  use kinds, only: wp
  implicit none
  private
  public :: transform, transform_back, smooth_size

  include 'fftw3.f03'

contains

  !> spectrum = sum a exp(-i k x), not scaled; spectrum(n1/2 + 1, n2, n3) for a(n1, n2, n3). a is left undefined.
  subroutine transform(a, spectrum)
    real(wp), intent(inout), contiguous :: a(:, :, :)
    complex(wp), intent(inout), contiguous :: spectrum(:, :, :)
    type(c_ptr) :: plan
    ! an estimated plan that asks for no alignment is the same on every rank, and so are the bits
    plan = fftw_plan_dft_r2c_3d(size(a, 3), size(a, 2), size(a, 1), a, spectrum, ior(fftw_estimate, fftw_unaligned))
    call fftw_execute_dft_r2c(plan, a, spectrum)
    call fftw_destroy_plan(plan)
  end subroutine transform

  !> a = sum spectrum exp(i k x), not scaled. spectrum is left undefined.
  subroutine transform_back(spectrum, a)
    complex(wp), intent(inout), contiguous :: spectrum(:, :, :)
    real(wp), intent(inout), contiguous :: a(:, :, :)
    type(c_ptr) :: plan
    plan = fftw_plan_dft_c2r_3d(size(a, 3), size(a, 2), size(a, 1), spectrum, a, ior(fftw_estimate, fftw_unaligned))
    call fftw_execute_dft_c2r(plan, spectrum, a)
    call fftw_destroy_plan(plan)
  end subroutine transform_back

  !> The smallest even number from n on whose only prime factors are 2, 3 and 5: sizes that transform fast.
  pure integer function smooth_size(n) result(even)
    integer, intent(in) :: n
    integer :: rest, factor
    even = n + mod(n, 2)
    do
      rest = even
      do factor = 2, 5
        do while (mod(rest, factor) == 0)
          rest = rest/factor
        end do
      end do
      if (rest == 1) return
      even = even + 2
    end do
  end function smooth_size

end module fftw
