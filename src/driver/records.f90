!> What a run writes while it goes: gauges, history, snapshots, peak maps, restart files, report lines; and when it is to stop.
module records
  use balance, only: balance_type, take_balance
  use blast_memory, only: remember_blasts, write_history
  use body_loads, only: sum_loads
  use checkpoint, only: save_run, resume_run
  use csv_series, only: series, close_series, flush_series
  use deck, only: write_deck
  use errors, only: fatal, exit_done, exit_stopped, exit_failed
  use file_system, only: make_directory
  use fragment_files, only: write_fragments
  use fragments, only: find_fragments, fragment_list
  use gauges, only: gauges_type, define_gauges, place_gauges, open_gauges, sample_gauges, close_gauges
  use history, only: open_history, put_history
  use kinds, only: wp, i8
  use load_files, only: open_loads, put_loads, put_load_map
  use log, only: say
  use mpi_f08, only: MPI_Allreduce, MPI_INTEGER8, MPI_SUM
  use options, only: options_type
  use parallel, only: is_root, barrier, world
  use peak_maps, only: peak_maps_type, start_peaks, update_peaks
  use report, only: report_figures, report_pace, start_pace, report_line, peak_memory
  use restart_files, only: newest_restart, forget_restarts
  use scene, only: scene_type
  use sleeping_bricks, only: awake_share
  use snapshot_header, only: snapshot_clock
  use snapshots, only: snapshots_type, start_snapshots, put_flow_snapshot, put_solid_snapshot, put_peak_snapshot, &
    step_text
  use solid_state, only: material_names
  use stopping, only: stop_reason, wall_seconds, go_on, reason_name
  use summary, only: write_summary, summary_figures
  use text, only: str
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: open_records, record_step, stop_if_asked, close_records

  !> Everything that is being written, and the times at which the next of it is due.
  type, public :: records_type
    character(:), allocatable :: folder
    type(unit_labels_type) :: labels
    type(gauges_type) :: gauges
    type(series) :: history, loads
    type(snapshots_type) :: snapshots
    type(peak_maps_type) :: peaks
    type(fragment_list) :: fragments !< of the last snapshot
    type(report_pace) :: pace
    real(wp) :: next_snapshot = huge(1.0_wp) !< time that a step must end at
    real(wp) :: next_restart = huge(1.0_wp)
    integer :: last_snapshot_step = -1, last_restart_step = -1
    real(wp) :: first(5) = 0 !< mass, momentum, energy of the first balance
    integer :: first_step = 0 !< step at which this run began
    integer :: last_step = huge(1) !< step at which this run ends
    integer :: first_flow_steps = 0, first_solid_steps = 0 !< counts at which this run began
    real(wp) :: restart_seconds = 1, step_seconds = 0 !< wall time of the longest restart file and step so far
    real(wp) :: wall_at_step = 0
    integer :: reason = go_on
    logical :: reached_end = .false. !< the end time or the last step of the deck, or nothing is left to compute
    logical :: nothing_left = .false.
  end type records_type

