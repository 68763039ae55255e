!> Small motions of elastic solids with exact solutions: a vibrating bar, a pulse in a bar, a thick cylinder.
module solid_vibrations
  use blocks, only: block, allocate_cells
  use constants, only: pi
  use deck_types, only: material_group, body_group, hole_group
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress
  use solid_numerics, only: numerics_type, choose_numerics
  use solid_scenes, only: solid_scene, empty_deck, metal, add_box, start_scene
  use solid_load, only: load_particles
  use solid_step, only: advance_solid, project_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: run_bar, run_pulse, run_cylinder

  real(wp), parameter :: shear = 200e9_wp/2.6_wp, modulus = 200e9_wp/1.2_wp + 4*shear/3 !< of the metal: G and K + 4/3 G
  real(wp), parameter :: layer = 0.25_wp !< of the cylinder that carries the load

  !> A bar that vibrates in its first mode.
  type, public :: bar_type
    real(wp) :: frequency = 0 !< over that of theory, less 1
    real(wp) :: loss = 0 !< energy lost per cycle, part of what there was; negative: gained
    real(wp) :: balance = 0 !< kinetic and internal energy over the first, less 1
  end type bar_type

  !> A thick cylinder loaded from inside.
  type, public :: cylinder_type
    real(wp) :: displacement = 0 !< mean error of the radial displacement over the largest
    real(wp) :: stress = 0 !< mean error of the stress around, away from the surfaces, over the largest
  end type cylinder_type

