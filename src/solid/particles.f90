!> Particles of one material in one brick: a structure of arrays, always sorted by (cell, id).
!>
!> The order never depends on ranks or on history, so every sum over the particles of a cell has the same bits wherever it is made.
module particles
  use kinds, only: wp
  implicit none
  private
  public :: allocate_particles, reserve_particles, note_moved, append_particle, sort_particles, cell_of_particle

  integer, parameter, public :: at_position = 1 !< first of 3 columns: position
  integer, parameter, public :: at_velocity = 4 !< first of 3 columns: velocity
  integer, parameter, public :: at_mass = 7 !< mass, constant
  integer, parameter, public :: at_volume = 8 !< present volume
  integer, parameter, public :: at_stress = 9 !< first of 6 columns: Cauchy stress xx, yy, zz, yz, xz, xy (tension positive)
  integer, parameter, public :: at_energy = 15 !< internal energy of the particle (not per mass)
  integer, parameter, public :: at_viscosity = 16 !< bulk viscosity, a pressure that acts beside the stress
  integer, parameter, public :: at_plastic_strain = 17 !< equivalent plastic strain
  integer, parameter, public :: at_damage = 18 !< damage, 0 sound to 1
  integer, parameter, public :: at_plastic_work = 19 !< plastic work of the particle (an energy)
  integer, parameter, public :: n_fields_basic = 19 !< columns that every particle has; what a material needs besides follows them
  !> Columns of the loads that the flow makes on the surface, where a material has them.
  integer, parameter, public :: load_overpressure = 0, load_peak = 1, load_impulse = 2, load_arrival = 3
  integer, parameter, public :: n_load_columns = 4
  real(wp), parameter, public :: load_not_wetted = -2, load_not_reached = -1 !< values of load_arrival
  !> Names of the columns, for output and restart.
  character(16), parameter, public :: field_name(n_fields_basic) = [character(16) :: &
    'position_x', 'position_y', 'position_z', 'velocity_x', 'velocity_y', 'velocity_z', 'mass', 'volume', &
    'stress_xx', 'stress_yy', 'stress_zz', 'stress_yz', 'stress_xz', 'stress_xy', 'internal_energy', 'viscosity', &
    'plastic_strain', 'damage', 'plastic_work']

  !> Particles of one set (material) in one brick.
  type, public :: particle_block
    integer :: n = 0 !< particles held
    integer :: capacity = 0 !< room of the arrays
    integer, allocatable :: id(:) !< global number, unique in the scene
    integer, allocatable :: body(:) !< body it belongs to
    real(wp), allocatable :: f(:, :) !< (capacity, n_field) columns at_*
    integer, allocatable :: cell_start(:) !< (n_cells + 1) first particle of each cell of the brick, x fastest
    integer :: n_moved = 0 !< particles that wait for the next sort
    integer, allocatable :: moved_index(:) !< their indices, ascending
    integer, allocatable :: moved_cell(:) !< their new cells; 0: gone from this brick
  end type particle_block

  !> Work space of sort_particles, kept between sorts because fresh memory costs more than the sort itself.
  type, public :: sort_space
    private
    integer :: n_runs = 0
    integer, allocatable :: from(:), to(:), length(:) !< runs of particles that move together
    integer, allocatable :: integers(:)
    real(wp), allocatable :: column(:)
  end type sort_space

