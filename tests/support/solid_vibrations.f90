!> Small motions of elastic solids with exact solutions: a vibrating bar, a pulse in a bar, a thick cylinder.
module solid_vibrations
  use constants, only: pi
  use deck_types, only: material_group
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress
  use solid_numerics, only: numerics_type, choose_numerics
  use solid_scenes, only: solid_scene, empty_deck, metal, add_box, start_scene
  use solid_step, only: advance_solid, project_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: run_bar, run_pulse

  !> A bar that vibrates in its first mode.
  type, public :: bar_type
    real(wp) :: frequency = 0 !< over that of theory, less 1
    real(wp) :: loss = 0 !< energy lost per cycle, part of what there was; negative: gained
    real(wp) :: balance = 0 !< kinetic and internal energy over the first, less 1
  end type bar_type

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
    real(wp), parameter :: bulk = 200e9_wp/1.2_wp, shear = 200e9_wp/2.6_wp
    f(at_volume) = f(at_volume)*(1 + strain)
    f(at_stress) = (bulk + 4*shear/3)*strain
    f(at_stress + 1:at_stress + 2) = (bulk - 2*shear/3)*strain
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

end module solid_vibrations
