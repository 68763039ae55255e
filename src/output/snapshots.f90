!> The states of a run as files that ParaView and VTK open: snapshot_flow_*.vtkhdf and snapshot_solid_*.vtkhdf, named after the
!> step, the lists of them with their times, and peaks.vtkhdf. All procedures are to be called by all ranks.
module snapshots
  use blocks, only: block
  use flow_layout, only: layout_type
  use hdf5_attributes, only: put_attribute
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_damage, at_mass, at_plastic_strain, at_position, at_stress, at_velocity, at_volume, particle_block
  use peak_maps, only: peak_arrival, peak_impulse, peak_maps_type, peak_overpressure
  use snapshot_header, only: snapshot_clock
  use snapshot_series, only: add_snapshot, snapshot_list, start_list
  use solid_state, only: solid_type, material_names, materials_of_sets
  use text, only: join, str
  use units, only: unit_labels_type
  use vtkhdf_grid, only: close_grid_file, create_grid_file, grid_file, put_cells
  use vtkhdf_points, only: close_point_file, create_point_file, point_file, put_points
  implicit none
  private
  public :: snapshots_type, start_snapshots, put_flow_snapshot, put_solid_snapshot, put_peak_snapshot, step_text

  !> Where snapshots go and what has been written.
  type :: snapshots_type
    character(:), allocatable :: folder
    character(:), allocatable :: title
    type(unit_labels_type) :: labels
    type(snapshot_list) :: flow, solid
  end type snapshots_type

