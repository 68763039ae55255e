!> One Runge-Kutta stage of one brick in a single sweep over its rows of cells (x fastest): reconstruction, Riemann problems in the
!> active directions, and the update, with no more in memory than a plane of z fluxes.
module brick_stage
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use reconstruction, only: reconstruct_venkatakrishnan, reconstruct_minmod, flatten_next_to_closed, minmod
  use riemann, only: hllc_single, hllc_materials, close_faces
  use update_materials, only: update_row, row_scratch, row_report
  use update_single, only: update_gas, update_stored_energy
  implicit none
  private
  public :: advance_brick, prepare_scratch

  !> What a stage needs to know beside the state.
  type, public :: stage_type
    logical :: first = .true. !< the fluxes belong to the state at the start of the step
    real(wp) :: part = 1 !< new = start + part (from - start - d)
    real(wp) :: weight = 1 !< of this stage's fluxes in the whole step
    real(wp) :: dt = 0
    real(wp) :: spacing(3) = 1
    logical :: active(3) = [.true., .false., .false.]
    integer :: limiter = 1
    real(wp) :: trace = 0 !< smallest volume fraction
    real(wp) :: floor_pressure = 0
    real(wp) :: lowest = 0 !< pressures at or below it are bad
    real(wp) :: gravity(3) = 0
  end type stage_type

  !> What a brick reports of a stage.
  type, public :: brick_report
    integer :: negative_masses = 0, clipped_fractions = 0, fallbacks = 0
    integer :: repaired(3) = 0 !< last cell of the above
    integer :: bad = 0 !< cells whose pressure or sound speed is no positive number
  end type brick_report

  !> Work space, the same for all bricks of a size; (along the row, variable, ...).
  type, public :: stage_scratch
    integer :: ld = 0
    real(wp), allocatable :: low(:, :), high(:, :) !< face values of a row of cells
    real(wp), allocatable :: y_high(:, :, :), z_high(:, :, :, :) !< upper face values kept for the next row and plane
    real(wp), allocatable :: flux_x(:, :), flux_y(:, :, :), flux_z(:, :, :, :)
    real(wp), allocatable :: d(:, :) !< what the fluxes take from each cell in a whole step
    real(wp), allocatable :: wave(:, :), partial(:, :), fractions(:, :), force(:)
    type(row_scratch) :: row
  end type stage_scratch

