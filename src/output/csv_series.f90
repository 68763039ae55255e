!> A table that grows by rows in time, as comma-separated text with a heading: gauges.csv and history.csv.
!> Numbers carry every bit (17 digits). After a restart the file is cut back to the time of the restart and continued.
module csv_series
  use errors, only: fatal, warn
  use file_system, only: file_exists, rename_file
  use kinds, only: wp, i8
  use parallel, only: is_root
  use text, only: str
  implicit none
  private
  public :: series, open_series, put_row, flush_series, close_series

  !> An open table; only the root has it.
  type :: series
    integer :: unit = 0
    character(:), allocatable :: file
    integer :: n_columns = 0
    integer(i8) :: last_flush = 0 !< clock tick of the last time the rows were sent to the disk
  end type series

  integer, parameter :: seconds_between_flushes = 5

contains

  !> Opens a table. columns: headings, the first being the time. resume_time: go on with the table that is there, of which rows
  !> later than this are dropped; without it the table starts anew. A table with other headings is kept under the name FILE.old.
  subroutine open_series(table, file, columns, resume_time)
    type(series), intent(out) :: table
    character(*), intent(in) :: file
    character(*), intent(in) :: columns(:)
    real(wp), intent(in), optional :: resume_time
    integer :: status
    logical :: resumed
    table%file = trim(file)
    table%n_columns = size(columns)
    if (.not. is_root()) return
    resumed = .false.
    if (present(resume_time)) call cut_back(table, heading(columns), resume_time, resumed)
    if (resumed) then
      open (newunit=table%unit, file=table%file, status='old', position='append', action='write', iostat=status)
    else
      open (newunit=table%unit, file=table%file, status='replace', action='write', iostat=status)
      if (status == 0) write (table%unit, '(a)', iostat=status) heading(columns)
    end if
    if (status /= 0) call fatal('can''t write "'//table%file//'"')
    call system_clock(table%last_flush)
  end subroutine open_series

  !> Adds a row. To be called by all ranks, or the root alone.
  subroutine put_row(table, values)
    type(series), intent(inout) :: table
    real(wp), intent(in) :: values(:)
    integer :: i, status
    integer(i8) :: now, rate
    character(24) :: field
    character(:), allocatable :: row
    if (.not. is_root()) return
    if (size(values) /= table%n_columns) call fatal('"'//table%file//'" has '//str(table%n_columns)// &
      ' columns and got a row of '//str(size(values)))
    row = ''
    do i = 1, size(values)
      write (field, '(es24.16e3)') values(i) + 0.0_wp ! -0 becomes 0, as in a sum over ranks: the same file from any number
      if (i > 1) row = row//','
      row = row//trim(adjustl(field))
    end do
    write (table%unit, '(a)', iostat=status) row
    if (status /= 0) call fatal('can''t write "'//table%file//'" (is the disk full?)')
    call system_clock(now, rate)
    if (now - table%last_flush > seconds_between_flushes*rate) call flush_series(table)
  end subroutine put_row

  !> Sends all rows to the disk; due before a restart file is written, so that no row is missing after a crash.
  subroutine flush_series(table)
    type(series), intent(inout) :: table
    if (.not. is_root() .or. table%unit == 0) return
    flush (table%unit)
    call system_clock(table%last_flush)
  end subroutine flush_series

  subroutine close_series(table)
    type(series), intent(inout) :: table
    if (is_root() .and. table%unit /= 0) close (table%unit)
    table%unit = 0
  end subroutine close_series

  !> Rewrites the table without the rows later than the time and without a broken last row; resumed: there is a table to go on with.
  subroutine cut_back(table, head, time, resumed)
    type(series), intent(in) :: table
    character(*), intent(in) :: head
    real(wp), intent(in) :: time
    logical, intent(out) :: resumed
    integer :: old, new, status
    integer(i8) :: taken, there
    character(:), allocatable :: line
    real(wp) :: row_time
    resumed = .false.
    if (.not. file_exists(table%file)) then
      call warn('"'//table%file//'" is gone; it starts again at the time of the restart')
      return
    end if
    open (newunit=old, file=table%file, status='old', action='read', iostat=status)
    if (status /= 0) call fatal('can''t read "'//table%file//'"')
    inquire (unit=old, size=there)
    call read_line(old, line, status)
    taken = len(line) + 1
    if (line /= head) then
      close (old)
      call rename_file(table%file, table%file//'.old')
      call warn('the columns of "'//table%file//'" have changed; the rows before the restart are in "'//table%file//'.old"')
      return
    end if
    open (newunit=new, file=table%file//'.part', status='replace', action='write', iostat=status)
    if (status /= 0) call fatal('can''t write "'//table%file//'.part"')
    write (new, '(a)') head
    do
      call read_line(old, line, status)
      taken = taken + len(line) + 1
      if (status /= 0 .or. taken > there .or. commas(line) /= table%n_columns - 1) exit ! the last row lacks its end
      read (line(:index(line//',', ',') - 1), *, iostat=status) row_time
      if (status /= 0 .or. row_time > time) exit
      write (new, '(a)') line
    end do
    close (old)
    close (new)
    call rename_file(table%file//'.part', table%file)
    resumed = .true.
  end subroutine cut_back

  !> A whole line of any length; status: not zero at the end of the file.
  subroutine read_line(unit, line, status)
    integer, intent(in) :: unit
    character(:), allocatable, intent(out) :: line
    integer, intent(out) :: status
    character(4096) :: piece
    integer :: length
    line = ''
    do
      read (unit, '(a)', advance='no', size=length, iostat=status) piece
      if (is_iostat_end(status)) return
      line = line//piece(:length)
      if (is_iostat_eor(status)) exit
      if (status /= 0) return
    end do
    status = 0
  end subroutine read_line

  pure integer function commas(line)
    character(*), intent(in) :: line
    integer :: i
    commas = count([(line(i:i) == ',', i=1, len(line))])
  end function commas

  pure function heading(columns) result(line)
    character(*), intent(in) :: columns(:)
    character(:), allocatable :: line
    integer :: i
    line = trim(columns(1))
    do i = 2, size(columns)
      line = line//','//trim(columns(i))
    end do
  end function heading

end module csv_series
