!> &mesh: the box of cells and the bricks that it is cut into.
module deck_mesh
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_length
  implicit none
  private
  public :: mesh_keys

  character(word_length), parameter, public :: geometry_words(0:2) = &
    [character(word_length) :: 'cartesian', 'cylindrical', 'spherical'] !< by the power of x in the area of its faces

  type, public :: mesh_group
    character(word_length) :: geometry = 'cartesian' !< in the others x is the distance from the axis or centre
    integer :: cells(3) = 1 !< 1: the dimension is not computed
    real(wp) :: lower(3) = 0
    real(wp) :: upper(3) = unset
    integer :: brick(3) = 0 !< cells of a brick, 0: chosen
    integer :: line = 0
  contains
    procedure :: active
    procedure :: radial_power
    procedure :: cell_size
  end type mesh_group

contains

  !> Which dimensions are computed.
  pure function active(self)
    class(mesh_group), intent(in) :: self
    logical :: active(3)
    active = self%cells > 1
  end function active

  !> 0: Cartesian, 1: cylindrical, 2: spherical.
  pure integer function radial_power(self)
    class(mesh_group), intent(in) :: self
    radial_power = max(0, findloc(geometry_words == self%geometry, .true., dim=1) - 1)
  end function radial_power

  !> Edge lengths of a cell (1 in a dimension that is not computed).
  pure function cell_size(self) result(h)
    class(mesh_group), intent(in) :: self
    real(wp) :: h(3)
    h = 1
    where (self%cells > 1) h = (self%upper - self%lower)/self%cells
  end function cell_size

  subroutine mesh_keys(group, table)
    type(mesh_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    real(wp), parameter :: usual(2) = [-1e5_wp, 1e5_wp]
    call table%start('mesh', group%line)
    call table%add('geometry', group%geometry, geometry_words)
    call table%add('cells', group%cells, at_least=1, required=.true.)
    call table%add('lower', group%lower, of_length, usual=usual)
    call table%add('upper', group%upper, of_length, usual=usual, required=.true.)
    call table%add('brick', group%brick, at_least=0)
  end subroutine mesh_keys

end module deck_mesh
