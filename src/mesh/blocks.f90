!> The one container of field data: what a brick holds of a field, ghost layers included.
module blocks
  use kinds, only: wp
  implicit none
  private
  public :: allocate_cells, allocate_nodes, row_length, holder, share, own

  !> Field data of one brick, x fastest. Unallocated where the scene needs nothing of it, or where another block of the same array
  !> holds the same numbers.
  type, public :: block
    real(wp), allocatable :: a(:, :, :, :) !< (x, variable, y, z)
    integer :: shares = 0 !< index of the block whose numbers it shares, 0 none
  end type block

contains

  !> A cell block: cells 1..n and ghost layers; the x rows are padded to whole vectors at the upper end.
  !> n: cells per direction; ghost: ghost layers per direction; n_var: variables; value: what all entries start with.
  subroutine allocate_cells(b, n, ghost, n_var, value)
    type(block), intent(inout) :: b
    integer, intent(in) :: n(3), ghost(3), n_var
    real(wp), intent(in) :: value
    if (allocated(b%a)) deallocate (b%a)
    allocate (b%a(1 - ghost(1):row_length(n, ghost) - ghost(1), n_var, 1 - ghost(2):n(2) + ghost(2), 1 - ghost(3):n(3) + ghost(3)))
    b%a = value
  end subroutine allocate_cells

  !> Length of a row along x of a cell block, ghosts and padding included.
  pure integer function row_length(n, ghost) result(width)
    integer, intent(in) :: n(3), ghost(3)
    integer, parameter :: vector = 4
    ! whole vectors for the cells 0..n+1 and what their reconstruction reads, and for kernels that take cells eight by eight
    width = max(vector*((n(1) + 1 + vector)/vector) + 2*max(ghost(1) - 1, 0), n(1) + 2*ghost(1), 8*((n(1) + 7)/8))
    width = vector*((width + vector - 1)/vector)
  end function row_length

  !> A node block: nodes 0..n in each direction, node i being the low corner of cell i+1; all zero.
  subroutine allocate_nodes(b, n, n_var)
    type(block), intent(inout) :: b
    integer, intent(in) :: n(3), n_var
    if (allocated(b%a)) deallocate (b%a)
    allocate (b%a(0:n(1), n_var, 0:n(2), 0:n(3)))
    b%a = 0
  end subroutine allocate_nodes

  !> Index of the block that holds the numbers of block b.
  pure integer function holder(blocks, b)
    type(block), intent(in) :: blocks(:)
    integer, intent(in) :: b
    holder = b
    if (blocks(b)%shares > 0) holder = blocks(b)%shares
  end function holder

  !> Block b lets go of its numbers and shares those of another block.
  pure subroutine share(blocks, b, other)
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: b, other
    if (allocated(blocks(b)%a)) deallocate (blocks(b)%a)
    blocks(b)%shares = other
  end subroutine share

  !> Block b gets a copy of its own of the numbers that it shares, if it does.
  pure subroutine own(blocks, b)
    type(block), intent(inout) :: blocks(:)
    integer, intent(in) :: b
    if (blocks(b)%shares == 0) return
    blocks(b)%a = blocks(blocks(b)%shares)%a
    blocks(b)%shares = 0
  end subroutine own

end module blocks
