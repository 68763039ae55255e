!> Nodes whose velocity is held at zero: by faces of the domain, by inactive directions, by clamps.
!>
!> A held component takes no part in the velocity change of the particles, as if the mirror image of the body stood behind a
!> symmetry plane. The impulse that this takes is booked by support.
module supports
  use blocks, only: block
  use cell_functions, only: cell_frame
  use kinds, only: wp
  use mesh, only: mesh_type
  use solid_state, only: solid_type, support_list, held_type, frame_of, n_supports, face_symmetry, face_clamped
  use tensor_functions, only: control_point
  implicit none
  private
  public :: find_supports, hold_nodes, sum_held

contains

  !> Lists the held components of every local brick. A component that two supports hold belongs to the first of them.
  subroutine find_supports(mesh, solid)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    type(held_type), allocatable :: list(:)
    type(cell_frame) :: frame
    integer :: b, i, j, k, d, n, support
    do b = 1, mesh%n_local
      frame = frame_of(mesh, solid%order, b)
      allocate (list(3*product(frame%last + 1)))
      n = 0
      do k = 0, frame%last(3)
        do j = 0, frame%last(2)
          do i = 0, frame%last(1)
            do d = 1, 3
              support = support_of(frame, mesh%spacing, solid, [i, j, k], d)
              if (support == 0) cycle
              n = n + 1
              list(n) = held_type([i, j, k], d, support)
            end do
          end do
        end do
      end do
      solid%support(b)%held = list(:n)
      deallocate (list)
    end do
  end subroutine find_supports

  !> What holds one component of one node, 0 if nothing does. A clamp holds the nodes whose control points it holds.
  pure integer function support_of(frame, spacing, solid, node, component) result(support)
    type(cell_frame), intent(in) :: frame
    real(wp), intent(in) :: spacing(3)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: node(3), component
    integer :: d, side, c
    logical :: on_face
    real(wp) :: x(3), margin(3)
    support = 0
    do d = 1, 3
      do side = 1, 2
        if (frame%active(d)) then
          if (side == 1) on_face = frame%at_low(d) .and. node(d) == 0
          if (side == 2) on_face = frame%at_high(d) .and. node(d) == frame%last(d)
          if (.not. on_face) cycle
          if (solid%face(side, d) == face_clamped .or. (solid%face(side, d) == face_symmetry .and. component == d)) then
            support = 2*(d - 1) + side
            return
          end if
        else if (component == d .and. node(d) == side - 1) then
          support = 2*(d - 1) + side
          return
        end if
      end do
      x(d) = control_point(frame, d, node(d))
    end do
    margin = 1e-6_wp*spacing
    do c = 1, size(solid%clamp)
      if (.not. solid%clamp(c)%fixed(component)) cycle
      if (any(frame%active .and. (x < solid%clamp(c)%lower - margin .or. x > solid%clamp(c)%upper + margin))) cycle
      support = n_supports
      return
    end do
  end function support_of

  !> Sets the held components of variables first+1..first+3 of a node block to zero.
  pure subroutine hold_nodes(support, first, nodes)
    type(support_list), intent(in) :: support
    integer, intent(in) :: first
    type(block), intent(inout) :: nodes
    integer :: h
    do h = 1, size(support%held)
      associate (held => support%held(h))
        nodes%a(held%node(1), first + held%direction, held%node(2), held%node(3)) = 0
      end associate
    end do
  end subroutine hold_nodes

  !> total(component, support) = sum over the held components of variable `variable`, or first + component where variable is 0.
  pure function sum_held(support, first, variable, nodes) result(total)
    type(support_list), intent(in) :: support
    integer, intent(in) :: first, variable
    type(block), intent(in) :: nodes
    real(wp) :: total(3, n_supports)
    integer :: h, v
    total = 0
    do h = 1, size(support%held)
      associate (held => support%held(h))
        v = variable
        if (variable == 0) v = first + held%direction
        total(held%direction, held%support) = total(held%direction, held%support) &
          + nodes%a(held%node(1), v, held%node(2), held%node(3))
      end associate
    end do
  end function sum_held

end module supports
