!> Test problems of one gas beyond tubes: smooth flows for orders of accuracy, interacting shocks, implosions, a blast, and plane
!> shocks that a scheme may corrugate.
module gas_problems
  use equation_of_state, only: eos_type, new_ideal_gas
  use flow_problem, only: problem_type, outcome_type, region_type, add_problem, fill_region, bound, note_measure
  use flow_profiles, only: profile_type, profile_of, crossing, front_distance
  use flow_scenes, only: flow_scene
  use flow_state, only: face_outflow, face_periodic, face_symmetry
  use kinds, only: wp
  use noh, only: noh_type
  use sedov, only: sedov_type, new_sedov
  use shock_relations, only: shock_jump
  use smooth_flows, only: density_wave_type, vortex_type
  implicit none
  private
  public :: add_smooth_flows, add_shock_problems

  real(wp), parameter :: noise = 1e-6_wp !< of density, from row to row
  real(wp), parameter :: cold = 1e-6_wp !< pressure of Noh's gas
  logical, parameter :: lines(3, 3) = reshape([.true., .false., .false., .true., .true., .false., .true., .true., .true.], [3, 3])
  character(14), parameter :: line_names(3) = [character(14) :: 'axis', 'face diagonal', 'space diagonal']

contains

  subroutine add_smooth_flows(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    problem%name = 'density_wave'
    problem%title = 'Sine wave of density carried once through its box'
    problem%eos = [new_ideal_gas(1.4_wp)]
    problem%cells = [64, 1, 1]
    problem%resolutions = [16, 32, 64, 128]
    problem%faces = face_periodic
    problem%end_time = 1
    problem%start => wave_start
    problem%exact => wave_exact
    call add_problem(list, problem)
    problem%name = 'vortex'
    problem%title = 'Isentropic vortex carried once through its box (Shu 1998)'
    problem%cells = [64, 64, 1]
    problem%resolutions = [16, 32, 64, 128]
    problem%lower = [-5.0_wp, -5.0_wp, 0.0_wp]
    problem%upper = [5.0_wp, 5.0_wp, 1.0_wp]
    problem%end_time = 10
    problem%start => vortex_start
    problem%exact => vortex_exact
    call add_problem(list, problem)
  end subroutine add_smooth_flows

  subroutine add_shock_problems(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    integer :: d
    problem%name = 'woodward_colella'
    problem%title = 'Two blast waves (Woodward & Colella 1984), against a fine run'
    problem%eos = [new_ideal_gas(1.4_wp)]
    problem%region = [region(1.0_wp, 0.0_wp, 1000.0_wp), region(1.0_wp, 0.0_wp, 0.01_wp), region(1.0_wp, 0.0_wp, 100.0_wp)]
    problem%cells = [400, 1, 1]
    problem%resolutions = [200, 400, 800]
    problem%fine_cells = 3200
    problem%faces = face_symmetry
    problem%end_time = 0.038_wp
    problem%is_hard = .true.
    problem%start => three_regions
    problem%bound = [bound('density', 0.07_wp), bound('velocity', 0.03_wp), bound('pressure', 0.03_wp), &
      bound('mass balance', 1e-11_wp), bound('energy balance', 1e-11_wp)]
    call add_problem(list, problem)

    problem%name = 'shu_osher'
    problem%title = 'Shock meets a density wave (Shu & Osher 1989), against a fine run'
    problem%region = [region(27/7.0_wp, 4*sqrt(35.0_wp)/9, 31/3.0_wp), region(1.0_wp, 0.0_wp, 1.0_wp)]
    problem%lower(1) = -5
    problem%upper(1) = 5
    problem%place = -4
    problem%faces = face_outflow
    problem%end_time = 1.8_wp
    problem%start => shu_osher_start
    problem%bound = [bound('density', 0.02_wp), bound('velocity', 0.02_wp), bound('pressure', 0.02_wp), &
      bound('mass balance', 1e-11_wp), bound('energy balance', 1e-11_wp)]
    call add_problem(list, problem)

    problem%fine_cells = 0
    do d = 1, 3
      call add_noh(list, d)
    end do
    call add_sedov(list)
    call add_plane_shock(list, 'odd_even_mach_6', 6.0_wp)
    call add_plane_shock(list, 'odd_even_mach_20', 20.0_wp)
  end subroutine add_shock_problems

  pure type(region_type) function region(density, velocity, pressure)
    real(wp), intent(in) :: density, velocity, pressure
    region = region_type(1, density, [velocity, 0.0_wp, 0.0_wp], pressure)
  end function region

  ! ---- smooth flows

  subroutine wave_start(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call start_from(problem, x, wave_exact, r, a, u, p)
  end subroutine wave_start

  subroutine wave_exact(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    type(density_wave_type) :: wave
    integer :: i
    do i = 1, size(x, 2)
      state(:, i) = wave%state(x(:, i)/(problem%upper - problem%lower), t)
    end do
  end subroutine wave_exact

  subroutine vortex_start(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call start_from(problem, x, vortex_exact, r, a, u, p)
  end subroutine vortex_start

  subroutine vortex_exact(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    type(vortex_type) :: vortex
    integer :: i
    vortex%gamma = problem%eos(1)%gas%gamma
    do i = 1, size(x, 2)
      state([1, 2, 3, 5], i) = vortex%state(x(:2, i), t)
      state(4, i) = 0
    end do
  end subroutine vortex_exact

  !> The exact solution at the start.
  subroutine start_from(problem, x, exact, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    interface
      subroutine exact(problem, t, x, state)
        import :: problem_type, wp
        type(problem_type), intent(in) :: problem
        real(wp), intent(in) :: t, x(:, :)
        real(wp), intent(out) :: state(:, :)
      end subroutine exact
    end interface
    real(wp), intent(out) :: r(:), a(:), u(3), p
    real(wp) :: state(5, 1)
    call exact(problem, 0.0_wp, reshape(x, [3, 1]), state)
    a = 1
    r = state(1, 1)
    u = state(2:4, 1)
    p = state(5, 1)
  end subroutine start_from

  ! ---- interacting shocks

  subroutine three_regions(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call fill_region(problem, 1 + count(x(1) > [0.1_wp, 0.9_wp]), r, a, u, p)
  end subroutine three_regions

  subroutine shu_osher_start(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call fill_region(problem, merge(1, 2, x(1) < problem%place), r, a, u, p)
    if (x(1) >= problem%place) r = 1 + 0.2_wp*sin(5*x(1))
  end subroutine shu_osher_start

  ! ---- implosions and a blast

  subroutine add_noh(list, d)
    type(problem_type), allocatable, intent(inout) :: list(:)
    integer, intent(in) :: d
    integer, parameter :: cells(3) = [200, 100, 48]
    real(wp), parameter :: most_density(3) = [0.05_wp, 0.10_wp, 0.25_wp], most_pressure(3) = [0.03_wp, 0.06_wp, 0.20_wp]
    type(problem_type) :: problem
    problem%name = 'noh_'//'123'(d:d)
    problem%title = 'Noh''s implosion in '//'123'(d:d)//' dimensions (Noh 1987)'
    problem%eos = [new_ideal_gas(5.0_wp/3.0_wp)]
    problem%cells = 1
    problem%cells(:d) = cells(d)
    problem%faces(1, :) = face_symmetry
    problem%end_time = 0.6_wp
    problem%window(:, 2) = 0.35_wp ! inside what the outer faces have spoilt
    problem%window(d + 1:, 2) = 1
    problem%is_hard = .true.
    problem%start => noh_start
    problem%exact => noh_exact
    problem%measure => measure_noh
    problem%resolutions = cells(d)*[1, 2]/2
    problem%bound = [bound('density', most_density(d)), bound('pressure', most_pressure(d))]
    call add_problem(list, problem)
  end subroutine add_noh

  !> Distance from the low corner, in the directions that are there.
  pure real(wp) function radius(problem, x)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    radius = norm2(merge(x, 0.0_wp, problem%cells > 1))
  end function radius

  subroutine noh_start(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    a = 1
    r = 1
    p = cold
    u = merge(-x/radius(problem, x), 0.0_wp, problem%cells > 1)
  end subroutine noh_start

  subroutine noh_exact(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    type(noh_type) :: implosion
    real(wp) :: radial(3), r
    integer :: i
    implosion%geometry = count(problem%cells > 1)
    do i = 1, size(x, 2)
      r = radius(problem, x(:, i))
      radial = implosion%state(r, t)
      state(:, i) = [radial(1), merge(x(:, i)*radial(2)/r, 0.0_wp, problem%cells > 1), radial(3)]
    end do
  end subroutine noh_exact

  subroutine measure_noh(problem, scene, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(outcome_type), intent(inout) :: outcome
    type(noh_type) :: implosion
    integer :: d
    d = count(problem%cells > 1)
    implosion%geometry = d
    call note_front(problem, scene, 4.0_wp**d/3, implosion%shock_speed()*scene%time, outcome)
  end subroutine measure_noh

  subroutine add_sedov(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    type(sedov_type) :: blast
    blast = new_sedov(3, 1.4_wp, 1.0_wp, 1.0_wp)
    problem%name = 'sedov_3'
    problem%title = 'Blast from a point (Sedov 1959), an octant of it; the shock has come to a distance of 1'
    problem%eos = [new_ideal_gas(1.4_wp)]
    problem%cells = 32
    problem%resolutions = [16, 32]
    problem%upper = 1.2_wp
    problem%faces(1, :) = face_symmetry
    problem%end_time = sqrt(blast%alpha)
    problem%is_hard = .true.
    problem%is_long = .true.
    problem%start => sedov_start
    problem%exact => sedov_exact
    problem%measure => measure_sedov
    problem%bound = [bound('axis', 0.5_wp), bound('face diagonal', 0.5_wp), bound('space diagonal', 0.5_wp), &
      bound('mass balance', 1e-11_wp), bound('energy balance', 1e-11_wp)]
    call add_problem(list, problem)
  end subroutine add_sedov

  !> The energy (an eighth of 1) in the four cells next to the centre: it and its neighbours along the axes.
  subroutine sedov_start(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    a = 1
    r = 1
    u = 0
    p = cold
    if (norm2(x/problem%spacing) < 2) p = 0.4_wp*0.125_wp/(4*product(problem%spacing))
  end subroutine sedov_start

  subroutine sedov_exact(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    integer, parameter :: n = 2000
    type(sedov_type) :: blast
    real(wp) :: table(3, 0:n + 1), radial(3), r, at, top
    integer :: i, k
    blast = new_sedov(3, problem%eos(1)%gas%gamma, 1.0_wp, 1.0_wp)
    top = blast%shock_radius(t)
    do i = 0, n
      table(:, i) = blast%state(min(i, n - 1)*top/n, t)
    end do
    do i = 1, size(x, 2)
      r = norm2(x(:, i))
      at = r/top*n
      k = min(int(at), n - 1)
      radial = [1.0_wp, 0.0_wp, 0.0_wp]
      if (r < top) radial = table(:, k) + (at - k)*(table(:, k + 1) - table(:, k))
      state(:, i) = [radial(1), x(:, i)*radial(2)/r, radial(3)]
    end do
  end subroutine sedov_exact

  subroutine measure_sedov(problem, scene, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(outcome_type), intent(inout) :: outcome
    type(sedov_type) :: blast
    associate (gamma => problem%eos(1)%gas%gamma)
      blast = new_sedov(3, gamma, 1.0_wp, 1.0_wp)
      call note_front(problem, scene, 2/(gamma + 1)*blast%shock_speed(scene%time)**2, blast%shock_radius(scene%time), outcome)
    end associate
  end subroutine measure_sedov

  !> How many cells the shock is off, towards an axis and the diagonals. pressure: behind it; exact: its distance from the centre.
  subroutine note_front(problem, scene, pressure, exact, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    real(wp), intent(in) :: pressure, exact
    type(outcome_type), intent(inout) :: outcome
    type(profile_type) :: profile
    real(wp) :: found
    integer :: m
    profile = profile_of(scene)
    do m = 1, count(problem%cells > 1)
      found = front_distance(profile, scene%mesh%cells, scene%mesh%spacing(1), lines(:, m), 0.5_wp*pressure)
      call note_measure(problem, outcome, line_names(m), abs(found - exact)/scene%mesh%spacing(1))
    end do
  end subroutine note_front

  ! ---- plane shocks

  !> A shock runs along 500 cells into gas at rest whose density is a millionth higher and lower from row to row.
  subroutine add_plane_shock(list, name, mach)
    type(problem_type), allocatable, intent(inout) :: list(:)
    character(*), intent(in) :: name
    real(wp), intent(in) :: mach
    type(problem_type) :: problem
    type(eos_type) :: gas
    real(wp) :: p, density, velocity, speed
    gas = new_ideal_gas(1.4_wp)
    p = (2*1.4_wp*mach**2 - 0.4_wp)/2.4_wp
    call shock_jump(gas, 1.4_wp, 1.0_wp, p, density, velocity, speed)
    problem%name = name
    write (problem%title, '(a,i0,a)') 'Plane shock of Mach ', nint(mach), ' with odd-even noise of 1e-6, for 500 cells (Quirk 1994)'
    problem%eos = [gas]
    problem%region = [region(density, velocity, p), region(1.4_wp, 0.0_wp, 1.0_wp)]
    problem%cells = [540, 16, 1]
    problem%upper(:2) = [540.0_wp, 16.0_wp]
    problem%place = 20
    problem%faces(:, 2:) = face_periodic
    problem%end_time = 500/speed
    problem%is_hard = .true.
    problem%start => noisy_shock
    problem%measure => measure_noise
    problem%bound = [bound('noise of density', 10.0_wp), bound('noise of velocity', 10.0_wp), bound('shock', 1.0_wp)]
    call add_problem(list, problem)
  end subroutine add_plane_shock

  subroutine noisy_shock(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call fill_region(problem, merge(1, 2, x(1) < problem%place), r, a, u, p)
    ! not quite the same in all pairs of rows: otherwise symmetry would keep the transverse velocity at nil
    r = r*(1 + noise*(-1)**floor(x(2)/problem%spacing(2))*(1 + 0.5_wp*sin(8*atan(1.0_wp)*x(2)/problem%upper(2))))
  end subroutine noisy_shock

  !> In the gas that the shock has passed: half the range of density over its mean, row against row, and the largest transverse
  !> velocity over the sound speed, both as multiples of the noise put in. The same of density in all that lies behind, where the
  !> waves of the start still run; and how many cells the shock is off.
  subroutine measure_noise(problem, scene, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(outcome_type), intent(inout) :: outcome
    type(profile_type) :: profile
    real(wp), allocatable :: state(:, :, :)
    real(wp) :: density(scene%mesh%cells(1)), c, at
    integer :: i, first, last, n(3)
    n = scene%mesh%cells
    profile = profile_of(scene)
    state = reshape(profile%state, [5, n(1), n(2)])
    associate (behind => problem%region(1))
      at = crossing(state(5, :, 1), 0.5_wp*behind%pressure, .true.)
      last = floor(at) - 3
      first = ceiling((problem%place + behind%velocity(1)*scene%time)/scene%mesh%spacing(1))
      do i = 1, last
        density(i) = 0.5_wp*n(2)*(maxval(state(1, i, :)) - minval(state(1, i, :)))/sum(state(1, i, :))/noise
      end do
      c = sqrt(problem%eos(1)%sound_speed_squared(behind%density, behind%pressure))
      call note_measure(problem, outcome, 'noise of density', maxval(density(first:last)))
      call note_measure(problem, outcome, 'noise of velocity', maxval(abs(state(3, first:, :)))/c/noise)
      call note_measure(problem, outcome, 'noise of all', maxval(density(:last)))
      call note_measure(problem, outcome, 'shock', abs(at - 0.5_wp - 520/scene%mesh%spacing(1)))
    end associate
  end subroutine measure_noise

end module gas_problems
