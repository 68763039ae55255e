!> The choices of &solid that the problems of the solid are run with.
module solid_numerics
  use deck_types, only: deck_type
  use kinds, only: wp
  implicit none
  private
  public :: choose_numerics, numerics_name, all_numerics

  type, public :: numerics_type
    character(16) :: shape = 'linear' !< functions of the nodes
    character(16) :: transfer = 'flip' !< of velocities
    character(16) :: scheme = 'musl' !< when the stress is updated
    real(wp) :: flip = 1 !< part of FLIP, the rest is PIC
  end type numerics_type

contains

  !> Writes the choices into a deck.
  subroutine choose_numerics(deck, numerics)
    type(deck_type), intent(inout) :: deck
    type(numerics_type), intent(in) :: numerics
    deck%solid%shape = numerics%shape
    deck%solid%transfer = numerics%transfer
    deck%solid%scheme = numerics%scheme
    deck%solid%flip = numerics%flip
  end subroutine choose_numerics

  !> 'linear flip musl', and the part of FLIP if it is not 1.
  function numerics_name(numerics) result(name)
    type(numerics_type), intent(in) :: numerics
    character(:), allocatable :: name
    character(8) :: part
    name = trim(numerics%shape)//' '//trim(numerics%transfer)//' '//trim(numerics%scheme)
    if (numerics%flip < 1) then
      write (part, '(f4.2)') numerics%flip
      name = name//' '//trim(part)
    end if
  end function numerics_name

  !> Everything that the code offers.
  function all_numerics() result(list)
    type(numerics_type), allocatable :: list(:)
    character(16), parameter :: shape(2) = [character(16) :: 'linear', 'quadratic']
    character(16), parameter :: transfer(2) = [character(16) :: 'flip', 'apic'], scheme(3) = [character(16) :: 'musl', 'usl', 'usf']
    integer :: i, j, k
    list = [(((numerics_type(shape(i), transfer(j), scheme(k)), k=1, 3), j=1, 2), i=1, 2)]
  end function all_numerics

end module solid_numerics
