!> Walls lighter than what sounds to them in a step: a foil in water, a plate thinner than its cell.
!>
!> The flow sees the velocity that the wall had at the beginning of the step. A wall of mass m on which gas or water of impedance
!> Z = r c A bears would answer to the force of a step dt with (Z dt/m) times the velocity that ends this force: too much from
!> Z dt/m = 2 on, and it breaks up. So where Z dt/m exceeds one half the wall takes part of its way at once: with
!> x = Z dt/m - 1/2 its velocity is raised by F/Z x/(1 + x), F the force that it would feel unmoved. What is left of the force moves
!> it the rest, short of the velocity of the flow, however light it is. Heavier walls are left as they are, and momentum is exact
!> all the same, since the solid gets what the flow loses.
module light_walls
  use blocks, only: block, allocate_cells
  use flow_state, only: flow_type
  use halo, only: halo_type, fill
  use interface_cells, only: interface_list
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_mass
  use reductions, only: reduce_max, any_rank
  use rigid_bodies, only: all_fixed
  use solid_state, only: solid_type
  implicit none
  private
  public :: ease_light_walls

  real(wp), parameter :: heavy = 0.5_wp !< Z dt/m up to which a wall is left as it is
  !> Variables of a wall cell; impedance and push by direction.
  integer, parameter :: at_wall_mass = 1, at_impedance = 2, at_push = 5, n_columns = 7

