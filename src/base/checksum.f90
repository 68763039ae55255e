!> A fingerprint of numbers, bit for bit: equal fingerprints mean equal states (FNV-1a over 64-bit words).
module checksum
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: wp, i8
  implicit none
  private
  public :: mix_reals, mix_integer, hexadecimal

  integer(i8), parameter, public :: empty_checksum = -3750763034362895579_i8 !< what a fingerprint starts from

  integer(i8), parameter :: low_prime = 435_i8 !< FNV prime 2**40 + 435, multiplied in two parts to stay inside 64 bits

contains

  !> The fingerprint with these numbers mixed in.
  pure integer(i8) function mix_reals(fingerprint, values) result(mixed)
    integer(i8), intent(in) :: fingerprint
    real(wp), intent(in) :: values(:)
    integer :: i
    mixed = fingerprint
    do i = 1, size(values)
      mixed = times_prime(ieor(mixed, transfer(values(i), 0_int64)))
    end do
  end function mix_reals

  !> The fingerprint with an integer mixed in.
  pure integer(i8) function mix_integer(fingerprint, value) result(mixed)
    integer(i8), intent(in) :: fingerprint
    integer(i8), intent(in) :: value
    mixed = times_prime(ieor(fingerprint, value))
  end function mix_integer

  !> value * (2**40 + 435) modulo 2**64, by additions and shifts that cannot overflow a signed integer.
  pure integer(i8) function times_prime(value) result(product)
    integer(i8), intent(in) :: value
    integer :: bit
    product = ishft(value, 40)
    do bit = 0, 8
      if (btest(low_prime, bit)) product = sum_modulo(product, ishft(value, bit))
    end do
    ! upper bits reach the lower ones too, which a product alone does not do
    product = ieor(product, ishft(product, -29))
  end function times_prime

  !> a + b modulo 2**64.
  pure integer(i8) function sum_modulo(a, b) result(total)
    integer(i8), intent(in) :: a, b
    integer(i8) :: low, high
    integer(i8), parameter :: mask = 4294967295_i8
    low = iand(a, mask) + iand(b, mask)
    high = ishft(a, -32) + ishft(b, -32) + ishft(low, -32)
    total = ior(iand(low, mask), ishft(iand(high, mask), 32))
  end function sum_modulo

  !> The fingerprint as 16 hexadecimal digits.
  pure function hexadecimal(fingerprint) result(digits)
    integer(i8), intent(in) :: fingerprint
    character(16) :: digits
    write (digits, '(z16.16)') fingerprint
  end function hexadecimal

end module checksum
