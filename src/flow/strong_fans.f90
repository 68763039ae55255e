!> Faces in strong fans. HLLC knows no fans: its one jump to the star state gives the face of a charge that is let go, with
!> pressures of 84000:1 on it, half of its momentum flux, and what the first cells of a fan get wrong stays as heat beside the
!> contact, a number of cells wide on any mesh. Where the matter on a face expands much, both sides of it get the state that the
!> exact solution has there (Toro 2009, ch. 4), whose flux HLLC then gives exactly: in the fan the state that moves at its own speed
!> of sound, behind it the one that has the pressure and velocity of the other side after a shock. Weak fans and the faces of shocks
!> are left to HLLC.
module strong_fans
  use equation_of_state, only: eos_type, max_materials
  use flow_layout, only: layout_type
  use kinds, only: wp
  use mixture, only: cell_fractions
  implicit none
  private
  public :: set_fan_states

  !> The most that may be left of the density where the face lies in the fan, and behind it; more is not strong.
  real(wp), parameter :: most_left_within = 0.9_wp, most_left_behind = 0.75_wp
  real(wp), parameter :: least_jump = 0.1_wp !< of the pressure, over the smaller pressure and r c**2: less is not looked at
  real(wp), parameter :: least_lack = 0.08_wp !< of the velocity, in sound speeds: less is made up for before a fan gets strong
  real(wp), parameter :: step = 0.1_wp !< of ln r along an isentrope
  integer, parameter :: most_steps = 100

  !> A state on the isentrope of a face value, all its materials expanded alike, as HLLC does.
  type :: fan_type
    real(wp) :: part = 1 !< of the density that is left
    real(wp) :: pressure = 0
    real(wp) :: bulk = 0 !< r c**2
    real(wp) :: speed = 0 !< towards the side of the lower pressure
    real(wp) :: energy(max_materials) = 0 !< of materials whose energy is stored
  end type fan_type

