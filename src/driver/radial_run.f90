!> The blast of one charge on a fine mesh of its own, in one radial direction, whose mesh grows with the wave.
module radial_run
  use blast_run, only: blast_run_type, keep_gauges, note_energy, note_step, profile_of, run_until, start_run, table_of
  use blocks, only: block
  use charge_reach, only: ambient_region, cells_in_charge, charge_radius
  use deck_types, only: deck_type, region_group
  use kinds, only: wp
  use log, only: be_quiet
  use mesh, only: mesh_type
  use radial_profile, only: blast_type, radial_profile_type, felt_arrival
  implicit none
  private
  public :: run_radially, radial_deck, deck_of_charge

  integer, parameter :: brick = 128 !< cells
  integer, parameter :: first_radii = 4 !< charge radii that the mesh reaches over at first
  integer, parameter :: margin = 48 !< cells before the front that hold its foot

contains

  !> Runs charge c until its wave has reached `stop_radius` and all of it has burnt, or until `latest`, whichever comes first.
  !> To be called by all ranks, who share the work; the same bits on any number of them. Fatal (bad input) where neither comes
  !> before the end of the deck's run.
  function run_radially(deck, c, stop_radius, latest) result(profile)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(in) :: stop_radius, latest
    type(radial_profile_type) :: profile
    type(blast_run_type) :: run
    integer :: cells
    logical :: was_quiet, is_done
    call be_quiet(was=was_quiet)
    cells = brick*ceiling(real(first_radii*cells_in_charge(deck, c), wp)/brick)
    call start_run(run, radial_deck(deck, c, cells))
    call keep_gauges(run, deck, blast_type(center=deck%charge(c)%center))
    call note_step(run)
    do
      call run_until(run, c, stop_radius, latest, (cells - margin)*run%scene%mesh%spacing(1), is_done)
      if (is_done) exit
      cells = 2*cells
      call grow(run, radial_deck(deck, c, cells))
    end do
    profile = profile_of(run, margin)
    profile%finest = profile%thickness
    call be_quiet(silent=was_quiet)
  end function run_radially

  !> The deck of that run: the charge alone in still surroundings, on a mesh of so many cells along the radius.
  function radial_deck(deck, c, cells) result(alone)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c, cells
    type(deck_type) :: alone
    alone = deck_of_charge(deck, c)
    if (allocated(alone%detonator)) alone%detonator%position(1) = 0
    alone%mesh%geometry = deck%charge(c)%start
    alone%mesh%cells(1) = cells
    alone%mesh%upper(1) = cells*(charge_radius(deck, c)/cells_in_charge(deck, c))
    alone%mesh%brick(1) = brick
    alone%flow%sleep = .false. ! the mesh grows with the wave instead
  end function radial_deck

  !> A charge alone in still surroundings, with its centre at a radius of 0; the mesh is still to be given.
  function deck_of_charge(deck, c) result(alone)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(deck_type) :: alone
    type(deck_type) :: none
    type(region_group) :: ambient
    integer :: i
    alone = deck
    alone%mesh = none%mesh
    alone%mesh%upper = 1
    alone%boundary = none%boundary
    alone%stages = none%stages
    alone%boundary%x_low = 'symmetry'
    alone%boundary%inflow_material = deck%boundary%inflow_material ! one of the flow's materials
    alone%flow%gravity = 0
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
    end if
    alone%body = deck%body(:0)
    alone%gauge = deck%gauge(:0)
    alone%has_solid = .false.
  end function deck_of_charge

  !> The same run on a longer mesh; what is added is still.
  subroutine grow(run, deck)
    type(blast_run_type), intent(inout) :: run
    type(deck_type), intent(in) :: deck
    type(blast_run_type) :: longer
    type(radial_profile_type) :: profile
    associate (old => run%scene, new => longer%scene)
      profile = profile_of(run, margin)
      call start_run(longer, deck)
      call put_columns(new%mesh, table_of(old%mesh, old%flow%w(:, old%flow%current), old%flow%layout%n_rows), &
                       new%flow%w(:, new%flow%current))
      call put_columns(new%mesh, table_of(old%mesh, run%peaks%map, felt_arrival), longer%peaks%map)
      call put_columns(new%mesh, table_of(old%mesh, run%impulse, 2), longer%impulse)
      new%clock = old%clock
      new%flow%time = old%flow%time
      longer%afterburnt = profile%afterburnt
      longer%energy_error = profile%energy_error
      longer%gauge = run%gauge
      longer%n_seen_at = run%n_seen_at
      call move_alloc(run%seen, longer%seen)
      call move_alloc(run%seen_at, longer%seen_at)
    end associate
    call note_energy(longer)
    run = longer
  end subroutine grow

  !> Puts columns into the cells nearest to the centre; there are fewer of them than cells.
  subroutine put_columns(mesh, columns, field)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: columns(:, :, :)
    type(block), intent(inout) :: field(:)
    integer :: b, i, before
    do b = 1, mesh%n_local
      before = mesh%brick(mesh%local(b))%location(1)*mesh%brick_cells(1)
      do i = 1, min(mesh%brick_cells(1), size(columns, 2) - before)
        field(b)%a(i, 1:size(columns, 1), 1, 1) = columns(:, before + i, 1)
      end do
    end do
  end subroutine put_columns

end module radial_run
