!> Large data of a restart file: what the bricks hold. Each rank writes and reads its own bricks, wherever they were before.
!> A name has the numbers of each brick (0 where a brick has nothing of it) and then the numbers themselves, brick after brick.
module restart_fields
  use blocks, only: block
  use errors, only: fatal
  use hdf5_attributes, only: get_attribute, put_attribute
  use hdf5_files, only: create_group, get_slab, put_slab
  use kinds, only: wp, i8
  use mpi_f08, only: MPI_Allreduce, MPI_Exscan, MPI_INTEGER, MPI_INTEGER8, MPI_MAX, MPI_SUM
  use parallel, only: rank, world
  use restart_files, only: restart_file
  use text, only: str
  implicit none
  private
  public :: restart_put_blocks, restart_get_blocks, restart_put_table, restart_get_table

  !> restart_put_table(file, name, counts, values): counts(b) numbers for each local brick b, one brick after the other.
  interface restart_put_table
    module procedure put_table_real, put_table_integer
  end interface restart_put_table
  !> restart_get_table(file, name, counts, values): the same for the bricks that are this rank's now; values is allocated.
  interface restart_get_table
    module procedure get_table_real, get_table_integer
  end interface restart_get_table

  integer, parameter :: most_numbers = 4*1024*1024 ! copied at a time, so that writing takes little memory

