!> Motions of a solid whose course is known: rotation, extension, flight of a single particle, collision of two discs. Each is run
!> with given numerics and returns what came out.
module solid_motions
  use constants, only: pi
  use deck_types, only: body_group, material_group
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress
  use solid_numerics, only: numerics_type, choose_numerics
  use solid_scenes, only: solid_scene, empty_deck, metal, add_box, start_scene
  use solid_step, only: advance_solid, project_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: run_flight, run_rotation, run_extension, run_discs

  !> A single particle that crosses cells.
  type, public :: flight_type
    real(wp) :: velocity = 0 !< change of its velocity over the speed
    real(wp) :: position = 0 !< distance from where it should be over the path
    real(wp) :: stress = 0 !< largest stress over density times speed squared
    integer :: cells = 0 !< crossed
  end type flight_type

  !> A body that turns freely.
  type, public :: rotation_type
    real(wp) :: turns = 0
    real(wp) :: angular_momentum = 0 !< last over first, less 1
    real(wp) :: kinetic = 0 !< last over first, less 1
    real(wp) :: energy = 0 !< kinetic and internal, last over first, less 1
    real(wp) :: stress = 0 !< mean distance from the stress of a spinning disc, over density times rim speed squared
    real(wp) :: momentum = 0 !< largest component over mass times rim speed
    real(wp) :: radius = 0 !< mean distance of the particles from the centre, last over first, less 1
  end type rotation_type

  !> A bar that is drawn out.
  type, public :: extension_type
    real(wp) :: velocity = 0 !< largest error in the middle four cells over the speed there
    real(wp) :: volume = 0 !< largest relative error of the volume there
    real(wp) :: stress = 0 !< largest error of the axial stress there over the stress
  end type extension_type

  !> Two elastic discs that meet and part.
  type, public :: discs_type
    real(wp) :: momentum = 0 !< largest change of a component over mass times speed
    real(wp) :: lowest = 0 !< least kinetic energy over the first
    real(wp) :: kinetic = 0 !< last kinetic energy over the first
    real(wp) :: energy = 0 !< last kinetic and internal energy over the first, less 1
    real(wp) :: angular_momentum = 0 !< change over mass times speed times radius
  end type discs_type

