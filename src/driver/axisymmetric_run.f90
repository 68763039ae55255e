!> The blast of one charge on fine axisymmetric meshes of its own, one after the other as the wave grows: each takes over the state
!> of the one before as a scene takes over a blast. A sphere that burns from its centre begins along its radius alone.
module axisymmetric_run
  use blast_run, only: blast_run_type, keep_gauges, keep_history, note_energy, note_overpressure, note_step, profile_of, &
    run_until, start_run
  use charge_reach, only: burns_from_center, charge_radius, least_reach, reach_of_charge, start_axis
  use deck_types, only: deck_type, gauge_group
  use kinds, only: wp
  use log, only: be_quiet
  use radial_mapping, only: map_profile
  use radial_profile, only: blast_type, radial_profile_type, n_felt, felt_arrival, felt_whole_impulse
  use radial_run, only: deck_of_charge, run_radially
  use start_mesh, only: lay_start_mesh, mesh_of_start, start_mesh_type
  implicit none
  private
  public :: run_axisymmetrically, axisymmetric_deck

  integer, parameter :: margin = 16 !< cells before the front that hold its foot
  real(wp), parameter :: ample = 1.25_wp !< room of a mesh over the distance that a wave enters it with

contains

  !> Runs charge c until its wave has come to `stop_distance` from its centre and all of it has burnt, or until `latest`, whichever
  !> comes first. To be called by all ranks; the same bits on any number of them. Fatal (bad input) where neither comes before the
  !> end of the deck's run.
  function run_axisymmetrically(deck, c, stop_distance, latest) result(profile)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(in) :: stop_distance, latest
    type(radial_profile_type) :: profile
    type(blast_run_type) :: run
    type(start_mesh_type) :: mesh
    real(wp) :: room
    integer :: level, cells
    logical :: was_quiet, is_done
    call be_quiet(was=was_quiet)
    mesh = mesh_of_start(deck, c)
    call begin(run, deck, c, mesh, stop_distance, latest, level, cells, room)
    do
      call run_until(run, c, stop_distance, latest, room - margin*run%scene%mesh%spacing(1), is_done)
      if (is_done) exit
      if (level < mesh%doublings .and. .not. run%burns()) then
        level = level + 1
      else
        cells = 2*cells
      end if
      call grow(run, axisymmetric_deck(deck, c, mesh, level, cells, room))
    end do
    profile = profile_of(run, margin)
    profile%finest = mesh%thickness
    profile%end_distance = abs(mesh%end_place)
    profile%end_kind = mesh%end_kind
    call be_quiet(silent=was_quiet)
  end function run_axisymmetrically

  !> The run at its beginning: with the charge as it is, or, where that burns from its centre, with the blast that it has become by
  !> the time at which the wave comes to a face across the axis. level, cells: of its mesh; room: that it has.
  subroutine begin(run, deck, c, mesh, stop_distance, latest, level, cells, room)
    type(blast_run_type), intent(inout) :: run
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(start_mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: stop_distance, latest
    integer, intent(out) :: level, cells
    real(wp), intent(out) :: room
    type(deck_type) :: alone
    type(blast_type) :: blast
    character(:), allocatable :: obstacle
    real(wp) :: free
    if (burns_from_center(deck, c)) then
      free = min(stop_distance, minval(abs(mesh%end_place), abs(mesh%end_place) > 0))
      level = 0
      cells = mesh%first_cells
      do while (cells*mesh%thickness*2**level < ample*free)
        if (level < mesh%doublings) then
          level = level + 1
        else
          cells = 2*cells
        end if
      end do
      alone = axisymmetric_deck(deck, c, mesh, level, cells, room)
      alone%charge%start = 'spherical'
      call reach_of_charge(alone, 1, free, obstacle)
      free = min(free, stop_distance)
      if (free >= least_reach*charge_radius(deck, c)) then
        blast%profile = run_radially(alone, 1, free, latest)
        call start_run(run, alone)
        call keep_gauges(run, alone, blast_type(axis=2))
        call keep_history(run, blast%profile)
        call enter(run, blast)
        return
      end if
    end if
    level = 0
    cells = mesh%first_cells
    alone = axisymmetric_deck(deck, c, mesh, level, cells, room)
    call start_run(run, alone)
    call keep_gauges(run, alone, blast_type(axis=2))
    call note_step(run)
  end subroutine begin

  !> The deck of that run: the charge alone in still surroundings, with its centre at the origin and its axis along y. room:
  !> distance from the centre within which the mesh holds all.
  function axisymmetric_deck(deck, c, mesh, level, cells, room) result(alone)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, level, cells
    type(start_mesh_type), intent(in) :: mesh
    real(wp), intent(out) :: room
    type(deck_type) :: alone
    type(blast_type) :: blast
    integer :: g, i, axis
    axis = start_axis(deck, c)
    blast%center = deck%charge(c)%center
    blast%axis = axis
    alone = deck_of_charge(deck, c)
    alone%flow%sleep = .true.
    alone%charge%center(2) = 0
    alone%charge%center(3) = 0
    alone%charge(1)%axis = [0.0_wp, 1.0_wp, 0.0_wp]
    if (allocated(alone%detonator)) then
      do i = 1, size(alone%detonator)
        associate (d => alone%detonator(i), origin => deck%charge(c)%center(axis))
          d%position = [0.0_wp, d%position(axis) - origin, 0.0_wp]
          if (d%shape == 'line') d%end = [0.0_wp, d%end(axis) - origin, 0.0_wp]
          if (d%shape == 'plane') d%normal = [0.0_wp, d%normal(axis), 0.0_wp]
        end associate
      end do
    end if
    do g = 1, size(deck%gauge)
      if (deck%gauge(g)%kind == 'flow') alone%gauge = [alone%gauge, gauge_group(name=deck%gauge(g)%name, &
        position=[blast%place_of(deck%gauge(g)%position, deck%mesh%active()), 0.0_wp])]
    end do
    call lay_start_mesh(mesh, level, cells, alone, room)
  end function axisymmetric_deck

  !> The same run on another mesh.
  subroutine grow(run, deck)
    type(blast_run_type), intent(inout) :: run
    type(deck_type), intent(in) :: deck
    type(blast_run_type) :: next
    type(deck_type) :: mapped
    mapped = deck
    if (.not. run%burns()) mapped%charge%start = 'axisymmetric' ! nothing is left to burn
    call start_run(next, mapped)
    next%scene%clock = run%scene%clock
    next%gauge = run%gauge
    next%n_seen_at = run%n_seen_at
    call enter(next, blast_type(axis=2, profile=profile_of(run, margin)))
    call move_alloc(run%seen, next%seen)
    call move_alloc(run%seen_at, next%seen_at)
    run = next
  end subroutine grow

  !> A blast around the origin enters the mesh of a run.
  subroutine enter(run, blast)
    type(blast_run_type), intent(inout) :: run
    type(blast_type), intent(in) :: blast
    real(wp) :: felt(n_felt), x(3)
    integer :: b, i, j
    associate (mesh => run%scene%mesh, flow => run%scene%flow)
      call map_profile(mesh, flow, blast)
      run%scene%clock%time = blast%profile%time
      flow%time = blast%profile%time
      run%energy_error = blast%profile%energy_error
      call note_energy(run)
      call note_overpressure(run, 0.0_wp)
      do b = 1, mesh%n_local
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            x = mesh%brick(mesh%local(b))%origin + ([i, j, 1] - 0.5_wp)*mesh%spacing
            if (.not. blast%has_reached(x, mesh%active)) cycle
            felt = blast%profile%felt_at(blast%place_of(x, mesh%active))
            run%peaks%map(b)%a(i, :, j, 1) = felt(:felt_arrival)
            run%impulse(b)%a(i, 1, j, 1) = felt(felt_whole_impulse)
          end do
        end do
      end do
    end associate
  end subroutine enter

end module axisymmetric_run
