!> All that a run holds: the deck, the mesh, the three solvers' states, the clock, and what is written.
module scene
  use body_loads, only: body_loads_type
  use deck_types, only: deck_type
  use flow_state, only: flow_type
  use halo, only: halo_type
  use immersed_boundary, only: coupling_type
  use kinds, only: wp
  use mesh, only: mesh_type
  use solid_state, only: solid_type
  use stages, only: stages_type
  use timers, only: stopwatch
  implicit none
  private

  !> Where the run stands and how large its next step is.
  type, public :: clock_type
    integer :: step = 0
    real(wp) :: time = 0
    real(wp) :: end_time = 0
    real(wp) :: dt = 0 !< of the step under way
    integer :: solid_steps = 1 !< steps of the solid in it
    integer :: flow_steps = 1 !< steps of the flow in it, counted
    character(:), allocatable :: limiter !< what sets dt, for people
    integer :: n_flow_steps = 0, n_solid_steps = 0 !< since the start of the scene
  end type clock_type

  type, public :: scene_type
    type(deck_type) :: deck
    type(mesh_type) :: mesh
    type(halo_type) :: halo
    logical :: has_flow = .false., has_solid = .false., coupled = .false.
    type(flow_type) :: flow
    type(solid_type) :: solid
    type(coupling_type) :: coupling
    type(body_loads_type) :: loads
    type(stages_type) :: stages
    type(clock_type) :: clock
    type(stopwatch) :: watch !< wall time by phase
  contains
    procedure :: flow_runs
    procedure :: solid_runs
  end type scene_type

contains

  !> There is a flow, and it is not over.
  pure logical function flow_runs(self)
    class(scene_type), intent(in) :: self
    flow_runs = self%has_flow .and. .not. self%stages%flow_over
  end function flow_runs

  !> There is a solid that can move, and it neither waits nor rests.
  pure logical function solid_runs(self)
    class(scene_type), intent(in) :: self
    solid_runs = self%has_solid .and. .not. (self%stages%solid_waits .or. self%stages%solid_over)
  end function solid_runs

end module scene
