!> Files from which a run goes on, bit for bit, on any number of ranks: restart_a.h5 and restart_b.h5 in the output folder.
!> They take turns, so the last two are kept; each is written aside and renamed, so a crash while writing loses nothing.
!> The file knows nothing of ranks: fields and particle tables stand brick after brick in the order of the mesh.
!> All procedures are to be called by all ranks. Errors are fatal: a run never starts anew in place of going on.
module restart_files
  use errors, only: fatal, exit_bad_input
  use file_system, only: file_exists, publish_file, remove_file
  use hdf5_attributes, only: get_attribute, put_attribute
  use hdf5_files, only: hdf5_file, close_file, create_file, create_group, has_object, open_file
  use kinds, only: wp
  use mesh, only: mesh_type
  use parallel, only: barrier, is_root, rank
  use text, only: str
  implicit none
  private
  public :: restart_file, create_restart, open_restart, close_restart, newest_restart, forget_restarts
  public :: restart_has

  integer, parameter :: format_version = 3

  !> A restart file being written or read.
  type :: restart_file
    type(hdf5_file) :: hdf5
    character(:), allocatable :: name !< path, the final one
    real(wp) :: time = 0
    integer :: step = 0
    logical :: writing = .false.
    integer :: n_bricks = 0 !< of the whole mesh
    integer :: first = 0 !< bricks before mine
  end type restart_file

