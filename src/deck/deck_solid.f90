!> &solid: the numerics of the material point method.
module deck_solid
  use kinds, only: wp
  use deck_keys, only: key_table, word_length
  use units, only: of_acceleration
  implicit none
  private
  public :: solid_keys

  type, public :: solid_group
    character(word_length) :: scheme = 'musl' !< when the stress is updated
    character(word_length) :: shape = 'quadratic' !< functions of the nodes
    character(word_length) :: transfer = 'flip' !< of velocities to and from the nodes
    real(wp) :: cfl = 0.5_wp
    real(wp) :: gravity(3) = 0
    real(wp) :: flip = 1 !< part of FLIP in the velocity update, the rest is PIC
    logical :: bulk_viscosity = .true.
    integer :: line = 0
  end type solid_group

contains

  subroutine solid_keys(group, table)
    type(solid_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('solid', group%line)
    call table%add('scheme', group%scheme, [character(word_length) :: 'musl', 'usl', 'usf'])
    call table%add('shape', group%shape, [character(word_length) :: 'linear', 'quadratic'])
    call table%add('transfer', group%transfer, [character(word_length) :: 'flip', 'apic'])
    call table%add('cfl', group%cfl, more_than=0.0_wp, at_most=1.0_wp)
    call table%add('gravity', group%gravity, of_acceleration, usual=[-1e4_wp, 1e4_wp])
    call table%add('flip', group%flip, at_least=0.0_wp, at_most=1.0_wp)
    call table%add('bulk_viscosity', group%bulk_viscosity)
  end subroutine solid_keys

end module deck_solid
