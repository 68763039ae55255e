!> Random numbers by counting: each number follows from its place and a key alone, in any order, with any compiler.
!>
!> Philox 4x32-10 of Salmon, Moraes, Dror & Shaw (2011), "Parallel random numbers: as easy as 1, 2, 3".
module random_numbers
  use constants, only: pi
  use kinds, only: wp, i8
  implicit none
  private
  public :: philox, normal_pair

  integer(i8), parameter :: mask = 4294967295_i8 !< 32 bits
  integer(i8), parameter :: multiplier(2) = [3528531795_i8, 3449720151_i8]
  integer(i8), parameter :: bump(2) = [2654435769_i8, 3144134277_i8]
  integer, parameter :: n_rounds = 10

contains

  !> Four words of 32 random bits. counter, key: words of 32 bits, from 0 to 2**32 - 1.
  pure function philox(counter, key) result(word)
    integer(i8), intent(in) :: counter(4), key(2)
    integer(i8) :: word(4), round_key(2), high(2), low(2)
    integer :: round
    word = counter
    round_key = key
    do round = 1, n_rounds
      call multiply(multiplier(1), word(1), high(1), low(1))
      call multiply(multiplier(2), word(3), high(2), low(2))
      word = [ieor(ieor(high(2), word(2)), round_key(1)), low(2), ieor(ieor(high(1), word(4)), round_key(2)), low(1)]
      round_key = iand(round_key + bump, mask)
    end do
  end function philox

  !> The upper and lower 32 bits of a product of two words; in halves, so that no integer overflows.
  pure subroutine multiply(a, b, high, low)
    integer(i8), intent(in) :: a, b
    integer(i8), intent(out) :: high, low
    integer(i8) :: upper, lower
    lower = a*iand(b, 65535_i8)
    upper = a*ishft(b, -16) + ishft(lower, -16)
    high = ishft(upper, -16)
    low = ior(ishft(iand(upper, 65535_i8), 16), iand(lower, 65535_i8))
  end subroutine multiply

  !> Two independent numbers of the standard normal distribution (Box & Muller 1958).
  pure function normal_pair(counter, key) result(pair)
    integer(i8), intent(in) :: counter(4), key(2)
    real(wp) :: pair(2), uniform(2), radius
    integer(i8) :: word(4)
    word = philox(counter, key)
    ! 52 bits each and half a step, so never 0 or 1
    uniform = (ior(ishft(word([1, 3]), 20), ishft(word([2, 4]), -12)) + 0.5_wp)*2.0_wp**(-52)
    radius = sqrt(-2*log(uniform(1)))
    pair = radius*[cos(2*pi*uniform(2)), sin(2*pi*uniform(2))]
  end function normal_pair

end module random_numbers
