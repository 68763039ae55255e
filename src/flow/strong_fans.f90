!> Faces in strong fans. HLLC knows no fans: its one jump to the star state gives the face of a charge that is let go, with pressures of
!> 84000:1 on it, half of its momentum flux, and what the first cells of a fan get wrong stays as heat beside the contact, a number of
!> cells wide on any mesh. Where the matter on a face expands much, both sides of it get the state that the exact solution has there
!> (Toro 2009, ch. 4), whose flux HLLC then gives exactly: in the fan the state that moves at its own speed of sound, behind the fan
!> the one that has the pressure and velocity of the other side after a shock. Weak fans and the faces of shocks are left to HLLC.
module strong_fans
  use equation_of_state, only: eos_type, max_materials
  use flow_layout, only: layout_type
  use kinds, only: wp
  implicit none
  private
  public :: set_fan_states

  !> The most that may be left of the density where the face lies in the fan, and behind it; more is not strong.
  real(wp), parameter :: most_left_within = 0.9_wp, most_left_behind = 0.75_wp
  real(wp), parameter :: least_jump = 0.1_wp !< of the pressure, over the smaller r c**2: with less there is no such fan
  real(wp), parameter :: step = 1.0_wp/16 !< of ln r along an isentrope
  integer, parameter :: most_steps = 160

  !> A state on the isentrope of a face value, all its materials expanded alike, as HLLC does.
  type :: fan_type
    real(wp) :: part = 1 !< of the density that is left
    real(wp) :: pressure = 0
    real(wp) :: speed = 0 !< towards the side of the lower pressure
    real(wp) :: energy(max_materials) = 0 !< of materials whose energy is stored
  end type fan_type

