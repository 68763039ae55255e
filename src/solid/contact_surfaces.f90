!> Where two velocity fields or more share nodes: which nodes, and where the surfaces of the fields lie around them.
!>
!> solid%surface holds, by field and node, sums over the particles of V grad N (1..3: points out of the body), V N (x - X) with the
!> position X of the node (4..6) and V N (7). V is the volume at rest, so neither density nor crushing tilts what follows from them.
!>
!> Where a body fills one side of a plane at the distance s (in cells) from a node, the middle of what the node sees of it lies at
!> u(s); `reach_of` inverts that. It knows no particle size: a surface comes out right to about a tenth of a cell.
module contact_surfaces
  use blocks, only: block
  use cell_functions, only: cell_frame, piece
  use halo, only: halo_type, add
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: particle_block, at_position, at_mass
  use solid_state, only: solid_type, contact_nodes, frame_of
  use supports, only: hold_nodes
  use tensor_functions, only: functions_of, tensor_weights, control_point, line_functions
  implicit none
  private
  public :: find_surfaces, reach_of

  integer, parameter, public :: n_surface = 7 !< sums by field and node

contains

  !> Lists the shared nodes of every local brick in solid%meeting and sums solid%surface there. Node masses must be there.
  subroutine find_surfaces(mesh, halo, solid)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(solid_type), intent(inout) :: solid
    type(cell_frame) :: frame
    logical, allocatable :: shared(:, :, :)
    integer :: b, set, field, n
    do b = 1, mesh%n_local
      frame = frame_of(mesh, solid%order, b)
      call list_nodes(solid, frame, b, shared, solid%meeting(b))
      do field = 1, solid%n_fields
        if (allocated(solid%surface(field, b)%a)) solid%surface(field, b)%a = 0
      end do
      if (size(solid%meeting(b)%share, 2) == 0) cycle
      do set = 1, solid%n_sets
        if (solid%block(set, b)%n > 0) call add_surface(frame, 1/solid%material(set)%density, shared, solid%block(set, b), &
          solid%surface(solid%field_of_set(set), b)%a)
      end do
      associate (meeting => solid%meeting(b), node => solid%meeting(b)%node)
        do n = 1, size(meeting%share, 2)
          do field = 1, solid%n_fields
            meeting%share(field, n) = solid%surface(field, b)%a(node(1, n), n_surface, node(2, n), node(3, n))
          end do
        end do
      end associate
    end do
    do field = 1, solid%n_fields
      call add(mesh, halo, solid%surface(field, :), n_surface, solid%order)
      do b = 1, mesh%n_local
        if (size(solid%meeting(b)%share, 2) == 0) cycle
        ! what is held stands for the mirror image behind it: the surface goes on there
        call hold_nodes(solid%support(b), 0, solid%surface(field, b))
        call hold_nodes(solid%support(b), 3, solid%surface(field, b))
      end do
    end do
  end subroutine find_surfaces

  !> Nodes of a brick at which two fields or more have mass.
  pure subroutine list_nodes(solid, frame, b, shared, meeting)
    type(solid_type), intent(in) :: solid
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: b
    logical, allocatable, intent(out) :: shared(:, :, :)
    type(contact_nodes), intent(inout) :: meeting
    integer, allocatable :: fields(:, :, :)
    integer :: field, i, j, k, n
    associate (last => frame%last)
      allocate (fields(0:last(1), 0:last(2), 0:last(3)), source=0)
      do field = 1, solid%n_fields
        if (allocated(solid%node(field, b)%a)) fields = fields + merge(1, 0, solid%node(field, b)%a(:, 1, :, :) > 0)
      end do
      allocate (shared(0:last(1), 0:last(2), 0:last(3)))
      shared = fields > 1
      if (allocated(meeting%node)) deallocate (meeting%node, meeting%share, meeting%normal, meeting%state)
      allocate (meeting%node(3, count(shared)), meeting%share(solid%n_fields, count(shared)))
      allocate (meeting%normal(3, size(solid%pair), count(shared)), meeting%state(size(solid%pair), count(shared)))
      n = 0
      do k = 0, last(3)
        do j = 0, last(2)
          do i = 0, last(1)
            if (.not. shared(i, j, k)) cycle
            n = n + 1
            meeting%node(:, n) = [i, j, k]
          end do
        end do
      end do
    end associate
  end subroutine list_nodes

  !> Adds the sums of one set of a brick, from the cells that touch a shared node.
  pure subroutine add_surface(frame, inverse_density, shared, blk, surface)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: inverse_density
    logical, intent(in) :: shared(0:, 0:, 0:)
    type(particle_block), intent(in) :: blk
    real(wp), intent(inout) :: surface(0:, :, 0:, 0:)
    type(line_functions) :: line(3)
    real(wp) :: w(piece, 3, 3), slope(piece, 3, 3), total(n_surface)
    integer :: i, j, k, d, a, b, c, cell, first, n, at(3), low(3), high(3)
    cell = 0
    do k = 1, frame%n(3)
      do j = 1, frame%n(2)
        do i = 1, frame%n(1)
          cell = cell + 1
          if (blk%cell_start(cell) == blk%cell_start(cell + 1)) cycle
          do d = 1, 3
            line(d) = functions_of(frame, d, merge(i, merge(j, k, d == 2), d == 1))
          end do
          low = [i, j, k] - 1
          high = low + line%n - 1
          if (.not. any(shared(low(1):high(1), low(2):high(2), low(3):high(3)))) cycle
          do first = blk%cell_start(cell), blk%cell_start(cell + 1) - 1, piece
            n = min(piece, blk%cell_start(cell + 1) - first)
            do d = 1, 3
              call tensor_weights(line(d), n, blk%f(first, at_position + d - 1), w(:, :, d), slope(:, :, d))
            end do
            do c = 1, line(3)%n
              do b = 1, line(2)%n
                do a = 1, line(1)%n
                  at = low + [a, b, c] - 1
                  if (.not. shared(at(1), at(2), at(3))) cycle
                  call sum_node(n, [(control_point(frame, d, at(d)), d=1, 3)], blk%f(first, at_mass), blk%f(first, at_position), &
                    blk%f(first, at_position + 1), blk%f(first, at_position + 2), w(:, a, 1), w(:, b, 2), w(:, c, 3), &
                    slope(:, a, 1), slope(:, b, 2), slope(:, c, 3), total)
                  surface(at(1), :, at(2), at(3)) = surface(at(1), :, at(2), at(3)) + inverse_density*total
                end do
              end do
            end do
          end do
        end do
      end do
    end do
  end subroutine add_surface

  !> Sums over n particles, times their mass, at the node that lies at `at`. w, s: functions and slopes along each direction.
  pure subroutine sum_node(n, at, mass, x, y, z, wx, wy, wz, sx, sy, sz, total)
    integer, intent(in) :: n
    real(wp), intent(in) :: at(3)
    real(wp), intent(in), dimension(n) :: mass, x, y, z, wx, wy, wz, sx, sy, sz
    real(wp), intent(out) :: total(n_surface)
    real(wp) :: part
    integer :: q
    total = 0
    do q = 1, n
      total(1:3) = total(1:3) + mass(q)*[sx(q)*wy(q)*wz(q), wx(q)*sy(q)*wz(q), wx(q)*wy(q)*sz(q)]
      part = mass(q)*wx(q)*wy(q)*wz(q)
      total(4:6) = total(4:6) + part*([x(q), y(q), z(q)] - at)
      total(7) = total(7) + part
    end do
  end subroutine sum_node

  !> How far the surface of a body lies from a node, s in cells, positive beyond the node: from where the middle of what the node
  !> sees of the body lies, u in cells along the same direction.
  !>
  !> Exact for linear functions of a body that ends before the node, u = (3 s - 1)/2 - ... = -1 + 2/3 (1 + s); beyond it
  !> u = (-1/6 + s^2/2 - s^3/3)/(1/2 + s - s^2/2) is inverted to 0.05.
  elemental real(wp) function reach_of(u) result(s)
    real(wp), intent(in) :: u
    if (u <= -1/3.0_wp) then
      s = 0.5_wp + 1.5_wp*u
    else if (u < 0) then
      s = 1 - sqrt(-2*u + 3*u*u)
    else
      s = 1
    end if
  end function reach_of

end module contact_surfaces
