!> A blast that was computed on a fine mesh of its own, in a file from which other runs take it. The file tells what it was computed
!> from.
module start_files
  use errors, only: fatal, exit_bad_input
  use file_system, only: file_exists, publish_file
  use hdf5_attributes, only: get_attribute, put_attribute
  use hdf5_files, only: hdf5_file, close_file, create_file, get_slab, n_columns, open_file, put_whole
  use, intrinsic :: iso_fortran_env, only: int64
  use kinds, only: wp
  use parallel, only: is_root
  use radial_profile, only: radial_profile_type, n_felt, n_seen
  use reductions, only: any_rank
  implicit none
  private
  public :: start_file_exists, write_start_file, read_start_file

  character(*), parameter :: kind = 'start of a charge, 2' !< and the version of its contents

contains

  !> The same on every rank.
  logical function start_file_exists(name) result(found)
    character(*), intent(in) :: name
    found = .false.
    if (is_root()) found = file_exists(name)
    found = any_rank(found)
  end function start_file_exists

  !> Writes a profile. fingerprint: of all that it depends on; stop: radius that the run was to stop at. To be called by all ranks.
  subroutine write_start_file(name, profile, fingerprint, stop_radius)
    character(*), intent(in) :: name, fingerprint
    type(radial_profile_type), intent(in) :: profile
    real(wp), intent(in) :: stop_radius
    type(hdf5_file) :: file
    call create_file(file, name//'.part')
    call put_attribute(file, '/', 'kind', kind)
    call put_attribute(file, '/', 'fingerprint', fingerprint)
    call put_attribute(file, '/', 'radial_power', [profile%radial_power])
    call put_attribute(file, '/', 'sizes', shape(profile%state))
    call put_attribute(file, '/', 'figures', [profile%thickness, profile%time, profile%front, profile%afterburnt, stop_radius, &
      profile%height, profile%bottom, profile%finest, profile%end_distance, profile%energy_error])
    call put_attribute(file, '/', 'low_end', trim(profile%end_kind(1)))
    call put_attribute(file, '/', 'high_end', trim(profile%end_kind(2)))
    call put_whole(file, 'state', reshape(profile%state, [size(profile%state)]), size(profile%state, 1))
    call put_whole(file, 'felt', reshape(profile%felt, [size(profile%felt)]), n_felt)
    call put_attribute(file, '/', 'gauges', [size(profile%gauge, 2)])
    call put_whole(file, 'seen_at', profile%seen_at)
    if (size(profile%gauge) > 0) then
      call put_whole(file, 'gauge', reshape(profile%gauge, [size(profile%gauge)]), 2)
      call put_whole(file, 'seen', reshape(profile%seen, [size(profile%seen)]), n_seen*size(profile%gauge, 2))
    end if
    call close_file(file)
    call publish_file(name//'.part', name)
  end subroutine write_start_file

  !> Reads a profile. Fatal (bad input) where the file is no such file or was computed from something else. stop: as it was written.
  subroutine read_start_file(name, profile, fingerprint, stop_radius)
    character(*), intent(in) :: name, fingerprint
    type(radial_profile_type), intent(out) :: profile
    real(wp), intent(out) :: stop_radius
    type(hdf5_file) :: file
    character(:), allocatable :: found
    real(wp) :: figures(11)
    real(wp), allocatable :: values(:)
    integer :: power(1), sizes(3)
    stop_radius = 0
    call open_file(file, name)
    call get_attribute(file, '/', 'kind', found)
    if (found /= kind) call refuse('is not the start of a charge as this program writes it')
    call get_attribute(file, '/', 'fingerprint', found)
    if (found /= fingerprint) call refuse('belongs to another charge, material, surroundings or scheme than the deck has: '// &
                                          'remove it or name another one')
    call get_attribute(file, '/', 'radial_power', power)
    call get_attribute(file, '/', 'sizes', sizes)
    call get_attribute(file, '/', 'figures', figures)
    call get_attribute(file, '/', 'low_end', found)
    profile%end_kind(1) = found
    call get_attribute(file, '/', 'high_end', found)
    profile%end_kind(2) = found
    profile%radial_power = power(1)
    profile%thickness = figures(1)
    profile%time = figures(2)
    profile%front = figures(3)
    profile%afterburnt = figures(4)
    stop_radius = figures(5)
    profile%height = figures(6)
    profile%bottom = figures(7)
    profile%finest = figures(8)
    profile%end_distance = figures(9:10)
    profile%energy_error = figures(11)
    allocate (values(product(sizes)))
    call get_slab(file, 'state', values, 0_int64, sizes(1))
    profile%state = reshape(values, sizes)
    deallocate (values)
    allocate (values(n_felt*sizes(2)*sizes(3)))
    call get_slab(file, 'felt', values, 0_int64, n_felt)
    profile%felt = reshape(values, [n_felt, sizes(2), sizes(3)])
    call read_history(file, profile)
    call close_file(file)
  contains
    subroutine refuse(reason)
      character(*), intent(in) :: reason
      call fatal('start_file '''//name//''' '//reason, exit_bad_input)
    end subroutine refuse
  end subroutine read_start_file

  subroutine read_history(file, profile)
    type(hdf5_file), intent(inout) :: file
    type(radial_profile_type), intent(inout) :: profile
    real(wp), allocatable :: values(:), places(:)
    integer :: gauges(1), n
    call get_attribute(file, '/', 'gauges', gauges)
    n = int(n_columns(file, 'seen_at'))
    allocate (profile%seen_at(n), places(2*gauges(1)), values(n_seen*gauges(1)*n))
    call get_slab(file, 'seen_at', profile%seen_at, 0_int64)
    if (gauges(1) > 0) then
      call get_slab(file, 'gauge', places, 0_int64, 2)
      call get_slab(file, 'seen', values, 0_int64, n_seen*gauges(1))
    end if
    profile%gauge = reshape(places, [2, gauges(1)])
    profile%seen = reshape(values, [n_seen, gauges(1), n])
  end subroutine read_history

end module start_files
