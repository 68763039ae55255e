!> Loads of the flow on the bodies as files: loads.csv with their history, and loads_<step>.vtkhdf with what their surfaces felt.
!> All procedures are to be called by all ranks.
module load_files
  use body_loads, only: body_sums
  use csv_series, only: series, open_series, put_row
  use hdf5_attributes, only: put_attribute
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_volume, load_overpressure, load_peak, load_impulse, load_arrival, load_not_wetted
  use snapshot_header, only: snapshot_clock
  use solid_state, only: solid_type
  use text, only: append, join
  use units, only: unit_labels_type
  use vtkhdf_points, only: close_point_file, create_point_file, point_file, put_points
  implicit none
  private
  public :: open_loads, put_loads, put_load_map

  integer, parameter :: column_length = 96

contains

  !> Opens the table; resume_time: go on after a restart.
  subroutine open_loads(table, file, body, active, labels, resume_time)
    type(series), intent(out) :: table
    character(*), intent(in) :: file, body(:)
    logical, intent(in) :: active(3)
    type(unit_labels_type), intent(in) :: labels
    real(wp), intent(in), optional :: resume_time
    character(column_length), allocatable :: column(:)
    character(:), allocatable :: moment
    integer :: b
    moment = trim(labels%force)
    if (moment /= '-') moment = moment//' '//trim(labels%length)
    allocate (column(0))
    call append(column, 'time ['//trim(labels%time)//']')
    do b = 1, size(body)
      call add('force', labels%force, active)
      call add('moment', moment, axes(active))
      call add('impulse', labels%momentum, active)
      call add('center', labels%length, active)
      call add('velocity', labels%velocity, active)
    end do
    call open_series(table, file, column, resume_time)

  contains

    subroutine add(name, unit, there)
      character(*), intent(in) :: name, unit
      logical, intent(in) :: there(3)
      integer :: d
      do d = 1, 3
        if (there(d)) call append(column, trim(body(b))//'.'//name//'_'//'xyz'(d:d)//' ['//trim(unit)//']')
      end do
    end subroutine add

  end subroutine open_loads

  !> Axes about which something can turn: those that stand on two directions with cells.
  pure function axes(active) result(there)
    logical, intent(in) :: active(3)
    logical :: there(3)
    integer :: d
    there = [(all(active .or. [1, 2, 3] == d), d=1, 3)]
  end function axes

  !> Adds a row.
  subroutine put_loads(table, time, active, sums)
    type(series), intent(inout) :: table
    real(wp), intent(in) :: time
    logical, intent(in) :: active(3)
    type(body_sums), intent(in) :: sums
    real(wp), allocatable :: row(:)
    integer :: b
    row = [time]
    do b = 1, size(sums%force, 2)
      row = [row, pack(sums%force(:, b), active), pack(sums%moment(:, b), axes(active)), pack(sums%impulse(:, b), active), &
             pack(sums%center(:, b), active), pack(sums%velocity(:, b), active)]
    end do
    call put_row(table, row)
  end subroutine put_loads

  !> Writes the particles that the flow has touched, with what they felt.
  subroutine put_load_map(name, clock, mesh, solid, labels)
    character(*), intent(in) :: name
    type(snapshot_clock), intent(in) :: clock
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(unit_labels_type), intent(in) :: labels
    type(point_file) :: file
    real(wp), allocatable :: position(:), felt(:, :), volume(:)
    integer, allocatable :: body(:), id(:)
    character(:), allocatable :: unit
    integer :: b, set, i, n, pass
    do pass = 1, 2
      n = 0
      do b = 1, mesh%n_local
        do set = 1, solid%n_sets
          associate (blk => solid%block(set, b), at => solid%at_load(set))
            do i = 1, blk%n
              if (blk%f(i, at + load_arrival) <= load_not_wetted) cycle
              n = n + 1
              if (pass == 1) cycle
              position(3*n - 2:3*n) = blk%f(i, at_position:at_position + 2)
              felt(n, :) = blk%f(i, at:at + load_arrival)
              volume(n) = blk%f(i, at_volume)
              body(n) = blk%body(i)
              id(n) = blk%id(i)
            end do
          end associate
        end do
      end do
      if (pass == 1) allocate (position(3*n), felt(n, load_overpressure:load_arrival), volume(n), body(n), id(n))
    end do
    unit = trim(labels%length)
    if (unit /= '-') unit = unit//'^3'
    call create_point_file(file, name, clock, mesh, position)
    call put_attribute(file%hdf5, 'brisance', 'materials', join(solid%material%name, ';'))
    call put_attribute(file%hdf5, 'brisance', 'bodies', join(solid%body_name, ';'))
    call put_points(file, 'overpressure', labels%pressure, felt(:, load_overpressure))
    call put_points(file, 'peak_overpressure', labels%pressure, felt(:, load_peak))
    call put_points(file, 'impulse', labels%impulse, felt(:, load_impulse))
    call put_points(file, 'arrival_time', labels%time, felt(:, load_arrival))
    call put_points(file, 'volume', unit, volume)
    call put_points(file, 'body', '-', body)
    call put_points(file, 'id', '-', id)
    call close_point_file(file)
  end subroutine put_load_map

end module load_files