contains

  !> An empty block for n_cells cells and n_field columns.
  subroutine allocate_particles(block, n_cells, n_field)
    type(particle_block), intent(inout) :: block
    integer, intent(in) :: n_cells, n_field
    block%n = 0
    block%capacity = 0
    block%n_moved = 0
    allocate (block%id(0), block%body(0), block%f(0, n_field), block%moved_index(0), block%moved_cell(0))
    allocate (block%cell_start(n_cells + 1), source=1)
  end subroutine allocate_particles

  !> Makes room for at least n particles; the contents stay.
  subroutine reserve_particles(block, n)
    type(particle_block), intent(inout) :: block
    integer, intent(in) :: n
    integer :: capacity
    integer, allocatable :: integers(:)
    real(wp), allocatable :: reals(:, :)
    if (n <= block%capacity) return
    capacity = (max(n + n/8, 64)/8 + 1)*8
    allocate (integers(capacity), source=0)
    integers(:block%n) = block%id(:block%n)
    call move_alloc(integers, block%id)
    allocate (integers(capacity), source=0)
    integers(:block%n) = block%body(:block%n)
    call move_alloc(integers, block%body)
    allocate (reals(capacity, size(block%f, 2)), source=0.0_wp)
    reals(:block%n, :) = block%f(:block%n, :)
    call move_alloc(reals, block%f)
    block%capacity = capacity
  end subroutine reserve_particles

  !> Notes that particle index belongs in another cell (0: that it leaves the brick). Indices must come in ascending order.
  subroutine note_moved(block, index, cell)
    type(particle_block), intent(inout) :: block
    integer, intent(in) :: index, cell
    integer, allocatable :: longer(:)
    integer :: n
    n = block%n_moved
    if (n == size(block%moved_index)) then
      allocate (longer(2*n + 64), source=0)
      longer(:n) = block%moved_index(:n)
      call move_alloc(longer, block%moved_index)
      allocate (longer(2*n + 64), source=0)
      longer(:n) = block%moved_cell(:n)
      call move_alloc(longer, block%moved_cell)
    end if
    block%n_moved = n + 1
    block%moved_index(n + 1) = index
    block%moved_cell(n + 1) = cell
  end subroutine note_moved

  !> Adds a particle that arrives in a cell; it takes its place in the next sort. All note_moved calls for resident particles
  !> come first.
  subroutine append_particle(block, id, body, fields, cell)
    type(particle_block), intent(inout) :: block
    integer, intent(in) :: id, body, cell
    real(wp), intent(in) :: fields(:)
    call reserve_particles(block, block%n + 1)
    block%n = block%n + 1
    block%id(block%n) = id
    block%body(block%n) = body
    block%f(block%n, :) = fields
    call note_moved(block, block%n, cell)
  end subroutine append_particle

  !> Puts the block in (cell, id) order again after note_moved and append_particle; does nothing when nothing moved.
  !>
  !> Resident particles keep their order, so only the moved ones are sorted (counting sort by cell, insertion by id) and merged in;
  !> the columns are then moved by runs, and runs that stay in place are not touched.
  subroutine sort_particles(block, space)
    type(particle_block), intent(inout) :: block
    type(sort_space), intent(inout) :: space
    integer :: total
    if (block%n_moved == 0) return
    call list_runs(block, space, total)
    call move_runs(block, space)
    block%n = total
    block%n_moved = 0
  end subroutine sort_particles

  !> The new order as runs of old indices; block%cell_start is that of the new order on return. total: particles that remain.
  subroutine list_runs(block, space, total)
    type(particle_block), intent(inout) :: block
    type(sort_space), intent(inout) :: space
    integer, intent(out) :: total
    integer, allocatable :: arriving(:), first(:)
    integer :: n_cells, n_resident, cell, leaving, position, source, stop_at, start
    n_cells = size(block%cell_start) - 1
    n_resident = block%cell_start(n_cells + 1) - 1
    call sort_arrivals(block, n_cells, arriving, first)
    space%n_runs = 0
    leaving = 1
    total = 0
    stop_at = 1
    do cell = 1, n_cells
      source = stop_at
      stop_at = block%cell_start(cell + 1)
      position = first(cell)
      start = total + 1
      do while (source < stop_at .or. position < first(cell + 1))
        if (source < stop_at .and. position == first(cell + 1)) then
          ! nothing arrives (any more): all up to the next one that leaves
          if (next_leaving() >= stop_at) then
            call add_run(space, total, source, stop_at - source)
            source = stop_at
            cycle
          end if
        end if
        if (source < stop_at .and. next_leaving() == source) then
          source = source + 1
          leaving = leaving + 1
        else if (position == first(cell + 1)) then
          call add_run(space, total, source, 1)
          source = source + 1
        else if (source == stop_at) then
          call add_run(space, total, arriving(position), 1)
          position = position + 1
        else if (block%id(arriving(position)) < block%id(source)) then
          call add_run(space, total, arriving(position), 1)
          position = position + 1
        else
          call add_run(space, total, source, 1)
          source = source + 1
        end if
      end do
      block%cell_start(cell) = start
    end do
    block%cell_start(n_cells + 1) = total + 1

  contains

    pure integer function next_leaving()
      next_leaving = huge(next_leaving)
      if (leaving <= block%n_moved) then
        if (block%moved_index(leaving) <= n_resident) next_leaving = block%moved_index(leaving)
      end if
    end function next_leaving

  end subroutine list_runs

  !> Adds particles from, from + 1, ... to the new order; they lengthen the last run if they follow it.
  subroutine add_run(space, total, from, length)
    type(sort_space), intent(inout) :: space
    integer, intent(inout) :: total
    integer, intent(in) :: from, length
    integer :: n
    n = space%n_runs
    if (.not. allocated(space%from)) allocate (space%from(64), space%to(64), space%length(64))
    if (n > 0) then
      if (space%from(n) + space%length(n) == from) then
        space%length(n) = space%length(n) + length
        total = total + length
        return
      end if
    end if
    if (n == size(space%from)) then
      call lengthen(space%from, 2*n)
      call lengthen(space%to, 2*n)
      call lengthen(space%length, 2*n)
    end if
    space%n_runs = n + 1
    space%from(n + 1) = from
    space%to(n + 1) = total + 1
    space%length(n + 1) = length
    total = total + length
  end subroutine add_run

  subroutine lengthen(list, n)
    integer, allocatable, intent(inout) :: list(:)
    integer, intent(in) :: n
    integer, allocatable :: longer(:)
    allocate (longer(n), source=0)
    longer(:size(list)) = list
    call move_alloc(longer, list)
  end subroutine lengthen

  !> Brings all columns into the order of the runs.
  subroutine move_runs(block, space)
    type(particle_block), intent(inout) :: block
    type(sort_space), intent(inout) :: space
    integer :: low, high, i, k
    low = huge(low)
    high = 0
    do k = 1, space%n_runs
      if (space%from(k) == space%to(k)) cycle
      low = min(low, space%from(k), space%to(k))
      high = max(high, max(space%from(k), space%to(k)) + space%length(k) - 1)
    end do
    if (high == 0) return
    if (allocated(space%column)) then
      if (size(space%column) < block%capacity) deallocate (space%column, space%integers)
    end if
    if (.not. allocated(space%column)) allocate (space%column(block%capacity), space%integers(block%capacity))
    call place_integers(space, low, high, block%id)
    call place_integers(space, low, high, block%body)
    do i = 1, size(block%f, 2)
      space%column(low:high) = block%f(low:high, i)
      do k = 1, space%n_runs
        if (space%from(k) == space%to(k)) cycle
        block%f(space%to(k):space%to(k) + space%length(k) - 1, i) = space%column(space%from(k):space%from(k) + space%length(k) - 1)
      end do
    end do
  end subroutine move_runs

  subroutine place_integers(space, low, high, values)
    type(sort_space), intent(inout) :: space
    integer, intent(in) :: low, high
    integer, intent(inout) :: values(:)
    integer :: k
    space%integers(low:high) = values(low:high)
    do k = 1, space%n_runs
      if (space%from(k) == space%to(k)) cycle
      values(space%to(k):space%to(k) + space%length(k) - 1) = space%integers(space%from(k):space%from(k) + space%length(k) - 1)
    end do
  end subroutine place_integers

  !> Indices of the moved particles that stay in this brick, in (cell, id) order; first(cell) is where a cell's list starts.
  subroutine sort_arrivals(block, n_cells, arriving, first)
    type(particle_block), intent(in) :: block
    integer, intent(in) :: n_cells
    integer, allocatable, intent(out) :: arriving(:), first(:)
    integer :: i, j, cell, index
    integer, allocatable :: fill(:)
    allocate (first(n_cells + 1), fill(n_cells), source=0)
    do i = 1, block%n_moved
      cell = block%moved_cell(i)
      if (cell > 0) first(cell + 1) = first(cell + 1) + 1
    end do
    first(1) = 1
    do cell = 1, n_cells
      first(cell + 1) = first(cell + 1) + first(cell)
    end do
    allocate (arriving(first(n_cells + 1) - 1))
    do i = 1, block%n_moved
      cell = block%moved_cell(i)
      if (cell == 0) cycle
      index = block%moved_index(i)
      j = first(cell) + fill(cell)
      do while (j > first(cell))
        if (block%id(arriving(j - 1)) < block%id(index)) exit
        arriving(j) = arriving(j - 1)
        j = j - 1
      end do
      arriving(j) = index
      fill(cell) = fill(cell) + 1
    end do
  end subroutine sort_arrivals

  !> The cell of the brick that holds particle index, by bisection of cell_start.
  pure integer function cell_of_particle(block, index) result(cell)
    type(particle_block), intent(in) :: block
    integer, intent(in) :: index
    integer :: high, middle
    cell = 1
    high = size(block%cell_start)
    do while (high - cell > 1)
      middle = (cell + high)/2
      if (block%cell_start(middle) <= index) then
        cell = middle
      else
        high = middle
      end if
    end do
  end function cell_of_particle

end module particles