contains

  !> Allocates the work space for bricks of n cells with rows of length ld.
  subroutine prepare_scratch(s, layout, n, ld)
    type(stage_scratch), intent(inout) :: s
    type(layout_type), intent(in) :: layout
    integer, intent(in) :: n(3), ld
    integer :: nm, nr, nf
    if (s%ld == ld .and. allocated(s%z_high)) then
      if (size(s%z_high, 3) == n(2)) return
    end if
    call clear_scratch(s)
    s%ld = ld
    nm = layout%n_materials
    nr = layout%n_reconstructed
    nf = layout%n_fluxes
    ! ones, so that what lies beyond the cells of a row never traps
    allocate (s%low(ld, nr), s%high(ld, nr), s%y_high(ld, nr, 0:1), s%z_high(ld, nr, n(2), 0:1), s%flux_x(ld, nf), &
      s%flux_y(ld, nf, 0:1), s%flux_z(ld, nf, n(2), 0:1), s%d(ld, nf), s%wave(ld, 7), s%partial(ld, nm), &
      s%fractions(ld, nm), s%force(ld), source=1.0_wp)
    allocate (s%row%m(ld, nm), s%row%a(ld, nm), s%row%e(ld, nm), s%row%a_from(ld, nm), s%row%e_from(ld, nm), &
      s%row%a_start(ld, nm), s%row%e_start(ld, nm), s%row%f(ld, nm), s%row%r_df(ld, nm), s%row%conserved(ld, 7), &
      s%row%relaxation(ld, 8), s%row%step(ld, nm), s%row%response(ld, nm), s%row%before(ld, nm), source=1.0_wp)
  end subroutine prepare_scratch

  subroutine clear_scratch(s)
    type(stage_scratch), intent(out) :: s
    s%ld = 0
  end subroutine clear_scratch

  !> Computes the new state of a brick. from: state that the fluxes belong to, ghosts filled; start: state at the start of the
  !> step; n: cells; g: ghost layers; ld: length of a row; eps2: of the limiter, by variable. booked(quantity, face): what
  !> enters the brick in the whole step
  !> through its faces (x low, x high, y low, ...) is added there, for faces with at_face. open, impulse: only of bricks with closed
  !> cells: 1 where open; the momentum that closed cells receive is added to the open cell beside them.
  subroutine advance_brick(n, g, ld, layout, eos, stage, eps2, at_face, from, start, new, booked, s, report, open, impulse)
    integer, intent(in) :: n(3), g(3), ld
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    type(stage_type), intent(in) :: stage
    real(wp), intent(in) :: eps2(layout%n_reconstructed)
    logical, intent(in) :: at_face(6)
    real(wp), intent(in), dimension(1 - g(1):ld - g(1), layout%n_rows, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3)) :: from, start
    real(wp), intent(inout) :: new(1 - g(1):ld - g(1), layout%n_rows, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp), intent(inout) :: booked(:, :)
    type(stage_scratch), intent(inout) :: s
    type(brick_report), intent(out) :: report
    real(wp), intent(in), optional :: open(1 - g(1):ld - g(1), 1, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp), intent(inout), optional :: impulse(1 - g(1):ld - g(1), 3, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp) :: rate(3), weight(3)
    integer :: j, k, cell_y, face_y, cell_z, face_z, c, x_cells, x_faces
    c = layout%sound_speed_row
    ! along x whole vectors: the rows are padded
    x_cells = 4*((n(1) + 5)/4)
    x_faces = 4*((n(1) + 4)/4)
    rate = stage%dt/stage%spacing
    weight = stage%weight*stage%dt*product(stage%spacing)/stage%spacing
    ! two of each: which one is old changes from row to row and from plane to plane
    cell_z = 1
    face_z = 0
    if (stage%active(3)) then
      do j = 1, n(2)
        call reconstruct_z(j, 0, s%z_high(1, 1, j, 0))
        call reconstruct_z(j, 1, s%z_high(1, 1, j, 1))
        call flux_across(n(1), 3, j, 0, j, 1, 0, s%z_high(1, 1, j, 0), s%low, s%flux_z(1, 1, j, 0))
        call book(5, 1.0_wp, s%flux_z(:, :, j, 0))
      end do
    end if
    do k = 1, n(3)
      cell_y = 1
      face_y = 0
      if (stage%active(2)) then
        call reconstruct_y(0, k, s%y_high(1, 1, 0))
        call reconstruct_y(1, k, s%y_high(1, 1, 1))
        call flux_across(n(1), 2, 0, k, 1, k, 0, s%y_high(1, 1, 0), s%low, s%flux_y(1, 1, 0))
        call book(3, 1.0_wp, s%flux_y(:, :, 0))
      end if
      do j = 1, n(2)
        call reconstruct_x(j, k)
        call flux_across(x_faces, 1, j, k, j, k, 1, s%high, s%low(2, 1), s%flux_x)
        call book_ends(s%flux_x)
        if (stage%active(2)) then
          call reconstruct_y(j + 1, k, s%y_high(1, 1, 1 - cell_y))
          call flux_across(n(1), 2, j, k, j + 1, k, 0, s%y_high(1, 1, cell_y), s%low, s%flux_y(1, 1, 1 - face_y))
        end if
        if (stage%active(3)) then
          call reconstruct_z(j, k + 1, s%z_high(1, 1, j, 1 - cell_z))
          call flux_across(n(1), 3, j, k, j, k + 1, 0, s%z_high(1, 1, j, cell_z), s%low, s%flux_z(1, 1, j, 1 - face_z))
          if (k == n(3)) call book(6, -1.0_wp, s%flux_z(:, :, j, 1 - face_z))
        end if
        call differences(n(1), ld, layout%n_fluxes, count(stage%active), rate, s%flux_x, s%flux_y(1, 1, face_y), &
          s%flux_y(1, 1, 1 - face_y), s%flux_z(1, 1, j, face_z), s%flux_z(1, 1, j, 1 - face_z), s%d)
        cell_y = 1 - cell_y
        face_y = 1 - face_y
        if (any(abs(stage%gravity) > 0)) call add_gravity(n(1), ld, layout, stage%dt, stage%gravity, from(1, 1, j, k), s%d)
        call update(j, k)
      end do
      if (stage%active(2)) call book(4, -1.0_wp, s%flux_y(:, :, face_y))
      cell_z = 1 - cell_z
      face_z = 1 - face_z
    end do

  contains

    !> Face values of the cells 0..n+1 of a row along it; cell i stands at i + 1.
    subroutine reconstruct_x(j, k)
      integer, intent(in) :: j, k
      call reconstruct(x_cells, from(-1, 1, j, k), from(0, 1, j, k), from(1, 1, j, k), s%low, s%high)
      if (present(open)) call flatten_next_to_closed(x_cells, ld, layout%n_reconstructed, from(0, 1, j, k), &
        open(-1, 1, j, k), open(0, 1, j, k), open(1, 1, j, k), s%low, s%high)
    end subroutine reconstruct_x

    subroutine reconstruct_y(j, k, high)
      integer, intent(in) :: j, k
      real(wp), intent(inout) :: high(ld, *)
      call reconstruct(whole(n(1)), from(1, 1, j - 1, k), from(1, 1, j, k), from(1, 1, j + 1, k), s%low, high)
      if (present(open)) call flatten_next_to_closed(n(1), ld, layout%n_reconstructed, from(1, 1, j, k), &
        open(1, 1, j - 1, k), open(1, 1, j, k), open(1, 1, j + 1, k), s%low, high)
    end subroutine reconstruct_y

    subroutine reconstruct_z(j, k, high)
      integer, intent(in) :: j, k
      real(wp), intent(inout) :: high(ld, *)
      call reconstruct(whole(n(1)), from(1, 1, j, k - 1), from(1, 1, j, k), from(1, 1, j, k + 1), s%low, high)
      if (present(open)) call flatten_next_to_closed(n(1), ld, layout%n_reconstructed, from(1, 1, j, k), &
        open(1, 1, j, k - 1), open(1, 1, j, k), open(1, 1, j, k + 1), s%low, high)
    end subroutine reconstruct_z

    !> A row in whole vectors: what lies behind its cells is ghosts and padding, whose face values nobody reads.
    pure integer function whole(n_cells)
      integer, intent(in) :: n_cells
      integer, parameter :: vector = 4
      whole = min(vector*((n_cells + vector - 1)/vector), ld - 2*g(1) - 1)
    end function whole

    subroutine reconstruct(n_cells, below, here, above, low, high)
      integer, intent(in) :: n_cells
      real(wp), intent(in) :: below(ld, *), here(ld, *), above(ld, *)
      real(wp), intent(inout) :: low(ld, *), high(ld, *)
      if (stage%limiter == minmod) then
        call reconstruct_minmod(n_cells, ld, layout%n_reconstructed, below, here, above, low, high)
      else
        call reconstruct_venkatakrishnan(n_cells, ld, layout%n_reconstructed, eps2, below, here, above, low, high)
      end if
    end subroutine reconstruct

    !> Fluxes from the row of cells (jl, kl) to the row (jr, kr); back: 1 where the left cells are the same row, one cell back.
    subroutine flux_across(n_faces, direction, jl, kl, jr, kr, back, left, right, flux)
      integer, intent(in) :: n_faces, direction, jl, kl, jr, kr, back
      real(wp), intent(in) :: left(ld, *), right(ld, *)
      real(wp), intent(inout) :: flux(ld, *)
      integer, parameter :: turn(3, 3) = reshape([1, 2, 3, 2, 3, 1, 3, 1, 2], [3, 3])
      integer :: normal(3), p, i
      normal = layout%velocity_row - 1 + turn(:, direction)
      if (layout%n_materials == 1) then
        call hllc_single(n_faces, ld, layout, eos(1), normal, left, from(1 - back, c, jl, kl), right, from(1, c, jr, kr), flux, &
          s%wave)
      else
        call hllc_materials(n_faces, ld, layout%n_materials, layout, eos, normal, left, from(1 - back, c, jl, kl), &
          right, from(1, c, jr, kr), flux, s%wave, s%partial, s%fractions)
      end if
      if (.not. present(open)) return
      p = layout%pressure_row
      call close_faces(n_faces, ld, layout%n_fluxes, layout%momentum_flux + direction - 1, open(1 - back, 1, jl, kl), &
        from(1 - back, p, jl, kl), open(1, 1, jr, kr), from(1, p, jr, kr), flux, s%force)
      do i = 1, n_faces
        if (open(i - back, 1, jl, kl) > 0) then
          impulse(i - back, direction, jl, kl) = impulse(i - back, direction, jl, kl) + weight(direction)*s%force(i)
        else
          impulse(i, direction, jr, kr) = impulse(i, direction, jr, kr) + weight(direction)*s%force(i)
        end if
      end do
    end subroutine flux_across

    subroutine update(j, k)
      integer, intent(in) :: j, k
      type(row_report) :: row
      integer :: v
      if (layout%n_materials > 1) then
        call update_row(n(1), ld, layout, eos, stage%first, stage%part, stage%trace, stage%floor_pressure, stage%lowest, s%d, &
          from(1, 1, j, k), start(1, 1, j, k), new(1, 1, j, k), s%row, row)
      else if (eos(1)%is_gas) then
        call update_gas(n(1), ld, eos(1), stage%part, stage%lowest, s%d, from(1, 1, j, k), start(1, 1, j, k), &
          new(1, 1, j, k), row%bad)
      else
        call update_stored_energy(n(1), ld, eos(1), stage%part, stage%lowest, s%d, from(1, 1, j, k), start(1, 1, j, k), &
          new(1, 1, j, k), row%bad, s%row%relaxation)
      end if
      if (present(open)) then
        do v = 1, layout%n_rows
          where (open(1:n(1), 1, j, k) <= 0) new(1:n(1), v, j, k) = from(1:n(1), v, j, k)
        end do
      end if
      report%negative_masses = report%negative_masses + row%negative_masses
      report%clipped_fractions = report%clipped_fractions + row%clipped_fractions
      report%fallbacks = report%fallbacks + row%fallbacks
      report%bad = report%bad + row%bad
      if (row%negative_masses + row%clipped_fractions + row%fallbacks > 0) report%repaired = [row%cell, j, k]
    end subroutine update

    !> Adds the fluxes of a row of faces of the brick's surface to the books.
    subroutine book(face, sign, flux)
      integer, intent(in) :: face
      real(wp), intent(in) :: sign, flux(:, :)
      integer :: q
      if (.not. at_face(face)) return
      do q = 1, layout%n_conserved
        booked(q, face) = booked(q, face) + sign*weight((face + 1)/2)*sum(flux(1:n(1), q))
      end do
    end subroutine book

    subroutine book_ends(flux)
      real(wp), intent(in) :: flux(:, :)
      integer :: q
      do q = 1, layout%n_conserved
        if (at_face(1)) booked(q, 1) = booked(q, 1) + weight(1)*flux(1, q)
        if (at_face(2)) booked(q, 2) = booked(q, 2) - weight(1)*flux(n(1) + 1, q)
      end do
    end subroutine book_ends

  end subroutine advance_brick

  !> What the fluxes of the active directions take from a row of cells in a whole step.
  pure subroutine differences(n, ld, n_fluxes, dimensions, rate, x, y_low, y_high, z_low, z_high, d)
    integer, intent(in) :: n, ld, n_fluxes, dimensions
    real(wp), intent(in) :: rate(3)
    real(wp), intent(in), dimension(ld, n_fluxes) :: x, y_low, y_high, z_low, z_high
    real(wp), intent(inout) :: d(ld, n_fluxes)
    integer :: i, v
    do v = 1, n_fluxes
      select case (dimensions)
      case (1)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v))
        end do
      case (2)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v)) + rate(2)*(y_high(i, v) - y_low(i, v))
        end do
      case (3)
        !$omp simd
        do i = 1, n
          d(i, v) = rate(1)*(x(i + 1, v) - x(i, v)) + rate(2)*(y_high(i, v) - y_low(i, v)) &
            + rate(3)*(z_high(i, v) - z_low(i, v))
        end do
      end select
    end do
  end subroutine differences

  !> Momentum and work of gravity.
  pure subroutine add_gravity(n, ld, layout, dt, gravity, from, d)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: dt, gravity(3), from(ld, *)
    real(wp), intent(inout) :: d(ld, *)
    integer :: i, q, r, u, m, e
    r = layout%density_row; u = layout%velocity_row - 1; m = layout%momentum_flux - 1; e = layout%energy_flux
    do q = 1, 3
      do i = 1, n
        d(i, m + q) = d(i, m + q) - dt*gravity(q)*from(i, r)
        d(i, e) = d(i, e) - dt*gravity(q)*from(i, r)*from(i, u + q)
      end do
    end do
  end subroutine add_gravity

end module brick_stage
