!> &body and &hole (repeated): shapes filled with particles, and shapes cut out of them.
module deck_body
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length, of_pressure, of_rate, of_velocity
  implicit none
  private
  public :: body_keys, hole_keys

  character(word_length), parameter :: directions(8) = [character(word_length) :: '', 'x', 'y', 'z', 'xy', 'xz', 'yz', 'xyz']
  character(word_length), parameter :: shapes(4) = [character(word_length) :: 'box', 'sphere', 'cylinder', 'ogive']

  !> Bodies of the same name are one body: their union.
  type, public :: body_group
    character(word_length) :: name = ''
    character(word_length) :: material = ''
    character(word_length) :: shape = ''
    real(wp) :: lower(3) = unset, upper(3) = unset !< box
    real(wp) :: center(3) = unset !< sphere
    real(wp) :: radius = unset !< sphere, cylinder, ogive
    real(wp) :: start(3) = unset, end(3) = unset !< axis of the cylinder; base and tip of the ogive
    real(wp) :: caliber_radius_head = 3 !< of the ogive
    real(wp) :: spacing = unset !< of the particles
    real(wp) :: velocity(3) = 0 !< at the origin of the coordinates
    real(wp) :: velocity_gradient(3) = 0 !< the velocity in x, y, z grows by this per length in x, y, z
    real(wp) :: pressure = unset !< of a fluid at the start
    ! rigid bodies
    character(word_length) :: fixed = '' !< directions in which the centre does not move
    character(word_length) :: fixed_rotation = '' !< axes about which the body does not turn
    real(wp) :: angular_velocity(3) = 0 !< about the centre of mass, at the start
    integer :: line = 0
    integer :: first = 0 !< place of the first body of this name in the deck, and
    integer :: number = 0 !< how manieth name that is; both set by the checks
  end type body_group

  type, public :: hole_group
    character(word_length) :: body = '' !< name of the body that it is cut out of
    character(word_length) :: shape = ''
    real(wp) :: lower(3) = unset, upper(3) = unset !< box
    real(wp) :: center(3) = unset !< sphere
    real(wp) :: radius = unset !< sphere, cylinder, ogive
    real(wp) :: start(3) = unset, end(3) = unset !< axis of the cylinder; base and tip of the ogive
    real(wp) :: caliber_radius_head = 3 !< of the ogive
    integer :: line = 0
  end type hole_group

contains

  subroutine body_keys(group, table)
    type(body_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('body', group%line)
    call table%add('name', group%name, required=.true.)
    call table%add('material', group%material, required=.true.)
    call table%add('shape', group%shape, shapes, required=.true.)
    call table%add('lower', group%lower, of_length)
    call table%add('upper', group%upper, of_length)
    call table%add('center', group%center, of_length)
    call table%add('radius', group%radius, of_length, more_than=0.0_wp)
    call table%add('start', group%start, of_length)
    call table%add('end', group%end, of_length)
    call table%add('caliber_radius_head', group%caliber_radius_head, at_least=0.5_wp)
    call table%add('spacing', group%spacing, of_length, more_than=0.0_wp, required=.true.)
    call table%add('velocity', group%velocity, of_velocity, usual=[-1e5_wp, 1e5_wp])
    call table%add('velocity_gradient', group%velocity_gradient, of_rate)
    call table%add('pressure', group%pressure, of_pressure)
    call table%add('fixed', group%fixed, directions)
    call table%add('fixed_rotation', group%fixed_rotation, directions)
    call table%add('angular_velocity', group%angular_velocity, of_rate)
  end subroutine body_keys

  subroutine hole_keys(group, table)
    type(hole_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('hole', group%line)
    call table%add('body', group%body, required=.true.)
    call table%add('shape', group%shape, shapes, required=.true.)
    call table%add('lower', group%lower, of_length)
    call table%add('upper', group%upper, of_length)
    call table%add('center', group%center, of_length)
    call table%add('radius', group%radius, of_length, more_than=0.0_wp)
    call table%add('start', group%start, of_length)
    call table%add('end', group%end, of_length)
    call table%add('caliber_radius_head', group%caliber_radius_head, at_least=0.5_wp)
  end subroutine hole_keys

end module deck_body