contains

  !> Makes the output folder and starts all that is written there, anew or from a restart file.
  subroutine open_records(scene, options, records)
    type(scene_type), intent(inout) :: scene
    type(options_type), intent(in) :: options
    type(records_type), intent(out) :: records
    character(:), allocatable :: restart
    type(balance_type) :: balance
    integer :: g
    real(wp) :: position(3, size(scene%deck%gauge))
    associate (deck => scene%deck)
      records%folder = trim(deck%output%directory)
      records%labels = unit_labels(trim(deck%run%units))
      do g = 1, size(deck%gauge)
        position(:, g) = deck%gauge(g)%position
      end do
      call define_gauges(records%gauges, scene%mesh, deck%gauge%name, deck%gauge%kind, position, deck%output%gauge_interval, &
                         deck%flow%ambient_pressure, records%labels)
      if (scene%has_flow .and. deck%output%peak_maps) call start_peaks(records%peaks, scene%mesh, deck%flow%ambient_pressure, &
                                                                      0.01_wp*abs(deck%flow%ambient_pressure))
      if (options%restart) then
        restart = options%restart_file
        if (len(restart) == 0) restart = newest_restart(records%folder)
        call resume_run(scene, restart, records%folder, records%gauges, records%peaks, records%first)
        call say('going on from '//restart)
        call open_history(records%history, records%folder//'/history.csv', scene, records%labels, scene%clock%time)
        if (scene%loads%active) call open_loads(records%loads, records%folder//'/loads.csv', scene%solid%body_name( &
          :scene%solid%n_bodies), scene%mesh%active, records%labels, scene%clock%time)
        call start_snapshots(records%snapshots, records%folder, trim(deck%run%title), records%labels, scene%clock%time)
      else
        call make_directory(records%folder)
        call forget_restarts(records%folder)
        if (is_root()) call write_deck(deck, records%folder//'/deck.nml')
        if (scene%has_solid) then
          call place_gauges(records%gauges, scene%mesh, scene%solid)
        else
          call place_gauges(records%gauges, scene%mesh)
        end if
        call open_gauges(records%gauges, records%folder)
        if (allocated(scene%blast)) then
          call write_history(scene%mesh, scene%blast, records%gauges)
          call remember_blasts(scene%mesh, scene%blast, records%peaks, records%gauges)
        end if
        call open_history(records%history, records%folder//'/history.csv', scene, records%labels)
        if (scene%loads%active) then
          call open_loads(records%loads, records%folder//'/loads.csv', scene%solid%body_name(:scene%solid%n_bodies), &
                          scene%mesh%active, records%labels)
          call put_loads(records%loads, scene%clock%time, scene%mesh%active, sum_loads(scene%loads, scene%mesh, scene%solid))
        end if
        call start_snapshots(records%snapshots, records%folder, trim(deck%run%title), records%labels)
        balance = take_balance(scene)
        records%first = [balance%mass, balance%momentum, balance%energy]
        call put_history(records%history, scene, balance)
        call measure(scene, records, 0.0_wp)
        call put_snapshot(scene, records)
      end if
      records%first_step = scene%clock%step
      records%last_step = deck%run%max_steps
      if (options%steps < huge(1)) records%last_step = min(records%last_step, scene%clock%step + options%steps)
      records%first_flow_steps = scene%clock%n_flow_steps
      records%first_solid_steps = scene%clock%n_solid_steps
    end associate
    call schedule(scene, records)
    call start_pace(records%pace, 0.0_wp, scene%clock%time, scene%clock%step)
    call say('output: '//records%folder)
    records%wall_at_step = wall_seconds()
  end subroutine open_records

  !> Writes what is due after a step.
  subroutine record_step(scene, records)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    type(balance_type) :: balance
    logical :: report_due, history_due
    call scene%watch%start('output')
    call measure(scene, records, scene%clock%dt)
    associate (clock => scene%clock, deck => scene%deck)
      report_due = mod(clock%step, deck%run%report_interval) == 0
      history_due = mod(clock%step, deck%output%history_interval) == 0
      if (report_due .or. history_due) then
        balance = take_balance(scene)
        if (history_due) call put_history(records%history, scene, balance)
        if (history_due .and. scene%loads%active) call put_loads(records%loads, clock%time, scene%mesh%active, &
                                                                 sum_loads(scene%loads, scene%mesh, scene%solid))
        if (report_due) call report_progress(scene, records, balance)
      end if
      if (clock%time >= records%next_snapshot) then
        call put_snapshot(scene, records)
        call schedule(scene, records)
      end if
      if (clock%time >= records%next_restart) call put_restart(scene, records)
    end associate
    call scene%watch%stop('output')
    records%step_seconds = max(records%step_seconds, wall_seconds() - records%wall_at_step)
    records%wall_at_step = wall_seconds()
  end subroutine record_step

  !> finished: the run is over; status: exit status, that of a stop before the end if there is a reason for one.
  subroutine stop_if_asked(scene, records, finished, status)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    logical, intent(out) :: finished
    integer, intent(out) :: status
    integer, parameter :: steps_between_looks = 10
    status = exit_done
    finished = scene%clock%time >= scene%clock%end_time .or. scene%clock%step >= records%last_step
    records%nothing_left = .not. (scene%flow_runs() .or. scene%has_solid .and. .not. scene%stages%solid_over)
    finished = finished .or. records%nothing_left
    if (finished) then
      records%reached_end = records%nothing_left .or. &
        scene%clock%time >= scene%deck%run%end_time .or. scene%clock%step >= scene%deck%run%max_steps
      return
    end if
    records%reason = stop_reason(scene%deck%run%wall_limit, 2*records%restart_seconds + 3*records%step_seconds, records%folder, &
                                 mod(scene%clock%step, steps_between_looks) == 0)
    finished = records%reason /= go_on
    if (finished) status = exit_stopped
  end subroutine stop_if_asked

  !> Writes the last of everything and the summary.
  subroutine close_records(scene, records, status)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    integer, intent(in) :: status
    type(balance_type) :: balance
    type(summary_figures) :: figures
    call scene%watch%start('output')
    if (.not. records%reached_end) call put_restart(scene, records)
    if (status == exit_done) call put_snapshot(scene, records)
    if (allocated(records%peaks%map)) call put_peak_snapshot(records%snapshots, scene%mesh, scene%clock%time, scene%clock%step, &
                                                             records%peaks)
    balance = take_balance(scene)
    call report_progress(scene, records, balance)
    call close_gauges(records%gauges)
    call close_series(records%history)
    if (scene%loads%active) call close_series(records%loads)
    call scene%watch%stop('output')
    figures%status = status
    figures%steps = scene%clock%step - records%first_step
    figures%flow_steps = scene%clock%n_flow_steps - records%first_flow_steps
    figures%solid_steps = scene%clock%n_solid_steps - records%first_solid_steps
    figures%wall = wall_seconds()
    figures%drift = drifts(records, balance)
    figures%repairs = all_repairs(scene)
    figures%memory = peak_memory()
    figures%ended_by = 'end time'
    if (records%nothing_left) figures%ended_by = 'rest'
    if (records%reason /= go_on) figures%ended_by = trim(reason_name(records%reason))
    if (records%reason == go_on .and. .not. records%reached_end) figures%ended_by = 'option'
    call write_summary(scene, balance, figures, records%fragments, records%folder//'/summary.json')
    if (scene%flow%burn_total > 0) call say('detonation: '//str(scene%flow%burn_total - balance%unburnt)//' of '// &
      str(scene%flow%burn_total)//' '//trim(records%labels%energy)//' released')
    if (records%reason /= go_on) call say('stopped by '//trim(reason_name(records%reason))//' after writing a restart file')
    call say('results are in '//records%folder)
  end subroutine close_records

  !> Gauges and peak maps take in the present state. dt: of the step that led to it.
  subroutine measure(scene, records, dt)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    real(wp), intent(in) :: dt
    associate (flow => scene%flow, time => scene%clock%time)
      if (scene%flow_runs() .and. scene%has_solid) then
        call sample_gauges(records%gauges, scene%mesh, time, dt, flow%w(:, flow%current), flow%open, flow%layout, &
                           scene%solid)
      else if (scene%flow_runs()) then
        call sample_gauges(records%gauges, scene%mesh, time, dt, flow%w(:, flow%current), flow%open, flow%layout)
      else
        call sample_gauges(records%gauges, scene%mesh, time, dt, solid=scene%solid)
      end if
      if (allocated(records%peaks%map) .and. scene%flow_runs()) call update_peaks(records%peaks, scene%mesh, &
        flow%w(:, flow%current), flow%open, flow%layout%pressure(), time, dt)
    end associate
  end subroutine measure

  subroutine put_snapshot(scene, records)
    type(scene_type), intent(in) :: scene
    type(records_type), intent(inout) :: records
    if (records%last_snapshot_step == scene%clock%step) return
    records%last_snapshot_step = scene%clock%step
    associate (flow => scene%flow, solid => scene%solid, clock => scene%clock)
      if (scene%flow_runs() .and. scene%deck%output%flow_snapshots) then
        if (scene%coupled) then
          call put_flow_snapshot(records%snapshots, scene%mesh, clock%time, clock%step, flow%w(:, flow%current), flow%layout, &
                                 flow%name, scene%coupling%kind)
        else
          call put_flow_snapshot(records%snapshots, scene%mesh, clock%time, clock%step, flow%w(:, flow%current), flow%layout, &
                                 flow%name)
        end if
      end if
      if (scene%has_solid .and. scene%deck%output%fragments) then
        call put_fragments(scene, records)
      else if (scene%has_solid .and. scene%deck%output%solid_snapshots) then
        call put_solid_snapshot(records%snapshots, scene%mesh, clock%time, clock%step, solid)
      end if
      if (scene%loads%active) call put_load_map(records%folder//'/loads_'//step_text(clock%step)//'.vtkhdf', &
        snapshot_clock(trim(scene%deck%run%title), records%labels%length, records%labels%time, clock%time, clock%step), &
        scene%mesh, solid, records%labels)
    end associate
  end subroutine put_snapshot

  !> Counts the fragments, writes their table, and the particles with the fragment that each belongs to.
  subroutine put_fragments(scene, records)
    type(scene_type), intent(in) :: scene
    type(records_type), intent(inout) :: records
    integer, allocatable :: label(:)
    associate (output => scene%deck%output, solid => scene%solid, clock => scene%clock)
      call find_fragments(scene%mesh, solid, output%fragment_reach, output%fragment_damage, records%fragments, label)
      call write_fragments(records%folder//'/fragments_'//step_text(clock%step)//'.csv', records%fragments%fragment, &
                           material_names(solid), solid%body_name, records%labels)
      if (output%solid_snapshots) call put_solid_snapshot(records%snapshots, scene%mesh, clock%time, clock%step, solid, label)
    end associate
  end subroutine put_fragments

  subroutine put_restart(scene, records)
    type(scene_type), intent(inout) :: scene
    type(records_type), intent(inout) :: records
    real(wp) :: began
    if (records%last_restart_step == scene%clock%step) return
    records%last_restart_step = scene%clock%step
    began = wall_seconds()
    call flush_series(records%history)
    if (scene%loads%active) call flush_series(records%loads)
    call save_run(scene, records%folder, records%gauges, records%peaks, records%first)
    records%restart_seconds = max(records%restart_seconds, wall_seconds() - began)
    call schedule(scene, records)
  end subroutine put_restart

  !> Sets the times of the next snapshot and restart file from the present time alone, so that a restart changes nothing.
  subroutine schedule(scene, records)
    type(scene_type), intent(in) :: scene
    type(records_type), intent(inout) :: records
    real(wp) :: soon
    associate (time => scene%clock%time, output => scene%deck%output)
      soon = time + 1e-9_wp*scene%clock%end_time
      records%next_snapshot = scene%clock%end_time
      if (output%snapshot_interval > 0) records%next_snapshot = min(records%next_snapshot, next_multiple(output%snapshot_interval))
      records%next_snapshot = min(records%next_snapshot, minval(output%snapshot_times, output%snapshot_times > soon))
      records%next_restart = huge(1.0_wp)
      if (output%restart_interval > 0) records%next_restart = next_multiple(output%restart_interval)
    end associate

  contains

    real(wp) function next_multiple(interval)
      real(wp), intent(in) :: interval
      next_multiple = interval*(floor(soon/interval) + 1)
    end function next_multiple

  end subroutine schedule

  !> Prints the line of progress; ends the run if its state is not finite.
  subroutine report_progress(scene, records, balance)
    type(scene_type), intent(in) :: scene
    type(records_type), intent(inout) :: records
    type(balance_type), intent(in) :: balance
    type(report_figures) :: figures
    real(wp) :: drift(3)
    drift = drifts(records, balance)
    figures%step = scene%clock%step
    figures%time = scene%clock%time
    figures%end_time = scene%clock%end_time
    figures%max_steps = records%last_step
    figures%dt = scene%clock%dt
    figures%time_unit = trim(records%labels%time)
    figures%limiter = ''
    if (allocated(scene%clock%limiter)) figures%limiter = scene%clock%limiter
    figures%mass_drift = drift(1)
    figures%momentum_drift = drift(2)
    figures%energy_drift = drift(3)
    figures%repairs = sum(all_repairs(scene))
    figures%memory = peak_memory()
    figures%cells = 0
    if (scene%flow_runs()) figures%cells = product(real(scene%mesh%cells, wp))*max(scene%clock%flow_steps, 1)
    if (scene%solid_runs()) figures%cells = figures%cells + sum(balance%solid%count)*scene%clock%solid_steps
    if (scene%flow_runs()) figures%awake = awake_share(scene%flow)
    figures%wall = wall_seconds()
    call say(report_line(figures, records%pace))
    if (.not. abs(balance%energy) <= huge(1.0_wp)) call fatal('the energy of the scene is not finite at step '// &
                                                              'of the report above', exit_failed)
  end subroutine report_progress

  !> Relative drifts of mass, momentum and energy since the start of the scene.
  pure function drifts(records, balance) result(drift)
    type(records_type), intent(in) :: records
    type(balance_type), intent(in) :: balance
    real(wp) :: drift(3)
    drift(1) = (balance%mass - records%first(1))/max(abs(records%first(1)), tiny(1.0_wp))
    drift(2) = sum(abs(balance%momentum - records%first(2:4)))/max(balance%momentum_scale, tiny(1.0_wp))
    drift(3) = (balance%energy - records%first(5))/max(abs(records%first(5)), tiny(1.0_wp))
  end function drifts

  !> Repairs of all ranks, by kind.
  function all_repairs(scene) result(total)
    type(scene_type), intent(in) :: scene
    integer(i8) :: total(size(scene%flow%repairs%count))
    call MPI_Allreduce(scene%flow%repairs%count, total, size(total), MPI_INTEGER8, MPI_SUM, world)
  end function all_repairs

end module records
