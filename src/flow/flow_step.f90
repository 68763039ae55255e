!> One time step of the flow: three stages of the strong-stability-preserving Runge-Kutta scheme of Shu and Osher.
!> The coupling may change velocities in the buffer that a stage wrote: the next stage starts from what it finds there.
module flow_step
  use brick_stage, only: advance_brick, prepare_scratch, stage_type, brick_report
  use flow_boundary, only: fill_boundary
  use flow_repair, only: repair_brick, count_repair
  use flow_state, only: flow_type, repair_negative_mass, repair_clipped_fraction, repair_relaxation
  use halo, only: halo_type, fill
  use kinds, only: wp
  use mesh, only: mesh_type
  implicit none
  private
  public :: advance_stage, accept_step, fill_ghosts

  real(wp), parameter :: part(3) = [1.0_wp, 0.25_wp, 2.0_wp/3.0_wp] !< new = start + part (from - start - d)
  real(wp), parameter, public :: stage_weight(3) = [1.0_wp/6.0_wp, 1.0_wp/6.0_wp, 2.0_wp/3.0_wp] !< of a stage's fluxes in the step

contains

  !> Stage 1, 2 or 3 of a step of length dt on all bricks of this rank.
  subroutine advance_stage(mesh, halo, flow, stage, dt)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: stage
    real(wp), intent(in) :: dt
    type(stage_type) :: plan
    integer :: b, from
    from = flow%current
    if (stage > 1) from = flow%target(stage - 1)
    call fill_ghosts(mesh, halo, flow, from)
    plan = stage_type(stage == 1, part(stage), stage_weight(stage), dt, mesh%spacing, mesh%active, flow%limiter, &
      flow%trace_fraction, flow%floor_pressure, flow%lowest_pressure(), flow%gravity)
    if (mesh%n_local > 0) call prepare_scratch(flow%scratch, flow%layout, mesh%brick_cells, size(flow%w(1, 1)%a, 1))
    do b = 1, mesh%n_local
      call advance_one(mesh, flow, plan, b, from, flow%current, flow%target(stage))
    end do
  end subroutine advance_stage

  !> The target of the third stage becomes the state.
  subroutine accept_step(flow)
    type(flow_type), intent(inout) :: flow
    flow%current = flow%target(3)
  end subroutine accept_step

  !> Ghost cells of one buffer, from neighbours and from the boundary conditions.
  subroutine fill_ghosts(mesh, halo, flow, buffer)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: buffer
    integer :: b
    call fill(mesh, halo, flow%w(:, buffer), flow%layout%n_rows, only_faces=.true.)
    do b = 1, mesh%n_local
      call fill_boundary(mesh, flow, b, buffer)
    end do
  end subroutine fill_ghosts

  subroutine advance_one(mesh, flow, plan, b, from, start, new)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(stage_type), intent(in) :: plan
    integer, intent(in) :: b, from, start, new
    type(brick_report) :: report
    logical :: at_face(6)
    integer :: ld
    ld = size(flow%w(b, 1)%a, 1)
    at_face(1::2) = mesh%brick(mesh%local(b))%at_low .and. mesh%active
    at_face(2::2) = mesh%brick(mesh%local(b))%at_high .and. mesh%active
    if (allocated(flow%open(b)%a)) then
      call advance_brick(mesh%brick_cells, mesh%ghost, ld, flow%layout, flow%eos, plan, flow%eps2, at_face, flow%w(b, from)%a, &
        flow%w(b, start)%a, flow%w(b, new)%a, flow%books(:, :, b), flow%scratch, report, flow%open(b)%a, flow%wall_impulse(b)%a)
    else
      call advance_brick(mesh%brick_cells, mesh%ghost, ld, flow%layout, flow%eos, plan, flow%eps2, at_face, flow%w(b, from)%a, &
        flow%w(b, start)%a, flow%w(b, new)%a, flow%books(:, :, b), flow%scratch, report)
    end if
    call count_repair(mesh, flow, repair_negative_mass, report%negative_masses, b, report%repaired)
    call count_repair(mesh, flow, repair_clipped_fraction, report%clipped_fractions, b, report%repaired)
    call count_repair(mesh, flow, repair_relaxation, report%fallbacks, b, report%repaired)
    if (report%bad > 0) call repair_brick(mesh, flow, b, new)
  end subroutine advance_one

end module flow_step