contains

  !> Puts the state of the exact solution on both sides of faces in strong fans. n: faces; u: row of the velocity normal to them;
  !> c_left, c_right: sound speeds of the cells on both sides; left, right: reconstructed rows on both sides; work: scratch.
  !> open_left, open_right: 0 of closed cells, whose faces are left alone.
  pure subroutine set_fan_states(n, ld, layout, eos, u, c_left, c_right, left, right, work, open_left, open_right)
    integer, intent(in) :: n, ld, u
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: c_left(n), c_right(n)
    real(wp), intent(inout) :: left(ld, layout%n_reconstructed), right(ld, layout%n_reconstructed), work(n)
    real(wp), intent(in), optional :: open_left(n), open_right(n)
    integer :: i, r, p
    r = layout%density_row
    p = layout%pressure_row
    if (.not. any_jump(n, left(1, p), right(1, p))) return
    call look_for_fans(n, 1 + 0.5_wp*minval(eos%grueneisen), left(1, r), left(1, u), left(1, p), c_left, right(1, r), right(1, u), &
      right(1, p), c_right, work)
    do i = 1, n
      if (.not. work(i) > 0) cycle
      if (.not. any_jump(1, left(i, p), right(i, p))) cycle ! the same faces, whatever row they stand in
      if (abs(right(i, p) - left(i, p)) <= least_jump*min(left(i, r)*c_left(i)**2, right(i, r)*c_right(i)**2)) cycle
      if (present(open_left)) then
        if (.not. open_left(i)*open_right(i) > 0) cycle
      end if
      call set_face(ld, layout, eos, u, left(i, p) > right(i, p), left(i, 1), right(i, 1))
    end do
  end subroutine set_fan_states

  !> Puts that state on both sides of one face, if it lies in a strong fan. up: the pressure is higher on the left.
  pure subroutine set_face(ld, layout, eos, u, up, left, right)
    integer, intent(in) :: ld, u
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    logical, intent(in) :: up
    real(wp), intent(inout) :: left(*), right(*) !< every ld-th of them
    real(wp), dimension(layout%n_reconstructed) :: high, low, state
    logical :: found
    integer :: v, at
    do v = 1, layout%n_reconstructed
      at = 1 + (v - 1)*ld
      high(v) = merge(left(at), right(at), up)
      low(v) = merge(right(at), left(at), up)
    end do
    call expand(layout, eos, u, merge(1, -1, up), high, low, state, found)
    if (.not. found) return
    do v = 1, layout%n_reconstructed
      at = 1 + (v - 1)*ld
      left(at) = state(v)
      right(at) = state(v)
    end do
  end subroutine set_face

  !> Whether the pressure changes at one of n faces by more than that part of its lower value, for gases less than r c**2.
  pure logical function any_jump(n, left, right)
    integer, intent(in) :: n
    real(wp), intent(in) :: left(n), right(n)
    real(wp) :: most
    integer :: i
    most = -1
    !$omp simd reduction(max:most)
    do i = 1, n
      most = max(most, abs(right(i) - left(i)) - least_jump*min(left(i), right(i)))
    end do
    any_jump = most > 0
  end function any_jump

  !> Leaves out faces that cannot lie in a strong fan, at little cost: those whose low side a shock to the high pressure would give no
  !> more speed than the high side has, as faces of shocks. promising: 1 of the others. width: the least that a shock's pressure
  !> counts in its r (U - u)**2; a part of the sound speeds of the cells stands for those of the faces.
  pure subroutine look_for_fans(n, width, r_left, u_left, p_left, c_left, r_right, u_right, p_right, c_right, promising)
    integer, intent(in) :: n
    real(wp), intent(in) :: width
    real(wp), intent(in), dimension(n) :: r_left, u_left, p_left, c_left, r_right, u_right, p_right, c_right
    real(wp), intent(out) :: promising(n)
    real(wp), parameter :: part_of_bulk = 0.8_wp, part_of_lack = 0.6_wp
    real(wp) :: rise, r, c, lack
    integer :: i
    !$omp simd private(rise, r, c, lack)
    do i = 1, n
      rise = abs(p_left(i) - p_right(i))
      r = merge(r_right(i), r_left(i), p_left(i) > p_right(i))
      c = merge(c_right(i), c_left(i), p_left(i) > p_right(i))
      lack = part_of_lack*least_lack*merge(c_left(i), c_right(i), p_left(i) > p_right(i)) + (u_left(i) - u_right(i))
      promising(i) = merge(1.0_wp, 0.0_wp, rise*rise > max(lack, 0.0_wp)**2*r*(part_of_bulk*r*c*c + width*rise))
    end do
  end subroutine look_for_fans

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
    stiffness = bulk_modulus(layout, eos, low, a, 1.0_wp, low(layout%pressure_row))
    width = 1 + 0.5_wp/sum(a*eos%over_g)
    a = fractions(layout, high)
    fan%pressure = high(layout%pressure_row)
    fan%bulk = bulk_modulus(layout, eos, high, a, 1.0_wp, fan%pressure)
    fan%speed = way*high(u)
    do i = 1, n
      if (layout%energy_row(i) > 0) fan%energy(i) = high(layout%energy_row(i))
    end do
    state = high
    found = .false.
    lack_before = 0
    do i = 0, most_steps
      sound = sqrt(fan%bulk/(fan%part*high(layout%density_row)))
      lead = speed_of_low(fan%pressure - low(layout%pressure_row))
      lack = min(sound, lead) - fan%speed
      if (.not. lack > 0) exit
      if (i == 0 .and. lead - fan%speed < least_lack*sound) return ! little would be left to expand, as at a shock
      before = fan
      lack_before = lack
      call follow(layout, eos, high, a, step, fan)
    end do
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
    real(wp) :: energy(layout%n_materials), part, pressure, bulk
    integer :: n
    n = layout%n_materials
    part = fan%part*exp(-0.5_wp*dx)
    pressure = fan%pressure - 0.5_wp*dx*fan%bulk
    energy = fan%energy(:n) - 0.5_wp*dx*(fan%energy(:n) + a*fan%pressure)
    bulk = bulk_modulus(layout, eos, high, a, part, pressure)
    fan%part = fan%part*exp(-dx)
    fan%pressure = fan%pressure - dx*bulk
    fan%speed = fan%speed + dx*sqrt(bulk/(part*high(layout%density_row)))
    fan%energy(:n) = fan%energy(:n) - dx*(energy + a*pressure)
    fan%bulk = bulk_modulus(layout, eos, high, a, fan%part, fan%pressure)
  end subroutine follow

  !> r c**2 of face values with fractions a at another pressure, with a part of their density; 0 where there is no sound.
  pure real(wp) function bulk_modulus(layout, eos, values, a, part, pressure)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    real(wp), intent(in) :: values(:), a(:), part, pressure
    integer :: k
    bulk_modulus = 0
    do k = 1, layout%n_materials
      bulk_modulus = bulk_modulus + part*values(k)*eos(k)%sound_speed_squared(part*values(k)/a(k), pressure)
    end do
    bulk_modulus = max(bulk_modulus, 0.0_wp)
  end function bulk_modulus

  !> Volume fractions on a face, which reconstruction leaves with a sum near one.
  pure function fractions(layout, values) result(a)
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: values(:)
    real(wp) :: a(layout%n_materials)
    a = cell_fractions(layout, values)
    if (layout%n_materials > 2) a = a/sum(a)
  end function fractions

end module strong_fans
