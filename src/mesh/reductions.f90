!> Sums and extremes over all bricks that give the same bits on any number of ranks.
module reductions
  use kinds, only: wp
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allgather, MPI_Allgatherv, MPI_Allreduce, MPI_DOUBLE_PRECISION, MPI_LOGICAL, MPI_LOR
  use parallel, only: world, n_ranks
  implicit none
  private
  public :: reduce_sum, reduce_max, reduce_min, any_rank

contains

  !> total(v) = sum over all bricks, in global brick order, of partial(v, local brick).
  subroutine reduce_sum(mesh, partial, total)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: partial(:, :)
    real(wp), intent(out) :: total(:)
    real(wp), allocatable :: all_bricks(:, :)
    integer :: counts(n_ranks), offsets(n_ranks), r, b
    allocate (all_bricks(size(partial, 1), size(mesh%brick)))
    do r = 1, n_ranks
      counts(r) = size(partial, 1)*count(mesh%brick%rank == r - 1)
    end do
    offsets(1) = 0
    do r = 2, n_ranks
      offsets(r) = offsets(r - 1) + counts(r - 1)
    end do
    call MPI_Allgatherv(partial, size(partial), MPI_DOUBLE_PRECISION, all_bricks, counts, offsets, MPI_DOUBLE_PRECISION, world)
    total = 0
    do b = 1, size(all_bricks, 2)
      total = total + all_bricks(:, b)
    end do
  end subroutine reduce_sum

  !> The largest value over the ranks, with the figures that go with it (a place, say); of equal values the lowest rank's.
  !> Ranks own ascending runs of bricks, so a caller that keeps its first maximum gets the same answer on any number of ranks.
  subroutine reduce_max(value, companion)
    real(wp), intent(inout) :: value
    real(wp), intent(inout) :: companion(:)
    real(wp) :: mine(size(companion) + 1), everyone(size(companion) + 1, n_ranks)
    integer :: best
    mine = [value, companion]
    call MPI_Allgather(mine, size(mine), MPI_DOUBLE_PRECISION, everyone, size(mine), MPI_DOUBLE_PRECISION, world)
    best = maxloc(everyone(1, :), dim=1)
    value = everyone(1, best)
    companion = everyone(2:, best)
  end subroutine reduce_max

  !> The smallest value over the ranks, with the figures that go with it.
  subroutine reduce_min(value, companion)
    real(wp), intent(inout) :: value
    real(wp), intent(inout) :: companion(:)
    value = -value
    call reduce_max(value, companion)
    value = -value
  end subroutine reduce_min

  !> True on every rank if it is on one.
  logical function any_rank(mine)
    logical, intent(in) :: mine
    call MPI_Allreduce(mine, any_rank, 1, MPI_LOGICAL, MPI_LOR, world)
  end function any_rank

end module reductions
