!> What every constitutive model shares: the kinematics of one step of up to `chunk` particles, the bulk viscosity, and how stress
!> and energy follow from the pressure and the scaled deviator.
module particle_step
  use cell_functions, only: chunk
  use constants, only: third
  use kinds, only: wp
  implicit none
  private
  public :: strain_and_rotate, bulk_viscosity, deviator_work, set_stress

  !> The step of n <= chunk particles; a model reads the first part and fills in the last two arrays.
  type, public :: step_type
    real(wp) :: dt = 0, length = 0 !< time step; size of a cell
    real(wp), dimension(chunk) :: &
      trial, & !< equivalent stress of the trial deviator t (old one, rotated, plus the elastic increment)
      power, & !< t:d with the deviatoric strain increment d
      shear, & !< d:d
      strain, & !< equivalent strain increment sqrt(2/3 d:d)
      old_pressure, &
      old_volume, volume, middle, & !< volume at the start, the end, and at mid step
      compression, & !< r/r0 - 1 at the end
      speed, & !< longitudinal sound speed
      viscosity, & !< bulk viscosity, a pressure
      pressure, & !< result: at the end
      ratio !< result: what the trial deviator must be multiplied by
    real(wp) :: deviator(chunk, 6) !< t: xx, yy, zz, yz, xz, xy
  end type step_type

