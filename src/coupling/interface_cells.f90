!> Work on the interface cells of one brick: the velocity that the solid imposes on them, the momentum that this takes from
!> the fluid, and the pressure on the closed faces behind them (paper eqs. 29-33).
module interface_cells
  use kinds, only: wp
  implicit none
  private
  public :: list_interface, force_velocity, add_wall_impulse, spread_force

  !> The interface cells of a brick, in the order of the cells.
  type, public :: interface_list
    integer :: n = 0
    integer, allocatable :: cell(:, :) !< (3, n) indices in the brick
    integer, allocatable :: closed(:, :) !< (3, n) closed faces per direction: those at the high side less those at the low side
    real(wp), allocatable :: velocity(:, :) !< (3, n) of the solid at the centre
    real(wp), allocatable :: impulse(:, :) !< (3, n) momentum given to the solid during the step
  end type interface_list

contains

  !> Lists the interface cells. kind: with ghost layers, see cell_types; behind: kind of the cells that lie behind closed faces:
  !> inside cells where the interface cells flow, else fluid.
  subroutine list_interface(n, ghost, kind, interface_kind, behind, list)
    integer, intent(in) :: n(3), ghost(3)
    real(wp), intent(in) :: kind(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(in) :: interface_kind, behind
    type(interface_list), intent(inout) :: list
    integer :: i, j, k, c, sign
    real(wp), parameter :: half = 0.5_wp
    sign = merge(1, -1, behind > interface_kind) ! an interface cell feels what is inside on its high side, or open on its low side
    list%n = count(abs(kind(1:n(1), 1:n(2), 1:n(3)) - interface_kind) < half)
    if (allocated(list%cell)) deallocate (list%cell, list%closed, list%velocity, list%impulse)
    allocate (list%cell(3, list%n), list%closed(3, list%n))
    allocate (list%velocity(3, list%n), list%impulse(3, list%n), source=0.0_wp)
    c = 0
    do k = 1, n(3)
      do j = 1, n(2)
        do i = 1, n(1)
          if (abs(kind(i, j, k) - interface_kind) >= half) cycle
          c = c + 1
          list%cell(:, c) = [i, j, k]
          list%closed(:, c) = 0
          if (ghost(1) > 0) list%closed(1, c) = step(kind(i + 1, j, k)) - step(kind(i - 1, j, k))
          if (ghost(2) > 0) list%closed(2, c) = step(kind(i, j + 1, k)) - step(kind(i, j - 1, k))
          if (ghost(3) > 0) list%closed(3, c) = step(kind(i, j, k + 1)) - step(kind(i, j, k - 1))
          list%closed(:, c) = sign*list%closed(:, c)
        end do
      end do
    end do

  contains

    pure integer function step(neighbour)
      real(wp), intent(in) :: neighbour
      step = merge(1, 0, abs(neighbour - behind) < half)
    end function step

  end subroutine list_interface

  !> Sets the fluid velocity in the interface cells to the solid's; what momentum this takes goes to the solid.
  !> w: fluid state (x, variable, y, z) with ghost layers; partial densities first; at_velocity: index of the first velocity;
  !> weight: share of this stage in the step (1/6, 2/3, 1; 1 before the first stage). The pressure stays.
  !> kinetic: kinetic energy that the fluid lost by it (summed up).
  subroutine force_velocity(n_materials, at_velocity, ghost, weight, cell_volume, list, w, kinetic)
    integer, intent(in) :: n_materials, at_velocity, ghost(3)
    real(wp), intent(in) :: weight, cell_volume
    type(interface_list), intent(inout) :: list
    real(wp), intent(inout) :: w(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(inout) :: kinetic
    integer :: c, i, j, k
    real(wp) :: mass, v(3)
    do c = 1, list%n
      i = list%cell(1, c); j = list%cell(2, c); k = list%cell(3, c)
      mass = weight*cell_volume*sum(w(i, 1:n_materials, j, k))
      v = w(i, at_velocity:at_velocity + 2, j, k)
      list%impulse(:, c) = list%impulse(:, c) + mass*(v - list%velocity(:, c))
      kinetic = kinetic + 0.5_wp*mass*(sum(v**2) - sum(list%velocity(:, c)**2))
      w(i, at_velocity:at_velocity + 2, j, k) = list%velocity(:, c)
    end do
  end subroutine force_velocity

  !> Adds what the closed faces of interface cells took from the flow, less the impulse of the reference pressure, which the solid
  !> does not feel since its stress is counted from there.
  !> wall: momentum (3) that closed cells received, in the open cell beside them; pressure_impulse: reference pressure times duration
  !> times the area of a face, by direction; reference: what was left out (summed up).
  subroutine add_wall_impulse(ghost, wall, pressure_impulse, list, reference)
    integer, intent(in) :: ghost(3)
    real(wp), intent(in) :: wall(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(in) :: pressure_impulse(3)
    type(interface_list), intent(inout) :: list
    real(wp), intent(inout) :: reference(3)
    integer :: c
    do c = 1, list%n
      list%impulse(:, c) = list%impulse(:, c) + (wall(list%cell(1, c), 1:3, list%cell(2, c), list%cell(3, c)) &
                                                 - pressure_impulse*list%closed(:, c))
      reference = reference + pressure_impulse*list%closed(:, c)
    end do
  end subroutine add_wall_impulse

  !> Force on the solid in each cell of a brick: the impulse over the time that it took. force: three variables, no ghosts.
  subroutine spread_force(list, duration, force)
    type(interface_list), intent(in) :: list
    real(wp), intent(in) :: duration
    real(wp), intent(inout) :: force(:, :, :, :)
    integer :: c
    force = 0
    do c = 1, list%n
      force(list%cell(1, c), 1:3, list%cell(2, c), list%cell(3, c)) = list%impulse(:, c)/duration
    end do
  end subroutine spread_force

end module interface_cells
