!> The scene passes from one stage to the next: the solid begins to move, the flow is dropped, the solid comes to rest. Each change is
!> told with its reason.
module stage_changes
  use burn, only: end_burn
  use flow_totals, only: sum_flow
  use immersed_boundary, only: release_coupling
  use flow_state, only: release_cells
  use kinds, only: wp
  use log, only: say
  use scene, only: scene_type
  use stages, only: arrest_solid, flow_has_faded, note_motion, solid_rests
  use text, only: str
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: review_stages, release_flow

  integer, parameter :: steps_between_looks = 10 !< at the motion of the solid, which cost a pass over the particles

contains

  !> Looks after a step whether a solver has become needless.
  subroutine review_stages(scene)
    type(scene_type), intent(inout) :: scene
    logical :: over
    real(wp) :: part
    associate (stages => scene%stages, time => scene%clock%time)
      if (stages%solid_started >= time - scene%clock%dt) call tell(scene, 'the solid begins to move: the first load has reached it')
      if (scene%flow_runs() .and. scene%coupled) then
        call flow_has_faded(stages, scene%flow, time, over, part)
        if (over) then
          call tell(scene, 'the flow is dropped: of its load on the solid '//percent(part)// &
                    ' came in the second half of the time since the first')
          scene%flow%time = time
          call end_burn(scene%flow)
          stages%last_flow = sum_flow(scene%mesh, scene%flow)
          stages%flow_over = .true.
          stages%flow_ended = time
          call release_flow(scene)
        end if
      end if
      if (trim(stages%plan%solid_end) /= 'rest' .or. .not. scene%solid_runs()) return
      if (mod(scene%clock%step, steps_between_looks) /= 0) return
      call note_motion(stages, scene%mesh, scene%solid, time)
      call solid_rests(stages, time, over, part)
      if (.not. over) return
      call tell(scene, 'the solid rests: in the second half of its motion its kinetic energy was at most '//percent(part)// &
                ' of the largest')
      call arrest_solid(scene%solid)
      stages%solid_over = .true.
      stages%solid_met = .false.
      stages%solid_ended = time
    end associate
  end subroutine review_stages

  !> Gives the memory of the flow and of the coupling back; their books stay.
  subroutine release_flow(scene)
    type(scene_type), intent(inout) :: scene
    call release_cells(scene%flow)
    call release_coupling(scene%coupling)
  end subroutine release_flow

  subroutine tell(scene, what)
    type(scene_type), intent(in) :: scene
    character(*), intent(in) :: what
    type(unit_labels_type) :: labels
    labels = unit_labels(trim(scene%deck%run%units))
    call say('at '//str(scene%clock%time, 5)//' '//trim(labels%time)//' '//what)
  end subroutine tell

  function percent(part) result(text)
    real(wp), intent(in) :: part
    character(:), allocatable :: text
    text = str(100*part, 2)//' per cent'
  end function percent

end module stage_changes
