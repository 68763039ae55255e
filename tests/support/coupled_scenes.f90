!> Small scenes from deck texts, made and advanced as the program does.
module coupled_scenes
  use blocks, only: block
  use deck, only: message_length, read_deck_string
  use kinds, only: wp
  use log, only: be_quiet
  use main_loop, only: advance_scene
  use scene, only: scene_type
  use setup, only: lay_out_scene, make_scene
  implicit none
  private
  public :: make_from_text, advance_until, advance_steps, value_at

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

end module coupled_scenes
