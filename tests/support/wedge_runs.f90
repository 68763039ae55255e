!> A plane shock that runs onto a wedge of particles at an angle to the mesh, and what is measured there.
module wedge_runs
  use constants, only: pi
  use coupled_scenes, only: make_from_text, advance_until, value_at, shock_groups, number, nl
  use kinds, only: wp
  use scene, only: scene_type
  use text, only: str
  implicit none
  private
  public :: run_wedge, measure_wall, path_angle

  real(wp), parameter, public :: gamma = 1.4_wp, degree = pi/180
  real(wp), parameter :: tip = 0.3_wp, start = 0.2_wp, reach = 0.9_wp

contains

  !> A shock of this Mach number on a wedge of this angle (degrees), n cells to a unit of length, when the shock is `reach` behind
  !> the tip.
  subroutine run_wedge(method, mach, angle, n, scene, ok)
    character(*), intent(in) :: method
    real(wp), intent(in) :: mach, angle
    integer, intent(in) :: n
    type(scene_type), intent(out) :: scene
    logical, intent(out) :: ok
    real(wp) :: height, axis(2), middle(2)
    integer :: rows
    ! a rectangle whose upper edge starts below the floor and passes through the tip
    axis = [cos(angle*degree), sin(angle*degree)]
    middle = [tip, 0.0_wp] + 2*[axis(2), -axis(1)]
    height = reach*tan(angle*degree) + 0.45_wp
    rows = 8*nint(height*n/8)
    call make_from_text("&run units='none', end_time="//number((tip - start + reach)/(mach*sqrt(gamma)))//" /"//nl// &
      "&mesh cells="//str(nint(1.3_wp*n))//","//str(rows)//",1, upper=1.3,"//number(real(rows, wp)/n)//",1.0 /"//nl// &
      shock_groups(mach, start, "x_high='outflow', y_low='symmetry', y_high='outflow', solid_y_low='free'")// &
      "&material name='rock', model='rigid', density=1e9 /"//nl// &
      "&body name='wedge', material='rock', shape='cylinder', start="//number(middle(1) - 2*axis(1))//","// &
      number(middle(2) - 2*axis(2))//",0, end="//number(middle(1) + 4*axis(1))//","//number(middle(2) + 4*axis(2))// &
      ",0, radius=2, spacing="//number(0.5_wp/n)//", fixed='xyz', fixed_rotation='xyz' /"//nl// &
      "&coupling method='"//method//"' /"//nl//"&solid shape='quadratic' /"//nl, scene, ok)
    if (ok) call advance_until(scene)
  end subroutine run_wedge

  !> Pressure in the cells just above the wedge over the exact one, between 0.6 of the way from the tip to the shock, where the tip
  !> is felt no more, and 0.85: mean, and mean distance (L1) from 1.
  subroutine measure_wall(scene, angle, exact, mean, distance)
    type(scene_type), intent(in) :: scene
    real(wp), intent(in) :: angle, exact
    real(wp), intent(out) :: mean, distance
    real(wp) :: h, p
    integer :: i, j, n
    h = scene%mesh%spacing(1)
    mean = 0
    distance = 0
    n = 0
    do i = ceiling((tip + 0.6_wp*reach)/h), floor((tip + 0.85_wp*reach)/h)
      j = ceiling(((i - 0.5_wp)*h - tip)*tan(angle*degree)/h + 1.5_wp)
      p = value_at(scene, scene%flow%layout%pressure_row, [i, j, 1])/exact
      mean = mean + p
      distance = distance + abs(p - 1)
      n = n + 1
    end do
    mean = mean/n
    distance = distance/n
  end subroutine measure_wall

  !> Angle between the wedge and the line from its tip to the triple point: the reflected shock, straight through where the pressure
  !> first exceeds that of the incident one by a tenth on the way down, 4 and 8 cells behind the incident shock, meets it there. Nil
  !> without a stem.
  real(wp) function path_angle(scene, mach, angle) result(chi)
    type(scene_type), intent(in) :: scene
    real(wp), intent(in) :: mach, angle
    real(wp) :: level, here, above, height(2), at_shock
    integer :: i, j, k
    level = 1.1_wp*(1 + 2*gamma/(gamma + 1)*(mach**2 - 1))
    height = 0
    do k = 1, 2
      i = nint((tip + reach)/scene%mesh%spacing(1)) - 4*k
      above = value_at(scene, scene%flow%layout%pressure_row, [i, scene%mesh%cells(2), 1])
      do j = scene%mesh%cells(2) - 1, 1, -1
        here = value_at(scene, scene%flow%layout%pressure_row, [i, j, 1])
        if (here > level .and. above <= level) then
          height(k) = scene%mesh%spacing(2)*(j - 0.5_wp + (here - level)/(here - above))
          exit
        end if
        above = here
      end do
    end do
    at_shock = 2*height(1) - height(2)
    chi = max(atan(at_shock/reach)/degree - angle, 0.0_wp)
  end function path_angle

end module wedge_runs
