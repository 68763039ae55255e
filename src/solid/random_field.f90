!> A homogeneous random field of mean 1 that is positive everywhere, on a box: a factor on the strength of a material, say.
!>
!> A standard normal field z is made on a regular grid by circulant embedding (Dietrich & Newsam 1997): white noise, filtered with
!> the root of the spectrum of the correlation on a periodic box that is larger than the asked one by `padding` correlation
!> lengths. Between grid points z is interpolated linearly and divided by the standard deviation that this leaves, so every
!> point has variance 1 and the distribution of the factor, a function of z alone, holds exactly. The grid follows from the box
!> and the correlation lengths, never from mesh or ranks.
module random_field
  use errors, only: fatal, exit_bad_input
  use fftw, only: transform, transform_back, smooth_size
  use kinds, only: wp, i8
  use random_numbers, only: normal_pair
  use text, only: str
  implicit none
  private
  public :: make_random_field, weibull_shape, correlation_of

  integer, parameter, public :: correlation_gaussian = 1, correlation_exponential = 2
  integer, parameter, public :: distribution_lognormal = 1, distribution_weibull = 2
  integer, parameter, public :: points_per_length = 4 !< grid points in a correlation length
  integer, parameter :: padding = 6 !< correlation lengths between the box and its periodic image
  real(wp), parameter :: most_points = 2.0e8_wp !< of the grid, 3 GB of memory

  type, public :: random_field_type
    integer :: correlation = correlation_gaussian
    integer :: distribution = distribution_lognormal
    real(wp) :: coefficient = 0 !< standard deviation of the factor over its mean
    real(wp) :: length(3) = 1 !< distance at which the correlation is 1/e
    real(wp) :: origin(3) = 0 !< first point of the grid
    real(wp) :: spacing(3) = 1 !< of the grid
    real(wp) :: width = 0 !< standard deviation of the factor's logarithm, or shape of Weibull
    real(wp) :: corner(8, 8) = 1 !< correlation between the corners of a grid cell, x fastest
    real(wp), allocatable :: z(:, :, :) !< standard normal values on the grid
  contains
    procedure :: normal_at
    procedure :: factor_at
  end type random_field_type

