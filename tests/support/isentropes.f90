!> Expansion isentropes of any equation of state, as functions of s = log(density/start): dp/ds = r c**2, dw/ds = c.
!> w is the velocity change along the isentrope, negative in an expansion; a wave into a side at velocity u has u -+ w and its
!> characteristics the speed u -+ (w + c) (Toro 2009, ch. 3 and 4). Gases have a closed form; others are integrated once, by
!> the method of Dormand & Prince 1980 of order 5 with a local error of 1e-14, down to where no material or no sound is left.
module isentropes
  use equation_of_state, only: eos_type
  use kinds, only: wp
  implicit none
  private
  public :: new_isentrope

  type, public :: isentrope_point
    real(wp) :: density = 0, pressure = 0, velocity = 0, sound_speed = 0 !< velocity: w
  end type isentrope_point

  type, public :: isentrope_type
    type(eos_type) :: eos
    type(isentrope_point) :: start
    logical :: closed_form = .true.
    real(wp), allocatable, private :: s(:), p(:), w(:), c(:) !< nodes from the start downwards, if there is no closed form
  contains
    procedure :: lowest_pressure => end_pressure !< of the isentrope: vacuum, or the strongest tension
    procedure :: at_pressure
    procedure :: at_density
    procedure :: at_velocity !< where w has a value
    procedure :: at_speed !< where w + c has a value: in a fan
  end type isentrope_type

  integer, parameter :: by_pressure = 1, by_velocity = 2, by_speed = 3
  integer, parameter :: most_nodes = 20000
  real(wp), parameter :: allowed_error = 1e-14_wp, shortest_step = 1e-9_wp
  real(wp), parameter :: emptiness = 1e-15_wp !< r c**2 over that of the start, at the end of an isentrope

