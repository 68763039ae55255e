!> Volumes that equal shells around a centre have in a box, and which way they lie. The box is cut into small ones, each of which is
!> taken as a slab across the radius. What all boxes have of a shell differs from its volume by a small error of second order;
!> module radial_mapping takes it away.
module radial_shells
  use geometry, only: ring_volume
  use kinds, only: wp
  implicit none
  private
  public :: shells_of_box, volume_of_ball

  integer, parameter :: halvings = 2 !< of every box
  integer, parameter :: most_halvings = 7 !< near the centre
  real(wp), parameter :: curved = 0.15_wp !< half a diagonal over the distance from which on a box is halved again

contains

  !> center: of the box, from the centre of the shells; width: edge lengths; active: directions that count; radial_power: of the
  !> mesh (where x is a radius the box is a ring); thickness: of a shell, n of them. first, last: shells that may have a part, none
  !> if first > last; volume(last - first + 1): of these; way(3, ...): the same times the mean unit vector from the centre.
  subroutine shells_of_box(center, width, active, radial_power, thickness, n, first, last, volume, way)
    real(wp), intent(in) :: center(3), width(3), thickness
    logical, intent(in) :: active(3)
    integer, intent(in) :: radial_power, n
    integer, intent(out) :: first, last
    real(wp), intent(inout), allocatable :: volume(:), way(:, :)
    real(wp) :: near, far
    near = norm2(merge(max(abs(center) - 0.5_wp*width, 0.0_wp), 0.0_wp, active))
    far = norm2(merge(abs(center) + 0.5_wp*width, 0.0_wp, active))
    first = 1
    last = 0
    if (near >= n*thickness) return
    first = max(int(near/thickness), 1)
    last = min(int(far/thickness) + 2, n)
    if (allocated(volume)) then
      if (size(volume) < last - first + 1) deallocate (volume, way)
    end if
    if (.not. allocated(volume)) allocate (volume(2*(last - first + 1)), way(3, 2*(last - first + 1)))
    volume(:last - first + 1) = 0
    way(:, :last - first + 1) = 0
    call add_box(center, width, 0)

  contains

    recursive subroutine add_box(x, w, level)
      real(wp), intent(in) :: x(3), w(3)
      integer, intent(in) :: level
      real(wp) :: r, half, child(3), middle(3)
      integer :: i
      r = norm2(merge(x, 0.0_wp, active))
      half = 0.5_wp*norm2(merge(w, 0.0_wp, active))
      if (level < halvings .or. (half > curved*r .and. level < most_halvings)) then
        child = merge(0.5_wp*w, w, active)
        do i = 0, 7
          if (any([btest(i, 0), btest(i, 1), btest(i, 2)] .and. .not. active)) cycle
          middle = x + merge(merge(0.25_wp, -0.25_wp, [btest(i, 0), btest(i, 1), btest(i, 2)])*w, 0.0_wp, active)
          call add_box(middle, child, level + 1)
        end do
      else
        call add_slab(x, w, r)
      end if
    end subroutine add_box

    ! A small box: its volume lies evenly between its lowest and its highest distance.
    subroutine add_slab(x, w, r)
      real(wp), intent(in) :: x(3), w(3), r
      real(wp) :: unit(3), low, high, part, whole
      integer :: j
      unit = merge(x, 0.0_wp, active)/max(r, tiny(1.0_wp))
      whole = product(w)*ring_volume(radial_power, x(1) - 0.5_wp*w(1), x(1) + 0.5_wp*w(1))
      high = r + 0.5_wp*sum(abs(unit)*w)
      low = max(r - 0.5_wp*sum(abs(unit)*w), near)
      do j = max(int(low/thickness) + 1, first), min(int(high/thickness) + 1, last)
        part = whole*max(min(high, j*thickness) - max(low, (j - 1)*thickness), 0.0_wp)/(high - low)
        volume(j - first + 1) = volume(j - first + 1) + part
        way(:, j - first + 1) = way(:, j - first + 1) + part*unit
      end do
    end subroutine add_slab

  end subroutine shells_of_box

  !> Volume of a whole ball (radial_power 2) or, per length, of a disc (1).
  pure real(wp) function volume_of_ball(radial_power, radius)
    integer, intent(in) :: radial_power
    real(wp), intent(in) :: radius
    volume_of_ball = radius*ring_volume(radial_power, 0.0_wp, radius)
  end function volume_of_ball

end module radial_shells