contains

  !> Strain increments, rotated old deviator plus elastic increment (trial deviator), and the new volume.
  !>
  !> The rotation is carried to second order in the spin increment, which keeps the invariants of the stress to fourth order.
  !> The volume changes by (1 + tr/2)/(1 - tr/2), tr the trace of the strain increment: positive, and the same backwards.
  !> g: velocity gradient times dt, see update_stress; the rest as in step_type.
  pure subroutine strain_and_rotate(n, shear_modulus, density, g, s1, s2, s3, s4, s5, s6, mass, volume_now, t, trial, power, &
      shear, strain, old_pressure, old_volume, volume, middle, compression)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, density, g(chunk, 9), mass(n), volume_now(n)
    real(wp), intent(in), dimension(n) :: s1, s2, s3, s4, s5, s6
    real(wp), intent(out) :: t(chunk, 6)
    real(wp), intent(out), dimension(n) :: trial, power, shear, strain, old_pressure, old_volume, volume, middle, compression
    real(wp) :: p, a1, a2, a3, a4, a5, a6, r1, r2, r3, r4, r5, r6, q1, q2, q3, q4, q5, q6, w12, w13, w23
    real(wp) :: d1, d2, d3, d4, d5, d6, trace, twice
    integer :: i
    twice = 2*shear_modulus
    !$omp simd private(p, a1, a2, a3, a4, a5, a6, r1, r2, r3, r4, r5, r6, q1, q2, q3, q4, q5, q6, w12, w13, w23)
    do i = 1, n
      p = -(s1(i) + s2(i) + s3(i))*third
      old_pressure(i) = p
      a1 = s1(i) + p
      a2 = s2(i) + p
      a3 = s3(i) + p
      a4 = s4(i)
      a5 = s5(i)
      a6 = s6(i)
      w12 = 0.5_wp*(g(i, 2) - g(i, 4))
      w13 = 0.5_wp*(g(i, 3) - g(i, 7))
      w23 = 0.5_wp*(g(i, 6) - g(i, 8))
      r1 = 2*(w12*a6 + w13*a5)
      r2 = 2*(w23*a4 - w12*a6)
      r3 = -2*(w13*a5 + w23*a4)
      r4 = w23*(a3 - a2) - w12*a5 - w13*a6
      r5 = w13*(a3 - a1) + w12*a4 - w23*a6
      r6 = w12*(a2 - a1) + w13*a4 + w23*a5
      q1 = 2*(w12*r6 + w13*r5)
      q2 = 2*(w23*r4 - w12*r6)
      q3 = -2*(w13*r5 + w23*r4)
      q4 = w23*(r3 - r2) - w12*r5 - w13*r6
      q5 = w13*(r3 - r1) + w12*r4 - w23*r6
      q6 = w12*(r2 - r1) + w13*r4 + w23*r5
      t(i, 1) = a1 + (r1 + 0.5_wp*q1)
      t(i, 2) = a2 + (r2 + 0.5_wp*q2)
      t(i, 3) = a3 + (r3 + 0.5_wp*q3)
      t(i, 4) = a4 + (r4 + 0.5_wp*q4)
      t(i, 5) = a5 + (r5 + 0.5_wp*q5)
      t(i, 6) = a6 + (r6 + 0.5_wp*q6)
    end do
    !$omp simd private(trace, d1, d2, d3, d4, d5, d6)
    do i = 1, n
      trace = g(i, 1) + g(i, 5) + g(i, 9)
      old_volume(i) = volume_now(i)
      volume(i) = old_volume(i)*((1 + 0.5_wp*trace)/(1 - 0.5_wp*trace))
      middle(i) = 0.5_wp*(old_volume(i) + volume(i))
      compression(i) = mass(i)/(density*volume(i)) - 1
      d1 = g(i, 1) - trace*third
      d2 = g(i, 5) - trace*third
      d3 = g(i, 9) - trace*third
      d4 = 0.5_wp*(g(i, 6) + g(i, 8))
      d5 = 0.5_wp*(g(i, 3) + g(i, 7))
      d6 = 0.5_wp*(g(i, 2) + g(i, 4))
      shear(i) = (d1*d1 + d2*d2 + d3*d3) + 2*(d4*d4 + d5*d5 + d6*d6)
      strain(i) = sqrt(2*third*shear(i))
      t(i, 1) = t(i, 1) + twice*d1
      t(i, 2) = t(i, 2) + twice*d2
      t(i, 3) = t(i, 3) + twice*d3
      t(i, 4) = t(i, 4) + twice*d4
      t(i, 5) = t(i, 5) + twice*d5
      t(i, 6) = t(i, 6) + twice*d6
      power(i) = (t(i, 1)*d1 + t(i, 2)*d2 + t(i, 3)*d3) + 2*(t(i, 4)*d4 + t(i, 5)*d5 + t(i, 6)*d6)
      trial(i) = sqrt(1.5_wp*((t(i, 1)*t(i, 1) + t(i, 2)*t(i, 2) + t(i, 3)*t(i, 3)) &
        + 2*(t(i, 4)*t(i, 4) + t(i, 5)*t(i, 5) + t(i, 6)*t(i, 6))))
    end do
  end subroutine strain_and_rotate

  !> q = r h e (linear c + quadratic h e) in compression, e = -dV/(V dt), h the cell length; zero in expansion.
  pure subroutine bulk_viscosity(n, dt, length, linear, quadratic, speed, mass, old_volume, volume, viscosity)
    integer, intent(in) :: n
    real(wp), intent(in) :: dt, length, linear, quadratic, speed(n), mass(n), old_volume(n), volume(n)
    real(wp), intent(out) :: viscosity(n)
    real(wp) :: jump, inverse
    integer :: i
    inverse = length/dt
    !$omp simd private(jump)
    do i = 1, n
      jump = max(old_volume(i)/volume(i) - 1, 0.0_wp)*inverse
      viscosity(i) = mass(i)/volume(i)*jump*(linear*speed(i) + quadratic*jump)
    end do
  end subroutine bulk_viscosity

  !> Work of the deviator in the step, for pressures that depend on the energy; the same number as in set_stress.
  pure subroutine deviator_work(n, shear_modulus, ratio, power, shear, middle, work)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, ratio(n), power(n), shear(n), middle(n)
    real(wp), intent(out) :: work(n)
    integer :: i
    !$omp simd
    do i = 1, n
      work(i) = 0.5_wp*middle(i)*((1 + ratio(i))*power(i) - 2*shear_modulus*shear(i))
    end do
  end subroutine deviator_work

  !> Stress from the scaled deviator and the pressure; energy by the mean stress power and the viscosity.
  pure subroutine set_stress(n, shear_modulus, t, ratio, pressure, power, shear, old_pressure, new_viscosity, new_volume, middle, &
      volume, energy, viscosity, s1, s2, s3, s4, s5, s6)
    integer, intent(in) :: n
    real(wp), intent(in) :: shear_modulus, t(chunk, 6)
    real(wp), intent(in), dimension(n) :: ratio, pressure, power, shear, old_pressure, new_viscosity, new_volume, middle
    real(wp), intent(inout), dimension(n) :: volume, energy
    real(wp), intent(out), dimension(n) :: viscosity, s1, s2, s3, s4, s5, s6
    integer :: i
    !$omp simd
    do i = 1, n
      s1(i) = ratio(i)*t(i, 1) - pressure(i)
      s2(i) = ratio(i)*t(i, 2) - pressure(i)
      s3(i) = ratio(i)*t(i, 3) - pressure(i)
      s4(i) = ratio(i)*t(i, 4)
      s5(i) = ratio(i)*t(i, 5)
      s6(i) = ratio(i)*t(i, 6)
    end do
    !$omp simd
    do i = 1, n
      energy(i) = energy(i) + 0.5_wp*middle(i)*((1 + ratio(i))*power(i) - 2*shear_modulus*shear(i)) &
        + (0.5_wp*(old_pressure(i) + pressure(i)) + new_viscosity(i))*(volume(i) - new_volume(i))
      viscosity(i) = new_viscosity(i)
      volume(i) = new_volume(i)
    end do
  end subroutine set_stress

end module particle_step
