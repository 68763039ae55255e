!> The largest stable time step of the flow, and the cell that sets it.
module flow_time_step
  use flow_repair, only: cell_centre
  use flow_state, only: flow_type, most_common_states
  use kinds, only: wp
  use mesh, only: mesh_type
  use mixture, only: cell_fractions
  use reductions, only: reduce_max
  implicit none
  private
  public :: flow_limit

  type, public :: flow_limit_type
    real(wp) :: dt = huge(1.0_wp)
    integer :: cell(3) = 0 !< of the domain, from 1
    real(wp) :: position(3) = 0 !< of its centre
    integer :: material = 0 !< the one that fills most of it
    real(wp) :: speed = 0 !< fastest signal in it, |u| + c
    logical :: is_front = .false. !< what limits is no cell but the front of a detonation
  end type flow_limit_type

contains

  !> dt = cfl / max over the cells of the sum over the active directions of (|u| + c)/h, or of D/h while a detonation runs with
  !> speed D. The same on every rank.
  function flow_limit(mesh, flow) result(limit)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(flow_limit_type) :: limit
    real(wp) :: largest, found, companion(8), cell(flow%layout%n_rows), over_h(3)
    logical :: seen(mesh%n_local + most_common_states)
    integer :: b, i, j, k, at(3), fastest_row(4), n(3), ld, u, c, h
    largest = -1
    fastest_row = 0
    n = mesh%brick_cells
    over_h = merge(1/mesh%spacing, 0.0_wp, mesh%active)
    u = flow%layout%velocity_row
    c = flow%layout%sound_speed_row
    seen = .false.
    do b = 1, mesh%n_local
      h = flow%holder(b)
      if (seen(h)) cycle ! the same cells as those of an earlier brick
      seen(h) = .not. allocated(flow%open(b)%a)
      ld = size(flow%w(h, flow%current)%a, 1)
      do k = 1, n(3)
        do j = 1, n(2)
          if (allocated(flow%open(b)%a)) then
            found = fastest_open(n(1), ld, over_h, flow%w(h, flow%current)%a(1, u, j, k), &
              flow%w(h, flow%current)%a(1, c, j, k), flow%open(b)%a(1, 1, j, k))
          else
            found = fastest(n(1), ld, over_h, flow%w(h, flow%current)%a(1, u, j, k), flow%w(h, flow%current)%a(1, c, j, k))
          end if
          if (.not. found > largest) cycle
          largest = found
          fastest_row = [0, j, k, b]
        end do
      end do
    end do
    companion = 0
    if (fastest_row(4) > 0) then
      b = fastest_row(4)
      do i = 1, n(1)
        cell = flow%w(flow%holder(b), flow%current)%a(i, :, fastest_row(2), fastest_row(3))
        if (signal_rate(cell) < largest) cycle
        if (allocated(flow%open(b)%a)) then
          if (.not. flow%open(b)%a(i, 1, fastest_row(2), fastest_row(3)) > 0) cycle
        end if
        at = [i, fastest_row(2), fastest_row(3)]
        companion = [cell_centre(mesh, b, at), real(mesh%brick(mesh%local(b))%location*n + at, wp), &
          real(maxloc(cell_fractions(flow%layout, cell), dim=1), wp), &
          maxval(abs(cell(flow%layout%velocity_row:flow%layout%velocity_row + 2))) + cell(flow%layout%sound_speed_row)]
        exit
      end do
    end if
    call reduce_max(largest, companion)
    if (largest > 0) limit%dt = flow%cfl/largest
    limit%position = companion(1:3)
    limit%cell = nint(companion(4:6))
    limit%material = nint(companion(7))
    limit%speed = companion(8)
    if (.not. flow%burn_speed > 0 .or. flow%time > flow%burn_end) return
    if (flow%burn_speed*sum(over_h) > largest) then
      limit%is_front = .true.
      limit%speed = flow%burn_speed
      limit%dt = flow%cfl/(flow%burn_speed*sum(over_h))
    end if
  contains
    pure real(wp) function signal_rate(cell)
      real(wp), intent(in) :: cell(:)
      associate (u => cell(flow%layout%velocity_row:flow%layout%velocity_row + 2), c => cell(flow%layout%sound_speed_row))
        signal_rate = (abs(u(1)) + c)*over_h(1) + (abs(u(2)) + c)*over_h(2) + (abs(u(3)) + c)*over_h(3)
      end associate
    end function signal_rate
  end function flow_limit

  pure real(wp) function fastest(n, ld, over_h, u, c)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: over_h(3), u(ld, *), c(*)
    integer :: i
    fastest = 0
    !$omp simd reduction(max:fastest)
    do i = 1, n
      fastest = max(fastest, (abs(u(i, 1)) + c(i))*over_h(1) + (abs(u(i, 2)) + c(i))*over_h(2) &
        + (abs(u(i, 3)) + c(i))*over_h(3))
    end do
  end function fastest

  pure real(wp) function fastest_open(n, ld, over_h, u, c, open) result(fastest)
    integer, intent(in) :: n, ld
    real(wp), intent(in) :: over_h(3), u(ld, *), c(*), open(*)
    integer :: i
    fastest = 0
    !$omp simd reduction(max:fastest)
    do i = 1, n
      fastest = max(fastest, merge(1.0_wp, 0.0_wp, open(i) > 0)*((abs(u(i, 1)) + c(i))*over_h(1) &
        + (abs(u(i, 2)) + c(i))*over_h(2) + (abs(u(i, 3)) + c(i))*over_h(3)))
    end do
  end function fastest_open

end module flow_time_step
