!> &region (repeated): the flow at the start, a later region over an earlier one.
module deck_region
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_density, of_length, of_pressure, of_velocity
  implicit none
  private
  public :: region_keys

  type, public :: region_group
    character(word_length) :: shape = '' !< 'all', 'box', 'sphere', 'cylinder', 'half_space'
    character(word_length) :: material = ''
    real(wp) :: density = unset !< default: of the material
    real(wp) :: pressure = unset
    real(wp) :: velocity(3) = 0
    real(wp) :: lower(3) = unset, upper(3) = unset !< box
    real(wp) :: center(3) = unset !< sphere
    real(wp) :: radius = unset !< sphere, cylinder
    real(wp) :: start(3) = unset, end(3) = unset !< axis of the cylinder
    real(wp) :: point(3) = unset, normal(3) = unset !< half space: filled where (x - point).normal < 0
    integer :: line = 0
  end type region_group

contains

  subroutine region_keys(group, table)
    type(region_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('region', group%line)
    call table%add('shape', group%shape, [character(word_length) :: 'all', 'box', 'sphere', 'cylinder', 'half_space'], &
      required=.true.)
    call table%add('material', group%material, required=.true.)
    call table%add('density', group%density, of_density, more_than=0.0_wp, usual=[1e-4_wp, 2.5e4_wp])
    call table%add('pressure', group%pressure, of_pressure, usual=[-1e10_wp, 1e12_wp], required=.true.)
    call table%add('velocity', group%velocity, of_velocity, usual=[-1e5_wp, 1e5_wp])
    call table%add('lower', group%lower, of_length)
    call table%add('upper', group%upper, of_length)
    call table%add('center', group%center, of_length)
    call table%add('radius', group%radius, of_length, more_than=0.0_wp)
    call table%add('start', group%start, of_length)
    call table%add('end', group%end, of_length)
    call table%add('point', group%point, of_length)
    call table%add('normal', group%normal)
  end subroutine region_keys

end module deck_region
