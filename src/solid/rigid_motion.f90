!> Motion of one rigid body: six degrees of freedom, each of which may be held.
!>
!> The state is the place of the centre of mass, its velocity, the orientation as a matrix and the angular momentum about the centre.
!> Without a moment the angular momentum is kept to the last bit; the orientation follows from it by the implicit midpoint rule on
!> the group of rotations, which runs backwards as it runs forwards, so that the energy of a top stays within a band (Hairer,
!> Lubich & Wanner, Geometric Numerical Integration, VII.5).
module rigid_motion
  use kinds, only: wp
  implicit none
  private
  public :: push_body, turn_body, find_angular_velocity, velocity_at, cross_product

  !> A rigid body; vectors in the directions of the mesh.
  type, public :: rigid_body
    integer :: body = 0 !< number among the bodies of the solid
    real(wp) :: mass = 0
    real(wp) :: inertia(3, 3) = 0 !< about the centre, in the orientation of the start
    real(wp) :: center(3) = 0 !< of mass
    real(wp) :: velocity(3) = 0 !< of the centre
    real(wp) :: angular_momentum(3) = 0 !< about the centre; components about axes that are held mean nothing
    real(wp) :: rotation(3, 3) = reshape([real(wp) :: 1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3]) !< from the start to now
    real(wp) :: angular_velocity(3) = 0 !< follows from the orientation and the angular momentum
    real(wp) :: force(3) = 0, moment(3) = 0 !< of the load, about the centre
    logical :: free(3) = .true. !< directions in which the centre moves
    logical :: free_axis(3) = .true. !< axes about which the body turns
  end type rigid_body

  integer, parameter :: n_iterations = 12 !< of the midpoint rule; at 0.1 radian a step each gains two digits

contains

  !> Velocity and angular momentum over dt. force, moment: about the centre, without gravity. held: impulse of what holds the body.
  pure subroutine push_body(body, dt, force, moment, gravity, held)
    type(rigid_body), intent(inout) :: body
    real(wp), intent(in) :: dt, force(3), moment(3), gravity(3)
    real(wp), intent(out) :: held(3)
    real(wp) :: impulse(3)
    impulse = dt*(force + body%mass*gravity)
    held = merge(0.0_wp, -impulse, body%free)
    body%velocity = merge(body%velocity + impulse/body%mass, 0.0_wp, body%free)
    body%angular_momentum = merge(body%angular_momentum + dt*moment, 0.0_wp, body%free_axis)
    call find_angular_velocity(body)
  end subroutine push_body

  !> Place and orientation over dt.
  pure subroutine turn_body(body, dt)
    type(rigid_body), intent(inout) :: body
    real(wp), intent(in) :: dt
    real(wp) :: w(3), middle(3, 3)
    integer :: i
    body%center = body%center + dt*body%velocity
    if (.not. any(abs(body%angular_momentum) > 0)) return
    w = body%angular_velocity
    do i = 1, n_iterations
      middle = matmul(rotation_by(0.5_wp*dt*w), body%rotation)
      w = angular_velocity_of(body%inertia, middle, body%angular_momentum, body%free_axis)
    end do
    body%rotation = orthonormal(matmul(rotation_by(dt*w), body%rotation))
    call find_angular_velocity(body)
  end subroutine turn_body

  pure subroutine find_angular_velocity(body)
    type(rigid_body), intent(inout) :: body
    body%angular_velocity = angular_velocity_of(body%inertia, body%rotation, body%angular_momentum, body%free_axis)
  end subroutine find_angular_velocity

  !> Velocity of the body at a place that lies at `arm` from its centre.
  pure function velocity_at(body, arm) result(velocity)
    type(rigid_body), intent(in) :: body
    real(wp), intent(in) :: arm(3)
    real(wp) :: velocity(3)
    velocity = body%velocity + cross_product(body%angular_velocity, arm)
  end function velocity_at

  !> Solves inertia*w = angular momentum over the free axes; nil for a body that has no inertia.
  pure function angular_velocity_of(inertia, rotation, angular_momentum, free) result(w)
    real(wp), intent(in) :: inertia(3, 3), rotation(3, 3), angular_momentum(3)
    logical, intent(in) :: free(3)
    real(wp) :: w(3), a(3, 3), b(3), determinant
    integer :: d
    a = matmul(rotation, matmul(inertia, transpose(rotation)))
    b = merge(angular_momentum, 0.0_wp, free)
    do d = 1, 3
      if (free(d)) cycle
      a(d, :) = 0
      a(:, d) = 0
      a(d, d) = 1
    end do
    w = 0
    determinant = dot_product(a(:, 1), cross_product(a(:, 2), a(:, 3)))
    if (.not. determinant > 0) return
    w(1) = dot_product(b, cross_product(a(:, 2), a(:, 3)))
    w(2) = dot_product(a(:, 1), cross_product(b, a(:, 3)))
    w(3) = dot_product(a(:, 1), cross_product(a(:, 2), b))
    w = merge(w/determinant, 0.0_wp, free)
  end function angular_velocity_of

  !> The rotation by a vector: its direction is the axis, its length the angle (formula of Rodrigues).
  pure function rotation_by(angle) result(r)
    real(wp), intent(in) :: angle(3)
    real(wp) :: r(3, 3), s(3, 3), a, first, second
    a = norm2(angle)
    if (a < 1e-4_wp) then
      first = 1 - a**2/6
      second = 0.5_wp - a**2/24
    else
      first = sin(a)/a
      second = (1 - cos(a))/a**2
    end if
    s = reshape([0.0_wp, angle(3), -angle(2), -angle(3), 0.0_wp, angle(1), angle(2), -angle(1), 0.0_wp], [3, 3])
    r = first*s + second*matmul(s, s)
    r(1, 1) = r(1, 1) + 1
    r(2, 2) = r(2, 2) + 1
    r(3, 3) = r(3, 3) + 1
  end function rotation_by

  !> A matrix that is nearly a rotation, made one again (Gram and Schmidt).
  pure function orthonormal(a) result(r)
    real(wp), intent(in) :: a(3, 3)
    real(wp) :: r(3, 3)
    r(:, 1) = a(:, 1)/norm2(a(:, 1))
    r(:, 2) = a(:, 2) - dot_product(r(:, 1), a(:, 2))*r(:, 1)
    r(:, 2) = r(:, 2)/norm2(r(:, 2))
    r(:, 3) = cross_product(r(:, 1), r(:, 2))
  end function orthonormal

  pure function cross_product(a, b) result(c)
    real(wp), intent(in) :: a(3), b(3)
    real(wp) :: c(3)
    c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross_product

end module rigid_motion
