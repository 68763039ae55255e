!> The Cartesian mesh as a set of equal bricks, ordered along a Morton curve and owned in contiguous runs by ranks.
module mesh
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp, i8
  use parallel, only: my_rank => rank, n_ranks
  use text, only: str
  implicit none
  private
  public :: build_mesh, assign_ranks, locate_cell

  !> One box of cells. Neighbours are global brick indices.
  type, public :: brick_type
    integer :: index = 0 !< position on the curve, from 1
    integer :: location(3) = 0 !< brick coordinates, from 0
    real(wp) :: origin(3) = 0 !< low corner
    integer :: rank = 0 !< owner
    integer :: neighbour(-1:1, -1:1, -1:1) = 0 !< global index of the neighbours, 0 outside the domain
    logical :: at_low(3) = .false. !< touches the low face of the domain (never on a periodic face)
    logical :: at_high(3) = .false. !< touches the high face of the domain
  end type brick_type

  !> The mesh; the table of bricks is the same on every rank.
  type, public :: mesh_type
    integer :: dimensions = 1 !< active directions
    integer :: cells(3) = 1 !< cells of the domain
    real(wp) :: lower(3) = 0, upper(3) = 1 !< corners of the domain
    real(wp) :: spacing(3) = 1 !< cell size; 1 in inactive directions
    real(wp) :: cell_volume = 1
    logical :: active(3) = .false. !< directions with more than one cell
    integer :: ghosts = 2 !< ghost layers that the flow scheme asks for
    integer :: ghost(3) = 0 !< ghost layers by direction: none in inactive ones
    integer :: brick_cells(3) = 1 !< cells of a brick
    integer :: bricks(3) = 1 !< bricks of the domain
    logical :: periodic(3) = .false.
    integer :: radial_power = 0 !< of x in the area of its faces: see module geometry
    type(brick_type), allocatable :: brick(:) !< all bricks in curve order
    integer, allocatable :: local(:) !< global indices of this rank's bricks, ascending
    integer :: n_local = 0
  end type mesh_type