contains

  !> The field on a box. length: correlation lengths; an inactive direction has none. The same bits for the same arguments.
  function make_random_field(lower, upper, active, length, correlation, distribution, coefficient, seed) result(field)
    real(wp), intent(in) :: lower(3), upper(3), length(3), coefficient
    logical, intent(in) :: active(3)
    integer, intent(in) :: correlation, distribution, seed
    type(random_field_type) :: field
    real(wp) :: points
    integer :: n(3), d
    field%correlation = correlation
    field%distribution = distribution
    field%coefficient = coefficient
    field%length = length
    field%spacing = merge(length/points_per_length, 1.0_wp, active)
    field%origin = merge(lower, 0.0_wp, active)
    points = product(merge((upper - lower)/field%spacing + padding*points_per_length, 1.0_wp, active))
    if (points > most_points) call fatal('heterogeneity: '//str(points, 3)//' points would be needed for a field over '// &
      str(maxval(upper - lower, active))//' with a correlation length of '//str(minval(length, active))// &
      '; give a larger correlation_length', exit_bad_input)
    n = 1
    do d = 1, 3
      if (active(d)) n(d) = smooth_size(ceiling((upper(d) - lower(d))/field%spacing(d)) + padding*points_per_length)
    end do
    if (distribution == distribution_lognormal) field%width = sqrt(log(1 + coefficient**2))
    if (distribution == distribution_weibull) field%width = weibull_shape(coefficient)
    allocate (field%z(n(1), n(2), n(3)))
    call correlate_corners(field, active)
    call fill_grid(field, seed)
  end function make_random_field

  !> Correlation at a distance d (in correlation lengths).
  elemental real(wp) function correlation_of(kind, distance) result(c)
    integer, intent(in) :: kind
    real(wp), intent(in) :: distance
    if (kind == correlation_gaussian) then
      c = exp(-min(distance**2, 700.0_wp))
    else
      c = exp(-min(distance, 700.0_wp))
    end if
  end function correlation_of

  subroutine correlate_corners(field, active)
    type(random_field_type), intent(inout) :: field
    logical, intent(in) :: active(3)
    integer :: i, j, d
    real(wp) :: offset(3)
    do j = 1, 8
      do i = 1, 8
        offset = [(ibits(i - 1, d, 1) - ibits(j - 1, d, 1), d=0, 2)]
        where (.not. active) offset = 0
        field%corner(i, j) = correlation_of(field%correlation, norm2(offset)/points_per_length)
      end do
    end do
  end subroutine correlate_corners

  !> White noise with the spectrum of the correlation, of mean square 1.
  subroutine fill_grid(field, seed)
    type(random_field_type), intent(inout) :: field
    integer, intent(in) :: seed
    complex(wp), allocatable :: spectrum(:, :, :)
    real(wp), allocatable :: root(:, :, :)
    real(wp) :: total
    integer :: n(3), i, j, k
    n = shape(field%z)
    allocate (spectrum(n(1)/2 + 1, n(2), n(3)), root(n(1)/2 + 1, n(2), n(3)))
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          field%z(i, j, k) = correlation_of(field%correlation, norm2(real(wrapped([i, j, k] - 1, n), wp))/points_per_length)
        end do
      end do
    end do
    call transform(field%z, spectrum)
    ! what is negative of the spectrum (little, by the padding) is left out and the rest brought to a mean square of 1
    root = max(real(spectrum), 0.0_wp)
    total = 2*sum(root) - sum(root(1, :, :))
    if (mod(n(1), 2) == 0) total = total - sum(root(n(1)/2 + 1, :, :))
    if (n(1) == 1) total = sum(root)
    root = sqrt(root/(total*product(real(n, wp))))
    call fill_with_noise(field%z, seed)
    call transform(field%z, spectrum)
    spectrum = spectrum*root
    call transform_back(spectrum, field%z)
  end subroutine fill_grid

  !> Offset to the nearest periodic image.
  elemental integer function wrapped(offset, n)
    integer, intent(in) :: offset, n
    wrapped = min(offset, n - offset)
  end function wrapped

  subroutine fill_with_noise(z, seed)
    real(wp), intent(out) :: z(:, :, :)
    integer, intent(in) :: seed
    integer :: i, j, k
    real(wp) :: pair(2)
    do k = 1, size(z, 3)
      do j = 1, size(z, 2)
        do i = 1, size(z, 1), 2
          pair = normal_pair([int(i, i8), int(j, i8), int(k, i8), 0_i8], [int(seed, i8), 0_i8])
          z(i, j, k) = pair(1)
          if (i < size(z, 1)) z(i + 1, j, k) = pair(2)
        end do
      end do
    end do
  end subroutine fill_with_noise

  !> The standard normal field at a point; one outside of the box takes the value of the nearest point of it and its padding.
  pure real(wp) function normal_at(self, x) result(z)
    class(random_field_type), intent(in) :: self
    real(wp), intent(in) :: x(3)
    real(wp) :: w(8), place, part(3)
    integer :: low(3), high(3), d, i, at(3)
    do d = 1, 3
      place = min(max((x(d) - self%origin(d))/self%spacing(d), 0.0_wp), real(size(self%z, d) - 1, wp))
      low(d) = min(int(place) + 1, max(size(self%z, d) - 1, 1))
      high(d) = min(low(d) + 1, size(self%z, d))
      part(d) = min(place - (low(d) - 1), 1.0_wp)
      if (size(self%z, d) == 1) part(d) = 0
    end do
    z = 0
    do i = 1, 8
      w(i) = 1
      do d = 1, 3
        if (btest(i - 1, d - 1)) then
          w(i) = w(i)*part(d)
          at(d) = high(d)
        else
          w(i) = w(i)*(1 - part(d))
          at(d) = low(d)
        end if
      end do
      z = z + w(i)*self%z(at(1), at(2), at(3))
    end do
    z = z/sqrt(dot_product(w, matmul(self%corner, w)))
  end function normal_at

  !> The factor at a point: positive, of mean 1 and the asked coefficient of variation.
  pure real(wp) function factor_at(self, x) result(factor)
    class(random_field_type), intent(in) :: self
    real(wp), intent(in) :: x(3)
    real(wp) :: z, survival
    z = self%normal_at(x)
    if (self%distribution == distribution_lognormal) then
      factor = exp(self%width*z - 0.5_wp*self%width**2)
      return
    end if
    if (z > -5) then
      survival = -log(0.5_wp*erfc(z/sqrt(2.0_wp)))
    else
      survival = 0.5_wp*erfc(-z/sqrt(2.0_wp)) ! -log(1 - x) = x for small x
    end if
    factor = survival**(1/self%width)/gamma(1 + 1/self%width)
  end function factor_at

  !> Shape k of Weibull's distribution, P(x < a) = 1 - exp(-(a/scale)**k), from its coefficient of variation.
  pure real(wp) function weibull_shape(coefficient) result(k)
    real(wp), intent(in) :: coefficient
    real(wp) :: low, high
    integer :: i
    low = 0.1_wp
    high = 1.0e5_wp
    do i = 1, 200
      k = sqrt(low*high)
      if (exp(log_gamma(1 + 2/k) - 2*log_gamma(1 + 1/k)) - 1 > coefficient**2) then
        low = k
      else
        high = k
      end if
    end do
  end function weibull_shape

end module random_field
