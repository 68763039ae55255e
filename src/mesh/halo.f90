!> The only communication of fields: *fill* ghost cells from neighbours, *add* what bricks hold of the nodes they share.
!> A plan is made once per change of the brick set; then each verb is one message per neighbour rank and copies inside a rank.
module halo
  use blocks, only: block, holder, own
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Request, MPI_Irecv, MPI_Isend, MPI_Waitall, MPI_DOUBLE_PRECISION, MPI_STATUSES_IGNORE
  use parallel, only: world, my_rank => rank, n_ranks
  implicit none
  private
  public :: plan_halo, fill, add, last_node

  !> One transfer: the receiver's neighbour in this direction gives it a slab.
  type :: transfer_type
    integer :: rank = 0 !< the other side
    integer :: receiver = 0, giver = 0 !< global brick indices
    integer :: here = 0 !< local index of the brick of this rank (receiver of what comes, giver of what goes)
    integer :: there = 0 !< local index of the giver where both are of this rank, else 0
    integer :: direction(3) = 0 !< from the receiver to the giver
  end type transfer_type

  !> What comes and what goes, ordered by rank, receiver and direction: the same order on both sides.
  type, public :: halo_type
    private
    type(transfer_type), allocatable :: incoming(:), outgoing(:)
    real(wp), allocatable :: received(:), sent(:)
    integer, allocatable :: position(:) !< where each incoming slab starts in received
    integer, allocatable :: entry(:, :, :, :) !< number of the incoming transfer by direction and local brick, 0 none
  end type halo_type

  integer, parameter :: tag = 11
  integer, parameter :: thin = 4 !< cells along x that are copied one by one

