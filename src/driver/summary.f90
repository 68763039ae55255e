!> summary.json: what ran, how fast, how well it kept its books, what was repaired, how it ended.
module summary
  use balance, only: balance_type
  use constants, only: unset
  use checksum, only: mix_reals, mix_integer, hexadecimal, empty_checksum
  use flow_state, only: repair_names
  use fragments, only: fragment_list
  use json_files, only: json_file, open_json, close_json, json_begin, json_end, json_put
  use kinds, only: wp, i8
  use parallel, only: n_ranks
  use reductions, only: reduce_sum
  use scene, only: scene_type
  use sleeping_bricks, only: awake_share
  use version, only: version_string
  implicit none
  private
  public :: write_summary

  !> What the run knows of itself at its end. Counts are of this run, not of those before a restart.
  type, public :: summary_figures
    integer :: status = 0
    character(:), allocatable :: ended_by
    integer :: steps = 0, flow_steps = 0, solid_steps = 0
    real(wp) :: wall = 0 !< seconds
    real(wp) :: drift(3) = 0 !< mass, momentum, energy
    integer(i8), allocatable :: repairs(:)
    integer(i8) :: memory = 0 !< peak, all ranks, bytes
  end type summary_figures

contains

  !> Writes the file; to be called by all ranks.
  subroutine write_summary(scene, balance, figures, fragments, name)
    type(scene_type), intent(in) :: scene
    type(balance_type), intent(in) :: balance
    type(summary_figures), intent(in) :: figures
    type(fragment_list), intent(in) :: fragments !< of the last snapshot
    character(*), intent(in) :: name
    type(json_file) :: file
    character(32), allocatable :: phases(:)
    real(wp) :: cells, particles, awake
    character(16) :: fingerprint
    integer :: i
    fingerprint = state_checksum(scene)
    cells = product(real(scene%mesh%cells, wp))
    awake = awake_share(scene%flow)
    particles = 0
    if (scene%has_solid) particles = sum(balance%solid%count)
    call open_json(file, name)
    call json_put(file, 'program', 'brisance')
    call json_put(file, 'version', version_string)
    call json_put(file, 'deck', trim(scene%deck%file))
    call json_put(file, 'title', trim(scene%deck%run%title))
    call json_put(file, 'units', trim(scene%deck%run%units))
    call json_put(file, 'exit_status', figures%status)
    call json_put(file, 'ended_by', figures%ended_by)
    call json_put(file, 'ranks', n_ranks)
    call json_put(file, 'cells', scene%mesh%cells)
    call json_put(file, 'brick_cells', scene%mesh%brick_cells)
    call json_put(file, 'bricks', size(scene%mesh%brick))
    call json_put(file, 'particles', nint(particles, i8))
    call json_put(file, 'step', scene%clock%step)
    call json_put(file, 'time', scene%clock%time)
    call json_put(file, 'steps_of_this_run', figures%steps)
    call json_put(file, 'flow_steps_of_this_run', figures%flow_steps)
    call json_put(file, 'solid_steps_of_this_run', figures%solid_steps)
    call json_put(file, 'wall_seconds', figures%wall)
    call json_begin(file, 'wall_seconds_by_phase')
    allocate (phases(0))
    phases = scene%watch%list()
    do i = 1, size(phases)
      call json_put(file, trim(phases(i)), scene%watch%seconds(trim(phases(i))))
    end do
    call json_end(file)
    if (scene%has_flow .and. figures%flow_steps > 0) call json_put(file, 'ns_per_cell_and_stage', &
      1e9_wp*n_ranks*scene%watch%seconds('flow')/max(cells*awake*3*figures%flow_steps, 1.0_wp))
    if (scene%has_flow) call json_put(file, 'mean_share_of_bricks_awake', awake)
    if (particles > 0 .and. figures%solid_steps > 0) call json_put(file, 'ns_per_particle_and_step', &
      1e9_wp*n_ranks*scene%watch%seconds('solid')/(particles*figures%solid_steps))
    call json_put(file, 'peak_memory_bytes', figures%memory)
    if (scene%has_flow) call json_put(file, 'peak_memory_bytes_per_cell', figures%memory/cells)
    call json_begin(file, 'drift')
    call json_put(file, 'mass', figures%drift(1))
    call json_put(file, 'momentum', figures%drift(2))
    call json_put(file, 'energy', figures%drift(3))
    call json_end(file)
    if (scene%flow%burn_total > 0) then
      call json_begin(file, 'detonation')
      call json_put(file, 'energy_of_charges', scene%flow%burn_total)
      call json_put(file, 'energy_released', scene%flow%burn_total - balance%unburnt)
      call json_end(file)
    end if
    if (scene%has_flow) then
      if (any(scene%flow%afterburn%energy > 0)) then
        call json_begin(file, 'afterburn')
        call json_put(file, 'energy_released', balance%flow%afterburnt)
        call json_end(file)
      end if
    end if
    if (scene%coupled .or. scene%stages%solid_over) then
      call json_begin(file, 'stages')
      if (scene%stages%solid_started > unset) call json_put(file, 'solid_started', scene%stages%solid_started)
      if (scene%stages%flow_over) call json_put(file, 'flow_ended', scene%stages%flow_ended)
      if (scene%stages%solid_over) call json_put(file, 'solid_ended', scene%stages%solid_ended)
      call json_end(file)
    end if
    if (scene%coupled) then
      call json_begin(file, 'coupling')
      call json_put(file, 'impulse_on_solid', balance%exchanged)
      call json_put(file, 'work_on_solid', balance%work_on_solid)
      call json_put(file, 'energy_taken_from_flow', balance%taken_from_flow)
      call json_put(file, 'mass_uncovered', balance%uncovered_mass)
      call json_put(file, 'energy_uncovered', balance%uncovered_energy)
      call json_end(file)
    end if
    if (scene%has_solid .and. scene%deck%output%fragments .and. allocated(fragments%fragment)) then
      call json_begin(file, 'fragments')
      call json_put(file, 'count', size(fragments%fragment))
      call json_put(file, 'mass', sum(fragments%fragment%mass))
      if (size(fragments%fragment) > 0) call json_put(file, 'largest_mass', fragments%fragment(1)%mass)
      call json_put(file, 'of_one_particle', count(fragments%fragment%particles == 1))
      call json_put(file, 'loose_particles', fragments%loose)
      call json_put(file, 'loose_mass', fragments%loose_mass)
      call json_end(file)
    end if
    if (scene%has_flow) then
      call json_begin(file, 'repairs')
      do i = 1, size(figures%repairs)
        call json_put(file, trim(repair_names(i)), figures%repairs(i))
      end do
      call json_end(file)
    end if
    call json_put(file, 'state_checksum', fingerprint)
    call close_json(file)
  end subroutine write_summary

  !> Fingerprint of the state, bit for bit, the same on any number of ranks: a sum over bricks of fingerprints that know their brick.
  function state_checksum(scene) result(digits)
    type(scene_type), intent(in) :: scene
    character(16) :: digits
    integer(i8) :: mixed, low, high
    real(wp) :: partial(2, scene%mesh%n_local), total(2)
    integer :: b, h, set, j, k, v, column
    integer(i8), parameter :: mask = 4294967295_i8
    do b = 1, scene%mesh%n_local
      mixed = mix_integer(empty_checksum, int(scene%mesh%local(b), i8))
      associate (n => scene%mesh%brick_cells)
        if (scene%flow_runs()) then
          h = scene%flow%holder(b)
          do k = 1, n(3)
            do j = 1, n(2)
              do v = 1, scene%flow%layout%n_rows
                mixed = mix_reals(mixed, scene%flow%w(h, scene%flow%current)%a(1:n(1), v, j, k))
              end do
            end do
          end do
        end if
      end associate
      if (scene%has_solid) then
        do set = 1, scene%solid%n_sets
          associate (block => scene%solid%block(set, b))
            do column = 1, size(block%f, 2)
              mixed = mix_reals(mixed, block%f(:block%n, column))
            end do
          end associate
        end do
      end if
      partial(1, b) = real(iand(mixed, mask), wp)
      partial(2, b) = real(iand(ishft(mixed, -32), mask), wp)
    end do
    call reduce_sum(scene%mesh, partial, total)
    low = int(total(1), i8)
    high = int(total(2), i8)
    digits = hexadecimal(ior(iand(low, mask), ishft(iand(high, mask), 32)))
  end function state_checksum

end module summary
