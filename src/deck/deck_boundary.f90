!> &boundary: what happens on the six faces of the domain, to the flow and to the solid.
module deck_boundary
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_density, of_pressure, of_velocity
  implicit none
  private
  public :: boundary_keys

  character(word_length), parameter :: flow_faces(5) = &
    [character(word_length) :: 'symmetry', 'outflow', 'ambient', 'inflow', 'periodic']
  character(word_length), parameter :: solid_faces(4) = &
    [character(word_length) :: '', 'free', 'symmetry', 'clamped']

  !> The solid's faces are never empty after the checks: symmetry where the flow has symmetry, else free.
  type, public :: boundary_group
    character(word_length) :: x_low = 'outflow', x_high = 'outflow'
    character(word_length) :: y_low = 'outflow', y_high = 'outflow'
    character(word_length) :: z_low = 'outflow', z_high = 'outflow'
    character(word_length) :: solid_x_low = '', solid_x_high = ''
    character(word_length) :: solid_y_low = '', solid_y_high = ''
    character(word_length) :: solid_z_low = '', solid_z_high = ''
    character(word_length) :: inflow_material = ''
    real(wp) :: inflow_density = unset
    real(wp) :: inflow_pressure = unset
    real(wp) :: inflow_velocity(3) = unset
    integer :: line = 0
  contains
    procedure :: flow_face
    procedure :: solid_face
  end type boundary_group

contains

  !> What the flow does on a face: direction 1..3, side 1 (low) or 2 (high).
  pure function flow_face(self, direction, side) result(kind)
    class(boundary_group), intent(in) :: self
    integer, intent(in) :: direction, side
    character(word_length) :: kind, faces(2, 3)
    faces = reshape([self%x_low, self%x_high, self%y_low, self%y_high, self%z_low, self%z_high], [2, 3])
    kind = faces(side, direction)
  end function flow_face

  !> What the solid does on a face: direction 1..3, side 1 (low) or 2 (high).
  pure function solid_face(self, direction, side) result(kind)
    class(boundary_group), intent(in) :: self
    integer, intent(in) :: direction, side
    character(word_length) :: kind, faces(2, 3)
    faces = reshape([self%solid_x_low, self%solid_x_high, self%solid_y_low, self%solid_y_high, &
      self%solid_z_low, self%solid_z_high], [2, 3])
    kind = faces(side, direction)
  end function solid_face

  subroutine boundary_keys(group, table)
    type(boundary_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('boundary', group%line)
    call table%add('x_low', group%x_low, flow_faces)
    call table%add('x_high', group%x_high, flow_faces)
    call table%add('y_low', group%y_low, flow_faces)
    call table%add('y_high', group%y_high, flow_faces)
    call table%add('z_low', group%z_low, flow_faces)
    call table%add('z_high', group%z_high, flow_faces)
    call table%add('solid_x_low', group%solid_x_low, solid_faces)
    call table%add('solid_x_high', group%solid_x_high, solid_faces)
    call table%add('solid_y_low', group%solid_y_low, solid_faces)
    call table%add('solid_y_high', group%solid_y_high, solid_faces)
    call table%add('solid_z_low', group%solid_z_low, solid_faces)
    call table%add('solid_z_high', group%solid_z_high, solid_faces)
    call table%add('inflow_material', group%inflow_material)
    call table%add('inflow_density', group%inflow_density, of_density, more_than=0.0_wp, usual=[1e-4_wp, 2.5e4_wp])
    call table%add('inflow_pressure', group%inflow_pressure, of_pressure, usual=[-1e10_wp, 1e12_wp])
    call table%add('inflow_velocity', group%inflow_velocity, of_velocity, usual=[-1e5_wp, 1e5_wp])
  end subroutine boundary_keys

end module deck_boundary
