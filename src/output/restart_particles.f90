!> Particles in a restart file: every column of every set, brick after brick, in the order in which they stand.
module restart_particles
  use errors, only: fatal
  use kinds, only: wp
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_INTEGER, MPI_MAX
  use parallel, only: world
  use particles, only: allocate_particles, field_name, particle_block, reserve_particles
  use restart_fields, only: restart_get_table, restart_put_table
  use restart_files, only: restart_file
  use restart_values, only: restart_get, restart_put
  use text, only: str
  implicit none
  private
  public :: restart_put_particles, restart_get_particles

contains

  !> blocks(set, local brick), sorted: none may wait for a sort.
  subroutine restart_put_particles(file, blocks)
    type(restart_file), intent(inout) :: file
    type(particle_block), intent(in) :: blocks(:, :)
    integer :: set, column, b, mine, n_field
    character(:), allocatable :: prefix
    call restart_put(file, 'particle_sets', size(blocks, 1))
    do set = 1, size(blocks, 1)
      prefix = 'particles_'//str(set)//'_'
      mine = 0
      do b = 1, size(blocks, 2)
        mine = max(mine, size(blocks(set, b)%f, 2))
        if (blocks(set, b)%n_moved > 0) call fatal('particles are not sorted when the restart file is written')
      end do
      call MPI_Allreduce(mine, n_field, 1, MPI_INTEGER, MPI_MAX, world)
      call restart_put(file, prefix//'columns', n_field)
      call restart_put_table(file, prefix//'id', blocks(set, :)%n, joined_integers(1))
      call restart_put_table(file, prefix//'body', blocks(set, :)%n, joined_integers(2))
      call restart_put_table(file, prefix//'cell_start', merge(n_starts(blocks(set, :)), 0, blocks(set, :)%n > 0), joined_starts())
      do column = 1, n_field
        call restart_put_table(file, prefix//column_name(column), blocks(set, :)%n, joined_reals())
      end do
    end do

  contains

    function joined_integers(which) result(values)
      integer, intent(in) :: which
      integer, allocatable :: values(:)
      integer :: place, i, n
      allocate (values(sum(blocks(set, :)%n)))
      place = 0
      do i = 1, size(blocks, 2)
        n = blocks(set, i)%n
        if (which == 1) values(place + 1:place + n) = blocks(set, i)%id(:n)
        if (which == 2) values(place + 1:place + n) = blocks(set, i)%body(:n)
        place = place + n
      end do
    end function joined_integers

    function joined_starts() result(values)
      integer, allocatable :: values(:)
      integer :: place, i, n
      allocate (values(sum(n_starts(blocks(set, :)), mask=blocks(set, :)%n > 0)))
      place = 0
      do i = 1, size(blocks, 2)
        if (blocks(set, i)%n == 0) cycle
        n = size(blocks(set, i)%cell_start)
        values(place + 1:place + n) = blocks(set, i)%cell_start
        place = place + n
      end do
    end function joined_starts

    function joined_reals() result(values)
      real(wp), allocatable :: values(:)
      integer :: place, i, n
      allocate (values(sum(blocks(set, :)%n)))
      place = 0
      do i = 1, size(blocks, 2)
        n = blocks(set, i)%n
        values(place + 1:place + n) = blocks(set, i)%f(:n, column)
        place = place + n
      end do
    end function joined_reals

  end subroutine restart_put_particles

  !> Columns that only some materials have go by their number.
  pure function column_name(column) result(name)
    integer, intent(in) :: column
    character(:), allocatable :: name
    if (column <= size(field_name)) then
      name = trim(field_name(column))
    else
      name = 'column_'//str(column)
    end if
  end function column_name

  elemental integer function n_starts(block)
    type(particle_block), intent(in) :: block
    n_starts = size(block%cell_start)
  end function n_starts

  !> Fills blocks(set, local brick); what they held is dropped. Fatal if their number of sets or columns differs from the file's.
  subroutine restart_get_particles(file, mesh, blocks)
    type(restart_file), intent(inout) :: file
    type(mesh_type), intent(in) :: mesh
    type(particle_block), intent(inout) :: blocks(:, :)
    integer :: set, n_sets, column, n_field, counts(size(blocks, 2)), start_counts(size(blocks, 2)), b
    character(:), allocatable :: prefix
    integer, allocatable :: integers(:)
    real(wp), allocatable :: reals(:)
    n_sets = 0
    call restart_get(file, 'particle_sets', n_sets)
    if (n_sets /= size(blocks, 1)) then
      call fatal('restart file "'//file%name//'" has '//str(n_sets)//' sets of particles, the deck has '//str(size(blocks, 1)))
      return
    end if
    do set = 1, n_sets
      prefix = 'particles_'//str(set)//'_'
      n_field = 0
      call restart_get(file, prefix//'columns', n_field)
      if (size(blocks, 2) > 0) then
        if (size(blocks(set, 1)%f, 2) /= n_field) call fatal('restart file "'//file%name//'": particles of set '//str(set)// &
          ' have '//str(n_field)//' columns, the deck asks for '//str(size(blocks(set, 1)%f, 2)))
      end if
      call restart_get_table(file, prefix//'id', counts, integers)
      do b = 1, size(blocks, 2)
        call empty_block(blocks(set, b), product(mesh%brick_cells), n_field)
        call reserve_particles(blocks(set, b), counts(b))
        blocks(set, b)%n = counts(b)
        blocks(set, b)%id(:counts(b)) = integers(sum(counts(:b - 1)) + 1:sum(counts(:b)))
      end do
      call restart_get_table(file, prefix//'body', counts, integers)
      do b = 1, size(blocks, 2)
        blocks(set, b)%body(:counts(b)) = integers(sum(counts(:b - 1)) + 1:sum(counts(:b)))
      end do
      call restart_get_table(file, prefix//'cell_start', start_counts, integers)
      do b = 1, size(blocks, 2)
        if (start_counts(b) > 0) blocks(set, b)%cell_start(:) = integers(sum(start_counts(:b - 1)) + 1:sum(start_counts(:b)))
      end do
      do column = 1, n_field
        call restart_get_table(file, prefix//column_name(column), counts, reals)
        do b = 1, size(blocks, 2)
          blocks(set, b)%f(:counts(b), column) = reals(sum(counts(:b - 1)) + 1:sum(counts(:b)))
        end do
      end do
    end do
  end subroutine restart_get_particles

  subroutine empty_block(block, n_cells, n_field)
    type(particle_block), intent(inout) :: block
    integer, intent(in) :: n_cells, n_field
    type(particle_block) :: fresh
    call allocate_particles(fresh, n_cells, n_field)
    block = fresh
  end subroutine empty_block

end module restart_particles
