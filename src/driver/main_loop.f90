!> The method, step by step: reading this from top to bottom tells what a step does.
module main_loop
  use body_loads, only: gather_loads
  use burn, only: end_burn
  use flow_step, only: advance_stage, accept_step
  use immersed_boundary, only: immerse_solid, find_wall_velocity, force_first_state, force_stage, collect_force, hold_solid
  use kinds, only: wp
  use records, only: records_type, record_step, stop_if_asked
  use rigid_bodies, only: load_rigid
  use scene, only: scene_type
  use solid_load, only: load_particles
  use solid_step, only: advance_solid
  use stage_changes, only: review_stages
  use stages, only: hold_load, note_load
  use time_step, only: choose_time_step, flow_part
  implicit none
  private
  public :: run_scene, advance_scene

contains

  !> Advances the scene to its end, or until it is told to stop; status: exit status of the program.
  subroutine run_scene(scene, records, status)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    integer, intent(out) :: status
    logical :: finished
    call stop_if_asked(scene, records, finished, status)
    do while (.not. finished)
      call advance_scene(scene, records%next_snapshot)
      call record_step(scene, records)
      call stop_if_asked(scene, records, finished, status)
    end do
  end subroutine run_scene

  !> One step of the scene. next_event: time that a step shall end at.
  subroutine advance_scene(scene, next_event)
    type(scene_type), intent(inout) :: scene
    real(wp), intent(in) :: next_event
    scene%flow%time = scene%clock%time
    call end_burn(scene%flow)
    call choose_time_step(scene, next_event)
    if (scene%flow_runs()) then
      if (scene%coupled) call meet_solid(scene)
      call advance_flow(scene)
      if (scene%coupled) call note_loads(scene)
    end if
    if (scene%solid_runs()) call advance_structure(scene)
    scene%clock%time = scene%clock%time + scene%clock%dt
    scene%clock%step = scene%clock%step + 1
    call review_stages(scene)
  end subroutine advance_scene

  !> Cell types from the particles, answers for covered and uncovered gas, velocity of the solid where it meets the flow. A solid
  !> that does not move is met once.
  subroutine meet_solid(scene)
    type(scene_type), intent(inout) :: scene
    call scene%watch%start('coupling')
    if (scene%stages%solid_met .and. .not. scene%solid_runs()) then
      call hold_solid(scene%flow, scene%coupling)
    else
      call immerse_solid(scene%mesh, scene%halo, scene%solid, scene%flow, scene%coupling)
      call find_wall_velocity(scene%mesh, scene%halo, scene%solid, scene%flow, scene%coupling, scene%clock%dt)
      scene%stages%solid_met = .true.
    end if
    call scene%watch%stop('coupling')
  end subroutine meet_solid

  !> The flow over the step, in parts if its own limit asks for them; each part in three stages of SSP Runge-Kutta, the velocity of
  !> the solid imposed after each. What this takes from the flow becomes the force on the solid.
  subroutine advance_flow(scene)
    type(scene_type), intent(inout) :: scene
    real(wp) :: left, dt
    integer :: stage
    left = scene%clock%dt
    scene%clock%flow_steps = 0
    do while (left > 0)
      call flow_part(scene, left, dt)
      if (scene%coupled) call force_first_state(scene%mesh, scene%flow, scene%coupling)
      do stage = 1, 3
        call scene%watch%start('flow')
        call advance_stage(scene%mesh, scene%halo, scene%flow, stage, dt)
        call scene%watch%stop('flow')
        if (scene%coupled) call force_stage(scene%mesh, scene%flow, scene%coupling, stage, dt)
      end do
      call accept_step(scene%flow)
      scene%flow%time = scene%flow%time + dt
      scene%clock%flow_steps = scene%clock%flow_steps + 1
    end do
    scene%clock%n_flow_steps = scene%clock%n_flow_steps + scene%clock%flow_steps
    if (scene%coupled) call collect_force(scene%mesh, scene%flow, scene%coupling, scene%clock%dt)
  end subroutine advance_flow

  !> What the bodies felt in the step, while the particles are still where they felt it.
  subroutine note_loads(scene)
    type(scene_type), intent(inout) :: scene
    real(wp) :: time
    call scene%watch%start('loads')
    time = scene%clock%time + scene%clock%dt
    call note_load(scene%stages, scene%mesh, scene%coupling, time, scene%clock%dt)
    if (scene%loads%active) call gather_loads(scene%loads, scene%mesh, scene%solid, scene%coupling%list, scene%coupling%face, &
                                              time, scene%clock%dt)
    if (.not. scene%solid_runs()) call hold_load(scene%coupling, scene%solid)
    call scene%watch%stop('loads')
  end subroutine note_loads

  !> The solid over the step, in equal parts under the same force.
  subroutine advance_structure(scene)
    type(scene_type), intent(inout) :: scene
    integer :: part
    real(wp) :: dt
    call scene%watch%start('solid')
    scene%solid%step = scene%clock%step
    scene%solid%time = scene%clock%time
    scene%solid%limiter = scene%clock%limiter
    dt = scene%clock%dt/scene%clock%solid_steps
    if (scene%coupled .and. scene%flow_runs()) then
      call load_particles(scene%mesh, scene%solid, scene%coupling%force, scene%clock%dt)
      if (scene%solid%rigid_field > 0) call load_rigid(scene%mesh, scene%solid, scene%coupling%force)
    end if
    do part = 1, scene%clock%solid_steps
      call advance_solid(scene%mesh, scene%halo, scene%solid, dt)
    end do
    scene%clock%n_solid_steps = scene%clock%n_solid_steps + scene%clock%solid_steps
    call scene%watch%stop('solid')
  end subroutine advance_structure

end module main_loop
