!> The immersed boundary between flow and solid: continuous forcing by a Lagrange multiplier, lg-CFIBM (paper section 3.2).
!>
!> In a step: immerse_solid finds the cell types and answers for gas that was covered or uncovered; wall velocities come from the
!> nodes; then each Runge-Kutta stage is followed by force_stage; collect_force turns the impulse, that of the pressure on closed
!> faces included, into the force that the solid step applies. The momentum that the fluid loses is what the solid gets, to
!> round-off.
!> Inside cells hold no flow and their faces are closed; their gas is booked out when they are covered, and a cell that becomes
!> open again is built from its open neighbours and booked in.
module immersed_boundary
  use blocks, only: block, allocate_cells
  use cell_functions, only: cell_frame
  use cell_types, only: classify_cells, mirror_ghosts, fluid_cell, interface_cell, inside_cell
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use flow_state, only: flow_type
  use halo, only: halo_type, fill
  use interface_cells, only: interface_list, list_interface, force_velocity, add_wall_impulse, &
    spread_force
  use kinds, only: wp
  use light_walls, only: ease_light_walls
  use loose_particles, only: list_loose, drag_loose
  use mesh, only: mesh_type
  use mixture, only: cell_energies, cell_fractions, close_cell
  use reductions, only: any_rank, reduce_sum
  use sleeping_bricks, only: is_asleep, wake
  use solid_cover, only: cover_cells, smooth_part, wall_normals
  use solid_load, only: cell_velocity
  use solid_reach, only: near_solid
  use solid_state, only: solid_type, frame_of
  implicit none
  private
  public :: start_coupling, restore_coupling, release_coupling, immerse_solid, hold_solid, find_wall_velocity, force_first_state, &
    force_stage, collect_force

  integer, parameter, public :: booked_impulse = 1 !< first of 3: momentum given to the solid
  integer, parameter, public :: booked_reference = 4 !< first of 3: impulse of the reference pressure on closed faces
  integer, parameter, public :: booked_kinetic = 7 !< energy taken from the fluid by forcing and by drag
  integer, parameter, public :: booked_uncovered = 8 !< cells opened
  integer, parameter, public :: booked_covered = 9 !< cells closed
  integer, parameter, public :: booked_gas = 10 !< first of n_conserved: gas that uncovering added less what covering took away

  !> Weights in the step of what is done to the state after each stage.
  real(wp), parameter :: state_weight(3) = [1.0_wp/6, 2.0_wp/3, 1.0_wp]

  !> State of the coupling.
  type, public :: coupling_type
    logical :: active = .false.
    real(wp) :: reference_pressure = 0 !< pressure that the solid does not feel: its stress is counted from there
    real(wp) :: face(3) = 1 !< area of cell faces by direction
    logical, allocatable :: near(:) !< local bricks that the solid concerns, now or in the step before; others have but kind
    logical, allocatable :: near_now(:)
    type(block), allocatable :: occupancy(:) !< particles in each cell
    type(block), allocatable :: kind(:), kind_before(:) !< cell types now and in the step before
    type(interface_list), allocatable :: list(:) !< interface cells of each local brick
    type(block), allocatable :: force(:) !< (3 variables) force on the solid by cell; unallocated where there is no interface
    real(wp), allocatable :: partial(:, :) !< (booked_*, local brick) of this step
    real(wp), allocatable :: books(:) !< (booked_*) since the start, all bricks
    logical :: started = .false. !< cell types of an earlier step are known
    logical :: moving_wall = .false. !< interface cells are closed and their faces are walls that move; else lg-CFIBM
    real(wp) :: closed_from = 0.5_wp*(interface_cell + inside_cell) !< cells of this kind or above hold no flow
    type(block), allocatable :: solid_part(:) !< part of each cell that is solid, for walls that move
  end type coupling_type

