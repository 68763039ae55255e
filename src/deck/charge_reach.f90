!> How far the blast of a charge may go before it meets anything: a face of the domain, a body, another state of the flow, another
!> charge. Symmetry planes through its centre are no hindrance, and faces across the axis of an axisymmetric start neither. All from
!> the deck, before anything is computed.
module charge_reach
  use constants, only: pi
  use deck_check_shape, only: inside_shape, shape_type
  use deck_types, only: deck_type, find_material, word_length
  use kinds, only: wp
  use text, only: str
  implicit none
  private
  public :: reach_of_charge, charge_radius, charge_extents, dimensions_of_blast, is_symmetry_of, ambient_region, cells_in_charge, &
    start_axis, burns_from_center, is_lit_at_center, is_lit_around_axis

  real(wp), parameter, public :: least_reach = 1.5_wp !< extents of the charge: by then all of it has burnt
  real(wp), parameter :: clearance = 2 !< cells of the scene between the front and what it would meet
  real(wp), parameter :: on_plane = 1e-9_wp !< of a cell: distance of a centre that lies on a symmetry plane
  real(wp), parameter :: at_center = 1e-6_wp !< of its radius: distance of a detonator that lies in the centre of a charge
  !> Along a radius alone, and on an axisymmetric mesh:
  integer, parameter :: fewest_cells(2) = [100, 24], most_cells(2) = [huge(1), 48] !< in a charge's radius, by default
  real(wp), parameter :: finer(2) = [4.0_wp, 2.0_wp] !< cells of the fine mesh in one of the scene

