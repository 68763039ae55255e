!> Shapes that regions and charges fill, in the active directions of the mesh only: on a 2-D mesh a sphere is a disc, on a 1-D
!> mesh a slab.
module flow_shapes
  use kinds, only: wp
  implicit none
  private
  public :: volume_in_box

  integer, parameter, public :: shape_all = 1, shape_box = 2, shape_sphere = 3, shape_cylinder = 4, shape_half_space = 5

  type, public :: filled_shape
    integer :: kind = shape_all
    logical :: active(3) = .true. !< directions of the mesh that count
    real(wp) :: lower(3) = 0, upper(3) = 0 !< box, along its own edges
    real(wp) :: center(3) = 0 !< sphere
    real(wp) :: radius = 0 !< sphere, cylinder
    real(wp) :: start(3) = 0, end(3) = 0 !< axis of the cylinder
    real(wp) :: normal(3) = 0 !< half space: the filled side is against it
  contains
    procedure :: distance
    procedure :: part_of_box
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

  !> Part of a small box that the shape fills, its surface taken as a plane there. width: edge lengths.
  pure real(wp) function part_of_box(self, center, width)
    class(filled_shape), intent(in) :: self
    real(wp), intent(in) :: center(3), width(3)
    real(wp) :: slope(3), step(3)
    integer :: d
    slope = 0
    do d = 1, 3
      if (.not. self%active(d)) cycle
      step = 0
      step(d) = 0.5_wp*width(d)
      slope(d) = self%distance(center + step) - self%distance(center - step)
    end do
    part_of_box = min(max(0.5_wp - self%distance(center)/max(sum(abs(slope)), tiny(1.0_wp)), 0.0_wp), 1.0_wp)
  end function part_of_box

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
      volume = product(width)
    else if (depth == 0) then
      volume = product(width)*shape%part_of_box(center, width)
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
