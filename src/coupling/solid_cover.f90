!> What the particles cover, cell by cell: where a moving wall stands and which way it looks. No surface is reconstructed.
module solid_cover
  use blocks, only: block
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_mass
  use solid_state, only: solid_type
  implicit none
  private
  public :: cover_cells, smooth_part, wall_normals

  !> Particles in a cell, seen as cubes side by side, must cover this part of a cell face to make a wall of it; fewer are fragments
  !> that gas flows around. A body's outermost cells are walls from about half full on, so that walls stand right in the mean.
  real(wp), parameter :: least_cover = 0.75_wp

contains

  !> solid_part: part of each cell that is solid; wall: 1 where particles make a wall of the cell, else 0 (both: one variable, any
  !> ghosts). Volumes are those at rest: loose particles neither swell nor shrink.
  subroutine cover_cells(mesh, solid, b, solid_part, wall)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b
    type(block), intent(inout) :: solid_part, wall
    real(wp) :: volume, cover, dimensions
    integer :: i, j, k, cell, set, q, n
    solid_part%a = 0
    wall%a = 0
    if (.not. allocated(solid%count(b)%a)) return
    dimensions = real(mesh%dimensions, wp)
    cell = 0
    do k = 1, mesh%brick_cells(3)
      do j = 1, mesh%brick_cells(2)
        do i = 1, mesh%brick_cells(1)
          cell = cell + 1
          n = nint(solid%count(b)%a(i, 1, j, k))
          if (n == 0) cycle
          volume = 0
          do set = 1, solid%n_sets
            if (solid%block(set, b)%n == 0) cycle
            associate (blk => solid%block(set, b))
              do q = blk%cell_start(cell), blk%cell_start(cell + 1) - 1
                volume = volume + blk%f(q, at_mass)/solid%material(set)%density
              end do
            end associate
          end do
          volume = volume/mesh%cell_volume
          cover = n*(volume/n)**((dimensions - 1)/dimensions)
          solid_part%a(i, 1, j, k) = min(volume, 1.0_wp)
          wall%a(i, 1, j, k) = merge(1.0_wp, 0.0_wp, cover >= least_cover)
        end do
      end do
    end do
  end subroutine cover_cells

  !> Spreads the solid part over five cells in each direction with binomial weights: normals of a wall askew to the mesh are then
  !> right to a degree or two. part: two ghost layers filled, in and out; what is put in the cells of the brick alone is right.
  pure subroutine smooth_part(n, active, ghost, part)
    integer, intent(in) :: n(3), ghost(3)
    logical, intent(in) :: active(3)
    real(wp), intent(inout) :: part(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):)
    real(wp) :: row(-1:maxval(n) + 2)
    integer :: d, i, j, k, lo(3), hi(3)
    if (.not. any(part > 0)) return
    lo = 1 - merge(2, 0, active)
    hi = n + merge(2, 0, active)
    do d = 1, 3
      if (.not. active(d)) cycle
      lo(d) = 1
      hi(d) = n(d)
      select case (d)
      case (1)
        do k = lo(3), hi(3)
          do j = lo(2), hi(2)
            row(-1:n(1) + 2) = part(-1:n(1) + 2, j, k)
            do i = 1, n(1)
              part(i, j, k) = spread_value(row(i - 2:i + 2))
            end do
          end do
        end do
      case (2)
        do k = lo(3), hi(3)
          do i = lo(1), hi(1)
            row(-1:n(2) + 2) = part(i, -1:n(2) + 2, k)
            do j = 1, n(2)
              part(i, j, k) = spread_value(row(j - 2:j + 2))
            end do
          end do
        end do
      case (3)
        do j = lo(2), hi(2)
          do i = lo(1), hi(1)
            row(-1:n(3) + 2) = part(i, j, -1:n(3) + 2)
            do k = 1, n(3)
              part(i, j, k) = spread_value(row(k - 2:k + 2))
            end do
          end do
        end do
      end select
    end do

  contains

    pure real(wp) function spread_value(a)
      real(wp), intent(in) :: a(5)
      spread_value = ((a(1) + a(5)) + 4*(a(2) + a(4)) + 6*a(3))*0.0625_wp
    end function spread_value

  end subroutine smooth_part

  !> Normals of the wall in open cells beside walls, for their faces across x (variables 4 to 6), y (7 to 9) and z (10 to 12): along
  !> the gradient of the smoothed solid part, less what another wall that meets this one in an inner corner adds to it; along the
  !> axis where that is small; nil between two walls. solid_part, closed: with filled ghosts; normal: set in the cells of the brick.
  pure subroutine wall_normals(n, active, ghost, spacing, solid_part, closed, normal)
    integer, intent(in) :: n(3), ghost(3)
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: spacing(3)
    real(wp), intent(in), dimension(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):) :: solid_part
    logical, intent(in), dimension(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):) :: closed
    real(wp), intent(inout) :: normal(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    integer :: i, j, k, d, t, side, r(3), step(3)
    real(wp) :: gradient(3), turned(3), axis(3), weight
    integer :: a, b, c
    logical :: beside(-1:1, 3)
    r = merge(1, 0, active)
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          if (closed(i, j, k)) cycle
          beside = .false.
          do d = 1, 3
            if (.not. active(d)) cycle
            step = merge(1, 0, [1, 2, 3] == d)
            beside(1, d) = closed(i + step(1), j + step(2), k + step(3))
            beside(-1, d) = closed(i - step(1), j - step(2), k - step(3))
          end do
          if (.not. any(beside)) cycle
          axis = merge(1, 0, beside(1, :)) - merge(1, 0, beside(-1, :))
          gradient = 0
          do c = -r(3), r(3)
            do b = -r(2), r(2)
              do a = -r(1), r(1)
                weight = solid_part(i + a, j + b, k + c)/((1 + abs(a))*(1 + abs(b))*(1 + abs(c)))
                gradient = gradient + weight*[a, b, c]
              end do
            end do
          end do
          gradient = gradient/spacing
          if (norm2(gradient)*minval(spacing, active) < 0.02_wp) gradient = axis
          do d = 1, 3
            turned = gradient
            do side = -1, 1, 2
              if (.not. beside(side, d)) cycle
              do t = 1, 3
                if (active(t) .and. t /= d) then
                  if (ends_in_corner(ghost, closed, [i, j, k], side*unit(d), unit(t))) turned(t) = 0
                end if
              end do
            end do
            normal(i, 1 + 3*d:3 + 3*d, j, k) = turned/max(norm2(turned), tiny(1.0_wp))
          end do
        end do
      end do
    end do
  end subroutine wall_normals

  !> Step by one cell along an axis.
  pure function unit(d)
    integer, intent(in) :: d
    integer :: unit(3)
    unit = merge(1, 0, [1, 2, 3] == d)
  end function unit

  !> True if the face of an open cell towards a wall belongs to a plane piece of wall along the mesh that ends, within reach of the
  !> normals, at another wall that stands on it: an inner corner. A wall askew to the mesh has corners too, those of its steps, but
  !> where such a step is higher than one cell it is but one cell deep. towards: step to the wall; along: step along it.
  pure logical function ends_in_corner(ghost, closed, cell, towards, along) result(corner)
    integer, intent(in) :: ghost(3), cell(3), towards(3), along(3)
    logical, intent(in) :: closed(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):)
    integer, parameter :: reach = 3, height = 3
    integer :: side, q, h, at(3), length, ends
    corner = .false.
    length = 1
    ends = 0
    do side = -1, 1, 2
      do q = 1, reach
        at = cell + q*side*along
        if (is_closed(at)) then
          do h = 1, height - 1
            if (.not. is_closed(at - h*towards)) return
          end do
          corner = .true.
          exit
        end if
        if (.not. is_closed(at + towards)) then
          ends = ends + 1
          exit
        end if
        length = length + 1
      end do
    end do
    corner = corner .and. (ends == 0 .or. length > 2)

  contains

    pure logical function is_closed(at)
      integer, intent(in) :: at(3)
      is_closed = closed(at(1), at(2), at(3))
    end function is_closed

  end function ends_in_corner

end module solid_cover
