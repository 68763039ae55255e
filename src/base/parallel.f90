!> Start and end of the message passing, and who we are in it.
module parallel
  use mpi_f08, only: MPI_Comm, MPI_COMM_WORLD, MPI_Init, MPI_Finalize, MPI_Comm_rank, MPI_Comm_size, MPI_Initialized, MPI_Barrier
  implicit none
  private
  public :: parallel_start, parallel_stop, is_root, barrier
  type(MPI_Comm), protected, public :: world !< communicator of the run
  integer, protected, public :: rank = 0 !< this process, from 0
  integer, protected, public :: n_ranks = 1 !< number of processes

contains

  !> Initialises MPI unless it already is; safe to call twice.
  subroutine parallel_start()
    logical :: started
    call MPI_Initialized(started)
    if (.not. started) call MPI_Init()
    world = MPI_COMM_WORLD
    call MPI_Comm_rank(world, rank)
    call MPI_Comm_size(world, n_ranks)
  end subroutine parallel_start

  !> Ends MPI; to be called once, by all ranks, at the very end.
  subroutine parallel_stop()
    call MPI_Finalize()
  end subroutine parallel_stop

  !> Waits for all ranks.
  subroutine barrier()
    call MPI_Barrier(world)
  end subroutine barrier

  !> True on the rank that prints and writes small files.
  pure logical function is_root()
    is_root = rank == 0
  end function is_root

end module parallel
