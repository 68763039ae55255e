!> The flow of this rank: state of its bricks in three rotating buffers, materials, boundary conditions, books and repairs.
module flow_state
  use afterburn, only: afterburn_type
  use blocks, only: block, allocate_cells, holder
  use brick_stage, only: stage_scratch
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type, new_layout, n_flow_books
  use flow_scheme, only: scheme_type
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  implicit none
  private
  public :: allocate_flow, hold_cells, release_cells, set_inflow

  integer, parameter, public :: face_outflow = 1, face_symmetry = 2, face_inflow = 3, face_periodic = 4, &
    face_ambient = 5

  !> Kinds of repair that are counted.
  integer, parameter, public :: repair_negative_mass = 1, repair_clipped_fraction = 2, repair_relaxation = 3, &
    repair_low_pressure = 4, repair_first_order = 5, n_repairs = 5
  character(28), parameter, public :: repair_names(n_repairs) = [character(28) :: 'negative mass set to nil', &
    'volume fraction clipped', 'relaxation by bisection', 'pressure lifted to its floor', 'redone in first order']

  integer, parameter, public :: most_common_states = 8 !< that the sleeping bricks of a rank may have

  real(wp), parameter :: no_noise = 1e-100_wp !< eps**2 that does no more than keep 0/0 away

  !> Counts of this rank. Relaxation by bisection leaves the answer as it is; cells redone in first order keep all that is
  !> conserved; the others change it.
  type, public :: repair_log
    integer(i8) :: count(n_repairs) = 0
    real(wp) :: position(3, n_repairs) = 0 !< centre of the last cell repaired
  end type repair_log

  type, public :: flow_type
    integer :: n_materials = 0
    character(64), allocatable :: name(:) !< of the materials
    type(eos_type), allocatable :: eos(:)
    type(layout_type) :: layout
    !> State: local brick, buffer 1..3. Sleeping bricks share one of the blocks of common states that stand behind those of the
    !> bricks: flow%holder(b) is the index of the block that holds the state of brick b.
    type(block), allocatable :: w(:, :)
    integer :: current = 1 !< buffer of the state at the start of the step
    type(scheme_type) :: scheme
    real(wp), allocatable :: eps2(:) !< square of the limiter's eps for each reconstructed row, in the row's units
    real(wp), allocatable :: steepest(:) !< alpha of the fifth-order bound for each reconstructed row
    logical, allocatable :: positive(:) !< reconstructed rows whose face values must be so
    real(wp) :: cfl = 0.8_wp !< of the sum over directions
    real(wp) :: trace_fraction = 1e-8_wp !< smallest volume fraction of a material
    real(wp) :: floor_pressure = 1e-30_wp !< smallest distance from a gas's lowest pressure
    real(wp) :: time = 0 !< at the start of the step
    real(wp) :: gravity(3) = 0
    integer :: face(2, 3) = face_outflow !< condition at the low and high face of each direction
    real(wp), allocatable :: inflow(:) !< rows of the state that enters
    real(wp), allocatable :: ambient(:) !< rows of the state beyond ambient faces
    type(block), allocatable :: open(:) !< 1 flows, 0 closed; allocated only in bricks with closed cells; ghosts filled
    type(block), allocatable :: wall_impulse(:) !< momentum (3) given to closed cells, in the open cell beside them; with open
    type(block), allocatable :: wall(:) !< of walls that move: velocity (3) in closed cells, in open ones beside them normals (3, 3)
    logical :: slip = .true. !< gas glides along walls that move
    !> 1 where a stage is redone with first-order fluxes; allocated while that goes on; sleeping bricks share the last one, all nil.
    type(block), allocatable :: troubled(:)
    type(block), &
      allocatable :: arrival(:) !< of the detonation front; allocated in bricks that hold explosive still to burn; with ghosts
    real(wp), allocatable :: burn_energy(:), burn_rate(:) !< of each material: see burn_release
    real(wp) :: burn_speed = 0 !< fastest front, 0 when all has burnt
    real(wp) :: burn_end = 0 !< time at which all has burnt
    real(wp) :: burn_total = 0 !< energy that burning releases from the start to the end
    type(afterburn_type), allocatable :: afterburn(:) !< of each material
    real(wp), allocatable :: books(:, :, :) !< what entered: conserved quantity, face (x low, x high, ...) or book_*, local brick
    type(repair_log) :: repairs
    type(stage_scratch) :: scratch
    logical :: sleep = .true. !< bricks in one uniform state hold no cells of their own and are not advanced
    logical, allocatable :: kept_awake(:) !< local bricks whose cells the coupling changes between stages
    logical, allocatable :: closed(:) !< of each local brick: all its cells and those beside them are closed
    logical :: common_closed(most_common_states) = .false. !< common states of closed bricks, in which nothing flows
    type(stage_scratch) :: common_scratch
    integer(i8) :: advanced_bricks = 0, all_bricks = 0 !< of this rank, summed over the stages
  contains
    procedure :: target => target_buffer
    procedure :: holder => state_holder
    procedure :: lowest_pressure
    procedure :: material_name
  end type flow_type

