!> Shapes that bodies are made of: convex, so that a straight line cuts each in one interval; from that follow inside tests,
!> and volumes of what remains after cutting shapes from one another.
module solid_shapes
  use kinds, only: wp
  implicit none
  private
  public :: box_shape, sphere_shape, cylinder_shape, ogive_shape, remaining_volume

  integer, parameter :: is_box = 1, is_sphere = 2, is_cylinder = 3, is_ogive = 4

  !> A box, a sphere, a cylinder with flat ends, or one with an ogive on its end. Directions that are not active play no part: in
  !> two dimensions a sphere is a disc.
  type, public :: shape_type
    integer :: kind = is_box
    logical :: active(3) = .true.
    real(wp) :: lower(3) = 0, upper(3) = 0 !< bounding box
    real(wp) :: center(3) = 0 !< of the sphere, or start of the cylinder's axis
    real(wp) :: axis(3) = 0 !< unit vector of the cylinder's axis
    real(wp) :: length = 0, radius = 0
    real(wp) :: nose = 0, arc = 0 !< length of the ogive, and radius of the arc that is its outline
    logical :: endless = .false. !< the cylinder's axis lies along an inactive direction
  contains
    procedure :: holds
    procedure :: interval
  end type shape_type

contains

  pure function box_shape(lower, upper, active) result(s)
    real(wp), intent(in) :: lower(3), upper(3)
    logical, intent(in) :: active(3)
    type(shape_type) :: s
    s%kind = is_box
    s%active = active
    s%lower = lower
    s%upper = upper
  end function box_shape

  pure function sphere_shape(center, radius, active) result(s)
    real(wp), intent(in) :: center(3), radius
    logical, intent(in) :: active(3)
    type(shape_type) :: s
    s%kind = is_sphere
    s%active = active
    s%center = merge(center, 0.0_wp, active)
    s%radius = radius
    s%lower = s%center - radius
    s%upper = s%center + radius
  end function sphere_shape

  pure function cylinder_shape(start, end, radius, active) result(s)
    real(wp), intent(in) :: start(3), end(3), radius
    logical, intent(in) :: active(3)
    type(shape_type) :: s
    real(wp) :: reach(3), finish(3)
    s%kind = is_cylinder
    s%active = active
    s%center = merge(start, 0.0_wp, active)
    finish = merge(end, 0.0_wp, active)
    s%radius = radius
    s%length = norm2(finish - s%center)
    s%endless = .not. s%length > 0
    if (s%endless) then
      s%lower = s%center - radius
      s%upper = s%center + radius
    else
      s%axis = (finish - s%center)/s%length
      reach = radius*sqrt(max(1 - s%axis**2, 0.0_wp))
      s%lower = min(s%center, finish) - reach
      s%upper = max(s%center, finish) + reach
    end if
  end function cylinder_shape

  !> A cylinder from start whose end is a tangent ogive with its tip at end: the outline is an arc of a circle that joins the
  !> cylinder smoothly. head: radius of the arc over the diameter (caliber radius head), 1/2 (a half sphere) or more.
  pure function ogive_shape(start, end, radius, head, active) result(s)
    real(wp), intent(in) :: start(3), end(3), radius, head
    logical, intent(in) :: active(3)
    type(shape_type) :: s
    s = cylinder_shape(start, end, radius, active)
    s%kind = is_ogive
    s%arc = 2*radius*head
    s%nose = min(sqrt(s%arc**2 - (s%arc - radius)**2), s%length)
  end function ogive_shape

  !> Radius of an ogive at a place along its axis, which lies between its ends.
  pure real(wp) function ogive_radius(self, along)
    class(shape_type), intent(in) :: self
    real(wp), intent(in) :: along
    real(wp) :: into
    into = max(along - (self%length - self%nose), 0.0_wp)
    ogive_radius = max(sqrt(max(self%arc**2 - into**2, 0.0_wp)) - (self%arc - self%radius), 0.0_wp)
  end function ogive_radius

  !> Is the point in the shape?
  pure logical function holds(self, point)
    class(shape_type), intent(in) :: self
    real(wp), intent(in) :: point(3)
    real(wp) :: d(3), along, radius
    holds = .not. any(self%active .and. (point < self%lower .or. point > self%upper))
    if (.not. holds .or. self%kind == is_box) return
    d = merge(point - self%center, 0.0_wp, self%active)
    along = 0
    radius = self%radius
    if (self%kind /= is_sphere .and. .not. self%endless) then
      along = dot_product(d, self%axis)
      holds = along >= 0 .and. along <= self%length
      if (self%kind == is_ogive) radius = ogive_radius(self, along)
    end if
    holds = holds .and. dot_product(d, d) - along**2 <= radius**2
  end function holds

  !> The part low..high of the line through point along coordinate direction that lies in the shape; empty where high <= low.
  !> range: what is of interest, always finite.
  pure subroutine interval(self, point, direction, range, low, high)
    class(shape_type), intent(in) :: self
    real(wp), intent(in) :: point(3), range(2)
    integer, intent(in) :: direction
    real(wp), intent(out) :: low, high
    real(wp) :: d(3), u(3), a, b, c, du, root, cut(2)
    logical :: across(3)
    integer :: i
    low = range(1)
    high = range(1)
    across = [(i /= direction, i=1, 3)] .and. self%active
    if (any(across .and. (point < self%lower .or. point > self%upper))) return
    high = range(2)
    if (self%active(direction)) then
      low = max(low, self%lower(direction))
      high = min(high, self%upper(direction))
    end if
    if (self%kind == is_box) return
    ! |d + s u|^2 - (along)^2 = radius^2, with d and u stripped of their part along the axis
    d = merge(point - self%center, 0.0_wp, self%active)
    d(direction) = 0
    u = 0
    if (self%active(direction)) u(direction) = 1
    if (self%kind /= is_sphere .and. .not. self%endless) then
      a = dot_product(d, self%axis)
      b = dot_product(u, self%axis)
      if (abs(b) > 1e-12_wp) then
        cut = self%center(direction) + [-a/b, (self%length - a)/b]
        low = max(low, minval(cut))
        high = min(high, maxval(cut))
      else if (a < 0 .or. a > self%length) then
        high = low
      end if
      d = d - a*self%axis
      u = u - b*self%axis
    end if
    a = dot_product(u, u)
    du = dot_product(d, u)
    c = dot_product(d, d) - self%radius**2
    if (a > 1e-20_wp) then
      root = du**2 - a*c
      if (root <= 0) then
        high = low
        return
      end if
      root = sqrt(root)
      low = max(low, self%center(direction) + (-du - root)/a)
      high = min(high, self%center(direction) + (-du + root)/a)
    else if (c > 0) then
      high = low
    end if
    if (self%kind == is_ogive .and. high > low) call cut_ogive(self, point, direction, low, high)
  end subroutine interval

  !> Shortens an interval of the cylinder around an ogive to that of the ogive. The shape is convex: the distance from the axis less
  !> the radius has one minimum along the line, which golden sections find, and a zero on either side, found by bisection.
  pure subroutine cut_ogive(self, point, direction, low, high)
    class(shape_type), intent(in) :: self
    real(wp), intent(in) :: point(3)
    integer, intent(in) :: direction
    real(wp), intent(inout) :: low, high
    real(wp), parameter :: golden = 0.5_wp*(sqrt(5.0_wp) - 1)
    real(wp) :: a, b, p, q, inside, outside(2)
    integer :: i, side
    a = low
    b = high
    do i = 1, 40
      p = b - golden*(b - a)
      q = a + golden*(b - a)
      if (excess(p) < excess(q)) then
        b = q
      else
        a = p
      end if
    end do
    inside = 0.5_wp*(a + b)
    if (excess(inside) > 0) then
      high = low
      return
    end if
    outside = [low, high]
    do side = 1, 2
      if (excess(outside(side)) <= 0) cycle
      a = inside
      b = outside(side)
      do i = 1, 40
        p = 0.5_wp*(a + b)
        if (excess(p) > 0) then
          b = p
        else
          a = p
        end if
      end do
      outside(side) = a
    end do
    low = outside(1)
    high = outside(2)

  contains

    pure real(wp) function excess(s)
      real(wp), intent(in) :: s
      real(wp) :: d(3), along
      d = point
      d(direction) = s
      d = merge(d - self%center, 0.0_wp, self%active)
      along = dot_product(d, self%axis)
      excess = sqrt(max(dot_product(d, d) - along**2, 0.0_wp)) - ogive_radius(self, along)
    end function excess

  end subroutine cut_ogive

  !> Volume of a shape inside the box lower..upper and outside all of cut.
  !>
  !> Lines along one direction cut every shape in an interval; the two other directions are summed by midpoints, 512 and more.
  !> pitch: spacing of the lattice that fills the shape; the midpoints fit between its planes, so that cuts along them are exact.
  pure real(wp) function remaining_volume(shape, cut, lower, upper, pitch) result(volume)
    type(shape_type), intent(in) :: shape, cut(:)
    real(wp), intent(in) :: lower(3), upper(3), pitch
    integer, parameter :: lines = 512
    real(wp) :: box_low(3), box_high(3), point(3), low, high, step(3), gap(2, size(cut))
    integer :: along, d1, d2, n(3), i, j, c, n_gap
    logical :: near(size(cut))
    volume = 0
    box_low = merge(max(lower, shape%lower), lower, shape%active)
    box_high = merge(min(upper, shape%upper), upper, shape%active)
    if (any(box_high <= box_low)) return
    ! across the axis of a cylinder the sums converge faster
    along = maxloc(box_high - box_low, dim=1, mask=shape%active .and. abs(shape%axis) < 0.9_wp)
    if (along == 0) along = maxloc(box_high - box_low, dim=1)
    d1 = 1 + mod(along, 3)
    d2 = 1 + mod(along + 1, 3)
    n = max(1, nint((box_high - box_low)/pitch))
    n = n*((lines + n - 1)/n)
    where (.not. shape%active) n = 1
    step = (box_high - box_low)/n
    do c = 1, size(cut)
      near(c) = .not. any(shape%active .and. (cut(c)%upper <= box_low .or. cut(c)%lower >= box_high))
    end do
    if (shape%kind == is_box .and. .not. any(near)) then
      volume = product(box_high - box_low)
      return
    end if
    point = 0
    do j = 1, n(d2)
      point(d2) = box_low(d2) + (j - 0.5_wp)*step(d2)
      do i = 1, n(d1)
        point(d1) = box_low(d1) + (i - 0.5_wp)*step(d1)
        call shape%interval(point, along, [box_low(along), box_high(along)], low, high)
        if (high <= low) cycle
        n_gap = 0
        do c = 1, size(cut)
          if (.not. near(c)) cycle
          call cut(c)%interval(point, along, [low, high], gap(1, n_gap + 1), gap(2, n_gap + 1))
          if (gap(2, n_gap + 1) > gap(1, n_gap + 1)) n_gap = n_gap + 1
          if (n_gap == size(cut)) exit
        end do
        volume = volume + (high - low) - covered(gap(:, :n_gap))
      end do
    end do
    volume = volume*step(d1)*step(d2)
  end function remaining_volume

  !> Length of the union of intervals.
  pure real(wp) function covered(gap) result(length)
    real(wp), intent(in) :: gap(:, :)
    real(wp) :: order(2, size(gap, 2)), reach, first(2)
    integer :: i, j
    order = gap
    do i = 2, size(gap, 2)
      first = order(:, i)
      j = i
      do while (j > 1)
        if (order(1, j - 1) <= first(1)) exit
        order(:, j) = order(:, j - 1)
        j = j - 1
      end do
      order(:, j) = first
    end do
    length = 0
    reach = -huge(reach)
    do i = 1, size(gap, 2)
      length = length + max(order(2, i) - max(order(1, i), reach), 0.0_wp)
      reach = max(reach, order(2, i))
    end do
  end function covered

end module solid_shapes
