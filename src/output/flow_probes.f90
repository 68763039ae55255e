!> Values of the flow at fixed points: linear in each direction between the centres of the cells around the point. Beyond the
!> outermost centres the value of the cell at the face is taken, which is right at a symmetry plane. Closed cells (inside a solid)
!> are left out and the weights of the others made up to one. Same bits on any number of ranks.
module flow_probes
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use blocks, only: block, holder
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp
  use mesh, only: locate_cell, mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_DOUBLE_PRECISION, MPI_SUM
  use parallel, only: rank, world
  use text, only: str
  implicit none
  private
  public :: flow_probes_type, place_flow_probes, read_flow_probes

  integer, parameter :: corners = 8

  !> Points and the cells around them.
  type :: flow_probes_type
    integer :: n = 0
    integer, allocatable :: brick(:, :) !< (corner, point) global brick of the cell
    integer, allocatable :: cell(:, :, :) !< (direction, corner, point) place in the brick
    real(wp), allocatable :: weight(:, :) !< (corner, point)
  end type flow_probes_type

contains

  !> Finds the cells. position(3, n); fatal (bad input) for a point outside the domain.
  subroutine place_flow_probes(probes, mesh, position)
    type(flow_probes_type), intent(out) :: probes
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: position(:, :)
    integer :: p, c, d, low(3), corner(3), side(3)
    real(wp) :: place(3), fraction(3), centre(3)
    probes%n = size(position, 2)
    allocate (probes%brick(corners, probes%n), probes%cell(3, corners, probes%n), probes%weight(corners, probes%n))
    do p = 1, probes%n
      if (any(mesh%active .and. (position(:, p) < mesh%lower .or. position(:, p) > mesh%upper))) then
        call fatal('a flow gauge lies outside the domain, at ('//str(position(1, p))//', '//str(position(2, p))//', '// &
          str(position(3, p))//')', exit_bad_input)
        return
      end if
      place = merge((position(:, p) - mesh%lower)/mesh%spacing - 0.5_wp, 0.0_wp, mesh%active)
      low = floor(place)
      fraction = place - low
      do c = 1, corners
        side = [iand(c - 1, 1), iand((c - 1)/2, 1), (c - 1)/4]
        corner = low + side
        where (mesh%periodic) corner = modulo(corner, mesh%cells)
        corner = min(max(corner, 0), mesh%cells - 1)
        probes%weight(c, p) = product([(merge(fraction(d), 1 - fraction(d), side(d) == 1), d=1, 3)])
        centre = mesh%lower + (corner + 0.5_wp)*mesh%spacing
        call locate_cell(mesh, centre, probes%brick(c, p), probes%cell(:, c, p))
      end do
    end do
  end subroutine place_flow_probes

  !> value(column, point): the variables of these columns at each point; not a number where all cells around it are closed.
  !> state, open: blocks of the flow (they may share numbers) and of its closed cells (0 closed; unallocated where all are open). To
  !> be called by all ranks.
  subroutine read_flow_probes(probes, mesh, state, open, columns, value)
    type(flow_probes_type), intent(in) :: probes
    type(mesh_type), intent(in) :: mesh
    type(block), intent(in) :: state(:), open(:)
    integer, intent(in) :: columns(:)
    real(wp), intent(out) :: value(:, :)
    real(wp) :: mine(0:size(columns), corners, probes%n), everyone(0:size(columns), corners, probes%n), weight
    integer :: p, c, b, i(3), bricks_before
    if (probes%n == 0) return
    bricks_before = count(mesh%brick%rank < rank)
    mine = 0
    do p = 1, probes%n
      do c = 1, corners
        b = probes%brick(c, p) - bricks_before
        if (b < 1 .or. b > mesh%n_local) cycle
        i = probes%cell(:, c, p)
        mine(0, c, p) = probes%weight(c, p)
        if (b <= size(open)) then
          if (allocated(open(b)%a)) mine(0, c, p) = mine(0, c, p)*open(b)%a(i(1), 1, i(2), i(3))
        end if
        mine(1:, c, p) = state(holder(state, b))%a(i(1), columns, i(2), i(3))
      end do
    end do
    call MPI_Allreduce(mine, everyone, size(mine), MPI_DOUBLE_PRECISION, MPI_SUM, world)
    do p = 1, probes%n
      weight = sum(everyone(0, :, p))
      if (weight > 0) then
        value(:, p) = 0
        do c = 1, corners
          if (everyone(0, c, p) > 0) value(:, p) = value(:, p) + (everyone(0, c, p)/weight)*everyone(1:, c, p)
        end do
      else
        value(:, p) = ieee_value(1.0_wp, ieee_quiet_nan)
      end if
    end do
  end subroutine read_flow_probes

end module flow_probes
