!> Particles to nodes, one brick and one set at a time.
!>
!> Particles come sorted by cell, so the eight nodes of a cell are added to once per cell. In cells of many particles the inner
!> loops run over particles, in others over the eight nodes; which of the two depends on the number in the cell only.
module scatter
  use cell_functions, only: cell_frame, weights, piece
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress, at_viscosity
  implicit none
  private
  public :: scatter_particles, add_momentum

  integer, parameter :: many = 24 !< particles from which loops over particles pay
  integer, parameter :: sxx = at_stress, syy = at_stress + 1, szz = at_stress + 2
  integer, parameter :: syz = at_stress + 3, sxz = at_stress + 4, sxy = at_stress + 5
  real(wp), parameter :: slope_x(8) = [-1, 1, -1, 1, -1, 1, -1, 1], start_x(8) = [1, 0, 1, 0, 1, 0, 1, 0]
  real(wp), parameter :: slope_y(8) = [-1, -1, 1, 1, -1, -1, 1, 1], start_y(8) = [1, 1, 0, 0, 1, 1, 0, 0]
  real(wp), parameter :: slope_z(8) = [-1, -1, -1, -1, 1, 1, 1, 1], start_z(8) = [1, 1, 1, 1, 0, 0, 0, 0]

contains

  !> Adds mass, momentum and internal force -sum grad N . (stress - q) V of the particles of a brick to its nodes.
  !> node: (mass, momentum); force: 3 components.
  pure subroutine scatter_particles(frame, capacity, n_field, f, cell_start, node, force)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: capacity, n_field, cell_start(:)
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(inout) :: node(0:frame%n(1), 4, 0:frame%n(2), 0:frame%n(3))
    real(wp), intent(inout) :: force(0:frame%n(1), 3, 0:frame%n(2), 0:frame%n(3))
    real(wp) :: wx(piece, 2), wy(piece, 2), wz(piece, 2), momentum(8, 4), push(8, 3)
    integer :: i, j, k, cell, first, n
    cell = 0
    do k = 1, frame%n(3)
      do j = 1, frame%n(2)
        do i = 1, frame%n(1)
          cell = cell + 1
          do first = cell_start(cell), cell_start(cell + 1) - 1, piece
            n = min(piece, cell_start(cell + 1) - first)
            call weights(frame, n, [i, j, k], f(first, at_position), f(first, at_position + 1), f(first, at_position + 2), &
              wx, wy, wz)
            if (n < many) then
              call momentum_of_few(n, capacity, f(first, 1), wx, wy, wz, momentum)
              call force_of_few(n, frame%inverse, capacity, f(first, 1), wx, wy, wz, push)
            else
              call momentum_of_many(n, capacity, f(first, 1), wx, wy, wz, momentum)
              call force_of_many(n, frame%inverse, capacity, f(first, 1), wx, wy, wz, push)
            end if
            call add_to_nodes(frame%n, 4, momentum, i, j, k, node)
            call add_to_nodes(frame%n, 3, push, i, j, k, force)
          end do
        end do
      end do
    end do
  end subroutine scatter_particles

  !> Adds the momenta of n <= piece particles of a cell to the nodes. f: their first row; wx, wy, wz: from weights.
  pure subroutine add_momentum(frame, n, capacity, f, wx, wy, wz, i, j, k, node)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: n, capacity, i, j, k
    real(wp), intent(in) :: f(capacity, *), wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(inout) :: node(0:frame%n(1), 3, 0:frame%n(2), 0:frame%n(3))
    real(wp) :: momentum(8, 4)
    if (n < many) then
      call momentum_of_few(n, capacity, f, wx, wy, wz, momentum)
    else
      call momentum_of_many(n, capacity, f, wx, wy, wz, momentum)
    end if
    call add_to_nodes(frame%n, 3, momentum(:, 2:4), i, j, k, node)
  end subroutine add_momentum

  pure subroutine add_to_nodes(n, n_var, part, i, j, k, a)
    integer, intent(in) :: n(3), n_var, i, j, k
    real(wp), intent(in) :: part(8, n_var)
    real(wp), intent(inout) :: a(0:n(1), n_var, 0:n(2), 0:n(3))
    integer :: v
    do v = 1, n_var
      a(i - 1, v, j - 1, k - 1) = a(i - 1, v, j - 1, k - 1) + part(1, v)
      a(i, v, j - 1, k - 1) = a(i, v, j - 1, k - 1) + part(2, v)
      a(i - 1, v, j, k - 1) = a(i - 1, v, j, k - 1) + part(3, v)
      a(i, v, j, k - 1) = a(i, v, j, k - 1) + part(4, v)
      a(i - 1, v, j - 1, k) = a(i - 1, v, j - 1, k) + part(5, v)
      a(i, v, j - 1, k) = a(i, v, j - 1, k) + part(6, v)
      a(i - 1, v, j, k) = a(i - 1, v, j, k) + part(7, v)
      a(i, v, j, k) = a(i, v, j, k) + part(8, v)
    end do
  end subroutine add_to_nodes

  !> Mass and momentum at the eight nodes: loop over nodes inside.
  pure subroutine momentum_of_few(n, capacity, f, wx, wy, wz, total)
    integer, intent(in) :: n, capacity
    real(wp), intent(in) :: f(capacity, *), wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(out) :: total(8, 4)
    real(wp) :: x, y, z, m, u, v, w, part
    integer :: q, l
    total = 0
    do q = 1, n
      x = wx(q, 2)
      y = wy(q, 2)
      z = wz(q, 2)
      m = f(q, at_mass)
      u = f(q, at_velocity)
      v = f(q, at_velocity + 1)
      w = f(q, at_velocity + 2)
      !$omp simd private(part)
      do l = 1, 8
        part = (m*(start_x(l) + slope_x(l)*x))*((start_y(l) + slope_y(l)*y)*(start_z(l) + slope_z(l)*z))
        total(l, 1) = total(l, 1) + part
        total(l, 2) = total(l, 2) + part*u
        total(l, 3) = total(l, 3) + part*v
        total(l, 4) = total(l, 4) + part*w
      end do
    end do
  end subroutine momentum_of_few

  !> Internal force at the eight nodes: loop over nodes inside.
  pure subroutine force_of_few(n, inverse, capacity, f, wx, wy, wz, total)
    integer, intent(in) :: n, capacity
    real(wp), intent(in) :: inverse(3), f(capacity, *), wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(out) :: total(8, 3)
    real(wp) :: x, y, z, v, f1, f2, f3, f4, f5, f6, ax, ay, az, gx, gy, gz, per_x(8), per_y(8), per_z(8)
    integer :: q, l
    total = 0
    per_x = -slope_x*inverse(1)
    per_y = -slope_y*inverse(2)
    per_z = -slope_z*inverse(3)
    do q = 1, n
      x = wx(q, 2)
      y = wy(q, 2)
      z = wz(q, 2)
      v = f(q, at_volume)
      f1 = v*(f(q, sxx) - f(q, at_viscosity))
      f2 = v*(f(q, syy) - f(q, at_viscosity))
      f3 = v*(f(q, szz) - f(q, at_viscosity))
      f4 = v*f(q, syz)
      f5 = v*f(q, sxz)
      f6 = v*f(q, sxy)
      !$omp simd private(ax, ay, az, gx, gy, gz)
      do l = 1, 8
        ax = start_x(l) + slope_x(l)*x
        ay = start_y(l) + slope_y(l)*y
        az = start_z(l) + slope_z(l)*z
        gx = per_x(l)*(ay*az)
        gy = per_y(l)*(ax*az)
        gz = per_z(l)*(ax*ay)
        total(l, 1) = total(l, 1) + ((f1*gx + f6*gy) + f5*gz)
        total(l, 2) = total(l, 2) + ((f6*gx + f2*gy) + f4*gz)
        total(l, 3) = total(l, 3) + ((f5*gx + f4*gy) + f3*gz)
      end do
    end do
  end subroutine force_of_few

  !> Mass and momentum at the eight nodes: loops over particles inside, two nodes at a time.
  pure subroutine momentum_of_many(n, capacity, f, wx, wy, wz, total)
    integer, intent(in) :: n, capacity
    real(wp), intent(in) :: f(capacity, *), wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(out) :: total(8, 4)
    real(wp) :: mass(piece, 4), w, a0, a1, a2, a3, b0, b1, b2, b3
    integer :: q, b
    !$omp simd
    do q = 1, n
      mass(q, 1) = f(q, at_mass)*(wy(q, 1)*wz(q, 1))
      mass(q, 2) = f(q, at_mass)*(wy(q, 2)*wz(q, 1))
      mass(q, 3) = f(q, at_mass)*(wy(q, 1)*wz(q, 2))
      mass(q, 4) = f(q, at_mass)*(wy(q, 2)*wz(q, 2))
    end do
    do b = 1, 4
      a0 = 0; a1 = 0; a2 = 0; a3 = 0
      b0 = 0; b1 = 0; b2 = 0; b3 = 0
      !$omp simd private(w) reduction(+:a0, a1, a2, a3, b0, b1, b2, b3)
      do q = 1, n
        w = mass(q, b)*wx(q, 1)
        a0 = a0 + w
        a1 = a1 + w*f(q, at_velocity)
        a2 = a2 + w*f(q, at_velocity + 1)
        a3 = a3 + w*f(q, at_velocity + 2)
        w = mass(q, b)*wx(q, 2)
        b0 = b0 + w
        b1 = b1 + w*f(q, at_velocity)
        b2 = b2 + w*f(q, at_velocity + 1)
        b3 = b3 + w*f(q, at_velocity + 2)
      end do
      total(2*b - 1, :) = [a0, a1, a2, a3]
      total(2*b, :) = [b0, b1, b2, b3]
    end do
  end subroutine momentum_of_many

  !> Internal force at the eight nodes: loops over particles inside, sums for each pair of faces of the cell.
  pure subroutine force_of_many(n, inverse, capacity, f, wx, wy, wz, total)
    integer, intent(in) :: n, capacity
    real(wp), intent(in) :: inverse(3), f(capacity, *), wx(piece, 2), wy(piece, 2), wz(piece, 2)
    real(wp), intent(out) :: total(8, 3)
    real(wp) :: flux(piece, 6), face(3, 2, 2, 3), v
    integer :: q, a, b, c, l
    !$omp simd private(v)
    do q = 1, n
      v = f(q, at_volume)
      flux(q, 1) = v*(f(q, sxx) - f(q, at_viscosity))
      flux(q, 2) = v*(f(q, syy) - f(q, at_viscosity))
      flux(q, 3) = v*(f(q, szz) - f(q, at_viscosity))
      flux(q, 4) = v*f(q, syz)
      flux(q, 5) = v*f(q, sxz)
      flux(q, 6) = v*f(q, sxy)
    end do
    do c = 1, 2
      call face_sums(n, flux(:, 1), flux(:, 6), flux(:, 5), wy, wz(:, c), face(:, :, c, 1))
      call face_sums(n, flux(:, 6), flux(:, 2), flux(:, 4), wx, wz(:, c), face(:, :, c, 2))
      call face_sums(n, flux(:, 5), flux(:, 4), flux(:, 3), wx, wy(:, c), face(:, :, c, 3))
    end do
    do c = 1, 3
      face(:, :, :, c) = face(:, :, :, c)*inverse(c)
    end do
    do l = 0, 7
      a = iand(l, 1)
      b = iand(l/2, 1)
      c = l/4
      total(l + 1, :) = (1 - 2*a)*face(:, 1 + b, 1 + c, 1) + (1 - 2*b)*face(:, 1 + a, 1 + c, 2) + (1 - 2*c)*face(:, 1 + a, 1 + b, 3)
    end do
  end subroutine force_of_many

  !> Sums over n particles of (f1, f2, f3) times the weights u(:,1) v and u(:,2) v of two corners of a cell face.
  pure subroutine face_sums(n, f1, f2, f3, u, v, total)
    integer, intent(in) :: n
    real(wp), intent(in) :: f1(piece), f2(piece), f3(piece), u(piece, 2), v(piece)
    real(wp), intent(out) :: total(3, 2)
    real(wp) :: w, a1, a2, a3, b1, b2, b3
    integer :: q
    a1 = 0; a2 = 0; a3 = 0
    b1 = 0; b2 = 0; b3 = 0
    !$omp simd private(w) reduction(+:a1, a2, a3, b1, b2, b3)
    do q = 1, n
      w = u(q, 1)*v(q)
      a1 = a1 + w*f1(q)
      a2 = a2 + w*f2(q)
      a3 = a3 + w*f3(q)
      w = u(q, 2)*v(q)
      b1 = b1 + w*f1(q)
      b2 = b2 + w*f2(q)
      b3 = b3 + w*f3(q)
    end do
    total(:, 1) = [a1, a2, a3]
    total(:, 2) = [b1, b2, b3]
  end subroutine face_sums

end module scatter