contains

  !> Starts the next restart file of a folder.
  subroutine create_restart(file, folder, mesh, time, step)
    type(restart_file), intent(out) :: file
    character(*), intent(in) :: folder
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: time
    integer, intent(in) :: step
    character(:), allocatable :: newest, group
    integer :: serial
    call find_newest(folder, newest, serial)
    file%name = slot_name(folder, 1)
    if (newest == file%name) file%name = slot_name(folder, 2)
    file%time = time
    file%step = step
    file%writing = .true.
    call note_share(file, mesh)
    call create_file(file%hdf5, file%name//'.part')
    group = 'brisance'
    call create_group(file%hdf5, group)
    call put_attribute(file%hdf5, group, 'format', [format_version])
    call put_attribute(file%hdf5, group, 'content', 'restart')
    call put_attribute(file%hdf5, group, 'serial', [serial + 1])
    call put_attribute(file%hdf5, group, 'time', [time])
    call put_attribute(file%hdf5, group, 'step', [step])
    call put_attribute(file%hdf5, group, 'cells', mesh%cells)
    call put_attribute(file%hdf5, group, 'brick_cells', mesh%brick_cells)
    call put_attribute(file%hdf5, group, 'radial_power', [mesh%radial_power])
    call put_attribute(file%hdf5, group, 'lower', mesh%lower)
    call put_attribute(file%hdf5, group, 'upper', mesh%upper)
    call create_group(file%hdf5, 'state')
    call create_group(file%hdf5, 'bricks')
  end subroutine create_restart

  !> Opens a restart file for reading; fatal unless it is of this mesh (cells, bricks, geometry, extent) and format.
  subroutine open_restart(file, name, mesh)
    type(restart_file), intent(out) :: file
    character(*), intent(in) :: name
    type(mesh_type), intent(in) :: mesh
    integer :: numbers(3), version(1), step(1), power(1)
    real(wp) :: extent(3), time(1)
    file%name = name
    call note_share(file, mesh)
    call open_file(file%hdf5, name)
    if (.not. file%hdf5%ok) return
    call get_attribute(file%hdf5, 'brisance', 'format', version)
    if (version(1) /= format_version) call fatal('restart file "'//name//'" has format '//str(version(1))// &
      '; this program reads format '//str(format_version))
    call get_attribute(file%hdf5, 'brisance', 'cells', numbers)
    if (any(numbers /= mesh%cells)) call fatal('restart file "'//name//'" has other cells ('//list_of(numbers)// &
      ') than the deck ('//list_of(mesh%cells)//')')
    call get_attribute(file%hdf5, 'brisance', 'brick_cells', numbers)
    if (any(numbers /= mesh%brick_cells)) call fatal('restart file "'//name//'" has bricks of '//list_of(numbers)// &
      ' cells, the deck of '//list_of(mesh%brick_cells))
    call get_attribute(file%hdf5, 'brisance', 'radial_power', power)
    if (power(1) /= mesh%radial_power) call fatal('restart file "'//name//'" is of another geometry than the deck')
    call get_attribute(file%hdf5, 'brisance', 'lower', extent)
    if (any(abs(extent - mesh%lower) > 0)) call fatal('restart file "'//name//'" has another lower corner than the deck')
    call get_attribute(file%hdf5, 'brisance', 'upper', extent)
    if (any(abs(extent - mesh%upper) > 0)) call fatal('restart file "'//name//'" has another upper corner than the deck')
    call get_attribute(file%hdf5, 'brisance', 'time', time)
    call get_attribute(file%hdf5, 'brisance', 'step', step)
    file%time = time(1)
    file%step = step(1)
  end subroutine open_restart

  !> Closes the file; one that was written gets its name only now.
  subroutine close_restart(file)
    type(restart_file), intent(inout) :: file
    logical :: ok
    ok = file%hdf5%ok
    call close_file(file%hdf5)
    if (file%writing .and. ok) call publish_file(file%name//'.part', file%name)
  end subroutine close_restart

  !> The newest restart file of a folder; fatal if there is none.
  function newest_restart(folder) result(name)
    character(*), intent(in) :: folder
    character(:), allocatable :: name
    integer :: serial
    call find_newest(folder, name, serial)
    if (len(name) == 0) call fatal('there is no readable restart file ('//slot_name(folder, 1)// &
    ' or '//slot_name(folder, 2)//')', exit_bad_input)
  end function newest_restart

  !> Removes the restart files of an earlier run from a folder in which a run starts anew.
  subroutine forget_restarts(folder)
    character(*), intent(in) :: folder
    integer :: slot
    if (is_root()) then
      do slot = 1, 2
        call remove_file(slot_name(folder, slot))
      end do
    end if
    call barrier()
  end subroutine forget_restarts

  !> Empty name and serial 0 where there is no whole restart file.
  subroutine find_newest(folder, name, serial)
    character(*), intent(in) :: folder
    character(:), allocatable, intent(out) :: name
    integer, intent(out) :: serial
    type(hdf5_file) :: candidate
    integer :: slot, found(1)
    name = ''
    serial = 0
    do slot = 1, 2
      if (.not. file_exists(slot_name(folder, slot))) cycle
      call open_file(candidate, slot_name(folder, slot), missing_ok=.true.)
      if (.not. candidate%ok) cycle
      if (has_object(candidate, 'brisance')) then
        call get_attribute(candidate, 'brisance', 'serial', found)
        if (found(1) > serial) then
          serial = found(1)
          name = slot_name(folder, slot)
        end if
      end if
      call close_file(candidate)
    end do
    call barrier()
  end subroutine find_newest

  pure function slot_name(folder, slot) result(name)
    character(*), intent(in) :: folder
    integer, intent(in) :: slot
    character(:), allocatable :: name
    name = trim(folder)//'/restart_'//merge('a', 'b', slot == 1)//'.h5'
  end function slot_name

  subroutine note_share(file, mesh)
    type(restart_file), intent(inout) :: file
    type(mesh_type), intent(in) :: mesh
    file%n_bricks = size(mesh%brick)
    file%first = count(mesh%brick%rank < rank)
  end subroutine note_share

  pure function list_of(numbers) result(list)
    integer, intent(in) :: numbers(3)
    character(:), allocatable :: list
    list = str(numbers(1))//' x '//str(numbers(2))//' x '//str(numbers(3))
  end function list_of

  !> True if the file holds something of that name, put by any of the procedures.
  logical function restart_has(file, name)
    type(restart_file), intent(in) :: file
    character(*), intent(in) :: name
    restart_has = has_object(file%hdf5, 'state/'//name)
    if (.not. restart_has) restart_has = has_object(file%hdf5, 'bricks/'//name)
  end function restart_has

end module restart_files
