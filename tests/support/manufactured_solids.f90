!> Manufactured solutions of the solid in two dimensions: a motion is prescribed, and the body force that it needs is given to the
!> particles as a kick before each step. The error of the positions then shows the order of the method.
!>
!> With g = A (1 - cos(2 pi t/T))/2 in both:
!> axis_aligned: u = g sin(2 pi X), v = -g sin(2 pi Y) in a unit square whose sides slide (as Sadeghirad, Brannon & Burghardt 2011,
!> with a course over time that starts from rest);
!> vortex: rings turn by g (1 - 16 (R - 1)^2)^4 for 3/4 < R < 5/4, which shears without any change of volume. Kamojjala, Brannon,
!> Sadeghirad & Guilkey (2015) have the power 2, with which the body force jumps at the edges of the ring; here it is smooth, and
!> the ring lies in a square at rest instead of alone, so that no surface is near.
module manufactured_solids
  use constants, only: pi
  use deck_types, only: material_group
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_stress
  use solid_numerics, only: numerics_type, choose_numerics
  use solid_scenes, only: solid_scene, empty_deck, metal, add_box, start_scene
  use solid_step, only: advance_solid, project_solid
  implicit none
  private
  public :: run_manufactured, force_of

  !> Which motion, of which material, and how large.
  type, public :: manufactured_type
    character(12) :: motion = 'axis_aligned' !< or vortex
    character(12) :: law = 'elastic' !< model of the material: elastic (hypoelastic, Jaumann) or neo_hookean
    real(wp) :: amplitude = 0 !< of the displacement in a square of 1, or of the angle
    real(wp) :: end_time = 1 !< periods
    real(wp) :: cfl = 0.4_wp !< of the compression wave
  end type manufactured_type

  real(wp), parameter :: density = 1000, youngs_modulus = 1e7_wp, poissons_ratio = 0.3_wp
  real(wp), parameter :: shear = youngs_modulus/(2*(1 + poissons_ratio)), bulk = youngs_modulus/(3*(1 - 2*poissons_ratio))
  real(wp), parameter :: period = 0.02_wp !< of both motions: 2 sqrt(density/E)

