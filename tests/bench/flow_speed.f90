!> Times whole steps of a scene: the fastest of several short windows, since machines are shared.
module flow_speed
  use flow_problem, only: problem_type
  use flow_problem_run, only: open_problem
  use flow_scenes, only: flow_scene, run_steps
  use flow_scheme, only: scheme_type
  use flow_step, only: fill_ghosts
  use flow_time_step, only: flow_limit, flow_limit_type
  use kinds, only: wp, i8
  implicit none
  private
  public :: time_steps

  type, public :: speed_type
    real(wp) :: nanoseconds = 0 !< per cell and stage, all told: wall time of a step over three times its cells
    real(wp) :: bookkeeping = 0 !< share of a step spent on ghost cells and on the search for the time step
  end type speed_type

  integer, parameter :: steps = 2 !< of a window

contains

  !> side: cells of a brick in every direction that is there.
  function time_steps(problem, scheme, side, windows) result(speed)
    type(problem_type), intent(in) :: problem
    type(scheme_type), intent(in) :: scheme
    integer, intent(in) :: side, windows
    type(speed_type) :: speed
    type(flow_scene) :: scene
    type(flow_limit_type) :: limit
    real(wp) :: began, step, other
    integer :: i, stage
    call open_problem(problem, 0, scheme, scene, brick=merge(side, 1, problem%cells > 1))
    scene%flow%sleep = .false. ! a still gas costs as much as any other
    call run_steps(scene, 2) ! memory is touched, work space made
    step = huge(step)
    other = huge(other)
    do i = 1, windows
      began = clock()
      call run_steps(scene, steps)
      step = min(step, (clock() - began)/steps)
      began = clock()
      do stage = 1, 3
        call fill_ghosts(scene%mesh, scene%halo, scene%flow, scene%flow%current)
      end do
      limit = flow_limit(scene%mesh, scene%flow)
      other = min(other, clock() - began)
    end do
    speed%nanoseconds = 1e9_wp*step/(3*product(real(problem%cells, wp)))
    speed%bookkeeping = other/step
    if (.not. limit%dt > 0) speed%nanoseconds = huge(step)
  end function time_steps

  real(wp) function clock()
    integer(i8) :: now, rate
    call system_clock(now, rate)
    clock = real(now, wp)/real(rate, wp)
  end function clock

end module flow_speed
