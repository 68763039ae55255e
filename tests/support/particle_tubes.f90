!> Tubes filled with particles of two fluids that meet in the middle: the Riemann problem of pure MPM, and its errors.
module particle_tubes
  use deck_types, only: material_group, body_group
  use exact_riemann, only: side_type, riemann_solution, solve_riemann
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress
  use solid_scenes, only: solid_scene, empty_deck, set_faces, start_scene
  use solid_step, only: advance_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: run_tube, ideal_gas_fluid, jwl_fluid

  !> What a tube came to. Errors: L1 over the tube, divided by its length.
  type, public :: tube_result
    real(wp) :: density = 0, velocity = 0, pressure = 0 !< errors
    real(wp) :: star_pressure = 0, star_velocity = 0 !< mean between contact and the shock to the right, middle half of the way
    real(wp) :: exact_pressure = 0, exact_velocity = 0 !< there
    real(wp) :: noise = 0 !< standard deviation of the velocity there, over the exact one
    real(wp) :: energy_drift = 0 !< change of kinetic and internal energy over the first
    integer :: steps = 0
  end type tube_result

contains

  !> A gas as particles.
  pure function ideal_gas_fluid(name, density, gamma) result(group)
    character(*), intent(in) :: name
    real(wp), intent(in) :: density, gamma
    type(material_group) :: group
    group%name = name
    group%model = 'fluid'
    group%eos = 'ideal_gas'
    group%density = density
    group%gamma = gamma
  end function ideal_gas_fluid

  !> Detonation products of TNT as particles (SI; constants of Ni et al. 2022).
  pure function jwl_fluid(name) result(group)
    character(*), intent(in) :: name
    type(material_group) :: group
    group%name = name
    group%model = 'fluid'
    group%eos = 'jwl'
    group%density = 1630
    group%energy_per_volume = 7.0e9_wp
    group%jwl_a = 371.2e9_wp
    group%jwl_b = 3.21e9_wp
    group%jwl_r1 = 4.15_wp
    group%jwl_r2 = 0.95_wp
    group%jwl_omega = 0.3_wp
  end function jwl_fluid

  !> Runs a tube of length 1, the fluids meeting at 0.5, to the time given. pressure: at the start.
  function run_tube(fluid, pressure, cells, per_cell, time, shape, transfer) result(tube)
    type(material_group), intent(in) :: fluid(2)
    real(wp), intent(in) :: pressure(2), time
    integer, intent(in) :: cells, per_cell
    character(*), intent(in), optional :: shape, transfer !< of &solid
    type(tube_result) :: tube
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    type(solid_totals_type) :: totals
    type(riemann_solution) :: exact
    type(body_group) :: body
    real(wp) :: now, dt, first
    integer :: k
    call empty_deck(scene%deck)
    call set_faces(scene%deck, 'symmetry')
    scene%deck%material = fluid
    if (present(shape)) scene%deck%solid%shape = shape
    if (present(transfer)) scene%deck%solid%transfer = transfer
    do k = 1, 2
      body%name = fluid(k)%name
      body%material = fluid(k)%name
      body%shape = 'box'
      body%lower = [0.5_wp*(k - 1), 0.0_wp, 0.0_wp]
      body%upper = [0.5_wp*k, 1.0_wp, 1.0_wp]
      body%spacing = 1.0_wp/(cells*per_cell)
      body%pressure = pressure(k)
      scene%deck%body = [scene%deck%body, body]
    end do
    call start_scene(scene, [cells, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [1.0_wp, 1.0_wp, 1.0_wp], [cells, 1, 1])
    exact = solve_riemann(side(1), side(2))
    totals = sum_solid(scene%mesh, scene%solid)
    first = sum(totals%kinetic + totals%internal)
    now = 0
    do while (now < time*(1 - 1e-12_wp))
      limit = solid_limit(scene%mesh, scene%solid)
      dt = min(limit%dt, time - now)
      call advance_solid(scene%mesh, scene%halo, scene%solid, dt)
      now = now + dt
      tube%steps = tube%steps + 1
    end do
    totals = sum_solid(scene%mesh, scene%solid)
    tube%energy_drift = sum(totals%kinetic + totals%internal)/first - 1
    call measure(scene, exact, time, tube)

  contains

    function side(k)
      integer, intent(in) :: k
      type(side_type) :: side
      side%density = fluid(k)%density
      side%pressure = pressure(k)
      side%eos = scene%solid%material(k)%eos
    end function side

  end function run_tube

  subroutine measure(scene, exact, time, tube)
    type(solid_scene), intent(in) :: scene
    type(riemann_solution), intent(in) :: exact
    real(wp), intent(in) :: time
    type(tube_result), intent(inout) :: tube
    real(wp) :: state(3), xi, low, high, squares
    integer :: set, i, n
    low = exact%velocity(2) + 0.25_wp*(exact%outer_speed(2) - exact%velocity(2))
    high = exact%velocity(2) + 0.75_wp*(exact%outer_speed(2) - exact%velocity(2))
    n = 0
    squares = 0
    do set = 1, 2
      associate (f => scene%solid%block(set, 1)%f)
        do i = 1, scene%solid%block(set, 1)%n
          xi = (f(i, at_position) - 0.5_wp)/time
          state = exact%sample(xi)
          tube%density = tube%density + f(i, at_volume)*abs(f(i, at_mass)/f(i, at_volume) - state(1))
          tube%velocity = tube%velocity + f(i, at_volume)*abs(f(i, at_velocity) - state(2))
          tube%pressure = tube%pressure + f(i, at_volume)*abs(-f(i, at_stress) - state(3))
          if (xi < low .or. xi > high) cycle
          n = n + 1
          tube%star_pressure = tube%star_pressure - f(i, at_stress)
          tube%star_velocity = tube%star_velocity + f(i, at_velocity)
          squares = squares + (f(i, at_velocity) - state(2))**2
        end do
      end associate
    end do
    tube%star_pressure = tube%star_pressure/n
    tube%star_velocity = tube%star_velocity/n
    tube%exact_pressure = exact%pressure
    tube%exact_velocity = exact%velocity(2)
    tube%noise = sqrt(squares/n)/exact%velocity(2)
  end subroutine measure

end module particle_tubes
