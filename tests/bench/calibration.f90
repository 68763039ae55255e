!> How fast this machine is at this moment, in two figures, so that timings of two machines or two days compare: memory bandwidth
!> (stream triad, McCalpin 1995) and multiply-adds in registers. Of one core; the best of several short windows.
!> This file is compiled with contraction to fused multiply-adds, unlike the rest of the program.
module calibration
  use kinds, only: wp, i8
  implicit none
  private
  public :: calibrate

  type, public :: calibration_type
    real(wp) :: triad = 0 !< GB/s, counting two loads and a store
    real(wp) :: multiply_add = 0 !< GFLOP/s, counting two for each
  end type calibration_type

  integer, parameter :: length = 4000000 !< of the three arrays of the triad: far more than the caches hold
  integer, parameter :: lanes = 8, chains = 12 !< multiply-adds that do not wait for each other
  integer, parameter :: rounds = 200000, windows = 8

contains

  function calibrate() result(figures)
    type(calibration_type) :: figures
    real(wp), allocatable :: a(:), b(:), c(:)
    real(wp) :: x(lanes, chains), seconds
    integer :: i
    allocate (a(length), b(length), c(length))
    a = 0
    b = 1
    c = 2
    x = 1
    do i = 1, windows
      seconds = clock()
      call triad(length, 0.5_wp, a, b, c)
      seconds = clock() - seconds
      figures%triad = max(figures%triad, 24e-9_wp*length/seconds)
      seconds = clock()
      call multiply_add(0.999_wp, 1e-3_wp, x)
      seconds = clock() - seconds
      figures%multiply_add = max(figures%multiply_add, 2e-9_wp*size(x)*rounds/seconds)
    end do
    if (a(1) + sum(x) < 0) figures%triad = 0 ! never: keeps the loops
  end function calibrate

  real(wp) function clock()
    integer(i8) :: now, rate
    call system_clock(now, rate)
    clock = real(now, wp)/real(rate, wp)
  end function clock

  subroutine triad(n, s, a, b, c)
    integer, intent(in) :: n
    real(wp), intent(in) :: s, b(n), c(n)
    real(wp), intent(inout) :: a(n)
    integer :: i
    do i = 1, n
      a(i) = b(i) + s*c(i)
    end do
  end subroutine triad

  !> Every chain is an array by itself, so that all stay in registers.
  subroutine multiply_add(s, t, x)
    real(wp), intent(in) :: s, t
    real(wp), intent(inout) :: x(lanes, chains)
    real(wp), dimension(lanes) :: a, b, c, d, e, f, g, h, o, p, q, r
    integer :: i, l
    a = x(:, 1); b = x(:, 2); c = x(:, 3); d = x(:, 4); e = x(:, 5); f = x(:, 6)
    g = x(:, 7); h = x(:, 8); o = x(:, 9); p = x(:, 10); q = x(:, 11); r = x(:, 12)
    do i = 1, rounds
      !$omp simd
      do l = 1, lanes
        a(l) = a(l)*s + t; b(l) = b(l)*s + t; c(l) = c(l)*s + t; d(l) = d(l)*s + t
        e(l) = e(l)*s + t; f(l) = f(l)*s + t; g(l) = g(l)*s + t; h(l) = h(l)*s + t
        o(l) = o(l)*s + t; p(l) = p(l)*s + t; q(l) = q(l)*s + t; r(l) = r(l)*s + t
      end do
    end do
    x(:, 1) = a; x(:, 2) = b; x(:, 3) = c; x(:, 4) = d; x(:, 5) = e; x(:, 6) = f
    x(:, 7) = g; x(:, 8) = h; x(:, 9) = o; x(:, 10) = p; x(:, 11) = q; x(:, 12) = r
  end subroutine multiply_add

end module calibration
