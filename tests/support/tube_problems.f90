!> Test problems: two uniform states that meet, with the exact solution. Tubes of one gas, of two gases, of condensed matter.
module tube_problems
  use equation_of_state, only: eos_type, new_ideal_gas, new_stiffened_gas, new_jwl, new_cochran_chan
  use exact_riemann, only: side_type, riemann_solution, solve_riemann
  use flow_problem, only: problem_type, outcome_type, measure_type, region_type, add_problem, fill_region, bound, note_measure, &
    trace_fraction
  use flow_profiles, only: profile_type, profile_of, crossing, fraction_profile
  use flow_scenes, only: flow_scene
  use kinds, only: wp
  implicit none
  private
  public :: add_gas_tubes, add_material_tubes, tnt_products, water, air, copper

contains

  !> Tubes of one ideal gas.
  subroutine add_gas_tubes(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(eos_type) :: gas(1)
    gas = new_ideal_gas(1.4_wp)
    call tube('sod', 'Sod''s tube (Sod 1978)', gas, [1.0_wp, 0.0_wp, 1.0_wp], [0.125_wp, 0.0_wp, 0.1_wp], 0.5_wp, 0.2_wp, 200, &
      [bound('mean density', 2.58e-3_wp)], resolutions=[100, 200, 400, 800], is_hard=.false.)
    call tube('toro_1', 'Toro''s test 1: sonic point (Toro 2009, table 4.1)', gas, [1.0_wp, 0.75_wp, 1.0_wp], &
      [0.125_wp, 0.0_wp, 0.1_wp], 0.3_wp, 0.2_wp, 200, errors(0.01_wp, 0.02_wp, 0.01_wp), resolutions=[100, 200, 400, 800])
    call tube('toro_2', 'Toro''s test 2: the 123 problem', gas, [1.0_wp, -2.0_wp, 0.4_wp], [1.0_wp, 2.0_wp, 0.4_wp], 0.5_wp, &
      0.15_wp, 200, errors(0.02_wp, 0.02_wp, 0.02_wp), resolutions=[100, 200, 400, 800])
    call tube('toro_3', 'Toro''s test 3: pressure ratio 1e5', gas, [1.0_wp, 0.0_wp, 1000.0_wp], [1.0_wp, 0.0_wp, 0.01_wp], 0.5_wp, &
      0.012_wp, 200, errors(0.06_wp, 0.03_wp, 0.02_wp), resolutions=[100, 200, 400, 800])
    call tube('toro_4', 'Toro''s test 4: colliding streams', gas, [5.99924_wp, 19.5975_wp, 460.894_wp], &
      [5.99242_wp, -6.19633_wp, 46.095_wp], 0.4_wp, 0.035_wp, 200, errors(0.02_wp, 0.02_wp, 0.01_wp), &
      resolutions=[100, 200, 400, 800])
    call tube('toro_5', 'Toro''s test 5: stationary contact', gas, [1.0_wp, -19.59745_wp, 1000.0_wp], &
      [1.0_wp, -19.59745_wp, 0.01_wp], 0.8_wp, 0.012_wp, 200, errors(0.06_wp, 0.03_wp, 0.02_wp), &
      resolutions=[100, 200, 400, 800])
    call tube('near_vacuum', '123 problem to near vacuum: streams part at 0.963 of the speed that empties the middle', gas, &
      [1.0_wp, -3.6_wp, 0.4_wp], [1.0_wp, 3.6_wp, 0.4_wp], 0.5_wp, 0.1_wp, 200, errors(0.04_wp, 0.05_wp, 0.06_wp))
    call tube('leblanc', 'LeBlanc''s tube: pressure ratio 1e9 (Loubere & Shashkov 2005)', [new_ideal_gas(5.0_wp/3.0_wp)], &
      [1.0_wp, 0.0_wp, 2.0_wp/3.0_wp*0.1_wp], [1e-3_wp, 0.0_wp, 2.0_wp/3.0_wp*1e-10_wp], 3.0_wp, 6.0_wp, 1600, &
      [errors(0.01_wp, 0.03_wp, 0.01_wp), bound('right shock', 3.0_wp)], & ! aim: 1 cell; the start of the jump leaves it ahead
      length=9.0_wp, resolutions=[400, 800, 1600])
    call tube('slow_shock', 'Slowly moving shock (Roberts 1990)', gas, [3.86_wp, -0.81_wp, 10.3334_wp], &
      [1.0_wp, -3.44_wp, 1.0_wp], 0.2_wp, 4.0_wp, 200, [errors(0.03_wp, 0.05_wp, 0.03_wp), bound('noise', 0.05_wp)])

  contains

    subroutine tube(name, title, eos, left, right, place, end_time, cells, bounds, length, resolutions, is_hard)
      character(*), intent(in) :: name, title
      type(eos_type), intent(in) :: eos(:)
      real(wp), intent(in) :: left(3), right(3), place, end_time
      integer, intent(in) :: cells
      type(measure_type), intent(in) :: bounds(:)
      real(wp), intent(in), optional :: length
      integer, intent(in), optional :: resolutions(:)
      logical, intent(in), optional :: is_hard
      call add_tube(list, name, title, eos, 1, left, right, place, end_time, cells, bounds, length, resolutions, is_hard)
    end subroutine tube

  end subroutine add_gas_tubes

  !> Tubes of two materials: the first on the left, the second on the right.
  subroutine add_material_tubes(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(measure_type) :: star(2), fronts(2)
    type(measure_type) :: tnt_star(2), tnt_fronts(2)
    star = [bound('star pressure', 0.01_wp), bound('star velocity', 0.01_wp)]
    fronts = [bound('contact', 2.0_wp), bound('right shock', 2.0_wp)]
    ! aims: as star and fronts. The start of a jump of 80000:1 leaves contact and shock ahead by a number of cells that does not change
    ! with the mesh or the time step.
    tnt_star = [bound('star pressure', 0.015_wp), bound('star velocity', 0.002_wp)]
    tnt_fronts = [bound('contact', 3.3_wp), bound('right shock', 5.5_wp)]
    call add_tube(list, 'sod_two_gases', 'Sod''s tube of gases 1.4 and 1.6', [new_ideal_gas(1.4_wp), new_ideal_gas(1.6_wp)], 2, &
      [1.0_wp, 0.0_wp, 1.0_wp], [0.125_wp, 0.0_wp, 0.1_wp], 0.5_wp, 0.2_wp, 256, errors(4.9e-3_wp, 9.3e-3_wp, 3.5e-3_wp), &
      resolutions=[128, 256, 512, 1024], is_hard=.false.)
    call add_tube(list, 'strong_1.4_1.6', 'Gases 1.4 and 1.6, pressure ratio 2500 (Abgrall & Karni 2001)', &
      [new_ideal_gas(1.4_wp), new_ideal_gas(1.6_wp)], 2, [1.0_wp, 0.0_wp, 500.0_wp], [1.0_wp, 0.0_wp, 0.2_wp], 0.5_wp, 0.012_wp, &
      200, [errors(0.04_wp, 0.03_wp, 0.02_wp), fronts], resolutions=[100, 200, 400, 800])
    call add_tube(list, 'strong_1.6_1.4', 'Gases 1.6 and 1.4, pressure ratio 2500', &
      [new_ideal_gas(1.6_wp), new_ideal_gas(1.4_wp)], 2, [1.0_wp, 0.0_wp, 500.0_wp], [1.0_wp, 0.0_wp, 0.2_wp], 0.5_wp, 0.012_wp, &
      200, [errors(0.07_wp, 0.03_wp, 0.02_wp), fronts])
    call add_tube(list, 'water_air', 'Water and dense air, pressure ratio 1e4 (Saurel & Abgrall 1999)', [water(), air()], 2, &
      [1000.0_wp, 0.0_wp, 1e9_wp], [50.0_wp, 0.0_wp, 1e5_wp], 0.7_wp, 240e-6_wp, 400, [errors(0.01_wp, 0.03_wp, 0.02_wp), &
      bound('star pressure', 0.05_wp), bound('star velocity', 0.01_wp), fronts], &
      resolutions=[200, 400, 800])
    call add_tube(list, 'water_light_air', 'Water and air of 1.2 kg/m3, pressure ratio 1e4', [water(), air()], 2, &
      [1000.0_wp, 0.0_wp, 1e9_wp], [1.2_wp, 0.0_wp, 1e5_wp], 0.6_wp, 200e-6_wp, 400, [errors(0.01_wp, 0.03_wp, 0.02_wp), &
      fronts])
    call add_tube(list, 'tnt_air', 'Products of TNT at constant volume (8.4 GPa) against air at 0.1 MPa', [tnt_products(), air()], &
      2, [1630.0_wp, 0.0_wp, tnt_pressure()], [1.2_wp, 0.0_wp, 1e5_wp], 0.45_wp, 1e-4_wp, 800, [errors(0.01_wp, 0.04_wp, 0.02_wp), &
      tnt_star, tnt_fronts], &
      resolutions=[200, 400, 800])
    call add_tube(list, 'products_copper', 'Products at 37 GPa against copper (Saurel & Abgrall 1999; Shyue 2001)', [new_jwl( &
      854.5e9_wp, 20.5e9_wp, 4.6_wp, 1.35_wp, 0.25_wp, 1840.0_wp, 8.5e9_wp), copper()], 2, [2485.37_wp, 0.0_wp, 37e9_wp], &
      [8900.0_wp, 0.0_wp, 1e5_wp], 0.5_wp, 73e-6_wp, 400, [errors(0.01_wp, 0.03_wp, 0.02_wp), star, fronts], &
      resolutions=[200, 400, 800])
    call add_tube(list, 'products_water', 'Products of TNT at constant volume against water at 0.1 MPa', &
      [tnt_products(), water()], 2, [1630.0_wp, 0.0_wp, tnt_pressure()], [1000.0_wp, 0.0_wp, 1e5_wp], 0.5_wp, 8e-5_wp, 400, &
      [errors(0.01_wp, 0.03_wp, 0.02_wp), star, fronts], &
      resolutions=[200, 400, 800])
    call add_tube(list, 'trace_gas', 'A trace of 1e-8 of another gas crosses a strong shock', [air(), new_ideal_gas(1.667_wp)], 1, &
      [1.2_wp, 0.0_wp, 1e7_wp], [1.2_wp, 0.0_wp, 1e5_wp], 0.4_wp, 1.2e-4_wp, 200, &
      [errors(0.06_wp, 0.03_wp, 0.02_wp), bound('trace', 6.5_wp)], absent=[0.2_wp, 0.0_wp, 1e5_wp])
    call add_tube(list, 'trace_water', 'A trace of 1e-8 of water crosses a strong shock in air', [air(), water()], 1, &
      [1.2_wp, 0.0_wp, 1e7_wp], [1.2_wp, 0.0_wp, 1e5_wp], 0.4_wp, 1.2e-4_wp, 200, &
      [errors(0.06_wp, 0.03_wp, 0.02_wp), bound('trace', 6.5_wp)], absent=[1000.0_wp, 0.0_wp, 1e5_wp])
    call add_tube(list, 'trace_air', 'A trace of 1e-8 of air crosses a strong shock in water', [water(), air()], 1, &
      [1000.0_wp, 0.0_wp, 1e10_wp], [1000.0_wp, 0.0_wp, 1e5_wp], 0.4_wp, 8e-5_wp, 200, &
      [errors(0.01_wp, 0.03_wp, 0.02_wp), bound('trace', 6.5_wp)], absent=[1.2_wp, 0.0_wp, 1e5_wp])
  end subroutine add_material_tubes

  !> right_material: 1 or 2; left, right: density, velocity, pressure; absent: a state of the second material where it is nowhere.
  subroutine add_tube(list, name, title, eos, right_material, left, right, place, end_time, cells, bounds, length, resolutions, &
    is_hard, absent)
    type(problem_type), allocatable, intent(inout) :: list(:)
    character(*), intent(in) :: name, title
    type(eos_type), intent(in) :: eos(:)
    integer, intent(in) :: right_material, cells
    real(wp), intent(in) :: left(3), right(3), place, end_time
    type(measure_type), intent(in) :: bounds(:)
    real(wp), intent(in), optional :: length, absent(3)
    integer, intent(in), optional :: resolutions(:)
    logical, intent(in), optional :: is_hard
    type(problem_type) :: problem
    problem%name = name
    problem%title = title
    problem%eos = eos
    problem%region = [region(1, left), region(right_material, right)]
    if (present(absent)) problem%region = [problem%region, region(2, absent)]
    problem%place = place
    problem%end_time = end_time
    problem%cells = [cells, 1, 1]
    if (present(length)) problem%upper(1) = length
    if (present(resolutions)) problem%resolutions = resolutions
    problem%is_hard = .true.
    if (present(is_hard)) problem%is_hard = is_hard
    problem%bound = [bounds, bound('mass balance', 1e-11_wp), bound('energy balance', 1e-11_wp)]
    problem%start => two_sides
    problem%exact => exact_tube
    problem%measure => measure_tube
    call add_problem(list, problem)
  end subroutine add_tube

  pure type(region_type) function region(material, state)
    integer, intent(in) :: material
    real(wp), intent(in) :: state(3)
    region = region_type(material, state(1), [state(2), 0.0_wp, 0.0_wp], state(3))
  end function region

  !> Bounds of the relative errors.
  pure function errors(density, velocity, pressure) result(bounds)
    real(wp), intent(in) :: density, velocity, pressure
    type(measure_type) :: bounds(3)
    bounds = [bound('density', density), bound('velocity', velocity), bound('pressure', pressure)]
  end function errors

  subroutine two_sides(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call fill_region(problem, merge(1, 2, x(1) < problem%place), r, a, u, p)
  end subroutine two_sides

  pure type(riemann_solution) function solution_of(problem)
    type(problem_type), intent(in) :: problem
    type(side_type) :: side(2)
    integer :: k
    do k = 1, 2
      associate (region => problem%region(k))
        side(k) = side_type(region%density, region%velocity(1), region%pressure, problem%eos(region%material))
      end associate
    end do
    solution_of = solve_riemann(side(1), side(2))
  end function solution_of

  subroutine exact_tube(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    type(riemann_solution) :: solution
    integer :: i
    solution = solution_of(problem)
    state = 0
    do i = 1, size(x, 2)
      state([1, 2, 5], i) = solution%sample((x(1, i) - problem%place)/t)
    end do
  end subroutine exact_tube

  !> Relative errors of pressure and velocity between the waves; how many cells the contact and shocks are off; the largest
  !> deviation of density from what should be uniform; and how much of a trace has become of one, as a multiple.
  subroutine measure_tube(problem, scene, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(outcome_type), intent(inout) :: outcome
    integer, parameter :: margin = 8 !< cells that a wave may be wide to either side
    type(riemann_solution) :: solution
    type(profile_type) :: profile
    real(wp), allocatable :: cell(:), fraction(:)
    real(wp) :: h, at
    integer :: first, last, k
    if (count(scene%mesh%cells > 1) /= 1 .or. scene%mesh%cells(1) == 1) return
    solution = solution_of(problem)
    profile = profile_of(scene)
    h = scene%mesh%spacing(1)
    cell = profile%state(5, :)
    first = max(1, margin + ceiling(exact_cell(solution%inner_speed(1))))
    last = min(size(cell), floor(exact_cell(solution%inner_speed(2))) - margin)
    if (last - first > 2 .and. .not. solution%is_vacuum) then
      call note_measure(problem, outcome, 'star pressure', abs(sum(cell(first:last))/(last - first + 1)/solution%pressure - 1))
      if (abs(solution%velocity(1)) > tiny(1.0_wp)) call note_measure(problem, outcome, 'star velocity', &
        abs(sum(profile%state(2, first:last))/(last - first + 1)/solution%velocity(1) - 1))
    end if
    if (problem%region(2)%material == 2) then
      fraction = fraction_profile(scene, 1)
      call note_measure(problem, outcome, 'contact', abs(crossing(fraction, 0.5_wp, .true.) - exact_cell(solution%velocity(1))))
      call note_measure(problem, outcome, 'contact width', real(count(fraction > 0.05_wp .and. fraction < 0.95_wp), wp))
    else if (size(problem%eos) == 2) then
      call note_measure(problem, outcome, 'trace', maxval(1 - fraction_profile(scene, 1))/trace_fraction)
    end if
    do k = 1, 2
      if (.not. solution%is_shock(k)) cycle
      at = exact_cell(solution%outer_speed(k))
      call note_measure(problem, outcome, trim(merge('left shock ', 'right shock', k == 1)), &
        abs(at - crossing(cell, 0.5_wp*(solution%pressure + problem%region(k)%pressure), k == 2)))
    end do
    if (problem%name == 'slow_shock') then
      last = floor(exact_cell(solution%outer_speed(2))) - margin
      call note_measure(problem, outcome, 'noise', maxval(abs(profile%state(1, :last)/problem%region(1)%density - 1)))
    end if

  contains

    !> Cell, with fractions, that what moves at this speed has come to.
    pure real(wp) function exact_cell(speed)
      real(wp), intent(in) :: speed
      exact_cell = (problem%place + speed*scene%time - problem%lower(1))/h + 0.5_wp
    end function exact_cell

  end subroutine measure_tube

  pure function air() result(eos)
    type(eos_type) :: eos
    eos = new_ideal_gas(1.4_wp)
  end function air

  pure function water() result(eos)
    type(eos_type) :: eos
    eos = new_stiffened_gas(4.4_wp, 6e8_wp)
  end function water

  !> Cochran & Chan 1979, as Saurel & Abgrall 1999 give it.
  pure function copper() result(eos)
    type(eos_type) :: eos
    eos = new_cochran_chan(145.67e9_wp, 147.75e9_wp, 2.99_wp, 1.99_wp, 2.0_wp, 8900.0_wp)
  end function copper

  pure function tnt_products() result(eos)
    type(eos_type) :: eos
    eos = new_jwl(371.2e9_wp, 3.231e9_wp, 4.15_wp, 0.95_wp, 0.3_wp, 1630.0_wp, 7e9_wp)
  end function tnt_products

  !> Of products that fill the volume of the explosive.
  pure real(wp) function tnt_pressure()
    type(eos_type) :: eos
    eos = tnt_products()
    tnt_pressure = eos%pressure(1630.0_wp, 7e9_wp/1630.0_wp)
  end function tnt_pressure

end module tube_problems
