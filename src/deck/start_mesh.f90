!> The axisymmetric mesh on which the blast of a charge with `start = 'axisymmetric'` is computed. Its cells become twice as large
!> each time that the wave has come through it, until they are half as large as those of the scene: so there are always more than a
!> hundred of them before the front. Across the axis it may end at the faces of the scene; cells of all sizes divide the way between
!> those.
module start_mesh
  use charge_reach, only: charge_extents, cells_in_charge, start_axis
  use deck_types, only: deck_type, word_length
  use kinds, only: wp
  implicit none
  private
  public :: mesh_of_start, lay_start_mesh

  integer, parameter :: brick(2) = [32, 16] !< cells along the radius and the axis
  integer, parameter :: mesh_to_charge = 10 !< cells along the radius of a mesh over those in the charge
  real(wp), parameter :: room_to_burn = 2.5_wp !< longest extents of the charge that the first mesh reaches over
  real(wp), parameter :: coarsest = 0.5_wp !< of a cell of the scene

  type, public :: start_mesh_type
    real(wp) :: thickness = 0, height = 0 !< finest cells along the radius and the axis
    integer :: doublings = 0 !< of these
    integer :: first_cells = 0 !< along the radius, while the cells are the finest
    integer :: cells_along = 0 !< finest cells between the faces of the scene across the axis
    real(wp) :: end_place(2) = 0 !< of these faces along the axis, from the centre of the charge
    character(word_length) :: end_kind(2) = '' !< what they are
  contains
    procedure :: coarsest_thickness
  end type start_mesh_type

contains

  !> The meshes for charge c.
  pure function mesh_of_start(deck, c) result(mesh)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(start_mesh_type) :: mesh
    real(wp) :: extents(2)
    integer :: axis, side, unit
    axis = start_axis(deck, c)
    extents = charge_extents(deck, c)
    mesh%thickness = minval(extents)/cells_in_charge(deck, c)
    do while (2*mesh%coarsest_thickness() <= coarsest*minval(deck%mesh%cell_size(), deck%mesh%active()))
      mesh%doublings = mesh%doublings + 1
    end do
    mesh%first_cells = whole_bricks(max(mesh_to_charge*minval(extents), room_to_burn*maxval(extents))/mesh%thickness, 1)
    mesh%end_place = [deck%mesh%lower(axis), deck%mesh%upper(axis)] - deck%charge(c)%center(axis)
    mesh%end_kind = [(deck%boundary%flow_face(axis, side), side=1, 2)]
    unit = brick(2)*2**mesh%doublings
    mesh%cells_along = unit*ceiling((mesh%end_place(2) - mesh%end_place(1))/(unit*mesh%thickness))
    mesh%height = (mesh%end_place(2) - mesh%end_place(1))/mesh%cells_along
  end function mesh_of_start

  !> Thickness of the shells after all doublings.
  pure real(wp) function coarsest_thickness(self)
    class(start_mesh_type), intent(in) :: self
    coarsest_thickness = self%thickness*2**self%doublings
  end function coarsest_thickness

  pure integer function whole_bricks(cells, d)
    real(wp), intent(in) :: cells
    integer, intent(in) :: d
    whole_bricks = brick(d)*ceiling(cells/brick(d))
  end function whole_bricks

  !> Sets mesh and faces of the deck of a charge whose centre is the origin. level: doublings of the cells; cells: along the radius,
  !> and as many to each side where no face is nearer. room: distance from the centre within which the mesh holds all.
  pure subroutine lay_start_mesh(mesh, level, cells, deck, room)
    type(start_mesh_type), intent(in) :: mesh
    integer, intent(in) :: level, cells
    type(deck_type), intent(inout) :: deck
    real(wp), intent(out) :: room
    real(wp) :: height
    integer :: center, low, high, top
    height = mesh%height*2**level
    top = mesh%cells_along/2**level
    center = min(max(nint(-mesh%end_place(1)/height), 0), top)
    low = brick(2)*max(floor(real(center - cells, wp)/brick(2)), 0)
    high = min(brick(2)*ceiling(real(center + cells, wp)/brick(2)), top)
    deck%mesh%geometry = 'cylindrical'
    deck%mesh%cells = [cells, high - low, 1]
    deck%mesh%lower = [0.0_wp, mesh%end_place(1) + low*height, 0.0_wp]
    deck%mesh%upper = [cells*mesh%thickness*2**level, mesh%end_place(1) + high*height, 1.0_wp]
    deck%mesh%brick(:2) = brick
    deck%boundary%x_high = 'ambient'
    deck%boundary%y_low = 'ambient'
    deck%boundary%y_high = 'ambient'
    room = deck%mesh%upper(1)
    if (low == 0) then
      deck%mesh%lower(2) = mesh%end_place(1)
      deck%boundary%y_low = mesh%end_kind(1)
    else
      room = min(room, -deck%mesh%lower(2))
    end if
    if (high == top) then
      deck%mesh%upper(2) = mesh%end_place(2)
      deck%boundary%y_high = mesh%end_kind(2)
    else
      room = min(room, deck%mesh%upper(2))
    end if
  end subroutine lay_start_mesh

end module start_mesh
