!> Times whole steps of the solid (processor time of one rank): the fastest of several short windows, since machines are shared.
module solid_speed
  use deck_types, only: body_group
  use kinds, only: wp
  use solid_scenes, only: solid_scene, empty_deck, metal, concrete, add_box, start_scene
  use solid_step, only: advance_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  implicit none
  private
  public :: time_particles

  integer, parameter, public :: n_solid_scenes = 8
  character(24), parameter, public :: solid_scene_names(n_solid_scenes) = [character(24) :: 'plasticity', 'johnson_cook', 'hjc', &
    'elastic', 'plasticity_splines', 'johnson_cook_splines', 'hjc_splines', 'plasticity_affine']
  character(64), parameter, public :: solid_scene_titles(n_solid_scenes) = [character(64) :: 'Taylor bar, J2', &
    'Taylor bar, Johnson-Cook', 'Block, HJC', 'Taylor bar, elastic', 'Taylor bar, J2, quadratic', &
    'Taylor bar, Johnson-Cook, quadratic', 'Block, HJC, quadratic', 'Taylor bar, J2, quadratic, APIC']

  type, public :: particle_speed
    integer :: particles = 0
    real(wp) :: nanoseconds = 0 !< per particle and step, all told
  end type particle_speed

  integer, parameter :: warm_up = 100, steps = 2 !< before, and of a window

contains

  !> which: number of the scene; halves: two bricks in every direction, else the code chooses.
  function time_particles(which, halves, windows) result(speed)
    integer, intent(in) :: which, windows
    logical, intent(in) :: halves
    type(particle_speed) :: speed
    type(solid_scene) :: scene
    real(wp) :: began, best
    integer :: i
    call open_scene(which, halves, scene)
    call run_steps(scene, warm_up)
    best = huge(best)
    do i = 1, windows
      began = clock()
      call run_steps(scene, steps)
      best = min(best, (clock() - began)/steps)
    end do
    speed%particles = scene%solid%n_particles
    speed%nanoseconds = 1e9_wp*best/speed%particles
  end function time_particles

  !> A copper-like bar of 21,107 particles, 190 m/s, or a block of concrete of 27,000 particles, 100 m/s; eight particles per cell.
  subroutine open_scene(which, halves, scene)
    integer, intent(in) :: which
    logical, intent(in) :: halves
    type(solid_scene), intent(inout) :: scene
    character(24) :: name
    type(body_group) :: bar
    integer :: brick(3)
    name = solid_scene_names(which)
    call empty_deck(scene%deck)
    scene%deck%solid%shape = merge('quadratic', 'linear   ', index(name, 'splines') + index(name, 'affine') > 0)
    if (index(name, 'affine') > 0) scene%deck%solid%transfer = 'apic'
    scene%deck%boundary%solid_z_low = 'symmetry'
    if (name(:3) == 'hjc') then
      brick = merge([12, 12, 10], 0, halves)
      scene%deck%material = [concrete('m')]
      call add_box(scene%deck, 'block', 'm', [0.05_wp, 0.05_wp, 0.0_wp], [0.2_wp, 0.2_wp, 0.15_wp], 0.005_wp, &
        [0.0_wp, 0.0_wp, -100.0_wp])
      call start_scene(scene, [24, 24, 20], [0.0_wp, 0.0_wp, 0.0_wp], [0.24_wp, 0.24_wp, 0.2_wp], brick)
      return
    end if
    brick = merge([10, 10, 18], 0, halves)
    select case (name(:5))
    case ('johns')
      scene%deck%material = [metal('m', 'johnson_cook')]
    case ('elast')
      scene%deck%material = [metal('m', 'elastic')]
    case default
      scene%deck%material = [metal('m', 'linear_hardening')]
    end select
    bar%name = 'bar'
    bar%material = 'm'
    bar%shape = 'cylinder'
    bar%start = 0
    bar%end = [0.0_wp, 0.0_wp, 25.4e-3_wp]
    bar%radius = 3.81e-3_wp
    bar%spacing = 0.38e-3_wp
    bar%velocity = [0.0_wp, 0.0_wp, -190.0_wp]
    scene%deck%body = [bar]
    call start_scene(scene, [20, 20, 36], [-7.6e-3_wp, -7.6e-3_wp, 0.0_wp], [7.6e-3_wp, 7.6e-3_wp, 27.36e-3_wp], brick)
  end subroutine open_scene

  subroutine run_steps(scene, n)
    type(solid_scene), intent(inout) :: scene
    integer, intent(in) :: n
    type(solid_limit_type) :: limit
    integer :: i
    do i = 1, n
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
    end do
  end subroutine run_steps

  !> Processor time: other processes may interrupt a window.
  real(wp) function clock()
    call cpu_time(clock)
  end function clock

end module solid_speed
