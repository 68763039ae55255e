!> Shapes that regions and charges fill, in the active directions of the mesh only: on a 2-D mesh a sphere is a disc, on a 1-D
!> mesh a slab. Where x is a radius, what is in the plane of the mesh turns about the axis or centre.
module flow_shapes
  use geometry, only: ring_volume
  use kinds, only: wp
  implicit none
  private
  public :: volume_in_box

  integer, parameter, public :: shape_all = 1, shape_box = 2, shape_sphere = 3, shape_cylinder = 4, shape_half_space = 5

  type, public :: filled_shape
    integer :: kind = shape_all
    logical :: active(3) = .true. !< directions of the mesh that count
    integer :: radial_power = 0 !< of the mesh
    real(wp) :: lower(3) = 0, upper(3) = 0 !< box, along its own edges
    real(wp) :: center(3) = 0 !< sphere
    real(wp) :: radius = 0 !< sphere, cylinder
    real(wp) :: start(3) = 0, end(3) = 0 !< axis of the cylinder
    real(wp) :: normal(3) = 0 !< half space: the filled side is against it
  contains
    procedure :: distance
    procedure :: part_of_box
    procedure :: volume_of_box
  end type filled_shape

contains

  !> Distance of a point from the surface, or a lower bound of it; negative inside.
  pure real(wp) function distance(self, point)
    class(filled_shape), intent(in) :: self
    real(wp), intent(in) :: point(3)
    real(wp) :: x(3), axis(3), length, along
    distance = -huge(1.0_wp)
    select case (self%kind)
    case (shape_box)
      distance = maxval(max(self%lower - point, point - self%upper), self%active)
    case (shape_sphere)
      x = merge(point - self%center, 0.0_wp, self%active)
      distance = norm2(x) - self%radius
    case (shape_cylinder)
      x = merge(point - self%start, 0.0_wp, self%active)
      axis = merge(self%end - self%start, 0.0_wp, self%active)
      length = norm2(axis)
      if (length > 1e-12_wp*norm2(self%end - self%start)) then
        along = dot_product(x, axis)/length
        distance = max(norm2(x - along*axis/length) - self%radius, -along, along - length)
      else
        distance = norm2(x) - self%radius
      end if
    case (shape_half_space)
      axis = merge(self%normal, 0.0_wp, self%active)
      distance = dot_product(merge(point - self%start, 0.0_wp, self%active), axis)/max(norm2(axis), tiny(1.0_wp))
    end select
  end function distance

  !> Part of a small box that the shape fills: exact for a box, else with the surface taken as a plane there. width: edge lengths.
  pure real(wp) function part_of_box(self, center, width)
    class(filled_shape), intent(in) :: self
    real(wp), intent(in) :: center(3), width(3)
    real(wp) :: x(3), axis(3), along, radial, overlap(3)
    select case (self%kind)
    case (shape_box)
      overlap = min(self%upper, center + 0.5_wp*width) - max(self%lower, center - 0.5_wp*width)
      part_of_box = product(max(overlap, 0.0_wp)/width, self%active)
    case (shape_sphere)
      x = merge(center - self%center, 0.0_wp, self%active)
      part_of_box = behind_plane(norm2(x) - self%radius, x, width)
    case (shape_cylinder)
      x = merge(center - self%start, 0.0_wp, self%active)
      axis = merge(self%end - self%start, 0.0_wp, self%active)
      if (norm2(axis) > 1e-12_wp*norm2(self%end - self%start)) then
        along = dot_product(x, axis)/norm2(axis)
        x = x - along*axis/norm2(axis)
        radial = behind_plane(norm2(x) - self%radius, x, width)
        part_of_box = radial*(behind_plane(along - norm2(axis), axis, width) + behind_plane(-along, axis, width) - 1)
      else
        part_of_box = behind_plane(norm2(x) - self%radius, x, width)
      end if
    case (shape_half_space)
      part_of_box = behind_plane(self%distance(center), merge(self%normal, 0.0_wp, self%active), width)
    case default
      part_of_box = 1
    end select
  end function part_of_box

  !> Volume of a small box, of the whole turn where x is a radius.
  pure real(wp) function volume_of_box(self, center, width)
    class(filled_shape), intent(in) :: self
    real(wp), intent(in) :: center(3), width(3)
    volume_of_box = product(width)*ring_volume(self%radial_power, center(1) - 0.5_wp*width(1), center(1) + 0.5_wp*width(1))
  end function volume_of_box

  !> Part of a box on the inner side of a plane at the given distance from its centre.
  pure real(wp) function behind_plane(distance, normal, width)
    real(wp), intent(in) :: distance, normal(3), width(3)
    real(wp) :: reach
    reach = dot_product(abs(normal), width)/max(norm2(normal), tiny(1.0_wp))
    if (reach > 0) then
      behind_plane = min(max(0.5_wp - distance/reach, 0.0_wp), 1.0_wp)
    else
      behind_plane = merge(1.0_wp, 0.0_wp, distance < 0)
    end if
  end function behind_plane

  !> Volume of a shape inside a box, by halving what the surface cuts depth times.
  pure recursive function volume_in_box(shape, center, width, depth) result(volume)
    type(filled_shape), intent(in) :: shape
    real(wp), intent(in) :: center(3), width(3)
    integer, intent(in) :: depth
    real(wp) :: volume, d, child(3), offset(3)
    integer :: i
    d = shape%distance(center)
    volume = 0
    if (d >= 0.5_wp*norm2(merge(width, 0.0_wp, shape%active))) return
    if (d <= -0.5_wp*norm2(merge(width, 0.0_wp, shape%active))) then
      volume = shape%volume_of_box(center, width)
    else if (depth == 0) then
      volume = shape%volume_of_box(center, width)*shape%part_of_box(center, width)
    else
      child = merge(0.5_wp*width, width, shape%active)
      do i = 0, 7
        if (any([btest(i, 0), btest(i, 1), btest(i, 2)] .and. .not. shape%active)) cycle
        offset = merge(0.25_wp, -0.25_wp, [btest(i, 0), btest(i, 1), btest(i, 2)])*width
        volume = volume + volume_in_box(shape, center + merge(offset, 0.0_wp, shape%active), child, depth - 1)
      end do
    end if
  end function volume_in_box

end module flow_shapes
