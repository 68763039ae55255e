!> &charge (repeated): an explosive of given mass; its size follows from the material's density.
module deck_charge
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length, path_length
  use units, only: of_length, of_mass, of_velocity
  implicit none
  private
  public :: charge_keys

  type, public :: charge_group
    character(word_length) :: explosive = '' !< a material with eos 'jwl'
    real(wp) :: mass = unset !< of the whole charge: symmetry planes cut it
    character(word_length) :: shape = 'sphere' !< 'sphere', 'cylinder', 'box'
    real(wp) :: center(3) = unset
    real(wp) :: axis(3) = [0.0_wp, 0.0_wp, 1.0_wp] !< of the cylinder
    real(wp) :: length_to_diameter = 1 !< of the cylinder
    real(wp) :: proportions(3) = 1 !< edges of the box, up to a factor
    character(word_length) :: detonation = 'instantaneous' !< 'instantaneous', 'programmed'
    real(wp) :: detonation_speed = unset !< of a programmed one; unset: that of Chapman and Jouguet
    character(word_length) :: start = 'none' !< 'spherical', 'cylindrical', 'axisymmetric': geometry of a first run on a fine mesh
    character(word_length) :: start_axis = '' !< 'x', 'y', 'z': of an axisymmetric one; empty: the charge's own, or z
    integer :: start_cells = 0 !< of that mesh in the radius of the charge, 0: chosen
    real(wp) :: start_stop = unset !< distance at which that run stops; unset: as far as nothing is in the way
    character(path_length) :: start_file = '' !< what that run is kept in
    integer :: line = 0
  contains
    procedure :: is_mapped
  end type charge_group

contains

  !> True if the charge enters the scene as a blast that has been computed before.
  elemental logical function is_mapped(self)
    class(charge_group), intent(in) :: self
    is_mapped = self%start /= 'none'
  end function is_mapped

  subroutine charge_keys(group, table)
    type(charge_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('charge', group%line)
    call table%add('explosive', group%explosive, required=.true.)
    call table%add('mass', group%mass, of_mass, more_than=0.0_wp, usual=[1e-9_wp, 1e8_wp], required=.true.)
    call table%add('shape', group%shape, [character(word_length) :: 'sphere', 'cylinder', 'box'])
    call table%add('center', group%center, of_length, required=.true.)
    call table%add('axis', group%axis)
    call table%add('length_to_diameter', group%length_to_diameter, more_than=0.0_wp)
    call table%add('proportions', group%proportions, more_than=0.0_wp)
    call table%add('detonation', group%detonation, [character(word_length) :: 'instantaneous', 'programmed'])
    call table%add('detonation_speed', group%detonation_speed, of_velocity, more_than=0.0_wp, usual=[500.0_wp, 2e4_wp])
    call table%add('start', group%start, [character(word_length) :: 'none', 'spherical', 'cylindrical', 'axisymmetric'])
    call table%add('start_axis', group%start_axis, [character(word_length) :: '', 'x', 'y', 'z'])
    call table%add('start_cells', group%start_cells, at_least=0)
    call table%add('start_stop', group%start_stop, of_length, more_than=0.0_wp)
    call table%add('start_file', group%start_file)
  end subroutine charge_keys

end module deck_charge
