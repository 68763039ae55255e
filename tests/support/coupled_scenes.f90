!> Small scenes from deck texts, made and advanced as the program does.
module coupled_scenes
  use blocks, only: block
  use deck, only: message_length, read_deck_string
  use kinds, only: wp
  use log, only: be_quiet
  use main_loop, only: advance_scene
  use scene, only: scene_type
  use setup, only: lay_out_scene, make_scene
  use text, only: str
  implicit none
  private
  public :: make_from_text, advance_until, advance_steps, value_at, shock_groups, number

  real(wp), parameter :: gamma = 1.4_wp

  character(*), parameter, public :: nl = new_line('a')

contains

  !> The scene of a deck; ok: the deck has no mistakes.
  subroutine make_from_text(text, scene, ok)
    character(*), intent(in) :: text
    type(scene_type), intent(out) :: scene
    logical, intent(out) :: ok
    character(message_length), allocatable :: errors(:)
    call be_quiet()
    call read_deck_string(text, scene%deck, errors)
    ok = size(errors) == 0
    if (.not. ok) then
      print '(a)', errors
      return
    end if
    call lay_out_scene(scene)
    call make_scene(scene)
  end subroutine make_from_text

  !> Steps until the end time of the deck.
  subroutine advance_until(scene)
    type(scene_type), intent(inout) :: scene
    do while (scene%clock%time < scene%clock%end_time)
      call advance_scene(scene, scene%clock%end_time)
    end do
  end subroutine advance_until

  !> A number of steps, however long.
  subroutine advance_steps(scene, n)
    type(scene_type), intent(inout) :: scene
    integer, intent(in) :: n
    integer :: i
    do i = 1, n
      call advance_scene(scene, huge(1.0_wp))
    end do
  end subroutine advance_steps

  !> A row of the flow state in the cell with these global indices (on one rank).
  real(wp) function value_at(scene, row, cell)
    type(scene_type), intent(in) :: scene
    integer, intent(in) :: row, cell(3)
    integer :: b, i(3)
    value_at = huge(1.0_wp)
    do b = 1, scene%mesh%n_local
      i = cell - scene%mesh%brick(scene%mesh%local(b))%location*scene%mesh%brick_cells
      if (all(i >= 1 .and. i <= scene%mesh%brick_cells)) &
        value_at = scene%flow%w(scene%flow%holder(b), scene%flow%current)%a(i(1), row, i(2), i(3))
    end do
  end function value_at

  !> Groups for gas at rest (density and pressure 1, gamma 1.4, in a material of the name air) and a shock of this Mach number that
  !> runs along x from x = place on; boundary: further keys of that group. Without units.
  function shock_groups(mach, place, boundary) result(text)
    real(wp), intent(in) :: mach, place
    character(*), intent(in) :: boundary
    character(:), allocatable :: text
    character(:), allocatable :: density, pressure, velocity
    density = number((gamma + 1)*mach**2/((gamma - 1)*mach**2 + 2))
    pressure = number(1 + 2*gamma/(gamma + 1)*(mach**2 - 1))
    velocity = number(2*sqrt(gamma)/(gamma + 1)*(mach - 1/mach))
    text = "&material name='air', eos='ideal_gas', gamma=1.4, density=1.0 /"//nl// &
      "&boundary x_low='inflow', inflow_material='air', inflow_density="//density//", inflow_pressure="//pressure// &
      ", inflow_velocity="//velocity//",0,0, "//boundary//" /"//nl// &
      "&region shape='all', material='air', density=1.0, pressure=1.0 /"//nl// &
      "&region shape='half_space', material='air', density="//density//", pressure="//pressure//", velocity="//velocity// &
      ",0,0, point="//number(place)//",0,0, normal=1,0,0 /"//nl
  end function shock_groups

  !> A number with every bit, for a deck.
  function number(value)
    real(wp), intent(in) :: value
    character(:), allocatable :: number
    number = str(value, 17)
  end function number

end module coupled_scenes