contains

  !> folder: of the output, which exists; resume_time: time of the restart, later snapshots are then struck off the lists.
  subroutine start_snapshots(snapshots, folder, title, labels, resume_time)
    type(snapshots_type), intent(out) :: snapshots
    character(*), intent(in) :: folder, title
    type(unit_labels_type), intent(in) :: labels
    real(wp), intent(in), optional :: resume_time
    snapshots%folder = trim(folder)
    snapshots%title = trim(title)
    snapshots%labels = labels
    call start_list(snapshots%flow, snapshots%folder//'/flow.vtkhdf.series', resume_time)
    call start_list(snapshots%solid, snapshots%folder//'/solid.vtkhdf.series', resume_time)
  end subroutine start_snapshots

  !> Writes the flow. material: names in the order of the layout; cell_type: 0 fluid, 1 interface, 2 inside the solid (absent: no
  !> solid in the scene).
  subroutine put_flow_snapshot(snapshots, mesh, time, step, state, layout, material, cell_type)
    type(snapshots_type), intent(inout) :: snapshots
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: time
    integer, intent(in) :: step
    type(block), intent(in) :: state(:)
    type(layout_type), intent(in) :: layout
    character(*), intent(in) :: material(:)
    type(block), intent(in), optional :: cell_type(:)
    type(grid_file) :: file
    character(:), allocatable :: name
    integer :: k, n
    name = snapshots%folder//'/snapshot_flow_'//step_text(step)//'.vtkhdf'
    call create_grid_file(file, name, 'flow', clock_of(snapshots, time, step), mesh)
    n = layout%n_materials
    associate (labels => snapshots%labels)
      call put_attribute(file%hdf5, 'brisance', 'materials', join(material, ';'))
      call put_cells(file, mesh, 'density', labels%density, state, [layout%density()])
      call put_cells(file, mesh, 'pressure', labels%pressure, state, [layout%pressure()])
      call put_cells(file, mesh, 'velocity', labels%velocity, state, [(layout%velocity(k), k=1, 3)])
      call put_cells(file, mesh, 'sound_speed', labels%velocity, state, [layout%sound_speed()])
      if (n > 1) then
        do k = 1, n - 1
          call put_cells(file, mesh, 'volume_fraction_'//plain(material(k)), '-', state, [layout%fraction(k)])
        end do
        call put_cells(file, mesh, 'volume_fraction_'//plain(material(n)), '-', state, [(layout%fraction(k), k=1, n - 1)], &
          remainder=.true.)
      end if
      if (present(cell_type)) call put_cells(file, mesh, 'cell_type', '-', cell_type, [1])
    end associate
    call close_grid_file(file)
    call add_snapshot(snapshots%flow, name, time)
  end subroutine put_flow_snapshot

  !> Writes the particles. Their pressure is that of the stress, without the bulk viscosity. fragment: of each particle of this rank,
  !> brick after brick and set after set.
  subroutine put_solid_snapshot(snapshots, mesh, time, step, solid, fragment)
    type(snapshots_type), intent(inout) :: snapshots
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: time
    integer, intent(in) :: step
    type(solid_type), intent(in) :: solid
    integer, intent(in), optional :: fragment(:)
    type(point_file) :: file
    character(:), allocatable :: name
    real(wp), allocatable :: stress(:)
    integer :: i
    name = snapshots%folder//'/snapshot_solid_'//step_text(step)//'.vtkhdf'
    call create_point_file(file, name, clock_of(snapshots, time, step), mesh, &
      columns(solid%block, at_position, 3))
    associate (labels => snapshots%labels, particle => solid%block)
      call put_attribute(file%hdf5, 'brisance', 'materials', join(material_names(solid), ';'))
      call put_attribute(file%hdf5, 'brisance', 'bodies', join(solid%body_name, ';'))
      call put_points(file, 'velocity', labels%velocity, columns(particle, at_velocity, 3), 3)
      allocate (stress(6*sum(particle%n)))
      stress(:) = columns(particle, at_stress, 6)
      call put_points(file, 'pressure', labels%pressure, [(-sum(stress(i:i + 2))/3, i=1, size(stress), 6)])
      call put_points(file, 'von_mises', labels%pressure, [(von_mises(stress(i:i + 5)), i=1, size(stress), 6)])
      call put_points(file, 'damage', '-', columns(particle, at_damage, 1))
      call put_points(file, 'plastic_strain', '-', columns(particle, at_plastic_strain, 1))
      call put_points(file, 'density', labels%density, columns(particle, at_mass, 1)/columns(particle, at_volume, 1))
      call put_points(file, 'volume', volume_unit(labels%length), columns(particle, at_volume, 1))
      call put_points(file, 'material', '-', numbers(particle, 1, materials_of_sets(solid)), one_byte=solid%n_sets < 256)
      call put_points(file, 'body', '-', numbers(particle, 2))
      call put_points(file, 'id', '-', numbers(particle, 3))
      if (present(fragment)) call put_points(file, 'fragment', '-', fragment)
    end associate
    call close_point_file(file)
    call add_snapshot(snapshots%solid, name, time)
  end subroutine put_solid_snapshot

  !> Writes the peak maps, as peaks.vtkhdf.
  subroutine put_peak_snapshot(snapshots, mesh, time, step, peaks)
    type(snapshots_type), intent(in) :: snapshots
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: time
    integer, intent(in) :: step
    type(peak_maps_type), intent(in) :: peaks
    type(grid_file) :: file
    call create_grid_file(file, snapshots%folder//'/peaks.vtkhdf', 'peaks', clock_of(snapshots, time, step), mesh)
    associate (labels => snapshots%labels)
      call put_cells(file, mesh, 'peak_overpressure', labels%pressure, peaks%map, [peak_overpressure])
      call put_cells(file, mesh, 'impulse', labels%impulse, peaks%map, [peak_impulse])
      call put_cells(file, mesh, 'arrival_time', labels%time, peaks%map, [peak_arrival])
    end associate
    call close_grid_file(file)
  end subroutine put_peak_snapshot

  function clock_of(snapshots, time, step) result(clock)
    type(snapshots_type), intent(in) :: snapshots
    real(wp), intent(in) :: time
    integer, intent(in) :: step
    type(snapshot_clock) :: clock
    clock%title = snapshots%title
    clock%length_unit = trim(snapshots%labels%length)
    clock%time_unit = trim(snapshots%labels%time)
    clock%time = time
    clock%step = step
  end function clock_of

  !> Columns first..first+width-1 of all particles, those of one particle together.
  pure function columns(particle, first, width) result(values)
    type(particle_block), intent(in) :: particle(:, :)
    integer, intent(in) :: first, width
    real(wp), allocatable :: values(:)
    integer :: set, b, i, place
    allocate (values(width*sum(particle%n)))
    place = 0
    do b = 1, size(particle, 2)
      do set = 1, size(particle, 1)
        do i = 1, particle(set, b)%n
          values(place + 1:place + width) = particle(set, b)%f(i, first:first + width - 1)
          place = place + width
        end do
      end do
    end do
  end function columns

  !> which: 1 material, 2 body, 3 id of all particles, in the order of columns. material: of each set.
  pure function numbers(particle, which, material) result(values)
    type(particle_block), intent(in) :: particle(:, :)
    integer, intent(in) :: which
    integer, intent(in), optional :: material(:)
    integer, allocatable :: values(:)
    integer :: set, b, n, place
    allocate (values(sum(particle%n)))
    place = 0
    do b = 1, size(particle, 2)
      do set = 1, size(particle, 1)
        n = particle(set, b)%n
        if (which == 1) values(place + 1:place + n) = material(set)
        if (which == 2) values(place + 1:place + n) = particle(set, b)%body(:n)
        if (which == 3) values(place + 1:place + n) = particle(set, b)%id(:n)
        place = place + n
      end do
    end do
  end function numbers

  !> Equivalent stress of von Mises, from xx, yy, zz, yz, xz, xy.
  pure real(wp) function von_mises(s)
    real(wp), intent(in) :: s(6)
    von_mises = sqrt(0.5_wp*((s(1) - s(2))**2 + (s(2) - s(3))**2 + (s(3) - s(1))**2) + 3*sum(s(4:6)**2))
  end function von_mises

  pure function volume_unit(length_unit) result(unit)
    character(*), intent(in) :: length_unit
    character(:), allocatable :: unit
    unit = trim(length_unit)
    if (unit /= '-') unit = unit//'^3'
  end function volume_unit

  !> A step as it stands in the names of files: six digits or more.
  pure function step_text(step) result(string)
    integer, intent(in) :: step
    character(:), allocatable :: string
    string = str(step)
    if (len(string) < 6) string = repeat('0', 6 - len(string))//string
  end function step_text

  !> A name without the letters that mean something in a path.
  pure function plain(name) result(string)
    character(*), intent(in) :: name
    character(:), allocatable :: string
    integer :: i
    string = trim(name)
    do i = 1, len(string)
      if (index('/. ', string(i:i)) > 0) string(i:i) = '_'
    end do
  end function plain

end module snapshots