contains

  !> Writes the part first..last (x, y, z indices) of a field, all its variables. A block may be unallocated; n_var is found.
  subroutine restart_put_blocks(file, name, blocks, first, last)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: first(3), last(3)
    integer :: b, n_var, counts(size(blocks)), low, high
    integer(i8) :: before, total, done
    real(wp), allocatable :: values(:)
    n_var = 0
    do b = 1, size(blocks)
      if (allocated(blocks(b)%a)) n_var = size(blocks(b)%a, 2)
    end do
    n_var = largest(n_var)
    do b = 1, size(blocks)
      counts(b) = merge(n_var*product(last - first + 1), 0, allocated(blocks(b)%a))
    end do
    call put_counts(file, name, counts)
    call put_attribute(file%hdf5, 'bricks/'//name, 'variables', [n_var])
    call share_of(counts, before, total)
    done = 0
    high = 0
    do while (largest(merge(1, 0, high < size(blocks))) > 0)
      low = high + 1
      high = batch_end(counts, low)
      allocate (values(sum(counts(low:high))))
      call pack_blocks(blocks(low:high), first, last, values)
      call put_slab(file%hdf5, 'bricks/'//name//'/values', values, before + done, total)
      done = done + size(values)
      deallocate (values)
    end do
  end subroutine restart_put_blocks

  !> Reads what restart_put_blocks wrote, with the same first and last. A block that was not allocated then is deallocated; one that
  !> was must be allocated now with its variables, or all_first, all_last give the indices to allocate it with.
  subroutine restart_get_blocks(file, name, blocks, first, last, all_first, all_last)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: first(3), last(3)
    integer, intent(in), optional :: all_first(3), all_last(3)
    integer :: b, n_var(1), counts(size(blocks)), low, high
    integer(i8) :: before, total, done
    real(wp), allocatable :: values(:)
    call get_attribute(file%hdf5, 'bricks/'//name, 'variables', n_var)
    call get_counts(file, name, counts, before, total)
    do b = 1, size(blocks)
      call prepare_block(b)
    end do
    done = 0
    high = 0
    do while (largest(merge(1, 0, high < size(blocks))) > 0)
      low = high + 1
      high = batch_end(counts, low)
      allocate (values(sum(counts(low:high))))
      call get_slab(file%hdf5, 'bricks/'//name//'/values', values, before + done)
      if (.not. file%hdf5%ok) return
      call unpack_blocks(blocks(low:high), first, last, values)
      done = done + size(values)
      deallocate (values)
    end do

  contains

    subroutine prepare_block(b)
      integer, intent(in) :: b
      if (counts(b) == 0) then
        if (allocated(blocks(b)%a)) deallocate (blocks(b)%a)
        return
      end if
      if (counts(b) /= n_var(1)*product(last - first + 1)) call fatal('restart file "'//file%name//'": '//name//' has '// &
        str(counts(b))//' numbers in a brick, not '//str(n_var(1)*product(last - first + 1)))
      if (.not. allocated(blocks(b)%a)) then
        if (.not. (present(all_first) .and. present(all_last))) then
          call fatal('restart file "'//file%name//'": '//name//' is there for a brick that has no room for it')
          return
        end if
        allocate (blocks(b)%a(all_first(1):all_last(1), n_var(1), all_first(2):all_last(2), all_first(3):all_last(3)))
        blocks(b)%a = 0
      end if
      if (size(blocks(b)%a, 2) /= n_var(1)) call fatal('restart file "'//file%name//'": '//name//' has '//str(n_var(1))// &
        ' variables, not '//str(size(blocks(b)%a, 2))//'; the deck has changed')
    end subroutine prepare_block

  end subroutine restart_get_blocks

  subroutine put_table_real(file, name, counts, values)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: counts(:)
    real(wp), intent(in) :: values(:)
    integer(i8) :: before, total
    call put_counts(file, name, counts)
    call share_of(counts, before, total)
    call put_slab(file%hdf5, 'bricks/'//name//'/values', values, before, total)
  end subroutine put_table_real

  subroutine get_table_real(file, name, counts, values)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(out) :: counts(:)
    real(wp), intent(out), allocatable :: values(:)
    integer(i8) :: before, total
    call get_counts(file, name, counts, before, total)
    allocate (values(sum(counts)))
    values = 0
    call get_slab(file%hdf5, 'bricks/'//name//'/values', values, before)
  end subroutine get_table_real

  subroutine put_table_integer(file, name, counts, values)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: counts(:)
    integer, intent(in) :: values(:)
    integer(i8) :: before, total
    call put_counts(file, name, counts)
    call share_of(counts, before, total)
    call put_slab(file%hdf5, 'bricks/'//name//'/values', values, before, total)
  end subroutine put_table_integer

  subroutine get_table_integer(file, name, counts, values)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(out) :: counts(:)
    integer, intent(out), allocatable :: values(:)
    integer(i8) :: before, total
    call get_counts(file, name, counts, before, total)
    allocate (values(sum(counts)))
    values = 0
    call get_slab(file%hdf5, 'bricks/'//name//'/values', values, before)
  end subroutine get_table_integer

  subroutine put_counts(file, name, counts)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(in) :: counts(:)
    call create_group(file%hdf5, 'bricks/'//name)
    call put_slab(file%hdf5, 'bricks/'//name//'/counts', counts, int(file%first, i8), int(file%n_bricks, i8))
  end subroutine put_counts

  !> counts: of this rank's bricks; before: numbers of the bricks before them; total: numbers of all.
  subroutine get_counts(file, name, counts, before, total)
    type(restart_file), intent(inout) :: file
    character(*), intent(in) :: name
    integer, intent(out) :: counts(:)
    integer(i8), intent(out) :: before, total
    integer :: everyone(file%n_bricks)
    everyone = 0
    call get_slab(file%hdf5, 'bricks/'//name//'/counts', everyone, 0_i8)
    counts = everyone(file%first + 1:file%first + size(counts))
    before = sum(int(everyone(:file%first), i8))
    total = sum(int(everyone, i8))
  end subroutine get_counts

  !> before: numbers of the bricks of lower ranks; total: of all.
  subroutine share_of(counts, before, total)
    integer, intent(in) :: counts(:)
    integer(i8), intent(out) :: before, total
    integer(i8) :: mine
    mine = sum(int(counts, i8))
    before = 0
    call MPI_Exscan(mine, before, 1, MPI_INTEGER8, MPI_SUM, world)
    if (rank == 0) before = 0 ! the library leaves it undefined there
    call MPI_Allreduce(mine, total, 1, MPI_INTEGER8, MPI_SUM, world)
  end subroutine share_of

  integer function largest(mine)
    integer, intent(in) :: mine
    call MPI_Allreduce(mine, largest, 1, MPI_INTEGER, MPI_MAX, world)
  end function largest

  !> Last of the bricks from low on that are moved in one go: at least one, if any is left.
  pure integer function batch_end(counts, low) result(high)
    integer, intent(in) :: counts(:), low
    integer :: numbers
    high = low - 1
    numbers = 0
    do while (high < size(counts))
      numbers = numbers + counts(high + 1)
      if (numbers > most_numbers .and. high >= low) exit
      high = high + 1
    end do
  end function batch_end

  pure subroutine pack_blocks(blocks, first, last, values)
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: first(3), last(3)
    real(wp), intent(out) :: values(:)
    integer :: b, v, j, k, place, n
    n = last(1) - first(1) + 1
    place = 0
    do b = 1, size(blocks)
      if (.not. allocated(blocks(b)%a)) cycle
      do k = first(3), last(3)
        do j = first(2), last(2)
          do v = 1, size(blocks(b)%a, 2)
            values(place + 1:place + n) = blocks(b)%a(first(1):last(1), v, j, k)
            place = place + n
          end do
        end do
      end do
    end do
  end subroutine pack_blocks

  pure subroutine unpack_blocks(blocks, first, last, values)
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: first(3), last(3)
    real(wp), intent(in) :: values(:)
    integer :: b, v, j, k, place, n
    n = last(1) - first(1) + 1
    place = 0
    do b = 1, size(blocks)
      if (.not. allocated(blocks(b)%a)) cycle
      do k = first(3), last(3)
        do j = first(2), last(2)
          do v = 1, size(blocks(b)%a, 2)
            blocks(b)%a(first(1):last(1), v, j, k) = values(place + 1:place + n)
            place = place + n
          end do
        end do
      end do
    end do
  end subroutine unpack_blocks

end module restart_fields