contains

  !> The isentrope through a state. walk: integrate in spite of a closed form (a check of the integration).
  pure function new_isentrope(eos, density, pressure, walk) result(isentrope)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, pressure
    logical, intent(in), optional :: walk
    type(isentrope_type) :: isentrope
    isentrope%eos = eos
    isentrope%start = isentrope_point(density, pressure, 0.0_wp, sqrt(eos%sound_speed_squared(density, pressure)))
    isentrope%closed_form = eos%is_gas
    if (present(walk)) isentrope%closed_form = eos%is_gas .and. .not. walk
    if (.not. isentrope%closed_form) call integrate(isentrope)
  end function new_isentrope

  pure real(wp) function end_pressure(self)
    class(isentrope_type), intent(in) :: self
    if (self%closed_form) then
      end_pressure = -self%eos%gas%p_infinity
    else
      end_pressure = self%p(size(self%p))
    end if
  end function end_pressure

  !> The point at a pressure between the lowest one and that of the start (of a gas: also above).
  pure function at_pressure(self, pressure) result(point)
    class(isentrope_type), intent(in) :: self
    real(wp), intent(in) :: pressure
    type(isentrope_point) :: point
    if (is_cold(self)) then
      point = self%start
    else if (self%closed_form) then
      associate (gas => self%eos%gas)
        point = gas_point(self, (max(pressure + gas%p_infinity, 0.0_wp)/(self%start%pressure + gas%p_infinity)) &
          **((gas%gamma - 1)/(2*gas%gamma)))
      end associate
    else
      point = found(self, by_pressure, pressure)
    end if
  end function at_pressure

  !> The point at a density between the lowest one and that of the start (of a gas: also above).
  pure function at_density(self, density) result(point)
    class(isentrope_type), intent(in) :: self
    real(wp), intent(in) :: density
    type(isentrope_point) :: point
    real(wp) :: error
    integer :: above, below, middle
    logical :: possible
    if (self%closed_form) then
      point = gas_point(self, (density/self%start%density)**(0.5_wp*(self%eos%gas%gamma - 1)))
      return
    end if
    above = 1
    below = size(self%s)
    do while (below - above > 1)
      middle = (above + below)/2
      if (self%start%density*exp(self%s(middle)) > density) then
        above = middle
      else
        below = middle
      end if
    end do
    point%density = density
    call step(self%eos, self%start%density, self%s(above), self%p(above), self%w(above), &
      log(density/self%start%density) - self%s(above), point%pressure, point%velocity, point%sound_speed, error, possible)
  end function at_density

  !> The point where the velocity change is w; the end of the isentrope if it is never that large.
  pure function at_velocity(self, w) result(point)
    class(isentrope_type), intent(in) :: self
    real(wp), intent(in) :: w
    type(isentrope_point) :: point
    if (is_cold(self)) then
      point = self%start
    else if (self%closed_form) then
      point = gas_point(self, max(1 + 0.5_wp*(self%eos%gas%gamma - 1)*w/self%start%sound_speed, 0.0_wp))
    else
      point = found(self, by_velocity, w)
    end if
  end function at_velocity

  !> The point where w + c is the given speed. It is assumed that w + c falls with density (a convex equation of state).
  pure function at_speed(self, speed) result(point)
    class(isentrope_type), intent(in) :: self
    real(wp), intent(in) :: speed
    type(isentrope_point) :: point
    real(wp) :: g
    if (is_cold(self)) then
      point = self%start
    else if (self%closed_form) then
      g = self%eos%gas%gamma
      point = gas_point(self, max((2 + (g - 1)*speed/self%start%sound_speed)/(g + 1), 0.0_wp))
    else
      point = found(self, by_speed, speed)
    end if
  end function at_speed

  !> A gas without pressure, or at its strongest tension, does not expand.
  pure logical function is_cold(self)
    class(isentrope_type), intent(in) :: self
    is_cold = self%closed_form .and. .not. self%start%sound_speed > 0
  end function is_cold

  !> Of a gas, at a sound speed of ratio times that of the start.
  pure function gas_point(self, ratio) result(point)
    class(isentrope_type), intent(in) :: self
    real(wp), intent(in) :: ratio
    type(isentrope_point) :: point
    associate (start => self%start, g => self%eos%gas%gamma, stiffness => self%eos%gas%p_infinity)
      point%density = start%density*ratio**(2/(g - 1))
      point%pressure = (start%pressure + stiffness)*ratio**(2*g/(g - 1)) - stiffness
      point%velocity = 2*start%sound_speed/(g - 1)*(ratio - 1)
      point%sound_speed = start%sound_speed*ratio
    end associate
  end function gas_point

  ! ---- without a closed form

  !> The point where a falling quantity has a value, by bisection: of the nodes, then of a step from the node above it.
  pure function found(self, quantity, goal) result(point)
    class(isentrope_type), intent(in) :: self
    integer, intent(in) :: quantity
    real(wp), intent(in) :: goal
    type(isentrope_point) :: point
    real(wp) :: low, high, p, w, c, value, error
    integer :: above, below, middle, i
    logical :: possible
    above = 1
    below = size(self%s)
    if (goal >= value_of(quantity, self%p(1), self%w(1), self%c(1))) below = 1
    if (goal <= value_of(quantity, self%p(below), self%w(below), self%c(below))) above = below
    do while (below - above > 1)
      middle = (above + below)/2
      if (value_of(quantity, self%p(middle), self%w(middle), self%c(middle)) > goal) then
        above = middle
      else
        below = middle
      end if
    end do
    high = 0
    low = self%s(below) - self%s(above)
    do i = 1, merge(0, 55, above == below)
      call step(self%eos, self%start%density, self%s(above), self%p(above), self%w(above), 0.5_wp*(low + high), p, w, c, &
        error, possible)
      value = value_of(quantity, p, w, c)
      if (value > goal) then
        high = 0.5_wp*(low + high)
      else
        low = 0.5_wp*(low + high)
      end if
    end do
    call step(self%eos, self%start%density, self%s(above), self%p(above), self%w(above), 0.5_wp*(low + high), p, w, c, &
      error, possible)
    point = isentrope_point(self%start%density*exp(self%s(above) + 0.5_wp*(low + high)), p, w, c)
  end function found

  pure real(wp) function value_of(quantity, p, w, c) result(value)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: p, w, c
    select case (quantity)
    case (by_pressure)
      value = p
    case (by_velocity)
      value = w
    case default
      value = w + c
    end select
  end function value_of

  pure subroutine integrate(self)
    type(isentrope_type), intent(inout) :: self
    real(wp) :: s(most_nodes), p(most_nodes), w(most_nodes), c(most_nodes), h, error, stiffness
    logical :: possible
    integer :: n
    n = 1
    s(1) = 0
    p(1) = self%start%pressure
    w(1) = 0
    c(1) = self%start%sound_speed
    stiffness = self%start%density*c(1)**2
    h = -1e-3_wp
    do while (n < most_nodes .and. -h > shortest_step)
      call step(self%eos, self%start%density, s(n), p(n), w(n), h, p(n + 1), w(n + 1), c(n + 1), error, possible)
      if (.not. possible) then
        h = 0.25_wp*h
      else if (error > allowed_error) then
        h = h*max(0.2_wp, 0.9_wp*(allowed_error/error)**0.2_wp)
      else
        s(n + 1) = s(n) + h
        n = n + 1
        if (self%start%density*exp(s(n))*c(n)**2 < emptiness*stiffness) exit
        h = h*min(2.0_wp, 0.9_wp*(allowed_error/max(error, 1e-30_wp))**0.2_wp)
      end if
    end do
    self%s = s(:n)
    self%p = p(:n)
    self%w = w(:n)
    self%c = c(:n)
  end subroutine integrate

  !> One step h < 0 of s. error: estimate, of p over r c**2 and of w over c. possible: sound exists all along the step.
  pure subroutine step(eos, density, s, p, w, h, p_new, w_new, c_new, error, possible)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, s, p, w, h
    real(wp), intent(out) :: p_new, w_new, c_new, error
    logical, intent(out) :: possible
    real(wp), parameter :: at(7) = [0.0_wp, 1/5.0_wp, 3/10.0_wp, 4/5.0_wp, 8/9.0_wp, 1.0_wp, 1.0_wp]
    real(wp), parameter :: a(6, 7) = reshape([0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      1/5.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      3/40.0_wp, 9/40.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      44/45.0_wp, -56/15.0_wp, 32/9.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      19372/6561.0_wp, -25360/2187.0_wp, 64448/6561.0_wp, -212/729.0_wp, 0.0_wp, 0.0_wp, &
      9017/3168.0_wp, -355/33.0_wp, 46732/5247.0_wp, 49/176.0_wp, -5103/18656.0_wp, 0.0_wp, &
      35/384.0_wp, 0.0_wp, 500/1113.0_wp, 125/192.0_wp, -2187/6784.0_wp, 11/84.0_wp], [6, 7])
    real(wp), parameter :: difference(7) = [71/57600.0_wp, 0.0_wp, -71/16695.0_wp, 71/1920.0_wp, -17253/339200.0_wp, &
      22/525.0_wp, -1/40.0_wp] !< of the orders 5 and 4
    real(wp) :: dp(7), dw(7), r, p_stage, c2
    integer :: i
    p_new = p
    w_new = w
    c_new = 0
    error = 0
    possible = .false.
    do i = 1, 7
      r = density*exp(s + at(i)*h)
      p_stage = p + h*dot_product(a(:i - 1, i), dp(:i - 1))
      c2 = eos%sound_speed_squared(r, p_stage)
      if (.not. c2 > 0) return
      dp(i) = r*c2
      dw(i) = sqrt(c2)
    end do
    possible = .true.
    p_new = p_stage
    w_new = w + h*dot_product(a(:, 7), dw(:6))
    c_new = dw(7)
    error = abs(h)*max(abs(dot_product(difference, dp))/dp(7), abs(dot_product(difference, dw))/dw(7))
  end subroutine step

end module isentropes