contains

  !> Allocates the flow on this rank's bricks: all ones, to be filled. name, eos: of the materials; without_cells: the state is not
  !> allocated yet, hold_cells does that brick by brick.
  subroutine allocate_flow(flow, mesh, name, eos, without_cells)
    type(flow_type), intent(inout) :: flow
    type(mesh_type), intent(in) :: mesh
    character(*), intent(in) :: name(:)
    type(eos_type), intent(in) :: eos(:)
    logical, intent(in), optional :: without_cells
    integer :: b
    flow%n_materials = size(eos)
    flow%name = name
    flow%eos = eos
    flow%layout = new_layout(eos)
    allocate (flow%w(mesh%n_local + most_common_states, 3), flow%open(mesh%n_local), flow%wall_impulse(mesh%n_local), &
      flow%wall(mesh%n_local), flow%troubled(mesh%n_local + 1), flow%arrival(mesh%n_local))
    allocate (flow%closed(mesh%n_local), flow%kept_awake(mesh%n_local), source=.false.)
    allocate (flow%eps2(flow%layout%n_reconstructed), source=no_noise)
    allocate (flow%steepest(flow%layout%n_reconstructed), source=4.0_wp)
    if (size(eos) > 1) then
      ! masses and fractions of traces would oscillate below 0
      flow%steepest(:size(eos)) = 2
      flow%steepest(flow%layout%first_fraction_row:) = 2
    end if
    allocate (flow%positive(flow%layout%n_reconstructed), source=.true.)
    flow%positive(flow%layout%velocity_row:flow%layout%velocity_row + 2) = .false.
    flow%positive(flow%layout%pressure_row) = .not. flow%lowest_pressure() < 0
    do b = 1, size(eos)
      if (flow%layout%energy_row(b) > 0) flow%positive(flow%layout%energy_row(b)) = .false.
    end do
    allocate (flow%burn_energy(size(eos)), flow%burn_rate(size(eos)), source=0.0_wp)
    allocate (flow%afterburn(size(eos)))
    allocate (flow%books(flow%layout%n_conserved, n_flow_books, mesh%n_local), source=0.0_wp)
    do b = 1, mesh%n_local
      if (present(without_cells)) then
        if (without_cells) exit
      end if
      call hold_cells(flow, mesh, b)
    end do
    do b = 1, 3
      if (mesh%periodic(b)) flow%face(:, b) = face_periodic
    end do
  end subroutine allocate_flow

  !> Allocates the state of local brick or common state b: all ones.
  subroutine hold_cells(flow, mesh, b)
    type(flow_type), intent(inout) :: flow
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b
    integer :: buffer
    do buffer = 1, 3
      call allocate_cells(flow%w(b, buffer), mesh%brick_cells, mesh%ghost, flow%layout%n_rows, 1.0_wp)
      flow%w(b, buffer)%shares = 0
    end do
  end subroutine hold_cells

  !> Index in w of the block that holds the state of local brick b: its own, or the one that it shares.
  pure integer function state_holder(self, b)
    class(flow_type), intent(in) :: self
    integer, intent(in) :: b
    state_holder = holder(self%w(:, self%current), b)
  end function state_holder

  !> Gives the memory of a flow back that is needed no more; books and counts stay.
  subroutine release_cells(flow)
    type(flow_type), intent(inout) :: flow
    deallocate (flow%w, flow%open, flow%wall_impulse, flow%wall, flow%troubled, flow%arrival)
  end subroutine release_cells

  !> Buffer that stage 1, 2 or 3 writes; stage 3's becomes the state.
  pure integer function target_buffer(self, stage)
    class(flow_type), intent(in) :: self
    integer, intent(in) :: stage
    target_buffer = 1 + mod(self%current + merge(1, 0, stage == 2), 3)
  end function target_buffer

  !> Pressures at or below this cannot be: every material is present everywhere, if only as a trace.
  pure real(wp) function lowest_pressure(self)
    class(flow_type), intent(in) :: self
    integer :: k
    lowest_pressure = -huge(1.0_wp)
    do k = 1, self%n_materials
      if (self%eos(k)%is_gas) then
        lowest_pressure = max(lowest_pressure, -self%eos(k)%gas%p_infinity)
      else
        lowest_pressure = max(lowest_pressure, 0.0_wp)
      end if
    end do
  end function lowest_pressure

  !> Name of material k; empty for 0.
  pure function material_name(self, k) result(name)
    class(flow_type), intent(in) :: self
    integer, intent(in) :: k
    character(:), allocatable :: name
    name = ''
    if (k > 0) name = trim(self%name(k))
  end function material_name

  !> The state that enters at inflow faces. state: rows of one cell.
  subroutine set_inflow(flow, state)
    type(flow_type), intent(inout) :: flow
    real(wp), intent(in) :: state(:)
    flow%inflow = state
  end subroutine set_inflow

end module flow_state