contains

  !> One particle over n_cells cells of a periodic square of 8 x 8 cells, askew.
  function run_flight(numerics, n_cells) result(flight)
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: n_cells
    type(flight_type) :: flight
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    real(wp), parameter :: velocity(3) = [3000.0_wp, 1370.0_wp, 0.0_wp]
    real(wp) :: time, position(3), way(3)
    integer :: b
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    scene%deck%material = [metal('m', 'elastic')]
    call add_box(scene%deck, 'a', 'm', [1.0_wp, 1.0_wp, 0.0_wp], [1.5_wp, 1.5_wp, 1.0_wp], 0.5_wp, velocity)
    call start_scene(scene, [8, 8, 1], [0.0_wp, 0.0_wp, 0.0_wp], [8.0_wp, 8.0_wp, 1.0_wp], [4, 4, 1], [.true., .true., .false.])
    time = 0
    do while (velocity(1)*time < n_cells)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
      do b = 1, scene%mesh%n_local
        associate (blk => scene%solid%block(1, b))
          if (blk%n == 0) cycle
          flight%stress = max(flight%stress, maxval(abs(blk%f(1, at_stress:at_stress + 5))))
          flight%velocity = max(flight%velocity, norm2(blk%f(1, at_velocity:at_velocity + 2) - velocity))
          position = blk%f(1, at_position:at_position + 2)
        end associate
      end do
    end do
    way = [1.25_wp, 1.25_wp, 0.5_wp] + velocity*time - position
    way(1:2) = way(1:2) - 8*anint(way(1:2)/8)
    flight%cells = int(velocity(1)*time)
    flight%position = norm2(way)/(norm2(velocity)*time)
    flight%velocity = flight%velocity/norm2(velocity)
    flight%stress = flight%stress/(8000*norm2(velocity)**2)
  end function run_flight

  !> A stiff disc of radius 4 cells in plane strain turns freely; its rim has 3 % of the speed of sound.
  function run_rotation(numerics, turns) result(rotation)
    type(numerics_type), intent(in) :: numerics
    real(wp), intent(in) :: turns
    type(rotation_type) :: rotation
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    real(wp), parameter :: center(2) = [6.1_wp, 5.9_wp], radius = 4
    real(wp) :: rim, spin, angle, first(4), last(4), weight, stress, r2
    type(solid_totals_type) :: totals
    integer :: b, i, n_steps
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    scene%deck%material = [metal('m', 'elastic')]
    scene%deck%body = [body_group(name='disc', material='m', shape='sphere', center=[center, 0.5_wp], radius=radius, &
      spacing=0.5_wp)]
    call start_scene(scene, [12, 12, 1], [0.0_wp, 0.0_wp, 0.0_wp], [12.0_wp, 12.0_wp, 1.0_wp], [6, 6, 1])
    rim = 0.03_wp*sqrt(200e9_wp*0.7_wp/(1.3_wp*0.4_wp)/8000)
    spin = rim/radius
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          blk%f(i, at_velocity) = -spin*(blk%f(i, at_position + 1) - center(2))
          blk%f(i, at_velocity + 1) = spin*(blk%f(i, at_position) - center(1))
          if (scene%solid%at_affine(1) == 0) cycle
          blk%f(i, scene%solid%at_affine(1) + 1) = -spin
          blk%f(i, scene%solid%at_affine(1) + 3) = spin
        end do
      end associate
    end do
    call project_solid(scene%mesh, scene%halo, scene%solid)
    first = moments(scene, center)
    angle = 0
    stress = 0
    n_steps = 0
    do while (angle < 2*pi*turns)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      angle = angle + limit%dt*spin
      ! the mean over the last turn
      if (angle < 2*pi*(turns - 1)) cycle
      n_steps = n_steps + 1
      weight = 0
      r2 = 0
      do b = 1, scene%mesh%n_local
        associate (blk => scene%solid%block(1, b))
          do i = 1, blk%n
            r2 = r2 + blk%f(i, at_mass)*excess(blk%f(i, at_position:at_position + 1) - center, &
              blk%f(i, at_stress:at_stress + 5), spin, radius)
            weight = weight + blk%f(i, at_mass)
          end do
        end associate
      end do
      stress = stress + r2/weight
    end do
    last = moments(scene, center)
    totals = sum_solid(scene%mesh, scene%solid)
    rotation%turns = angle/(2*pi)
    rotation%angular_momentum = last(1)/first(1) - 1
    rotation%kinetic = last(2)/first(2) - 1
    rotation%energy = last(3)/first(3) - 1
    rotation%radius = last(4)/first(4) - 1
    rotation%stress = stress/n_steps/(8000*rim**2)
    rotation%momentum = maxval(abs(totals%momentum))/(totals%mass(1)*rim)
  end function run_rotation

  !> Angular momentum (with the part of the affine matrix, whose inertia is m h^2/4), kinetic energy, kinetic and internal energy,
  !> mean distance from the centre.
  function moments(scene, center) result(m)
    type(solid_scene), intent(in) :: scene
    real(wp), intent(in) :: center(2)
    real(wp) :: m(4), d(2), inertia
    type(solid_totals_type) :: totals
    integer :: b, i
    totals = sum_solid(scene%mesh, scene%solid)
    inertia = 0.25_wp*scene%mesh%spacing(1)**2
    m = 0
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b), affine => scene%solid%at_affine(1))
        do i = 1, blk%n
          d = blk%f(i, at_position:at_position + 1) - center
          m(1) = m(1) + blk%f(i, at_mass)*(d(1)*blk%f(i, at_velocity + 1) - d(2)*blk%f(i, at_velocity))
          m(4) = m(4) + blk%f(i, at_mass)*norm2(d)
          if (affine > 0) m(1) = m(1) + inertia*blk%f(i, at_mass)*(blk%f(i, affine + 3) - blk%f(i, affine + 1))
        end do
      end associate
    end do
    m(2) = sum(totals%kinetic)
    m(3) = m(2) + sum(totals%internal)
  end function moments

  !> Size of the difference between a stress and that of a disc in plane strain that turns steadily. With k = 1/(8 (1 - nu)) the
  !> latter is r w^2 k (3 - 2 nu) (a^2 - r^2) radially and r w^2 k ((3 - 2 nu) a^2 - (1 + 2 nu) r^2) around.
  pure real(wp) function excess(d, stress, spin, radius)
    real(wp), intent(in) :: d(2), stress(6), spin, radius
    real(wp), parameter :: nu = 0.3_wp
    real(wp) :: r2, radial, around, k, x(3)
    r2 = dot_product(d, d)
    k = 8000*spin**2/(8*(1 - nu))
    radial = k*(3 - 2*nu)*(radius**2 - r2)
    around = k*((3 - 2*nu)*radius**2 - (1 + 2*nu)*r2)
    x(1) = stress(1) - (radial*d(1)**2 + around*d(2)**2)/r2
    x(2) = stress(2) - (radial*d(2)**2 + around*d(1)**2)/r2
    x(3) = stress(6) - (radial - around)*d(1)*d(2)/r2
    excess = sqrt(x(1)**2 + x(2)**2 + 2*x(3)**2)
  end function excess

  !> A bar of 48 cells in one dimension whose velocity rises along it, stretched by the given factor before waves from its ends
  !> reach the middle: there the motion is uniform extension.
  function run_extension(numerics, stretch) result(extension)
    type(numerics_type), intent(in) :: numerics
    real(wp), intent(in) :: stretch
    type(extension_type) :: extension
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    real(wp), parameter :: low = 8, high = 56, middle = 32
    real(wp) :: rate, time, exact, bulk, shear, v, spacing
    integer :: b, i
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    scene%deck%material = [metal('m', 'elastic')]
    spacing = 0.25_wp
    call add_box(scene%deck, 'bar', 'm', [low, 0.0_wp, 0.0_wp], [high, 1.0_wp, 1.0_wp], spacing)
    call start_scene(scene, [64, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [64.0_wp, 1.0_wp, 1.0_wp], [32, 1, 1])
    ! waves run 8 cells while the bar stretches
    rate = (stretch - 1)*sqrt(200e9_wp*0.7_wp/(1.3_wp*0.4_wp)/8000)/8
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          blk%f(i, at_velocity) = rate*(blk%f(i, at_position) - middle)
        end do
      end associate
    end do
    call project_solid(scene%mesh, scene%halo, scene%solid)
    time = 0
    do while (rate*time < stretch - 1)
      limit = solid_limit(scene%mesh, scene%solid)
      limit%dt = min(limit%dt, (stretch - 1)/rate - time + 1e-9_wp*limit%dt)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
    end do
    bulk = 200e9_wp/(3*0.4_wp)
    shear = 200e9_wp/2.6_wp
    exact = bulk*(1 - 1/stretch) + 4*shear/3*log(stretch)
    do b = 1, scene%mesh%n_local
      associate (blk => scene%solid%block(1, b))
        do i = 1, blk%n
          v = rate*(blk%f(i, at_position) - middle)/(1 + rate*time)
          if (abs(v) > rate*2) cycle
          extension%velocity = max(extension%velocity, abs(blk%f(i, at_velocity) - v)/(rate*2))
          extension%volume = max(extension%volume, abs(blk%f(i, at_volume)/(spacing*stretch) - 1))
          extension%stress = max(extension%stress, abs(blk%f(i, at_stress)/exact - 1))
        end do
      end associate
    end do
  end function run_extension

  !> Two elastic discs in a square of 20 x 20 cells meet along its diagonal (Sulsky, Chen & Schreyer 1994): E = 1000, nu = 0.3,
  !> density 1000, radius 0.2, speed 0.1 along x and y each; they part at about 2.6.
  function run_discs(numerics) result(discs)
    type(numerics_type), intent(in) :: numerics
    type(discs_type) :: discs
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    type(material_group) :: group
    type(solid_totals_type) :: first, last
    real(wp) :: time, before(4), after(4)
    real(wp), parameter :: center(2) = 0.5_wp
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    group = metal('m', 'elastic')
    group%density = 1000
    group%youngs_modulus = 1000
    scene%deck%material = [group]
    scene%deck%body = [body_group(name='a', material='m', shape='sphere', center=[0.2_wp, 0.2_wp, 0.5_wp], radius=0.2_wp, &
      spacing=0.02_wp, velocity=[0.1_wp, 0.1_wp, 0.0_wp]), body_group(name='b', material='m', shape='sphere', &
      center=[0.8_wp, 0.8_wp, 0.5_wp], radius=0.2_wp, spacing=0.02_wp, velocity=[-0.1_wp, -0.1_wp, 0.0_wp])]
    call start_scene(scene, [24, 24, 1], [-0.1_wp, -0.1_wp, 0.0_wp], [1.1_wp, 1.1_wp, 1.0_wp], [12, 12, 1])
    first = sum_solid(scene%mesh, scene%solid)
    before = moments(scene, center)
    discs%lowest = 1
    time = 0
    do while (time < 3.2_wp)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
      last = sum_solid(scene%mesh, scene%solid)
      discs%lowest = min(discs%lowest, sum(last%kinetic)/sum(first%kinetic))
    end do
    after = moments(scene, center)
    discs%momentum = maxval(abs(sum(last%momentum, 2) - sum(first%momentum, 2)))/(sum(first%mass)*0.1_wp)
    discs%kinetic = sum(last%kinetic)/sum(first%kinetic)
    discs%energy = (sum(last%kinetic) + sum(last%internal))/sum(first%kinetic) - 1
    discs%angular_momentum = (after(1) - before(1))/(sum(first%mass)*0.1_wp*0.2_wp)
  end function run_discs

end module solid_motions
