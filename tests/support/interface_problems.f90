!> Test problems of several materials beyond tubes: interfaces carried far, drops, bubbles and charges, and a random field.
!> Where no solution is known they ask for a state that stays one and books that balance.
module interface_problems
  use equation_of_state, only: eos_type, new_ideal_gas
  use flow_problem, only: problem_type, outcome_type, region_type, measure_type, add_problem, fill_region, bound, note_measure
  use flow_profiles, only: profile_type, profile_of, fraction_profile
  use flow_scenes, only: flow_scene
  use flow_state, only: face_periodic, face_symmetry, repair_first_order
  use kinds, only: wp
  use shock_relations, only: shock_jump
  use tube_problems, only: air, water, tnt_products
  implicit none
  private
  public :: add_interface_problems

  type(measure_type), parameter :: books(2) = [measure_type('mass balance', huge(1.0_wp), 1e-11_wp), &
    measure_type('energy balance', huge(1.0_wp), 1e-11_wp)]

contains

  subroutine add_interface_problems(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    call add_carried(list, 'interface_gases', 'Gases of density ratio 1000 carried over 2000 cells', &
      [new_ideal_gas(1.4_wp), new_ideal_gas(1.667_wp)], 1.0_wp, 1.0_wp, 1.0_wp)
    call add_carried(list, 'interface_water', 'Water in air carried over 2000 cells', [water(), air()], 1.0_wp, 100.0_wp, 1e5_wp)
    call add_water_drop(list)
    call add_burst(list)
    call add_bubble(list)
    call add_random_field(list)
  end subroutine add_interface_problems

  pure type(region_type) function region(material, density, velocity, pressure)
    integer, intent(in) :: material
    real(wp), intent(in) :: density, velocity, pressure
    region = region_type(material, density, [velocity, 0.0_wp, 0.0_wp], pressure)
  end function region

  !> What a shock that raises the pressure of a region to p leaves behind it.
  pure type(region_type) function shocked(eos, ahead, p)
    type(eos_type), intent(in) :: eos
    type(region_type), intent(in) :: ahead
    real(wp), intent(in) :: p
    real(wp) :: speed
    shocked = ahead
    shocked%pressure = p
    call shock_jump(eos, ahead%density, ahead%pressure, p, shocked%density, shocked%velocity(1), speed)
  end function shocked

  ! ---- carried interfaces

  !> A band of 1000 in a gas of the given density, at a uniform velocity and pressure, ten times through a box of 200 cells.
  subroutine add_carried(list, name, title, eos, density, velocity, pressure)
    type(problem_type), allocatable, intent(inout) :: list(:)
    character(*), intent(in) :: name, title
    type(eos_type), intent(in) :: eos(2)
    real(wp), intent(in) :: density, velocity, pressure
    type(problem_type) :: problem
    problem%name = name
    problem%title = title
    problem%eos = eos
    problem%region = [region(1, 1000.0_wp, velocity, pressure), region(2, density, velocity, pressure)]
    problem%cells = [200, 1, 1]
    problem%faces = face_periodic
    problem%end_time = 10/velocity
    problem%is_hard = .true.
    problem%start => band
    problem%exact => carried_band
    problem%measure => measure_band
    problem%bound = [books, bound('uniform pressure', 1e-7_wp), bound('uniform velocity', 1e-7_wp), bound('repairs', 0.0_wp)] ! what keeps all that is conserved is only counted
    call add_problem(list, problem)
  end subroutine add_carried

  pure integer function band_region(x)
    real(wp), intent(in) :: x
    band_region = merge(1, 2, abs(x - 0.4_wp) < 0.2_wp)
  end function band_region

  subroutine band(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    call fill_region(problem, band_region(x(1)), r, a, u, p)
  end subroutine band

  subroutine carried_band(problem, t, x, state)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: t, x(:, :)
    real(wp), intent(out) :: state(:, :)
    integer :: i
    do i = 1, size(x, 2)
      associate (region => problem%region(band_region(modulo(x(1, i) - problem%region(1)%velocity(1)*t, 1.0_wp))))
        state(:, i) = [region%density, region%velocity, region%pressure]
      end associate
    end do
  end subroutine carried_band

  subroutine measure_band(problem, scene, outcome)
    type(problem_type), intent(in) :: problem
    type(flow_scene), intent(in) :: scene
    type(outcome_type), intent(inout) :: outcome
    type(profile_type) :: profile
    real(wp), allocatable :: fraction(:)
    profile = profile_of(scene)
    fraction = fraction_profile(scene, 1)
    associate (region => problem%region(1))
      call note_measure(problem, outcome, 'uniform pressure', maxval(abs(profile%state(5, :)/region%pressure - 1)))
      call note_measure(problem, outcome, 'uniform velocity', maxval(abs(profile%state(2, :)/region%velocity(1) - 1)))
    end associate
    call note_measure(problem, outcome, 'contact width', 0.5_wp*count(fraction > 0.05_wp .and. fraction < 0.95_wp))
    call note_measure(problem, outcome, 'repairs', real(sum(outcome%repairs) - outcome%repairs(repair_first_order), wp))
  end subroutine measure_band

  ! ---- drops, bubbles and charges: half of the plane picture

  subroutine add_water_drop(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    problem%name = 'water_drop'
    problem%title = 'A shock of Mach 3 in air meets a drop of water (2-D)'
    problem%eos = [air(), water()]
    problem%region = [region(1, 1.2_wp, 0.0_wp, 1e5_wp), region(2, 1000.0_wp, 0.0_wp, 1e5_wp)]
    problem%region = [problem%region, shocked(air(), problem%region(1), 1e5_wp*(2.8_wp*9 - 0.4_wp)/2.4_wp)]
    problem%cells = [128, 64, 1]
    problem%upper(:2) = [16e-3_wp, 8e-3_wp]
    problem%faces(1, 2) = face_symmetry
    problem%end_time = 20e-6_wp
    problem%is_hard = .true.
    problem%start => drop
    problem%bound = books
    call add_problem(list, problem)
  end subroutine add_water_drop

  !> Region 2 in a circle, region 3 behind a shock on the left.
  subroutine drop(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    integer :: i
    i = 1
    if (norm2(x(:2) - [6e-3_wp, 0.0_wp]) < 2.4e-3_wp) i = 2
    if (x(1) < 3e-3_wp) i = 3
    call fill_region(problem, i, r, a, u, p)
  end subroutine drop

  subroutine add_bubble(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    problem%name = 'air_bubble'
    problem%title = 'A shock of 1.9 GPa in water collapses a bubble of air (2-D)'
    problem%eos = [water(), air()]
    problem%region = [region(1, 1000.0_wp, 0.0_wp, 1e5_wp), region(2, 1.2_wp, 0.0_wp, 1e5_wp)]
    problem%region = [problem%region, shocked(water(), problem%region(1), 1.9e9_wp)]
    problem%cells = [128, 64, 1]
    problem%upper(:2) = [16e-3_wp, 8e-3_wp]
    problem%faces(1, 2) = face_symmetry
    problem%end_time = 5e-6_wp
    problem%is_hard = .true.
    problem%start => drop
    problem%bound = books
    call add_problem(list, problem)
  end subroutine add_bubble

  subroutine add_burst(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    type(eos_type) :: tnt
    tnt = tnt_products()
    problem%name = 'underwater_burst'
    problem%title = 'Products of TNT below the surface of water, air above: three materials (2-D)'
    problem%eos = [tnt, water(), air()]
    problem%region = [region(1, 1630.0_wp, 0.0_wp, tnt%pressure(1630.0_wp, 7e9_wp/1630.0_wp)), &
      region(2, 1000.0_wp, 0.0_wp, 1e5_wp), region(3, 1.2_wp, 0.0_wp, 1e5_wp)]
    problem%cells = [80, 100, 1]
    problem%upper(:2) = [0.8_wp, 1.0_wp]
    problem%faces(1, 1) = face_symmetry
    problem%end_time = 2e-4_wp
    problem%is_hard = .true.
    problem%start => burst
    problem%bound = books
    call add_problem(list, problem)
  end subroutine add_burst

  subroutine burst(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    integer :: i
    i = merge(2, 3, x(2) < 0.6_wp)
    if (norm2(x(:2) - [0.0_wp, 0.45_wp]) < 0.05_wp) i = 1
    call fill_region(problem, i, r, a, u, p)
  end subroutine burst

  ! ---- random field

  subroutine add_random_field(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    problem%name = 'random_field'
    problem%title = 'A shock of 10 MPa through cells of air, helium and water at random (2-D)'
    problem%eos = [air(), new_ideal_gas(1.667_wp), water()]
    problem%region = [region(1, 1.2_wp, 0.0_wp, 1e5_wp), region(2, 0.166_wp, 0.0_wp, 1e5_wp), region(3, 1000.0_wp, 0.0_wp, 1e5_wp)]
    problem%region = [problem%region, shocked(air(), problem%region(1), 1e7_wp)]
    problem%cells = [64, 32, 1]
    problem%upper(:2) = [1.0_wp, 0.5_wp]
    problem%faces(:, 2) = face_periodic
    problem%end_time = 1e-3_wp
    problem%is_hard = .true.
    problem%start => random_cells
    problem%bound = books
    call add_problem(list, problem)
  end subroutine add_random_field

  subroutine random_cells(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    real(wp) :: scattered
    integer :: cell(2)
    cell = floor(x(:2)/problem%spacing(:2))
    ! far digits of a sine: the same on every machine that has a good one, and at random for this purpose
    scattered = 1e4_wp*sin(12.9898_wp*cell(1) + 78.233_wp*cell(2) + 1)
    call fill_region(problem, merge(4, 1 + int(3*(scattered - floor(scattered))), x(1) < 0.125_wp), r, a, u, p)
  end subroutine random_cells

end module interface_problems
