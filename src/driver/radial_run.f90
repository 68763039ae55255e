!> The blast of one charge on a fine mesh of its own, in one radial direction: a scene like any other, whose mesh grows with the
!> wave.
module radial_run
  use blocks, only: block, own
  use charge_reach, only: ambient_region, cells_in_charge, charge_radius, dimensions_of_blast
  use deck_types, only: deck_type, region_group
  use errors, only: fatal, exit_bad_input
  use flow_totals, only: flow_totals_type, sum_flow
  use kinds, only: wp
  use log, only: be_quiet
  use main_loop, only: advance_scene
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allgatherv, MPI_Allreduce, MPI_DOUBLE_PRECISION, MPI_IN_PLACE, MPI_SUM
  use parallel, only: is_root, n_ranks, world
  use peak_maps, only: peak_maps_type, start_peaks, update_peaks
  use radial_profile, only: radial_profile_type, n_felt, felt_arrival, felt_whole_impulse, n_seen, seen_pressure, seen_density, &
    seen_velocity
  use reductions, only: reduce_max
  use scene, only: scene_type
  use setup, only: lay_out_scene, make_scene
  use text, only: str
  implicit none
  private
  public :: run_radially, radial_deck

  real(wp), parameter :: noticeable = 1e-6_wp !< part of pressure and sound speed that counts as the front of the wave
  real(wp), parameter :: slightest = 1e-9_wp !< what is above the noise of relaxation in still surroundings
  integer, parameter :: brick = 128 !< cells
  integer, parameter :: first_radii = 4 !< charge radii that the mesh reaches over at first
  integer, parameter :: margin = 48 !< cells before the front that hold its foot

  !> The run and what its cells have felt.
  type :: radial_run_type
    type(scene_type) :: scene
    type(peak_maps_type) :: peaks
    type(block), allocatable :: impulse(:) !< integral of the overpressure of each cell, and the overpressure at the last step
    real(wp), allocatable :: still(:) !< state of the surroundings
    real(wp), allocatable :: gauge(:) !< radii
    real(wp), allocatable :: seen(:, :, :) !< (seen_*, gauge, step + 1): this rank's part
    real(wp), allocatable :: seen_at(:)
    integer :: n_seen_at = 0
    real(wp) :: afterburnt = 0 !< before the mesh grew last
  end type radial_run_type