contains

  !> Raises the velocities of walls so light that they would break up. list: of each local brick, with velocities; kind: types of
  !> the cells, closed from closed_from on; reference: pressure that the solid does not feel; face: areas; dt: of the scene.
  subroutine ease_light_walls(mesh, halo, solid, flow, kind, closed_from, reference, face, dt, list)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(in) :: solid
    type(flow_type), intent(inout) :: flow
    type(block), intent(in) :: kind(:)
    real(wp), intent(in) :: closed_from, reference, face(3), dt
    type(interface_list), intent(inout) :: list(:)
    type(block) :: wall(mesh%n_local)
    integer :: b, c
    if (all_fixed(solid)) return
    if (.not. any_light(mesh, solid, flow, face, dt, list)) return
    call fill(mesh, halo, flow%w(:, flow%current), flow%layout%n_rows, only_faces=.true.)
    do b = 1, mesh%n_local
      if (.not. allocated(solid%count(b)%a)) cycle
      call allocate_cells(wall(b), mesh%brick_cells, mesh%ghost, n_columns, 0.0_wp)
      do c = 1, list(b)%n - list(b)%n_loose
        associate (i => list(b)%cell(1, c), j => list(b)%cell(2, c), k => list(b)%cell(3, c))
          wall(b)%a(i, at_wall_mass, j, k) = mass_in_cell(mesh, solid, b, list(b)%cell(:, c))
          call bear_on(mesh, flow, b, kind(b)%a(:, 1, :, :), closed_from, reference, face, list(b)%cell(:, c), &
            list(b)%velocity(:, c), wall(b)%a(i, at_impedance:at_impedance + 2, j, k), wall(b)%a(i, at_push:at_push + 2, j, k))
        end associate
      end do
      call add_inner_mass(mesh, solid, b, wall(b))
    end do
    call fill(mesh, halo, wall, n_columns, only_faces=.true.)
    do b = 1, mesh%n_local
      do c = 1, list(b)%n - list(b)%n_loose
        call ease(mesh%active, mesh%ghost, dt, list(b)%cell(:, c), wall(b)%a, list(b)%velocity(:, c))
      end do
    end do
  end subroutine ease_light_walls

  !> Could any wall cell be light, by the stiffest gas anywhere? The same answer on all ranks.
  logical function any_light(mesh, solid, flow, face, dt, list)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: face(3), dt
    type(interface_list), intent(in) :: list(:)
    real(wp) :: stiffest, none(0), lightest
    integer :: b, c
    stiffest = 0
    lightest = huge(1.0_wp)
    do b = 1, mesh%n_local
      associate (n => mesh%brick_cells, w => flow%w(flow%holder(b), flow%current)%a, r => flow%layout%density_row, &
                 s => flow%layout%sound_speed_row)
        stiffest = max(stiffest, maxval(w(1:n(1), r, 1:n(2), 1:n(3))*w(1:n(1), s, 1:n(2), 1:n(3))))
      end associate
      do c = 1, list(b)%n - list(b)%n_loose
        lightest = min(lightest, mass_in_cell(mesh, solid, b, list(b)%cell(:, c)))
      end do
    end do
    call reduce_max(stiffest, none)
    any_light = any_rank(2*dt*stiffest*maxval(face, mesh%active) > heavy*lightest)
  end function any_light

  pure real(wp) function mass_in_cell(mesh, solid, b, c) result(mass)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b, c(3)
    integer :: set, cell
    cell = c(1) + mesh%brick_cells(1)*(c(2) - 1 + mesh%brick_cells(2)*(c(3) - 1))
    mass = 0
    do set = 1, solid%n_sets
      if (solid%block(set, b)%n == 0) cycle
      associate (blk => solid%block(set, b))
        mass = mass + sum(blk%f(blk%cell_start(cell):blk%cell_start(cell + 1) - 1, at_mass))
      end associate
    end do
  end function mass_in_cell

  !> Masses of the cells that are no walls but hold particles: the wall cells beside them lean on these.
  subroutine add_inner_mass(mesh, solid, b, wall)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b
    type(block), intent(inout) :: wall
    integer :: i, j, k
    do k = 1, mesh%brick_cells(3)
      do j = 1, mesh%brick_cells(2)
        do i = 1, mesh%brick_cells(1)
          if (.not. solid%count(b)%a(i, 1, j, k) > 0 .or. wall%a(i, at_wall_mass, j, k) > 0) cycle
          wall%a(i, at_wall_mass, j, k) = mass_in_cell(mesh, solid, b, [i, j, k])
        end do
      end do
    end do
  end subroutine add_inner_mass

  !> Impedance of the open cells beside a wall cell and their force on it, were it to keep its velocity; by direction.
  pure subroutine bear_on(mesh, flow, b, kind, closed_from, reference, face, cell, velocity, impedance, push)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: b, cell(3)
    real(wp), intent(in) :: kind(1 - mesh%ghost(1):, 1 - mesh%ghost(2):, 1 - mesh%ghost(3):), closed_from, reference, face(3), &
      velocity(3)
    real(wp), intent(out) :: impedance(3), push(3)
    real(wp) :: z
    integer :: d, side, at(3)
    impedance = 0
    push = 0
    do d = 1, 3
      if (.not. mesh%active(d)) cycle
      do side = -1, 1, 2
        at = cell
        at(d) = at(d) + side
        if (kind(at(1), at(2), at(3)) > closed_from) cycle
        associate (w => flow%w(flow%holder(b), flow%current)%a(at(1), :, at(2), at(3)), layout => flow%layout)
          z = face(d)*w(layout%density_row)*w(layout%sound_speed_row)
          impedance(d) = impedance(d) + z
          push(d) = push(d) - side*face(d)*(w(layout%pressure_row) - reference) &
                    + z*(w(layout%velocity_row + d - 1) - velocity(d))
        end associate
      end do
    end do
  end subroutine bear_on

  !> Raises the velocity of one wall cell, direction by direction; what leans on it and what it leans on moves with it.
  pure subroutine ease(active, ghost, dt, cell, wall, velocity)
    logical, intent(in) :: active(3)
    integer, intent(in) :: ghost(3), cell(3)
    real(wp), intent(in) :: dt, wall(1 - ghost(1):, :, 1 - ghost(2):, 1 - ghost(3):)
    real(wp), intent(inout) :: velocity(3)
    real(wp) :: mass, impedance, push, excess
    integer :: d, side, at(3)
    do d = 1, 3
      if (.not. active(d)) cycle
      mass = 0
      impedance = 0
      push = 0
      do side = -1, 1
        at = cell
        at(d) = at(d) + side
        mass = mass + wall(at(1), at_wall_mass, at(2), at(3))
        impedance = impedance + wall(at(1), at_impedance + d - 1, at(2), at(3))
        push = push + wall(at(1), at_push + d - 1, at(2), at(3))
      end do
      excess = dt*impedance/mass - heavy
      if (excess > 0) velocity(d) = velocity(d) + push/impedance*excess/(1 + excess)
    end do
  end subroutine ease

end module light_walls
