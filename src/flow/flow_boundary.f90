!> Ghost cells at the faces of the domain. Sweeps go direction by direction, so edges and corners are not needed.
module flow_boundary
  use flow_state, only: flow_type, face_symmetry, face_inflow, face_ambient
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: fill_boundary

contains

  !> Fills the ghost cells outside the domain of local brick b in the given buffer.
  !> Symmetry mirrors the state and turns the normal velocity: a slip wall. Outflow repeats the last cell. Beyond an ambient
  !> face the surroundings are as they were: a shock that leaves meets there what it has met before.
  subroutine fill_boundary(mesh, flow, b, buffer)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b, buffer
    integer :: d
    associate (brick => mesh%brick(mesh%local(b)))
      do d = 1, 3
        if (.not. mesh%active(d)) cycle
        if (brick%at_low(d)) call fill_face(flow%w(b, buffer)%a, d, 1, mesh%ghosts, -1)
        if (brick%at_high(d)) call fill_face(flow%w(b, buffer)%a, d, mesh%brick_cells(d), mesh%ghosts, 1)
      end do
    end associate

  contains

    !> Ghost layers beyond cell `last` of direction d; outward: -1 at the low face, 1 at the high face.
    subroutine fill_face(w, d, last, layers, outward)
      real(wp), allocatable, intent(inout) :: w(:, :, :, :)
      integer, intent(in) :: d, last, layers, outward
      integer :: layer, kind, from
      kind = flow%face(merge(1, 2, outward < 0), d)
      do layer = 1, layers
        select case (kind)
        case (face_symmetry)
          from = last - outward*(layer - 1)
        case default
          from = last
        end select
        select case (kind)
        case (face_inflow)
          call set_layer(w, d, last + outward*layer, flow%inflow)
        case (face_ambient)
          call set_layer(w, d, last + outward*layer, flow%ambient)
        case default
          call copy_layer(w, d, from, last + outward*layer, merge(-1.0_wp, 1.0_wp, kind == face_symmetry))
        end select
      end do
    end subroutine fill_face

    !> Copies a layer of cells, normal velocity times sign.
    subroutine copy_layer(w, d, from, to, sign)
      real(wp), allocatable, intent(inout) :: w(:, :, :, :)
      integer, intent(in) :: d, from, to
      real(wp), intent(in) :: sign
      real(wp) :: factor
      integer :: v, j, k, source(3), target(3)
      do k = merge(to, lbound(w, 4), d == 3), merge(to, ubound(w, 4), d == 3)
        do j = merge(to, lbound(w, 3), d == 2), merge(to, ubound(w, 3), d == 2)
          target = [to, j, k]
          source = target
          source(d) = from
          do v = 1, flow%layout%n_rows
            factor = merge(sign, 1.0_wp, v == flow%layout%velocity_row + d - 1)
            if (d == 1) then
              w(to, v, j, k) = factor*w(from, v, j, k)
            else
              call copy_row(size(w, 1), factor, w(lbound(w, 1), v, source(2), source(3)), w(lbound(w, 1), v, j, k))
            end if
          end do
        end do
      end do
    end subroutine copy_layer

    pure subroutine copy_row(n, factor, from, to)
      integer, intent(in) :: n
      real(wp), intent(in) :: factor, from(n)
      real(wp), intent(inout) :: to(n)
      to = factor*from
    end subroutine copy_row

    subroutine set_layer(w, d, layer, state)
      real(wp), allocatable, intent(inout) :: w(:, :, :, :)
      integer, intent(in) :: d, layer
      real(wp), intent(in) :: state(:)
      integer :: v
      do v = 1, flow%layout%n_rows
        select case (d)
        case (1); w(layer, v, :, :) = state(v)
        case (2); w(:, v, layer, :) = state(v)
        case (3); w(:, v, :, layer) = state(v)
        end select
      end do
    end subroutine set_layer

  end subroutine fill_boundary

end module flow_boundary
