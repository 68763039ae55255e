!> Small scenes of flow alone, without a deck.
module flow_scenes
  use equation_of_state, only: eos_type
  use flow_scheme, only: scheme_type, ghost_layers, muscl, venkatakrishnan
  use flow_state, only: flow_type, allocate_flow, face_periodic
  use flow_step, only: advance_stage, accept_step
  use flow_time_step, only: flow_limit, flow_limit_type
  use halo, only: halo_type, plan_halo
  use kinds, only: wp
  use mesh, only: mesh_type, build_mesh
  use mixture, only: cell_from
  implicit none
  private
  public :: make_scene, run_until, run_steps, run_step, row_of_cells, value_at

  type, public :: flow_scene
    type(mesh_type) :: mesh
    type(halo_type) :: halo
    type(flow_type) :: flow
    real(wp) :: time = 0
    integer :: steps = 0
  end type flow_scene

  abstract interface
    !> Phase densities, fractions, velocity and pressure at a point.
    subroutine start_state(x, r, a, u, p)
      import :: wp
      real(wp), intent(in) :: x(3)
      real(wp), intent(out) :: r(:), a(:), u(3), p
    end subroutine start_state
  end interface

contains

  !> A scene on the given cells and bricks (0: one brick) with all faces alike (see flow_state), or each as faces says (low and high
  !> face of each direction; periodic ones in pairs). What enters at inflow faces is to be set after. scheme: if not the paper's;
  !> radial_power: of module geometry, if not Cartesian.
  subroutine make_scene(scene, eos, cells, lower, upper, brick, face, start, faces, scheme, radial_power)
    type(flow_scene), intent(out) :: scene
    type(eos_type), intent(in) :: eos(:)
    integer, intent(in) :: cells(3), brick(3), face
    real(wp), intent(in) :: lower(3), upper(3)
    procedure(start_state) :: start
    integer, intent(in), optional :: faces(2, 3)
    type(scheme_type), intent(in), optional :: scheme
    integer, intent(in), optional :: radial_power
    type(scheme_type) :: chosen
    real(wp) :: r(size(eos)), a(size(eos)), u(3), p, x(3)
    integer :: b, i, j, k, each(2, 3)
    each = face
    if (present(faces)) each = faces
    chosen = scheme_type(muscl, venkatakrishnan, .false., .false.)
    if (present(scheme)) chosen = scheme
    call build_mesh(scene%mesh, cells, lower, upper, merge(brick, cells, brick > 0), each(1, :) == face_periodic, &
      ghost_layers(chosen))
    if (present(radial_power)) scene%mesh%radial_power = radial_power
    call plan_halo(scene%mesh, scene%halo)
    scene%flow%scheme = chosen
    call allocate_flow(scene%flow, scene%mesh, spread('gas', 1, size(eos)), eos)
    scene%flow%face = each
    associate (n => scene%mesh%brick_cells)
      do b = 1, scene%mesh%n_local
        do k = 1, n(3)
          do j = 1, n(2)
            do i = 1, n(1)
              x = scene%mesh%brick(scene%mesh%local(b))%origin + ([i, j, k] - 0.5_wp)*scene%mesh%spacing
              call start(x, r, a, u, p)
              scene%flow%w(b, 1)%a(i, :, j, k) = cell_from(scene%flow%layout, eos, r, a, u, p)
            end do
          end do
        end do
      end do
    end associate
  end subroutine make_scene

  !> Runs to a time with the scene's Courant number.
  subroutine run_until(scene, end_time)
    type(flow_scene), intent(inout) :: scene
    real(wp), intent(in) :: end_time
    type(flow_limit_type) :: limit
    real(wp) :: dt
    do while (scene%time < end_time*(1 - 1e-12_wp))
      limit = flow_limit(scene%mesh, scene%flow)
      dt = min(limit%dt, end_time - scene%time)
      call run_step(scene, dt)
    end do
  end subroutine run_until

  !> Runs a number of steps.
  subroutine run_steps(scene, n)
    type(flow_scene), intent(inout) :: scene
    integer, intent(in) :: n
    type(flow_limit_type) :: limit
    integer :: i
    do i = 1, n
      limit = flow_limit(scene%mesh, scene%flow)
      call run_step(scene, limit%dt)
    end do
  end subroutine run_steps

  !> One step of a given length.
  subroutine run_step(scene, dt)
    type(flow_scene), intent(inout) :: scene
    real(wp), intent(in) :: dt
    integer :: stage
    scene%flow%time = scene%time
    do stage = 1, 3
      call advance_stage(scene%mesh, scene%halo, scene%flow, stage, dt)
    end do
    call accept_step(scene%flow)
    scene%time = scene%time + dt
    scene%steps = scene%steps + 1
  end subroutine run_step

  !> One variable along direction d through the first cells of the other directions, on one rank.
  function row_of_cells(scene, d, row) result(values)
    type(flow_scene), intent(in) :: scene
    integer, intent(in) :: d, row
    real(wp) :: values(scene%mesh%cells(d))
    integer :: i, at(3)
    do i = 1, scene%mesh%cells(d)
      at = 1
      at(d) = i
      values(i) = value_at(scene, row, at)
    end do
  end function row_of_cells

  !> One variable in a cell of the domain, on one rank.
  real(wp) function value_at(scene, row, cell)
    type(flow_scene), intent(in) :: scene
    integer, intent(in) :: row, cell(3)
    integer :: b, location(3), c(3)
    location = (cell - 1)/scene%mesh%brick_cells
    c = cell - location*scene%mesh%brick_cells
    value_at = -huge(1.0_wp)
    do b = 1, scene%mesh%n_local
      if (any(scene%mesh%brick(scene%mesh%local(b))%location /= location)) cycle
      value_at = scene%flow%w(scene%flow%holder(b), scene%flow%current)%a(c(1), row, c(2), c(3))
    end do
  end function value_at

end module flow_scenes
