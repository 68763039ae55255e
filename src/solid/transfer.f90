!> Particles to nodes and back for one set of one brick, by the kernels of the shape and the transfer that the deck asks for:
!> trilinear functions with FLIP/PIC have their own (scatter, gather), the rest goes by tensor products.
module transfer
  use cell_functions, only: cell_frame, chunk
  use gather, only: update_velocity, gather_motion
  use kinds, only: wp
  use particles, only: particle_block
  use scatter, only: scatter_particles
  use tensor_gather, only: update_velocity_by_tensor, gather_motion_by_tensor
  use tensor_scatter, only: scatter_by_tensor
  implicit none
  private
  public :: particles_to_nodes, nodes_to_particles, move_particles

contains

  !> Adds mass, momentum and internal force of a block to node (4 variables) and force (3). affine: first column of the affine
  !> matrix, 0 without APIC.
  pure subroutine particles_to_nodes(frame, affine, blk, node, force)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: affine
    type(particle_block), intent(in) :: blk
    real(wp), intent(inout) :: node(0:, :, 0:, 0:), force(0:, :, 0:, 0:)
    if (frame%order == 1 .and. affine == 0) then
      call scatter_particles(frame, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, node, force)
    else
      call scatter_by_tensor(frame, affine, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, node, force)
    end if
  end subroutine particles_to_nodes

  !> Velocities of a block from the nodes; with `again` its new momenta are added to momentum.
  pure subroutine nodes_to_particles(frame, flip, affine, again, blk, change, node, momentum)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: flip
    integer, intent(in) :: affine
    logical, intent(in) :: again
    type(particle_block), intent(inout) :: blk
    real(wp), intent(in) :: change(0:, :, 0:, 0:), node(0:, :, 0:, 0:)
    real(wp), intent(inout) :: momentum(0:, :, 0:, 0:)
    if (frame%order == 1 .and. affine == 0) then
      call update_velocity(frame, flip, again, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, change, node, momentum)
    else
      call update_velocity_by_tensor(frame, flip, affine, again, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, change, &
        node, momentum)
    end if
  end subroutine nodes_to_particles

  !> Moves particles first..last over dt with the node velocities and gives the gradient increments of `mapped` over strain_dt.
  pure subroutine move_particles(frame, affine, dt, strain_dt, blk, first, last, cell, node, mapped, gradient, n_moved, moved)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: affine, first, last
    real(wp), intent(in) :: dt, strain_dt
    type(particle_block), intent(inout) :: blk
    integer, intent(inout) :: cell
    real(wp), intent(in) :: node(0:, :, 0:, 0:), mapped(0:, :, 0:, 0:)
    real(wp), intent(out) :: gradient(chunk, 9)
    integer, intent(out) :: n_moved, moved(chunk)
    if (frame%order == 1 .and. affine == 0) then
      call gather_motion(frame, dt, strain_dt, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, first, last, cell, node, &
        mapped, gradient, n_moved, moved)
    else
      call gather_motion_by_tensor(frame, dt, strain_dt, blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, first, last, cell, &
        node, mapped, gradient, n_moved, moved)
    end if
  end subroutine move_particles

end module transfer