contains

  !> A bar of 25 cells in one dimension, held at one end, n_cycles cycles of its first mode. E = 100, density 1, so c = 10
  !> (nu = 0). speed: of the free end at the start; its amplitude is 1.6 times that, in cells.
  function run_bar(numerics, n_cycles, speed) result(bar)
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: n_cycles
    real(wp), intent(in) :: speed
    type(bar_type) :: bar
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    type(material_group) :: group
    type(solid_totals_type) :: totals
    real(wp), parameter :: length = 25
    real(wp) :: time, start, amplitude, last, crossing(2), peak(2)
    integer :: b, i, n_crossings
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    group = metal('m', 'elastic')
    group%density = 1
    group%youngs_modulus = 100
    group%poissons_ratio = 0
    scene%deck%material = [group]
    scene%deck%boundary%solid_x_low = 'symmetry'
    call add_box(scene%deck, 'bar', 'm', [0.0_wp, 0.0_wp, 0.0_wp], [length, 1.0_wp, 1.0_wp], 0.5_wp)
    call start_scene(scene, [30, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [30.0_wp, 1.0_wp, 1.0_wp], [15, 1, 1])
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          blk%f(i, at_velocity) = speed*sin(0.5_wp*pi*blk%f(i, at_position)/length)
        end do
      end associate
    end do
    call project_solid(scene%mesh, scene%halo, scene%solid)
    totals = sum_solid(scene%mesh, scene%solid)
    start = totals%kinetic(1)
    last = mode(scene, length)
    time = 0
    n_crossings = 0
    crossing = 0
    peak = 0
    do while (n_crossings < 2*n_cycles + 1)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      amplitude = mode(scene, length)
      totals = sum_solid(scene%mesh, scene%solid)
      ! largest kinetic energy of the first and of the last half cycle between two crossings
      if (n_crossings == 1) peak(1) = max(peak(1), totals%kinetic(1))
      if (n_crossings == 2*n_cycles) peak(2) = max(peak(2), totals%kinetic(1))
      if (amplitude*last <= 0) then
        n_crossings = n_crossings + 1
        crossing(2) = time + limit%dt*last/(last - amplitude)
        if (n_crossings == 1) crossing(1) = crossing(2)
      end if
      last = amplitude
      time = time + limit%dt
    end do
    bar%frequency = 0.5_wp*(n_crossings - 1)/(crossing(2) - crossing(1))*(4*length/10) - 1
    bar%loss = 1 - (peak(2)/peak(1))**(1/(n_cycles - 0.5_wp))
    bar%balance = (totals%kinetic(1) + totals%internal(1))/start - 1
  end function run_bar

  !> Part of the first mode in the velocities.
  real(wp) function mode(scene, length)
    type(solid_scene), intent(in) :: scene
    real(wp), intent(in) :: length
    integer :: b, i
    mode = 0
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          mode = mode + blk%f(i, at_mass)*blk%f(i, at_velocity)*sin(0.5_wp*pi*blk%f(i, at_position)/length)
        end do
      end associate
    end do
  end function mode

  !> Speed of a smooth pulse in a bar in one dimension over the speed of sound, less 1. The pulse is 64 cells wide and travels 100;
  !> its place is the mean of the squared velocity.
  real(wp) function run_pulse(numerics)
    type(numerics_type), intent(in) :: numerics
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    real(wp) :: c, time, x, w, place(2), strain
    real(wp), parameter :: width = 64, middle = 40, speed = 0.01_wp
    integer :: b, i
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    scene%deck%material = [metal('m', 'elastic')]
    call add_box(scene%deck, 'bar', 'm', [0.0_wp, 0.0_wp, 0.0_wp], [200.0_wp, 1.0_wp, 1.0_wp], 0.5_wp)
    call start_scene(scene, [200, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [200.0_wp, 1.0_wp, 1.0_wp], [50, 1, 1])
    c = sqrt(200e9_wp*0.7_wp/(1.3_wp*0.4_wp)/8000)
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          x = (blk%f(i, at_position) - middle)/width
          if (abs(x) > 0.5_wp) cycle
          blk%f(i, at_velocity) = speed*cos(pi*x)**2
          ! a wave that runs to the right only: strain -v/c
          strain = -blk%f(i, at_velocity)/c
          call strain_uniaxially(blk%f(i, :), strain)
        end do
      end associate
    end do
    call project_solid(scene%mesh, scene%halo, scene%solid)
    call center_of_pulse(scene, place(1), w)
    time = 0
    do while (time*c < 100)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
    end do
    call center_of_pulse(scene, place(2), w)
    run_pulse = (place(2) - place(1))/(c*time) - 1
  end function run_pulse

  !> Stress and volume of a particle of the metal after a small strain along x.
  subroutine strain_uniaxially(f, strain)
    real(wp), intent(inout) :: f(:)
    real(wp), intent(in) :: strain
    f(at_volume) = f(at_volume)*(1 + strain)
    f(at_stress) = modulus*strain
    f(at_stress + 1:at_stress + 2) = (modulus - 2*shear)*strain
  end subroutine strain_uniaxially

  subroutine center_of_pulse(scene, place, weight)
    type(solid_scene), intent(in) :: scene
    real(wp), intent(out) :: place, weight
    integer :: b, i
    real(wp) :: v2
    place = 0
    weight = 0
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          v2 = blk%f(i, at_velocity)**2
          place = place + v2*blk%f(i, at_position)
          weight = weight + v2
        end do
      end associate
    end do
    place = place/weight
  end subroutine center_of_pulse

  !> A quarter of a cylinder of radii 1 and 2 in plane strain. A radial force per volume in its innermost quarter stands for a
  !> pressure, so that the boundary needs no treatment of its own; beyond it Lame's solution holds. The load rises slowly and the
  !> motion is damped; cells: per unit length.
  function run_cylinder(numerics, cells) result(cylinder)
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: cells
    type(cylinder_type) :: cylinder
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    real(wp), allocatable :: start(:, :)
    real(wp), parameter :: force = 1e6_wp
    type(block), allocatable :: scale(:), load(:)
    integer, parameter :: none(3) = 0
    real(wp) :: c, time, x(2), r, exact, around, largest(2), weight(2), volume
    integer :: b, i, cell(2)
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    scene%deck%material = [metal('m', 'elastic')]
    scene%deck%boundary%solid_x_low = 'symmetry'
    scene%deck%boundary%solid_y_low = 'symmetry'
    scene%deck%body = [body_group(name='a', material='m', shape='sphere', center=[0.0_wp, 0.0_wp, 0.5_wp], radius=2.0_wp, &
      spacing=0.5_wp/cells)]
    scene%deck%hole = [hole_group(body='a', shape='sphere', center=[0.0_wp, 0.0_wp, 0.5_wp], radius=1.0_wp)]
    call start_scene(scene, [2*cells + 2, 2*cells + 2, 1], [0.0_wp, 0.0_wp, 0.0_wp], &
      [2 + 2.0_wp/cells, 2 + 2.0_wp/cells, 1.0_wp], [2*cells + 2, 2*cells + 2, 1], loaded=.true.)
    allocate (start(2, scene%solid%n_particles))
    volume = 0
    allocate (scale(scene%mesh%n_local))
    call allocate_cells(scale(1), scene%mesh%brick_cells, none, 3, 0.0_wp)
    associate (blk => scene%solid%block(1, 1))
      do i = 1, blk%n
        x = blk%f(i, at_position:at_position + 1)
        start(:, blk%id(i)) = x
        if (norm2(x) > 1 + layer) cycle
        volume = volume + blk%f(i, at_volume)
        cell = 1 + int(x*cells)
        scale(1)%a(cell(1), 1:2, cell(2), 1) = scale(1)%a(cell(1), 1:2, cell(2), 1) + force*blk%f(i, at_volume)*x/norm2(x)
      end do
    end associate
    ! the particles of the layer have not quite its volume
    r = 0.25_wp*pi*((1 + layer)**2 - 1)/volume
    scale(1)%a = r*scale(1)%a
    allocate (load(1), source=scale(1:1))
    c = sqrt(modulus/8000)
    time = 0
    do while (time*c < 40)
      limit = solid_limit(scene%mesh, scene%solid)
      ! damped particles, so that they come to rest
      do b = 1, scene%mesh%n_local
        associate (blk => scene%solid%block(1, b))
          do i = 1, blk%n
            blk%f(i, at_velocity:at_velocity + 1) = (1 - 0.6_wp*c*limit%dt)*blk%f(i, at_velocity:at_velocity + 1)
          end do
        end associate
      end do
      call project_solid(scene%mesh, scene%halo, scene%solid)
      load(1)%a = min(time*c/10, 1.0_wp)*scale(1)%a
      call load_particles(scene%mesh, scene%solid, load, limit%dt)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
    end do
    largest = [lame(1 + layer, force), hoop(1 + layer, force)]
    weight = 0
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          x = start(:, blk%id(i))
          r = norm2(x)
          if (r < 1 + layer) cycle
          exact = lame(r, force)
          cylinder%displacement = cylinder%displacement &
            + abs(dot_product(blk%f(i, at_position:at_position + 1) - x, x)/r - exact)/largest(1)
          weight(1) = weight(1) + 1
          if (r < 1.4_wp .or. r > 1.8_wp) cycle
          around = (blk%f(i, at_stress)*x(2)**2 + blk%f(i, at_stress + 1)*x(1)**2 - 2*blk%f(i, at_stress + 5)*x(1)*x(2))/r**2
          cylinder%stress = cylinder%stress + abs(around - hoop(r, force))/largest(2)
          weight(2) = weight(2) + 1
        end do
      end associate
    end do
    cylinder%displacement = cylinder%displacement/weight(1)
    cylinder%stress = cylinder%stress/weight(2)
  end function run_cylinder

  !> Constants of the outer part of the cylinder, u = a r + b/r: its outer surface is free; in the layer u = a' r + b'/r - f r^2/(3
  !> M), the inner surface is free, and displacement and radial stress pass from one to the other.
  pure function outer_constants(load) result(k)
    real(wp), intent(in) :: load
    real(wp) :: k(2), m, g2, s, x, ratio, inner, p
    m = modulus
    g2 = 2*shear
    s = 1 + layer
    ! radial stress of a r + b/r: (2 M - 2 G) a - 2 G b/r^2; of the particular part: -f r (2 M + lambda)/(3 M), lambda = M - 2 G
    p = load*(3*m - g2)/(3*m)
    ! b = ratio a (outer), b' = ratio' a' + inner (layer, free at r = 1)
    ratio = (2*m - g2)/g2*4
    inner = -p/g2
    x = (2*m - g2)/g2
    ! two equations at r = s for a and a'
    block
      real(wp) :: e(2, 2), rhs(2), det
      e(1, :) = [s + ratio/s, -(s + x/s)]
      rhs(1) = inner/s - load*s**2/(3*m)
      e(2, :) = [(2*m - g2) - g2*ratio/s**2, -((2*m - g2) - g2*x/s**2)]
      rhs(2) = -g2*inner/s**2 - p*s
      det = e(1, 1)*e(2, 2) - e(1, 2)*e(2, 1)
      k(1) = (rhs(1)*e(2, 2) - e(1, 2)*rhs(2))/det
      k(2) = ratio*k(1)
    end block
  end function outer_constants

  !> Radial displacement.
  pure real(wp) function lame(r, load)
    real(wp), intent(in) :: r, load
    real(wp) :: k(2)
    k = outer_constants(load)
    lame = k(1)*r + k(2)/r
  end function lame

  !> Stress around.
  pure real(wp) function hoop(r, load)
    real(wp), intent(in) :: r, load
    real(wp) :: k(2)
    k = outer_constants(load)
    hoop = (2*modulus - 2*shear)*k(1) + 2*shear*k(2)/r**2
  end function hoop

end module solid_vibrations
