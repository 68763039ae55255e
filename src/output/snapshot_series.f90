!> The list that ties snapshots to their times: flow.vtkhdf.series and solid.vtkhdf.series, which ParaView opens as one series.
module snapshot_series
  use errors, only: fatal
  use file_system, only: base_name, file_exists, rename_file
  use kinds, only: wp
  use parallel, only: is_root
  implicit none
  private
  public :: snapshot_list, start_list, add_snapshot

  integer, parameter :: name_length = 128

  !> The snapshots so far; only the root has them.
  type :: snapshot_list
    character(:), allocatable :: file
    integer :: n = 0
    character(name_length), allocatable :: name(:)
    real(wp), allocatable :: time(:)
  end type snapshot_list

contains

  !> An empty list; with resume_time, the list that is there without the snapshots later than this.
  subroutine start_list(list, file, resume_time)
    type(snapshot_list), intent(out) :: list
    character(*), intent(in) :: file
    real(wp), intent(in), optional :: resume_time
    integer :: unit, status, first, last
    character(512) :: line
    real(wp) :: time
    list%file = trim(file)
    allocate (list%name(0), list%time(0))
    if (.not. (is_root() .and. present(resume_time))) return
    if (.not. file_exists(file)) return
    open (newunit=unit, file=list%file, status='old', action='read', iostat=status)
    if (status /= 0) call fatal('can''t read "'//list%file//'"')
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      first = index(line, '"name": "') + 9
      if (first == 9) cycle
      last = first + index(line(first:), '"') - 2
      read (line(index(line, '"time":') + 7:index(line, '}') - 1), *, iostat=status) time
      if (status /= 0) exit
      if (time <= resume_time) call append(list, line(first:last), time)
    end do
    close (unit)
  end subroutine start_list

  !> Adds a snapshot and rewrites the list; one of the same file is replaced.
  subroutine add_snapshot(list, path, time)
    type(snapshot_list), intent(inout) :: list
    character(*), intent(in) :: path
    real(wp), intent(in) :: time
    integer :: unit, i, status
    character(24) :: number
    if (.not. is_root()) return
    if (list%n > 0) then
      if (list%name(list%n) == base_name(path)) list%n = list%n - 1
    end if
    call append(list, base_name(path), time)
    open (newunit=unit, file=list%file//'.part', status='replace', action='write', iostat=status)
    if (status /= 0) call fatal('can''t write "'//list%file//'"')
    write (unit, '(a)') '{', '  "file-series-version": "1.0",', '  "files": ['
    do i = 1, list%n
      write (number, '(es24.16e3)') list%time(i)
      write (unit, '(6a)') '    {"name": "', trim(list%name(i)), '", "time": ', trim(adjustl(number)), '}', &
        trim(merge(', ', '  ', i < list%n))
    end do
    write (unit, '(a)') '  ]', '}'
    close (unit)
    call rename_file(list%file//'.part', list%file)
  end subroutine add_snapshot

  subroutine append(list, name, time)
    type(snapshot_list), intent(inout) :: list
    character(*), intent(in) :: name
    real(wp), intent(in) :: time
    character(name_length), allocatable :: longer_name(:)
    real(wp), allocatable :: longer_time(:)
    if (list%n == size(list%time)) then
      allocate (longer_name(2*list%n + 16), longer_time(2*list%n + 16))
      longer_name(:list%n) = list%name(:list%n)
      longer_time(:list%n) = list%time(:list%n)
      call move_alloc(longer_name, list%name)
      call move_alloc(longer_time, list%time)
    end if
    list%n = list%n + 1
    list%name(list%n) = name
    list%time(list%n) = time
  end subroutine append

end module snapshot_series
