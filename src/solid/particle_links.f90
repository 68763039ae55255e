!> Which points hang together: links between near points, and the groups that follow from them (union-find).
module particle_links
  use kinds, only: wp, i8
  implicit none
  private
  public :: link_points, number_groups, group_of, join_groups

  !> Points with a size; two of one kind are linked where they are nearer than reach times their mean size.
  type, public :: point_set
    integer :: n = 0
    real(wp), allocatable :: position(:, :) !< (3, n)
    real(wp), allocatable :: size(:) !< (n)
    integer, allocatable :: kind(:) !< (n) points of different kinds are never linked
    integer, allocatable :: member(:) !< (n) what is linked when the point is: its place in parent
  end type point_set

contains

  !> Joins the members of all linked points. largest: no point is larger; parent: of each member, a forest that lives on.
  !>
  !> Each point looks for those before it in the cells of a grid of edge reach*largest around it, found by their hash.
  pure subroutine link_points(points, active, reach, largest, parent)
    type(point_set), intent(in) :: points
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: reach, largest
    integer, intent(inout) :: parent(:)
    integer, allocatable :: head(:), next(:)
    integer(i8) :: cell(3, points%n), around(3)
    integer :: n_buckets, i, j, a, b, c, bucket, width(3)
    n_buckets = 2*points%n + 1
    allocate (head(n_buckets), next(points%n), source=0)
    width = merge(1, 0, active)
    do i = 1, points%n
      cell(:, i) = floor(merge(points%position(:, i), 0.0_wp, active)/(reach*largest), i8)
      do c = -width(3), width(3)
        do b = -width(2), width(2)
          do a = -width(1), width(1)
            around = cell(:, i) + [a, b, c]
            j = head(bucket_of(around, n_buckets))
            do while (j > 0)
              if (all(cell(:, j) == around) .and. points%kind(j) == points%kind(i)) then
                if (near(points, active, reach, i, j)) call join_groups(parent, points%member(i), points%member(j))
              end if
              j = next(j)
            end do
          end do
        end do
      end do
      bucket = bucket_of(cell(:, i), n_buckets)
      next(i) = head(bucket)
      head(bucket) = i
    end do
  end subroutine link_points

  pure integer function bucket_of(cell, n) result(bucket)
    integer(i8), intent(in) :: cell(3)
    integer, intent(in) :: n
    bucket = 1 + int(modulo(cell(1)*73856093_i8 + cell(2)*19349663_i8 + cell(3)*83492791_i8, int(n, i8)))
  end function bucket_of

  pure logical function near(points, active, reach, i, j)
    type(point_set), intent(in) :: points
    logical, intent(in) :: active(3)
    real(wp), intent(in) :: reach
    integer, intent(in) :: i, j
    real(wp) :: distance
    distance = norm2(merge(points%position(:, i) - points%position(:, j), 0.0_wp, active))
    near = distance <= 0.5_wp*reach*(points%size(i) + points%size(j))
  end function near

  !> The first member of the group of i.
  pure integer function group_of(parent, i) result(root)
    integer, intent(in) :: parent(:), i
    root = i
    do while (parent(root) /= root)
      root = parent(root)
    end do
  end function group_of

  !> Makes two groups one. The first member stays the root, so the answer does not depend on the order of the links.
  pure subroutine join_groups(parent, i, j)
    integer, intent(inout) :: parent(:)
    integer, intent(in) :: i, j
    integer :: a, b
    a = group_of(parent, i)
    b = group_of(parent, j)
    parent(i) = min(a, b)
    parent(j) = min(a, b)
    parent(max(a, b)) = min(a, b)
  end subroutine join_groups

  !> Numbers the groups from 1 in the order of their first members; number: of each member's group.
  pure subroutine number_groups(parent, number, n_groups)
    integer, intent(in) :: parent(:)
    integer, intent(out) :: number(:), n_groups
    integer :: i, root
    n_groups = 0
    do i = 1, size(parent)
      root = group_of(parent, i)
      if (root == i) then
        n_groups = n_groups + 1
        number(i) = n_groups
      else
        number(i) = number(root)
      end if
    end do
  end subroutine number_groups

end module particle_links
