!> Particles too few in their cell to make a wall of it: gas flows around them and drags them along, each a sphere of its own volume.
!>
!> The drag of a cell is implicit in the relative velocity, so that particles lighter than the gas around them end at its velocity
!> at most. Momentum is what the gas loses; the energy of the relative motion that this ends heats the gas.
module loose_particles
  use constants, only: pi
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use interface_cells, only: interface_list
  use kinds, only: wp
  use mesh, only: mesh_type
  use mixture, only: cell_fractions, close_cell
  use particles, only: at_mass
  use solid_state, only: solid_type
  implicit none
  private
  public :: list_loose, drag_loose

  real(wp), parameter :: drag_coefficient = 1 !< of rough fragments in fast flow

contains

  !> Adds to the list the open cells of a brick that hold particles and have no wall beside them. kind: types of the cells with ghost
  !> layers; closed_from: those of this kind or above are closed.
  subroutine list_loose(mesh, solid, b, kind, closed_from, list)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b
    real(wp), intent(in) :: kind(1 - mesh%ghost(1):, 1 - mesh%ghost(2):, 1 - mesh%ghost(3):), closed_from
    type(interface_list), intent(inout) :: list
    type(interface_list) :: loose
    integer :: i, j, k, n, pass
    list%n_loose = 0
    if (.not. allocated(solid%count(b)%a)) return
    do pass = 1, 2
      n = 0
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            if (.not. solid%count(b)%a(i, 1, j, k) > 0) cycle
            if (kind(i, j, k) > closed_from .or. beside_wall(i, j, k)) cycle
            n = n + 1
            if (pass == 1) cycle
            loose%cell(:, n) = [i, j, k]
            call measure(loose%mass(n), loose%area(n), loose%cell(:, n))
          end do
        end do
      end do
      if (n == 0) return
      if (pass == 1) allocate (loose%cell(3, n), loose%mass(n), loose%area(n))
    end do
    list%n_loose = n
    list%n = list%n + n
    list%cell = reshape([list%cell, loose%cell], [3, list%n])
    list%closed = reshape([list%closed, spread([0, 0, 0], 2, n)], [3, list%n])
    list%mass = loose%mass
    list%area = loose%area
    deallocate (list%velocity, list%impulse)
    allocate (list%velocity(3, list%n), list%impulse(3, list%n), source=0.0_wp)

  contains

    pure logical function beside_wall(i, j, k)
      integer, intent(in) :: i, j, k
      integer :: d, step(3)
      beside_wall = .false.
      do d = 1, 3
        if (.not. mesh%active(d)) cycle
        step = merge(1, 0, [1, 2, 3] == d)
        beside_wall = beside_wall .or. kind(i + step(1), j + step(2), k + step(3)) > closed_from &
                      .or. kind(i - step(1), j - step(2), k - step(3)) > closed_from
      end do
    end function beside_wall

    !> Mass of a cell's particles and the area that they turn to the gas; in the plane they are rods across it.
    subroutine measure(mass, area, c)
      real(wp), intent(out) :: mass, area
      integer, intent(in) :: c(3)
      integer :: set, q, cell
      real(wp) :: volume, depth
      cell = c(1) + mesh%brick_cells(1)*(c(2) - 1 + mesh%brick_cells(2)*(c(3) - 1))
      mass = 0
      area = 0
      depth = product(mesh%spacing, .not. mesh%active)
      do set = 1, solid%n_sets
        if (solid%block(set, b)%n == 0) cycle
        associate (blk => solid%block(set, b))
          do q = blk%cell_start(cell), blk%cell_start(cell + 1) - 1
            mass = mass + blk%f(q, at_mass)
            volume = blk%f(q, at_mass)/solid%material(set)%density
            if (mesh%dimensions == 3) then
              area = area + 0.25_wp*pi*(6*volume/pi)**(2.0_wp/3)
            else
              area = area + depth*sqrt(4*volume/(pi*depth))
            end if
          end do
        end associate
      end do
    end subroutine measure

  end subroutine list_loose

  !> What drag does in dt to the gas of the loose cells at the end of the list; the momentum goes to list%impulse. w: state of the
  !> flow; taken: energy that leaves the gas with it (summed up).
  subroutine drag_loose(layout, eos, ghost, dt, cell_volume, list, w, taken)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    integer, intent(in) :: ghost(3)
    real(wp), intent(in) :: dt, cell_volume
    type(interface_list), intent(inout) :: list
    real(wp), intent(inout) :: w(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(inout) :: taken
    real(wp) :: cell(layout%n_rows), a(layout%n_materials), v(3), relative(3), impulse(3), gas, reduced, rate, heat
    integer :: c, q, first
    first = layout%velocity_row
    do q = 1, list%n_loose
      c = list%n - list%n_loose + q
      associate (i => list%cell(1, c), j => list%cell(2, c), k => list%cell(3, c))
        cell = w(i, :layout%n_rows, j, k)
        v = cell(first:first + 2)
        relative = v - list%velocity(:, c)
        gas = cell_volume*cell(layout%density_row)
        reduced = gas*list%mass(q)/(gas + list%mass(q))
        rate = 0.5_wp*drag_coefficient*cell(layout%density_row)*list%area(q)*norm2(relative)/reduced
        impulse = reduced*relative*(rate*dt/(1 + rate*dt))
        cell(first:first + 2) = v - impulse/gas
        heat = 0.5_wp*gas*(sum(v**2) - sum(cell(first:first + 2)**2)) - sum(impulse*list%velocity(:, c))
        a = cell_fractions(layout, cell)
        cell(layout%pressure_row) = cell(layout%pressure_row) + max(heat, 0.0_wp)/(cell_volume*sum(a/eos%grueneisen))
        call close_cell(layout, eos, cell)
        w(i, :layout%n_rows, j, k) = cell
        list%impulse(:, c) = list%impulse(:, c) + impulse
        taken = taken + sum(impulse*list%velocity(:, c))
      end associate
    end do
  end subroutine drag_loose

end module loose_particles
