!> The time step of the scene from the limits of flow and solid. The slower of the two takes one step while the other takes
!> several, where that pays: as many as fit, up to a number that keeps the coupling close.
module time_step
  use flow_time_step, only: flow_limit, flow_limit_type
  use kinds, only: wp
  use scene, only: scene_type
  use solid_material, only: model_rigid
  use solid_time_step, only: solid_limit, solid_limit_type
  use text, only: str
  implicit none
  private
  public :: choose_time_step, flow_part

  integer, parameter :: most_parts = 8 !< steps of one solver in a step of the other
  integer, parameter :: gentle_steps = 5 !< first steps of a run from a state at rest, whose waves are yet to form
  real(wp), parameter :: gentle_start = 0.2_wp

contains

  !> Sets dt, the number of solid steps in it and what limits it. next_event: time that a step shall end at (a snapshot, the end).
  subroutine choose_time_step(scene, next_event)
    type(scene_type), intent(inout) :: scene
    real(wp), intent(in) :: next_event
    type(flow_limit_type) :: flow
    type(solid_limit_type) :: solid
    real(wp) :: dt, left
    associate (clock => scene%clock)
      clock%solid_steps = 1
      if (scene%flow_runs()) flow = flow_limit(scene%mesh, scene%flow)
      if (scene%has_solid) solid = solid_limit(scene%mesh, scene%solid)
      if (scene%coupled .and. scene%flow_runs()) then
        if (solid%dt < flow%dt) then
          clock%solid_steps = min(most_parts, int(flow%dt/solid%dt))
          dt = clock%solid_steps*solid%dt
          clock%limiter = solid_limiter(scene, solid)
        else
          dt = flow%dt
          ! a rigid body follows each step of the flow, which costs little
          if (flow%dt < 0.5_wp*solid%dt .and. scene%solid_runs() .and. .not. all(scene%solid%material%model == model_rigid)) &
            dt = min(most_parts*flow%dt, solid%dt)
          clock%limiter = flow_limiter(scene, flow)
        end if
      else if (scene%has_solid) then
        dt = solid%dt
        clock%limiter = solid_limiter(scene, solid)
      else
        dt = flow%dt
        clock%limiter = flow_limiter(scene, flow)
      end if
      if (clock%step < gentle_steps) dt = dt*(gentle_start + (1 - gentle_start)*clock%step/gentle_steps)
      left = next_event - clock%time
      if (left < 2*dt) then ! no sliver of a step before an event
        if (left <= dt*(1 + 1e-9_wp)) then
          dt = left
          clock%limiter = 'output'
        else
          dt = 0.5_wp*left
        end if
      end if
      clock%dt = dt
    end associate
  end subroutine choose_time_step

  !> The next part of the flow step: all that is left, or an equal share of it if the flow's limit is smaller.
  !> dt: of the part; left: what remains after it.
  subroutine flow_part(scene, left, dt)
    type(scene_type), intent(inout) :: scene
    real(wp), intent(inout) :: left
    real(wp), intent(out) :: dt
    type(flow_limit_type) :: limit
    integer :: parts
    parts = 1
    if (scene%coupled) then
      limit = flow_limit(scene%mesh, scene%flow)
      parts = max(1, ceiling(left/(limit%dt*(1 + 1e-9_wp))))
    end if
    if (parts == 1) then
      dt = left
      left = 0
    else
      dt = left/parts
      left = left - dt
    end if
  end subroutine flow_part

  function flow_limiter(scene, limit) result(line)
    type(scene_type), intent(in) :: scene
    type(flow_limit_type), intent(in) :: limit
    character(:), allocatable :: line
    if (limit%is_front) then
      line = 'flow, front of the detonation'
    else
      line = 'flow, '//trim(scene%flow%name(max(limit%material, 1)))//' at '//place(scene, limit%position)
    end if
  end function flow_limiter

  function solid_limiter(scene, limit) result(line)
    type(scene_type), intent(in) :: scene
    type(solid_limit_type), intent(in) :: limit
    character(:), allocatable :: line
    line = 'solid, '//trim(scene%solid%material(max(limit%set, 1))%name)//' at '//place(scene, limit%position)
  end function solid_limiter

  !> A point in as many coordinates as the scene has directions.
  function place(scene, position) result(line)
    type(scene_type), intent(in) :: scene
    real(wp), intent(in) :: position(3)
    character(:), allocatable :: line
    integer :: d
    line = '('
    do d = 1, 3
      if (.not. scene%mesh%active(d)) cycle
      if (len(line) > 1) line = line//', '
      line = line//str(position(d), 4)
    end do
    line = line//')'
  end function place

end module time_step
