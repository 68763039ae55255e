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
    real(wp) :: cfl = 0.5_wp
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
    deck%solid%cfl = numerics%cfl
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

  !> Everything that the code offers: APIC needs the quadratic shape. stable: without what the literature calls unstable and
  !> what long runs show to be so, which is USL with the linear shape.
  function all_numerics(stable) result(list)
    logical, intent(in), optional :: stable
    type(numerics_type), allocatable :: list(:)
    list = [numerics_type('linear', 'flip', 'musl'), numerics_type('linear', 'flip', 'usf'), &
      numerics_type('quadratic', 'flip', 'musl'), numerics_type('quadratic', 'flip', 'usl'), &
      numerics_type('quadratic', 'flip', 'usf'), numerics_type('quadratic', 'apic', 'musl'), &
      numerics_type('quadratic', 'apic', 'usl'), numerics_type('quadratic', 'apic', 'usf')]
    if (present(stable)) then
      if (stable) return
    end if
    list = [list, numerics_type('linear', 'flip', 'usl')]
  end function all_numerics

end module solid_numerics
