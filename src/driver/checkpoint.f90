!> The whole state of a run to a restart file and back, bit for bit, on any number of ranks.
module checkpoint
  use blocks, only: share
  use errors, only: fatal
  use flow_state, only: flow_type
  use gauges, only: gauges_type, save_gauges, resume_gauges
  use immersed_boundary, only: restore_coupling
  use kinds, only: wp, i8
  use mesh, only: mesh_type
  use mpi_f08, only: MPI_Allreduce, MPI_INTEGER8, MPI_SUM
  use parallel, only: is_root, world
  use peak_maps, only: peak_maps_type, restore_unreached
  use restart_fields, only: restart_put_blocks, restart_get_blocks, restart_put_table, restart_get_table
  use restart_files, only: restart_file, create_restart, open_restart, close_restart, restart_has
  use restart_particles, only: restart_put_particles, restart_get_particles
  use restart_values, only: restart_put, restart_get, restart_count
  use rigid_bodies, only: pack_rigid, unpack_rigid
  use scene, only: scene_type
  use sleeping_bricks, only: is_asleep, share_state, wake
  use solid_step, only: project_solid
  use stage_changes, only: release_flow
  use stages, only: pack_stages, unpack_stages
  implicit none
  private
  public :: save_run, resume_run

contains

  !> Writes the next restart file of the folder. first: mass, momentum, energy of the first balance.
  subroutine save_run(scene, folder, gauges, peaks, first)
    type(scene_type), intent(inout) :: scene
    character(*), intent(in) :: folder
    type(gauges_type), intent(inout) :: gauges
    type(peak_maps_type), intent(in) :: peaks
    real(wp), intent(in) :: first(:)
    type(restart_file) :: file
    integer :: b
    integer(i8) :: repairs(size(scene%flow%repairs%count))
    call create_restart(file, folder, scene%mesh, scene%clock%time, scene%clock%step)
    call restart_put(file, 'flow_steps', scene%clock%n_flow_steps)
    call restart_put(file, 'solid_steps', scene%clock%n_solid_steps)
    call restart_put(file, 'first_balance', first)
    call restart_put(file, 'stages', pack_stages(scene%stages))
    associate (mesh => scene%mesh, one => [1, 1, 1])
      if (scene%has_flow) then
        if (scene%flow_runs()) call put_flow(file, mesh, scene%flow)
        call restart_put_table(file, 'flow_books', [(size(scene%flow%books(:, :, b)), b=1, mesh%n_local)], &
                               reshape(scene%flow%books, [size(scene%flow%books)]))
        call MPI_Allreduce(scene%flow%repairs%count, repairs, size(repairs), MPI_INTEGER8, MPI_SUM, world)
        call restart_put(file, 'flow_repairs', repairs)
      end if
      if (scene%has_solid) then
        call restart_put_particles(file, scene%solid%block)
        if (scene%solid%rigid_field > 0) call restart_put(file, 'rigid_bodies', pack_rigid(scene%solid%rigid))
        call restart_put_table(file, 'solid_books', [(size(scene%solid%books, 1), b=1, mesh%n_local)], &
                               reshape(scene%solid%books, [size(scene%solid%books)]))
      end if
      if (scene%coupled) then
        if (scene%flow_runs()) &
          call restart_put_blocks(file, 'cell_type', scene%coupling%kind, 1 - mesh%ghost, mesh%brick_cells + mesh%ghost)
        call restart_put(file, 'coupling_books', scene%coupling%books)
        if (scene%loads%active) call restart_put_table(file, 'loads', [(size(scene%loads%impulse(:, :, b)), b=1, mesh%n_local)], &
                                                       reshape(scene%loads%impulse, [size(scene%loads%impulse)]))
      end if
      if (allocated(peaks%map)) call restart_put_blocks(file, 'peaks', peaks%map(:mesh%n_local), one, mesh%brick_cells)
    end associate
    call save_gauges(gauges, file)
    call close_restart(file)
  end subroutine save_run

  !> Takes up a run: scene and peaks have been made as for a new run and are overwritten. gauges: defined, not placed.
  subroutine resume_run(scene, name, folder, gauges, peaks, first)
    type(scene_type), intent(inout) :: scene
    character(*), intent(in) :: name, folder
    type(gauges_type), intent(inout) :: gauges
    type(peak_maps_type), intent(inout) :: peaks
    real(wp), intent(out) :: first(:)
    type(restart_file) :: file
    integer, allocatable :: counts(:)
    real(wp), allocatable :: values(:)
    allocate (counts(scene%mesh%n_local))
    call open_restart(file, name, scene%mesh)
    scene%clock%time = file%time
    scene%flow%time = file%time
    scene%clock%step = file%step
    call restart_get(file, 'flow_steps', scene%clock%n_flow_steps)
    call restart_get(file, 'solid_steps', scene%clock%n_solid_steps)
    call restart_get(file, 'first_balance', first)
    allocate (values(restart_count(file, 'stages')))
    call restart_get(file, 'stages', values)
    call unpack_stages(values, scene%stages)
    deallocate (values)
    if (scene%stages%flow_over) call release_flow(scene)
    associate (mesh => scene%mesh, one => [1, 1, 1])
      if (scene%has_flow) then
        if (scene%flow_runs()) call get_flow(file, mesh, scene%flow)
        call restart_get_table(file, 'flow_books', counts, values)
        scene%flow%books = reshape(values, shape(scene%flow%books))
        call restart_get(file, 'flow_repairs', scene%flow%repairs%count)
        if (.not. is_root()) scene%flow%repairs%count = 0
      end if
      if (scene%has_solid) then
        call restart_get_particles(file, mesh, scene%solid%block)
        call restart_get_table(file, 'solid_books', counts, values)
        if (size(values) /= size(scene%solid%books)) call fatal('restart file "'//file%name// &
                                                                '" is of a run with other contacts than the deck has')
        scene%solid%books = reshape(values, shape(scene%solid%books))
        if (scene%solid%rigid_field > 0) then
          values = pack_rigid(scene%solid%rigid)
          call restart_get(file, 'rigid_bodies', values)
          call unpack_rigid(values, scene%solid%rigid)
        end if
        call project_solid(mesh, scene%halo, scene%solid)
      end if
      if (scene%coupled) then
        call restart_get(file, 'coupling_books', scene%coupling%books)
        if (scene%flow_runs()) then
          call restart_get_blocks(file, 'cell_type', scene%coupling%kind, 1 - mesh%ghost, mesh%brick_cells + mesh%ghost)
          call restore_coupling(mesh, scene%flow, scene%coupling)
        end if
        if (scene%loads%active) then
          call restart_get_table(file, 'loads', counts, values)
          scene%loads%impulse = reshape(values, shape(scene%loads%impulse))
        end if
      end if
      if (allocated(peaks%map)) then
        call restart_get_blocks(file, 'peaks', peaks%map(:mesh%n_local), one, mesh%brick_cells, one, mesh%brick_cells)
        call restore_unreached(peaks, mesh)
      end if
    end associate
    if (scene%has_solid) then
      call resume_gauges(gauges, scene%mesh, folder, file, scene%solid)
    else
      call resume_gauges(gauges, scene%mesh, folder, file)
    end if
    call close_restart(file)
  end subroutine resume_run

  !> Writes the flow: of bricks that sleep only their state.
  subroutine put_flow(file, mesh, flow)
    type(restart_file), intent(inout) :: file
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    real(wp), allocatable :: states(:)
    integer :: b, counts(mesh%n_local)
    call restart_put_blocks(file, 'flow', flow%w(:mesh%n_local, flow%current), [1, 1, 1], mesh%brick_cells)
    allocate (states(0))
    counts = 0
    do b = 1, mesh%n_local
      if (.not. is_asleep(flow, b)) cycle
      counts(b) = flow%layout%n_rows
      states = [states, flow%w(flow%holder(b), flow%current)%a(1, :, 1, 1)]
    end do
    call restart_put_table(file, 'flow_asleep', counts, states)
  end subroutine put_flow

  !> Reads the flow: bricks that slept when the file was written have only their state in it. In files from before there was sleep
  !> all are awake.
  subroutine get_flow(file, mesh, flow)
    type(restart_file), intent(inout) :: file
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    real(wp), allocatable :: states(:)
    integer :: b, buffer, before, counts(mesh%n_local)
    counts = 0
    if (restart_has(file, 'flow_asleep')) call restart_get_table(file, 'flow_asleep', counts, states)
    do b = 1, mesh%n_local
      if (counts(b) == 0) then
        call wake(flow, b)
      else
        do buffer = 1, 3
          call share(flow%w(:, buffer), b, 0) ! what the set-up has made is not wanted
        end do
      end if
    end do
    call restart_get_blocks(file, 'flow', flow%w(:mesh%n_local, flow%current), [1, 1, 1], mesh%brick_cells)
    before = 0
    do b = 1, mesh%n_local
      if (counts(b) > 0) call share_state(mesh, flow, b, states(before + 1:before + counts(b)))
      before = before + counts(b)
    end do
  end subroutine get_flow

end module checkpoint