contains

  !> Largest radius that the front of charge c may have, and what it would meet next; negative where that is nearer than the
  !> clearance.
  subroutine reach_of_charge(deck, c, reach, obstacle)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(out) :: reach
    character(:), allocatable, intent(out) :: obstacle
    real(wp) :: center(3)
    integer :: d, side, i
    character(6), parameter :: face(2, 3) = reshape([character(6) :: 'x_low', 'x_high', 'y_low', 'y_high', 'z_low', 'z_high'], &
      [2, 3])
    reach = huge(1.0_wp)
    obstacle = 'nothing'
    center = deck%charge(c)%center
    associate (mesh => deck%mesh)
      do d = 1, 3
        if (.not. mesh%cells(d) > 1) cycle
        do side = 1, 2
          if (is_symmetry_of(deck, c, d, side)) cycle
          if (d == start_axis(deck, c) .and. stays_axisymmetric(deck%boundary%flow_face(d, side))) cycle
          call meet(merge(center(d) - mesh%lower(d), mesh%upper(d) - center(d), side == 1), 'the face '//trim(face(side, d)))
        end do
      end do
      do i = 1, size(deck%body)
        call meet(distance(shape_of_body(i), center, mesh%active()), 'body '''//trim(deck%body(i)%name)//'''')
      end do
      i = ambient_region(deck, c)
      if (i == 0) return
      if (deck%region(i)%shape /= 'all') call meet(-distance(shape_of_region(i), center, mesh%active()), &
        'the end of the &region on line '//str(deck%region(i)%line))
      do i = i + 1, size(deck%region)
        if (same_state(i, ambient_region(deck, c))) cycle
        call meet(distance(shape_of_region(i), center, mesh%active()), 'the &region on line '//str(deck%region(i)%line))
      end do
      do i = 1, size(deck%charge)
        if (i == c) cycle
        call meet(way_to_charge(i), 'charge '//str(i))
      end do
    end associate
    reach = reach - clearance*maxval(deck%mesh%cell_size(), deck%mesh%active())

  contains

    subroutine meet(way, what)
      real(wp), intent(in) :: way
      character(*), intent(in) :: what
      if (.not. way < reach) return
      reach = way
      obstacle = what
    end subroutine meet

    function shape_of_body(i) result(shape)
      integer, intent(in) :: i
      type(shape_type) :: shape
      associate (b => deck%body(i))
        shape = shape_type(b%shape, b%lower, b%upper, b%center, b%radius, b%start, b%end)
      end associate
    end function shape_of_body

    function shape_of_region(i) result(shape)
      integer, intent(in) :: i
      type(shape_type) :: shape
      associate (r => deck%region(i))
        shape = shape_type(r%shape, r%lower, r%upper, r%center, r%radius, r%start, r%end, r%point, r%normal)
      end associate
    end function shape_of_region

    pure logical function same_state(i, j)
      integer, intent(in) :: i, j
      associate (a => deck%region(i), b => deck%region(j))
        same_state = a%material == b%material .and. abs(a%density - b%density) <= 0 .and. abs(a%pressure - b%pressure) <= 0 &
          .and. all(abs(a%velocity - b%velocity) <= 0)
      end associate
    end function same_state

    ! Blasts of two charges share the way between them as their radii; a charge that is lit later is met at its surface.
    real(wp) function way_to_charge(i) result(way)
      integer, intent(in) :: i
      way = norm2(merge(deck%charge(i)%center - center, 0.0_wp, deck%mesh%active()))
      if (deck%charge(i)%is_mapped()) then
        way = way*charge_radius(deck, c)/(charge_radius(deck, c) + charge_radius(deck, i))
      else
        way = way - 2*charge_radius(deck, i)*max(1.0_wp, deck%charge(i)%length_to_diameter, &
          maxval(deck%charge(i)%proportions)/minval(deck%charge(i)%proportions))
      end if
    end function way_to_charge

  end subroutine reach_of_charge

  !> Directions in which the blast of a charge spreads: 3 from a point, 2 from an axis, 1 from a plane.
  pure integer function dimensions_of_blast(deck) result(n)
    type(deck_type), intent(in) :: deck
    n = count(deck%mesh%cells > 1) + deck%mesh%radial_power()
  end function dimensions_of_blast

  !> Radius of charge c, taken as a sphere (as a disc or slab in two directions or one).
  pure real(wp) function charge_radius(deck, c) result(radius)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp) :: volume
    volume = deck%charge(c)%mass/deck%material(find_material(deck, deck%charge(c)%explosive))%density
    select case (dimensions_of_blast(deck))
    case (3); radius = (3*volume/(4*pi))**(1.0_wp/3)
    case (2); radius = sqrt(volume/pi)
    case default; radius = 0.5_wp*volume
    end select
  end function charge_radius

  !> Direction of the axis of charge c where its start is axisymmetric, else 0: as the deck says, or that of the mesh or the
  !> cylinder, or z.
  pure integer function start_axis(deck, c) result(axis)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    axis = 0
    associate (charge => deck%charge(c))
      if (charge%start /= 'axisymmetric') return
      axis = index('xyz', trim(charge%start_axis))
      if (charge%start_axis /= '') return
      axis = 3
      if (charge%shape == 'cylinder') axis = maxloc(abs(charge%axis), dim=1)
      if (deck%mesh%radial_power() > 0) axis = 2
    end associate
  end function start_axis

  !> What a face across the axis may be so that a flow around the axis stays one.
  pure logical function stays_axisymmetric(face)
    character(*), intent(in) :: face
    stays_axisymmetric = any(face == [character(word_length) :: 'symmetry', 'outflow', 'ambient'])
  end function stays_axisymmetric

  !> True if charge c is a sphere that burns from its centre, or has burnt at once.
  pure logical function burns_from_center(deck, c)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    integer :: i
    associate (charge => deck%charge(c))
      burns_from_center = charge%shape == 'sphere'
      if (charge%detonation /= 'programmed') return
      do i = 1, size(deck%detonator)
        if (all(deck%detonator(i)%charge /= [0, c])) cycle
        if (.not. is_lit_at_center(deck, c, i)) burns_from_center = .false.
      end do
    end associate
  end function burns_from_center

  !> True if detonator i is a point in the centre of charge c.
  pure logical function is_lit_at_center(deck, c, i)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, i
    associate (d => deck%detonator(i))
      is_lit_at_center = d%shape == 'point' .and. norm2(merge(d%position - deck%charge(c)%center, 0.0_wp, deck%mesh%active())) &
                         <= at_center*charge_radius(deck, c)
    end associate
  end function is_lit_at_center

  !> True if detonator i lights a charge that turns about the axis of charge c in the same way all around.
  pure logical function is_lit_around_axis(deck, c, i)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, i
    logical :: across(3)
    real(wp) :: near
    across = deck%mesh%active() .and. [1, 2, 3] /= start_axis(deck, c)
    near = at_center*charge_radius(deck, c)
    associate (d => deck%detonator(i), center => deck%charge(c)%center)
      select case (d%shape)
      case ('plane'); is_lit_around_axis = norm2(merge(d%normal, 0.0_wp, across)) <= at_center*norm2(d%normal)
      case ('line'); is_lit_around_axis = all(abs([d%position, d%end] - [center, center]) <= near .or. .not. [across, across])
      case default; is_lit_around_axis = all(abs(d%position - center) <= near .or. .not. across)
      end select
    end associate
  end function is_lit_around_axis

  !> Radius of charge c, and the half of its length along its axis.
  pure function charge_extents(deck, c) result(extents)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp) :: extents(2), volume
    extents = charge_radius(deck, c)
    associate (charge => deck%charge(c))
      if (charge%shape /= 'cylinder') return
      volume = charge%mass/deck%material(find_material(deck, charge%explosive))%density
      extents(1) = (volume/(2*pi*charge%length_to_diameter))**(1.0_wp/3)
      extents(2) = extents(1)*charge%length_to_diameter
    end associate
  end function charge_extents

  !> Cells of the fine mesh in the radius of charge c, or in what is less of that and half of its length: as the deck says, or
  !> enough of them for the detonation and for the scene's mesh.
  pure integer function cells_in_charge(deck, c) result(n)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp) :: length
    integer :: kind
    n = deck%charge(c)%start_cells
    if (n > 0) return
    kind = 1
    length = charge_radius(deck, c)
    if (start_axis(deck, c) > 0) then
      kind = 2
      length = minval(charge_extents(deck, c))
    end if
    n = ceiling(finer(kind)*length/minval(deck%mesh%cell_size(), deck%mesh%active()))
    n = min(max(n, fewest_cells(kind)), most_cells(kind))
  end function cells_in_charge

  !> True if a face is a symmetry plane through the centre of charge c, or the axis or centre that it lies on.
  pure logical function is_symmetry_of(deck, c, direction, side)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, direction, side
    real(wp) :: h(3)
    h = deck%mesh%cell_size()
    is_symmetry_of = abs(deck%charge(c)%center(direction) - merge(deck%mesh%lower(direction), deck%mesh%upper(direction), &
      side == 1)) <= on_plane*h(direction) .and. deck%boundary%flow_face(direction, side) == 'symmetry'
  end function is_symmetry_of

  !> The region that charge c lies in: the last that holds its centre; 0 if none does.
  pure integer function ambient_region(deck, c) result(i)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    do i = size(deck%region), 1, -1
      associate (r => deck%region(i))
        if (inside_shape(shape_type(r%shape, r%lower, r%upper, r%center, r%radius, r%start, r%end, r%point, r%normal), &
                         deck%charge(c)%center)) return
      end associate
    end do
    i = 0
  end function ambient_region

  !> Distance of a point from a shape in the active directions, negative inside; an ogive as the cylinder around it.
  pure real(wp) function distance(shape, point, active)
    type(shape_type), intent(in) :: shape
    real(wp), intent(in) :: point(3)
    logical, intent(in) :: active(3)
    real(wp) :: away(3), axis(3), along, length
    distance = -huge(1.0_wp)
    select case (shape%kind)
    case ('box')
      away = merge(max(shape%lower - point, point - shape%upper), -huge(1.0_wp), active)
      distance = maxval(away)
      if (distance > 0) distance = norm2(max(away, 0.0_wp))
    case ('sphere')
      distance = norm2(merge(point - shape%center, 0.0_wp, active)) - shape%radius
    case ('cylinder', 'ogive')
      away = merge(point - shape%start, 0.0_wp, active)
      axis = merge(shape%end - shape%start, 0.0_wp, active)
      length = norm2(axis)
      if (length > 0) then
        along = dot_product(away, axis)/length
        away(1:2) = [norm2(away - along*axis/length) - shape%radius, max(-along, along - length)]
        distance = maxval(away(1:2))
        if (distance > 0) distance = norm2(max(away(1:2), 0.0_wp))
      else
        distance = norm2(away) - shape%radius
      end if
    case ('half_space')
      axis = merge(shape%normal, 0.0_wp, active)
      distance = dot_product(merge(point - shape%point, 0.0_wp, active), axis)/max(norm2(axis), tiny(1.0_wp))
    end select
  end function distance

end module charge_reach