contains

  !> Puts the state of the exact solution on both sides of faces in strong fans. n: faces; u: row of the velocity normal to them;
  !> c_left, c_right: sound speeds of the cells on both sides; left, right: reconstructed rows on both sides. open_left, open_right:
  !> 0 of closed cells, whose faces are left alone.
  pure subroutine set_fan_states(n, ld, layout, eos, u, c_left, c_right, left, right, open_left, open_right)
    integer, intent(in) :: n, ld, u
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: c_left(n), c_right(n)
    real(wp), intent(inout) :: left(ld, layout%n_reconstructed), right(ld, layout%n_reconstructed)
    real(wp), intent(in), optional :: open_left(n), open_right(n)
    real(wp) :: state(layout%n_reconstructed)
    logical :: found
    integer :: i, r, p
    r = layout%density_row
    p = layout%pressure_row
    if (.not. strongest(n, left(1, r), left(1, p), c_left, right(1, r), right(1, p), c_right) > 0) return
    do i = 1, n
      if (.not. strongest(1, left(i, r), left(i, p), c_left(i), right(i, r), right(i, p), c_right(i)) > 0) cycle
      if (present(open_left)) then
        if (.not. open_left(i)*open_right(i) > 0) cycle
      end if
      if (left(i, p) > right(i, p)) then
        call expand(layout, eos, u, 1, left(i, :), right(i, :), state, found)
      else
        call expand(layout, eos, u, -1, right(i, :), left(i, :), state, found)
      end if
      if (.not. found) cycle
      left(i, :) = state
      right(i, :) = state
    end do
  end subroutine set_fan_states

  !> The strongest jump of the pressure at n faces, less the least that counts.
  pure real(wp) function strongest(n, r_left, p_left, c_left, r_right, p_right, c_right)
    integer, intent(in) :: n
    real(wp), intent(in), dimension(n) :: r_left, p_left, c_left, r_right, p_right, c_right
    integer :: i
    strongest = -1
    !$omp simd reduction(max:strongest)
    do i = 1, n
      strongest = max(strongest, abs(p_right(i) - p_left(i)) &
        - least_jump*min(r_left(i)*(c_left(i)*c_left(i)), r_right(i)*(c_right(i)*c_right(i))))
    end do
  end function strongest

  !> Follows the isentrope of the side of the higher pressure down to where it moves at its speed of sound, or as the other side
  !> does at the same pressure. way: 1 if the other side lies above, -1 below. found: it expands much to get there, and moves
  !> towards the other side, so that this is the state on the face.
  pure subroutine expand(layout, eos, u, way, high, low, state, found)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    integer, intent(in) :: u, way
    real(wp), intent(in) :: high(layout%n_reconstructed), low(layout%n_reconstructed)
    real(wp), intent(out) :: state(layout%n_reconstructed)
    logical, intent(out) :: found
    real(wp) :: a(layout%n_materials), stiffness, width, sound, lead, lack, lack_before
    type(fan_type) :: fan, before
    integer :: i, n
    n = layout%n_materials
    a = fractions(layout, low)
    stiffness = max(bulk(layout, eos, low, a, fan_type(pressure=low(layout%pressure_row))), 0.0_wp)
    width = 1 + 0.5_wp/sum(a*eos%over_g)
    a = fractions(layout, high)
    fan%pressure = high(layout%pressure_row)
    fan%speed = way*high(u)
    do i = 1, n
      if (layout%energy_row(i) > 0) fan%energy(i) = high(layout%energy_row(i))
    end do
    lack_before = 0
    do i = 0, most_steps
      sound = sound_speed(layout, eos, high, a, fan)
      lead = speed_of_low(fan%pressure - low(layout%pressure_row))
      lack = min(sound, lead) - fan%speed
      if (.not. lack > 0) exit
      before = fan
      lack_before = lack
      call follow(layout, eos, high, a, step, fan)
    end do
    state = high
    found = .false.
    if (i == 0 .or. .not. lack <= 0) return
    fan = before
    call follow(layout, eos, high, a, step*lack_before/(lack_before - lack), fan)
    found = fan%part < merge(most_left_within, most_left_behind, sound < lead) .and. fan%speed > 0
    state(:n) = fan%part*high(:n)
    state(layout%density_row) = fan%part*high(layout%density_row)
    state(layout%pressure_row) = fan%pressure
    state(u) = way*fan%speed
    do i = 1, n
      if (layout%energy_row(i) > 0) state(layout%energy_row(i)) = fan%energy(i)
    end do

  contains

    !> Velocity of the other side after a shock, or a sound wave to less, that raises its pressure so much.
    pure real(wp) function speed_of_low(rise)
      real(wp), intent(in) :: rise
      speed_of_low = way*low(u) &
        + rise/sqrt(max(low(layout%density_row)*(stiffness + width*max(rise, 0.0_wp)), tiny(1.0_wp)))
    end function speed_of_low

  end subroutine expand

  !> A step of -dx in ln r, by the midpoint rule: dp = -r c**2 dx, du = c dx, de = -(e + a p) dx.
  pure subroutine follow(layout, eos, high, a, dx, fan)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: high(:), a(:), dx
    type(fan_type), intent(inout) :: fan
    type(fan_type) :: middle
    integer :: n
    n = layout%n_materials
    middle%part = fan%part*exp(-0.5_wp*dx)
    middle%pressure = fan%pressure - 0.5_wp*dx*bulk(layout, eos, high, a, fan)
    middle%energy(:n) = fan%energy(:n) - 0.5_wp*dx*(fan%energy(:n) + a*fan%pressure)
    fan%part = fan%part*exp(-dx)
    fan%pressure = fan%pressure - dx*bulk(layout, eos, high, a, middle)
    fan%speed = fan%speed + dx*sound_speed(layout, eos, high, a, middle)
    fan%energy(:n) = fan%energy(:n) - dx*(middle%energy(:n) + a*middle%pressure)
  end subroutine follow

  !> Sound speed of a state in a fan; 0 where there is none.
  pure real(wp) function sound_speed(layout, eos, high, a, fan)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: high(:), a(:)
    type(fan_type), intent(in) :: fan
    sound_speed = sqrt(max(bulk(layout, eos, high, a, fan), 0.0_wp)/(fan%part*high(layout%density_row)))
  end function sound_speed

  !> r c**2 of a state on the isentrope of a face value with fractions a.
  pure real(wp) function bulk(layout, eos, values, a, fan)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: values(:), a(:)
    type(fan_type), intent(in) :: fan
    real(wp) :: m
    integer :: k
    bulk = 0
    do k = 1, layout%n_materials
      m = fan%part*values(k)
      bulk = bulk + m*eos(k)%sound_speed_squared(m/a(k), fan%pressure)
    end do
  end function bulk

  !> Volume fractions on a face.
  pure function fractions(layout, values) result(a)
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: values(:)
    real(wp) :: a(layout%n_materials)
    integer :: k
    a = 1
    do k = 1, layout%n_fractions
      a(k) = values(layout%fraction(k))
    end do
    if (layout%n_materials == 2) a(2) = 1 - a(1)
    if (layout%n_materials > 2) a = a/sum(a)
  end function fractions

end module strong_fans