contains

  !> Lists the transfers of this rank's bricks.
  subroutine plan_halo(mesh, halo)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(out) :: halo
    type(transfer_type) :: list(26*mesh%n_local)
    integer :: other, b, n
    integer, allocatable :: local_index(:)
    allocate (local_index(size(mesh%brick)), source=0)
    do b = 1, mesh%n_local
      local_index(mesh%local(b)) = b
    end do
    n = 0
    do other = 0, n_ranks - 1
      do b = 1, mesh%n_local
        call list_neighbours(mesh, local_index, b, other, list, n)
      end do
    end do
    halo%incoming = list(:n)
    n = 0
    do other = 0, n_ranks - 1
      if (other == my_rank) cycle
      do b = 1, size(mesh%brick)
        if (mesh%brick(b)%rank == other) call list_gifts(mesh, local_index, b, list, n)
      end do
    end do
    halo%outgoing = list(:n)
    allocate (halo%received(0), halo%sent(0), halo%position(size(halo%incoming)))
    allocate (halo%entry(-1:1, -1:1, -1:1, mesh%n_local), source=0)
    do n = 1, size(halo%incoming)
      associate (in => halo%incoming(n))
        halo%entry(in%direction(1), in%direction(2), in%direction(3), in%here) = n
      end associate
    end do
  end subroutine plan_halo

  !> Neighbours of local brick b that the other rank owns.
  subroutine list_neighbours(mesh, local_index, b, other, list, n)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: local_index(:), b, other
    type(transfer_type), intent(inout) :: list(:)
    integer, intent(inout) :: n
    integer :: i, j, k, giver
    do k = -1, 1
      do j = -1, 1
        do i = -1, 1
          giver = mesh%brick(mesh%local(b))%neighbour(i, j, k)
          if (giver == 0 .or. all([i, j, k] == 0)) cycle
          if (mesh%brick(giver)%rank /= other) cycle
          n = n + 1
          list(n) = transfer_type(other, mesh%local(b), giver, b, local_index(giver), [i, j, k])
        end do
      end do
    end do
  end subroutine list_neighbours

  !> What this rank's bricks give to global brick b of another rank.
  subroutine list_gifts(mesh, local_index, b, list, n)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: local_index(:), b
    type(transfer_type), intent(inout) :: list(:)
    integer, intent(inout) :: n
    integer :: i, j, k, giver
    do k = -1, 1
      do j = -1, 1
        do i = -1, 1
          giver = mesh%brick(b)%neighbour(i, j, k)
          if (giver == 0 .or. all([i, j, k] == 0)) cycle
          if (local_index(giver) == 0) cycle
          n = n + 1
          list(n) = transfer_type(mesh%brick(b)%rank, b, giver, local_index(giver), 0, [i, j, k])
        end do
      end do
    end do
  end subroutine list_gifts

  !> Ghost cells of all local blocks get the values of the neighbours' cells; those outside the domain are left alone.
  !> n_var: variables 1..n_var travel; only_faces: leave out edges and corners; unread: bricks whose ghosts need not be filled.
  !> All blocks must be allocated or share the numbers of another: these get numbers of their own where their ghosts would change.
  subroutine fill(mesh, halo, blocks, n_var, only_faces, unread)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: n_var
    logical, intent(in), optional :: only_faces, unread(:)
    logical :: faces, left_alone(mesh%n_local)
    integer :: t, first(3), last(3), from(3), to(3)
    faces = .false.
    if (present(only_faces)) faces = only_faces
    left_alone = .false.
    if (present(unread)) left_alone = unread
    call transfer_slabs(mesh, halo, blocks, n_var, cells_to_give, faces, .false.)
    call part_where_ghosts_differ(mesh, halo, blocks, n_var, faces, left_alone)
    do t = 1, size(halo%incoming)
      associate (in => halo%incoming(t))
        if (skipped(mesh, in%direction, faces)) cycle
        if (blocks(in%here)%shares > 0 .or. left_alone(in%here)) cycle
        call ghosts_to_fill(mesh, in%direction, first, last)
        if (in%there > 0) then
          call cells_to_give(mesh, in%direction, from, to)
          call copy_slab(blocks(holder(blocks, in%there))%a, from, to, n_var, first, blocks(in%here)%a)
        else
          call unpack_slab(blocks(in%here), first, last, n_var, halo%received(halo%position(t):))
        end if
      end associate
    end do
  end subroutine fill

  !> Blocks that share the numbers of another get their own where what comes in differs, bit by bit, from the ghosts they share.
  subroutine part_where_ghosts_differ(mesh, halo, blocks, n_var, faces, left_alone)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(in) :: halo
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: n_var
    logical, intent(in) :: faces, left_alone(:)
    integer :: t, first(3), last(3), from(3), to(3), giver, receiver
    do t = 1, size(halo%incoming)
      associate (in => halo%incoming(t))
        if (blocks(in%here)%shares == 0 .or. left_alone(in%here)) cycle
        if (skipped(mesh, in%direction, faces)) cycle
        receiver = blocks(in%here)%shares
        call ghosts_to_fill(mesh, in%direction, first, last)
        if (in%there > 0) then
          giver = holder(blocks, in%there)
          if (giver == receiver) cycle
          call cells_to_give(mesh, in%direction, from, to)
          if (.not. same_slab(blocks(giver)%a, from, to, n_var, first, blocks(receiver)%a)) call own(blocks, in%here)
        else
          if (.not. same_as_slab(blocks(receiver), first, last, n_var, halo%received(halo%position(t):))) &
            call own(blocks, in%here)
        end if
      end associate
    end do
  end subroutine part_where_ghosts_differ

  !> Index of the last node that a brick holds in each direction, the first being 0. layers: see add. With two layers an inactive
  !> direction has one node.
  pure function last_node(mesh, layers) result(last)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: layers
    integer :: last(3)
    last = merge(mesh%brick_cells + layers - 1, merge(mesh%brick_cells, 0, layers == 1), mesh%active)
  end function last_node

  !> Each node that bricks share gets the sum of what all of them hold, added in the order of their places: the same bits in
  !> every sharer, on any number of ranks. A brick with an unallocated block takes no part. n_var: variables 1..n_var are added;
  !> layers: of nodes that two neighbours share, 1 (default, nodes 0..n of n cells) or 2 (nodes 0..n+1, bricks of two cells and
  !> more).
  subroutine add(mesh, halo, blocks, n_var, layers)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: n_var
    integer, intent(in), optional :: layers
    integer :: b, i, j, k, shared, slab(-1:1, -1:1, -1:1)
    shared = 1
    if (present(layers)) shared = layers
    if (shared == 1) then
      call transfer_slabs(mesh, halo, blocks, n_var, nodes_to_give, .false., .true.)
    else
      call transfer_slabs(mesh, halo, blocks, n_var, pairs_to_give, .false., .true.)
    end if
    do b = 1, mesh%n_local
      if (.not. allocated(blocks(b)%a)) cycle
      slab = 0
      do k = -1, 1
        do j = -1, 1
          do i = -1, 1
            if (halo%entry(i, j, k, b) == 0 .or. skipped(mesh, [i, j, k], .false.)) cycle
            slab(i, j, k) = halo%position(halo%entry(i, j, k, b))
          end do
        end do
      end do
      call sum_shared(last_node(mesh, shared), merge(shared, 0, mesh%active), slab, halo%received, n_var, blocks(b))
    end do
  end subroutine add

  !> Sums the shared nodes at each face, edge and corner of one brick over its sharers, low ones first.
  !> n: last node; shared: layers by direction.
  subroutine sum_shared(n, shared, slab, received, n_var, b)
    integer, intent(in) :: n(3), shared(3), slab(-1:1, -1:1, -1:1), n_var
    real(wp), intent(in) :: received(:)
    type(block), intent(inout) :: b
    real(wp), allocatable :: total(:, :, :, :)
    integer :: i, j, k, di, dj, dk, c(3), d(3), first(3), last(3), slab_first(3), slab_last(3)
    do k = -1, 1
      do j = -1, 1
        do i = -1, 1
          c = [i, j, k]
          if (all(c == 0)) cycle
          first = merge(n - shared + 1, merge(0, shared, c < 0), c > 0)
          last = merge(n, merge(shared - 1, n - shared, c < 0), c > 0)
          if (any(last < first)) cycle
          if (.not. any(slab(min(i, 0):max(i, 0), min(j, 0):max(j, 0), min(k, 0):max(k, 0)) > 0)) cycle
          allocate (total(first(1):last(1), n_var, first(2):last(2), first(3):last(3)), source=0.0_wp)
          do dk = min(k, 0), max(k, 0)
            do dj = min(j, 0), max(j, 0)
              do di = min(i, 0), max(i, 0)
                d = [di, dj, dk]
                if (all(d == 0)) then
                  total = total + b%a(first(1):last(1), :n_var, first(2):last(2), first(3):last(3))
                else if (slab(di, dj, dk) > 0) then
                  slab_first = merge(n - shared + 1, 0, d > 0)
                  slab_last = merge(shared - 1, n, d < 0)
                  call add_part(received(slab(di, dj, dk):), slab_first, slab_last, n_var, first, last, total)
                end if
              end do
            end do
          end do
          b%a(first(1):last(1), :n_var, first(2):last(2), first(3):last(3)) = total
          deallocate (total)
        end do
      end do
    end do
  end subroutine sum_shared

  subroutine add_part(buffer, slab_first, slab_last, n_var, first, last, total)
    integer, intent(in) :: slab_first(3), slab_last(3), n_var, first(3), last(3)
    real(wp), intent(in) :: buffer(slab_first(1):slab_last(1), n_var, slab_first(2):slab_last(2), slab_first(3):slab_last(3))
    real(wp), intent(inout) :: total(first(1):, :, first(2):, first(3):)
    total = total + buffer(first(1):last(1), :, first(2):last(2), first(3):last(3))
  end subroutine add_part

  !> Brings incoming slabs into halo%received: by one message from each other rank and, if copies are wanted too, from this rank's
  !> bricks.
  subroutine transfer_slabs(mesh, halo, blocks, n_var, to_give, faces, copies)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: n_var
    logical, intent(in) :: faces, copies
    interface
      pure subroutine to_give(mesh, direction, first, last)
        import :: mesh_type
        type(mesh_type), intent(in) :: mesh
        integer, intent(in) :: direction(3)
        integer, intent(out) :: first(3), last(3)
      end subroutine to_give
    end interface
    type(MPI_Request) :: request(2*n_ranks)
    integer :: t, at, start, n_requests, first(3), last(3), other
    n_requests = 0
    at = 1
    do t = 1, size(halo%incoming)
      halo%position(t) = at
      if (skipped(mesh, halo%incoming(t)%direction, faces)) cycle
      call to_give(mesh, halo%incoming(t)%direction, first, last)
      at = at + n_var*product(last - first + 1)
    end do
    if (size(halo%received) < at) then
      deallocate (halo%received)
      allocate (halo%received(at))
    end if
    t = 1
    do while (t <= size(halo%incoming))
      other = halo%incoming(t)%rank
      start = halo%position(t)
      do while (t <= size(halo%incoming))
        if (halo%incoming(t)%rank /= other) exit
        t = t + 1
      end do
      if (other == my_rank) cycle
      last(1) = at
      if (t <= size(halo%incoming)) last(1) = halo%position(t)
      n_requests = n_requests + 1
      call MPI_Irecv(halo%received(start), last(1) - start, MPI_DOUBLE_PRECISION, other, tag, world, request(n_requests))
    end do
    call send_slabs(mesh, halo, blocks, n_var, to_give, faces, request, n_requests)
    do t = 1, size(halo%incoming)
      associate (in => halo%incoming(t))
        if (in%there == 0 .or. .not. copies) cycle
        if (skipped(mesh, in%direction, faces)) cycle
        call to_give(mesh, in%direction, first, last)
        call pack_slab(blocks(in%there), first, last, n_var, halo%received(halo%position(t):))
      end associate
    end do
    call MPI_Waitall(n_requests, request(:n_requests), MPI_STATUSES_IGNORE)
  end subroutine transfer_slabs

  subroutine send_slabs(mesh, halo, blocks, n_var, to_give, faces, request, n_requests)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: n_var
    logical, intent(in) :: faces
    interface
      pure subroutine to_give(mesh, direction, first, last)
        import :: mesh_type
        type(mesh_type), intent(in) :: mesh
        integer, intent(in) :: direction(3)
        integer, intent(out) :: first(3), last(3)
      end subroutine to_give
    end interface
    type(MPI_Request), intent(inout) :: request(:)
    integer, intent(inout) :: n_requests
    integer :: t, at, start, first(3), last(3), other
    at = 0
    do t = 1, size(halo%outgoing)
      if (skipped(mesh, halo%outgoing(t)%direction, faces)) cycle
      call to_give(mesh, halo%outgoing(t)%direction, first, last)
      at = at + n_var*product(last - first + 1)
    end do
    at = at + 1 ! an empty message has a place too
    if (size(halo%sent) < at) then
      deallocate (halo%sent)
      allocate (halo%sent(at))
    end if
    at = 1
    t = 1
    do while (t <= size(halo%outgoing))
      other = halo%outgoing(t)%rank
      start = at
      do while (t <= size(halo%outgoing))
        associate (out => halo%outgoing(t))
          if (out%rank /= other) exit
          if (.not. skipped(mesh, out%direction, faces)) then
            call to_give(mesh, out%direction, first, last)
            call pack_slab(blocks(holder(blocks, out%here)), first, last, n_var, halo%sent(at:))
            at = at + n_var*product(last - first + 1)
          end if
        end associate
        t = t + 1
      end do
      n_requests = n_requests + 1
      call MPI_Isend(halo%sent(start), at - start, MPI_DOUBLE_PRECISION, other, tag, world, request(n_requests))
    end do
  end subroutine send_slabs

  !> A slab across an inactive direction does not exist; edges and corners are left out on demand.
  pure logical function skipped(mesh, direction, faces)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: direction(3)
    logical, intent(in) :: faces
    skipped = any(direction /= 0 .and. .not. mesh%active) .or. (faces .and. count(direction /= 0) > 1)
  end function skipped

  !> Cells of the giver next to the face that it shares with the receiver, who sees it in this direction.
  pure subroutine cells_to_give(mesh, direction, first, last)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: direction(3)
    integer, intent(out) :: first(3), last(3)
    first = merge(mesh%brick_cells - mesh%ghost + 1, 1, direction < 0)
    last = merge(mesh%ghost, mesh%brick_cells, direction > 0)
  end subroutine cells_to_give

  !> Ghost cells of the receiver in this direction.
  pure subroutine ghosts_to_fill(mesh, direction, first, last)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: direction(3)
    integer, intent(out) :: first(3), last(3)
    first = merge(1 - mesh%ghost, merge(mesh%brick_cells + 1, 1, direction > 0), direction < 0)
    last = merge(0, mesh%brick_cells + merge(mesh%ghost, 0, direction > 0), direction < 0)
  end subroutine ghosts_to_fill

  !> Nodes of the giver that lie on the face, edge or corner that it shares with the receiver.
  pure subroutine nodes_to_give(mesh, direction, first, last)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: direction(3)
    integer, intent(out) :: first(3), last(3)
    first = merge(mesh%brick_cells, 0, direction < 0)
    last = merge(0, mesh%brick_cells, direction > 0)
  end subroutine nodes_to_give

  !> Likewise where two layers are shared.
  pure subroutine pairs_to_give(mesh, direction, first, last)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: direction(3)
    integer, intent(out) :: first(3), last(3)
    integer :: n(3)
    n = last_node(mesh, 2)
    first = merge(n - 1, 0, direction < 0)
    last = merge(1, n, direction > 0)
  end subroutine pairs_to_give

  !> Copies a box of one block to a box of the same shape in another. Thin boxes go cell by cell: a call to copy two numbers costs
  !> more than the copy.
  subroutine copy_slab(giver, from, to, n_var, first, receiver)
    real(wp), allocatable, intent(in) :: giver(:, :, :, :)
    integer, intent(in) :: from(3), to(3), n_var, first(3)
    real(wp), allocatable, intent(inout) :: receiver(:, :, :, :)
    integer :: i, j, k, v, n, d(3)
    n = to(1) - from(1) + 1
    d = first - from
    do k = from(3), to(3)
      do j = from(2), to(2)
        if (n <= thin) then
          do i = from(1), to(1)
            do v = 1, n_var
              receiver(i + d(1), v, j + d(2), k + d(3)) = giver(i, v, j, k)
            end do
          end do
        else
          do v = 1, n_var
            receiver(first(1):first(1) + n - 1, v, j + d(2), k + d(3)) = giver(from(1):to(1), v, j, k)
          end do
        end if
      end do
    end do
  end subroutine copy_slab

  !> True if copy_slab would change nothing.
  pure logical function same_slab(giver, from, to, n_var, first, receiver) result(same)
    real(wp), allocatable, intent(in) :: giver(:, :, :, :), receiver(:, :, :, :)
    integer, intent(in) :: from(3), to(3), n_var, first(3)
    integer :: i, j, k, v, d(3)
    d = first - from
    same = .false.
    do k = from(3), to(3)
      do j = from(2), to(2)
        do v = 1, n_var
          do i = from(1), to(1)
            if (.not. same_bits(receiver(i + d(1), v, j + d(2), k + d(3)), giver(i, v, j, k))) return
          end do
        end do
      end do
    end do
    same = .true.
  end function same_slab

  !> True if unpack_slab would change nothing.
  pure logical function same_as_slab(b, first, last, n_var, buffer) result(same)
    type(block), intent(in) :: b
    integer, intent(in) :: first(3), last(3), n_var
    real(wp), intent(in) :: buffer(:)
    integer :: i, j, k, v, at
    at = 0
    same = .false.
    do k = first(3), last(3)
      do j = first(2), last(2)
        do v = 1, n_var
          do i = first(1), last(1)
            at = at + 1
            if (.not. same_bits(b%a(i, v, j, k), buffer(at))) return
          end do
        end do
      end do
    end do
    same = .true.
  end function same_as_slab

  pure logical function same_bits(a, b)
    real(wp), intent(in) :: a, b
    same_bits = transfer(a, 0_i8) == transfer(b, 0_i8)
  end function same_bits

  !> Copies a box of a block to a buffer; an unallocated block gives zeros.
  subroutine pack_slab(b, first, last, n_var, buffer)
    type(block), intent(in) :: b
    integer, intent(in) :: first(3), last(3), n_var
    real(wp), intent(inout) :: buffer(:)
    integer :: i, j, k, v, n, at
    n = last(1) - first(1) + 1
    if (.not. allocated(b%a)) then
      buffer(:n_var*product(last - first + 1)) = 0
      return
    end if
    at = 0
    do k = first(3), last(3)
      do j = first(2), last(2)
        if (n <= thin) then
          do i = 1, n
            do v = 1, n_var
              buffer(at + i + n*(v - 1)) = b%a(first(1) + i - 1, v, j, k)
            end do
          end do
          at = at + n*n_var
        else
          do v = 1, n_var
            buffer(at + 1:at + n) = b%a(first(1):last(1), v, j, k)
            at = at + n
          end do
        end if
      end do
    end do
  end subroutine pack_slab

  !> Copies a buffer to a box of a block.
  subroutine unpack_slab(b, first, last, n_var, buffer)
    type(block), intent(inout) :: b
    integer, intent(in) :: first(3), last(3), n_var
    real(wp), intent(in) :: buffer(:)
    integer :: i, j, k, v, n, at
    n = last(1) - first(1) + 1
    at = 0
    do k = first(3), last(3)
      do j = first(2), last(2)
        if (n <= thin) then
          do i = 1, n
            do v = 1, n_var
              b%a(first(1) + i - 1, v, j, k) = buffer(at + i + n*(v - 1))
            end do
          end do
          at = at + n*n_var
        else
          do v = 1, n_var
            b%a(first(1):last(1), v, j, k) = buffer(at + 1:at + n)
            at = at + n
          end do
        end if
      end do
    end do
  end subroutine unpack_slab

end module halo
