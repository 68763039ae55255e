!> What the blast did to each place: the highest overpressure, the impulse of the positive overpressure, the time of arrival.
module peak_maps
  use blocks, only: block, holder, own, share
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: peak_maps_type, start_peaks, update_peaks, restore_unreached

  integer, parameter, public :: peak_overpressure = 1 !< highest pressure less the ambient one
  integer, parameter, public :: peak_impulse = 2 !< integral of the positive overpressure over time
  integer, parameter, public :: peak_arrival = 3 !< first time of an overpressure above the threshold; not_reached before
  integer, parameter, public :: n_peaks = 3
  real(wp), parameter, public :: not_reached = -1

  !> The maps: one block per local brick, cells 1..n without ghosts. Bricks that nothing has reached share the one behind them.
  type :: peak_maps_type
    type(block), allocatable :: map(:)
    real(wp) :: ambient = 0 !< pressure from which overpressure is counted
    real(wp) :: threshold = 0 !< overpressure that counts as arrival
  end type peak_maps_type

contains

  !> Empty maps.
  subroutine start_peaks(peaks, mesh, ambient, threshold)
    type(peak_maps_type), intent(out) :: peaks
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: ambient, threshold
    integer :: b
    peaks%ambient = ambient
    peaks%threshold = threshold
    allocate (peaks%map(mesh%n_local + 1))
    associate (unreached => peaks%map(mesh%n_local + 1))
      allocate (unreached%a(mesh%brick_cells(1), n_peaks, mesh%brick_cells(2), mesh%brick_cells(3)))
      unreached%a = 0
      unreached%a(:, peak_arrival, :, :) = not_reached
    end associate
    do b = 1, mesh%n_local
      call share(peaks%map, b, mesh%n_local + 1)
    end do
  end subroutine start_peaks

  !> After maps have been read: bricks that have none are those that nothing has reached.
  subroutine restore_unreached(peaks, mesh)
    type(peak_maps_type), intent(inout) :: peaks
    type(mesh_type), intent(in) :: mesh
    integer :: b
    do b = 1, mesh%n_local
      if (allocated(peaks%map(b)%a)) then
        peaks%map(b)%shares = 0
      else
        call share(peaks%map, b, mesh%n_local + 1)
      end if
    end do
  end subroutine restore_unreached

  !> Takes in the state at a time. state, open: blocks of the flow (those of sleeping bricks are shared) and of its closed cells (0
  !> closed; unallocated where all are open); column: of the pressure; duration: the time that this state stands for in the integral
  !> (the mean of the steps before and after it gives the trapezoidal rule).
  subroutine update_peaks(peaks, mesh, state, open, column, time, duration)
    type(peak_maps_type), intent(inout) :: peaks
    type(mesh_type), intent(in) :: mesh
    type(block), intent(in) :: state(:), open(:)
    integer, intent(in) :: column
    real(wp), intent(in) :: time, duration
    integer :: b, h, j, k, n
    logical :: all_open
    real(wp) :: ones(mesh%brick_cells(1))
    n = mesh%brick_cells(1)
    ones = 1
    do b = 1, mesh%n_local
      h = holder(state, b)
      if (.not. allocated(state(h)%a)) cycle
      if (h /= b) then
        if (.not. state(h)%a(1, column, 1, 1) > peaks%ambient) cycle ! a sleeping brick is in one state
      end if
      all_open = .true.
      if (b <= size(open)) all_open = .not. allocated(open(b)%a)
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          if (.not. any(state(h)%a(1:n, column, j, k) > peaks%ambient)) cycle ! nothing can change: spares the maps' memory
          call own(peaks%map, b)
          if (all_open) then
            call update_row(n, state(h)%a(1:n, column, j, k), ones, peaks%ambient, peaks%threshold, time, duration, &
              peaks%map(b)%a(:, 1, j, k), peaks%map(b)%a(:, 2, j, k), peaks%map(b)%a(:, 3, j, k))
          else
            call update_row(n, state(h)%a(1:n, column, j, k), open(b)%a(1:n, 1, j, k), peaks%ambient, peaks%threshold, time, &
              duration, peaks%map(b)%a(:, 1, j, k), peaks%map(b)%a(:, 2, j, k), peaks%map(b)%a(:, 3, j, k))
          end if
        end do
      end do
    end do
  end subroutine update_peaks

  pure subroutine update_row(n, pressure, open, ambient, threshold, time, duration, peak, impulse, arrival)
    integer, intent(in) :: n
    real(wp), intent(in) :: pressure(n), open(n), ambient, threshold, time, duration
    real(wp), intent(inout) :: peak(n), impulse(n), arrival(n)
    real(wp) :: over, highest, arrived
    integer :: i
    !$omp simd private(over, highest, arrived)
    do i = 1, n
      over = (pressure(i) - ambient)*open(i)
      highest = peak(i)
      peak(i) = merge(over, highest, over > highest)
      impulse(i) = impulse(i) + duration*merge(over, 0.0_wp, over > 0)
      arrived = arrival(i)
      arrived = merge(arrived, merge(time, arrived, over > threshold), arrived >= 0)
      arrival(i) = arrived
    end do
  end subroutine update_row

end module peak_maps