contains

  !> Error of a run on a mesh of `cells` cells per unit length: largest over time of the root mean square distance of the particles
  !> from where they should be, over the amplitude.
  function run_manufactured(problem, numerics, cells) result(error)
    type(manufactured_type), intent(in) :: problem
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: cells
    real(wp) :: error
    type(solid_scene) :: scene
    type(material_group) :: group
    real(wp), allocatable :: label(:, :)
    real(wp) :: lower(3), upper(3), time, dt, total, mass, position(2), velocity(2), force(2)
    integer :: n, step, n_steps, b, i
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    group = metal('m', problem%law)
    group%density = density
    group%youngs_modulus = youngs_modulus
    group%poissons_ratio = poissons_ratio
    scene%deck%material = [group]
    lower = 0
    upper = 1
    n = cells
    if (problem%motion == 'vortex') then
      lower(1:2) = -1.5_wp
      upper(1:2) = 1.5_wp
      n = 3*cells
    else
      scene%deck%boundary%solid_x_low = 'symmetry'
      scene%deck%boundary%solid_x_high = 'symmetry'
      scene%deck%boundary%solid_y_low = 'symmetry'
      scene%deck%boundary%solid_y_high = 'symmetry'
    end if
    call add_box(scene%deck, 'body', 'm', lower, upper, 0.5_wp/cells)
    call start_scene(scene, [n, n, 1], lower, upper, [n, n, 1])
    call list_labels(scene, label)
    n_steps = ceiling(problem%end_time*period*cells*125/problem%cfl)
    dt = problem%end_time*period/n_steps
    error = 0
    ! velocities live half a step before positions
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          call motion_of(problem, label(:, blk%id(i)), -0.5_wp*dt, position, velocity)
          blk%f(i, at_velocity:at_velocity + 1) = velocity
        end do
      end associate
    end do
    do step = 1, n_steps
      time = (step - 1)*dt
      do b = 1, scene%mesh%n_local
        associate (blk => scene%solid%block(1, b))
          do i = 1, blk%n
            force = force_of(problem, label(:, blk%id(i)), time)
            blk%f(i, at_velocity:at_velocity + 1) = blk%f(i, at_velocity:at_velocity + 1) + dt*force
          end do
        end associate
      end do
      call project_solid(scene%mesh, scene%halo, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, dt)
      total = 0
      mass = 0
      do b = 1, scene%mesh%n_local
        associate (blk => scene%solid%block(1, b))
          do i = 1, blk%n
            call motion_of(problem, label(:, blk%id(i)), time + dt, position, velocity)
            total = total + blk%f(i, at_mass)*sum((blk%f(i, at_position:at_position + 1) - position)**2)
            mass = mass + blk%f(i, at_mass)
          end do
        end associate
      end do
      error = max(error, sqrt(total/mass)/problem%amplitude)
    end do
  end function run_manufactured

  !> Positions at the start, by particle number.
  subroutine list_labels(scene, label)
    type(solid_scene), intent(in) :: scene
    real(wp), allocatable, intent(out) :: label(:, :)
    integer :: b, i
    allocate (label(2, scene%solid%n_particles))
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          label(:, blk%id(i)) = blk%f(i, at_position:at_position + 1)
        end do
      end associate
    end do
  end subroutine list_labels

  !> Position and velocity of the particle that starts at x.
  pure subroutine motion_of(problem, x, time, position, velocity)
    type(manufactured_type), intent(in) :: problem
    real(wp), intent(in) :: x(2), time
    real(wp), intent(out) :: position(2), velocity(2)
    real(wp) :: shape(2), turn, rate, r, angle, f(0:2), g(0:2)
    if (problem%motion == 'vortex') then
      r = norm2(x)
      f = ring(r)
      g = course(problem%amplitude, time)
      turn = f(0)*g(0)
      rate = f(0)*g(1)
      angle = atan2(x(2), x(1)) + turn
      position = r*[cos(angle), sin(angle)]
      velocity = r*rate*[-sin(angle), cos(angle)]
    else
      g = course(problem%amplitude, time)
      shape = [1, -1]*sin(2*pi*x)
      position = x + shape*g(0)
      velocity = shape*g(1)
    end if
  end subroutine motion_of

  !> Body force per mass that the particle that starts at x needs: acceleration less divergence of the stress over density.
  pure function force_of(problem, x, time) result(force)
    type(manufactured_type), intent(in) :: problem
    real(wp), intent(in) :: x(2), time
    real(wp) :: force(2)
    real(wp) :: f(2), slope(2), jacobian, other, r, a(0:2), g(0:2), gamma, gamma_slope, radial, around, angle
    integer :: d
    if (problem%motion == 'vortex') then
      r = norm2(x)
      a = ring(r)
      g = course(problem%amplitude, time)
      gamma = r*a(1)*g(0)
      gamma_slope = (a(1) + r*a(2))*g(0)
      if (problem%law == 'neo_hookean') then
        ! stress: rr -G gamma^2/3, tt 2 G gamma^2/3, rt G gamma
        radial = -shear*(2*gamma*gamma_slope/3 + gamma**2/r)
        around = shear*(gamma_slope + 2*gamma/r)
      else
        ! rate of Jaumann in simple shear: rr -G (1 - cos gamma), tt the opposite, rt G sin gamma
        radial = -shear*(sin(gamma)*gamma_slope + 2*(1 - cos(gamma))/r)
        around = shear*(cos(gamma)*gamma_slope + 2*sin(gamma)/r)
      end if
      radial = -r*(a(0)*g(1))**2 - radial/density
      around = r*a(0)*g(2) - around/density
      angle = atan2(x(2), x(1)) + a(0)*g(0)
      force = radial*[cos(angle), sin(angle)] + around*[-sin(angle), cos(angle)]
    else
      g = course(problem%amplitude, time)
      f = 1 + 2*pi*[1, -1]*cos(2*pi*x)*g(0)
      slope = -4*pi**2*[1, -1]*sin(2*pi*x)*g(0)
      jacobian = f(1)*f(2)
      do d = 1, 2
        if (problem%law == 'neo_hookean') then
          ! Cauchy stress: G J**(-5/3) (2 F^2 - other^2 - 1)/3 + K/2 (J - 1/J), times the other F
          other = f(3 - d)
          force(d) = slope(d)*other*(4*shear*f(d)/3*jacobian**(-5/3.0_wp) + other*(0.5_wp*bulk*(1 + 1/jacobian**2) &
            - 5*shear/9*jacobian**(-8/3.0_wp)*(2*f(d)**2 - other**2 - 1)))
        else
          ! Cauchy stress: K (1 - 1/J) + 2 G (ln F - ln J/3), times the other F
          force(d) = slope(d)*(bulk + 4*shear/3*jacobian)/f(d)**2
        end if
      end do
      force = [1, -1]*sin(2*pi*x)*g(2) - force/density
    end if
  end function force_of

  !> H(R) of the vortex and its first two derivatives.
  pure function ring(r) result(h)
    real(wp), intent(in) :: r
    real(wp) :: h(0:2), s, q
    s = r - 1
    h = 0
    if (abs(s) >= 0.25_wp) return
    q = 1 - 16*s**2
    h = [q**4, -128*s*q**3, -128*q**3 + 12288*s**2*q**2]
  end function ring

  !> Course of both motions over time, and its first two derivatives.
  pure function course(amplitude, time) result(g)
    real(wp), intent(in) :: amplitude, time
    real(wp) :: g(0:2), w
    w = 2*pi/period
    g = 0.5_wp*amplitude*[1 - cos(w*time), w*sin(w*time), w**2*cos(w*time)]
  end function course

end module manufactured_solids