contains

  !> Runs charge c until its wave has reached `stop_radius` and all of it has burnt, or until `latest`, whichever comes first.
  !> To be called by all ranks, who share the work; the same bits on any number of them. Fatal (bad input) where neither comes
  !> before the end of the deck's run.
  function run_radially(deck, c, stop_radius, latest) result(profile)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(in) :: stop_radius, latest
    type(radial_profile_type) :: profile
    type(radial_run_type) :: run
    real(wp) :: front, disturbed
    integer :: cells
    logical :: was_quiet
    call be_quiet(was=was_quiet)
    cells = brick*ceiling(real(first_radii*cells_in_charge(deck, c), wp)/brick)
    call start_run(run, deck, c, cells)
    run%gauge = gauges_of(deck, c)
    call look(run)
    do
      associate (scene => run%scene, flow => run%scene%flow)
        call find_wave(run, front, disturbed)
        if (front >= stop_radius .and. (flow%time > flow%burn_end .or. .not. flow%burn_total > 0)) exit
        if (scene%clock%time >= latest) exit
        if (scene%clock%time >= deck%run%end_time) call fatal('charge '//str(c)//': at the end of the run, '// &
          str(scene%clock%time)//', its wave has come to '//str(front)//' only, not to '//str(stop_radius)// &
          ', where it is to enter the scene', exit_bad_input)
        if (front > (cells - margin)*scene%mesh%spacing(1)) then
          call grow(run, deck, c, 2*cells)
          cells = 2*cells
        end if
        call advance_scene(scene, min(latest, deck%run%end_time))
        call measure(run)
        call look(run)
      end associate
    end do
    profile = profile_of(run, front, disturbed)
    call be_quiet(silent=was_quiet)
  end function run_radially

  !> The deck of that run: the charge alone in still surroundings, on a mesh of so many cells along the radius.
  function radial_deck(deck, c, cells) result(alone)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, cells
    type(deck_type) :: alone
    type(deck_type) :: none
    type(region_group) :: ambient
    integer :: i
    alone = deck
    alone%mesh = none%mesh
    alone%mesh%geometry = deck%charge(c)%start
    alone%mesh%cells(1) = cells
    alone%mesh%upper = 1
    alone%mesh%upper(1) = cells*(charge_radius(deck, c)/cells_in_charge(deck, c))
    alone%mesh%brick(1) = brick
    alone%boundary = none%boundary
    alone%stages = none%stages
    alone%boundary%x_low = 'symmetry'
    alone%boundary%inflow_material = deck%boundary%inflow_material ! one of the flow's materials
    alone%flow%gravity = 0
    alone%flow%sleep = .false. ! the mesh grows with the wave instead
    ! the surroundings cover all other regions, which stay for their materials
    ambient = deck%region(ambient_region(deck, c))
    alone%region = [(deck%region(i), i=1, size(deck%region)), ambient]
    alone%region%shape = 'all'
    alone%charge%start = 'none'
    alone%charge%center(1) = 0
    alone%charge(1) = alone%charge(c)
    alone%charge = alone%charge(:1)
    if (allocated(deck%detonator)) then
      alone%detonator = pack(deck%detonator, deck%detonator%charge == 0 .or. deck%detonator%charge == c)
      alone%detonator%charge = 0
      alone%detonator%position(1) = 0
    end if
    alone%body = deck%body(:0)
    alone%gauge = deck%gauge(:0)
    alone%has_solid = .false.
  end function radial_deck

  subroutine start_run(run, deck, c, cells)
    type(radial_run_type), intent(inout) :: run
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, cells
    integer :: b
    run%scene%deck = radial_deck(deck, c, cells)
    call lay_out_scene(run%scene)
    call make_scene(run%scene)
    associate (mesh => run%scene%mesh, flow => run%scene%flow)
      call start_peaks(run%peaks, mesh, deck%flow%ambient_pressure, 0.01_wp*abs(deck%flow%ambient_pressure))
      allocate (run%impulse(mesh%n_local))
      do b = 1, mesh%n_local
        call own(run%peaks%map, b)
        allocate (run%impulse(b)%a(mesh%brick_cells(1), 2, 1, 1), source=0.0_wp)
        run%impulse(b)%a(:, 2, 1, 1) = flow%w(b, flow%current)%a(1:mesh%brick_cells(1), flow%layout%pressure(), 1, 1) &
                                       - run%peaks%ambient
      end do
      run%still = last_column(mesh, flow%w(:, flow%current), flow%layout%n_rows)
    end associate
    call update_peaks(run%peaks, run%scene%mesh, run%scene%flow%w(:, run%scene%flow%current), run%scene%flow%open, &
                      run%scene%flow%layout%pressure(), 0.0_wp, 0.0_wp)
  end subroutine start_run

  !> What the cells have felt in the last step.
  subroutine measure(run)
    type(radial_run_type), intent(inout) :: run
    real(wp), allocatable :: overpressure(:)
    integer :: b
    associate (mesh => run%scene%mesh, flow => run%scene%flow, clock => run%scene%clock)
      call update_peaks(run%peaks, mesh, flow%w(:, flow%current), flow%open, flow%layout%pressure(), clock%time, clock%dt)
      do b = 1, mesh%n_local
        overpressure = flow%w(b, flow%current)%a(1:mesh%brick_cells(1), flow%layout%pressure(), 1, 1) - run%peaks%ambient
        associate (impulse => run%impulse(b)%a(:, 1, 1, 1), last => run%impulse(b)%a(:, 2, 1, 1))
          impulse = impulse + 0.5_wp*clock%dt*(last + overpressure)
          last = overpressure
        end associate
      end do
    end associate
  end subroutine measure

  !> Distances of the flow gauges from charge c.
  pure function gauges_of(deck, c) result(radius)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), allocatable :: radius(:)
    integer :: g
    allocate (radius(0))
    do g = 1, size(deck%gauge)
      if (deck%gauge(g)%kind == 'flow') radius = [radius, norm2(merge(deck%gauge(g)%position - deck%charge(c)%center, 0.0_wp, &
                                                                       deck%mesh%active()))]
    end do
  end function gauges_of

  !> Takes a row of the history at the gauges: linear between the middles of two cells, of which each rank adds its own.
  subroutine look(run)
    type(radial_run_type), intent(inout) :: run
    real(wp), allocatable :: more(:, :, :)
    real(wp) :: place, part
    integer :: g, n, i
    if (.not. allocated(run%seen)) allocate (run%seen(n_seen, size(run%gauge), 64), run%seen_at(64))
    n = run%n_seen_at + 1
    if (n > size(run%seen_at)) then
      allocate (more(n_seen, size(run%gauge), 2*n))
      more(:, :, :n - 1) = run%seen
      call move_alloc(more, run%seen)
      run%seen_at = [run%seen_at, run%seen_at, 0.0_wp, 0.0_wp]
    end if
    run%n_seen_at = n
    run%seen_at(n) = run%scene%clock%time
    run%seen(:, :, n) = 0
    associate (mesh => run%scene%mesh)
      do g = 1, size(run%gauge)
        place = max(run%gauge(g)/mesh%spacing(1) + 0.5_wp, 1.0_wp)
        if (.not. place < mesh%cells(1)) then
          if (is_root()) run%seen(:, g, n) = run%still(columns_seen(run))
          cycle
        end if
        i = int(place)
        part = place - i
        call add(i, 1 - part)
        call add(i + 1, part)
      end do
    end associate
  contains
    subroutine add(cell, weight)
      integer, intent(in) :: cell
      real(wp), intent(in) :: weight
      integer :: b, i
      associate (mesh => run%scene%mesh, flow => run%scene%flow)
        do b = 1, mesh%n_local
          i = cell - mesh%brick(mesh%local(b))%location(1)*mesh%brick_cells(1)
          if (i < 1 .or. i > mesh%brick_cells(1)) cycle
          run%seen(:, g, n) = run%seen(:, g, n) + weight*flow%w(b, flow%current)%a(i, columns_seen(run), 1, 1)
        end do
      end associate
    end subroutine add
  end subroutine look

  !> Rows of the flow that a history has.
  pure function columns_seen(run) result(columns)
    type(radial_run_type), intent(in) :: run
    integer :: columns(n_seen)
    columns(seen_pressure) = run%scene%flow%layout%pressure()
    columns(seen_density) = run%scene%flow%layout%density()
    columns(seen_velocity) = run%scene%flow%layout%velocity(1)
  end function columns_seen

  !> front: radius that the wave has come to; disturbed: radius beyond which all is still but for noise.
  subroutine find_wave(run, front, disturbed)
    type(radial_run_type), intent(in) :: run
    real(wp), intent(out) :: front, disturbed
    real(wp) :: nothing(0), motion
    integer :: b, i
    front = 0
    disturbed = 0
    associate (mesh => run%scene%mesh, flow => run%scene%flow, layout => run%scene%flow%layout)
      do b = mesh%n_local, 1, -1
        do i = mesh%brick_cells(1), 1, -1
          associate (cell => flow%w(b, flow%current)%a(i, :, 1, 1), x => mesh%brick(mesh%local(b))%origin(1) + i*mesh%spacing(1))
            motion = max(abs(cell(layout%pressure_row)/run%still(layout%pressure_row) - 1), &
                         abs(cell(layout%velocity_row))/run%still(layout%sound_speed_row))
            if (max(motion, abs(cell(layout%density_row)/run%still(layout%density_row) - 1)) > slightest) &
              disturbed = max(disturbed, x)
            if (motion > noticeable) front = max(front, x)
          end associate
        end do
      end do
    end associate
    call reduce_max(front, nothing)
    call reduce_max(disturbed, nothing)
  end subroutine find_wave

  !> The same run on a longer mesh; what is added is still.
  subroutine grow(run, deck, c, cells)
    type(radial_run_type), intent(inout) :: run
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, cells
    type(radial_run_type) :: longer
    real(wp), allocatable :: state(:, :), peak(:, :), impulse(:, :)
    type(flow_totals_type) :: totals
    associate (old => run%scene, new => longer%scene)
      state = columns_of(old%mesh, old%flow%w(:, old%flow%current), old%flow%layout%n_rows)
      peak = columns_of(old%mesh, run%peaks%map, felt_arrival)
      impulse = columns_of(old%mesh, run%impulse, 2)
      totals = sum_flow(old%mesh, old%flow)
      call start_run(longer, deck, c, cells)
      call put_columns(new%mesh, state, new%flow%w(:, new%flow%current))
      call put_columns(new%mesh, peak, longer%peaks%map)
      call put_columns(new%mesh, impulse, longer%impulse)
      new%clock = old%clock
      new%flow%time = old%flow%time
      longer%afterburnt = run%afterburnt + totals%afterburnt
      longer%gauge = run%gauge
      longer%n_seen_at = run%n_seen_at
      call move_alloc(run%seen, longer%seen)
      call move_alloc(run%seen_at, longer%seen_at)
    end associate
    run = longer
  end subroutine grow

  function profile_of(run, front, disturbed) result(profile)
    type(radial_run_type), intent(in) :: run
    real(wp), intent(in) :: front, disturbed
    type(radial_profile_type) :: profile
    type(flow_totals_type) :: totals
    real(wp), allocatable :: impulse(:, :)
    integer :: n
    associate (mesh => run%scene%mesh, flow => run%scene%flow)
      profile%radial_power = mesh%radial_power
      profile%thickness = mesh%spacing(1)
      profile%time = run%scene%clock%time
      profile%front = front
      totals = sum_flow(mesh, flow)
      profile%afterburnt = run%afterburnt + totals%afterburnt
      n = min(nint(min(disturbed/mesh%spacing(1), front/mesh%spacing(1) + margin - 1)) + 1, mesh%cells(1))
      profile%state = columns_of(mesh, flow%w(:, flow%current), flow%layout%n_rows)
      profile%state = profile%state(:, :n)
      allocate (profile%felt(n_felt, n))
      impulse = columns_of(mesh, run%peaks%map, felt_arrival)
      profile%felt(:felt_arrival, :) = impulse(:, :n)
      impulse = columns_of(mesh, run%impulse, 1)
      profile%felt(felt_whole_impulse, :) = impulse(1, :n)
    end associate
    profile%gauge = run%gauge
    profile%seen_at = run%seen_at(:run%n_seen_at)
    profile%seen = run%seen(:, :, :run%n_seen_at)
    call MPI_Allreduce(MPI_IN_PLACE, profile%seen, size(profile%seen), MPI_DOUBLE_PRECISION, MPI_SUM, world)
  end function profile_of

  !> All columns of a field along the radius, variables 1..n_var, on every rank: bricks of ranks follow each other along it.
  function columns_of(mesh, field, n_var) result(columns)
    type(mesh_type), intent(in) :: mesh
    type(block), intent(in) :: field(:)
    integer, intent(in) :: n_var
    real(wp), allocatable :: columns(:, :)
    real(wp) :: mine(n_var, mesh%brick_cells(1), mesh%n_local)
    integer :: counts(n_ranks), offsets(n_ranks), r, b
    do b = 1, mesh%n_local
      mine(:, :, b) = transpose(field(b)%a(1:mesh%brick_cells(1), 1:n_var, 1, 1))
    end do
    do r = 1, n_ranks
      counts(r) = n_var*mesh%brick_cells(1)*count(mesh%brick%rank == r - 1)
      offsets(r) = sum(counts(:r - 1))
    end do
    allocate (columns(n_var, mesh%cells(1)))
    call MPI_Allgatherv(mine, size(mine), MPI_DOUBLE_PRECISION, columns, counts, offsets, MPI_DOUBLE_PRECISION, world)
  end function columns_of

  function last_column(mesh, field, n_var) result(column)
    type(mesh_type), intent(in) :: mesh
    type(block), intent(in) :: field(:)
    integer, intent(in) :: n_var
    real(wp) :: column(n_var)
    real(wp), allocatable :: all_columns(:, :)
    all_columns = columns_of(mesh, field, n_var)
    column = all_columns(:, mesh%cells(1))
  end function last_column

  !> Puts columns into the cells nearest to the centre; there are fewer of them than cells.
  subroutine put_columns(mesh, columns, field)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: columns(:, :)
    type(block), intent(inout) :: field(:)
    integer :: b, i, before
    do b = 1, mesh%n_local
      before = mesh%brick(mesh%local(b))%location(1)*mesh%brick_cells(1)
      do i = 1, min(mesh%brick_cells(1), size(columns, 2) - before)
        field(b)%a(i, 1:size(columns, 1), 1, 1) = columns(:, before + i)
      end do
    end do
  end subroutine put_columns

end module radial_run