contains

  !> Lays bricks over the domain and gives each rank an equal run of them.
  !> cells: of the domain, 1 for an inactive direction; brick: cells of a brick, 0 where the code is to choose a divisor.
  !> axis_order: directions from the one that the curve runs through fastest to the one that cuts the domain first (default x, y,
  !> z). Fatal (bad input) if a brick does not divide the domain or is smaller than the ghost layers.
  subroutine build_mesh(mesh, cells, lower, upper, brick, periodic, ghosts, axis_order)
    type(mesh_type), intent(out) :: mesh
    integer, intent(in) :: cells(3), brick(3), ghosts
    real(wp), intent(in) :: lower(3), upper(3)
    logical, intent(in) :: periodic(3)
    integer, intent(in), optional :: axis_order(3)
    integer :: d, order(3)
    order = [1, 2, 3]
    if (present(axis_order)) order = axis_order
    mesh%cells = cells
    mesh%active = cells > 1
    mesh%dimensions = count(mesh%active)
    mesh%ghosts = ghosts
    mesh%ghost = merge(ghosts, 0, mesh%active)
    mesh%lower = merge(lower, 0.0_wp, mesh%active)
    mesh%upper = merge(upper, 1.0_wp, mesh%active)
    mesh%periodic = periodic .and. mesh%active
    mesh%spacing = (mesh%upper - mesh%lower)/cells
    mesh%cell_volume = product(mesh%spacing)
    do d = 1, 3
      mesh%brick_cells(d) = brick(d)
      if (brick(d) == 0) mesh%brick_cells(d) = chosen_divisor(cells(d), target_size(mesh%dimensions))
      if (mod(cells(d), mesh%brick_cells(d)) /= 0) call fatal('mesh%brick: '//str(mesh%brick_cells(d))// &
        ' does not divide the '//str(cells(d))//' cells of direction '//str(d), exit_bad_input)
      if (mesh%active(d) .and. mesh%brick_cells(d) < ghosts) call fatal('mesh: a brick of '//str(mesh%brick_cells(d))// &
        ' cells is smaller than the '//str(ghosts)//' ghost layers', exit_bad_input)
    end do
    mesh%bricks = cells/mesh%brick_cells
    call lay_bricks(mesh, order)
    call assign_ranks(mesh, [(1.0_wp, d=1, size(mesh%brick))])
  end subroutine build_mesh

  !> Cells per direction of a brick whose rows and planes stay in the second-level cache.
  pure integer function target_size(dimensions)
    integer, intent(in) :: dimensions
    integer, parameter :: sizes(3) = [256, 64, 32]
    target_size = sizes(dimensions)
  end function target_size

  !> The divisor of n nearest to the wanted size, on a logarithmic scale.
  pure integer function chosen_divisor(n, wanted) result(best)
    integer, intent(in) :: n, wanted
    integer :: candidate
    best = n
    do candidate = 2, n
      if (mod(n, candidate) /= 0) cycle
      if (abs(log(real(candidate, wp)/wanted)) < abs(log(real(best, wp)/wanted))) best = candidate
    end do
  end function chosen_divisor

  subroutine lay_bricks(mesh, axis_order)
    type(mesh_type), intent(inout) :: mesh
    integer, intent(in) :: axis_order(3)
    integer, allocatable :: curve(:, :, :), order(:)
    integer(i8), allocatable :: key(:)
    integer :: n, i, j, k, b, location(3), next(3), d(3)
    n = product(mesh%bricks)
    allocate (mesh%brick(n), key(n), order(n), curve(0:mesh%bricks(1) - 1, 0:mesh%bricks(2) - 1, 0:mesh%bricks(3) - 1))
    b = 0
    do k = 0, mesh%bricks(3) - 1
      do j = 0, mesh%bricks(2) - 1
        do i = 0, mesh%bricks(1) - 1
          b = b + 1
          location = [i, j, k]
          key(b) = morton_key(location(axis_order))
          order(b) = b
        end do
      end do
    end do
    call sort_by_key(order, key)
    do b = 1, n
      i = order(b) - 1
      location = [mod(i, mesh%bricks(1)), mod(i/mesh%bricks(1), mesh%bricks(2)), i/(mesh%bricks(1)*mesh%bricks(2))]
      curve(location(1), location(2), location(3)) = b
      mesh%brick(b)%index = b
      mesh%brick(b)%location = location
      mesh%brick(b)%origin = mesh%lower + location*mesh%brick_cells*mesh%spacing
      mesh%brick(b)%at_low = location == 0 .and. .not. mesh%periodic
      mesh%brick(b)%at_high = location == mesh%bricks - 1 .and. .not. mesh%periodic
    end do
    do b = 1, n
      do k = -1, 1
        do j = -1, 1
          do i = -1, 1
            d = [i, j, k]
            next = mesh%brick(b)%location + d
            where (mesh%periodic) next = modulo(next, mesh%bricks)
            if (any(next < 0 .or. next >= mesh%bricks)) cycle
            mesh%brick(b)%neighbour(i, j, k) = curve(next(1), next(2), next(3))
          end do
        end do
      end do
    end do
  end subroutine lay_bricks

  !> Bits of the three coordinates interleaved: near on the curve means near in space.
  pure integer(i8) function morton_key(location) result(key)
    integer, intent(in) :: location(3)
    integer :: bit, d
    key = 0
    do bit = 0, 19
      do d = 1, 3
        if (btest(location(d), bit)) key = ibset(key, 3*bit + d - 1)
      end do
    end do
  end function morton_key

  !> Orders the list by its keys (heap sort; keys are distinct).
  pure subroutine sort_by_key(list, key)
    integer, intent(inout) :: list(:)
    integer(i8), intent(in) :: key(:)
    integer :: n, start, last, swap
    n = size(list)
    do start = n/2, 1, -1
      call sift(list, key, start, n)
    end do
    do last = n, 2, -1
      swap = list(1); list(1) = list(last); list(last) = swap
      call sift(list, key, 1, last - 1)
    end do
  end subroutine sort_by_key

  pure subroutine sift(list, key, start, last)
    integer, intent(inout) :: list(:)
    integer(i8), intent(in) :: key(:)
    integer, intent(in) :: start, last
    integer :: root, child, swap
    root = start
    do while (2*root <= last)
      child = 2*root
      if (child < last) then
        if (key(list(child)) < key(list(child + 1))) child = child + 1
      end if
      if (key(list(root)) >= key(list(child))) return
      swap = list(root); list(root) = list(child); list(child) = swap
      root = child
    end do
  end subroutine sift

  !> Cuts the curve into one run of bricks per rank, with as equal sums of weight as whole bricks allow.
  !> weight: cost of each brick, in curve order, positive.
  subroutine assign_ranks(mesh, weight)
    type(mesh_type), intent(inout) :: mesh
    real(wp), intent(in) :: weight(:)
    real(wp) :: total, before
    integer :: b
    total = sum(weight)
    before = 0
    do b = 1, size(mesh%brick)
      mesh%brick(b)%rank = min(n_ranks - 1, int((before + weight(b)/2)/total*n_ranks))
      before = before + weight(b)
    end do
    mesh%local = pack([(b, b=1, size(mesh%brick))], mesh%brick%rank == my_rank)
    mesh%n_local = size(mesh%local)
  end subroutine assign_ranks

  !> The cell that holds a point: global index of its brick (0 outside the domain) and cell indices in the brick, from 1.
  pure subroutine locate_cell(mesh, point, brick, cell)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: point(3)
    integer, intent(out) :: brick, cell(3)
    integer :: global(3), location(3), b
    brick = 0
    cell = 0
    if (any(mesh%active .and. (point < mesh%lower .or. point > mesh%upper))) return
    global = 0
    where (mesh%active) global = min(int((point - mesh%lower)/mesh%spacing), mesh%cells - 1)
    location = global/mesh%brick_cells
    do b = 1, size(mesh%brick)
      if (all(mesh%brick(b)%location == location)) brick = b
    end do
    cell = global - location*mesh%brick_cells + 1
  end subroutine locate_cell

end module mesh
