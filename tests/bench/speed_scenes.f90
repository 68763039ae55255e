!> Scenes whose steps are timed: balls of one material in another, large enough for several bricks. Every step costs the same, so
!> nothing depends on how far they run.
module speed_scenes
  use equation_of_state, only: new_ideal_gas, new_stiffened_gas
  use flow_problem, only: problem_type, region_type, add_problem, fill_region
  use flow_state, only: face_symmetry
  use kinds, only: wp
  use tube_problems, only: air, water, tnt_products
  implicit none
  private
  public :: add_speed_scenes

contains

  subroutine add_speed_scenes(list)
    type(problem_type), allocatable, intent(inout) :: list(:)
    type(problem_type) :: problem
    problem%faces = face_symmetry
    problem%start => ball
    problem%cells = [512, 512, 1]
    problem%region = [region(1, 1.0_wp, 10.0_wp), region(1, 0.125_wp, 1.0_wp), region(1, 1.0_wp, 1.0_wp)]
    problem%eos = [air()]
    call add('one_gas_2d', 'One gas, 2-D')
    problem%cells = 64
    call add('one_gas_3d', 'One gas, 3-D')
    problem%eos = [air(), new_ideal_gas(1.667_wp)]
    problem%region = [region(2, 1.0_wp, 10.0_wp), region(1, 1.0_wp, 1.0_wp), region(1, 1.0_wp, 1.0_wp)]
    call add('two_gases_3d', 'Two gases, 3-D')
    problem%cells = [512, 512, 1]
    call add('two_gases_2d', 'Two gases, 2-D')
    problem%cells = 64
    problem%eos = [tnt_products(), air()]
    problem%region = [region(1, 1630.0_wp, 8.4e9_wp), region(2, 1.2_wp, 1e5_wp), region(2, 1.2_wp, 1e5_wp)]
    call add('products_and_air_3d', 'Products (JWL) and air, 3-D')
    problem%eos = [tnt_products(), air(), water()]
    problem%region(3) = region(3, 1000.0_wp, 1e5_wp)
    call add('three_materials_3d', 'Products, air and water, 3-D')

  contains

    subroutine add(name, title)
      character(*), intent(in) :: name, title
      problem%name = name
      problem%title = title
      call add_problem(list, problem)
    end subroutine add

  end subroutine add_speed_scenes

  pure type(region_type) function region(material, density, pressure)
    integer, intent(in) :: material
    real(wp), intent(in) :: density, pressure
    region = region_type(material, density, 0.0_wp, pressure)
  end function region

  !> Region 1 in a ball that bricks cut, region 2 around it, region 3 below.
  subroutine ball(problem, x, r, a, u, p)
    type(problem_type), intent(in) :: problem
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    integer :: i
    i = merge(2, 3, x(2) > 0.3_wp)
    if (norm2(merge(x - 0.52_wp, 0.0_wp, problem%cells > 1)) < 0.2_wp) i = 1
    call fill_region(problem, i, r, a, u, p)
  end subroutine ball

end module speed_scenes
