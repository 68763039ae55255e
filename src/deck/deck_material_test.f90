!> &material_test (repeated): one segment of the path of one material point; groups of the same name follow each other.
module deck_material_test
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length, of_pressure, of_rate
  implicit none
  private
  public :: material_test_keys

  character(word_length), parameter, public :: path_names(6) = [character(word_length) :: 'uniaxial_strain', 'uniaxial_stress', &
    'triaxial', 'hydrostatic', 'shear', 'gradient']

  type, public :: material_test_group
    character(word_length) :: name = ''
    character(word_length) :: material = '' !< '': that of the first segment of this name
    character(word_length) :: path = ''
    real(wp) :: strain = unset !< of this segment, extension positive
    real(wp) :: strain_rate = unset
    integer :: steps = 1000
    real(wp) :: pressure = unset !< ends a hydrostatic segment
    real(wp) :: gradient(9) = 0 !< velocity gradient over strain_rate, row by row
    real(wp) :: length = unset !< size of the cell; set by the checks
    integer :: line = 0
  end type material_test_group

contains

  subroutine material_test_keys(group, table)
    type(material_test_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('material_test', group%line)
    call table%add('name', group%name, required=.true.)
    call table%add('material', group%material)
    call table%add('path', group%path, path_names, required=.true.)
    call table%add('strain', group%strain, required=.true.)
    call table%add('strain_rate', group%strain_rate, of_rate, more_than=0.0_wp, usual=[1e-6_wp, 1e8_wp], required=.true.)
    call table%add('steps', group%steps, at_least=1)
    call table%add('pressure', group%pressure, of_pressure)
    call table%add('gradient', group%gradient)
    call table%add('length', group%length, of_length, more_than=0.0_wp, usual=[1e-6_wp, 10.0_wp])
  end subroutine material_test_keys

end module deck_material_test
