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
      integer :: layer, kind, from(layers), to(layers)
      kind = flow%face(merge(1, 2, outward < 0), d)
      to = [(last + outward*layer, layer=1, layers)]
      from = last
      if (kind == face_symmetry) from = [(last - outward*(layer - 1), layer=1, layers)]
      select case (kind)
      case (face_inflow)
        call set_layers(w, d, to, flow%inflow)
      case (face_ambient)
        call set_layers(w, d, to, flow%ambient)
      case default
        call copy_layers(w, d, from, to, merge(-1.0_wp, 1.0_wp, kind == face_symmetry))
      end select
    end subroutine fill_face

    !> Copies layers of cells, normal velocity times sign.
    subroutine copy_layers(w, d, from, to, sign)
      real(wp), allocatable, intent(inout) :: w(:, :, :, :)
      integer, intent(in) :: d, from(:), to(:)
      real(wp), intent(in) :: sign
      integer :: layer, v, j, k, first, normal
      first = lbound(w, 1)
      normal = flow%layout%velocity_row + d - 1
      select case (d)
      case (1)
        do k = lbound(w, 4), ubound(w, 4)
          do j = lbound(w, 3), ubound(w, 3)
            do v = 1, flow%layout%n_rows
              do layer = 1, size(to)
                w(to(layer), v, j, k) = merge(sign, 1.0_wp, v == normal)*w(from(layer), v, j, k)
              end do
            end do
          end do
        end do
      case (2)
        do k = lbound(w, 4), ubound(w, 4)
          do layer = 1, size(to)
            call copy_rows(size(w, 1)*size(w, 2), w(first, 1, from(layer), k), w(first, 1, to(layer), k))
            w(:, normal, to(layer), k) = sign*w(:, normal, to(layer), k)
          end do
        end do
      case (3)
        do layer = 1, size(to)
          call copy_rows(size(w, 1)*size(w, 2)*size(w, 3), w(first, 1, lbound(w, 3), from(layer)), &
            w(first, 1, lbound(w, 3), to(layer)))
          w(:, normal, :, to(layer)) = sign*w(:, normal, :, to(layer))
        end do
      end select
    end subroutine copy_layers

    pure subroutine copy_rows(n, from, to)
      integer, intent(in) :: n
      real(wp), intent(in) :: from(n)
      real(wp), intent(inout) :: to(n)
      to = from
    end subroutine copy_rows

    subroutine set_layers(w, d, to, state)
      real(wp), allocatable, intent(inout) :: w(:, :, :, :)
      integer, intent(in) :: d, to(:)
      real(wp), intent(in) :: state(:)
      integer :: layer, v
      do layer = 1, size(to)
        do v = 1, flow%layout%n_rows
          select case (d)
          case (1); w(to(layer), v, :, :) = state(v)
          case (2); w(:, v, to(layer), :) = state(v)
          case (3); w(:, v, :, to(layer)) = state(v)
          end select
        end do
      end do
    end subroutine set_layers

  end subroutine fill_boundary

end module flow_boundary
