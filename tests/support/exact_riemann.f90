!> Exact solution of the Riemann problem of two materials of any equations of state (Toro 2009, ch. 4): the two waves are
!> shocks or expansions, and bring both sides to one pressure and velocity. If the sides part too fast there is vacuum between.
module exact_riemann
  use equation_of_state, only: eos_type
  use isentropes, only: isentrope_type, isentrope_point, new_isentrope
  use kinds, only: wp
  use shock_relations, only: shock_jump
  implicit none
  private
  public :: solve_riemann, star_state, exact_state

  !> One side of the problem.
  type, public :: side_type
    real(wp) :: density = 1, velocity = 0, pressure = 1
    type(eos_type) :: eos !< an ideal gas of 1.4 unless given
  end type side_type

  !> The solution; index 1 is the left wave or side, 2 the right one.
  type, public :: riemann_solution
    type(side_type) :: side(2)
    type(isentrope_type), private :: isentrope(2)
    logical :: is_shock(2) = .false.
    logical :: is_vacuum = .false. !< between the sides
    real(wp) :: pressure = 0 !< between the waves
    real(wp) :: density(2) = 0 !< behind the waves
    real(wp) :: velocity(2) = 0 !< of the contact; of the two edges of a vacuum
    real(wp) :: outer_speed(2) = 0 !< of the shock, or of the head of the expansion
    real(wp) :: inner_speed(2) = 0 !< of the shock, or of the tail of the expansion
  contains
    procedure :: sample
    procedure :: material
  end type riemann_solution

  real(wp), parameter :: direction(2) = [-1.0_wp, 1.0_wp] !< of the waves

contains

  !> The state between the waves, by bisection of its pressure.
  pure function solve_riemann(left, right) result(solution)
    type(side_type), intent(in) :: left, right
    type(riemann_solution) :: solution
    real(wp) :: low, high
    integer :: i, k
    solution%side(1) = left
    solution%side(2) = right
    do k = 1, 2
      solution%isentrope(k) = new_isentrope(solution%side(k)%eos, solution%side(k)%density, solution%side(k)%pressure)
    end do
    low = max(solution%isentrope(1)%lowest_pressure(), solution%isentrope(2)%lowest_pressure())
    solution%is_vacuum = excess_velocity(solution, low) >= 0
    if (solution%is_vacuum) then
      solution%pressure = low
    else
      high = max(left%pressure, right%pressure)
      do while (excess_velocity(solution, high) < 0)
        high = high + max(high - low, maxval(solution%isentrope%start%density*solution%isentrope%start%sound_speed**2), &
          maxval(solution%side%density)*(right%velocity - left%velocity)**2)
      end do
      do i = 1, 200
        solution%pressure = 0.5_wp*(low + high)
        if (solution%pressure <= low .or. solution%pressure >= high) exit
        if (excess_velocity(solution, solution%pressure) > 0) then
          high = solution%pressure
        else
          low = solution%pressure
        end if
      end do
    end if
    do k = 1, 2
      call describe_wave(solution, k)
    end do
    if (.not. solution%is_vacuum) solution%velocity = 0.5_wp*sum(solution%velocity)
  end function solve_riemann

  !> Velocity by which the right side would run away from the left one if both were brought to pressure p.
  pure real(wp) function excess_velocity(solution, p)
    type(riemann_solution), intent(in) :: solution
    real(wp), intent(in) :: p
    integer :: k
    excess_velocity = solution%side(2)%velocity - solution%side(1)%velocity
    do k = 1, 2
      excess_velocity = excess_velocity + velocity_change(solution%side(k), solution%isentrope(k), p)
    end do
  end function excess_velocity

  pure real(wp) function velocity_change(side, isentrope, p)
    type(side_type), intent(in) :: side
    type(isentrope_type), intent(in) :: isentrope
    real(wp), intent(in) :: p
    type(isentrope_point) :: point
    real(wp) :: density, speed
    if (p > side%pressure) then
      call shock_jump(side%eos, side%density, side%pressure, p, density, velocity_change, speed)
    else
      point = isentrope%at_pressure(p)
      velocity_change = point%velocity
    end if
  end function velocity_change

  !> Density, velocity and speeds of wave k, when the pressure is known.
  pure subroutine describe_wave(solution, k)
    type(riemann_solution), intent(inout) :: solution
    integer, intent(in) :: k
    type(isentrope_point) :: point
    real(wp) :: velocity, speed
    associate (side => solution%side(k))
      solution%is_shock(k) = solution%pressure > side%pressure
      if (solution%is_shock(k)) then
        call shock_jump(side%eos, side%density, side%pressure, solution%pressure, solution%density(k), velocity, speed)
        solution%velocity(k) = side%velocity + direction(k)*velocity
        solution%outer_speed(k) = side%velocity + direction(k)*speed
        solution%inner_speed(k) = solution%outer_speed(k)
      else
        point = solution%isentrope(k)%at_pressure(solution%pressure)
        solution%density(k) = point%density
        solution%velocity(k) = side%velocity + direction(k)*point%velocity
        solution%outer_speed(k) = side%velocity + direction(k)*solution%isentrope(k)%start%sound_speed
        solution%inner_speed(k) = side%velocity + direction(k)*(point%velocity + point%sound_speed)
      end if
    end associate
  end subroutine describe_wave

  !> The material at speed xi = x/t: 1 left, 2 right, 0 vacuum.
  elemental integer function material(self, xi)
    class(riemann_solution), intent(in) :: self
    real(wp), intent(in) :: xi
    if (xi < self%velocity(1)) then
      material = 1
    else if (self%is_vacuum .and. xi <= self%velocity(2)) then
      material = 0
    else
      material = 2
    end if
  end function material

  !> Density, velocity and pressure at speed xi = x/t. Vacuum has density 0 and, to be continuous, velocity xi.
  pure function sample(self, xi) result(state)
    class(riemann_solution), intent(in) :: self
    real(wp), intent(in) :: xi
    real(wp) :: state(3)
    type(isentrope_point) :: point
    integer :: k
    k = self%material(xi)
    if (k == 0) then
      state = [0.0_wp, xi, self%pressure]
      return
    end if
    associate (side => self%side(k))
      if (direction(k)*(xi - self%outer_speed(k)) > 0) then
        state = [side%density, side%velocity, side%pressure]
      else if (direction(k)*(xi - self%inner_speed(k)) < 0 .or. self%is_shock(k)) then
        state = [self%density(k), self%velocity(k), self%pressure]
      else
        point = self%isentrope(k)%at_speed(direction(k)*(xi - side%velocity))
        state = [point%density, side%velocity + direction(k)*point%velocity, point%pressure]
      end if
    end associate
  end function sample

  !> Pressure and velocity between the waves.
  pure subroutine star_state(left, right, pressure, velocity)
    type(side_type), intent(in) :: left, right
    real(wp), intent(out) :: pressure, velocity
    type(riemann_solution) :: solution
    solution = solve_riemann(left, right)
    pressure = solution%pressure
    velocity = 0.5_wp*sum(solution%velocity)
  end subroutine star_state

  !> Density, velocity and pressure at one speed xi = x/t; for many speeds, solve once and sample.
  pure function exact_state(left, right, xi) result(state)
    type(side_type), intent(in) :: left, right
    real(wp), intent(in) :: xi
    real(wp) :: state(3)
    type(riemann_solution) :: solution
    solution = solve_riemann(left, right)
    state = solution%sample(xi)
  end function exact_state

end module exact_riemann
