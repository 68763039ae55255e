!> One Runge-Kutta stage of one brick in a single sweep over its rows of cells (x fastest): reconstruction, Riemann problems in the
!> active directions, and the update, with no more in memory than a plane of z fluxes.
module brick_stage
  use afterburn, only: release_afterburn
  use burn_release, only: release_energy
  use face_states, only: all_open, flatten_next_to_closed, replace_near_closed, take_cell_values
  use fifth_order_upwind, only: reconstruct_fifth_order, keep_below_one
  use flow_differences, only: difference_fluxes, difference_radial_fluxes, add_gravity
  use flow_layout, only: layout_type, book_afterburn, book_walls
  use flow_scheme, only: scheme_type, fifth_order, third_order
  use equation_of_state, only: eos_type
  use interface_sharpening, only: sharpen_faces
  use kinds, only: wp
  use muscl, only: reconstruct_muscl
  use riemann, only: hllc_single, hllc_materials, close_faces
  use shock_sensor, only: sense_shocks, dissipate_shear
  use strong_fans, only: set_fan_states
  use update_materials, only: update_row, row_scratch, row_report
  use update_single, only: update_gas, update_stored_energy
  use wall_faces, only: wall_flux
  implicit none
  private
  public :: advance_brick, prepare_scratch

  !> What a stage needs to know beside the state.
  type, public :: stage_type
    logical :: first = .true. !< the fluxes belong to the state at the start of the step
    real(wp) :: part = 1 !< new = start + part (from - start - d)
    real(wp) :: weight = 1 !< of this stage's fluxes in the whole step
    real(wp) :: dt = 0
    real(wp) :: time(3) = 0 !< of the states start, from and new
    real(wp) :: spacing(3) = 1
    logical :: active(3) = [.true., .false., .false.]
    logical :: radial = .false. !< x is a radius
    type(scheme_type) :: scheme
    logical :: fans = .false. !< faces in strong fans get the exact state
    real(wp) :: trace = 0 !< smallest volume fraction
    real(wp) :: floor_pressure = 0
    real(wp) :: lowest = 0 !< pressures at or below it are bad
    real(wp) :: gravity(3) = 0
    logical :: slip = .true. !< gas glides along walls that move
    real(wp), allocatable :: burn_energy(:) !< of each material, per mass; 0 where it does not burn
    real(wp), allocatable :: burn_rate(:) !< one over the time that a cell takes to burn
    real(wp), allocatable :: afterburn(:) !< energy per mass of each material that the whole step releases
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
    real(wp), allocatable :: narrow_low(:, :), narrow_high(:, :) !< face values of a narrower reconstruction
    real(wp), allocatable :: flux_x(:, :), flux_y(:, :, :), flux_z(:, :, :, :)
    real(wp), allocatable :: d(:, :) !< what the fluxes take from each cell in a whole step
    real(wp), allocatable :: wave(:, :), partial(:, :), fractions(:, :), force(:)
    real(wp), allocatable :: shock(:, :, :) !< sensor of the cells 0..n+1 of a row, in the rows of two planes
    real(wp), allocatable :: strongest(:, :) !< of each row
    real(wp), allocatable :: rate_low(:), rate_high(:) !< time step times area over volume at the faces across x
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
      s%fractions(ld, nm), s%force(ld), s%narrow_low(ld, nr), s%narrow_high(ld, nr), s%rate_low(ld), s%rate_high(ld), source=1.0_wp)
    allocate (s%shock(ld, 0:n(2) + 1, 0:1), s%strongest(0:n(2) + 1, 0:1), source=0.0_wp)
    allocate (s%row%m(ld, nm), s%row%a(ld, nm), s%row%e(ld, nm), s%row%a_from(ld, nm), s%row%e_from(ld, nm), &
      s%row%a_start(ld, nm), s%row%e_start(ld, nm), s%row%f(ld, nm), s%row%r_df(ld, nm), s%row%conserved(ld, 7), &
      s%row%relaxation(ld, 8), s%row%step(ld, nm), s%row%response(ld, nm), s%row%before(ld, nm), source=1.0_wp)
  end subroutine prepare_scratch

  subroutine clear_scratch(s)
    type(stage_scratch), intent(out) :: s
    s%ld = 0
  end subroutine clear_scratch

  !> Computes the new state of a brick. from: state that the fluxes belong to, ghosts filled; start: state at the start of the
  !> step; n: cells; g: ghost layers; ld: length of a row; eps2: of the limiter, steepest: alpha of the
  !> fifth-order bound, by variable; positive: variables that must be so on
  !> faces. booked(quantity, face): what enters the brick in the whole step through its faces (x low, x high, y low, ...) is added
  !> there, for faces with at_face, and what afterburn releases at book_afterburn. area, volume: of the faces across x and of the
  !> cells of a row.
  !> Optional, of bricks that have such cells: open: 1 where open, 0 where closed; impulse: the momentum that closed cells receive
  !> is added to the open cell beside them; troubled: 1 where all fluxes are to be of first order, 2 where that was not enough;
  !> arrival: time at which a detonation front passes; wall: velocity of walls that move and their normals for faces across x, y and
  !> z; their impulse is added to the closed cell.
  subroutine advance_brick(n, g, ld, layout, eos, stage, eps2, steepest, positive, at_face, area, volume, from, start, new, &
    booked, s, &
    report, &
      open, impulse, troubled, arrival, wall)
    integer, intent(in) :: n(3), g(3), ld
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    type(stage_type), intent(in) :: stage
    real(wp), intent(in), dimension(layout%n_reconstructed) :: eps2, steepest
    logical, intent(in) :: positive(layout%n_reconstructed)
    logical, intent(in) :: at_face(6)
    real(wp), intent(in) :: area(n(1) + 1), volume(n(1))
    real(wp), intent(in), dimension(1 - g(1):ld - g(1), layout%n_rows, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3)) :: from, start
    real(wp), intent(inout) :: new(1 - g(1):ld - g(1), layout%n_rows, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp), intent(inout) :: booked(:, :)
    type(stage_scratch), intent(inout) :: s
    type(brick_report), intent(out) :: report
    real(wp), intent(in), optional, dimension(1 - g(1):ld - g(1), 1, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3)) :: open, &
      troubled, &
      arrival
    real(wp), intent(in), optional :: wall(1 - g(1):ld - g(1), 12, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp), intent(inout), optional :: impulse(1 - g(1):ld - g(1), 3, 1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3))
    real(wp) :: rate(3), weight(3), over_h(3)
    integer :: j, k, cell_y, face_y, cell_z, face_z, c, x_cells, x_faces, stride(3), reach, back(3), last
    logical :: radial, cure
    logical :: row_open(1 - g(2):n(2) + g(2), 1 - g(3):n(3) + g(3)) !< no cell of the row, ghosts included, is closed
    c = layout%sound_speed_row
    ! along x whole vectors: the rows are padded
    x_cells = 4*((n(1) + 5)/4)
    x_faces = 4*((n(1) + 4)/4)
    stride = merge([1, ld*layout%n_rows, ld*layout%n_rows*(n(2) + 2*g(2))], 0, stage%active)
    reach = maxval(stride)
    back = merge(1, 0, stride == reach) ! the neighbour that lies furthest back in memory
    over_h = merge(1/stage%spacing, 0.0_wp, stage%active)
    rate = merge(stage%dt/stage%spacing, 0.0_wp, stage%active)
    last = maxval(merge([1, 2, 3], 0, stage%active))
    weight = stage%weight*stage%dt*product(stage%spacing)/stage%spacing
    radial = stage%radial
    s%rate_low(1:n(1)) = merge(stage%dt*area(1:n(1))/volume, rate(1), radial)
    s%rate_high(1:n(1)) = merge(stage%dt*area(2:n(1) + 1)/volume, rate(1), radial)
    cure = stage%scheme%cure_shocks .and. count(stage%active) > 1
    row_open = .true.
    if (present(open)) then
      do k = 1 - g(3), n(3) + g(3)
        do j = 1 - g(2), n(2) + g(2)
          row_open(j, k) = all_open(ld, 1, 1, open(1 - g(1), 1, j, k))
        end do
      end do
    end if
    if (cure) call sense_plane(1)
    ! two of each: which one is old changes from row to row and from plane to plane
    cell_z = 1
    face_z = 0
    if (stage%active(3)) then
      if (cure) call sense_plane(0)
      do j = 1, n(2)
        call reconstruct_z(j, 0, s%z_high(1, 1, j, 0))
        call reconstruct_z(j, 1, s%z_high(1, 1, j, 1))
        call flux_across(n(1), 3, j, 0, j, 1, 0, s%z_high(1, 1, j, 0), s%low, s%flux_z(1, 1, j, 0))
        call book(5, 1.0_wp, s%flux_z(:, :, j, 0))
      end do
    end if
    do k = 1, n(3)
      if (cure .and. stage%active(3)) then
        do j = 0, n(2) + 1, n(2) + 1
          if (k < n(3)) call sense_row(j, k + 1)
        end do
      end if
      cell_y = 1
      face_y = 0
      if (stage%active(2)) then
        call reconstruct_y(0, k, s%y_high(1, 1, 0))
        call reconstruct_y(1, k, s%y_high(1, 1, 1))
        call flux_across(n(1), 2, 0, k, 1, k, 0, s%y_high(1, 1, 0), s%low, s%flux_y(1, 1, 0))
        call book(3, 1.0_wp, s%flux_y(:, :, 0))
      end if
      do j = 1, n(2)
        if (stage%active(1)) then
          call reconstruct_x(j, k)
          call flux_across(x_faces, 1, j, k, j, k, 1, s%high, s%low(2, 1), s%flux_x)
          call book_ends(s%flux_x)
        end if
        if (stage%active(2)) then
          call reconstruct_y(j + 1, k, s%y_high(1, 1, 1 - cell_y))
          call flux_across(n(1), 2, j, k, j + 1, k, 0, s%y_high(1, 1, cell_y), s%low, s%flux_y(1, 1, 1 - face_y))
        end if
        if (stage%active(3)) then
          call reconstruct_z(j, k + 1, s%z_high(1, 1, j, 1 - cell_z))
          if (cure) call sense_row(j, k + 1)
          call flux_across(n(1), 3, j, k, j, k + 1, 0, s%z_high(1, 1, j, cell_z), s%low, s%flux_z(1, 1, j, 1 - face_z))
          if (k == n(3)) call book(6, -1.0_wp, s%flux_z(:, :, j, 1 - face_z))
        end if
        call take_differences(j, k)
        cell_y = 1 - cell_y
        face_y = 1 - face_y
        call update(j, k)
      end do
      if (stage%active(2)) call book(4, -1.0_wp, s%flux_y(:, :, face_y))
      cell_z = 1 - cell_z
      face_z = 1 - face_z
    end do

  contains

    !> Sensor of plane k; rows and planes of ghosts only as far as faces of the brick need them.
    subroutine sense_plane(k)
      integer, intent(in) :: k
      integer :: j, edge
      edge = merge(1, 0, k >= 1 .and. k <= n(3))
      do j = 1 - edge, n(2) + edge
        call sense_row(j, k)
      end do
    end subroutine sense_plane

    subroutine sense_row(j, k)
      integer, intent(in) :: j, k
      call sense_shocks(n(1) + 2, stride, reach, from(-back(1), layout%pressure_row, j - back(2), k - back(3)), &
        from(0, layout%density_row, j, k), from(0, c, j, k), s%shock(1, j, modulo(k, 2)), s%strongest(j, modulo(k, 2)))
    end subroutine sense_row

    !> Face values of the cells 0..n+1 of a row along it; cell i stands at i + 1.
    subroutine reconstruct_x(j, k)
      integer, intent(in) :: j, k
      call reconstruct(x_cells, 1, 0, j, k, s%low, s%high)
    end subroutine reconstruct_x

    subroutine reconstruct_y(j, k, high)
      integer, intent(in) :: j, k
      real(wp), intent(inout) :: high(ld, *)
      call reconstruct(whole(n(1)), 2, 1, j, k, s%low, high)
    end subroutine reconstruct_y

    subroutine reconstruct_z(j, k, high)
      integer, intent(in) :: j, k
      real(wp), intent(inout) :: high(ld, *)
      call reconstruct(whole(n(1)), 3, 1, j, k, s%low, high)
    end subroutine reconstruct_z

    !> A row in whole vectors: what lies behind its cells is ghosts and padding, whose face values nobody reads.
    pure integer function whole(n_cells)
      integer, intent(in) :: n_cells
      integer, parameter :: vector = 4
      whole = min(vector*((n_cells + vector - 1)/vector), ld - g(1))
    end function whole

    !> Face values in one direction of the row (j, k) from cell i on.
    subroutine reconstruct(n_cells, direction, i, j, k, low, high)
      integer, intent(in) :: n_cells, direction, i, j, k
      real(wp), intent(inout) :: low(ld, *), high(ld, *)
      integer :: one(3), v, nr, wide
      one = merge(1, 0, [1, 2, 3] == direction)
      nr = layout%n_reconstructed
      associate (s1 => stride(direction))
        if (stage%scheme%reconstruction == fifth_order) then
          call reconstruct_fifth_order(n_cells, ld, nr, s1, steepest, positive, from(i - 2*one(1), 1, j - 2*one(2), k - 2*one(3)), &
            low, high)
          v = layout%fraction(1)
          if (layout%n_materials == 2) call keep_below_one(n_cells, from(i, v, j, k), low(1, v), high(1, v))
        else
          call reconstruct_muscl(stage%scheme%limiter, n_cells, ld, nr, s1, eps2, from(i - one(1), 1, j - one(2), k - one(3)), &
            low, high)
        end if
        if (stage%scheme%sharpen .and. layout%n_materials > 1) call sharpen_faces(n_cells, ld, layout, stride, over_h, direction, &
          reach, from(i - back(1), 1, j - back(2), k - back(3)), low, high, s%partial, s%fractions, s%force)
        if (.not. present(open)) return
        wide = merge(2, 1, stage%scheme%reconstruction == fifth_order)
        if (all(row_open(j - wide*one(2):j + wide*one(2), k - wide*one(3):k + wide*one(3)))) return
        if (stage%scheme%reconstruction == fifth_order) then
          call reconstruct_muscl(third_order, n_cells, ld, nr, s1, eps2, from(i - one(1), 1, j - one(2), k - one(3)), &
            s%narrow_low, &
            s%narrow_high)
          call replace_near_closed(n_cells, ld, nr, open(i - 2*one(1), 1, j - 2*one(2), k - 2*one(3)), &
            open(i + 2*one(1), 1, j + 2*one(2), k + 2*one(3)), s%narrow_low, s%narrow_high, low, high)
        end if
        call flatten_next_to_closed(n_cells, ld, nr, from(i, 1, j, k), open(i - one(1), 1, j - one(2), k - one(3)), open(i, 1, &
          j, k), &
          open(i + one(1), 1, j + one(2), k + one(3)), low, high)
      end associate
    end subroutine reconstruct

    !> Fluxes from the row of cells (jl, kl) to the row (jr, kr); back: 1 where the left cells are the same row, one cell back.
    subroutine flux_across(n_faces, direction, jl, kl, jr, kr, back, left, right, flux)
      integer, intent(in) :: n_faces, direction, jl, kl, jr, kr, back
      real(wp), intent(inout) :: left(ld, *), right(ld, *)
      real(wp), intent(inout) :: flux(ld, *)
      integer, parameter :: turn(3, 3) = reshape([1, 2, 3, 2, 3, 1, 3, 1, 2], [3, 3])
      integer :: normal(3), first, p
      normal = layout%velocity_row - 1 + turn(:, direction)
      first = layout%momentum_flux - layout%velocity_row
      p = layout%pressure_row
      if (present(troubled)) call take_cell_values(n_faces, ld, layout%n_reconstructed, 0.0_wp, troubled(1 - back, 1, jl, kl), &
        troubled(1, 1, jr, kr), from(1 - back, 1, jl, kl), from(1, 1, jr, kr), left, right)
      if (present(open) .and. stage%fans) then
        call set_fan_states(n(1) + back, ld, layout, eos, normal(1), from(1 - back, c, jl, kl), from(1, c, jr, kr), left, right, &
          s%force, open(1 - back, 1, jl, kl), open(1, 1, jr, kr))
      else if (stage%fans) then
        call set_fan_states(n(1) + back, ld, layout, eos, normal(1), from(1 - back, c, jl, kl), from(1, c, jr, kr), left, right, &
          s%force)
      end if
      ! where that was not enough, without fans
      if (present(troubled)) call take_cell_values(n_faces, ld, layout%n_reconstructed, 1.0_wp, troubled(1 - back, 1, jl, kl), &
        troubled(1, 1, jr, kr), from(1 - back, 1, jl, kl), from(1, 1, jr, kr), left, right)
      if (layout%n_materials == 1) then
        call hllc_single(n_faces, ld, layout, eos(1), normal, left, from(1 - back, c, jl, kl), right, from(1, c, jr, kr), flux, &
          s%wave)
      else
        call hllc_materials(n_faces, ld, layout%n_materials, layout, eos, normal, left, from(1 - back, c, jl, kl), &
          right, from(1, c, jr, kr), flux, s%wave, s%partial, s%fractions)
      end if
      if (cure) then
        if (max(s%strongest(jl, modulo(kl, 2)), s%strongest(jr, modulo(kr, 2))) > 0) then
          if (layout%n_materials == 1) s%wave(:n_faces, 5) = flux(:n_faces, 1)
          call dissipate_shear(n_faces, ld, layout%density_row, normal(1), normal(2), normal(3), p, normal(2) + first, &
            normal(3) + first, layout%energy_flux, left, from(1 - back, c, jl, kl), s%shock(2 - back, jl, modulo(kl, 2)), &
            right, from(1, c, jr, kr), s%shock(2, jr, modulo(kr, 2)), s%wave(1, 5), flux)
        end if
      end if
      if (.not. present(open)) return
      if (row_open(jl, kl) .and. row_open(jr, kr)) return
      if (present(wall)) then
        call move_row(n_faces, direction, jl, kl, jr, kr, back, flux)
      else
        call close_row(n_faces, direction, jl, kl, jr, kr, back, flux)
      end if
    end subroutine flux_across

    !> Makes moving walls of the faces of closed cells, notes the momentum that these receive and what passes through.
    subroutine move_row(n_faces, direction, jl, kl, jr, kr, back, flux)
      integer, intent(in) :: n_faces, direction, jl, kl, jr, kr, back
      real(wp), intent(inout) :: flux(ld, *)
      integer :: i
      do i = 1, min(n_faces, n(1) + back) ! without the padding along x
        if (open(i - back, 1, jl, kl) > 0 .and. open(i, 1, jr, kr) > 0) cycle
        if (open(i - back, 1, jl, kl) > 0) then
          call move_face(direction, 1, [i - back, jl, kl], [i, jr, kr], flux(i, 1:layout%n_fluxes))
        else if (open(i, 1, jr, kr) > 0) then
          call move_face(direction, -1, [i, jr, kr], [i - back, jl, kl], flux(i, 1:layout%n_fluxes))
        else
          flux(i, 1:layout%n_fluxes) = 0
        end if
      end do
    end subroutine move_row

    !> side: 1 where the closed cell lies behind the open one.
    subroutine move_face(direction, side, cell, closed, flux)
      integer, intent(in) :: direction, side, cell(3), closed(3)
      real(wp), intent(out) :: flux(layout%n_fluxes)
      real(wp) :: pressure
      integer :: q
      associate (i => closed(1), j => closed(2), k => closed(3))
        call wall_flux(layout, eos, direction, side, from(cell(1), :, cell(2), cell(3)), wall(i, 1:3, j, k), &
          wall(cell(1), 1 + 3*direction:3 + 3*direction, cell(2), cell(3)), stage%slip, stage%lowest, flux, pressure)
        impulse(i, direction, j, k) = impulse(i, direction, j, k) + side*weight(direction)*pressure
      end associate
      if (any(cell < 1) .or. any(cell > n)) return
      do q = 1, layout%n_conserved
        booked(q, book_walls) = booked(q, book_walls) - side*weight(direction) &
          *(flux(q) - merge(pressure, 0.0_wp, q == layout%momentum_flux + direction - 1))
      end do
    end subroutine move_face

    !> Makes walls of the faces of closed cells, and notes the momentum that these receive.
    subroutine close_row(n_faces, direction, jl, kl, jr, kr, back, flux)
      integer, intent(in) :: n_faces, direction, jl, kl, jr, kr, back
      real(wp), intent(inout) :: flux(ld, *)
      integer :: p, i
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
    end subroutine close_row

    !> What fluxes, gravity, afterburn and the energy of burning explosive take from the cells of row (j, k).
    subroutine take_differences(j, k)
      integer, intent(in) :: j, k
      integer :: m, e, one_row(3)
      if (radial) then
        call difference_radial_fluxes(n(1), ld, layout%n_fluxes, last, layout%momentum_flux, s%rate_low, &
          s%rate_high, &
          rate, from(1, layout%pressure_row, j, k), s%flux_x, s%flux_y(1, 1, face_y), s%flux_y(1, 1, 1 - face_y), s%d)
      else
        call difference_fluxes(n(1), ld, layout%n_fluxes, last, rate, s%flux_x, s%flux_y(1, 1, face_y), &
          s%flux_y(1, 1, 1 - face_y), s%flux_z(1, 1, j, face_z), s%flux_z(1, 1, j, 1 - face_z), s%d)
      end if
      if (any(abs(stage%gravity) > 0)) call add_gravity(n(1), ld, layout, stage%dt, stage%gravity, from(1, 1, j, k), s%d)
      if (any(stage%afterburn > 0)) call release_after(j, k)
      if (.not. present(arrival)) return
      one_row = merge([1, ld, ld*(n(2) + 2*g(2))], 0, stage%active) ! arrival has but one
      do m = 1, layout%n_materials
        if (.not. stage%burn_energy(m) > 0) cycle
        e = layout%energy_flux
        if (layout%n_materials > 1) e = layout%first_material_energy_flux + m - 1
        call release_energy(n(1), stage%part, stage%time, stage%burn_energy(m), stage%burn_rate(m), one_row, maxval(one_row), &
          arrival(1 - back(1), 1, j - back(2), k - back(3)), from(1, m, j, k), start(1, m, j, k), s%d(1, m), s%rate_low, &
          s%rate_high, &
          rate, s%flux_x(1, m), s%flux_y(1, m, face_y), s%flux_y(1, m, 1 - face_y), s%flux_z(1, m, j, face_z), &
          s%flux_z(1, m, j, 1 - face_z), s%force)
        s%d(1:n(1), e) = s%d(1:n(1), e) - s%force(1:n(1))
        if (layout%n_materials > 1) s%d(1:n(1), layout%energy_flux) = s%d(1:n(1), layout%energy_flux) - s%force(1:n(1))
      end do
    end subroutine take_differences

    !> Releases the energy of afterburn in row (j, k) and books it.
    subroutine release_after(j, k)
      integer, intent(in) :: j, k
      integer :: m, e
      e = layout%energy_flux
      do m = 1, layout%n_materials
        if (.not. stage%afterburn(m) > 0) cycle
        if (layout%n_materials > 1) then
          call release_afterburn(n(1), stage%afterburn(m), from(1, m, j, k), s%d(1, e), s%force, &
            s%d(1, layout%first_material_energy_flux + m - 1))
        else
          call release_afterburn(n(1), stage%afterburn(m), from(1, m, j, k), s%d(1, e), s%force)
        end if
        if (present(open)) s%force(1:n(1)) = merge(s%force(1:n(1)), 0.0_wp, open(1:n(1), 1, j, k) > 0)
        booked(e, book_afterburn) = booked(e, book_afterburn) + stage%weight*sum(s%force(1:n(1))*volume)
      end do
    end subroutine release_after

    subroutine update(j, k)
      integer, intent(in) :: j, k
      type(row_report) :: row
      integer :: v
      if (present(wall) .and. .not. row_open(j, k)) then ! what passes walls is nothing to the cells behind
        do v = 1, layout%n_fluxes
          where (open(1:n(1), 1, j, k) <= 0) s%d(1:n(1), v) = 0
        end do
      end if
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
      if (.not. row_open(j, k)) then
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
      real(wp) :: sum_of_fluxes
      if (.not. at_face(face)) return
      do q = 1, layout%n_conserved
        if (radial) then
          sum_of_fluxes = sum(flux(1:n(1), q)*volume)/product(stage%spacing)
        else
          sum_of_fluxes = sum(flux(1:n(1), q))
        end if
        booked(q, face) = booked(q, face) + sign*weight((face + 1)/2)*sum_of_fluxes
      end do
    end subroutine book

    subroutine book_ends(flux)
      real(wp), intent(in) :: flux(:, :)
      integer :: q
      real(wp) :: low, high
      low = merge(stage%weight*stage%dt*area(1), weight(1), radial)
      high = merge(stage%weight*stage%dt*area(n(1) + 1), weight(1), radial)
      do q = 1, layout%n_conserved
        if (at_face(1)) booked(q, 1) = booked(q, 1) + low*flux(1, q)
        if (at_face(2)) booked(q, 2) = booked(q, 2) - high*flux(n(1) + 1, q)
      end do
    end subroutine book_ends

  end subroutine advance_brick

end module brick_stage
