!> Histories at points, as gauges.csv: fixed points in the flow, and points on the solid that move with their particle.
!> Impulses are integrated over every step (trapezoidal rule), whatever the interval between rows.
module gauges
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
  use blocks, only: block
  use csv_series, only: series, close_series, flush_series, open_series, put_row
  use errors, only: exit_bad_input, fatal, warn
  use flow_layout, only: layout_type
  use flow_probes, only: flow_probes_type, place_flow_probes, read_flow_probes
  use kinds, only: wp
  use mesh, only: mesh_type
  use parallel, only: is_root
  use restart_files, only: restart_file
  use restart_values, only: restart_get, restart_put
  use solid_gauges, only: nearest_particle, read_gauges, solid_gauge
  use solid_state, only: solid_type
  use text, only: append
  use units, only: unit_labels_type
  implicit none
  private
  public :: gauges_type, define_gauges, place_gauges, open_gauges, resume_gauges, save_gauges, sample_gauges
  public :: flush_gauges, close_gauges

  integer, parameter :: name_length = 64, column_length = 128

  !> All gauges of a scene.
  type :: gauges_type
    integer :: n = 0
    character(name_length), allocatable :: name(:)
    logical, allocatable :: in_flow(:) !< else on the solid
    real(wp), allocatable :: position(:, :) !< (3, gauge) as asked for
    type(flow_probes_type) :: flow
    type(solid_gauge), allocatable :: followed(:) !< particle of each solid gauge
    real(wp), allocatable :: start(:, :) !< (3, solid gauge) where the particle was at the start
    real(wp) :: ambient = 0 !< pressure from which overpressure is counted
    real(wp) :: interval = 0 !< time between rows, 0: each step
    real(wp) :: next = -huge(1.0_wp) !< time of the next row
    real(wp), allocatable :: impulse(:) !< of each flow gauge, so far
    real(wp), allocatable :: overpressure(:) !< of each flow gauge, at the last sample
    character(column_length), allocatable :: column(:) !< headings
    type(series) :: table
  end type gauges_type