contains

  !> Allocates the coupling of a scene that has both flow and solid.
  subroutine start_coupling(coupling, mesh, flow, reference_pressure, moving_wall)
    type(coupling_type), intent(out) :: coupling
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: reference_pressure
    logical, intent(in) :: moving_wall
    integer :: b, n_books
    coupling%active = .true.
    coupling%reference_pressure = reference_pressure
    coupling%moving_wall = moving_wall
    if (moving_wall) coupling%closed_from = 0.5_wp*(fluid_cell + interface_cell)
    coupling%face = mesh%cell_volume/mesh%spacing
    allocate (coupling%occupancy(mesh%n_local), coupling%kind(mesh%n_local), coupling%kind_before(mesh%n_local))
    allocate (coupling%list(mesh%n_local), coupling%force(mesh%n_local), coupling%solid_part(mesh%n_local))
    do b = 1, mesh%n_local
      call allocate_cells(coupling%kind(b), mesh%brick_cells, mesh%ghost, 1, fluid_cell)
    end do
    allocate (coupling%near(mesh%n_local), coupling%near_now(mesh%n_local), source=.false.)
    n_books = booked_gas - 1 + flow%layout%n_conserved
    allocate (coupling%partial(n_books, mesh%n_local), coupling%books(n_books), source=0.0_wp)
  end subroutine start_coupling

  !> Closes the inside cells again after a restart has brought back the cell types.
  subroutine restore_coupling(mesh, flow, coupling)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer :: b
    coupling%started = .true.
    do b = 1, mesh%n_local
      coupling%near_now(b) = any(coupling%kind(b)%a > fluid_cell)
      call close_cells(mesh, coupling%kind(b), coupling%closed_from, coupling%moving_wall, flow%open(b), flow%wall_impulse(b), &
                       flow%wall(b))
    end do
  end subroutine restore_coupling

  !> Gives the memory of a coupling back that is needed no more; the books stay.
  subroutine release_coupling(coupling)
    type(coupling_type), intent(inout) :: coupling
    deallocate (coupling%occupancy, coupling%kind, coupling%kind_before, coupling%list, coupling%force, coupling%solid_part, &
                coupling%near, coupling%near_now)
  end subroutine release_coupling

  !> Gives arrays to the bricks that the solid concerns and takes them from the others.
  subroutine follow_solid(mesh, solid, coupling)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(coupling_type), intent(inout) :: coupling
    logical :: before(mesh%n_local)
    integer :: b
    before = coupling%near_now
    coupling%near_now = near_solid(mesh, solid)
    coupling%near = coupling%near_now .or. before
    do b = 1, mesh%n_local
      if (coupling%near(b) .eqv. allocated(coupling%occupancy(b)%a)) cycle
      if (coupling%near(b)) then
        call allocate_cells(coupling%occupancy(b), mesh%brick_cells, mesh%ghost, 1, 0.0_wp)
        call allocate_cells(coupling%kind_before(b), mesh%brick_cells, mesh%ghost, 1, fluid_cell)
        if (coupling%moving_wall) call allocate_cells(coupling%solid_part(b), mesh%brick_cells, mesh%ghost, 1, 0.0_wp)
      else
        deallocate (coupling%occupancy(b)%a, coupling%kind_before(b)%a)
        if (coupling%moving_wall) deallocate (coupling%solid_part(b)%a)
        coupling%list(b)%n = 0
        coupling%list(b)%n_loose = 0
      end if
    end do
  end subroutine follow_solid

  !> Finds the cell types from the particles, closes the cells inside, and lists the interface.
  subroutine immerse_solid(mesh, halo, solid, flow, coupling)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(in) :: solid
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer :: b
    logical :: opened(mesh%n_local)
    coupling%partial = 0
    call follow_solid(mesh, solid, coupling)
    do b = 1, mesh%n_local
      if (.not. coupling%near(b)) cycle
      if (coupling%moving_wall) then
        call cover_cells(mesh, solid, b, coupling%solid_part(b), coupling%occupancy(b))
      else
        call copy_counts(mesh%brick_cells, solid%count(b), coupling%occupancy(b))
      end if
      if (coupling%started) coupling%kind_before(b)%a = coupling%kind(b)%a
    end do
    call classify_cells(mesh, halo, coupling%occupancy, coupling%kind)
    if (coupling%started) then
      do b = 1, mesh%n_local
        opened(b) = .false.
        if (.not. coupling%near(b)) cycle
        opened(b) = any(coupling%kind_before(b)%a > coupling%closed_from .and. &
                        coupling%kind(b)%a < coupling%closed_from)
        if (any(abs(coupling%kind_before(b)%a - coupling%kind(b)%a) > 0)) call wake(flow, b)
      end do
      if (any_rank(any(opened))) call fill(mesh, halo, flow%w(:, flow%current), flow%layout%n_rows, only_faces=.true., &
                                           unread=.not. opened)
      do b = 1, mesh%n_local
        if (coupling%near(b) .and. .not. is_asleep(flow, b)) call answer_for_gas(mesh, solid, flow, coupling, b)
      end do
    end if
    coupling%started = .true.
    do b = 1, mesh%n_local
      if (.not. coupling%near(b)) cycle
      call close_cells(mesh, coupling%kind(b), coupling%closed_from, coupling%moving_wall, flow%open(b), flow%wall_impulse(b), &
                       flow%wall(b))
      call list_interface(mesh%brick_cells, mesh%ghost, coupling%kind(b)%a(:, 1, :, :), interface_cell, &
                          merge(fluid_cell, inside_cell, coupling%moving_wall), coupling%list(b))
      if (coupling%moving_wall) call list_loose(mesh, solid, b, coupling%kind(b)%a(:, 1, :, :), coupling%closed_from, &
                                                coupling%list(b))
      flow%kept_awake(b) = coupling%list(b)%n > 0
      if (flow%kept_awake(b)) call wake(flow, b)
    end do
  end subroutine immerse_solid

  !> Particle counts of one brick in a block that has ghosts; a brick without particles has no counts.
  subroutine copy_counts(n, counts, occupancy)
    integer, intent(in) :: n(3)
    type(block), intent(in) :: counts
    type(block), intent(inout) :: occupancy
    if (allocated(counts%a)) then
      occupancy%a(1:n(1), 1, 1:n(2), 1:n(3)) = counts%a(1:n(1), 1, 1:n(2), 1:n(3))
    else
      occupancy%a = 0
    end if
  end subroutine copy_counts

  !> flow%open of one brick: 0 in closed cells, 1 elsewhere; unallocated where no cell or ghost is closed. Walls start from nil.
  !> moving: they have velocities and normals, to be set.
  subroutine close_cells(mesh, kind, closed_from, moving, open, wall_impulse, wall)
    type(mesh_type), intent(in) :: mesh
    type(block), intent(in) :: kind
    real(wp), intent(in) :: closed_from
    logical, intent(in) :: moving
    type(block), intent(inout) :: open, wall_impulse, wall
    if (any(kind%a > closed_from)) then
      if (.not. allocated(open%a)) then
        call allocate_cells(open, mesh%brick_cells, mesh%ghost, 1, 1.0_wp)
        call allocate_cells(wall_impulse, mesh%brick_cells, mesh%ghost, 3, 0.0_wp)
        if (moving) call allocate_cells(wall, mesh%brick_cells, mesh%ghost, 12, 0.0_wp)
      end if
      open%a = merge(0.0_wp, 1.0_wp, kind%a > closed_from)
      wall_impulse%a = 0
    else if (allocated(open%a)) then
      deallocate (open%a, wall_impulse%a)
      if (moving) deallocate (wall%a)
    end if
  end subroutine close_cells

  !> Books out the gas of cells that became inside cells; cells that are open again get the mean state of their face neighbours
  !> that were open before, and are booked in. Without such a neighbour the gas that was closed in comes out again.
  subroutine answer_for_gas(mesh, solid, flow, coupling, b)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer, intent(in) :: b
    integer :: i, j, k
    logical :: was_inside, is_inside
    real(wp) :: cell(flow%layout%n_rows), outward(3)
    associate (w => flow%w(b, flow%current)%a, before => coupling%kind_before(b)%a, now => coupling%kind(b)%a, &
               n => mesh%brick_cells)
      do k = 1, n(3)
        do j = 1, n(2)
          do i = 1, n(1)
            was_inside = before(i, 1, j, k) > coupling%closed_from
            is_inside = now(i, 1, j, k) > coupling%closed_from
            if (was_inside .eqv. is_inside) cycle
            if (is_inside) then
              call book_gas(i, j, k, -1.0_wp)
              coupling%partial(booked_covered, b) = coupling%partial(booked_covered, b) + 1
            else
              call mean_of_neighbours(mesh%active, mesh%ghost, flow%layout%n_rows, coupling%closed_from, coupling%moving_wall, &
                                      i, j, k, before(:, 1, :, :), now(:, 1, :, :), w, outward)
              cell = w(i, :flow%layout%n_rows, j, k)
              call close_cell(flow%layout, flow%eos, cell)
              if (coupling%moving_wall .and. solid_beside(solid, b, [i, j, k])) call follow_wall(flow%layout, flow%eos, &
                cell_velocity(solid, frame_of(mesh, solid%order, b), b, [i, j, k]), outward, cell)
              w(i, :flow%layout%n_rows, j, k) = cell
              call book_gas(i, j, k, 1.0_wp)
              coupling%partial(booked_uncovered, b) = coupling%partial(booked_uncovered, b) + 1
            end if
          end do
        end do
      end do
    end associate

  contains

    !> Masses, momentum and energy of a cell.
    subroutine book_gas(i, j, k, sign)
      integer, intent(in) :: i, j, k
      real(wp), intent(in) :: sign
      real(wp) :: content(flow%layout%n_conserved), v(3), density
      associate (w => flow%w(b, flow%current)%a(i, :, j, k), layout => flow%layout)
        density = sum(w(:layout%n_materials))
        v = w(layout%velocity(1):layout%velocity(3))
        content(:layout%n_materials) = w(:layout%n_materials)
        content(layout%momentum_flux:layout%momentum_flux + 2) = density*v
        content(layout%energy_flux) = sum(cell_energies(layout, flow%eos, w)) + 0.5_wp*density*sum(v**2)
      end associate
      coupling%partial(booked_gas:, b) = coupling%partial(booked_gas:, b) + sign*mesh%cell_volume*content
    end subroutine book_gas

  end subroutine answer_for_gas

  !> True if a node of the cell has mass: the solid that has left it is still beside it.
  pure logical function solid_beside(solid, b, cell)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b, cell(3)
    integer :: field, last(3)
    solid_beside = .false.
    do field = 1, solid%n_fields
      if (.not. allocated(solid%node(field, b)%a)) cycle
      associate (mass => solid%node(field, b)%a(:, 1, :, :))
        last = min(cell + 1, shape(mass)) ! the first node has the index 1 here
        solid_beside = solid_beside .or. any(mass(cell(1):last(1), cell(2):last(2), cell(3):last(3)) > 0)
      end associate
    end do
  end function solid_beside

  !> Sets the state of a cell to the mean of those face neighbours that were open before. one_sided: leave out one that is closed
  !> now where that opposite was and is open, since what a wall of one cell covers as it leaves this cell lies on its other side.
  !> outward: sum of the directions from them to the cell.
  subroutine mean_of_neighbours(active, ghost, n_rows, closed_from, one_sided, i, j, k, before, now, w, outward)
    logical, intent(in) :: active(3), one_sided
    integer, intent(in) :: ghost(3), n_rows, i, j, k
    real(wp), intent(in) :: closed_from
    real(wp), intent(in), dimension(1 - ghost(1):, 1 - ghost(2):, 1 - ghost(3):) :: before, now
    real(wp), intent(inout) :: w(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(out) :: outward(3)
    real(wp) :: mean(n_rows)
    integer :: d, side, n, c(3)
    mean = 0
    outward = 0
    n = 0
    do d = 1, 3
      if (.not. active(d)) cycle
      do side = -1, 1, 2
        c = [i, j, k]
        c(d) = c(d) + side
        if (before(c(1), c(2), c(3)) > closed_from) cycle
        if (one_sided .and. now(c(1), c(2), c(3)) > closed_from) then
          c(d) = c(d) - 2*side
          if (max(before(c(1), c(2), c(3)), now(c(1), c(2), c(3))) < closed_from) cycle
          c(d) = c(d) + 2*side
        end if
        mean = mean + w(c(1), :n_rows, c(2), c(3))
        outward(d) = outward(d) - side
        n = n + 1
      end do
    end do
    if (n > 0) w(i, :n_rows, j, k) = mean/n
  end subroutine mean_of_neighbours

  !> Brings the gas of a cell that a wall has left behind to the speed of the wall, in the direction away from the gas, by a weak
  !> wave: nothing else tells gas that comes faster than sound how fast its wall is. velocity: of the wall.
  pure subroutine follow_wall(layout, eos, velocity, outward, cell)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    real(wp), intent(in) :: velocity(3), outward(3)
    real(wp), intent(inout) :: cell(:)
    real(wp) :: direction(3), lag, density, sound, fall, above
    integer :: n
    n = layout%n_materials
    direction = outward/max(norm2(outward), tiny(1.0_wp))
    associate (v => cell(layout%velocity_row:layout%velocity_row + 2), p => cell(layout%pressure_row))
      lag = sum((velocity - v)*direction)
      density = cell(layout%density_row)
      sound = cell(layout%sound_speed_row)
      above = p - maxval(eos(:n)%lowest_pressure(cell(:n)/cell_fractions(layout, cell)))
      fall = density*sound*lag
      if (fall > 0) fall = fall/(1 + fall/max(above, tiny(p))) ! leaves the gas some pressure
      v = v + lag*direction
      p = p - fall
      cell(:n) = cell(:n)*(1 - fall/(density*sound**2))
    end associate
    call close_cell(layout, eos, cell)
  end subroutine follow_wall

  !> Velocity of the solid in the interface cells, from the nodes (eq. 29); where walls move, the flow gets it with their normals.
  !> dt: of the step.
  subroutine find_wall_velocity(mesh, halo, solid, flow, coupling, dt)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(in) :: solid
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    real(wp), intent(in) :: dt
    type(cell_frame) :: frame
    integer :: b, c
    do b = 1, mesh%n_local
      frame = frame_of(mesh, solid%order, b)
      associate (list => coupling%list(b))
        do c = 1, list%n
          list%velocity(:, c) = cell_velocity(solid, frame, b, list%cell(:, c))
        end do
      end associate
    end do
    if (.not. coupling%moving_wall) return
    call ease_light_walls(mesh, halo, solid, flow, coupling%kind, coupling%closed_from, coupling%reference_pressure, &
                          coupling%face, dt, coupling%list)
    call set_walls(mesh, halo, flow, coupling)
  end subroutine find_wall_velocity

  !> In place of immerse_solid and find_wall_velocity where the solid has not moved since: a new step begins.
  subroutine hold_solid(flow, coupling)
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer :: b
    coupling%partial = 0
    do b = 1, size(coupling%list)
      if (allocated(coupling%list(b)%impulse)) coupling%list(b)%impulse = 0
      if (allocated(flow%wall_impulse(b)%a)) flow%wall_impulse(b)%a = 0
    end do
  end subroutine hold_solid

  !> Velocities and normals of walls that move, for the flow.
  subroutine set_walls(mesh, halo, flow, coupling)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer :: b, c
    call fill(mesh, halo, coupling%solid_part, 1)
    do b = 1, mesh%n_local
      if (.not. coupling%near(b)) cycle
      call mirror_ghosts(mesh, mesh%local(b), coupling%solid_part(b))
      call smooth_part(mesh%brick_cells, mesh%active, mesh%ghost, coupling%solid_part(b)%a(:, 1, :, :))
    end do
    call fill(mesh, halo, coupling%solid_part, 1)
    do b = 1, mesh%n_local
      if (.not. allocated(flow%wall(b)%a)) cycle
      call mirror_ghosts(mesh, mesh%local(b), coupling%solid_part(b))
      do c = 1, coupling%list(b)%n
        associate (cell => coupling%list(b)%cell(:, c))
          flow%wall(b)%a(cell(1), 1:3, cell(2), cell(3)) = coupling%list(b)%velocity(:, c)
        end associate
      end do
      call wall_normals(mesh%brick_cells, mesh%active, mesh%ghost, mesh%spacing, coupling%solid_part(b)%a(:, 1, :, :), &
                        coupling%kind(b)%a(:, 1, :, :) > coupling%closed_from, flow%wall(b)%a)
    end do
    call fill(mesh, halo, flow%wall, 12, only_faces=.true.)
  end subroutine set_walls

  !> Forces the state that the step starts from: the solid has moved since the last stage.
  subroutine force_first_state(mesh, flow, coupling)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    call force_buffer(mesh, flow, coupling, flow%current, 1.0_wp)
  end subroutine force_first_state

  !> Forces the state that a stage of a step of length dt has made; loose particles drag at the end of the step.
  subroutine force_stage(mesh, flow, coupling, stage, dt)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer, intent(in) :: stage
    real(wp), intent(in) :: dt
    integer :: b
    call force_buffer(mesh, flow, coupling, flow%target(stage), state_weight(stage))
    if (stage < 3) return
    do b = 1, mesh%n_local
      if (coupling%list(b)%n_loose > 0) call drag_loose(flow%layout, flow%eos, mesh%ghost, dt, mesh%cell_volume, coupling%list(b), &
        flow%w(b, flow%target(stage))%a, coupling%partial(booked_kinetic, b))
    end do
  end subroutine force_stage

  subroutine force_buffer(mesh, flow, coupling, buffer, weight)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(coupling_type), intent(inout) :: coupling
    integer, intent(in) :: buffer
    real(wp), intent(in) :: weight
    integer :: b
    if (coupling%moving_wall) return
    do b = 1, mesh%n_local
      if (coupling%list(b)%n == 0) cycle
      call force_velocity(flow%layout%n_materials, flow%layout%velocity(1), mesh%ghost, weight, mesh%cell_volume, &
                          coupling%list(b), flow%w(b, buffer)%a, coupling%partial(booked_kinetic, b))
    end do
  end subroutine force_buffer

  !> Turns the impulse of the step into the force that the solid feels in each cell, and brings the books up to date.
  subroutine collect_force(mesh, flow, coupling, dt)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(coupling_type), intent(inout) :: coupling
    real(wp), intent(in) :: dt
    real(wp) :: total(size(coupling%books))
    integer :: b, d
    do b = 1, mesh%n_local
      if (coupling%list(b)%n == 0) then
        if (allocated(coupling%force(b)%a)) deallocate (coupling%force(b)%a)
        cycle
      end if
      if (allocated(flow%open(b)%a)) call add_wall_impulse(mesh%ghost, flow%wall_impulse(b)%a, &
        dt*coupling%reference_pressure*coupling%face, coupling%list(b), &
        coupling%partial(booked_reference:booked_reference + 2, b))
      if (.not. allocated(coupling%force(b)%a)) call allocate_cells(coupling%force(b), mesh%brick_cells, [0, 0, 0], 3, 0.0_wp)
      call spread_force(coupling%list(b), dt, coupling%force(b)%a)
      do d = 1, 3
        coupling%partial(booked_impulse + d - 1, b) = coupling%partial(booked_impulse + d - 1, b) &
                                                      + sum(coupling%list(b)%impulse(d, :))
      end do
    end do
    call reduce_sum(mesh, coupling%partial, total)
    coupling%books = coupling%books + total
  end subroutine collect_force

end module immersed_boundary