contains

  !> What is to be measured. kind: 'flow' or 'solid'; interval: time between rows, 0 for every step.
  subroutine define_gauges(gauges, mesh, name, kind, position, interval, ambient, labels)
    type(gauges_type), intent(out) :: gauges
    type(mesh_type), intent(in) :: mesh
    character(*), intent(in) :: name(:), kind(:)
    real(wp), intent(in) :: position(:, :), interval, ambient
    type(unit_labels_type), intent(in) :: labels
    integer :: g
    gauges%n = size(name)
    allocate (gauges%name(gauges%n), gauges%in_flow(gauges%n), gauges%column(1))
    gauges%name(:) = name
    gauges%in_flow(:) = kind == 'flow'
    gauges%position = position
    gauges%interval = interval
    gauges%ambient = ambient
    gauges%column(1) = 'time ['//trim(labels%time)//']'
    do g = 1, gauges%n
      if (gauges%in_flow(g)) then
        call add_column('pressure', labels%pressure)
        call add_column('overpressure', labels%pressure)
        call add_column('impulse', labels%impulse)
        call add_column('density', labels%density)
        call add_vector('velocity', labels%velocity)
      else
        call add_vector('displacement', labels%length)
        call add_vector('velocity', labels%velocity)
        call add_column('solid_pressure', labels%pressure)
      end if
    end do
    allocate (gauges%followed(count(.not. gauges%in_flow)), gauges%start(3, count(.not. gauges%in_flow)))
    gauges%start = 0
    allocate (gauges%impulse(count(gauges%in_flow)), gauges%overpressure(count(gauges%in_flow)))
    gauges%impulse = 0
    gauges%overpressure = 0

  contains

    subroutine add_column(quantity, unit)
      character(*), intent(in) :: quantity, unit
      call append(gauges%column, trim(gauges%name(g))//'.'//quantity//' ['//trim(unit)//']')
    end subroutine add_column

    subroutine add_vector(quantity, unit)
      character(*), intent(in) :: quantity, unit
      character(1), parameter :: axis(3) = ['x', 'y', 'z']
      integer :: d
      do d = 1, 3
        if (mesh%active(d)) call add_column(quantity//'_'//axis(d), unit)
      end do
    end subroutine add_vector

  end subroutine define_gauges

  !> Finds the cells and particles of the gauges in the state at the start. solid: absent where the scene has none.
  subroutine place_gauges(gauges, mesh, solid)
    type(gauges_type), intent(inout) :: gauges
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in), optional :: solid
    integer :: g, s, in_flow(count(gauges%in_flow)), on_solid(count(.not. gauges%in_flow))
    in_flow = pack([(g, g=1, gauges%n)], gauges%in_flow)
    on_solid = pack([(g, g=1, gauges%n)], .not. gauges%in_flow)
    call place_flow_probes(gauges%flow, mesh, gauges%position(:, in_flow))
    if (size(on_solid) == 0) return
    if (present(solid)) then
      do s = 1, size(on_solid)
        gauges%followed(s) = nearest_particle(mesh, solid, gauges%position(:, on_solid(s)))
      end do
      call read_gauges(mesh, solid, gauges%followed)
      do s = 1, size(on_solid)
        gauges%start(:, s) = gauges%followed(s)%value(1:3)
      end do
    end if
    if (any(gauges%followed%id == 0)) call fatal('gauge "'//trim(gauges%name(on_solid(1)))// &
      '" is to follow a solid, but there are no particles', exit_bad_input)
  end subroutine place_gauges

  !> Starts the table in this folder; nothing is written for a scene without gauges.
  subroutine open_gauges(gauges, folder)
    type(gauges_type), intent(inout) :: gauges
    character(*), intent(in) :: folder
    if (gauges%n > 0) call open_series(gauges%table, folder//'/gauges.csv', gauges%column)
  end subroutine open_gauges

  !> Takes up the gauges from a restart file and cuts the table back to its time, in place of place_gauges and open_gauges.
  !> solid: as for place_gauges; it serves gauges that the run did not have when the file was written, which start now.
  subroutine resume_gauges(gauges, mesh, folder, file, solid)
    type(gauges_type), intent(inout) :: gauges
    type(mesh_type), intent(in) :: mesh
    character(*), intent(in) :: folder
    type(restart_file), intent(inout) :: file
    type(solid_type), intent(in), optional :: solid
    character(:), allocatable :: names
    integer :: lost(size(gauges%followed))
    if (gauges%n == 0) return
    call place_gauges(gauges, mesh, solid)
    call restart_get(file, 'gauge_names', names)
    if (names == names_of(gauges)) then
      call restart_get(file, 'gauge_next', gauges%next)
      if (size(gauges%impulse) > 0) then
        call restart_get(file, 'gauge_impulse', gauges%impulse)
        call restart_get(file, 'gauge_overpressure', gauges%overpressure)
      end if
      if (size(lost) > 0) then
        gauges%followed = solid_gauge()
        call restart_get(file, 'gauge_particle_id', gauges%followed%id)
        call restart_get(file, 'gauge_particle_set', gauges%followed%set)
        call restart_get(file, 'gauge_particle_lost', lost)
        call restart_get(file, 'gauge_particle_start', gauges%start)
        gauges%followed%lost = lost == 1
      end if
    else if (is_root()) then
      call warn('the gauges have changed since the restart file was written: impulses and displacements count from the restart on')
    end if
    call open_series(gauges%table, folder//'/gauges.csv', gauges%column, file%time)
  end subroutine resume_gauges

  !> Writes to a restart file what resume_gauges reads, and sends the rows so far to the disk.
  subroutine save_gauges(gauges, file)
    type(gauges_type), intent(inout) :: gauges
    type(restart_file), intent(inout) :: file
    call restart_put(file, 'gauge_names', names_of(gauges))
    call restart_put(file, 'gauge_next', gauges%next)
    if (size(gauges%impulse) > 0) then
      call restart_put(file, 'gauge_impulse', gauges%impulse)
      call restart_put(file, 'gauge_overpressure', gauges%overpressure)
    end if
    if (size(gauges%followed) > 0) then
      call restart_put(file, 'gauge_particle_id', gauges%followed%id)
      call restart_put(file, 'gauge_particle_set', gauges%followed%set)
      call restart_put(file, 'gauge_particle_lost', merge(1, 0, gauges%followed%lost))
      call restart_put(file, 'gauge_particle_start', gauges%start)
    end if
    call flush_gauges(gauges)
  end subroutine save_gauges

  !> Measures, once with dt = 0 before the first step and then after each step of size dt, and writes a row if one is due.
  !> state, open, layout: of the flow; each absent where the scene has none. A gauge shows no numbers once its particle has left the
  !> domain, or once the flow is over.
  subroutine sample_gauges(gauges, mesh, time, dt, state, open, layout, solid)
    type(gauges_type), intent(inout) :: gauges
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: time, dt
    type(block), intent(in), optional :: state(:), open(:)
    type(layout_type), intent(in), optional :: layout
    type(solid_type), intent(in), optional :: solid
    real(wp) :: flow(5, gauges%flow%n), value(7), row(size(gauges%column))
    integer :: g, f, s, place, d
    logical :: due
    if (gauges%n == 0) return
    due = time >= gauges%next
    if (gauges%flow%n > 0) flow = ieee_value(1.0_wp, ieee_quiet_nan)
    if (present(state) .and. gauges%flow%n > 0) then
      call read_flow_probes(gauges%flow, mesh, state, open, &
        [layout%pressure(), layout%density(), (layout%velocity(d), d=1, 3)], flow)
      do f = 1, gauges%flow%n
        if (.not. ieee_is_finite(flow(1, f))) cycle
        gauges%impulse(f) = gauges%impulse(f) + 0.5_wp*dt*(gauges%overpressure(f) + flow(1, f) - gauges%ambient)
        gauges%overpressure(f) = flow(1, f) - gauges%ambient
      end do
    end if
    if (.not. due) return
    if (present(solid)) call read_gauges(mesh, solid, gauges%followed)
    row(1) = time
    place = 1
    f = 0
    s = 0
    do g = 1, gauges%n
      if (gauges%in_flow(g)) then
        f = f + 1
        call add([flow(1, f), flow(1, f) - gauges%ambient, gauges%impulse(f), flow(2, f), pack(flow(3:5, f), mesh%active)])
      else
        s = s + 1
        value = gauges%followed(s)%value
        if (gauges%followed(s)%lost) value = ieee_value(1.0_wp, ieee_quiet_nan)
        call add([pack(value(1:3) - gauges%start(:, s), mesh%active), pack(value(4:6), mesh%active), value(7)])
      end if
    end do
    call put_row(gauges%table, row)
    if (gauges%interval > 0) gauges%next = gauges%interval*(floor(time/gauges%interval*(1 + epsilon(1.0_wp))) + 1)

  contains

    subroutine add(values)
      real(wp), intent(in) :: values(:)
      row(place + 1:place + size(values)) = values
      place = place + size(values)
    end subroutine add

  end subroutine sample_gauges

  !> Sends the rows so far to the disk.
  subroutine flush_gauges(gauges)
    type(gauges_type), intent(inout) :: gauges
    call flush_series(gauges%table)
  end subroutine flush_gauges

  subroutine close_gauges(gauges)
    type(gauges_type), intent(inout) :: gauges
    call close_series(gauges%table)
  end subroutine close_gauges

  !> All names and kinds in one line, by which a restart knows whether they are the same.
  pure function names_of(gauges) result(line)
    type(gauges_type), intent(in) :: gauges
    character(:), allocatable :: line
    integer :: g
    line = ''
    do g = 1, gauges%n
      line = line//trim(gauges%name(g))//trim(merge(' flow; ', ' solid;', gauges%in_flow(g)))
    end do
  end function names_of

end module gauges
