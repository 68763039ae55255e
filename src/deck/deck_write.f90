!> The deck written out with every default filled in; read again it gives the same deck, bit for bit.
module deck_write
  use kinds, only: wp
  use constants, only: unset
  use deck_assign, only: exact_text
  use deck_keys, only: key_table, key_type, kind_integer, kind_logical, kind_real
  use deck_tables, only: make_tables
  use deck_types, only: deck_type
  use errors, only: fatal
  use text, only: str
  use units, only: unit_label
  implicit none
  private
  public :: write_deck, deck_text

  !> To a unit that is open, or to a file of this name.
  interface write_deck
    module procedure write_to_unit, write_to_file
  end interface write_deck

contains

  !> Writes the deck to an open unit. To be called by one rank.
  subroutine write_to_unit(deck, unit)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: unit
    write (unit, '(a)') deck_text(deck)
  end subroutine write_to_unit

  !> Writes the deck to a file, which is replaced. To be called by one rank.
  subroutine write_to_file(deck, file)
    type(deck_type), intent(in) :: deck
    character(*), intent(in) :: file
    integer :: unit, status
    open (newunit=unit, file=file, status='replace', action='write', iostat=status)
    if (status /= 0) then
      call fatal('cannot write the deck to '//file)
      return
    end if
    call write_to_unit(deck, unit)
    close (unit)
  end subroutine write_to_file

  !> The text of the whole deck, a line for each key with its unit. Numbers that are not set are left out.
  function deck_text(deck) result(lines)
    type(deck_type), intent(in) :: deck
    character(:), allocatable :: lines
    type(deck_type), target :: copy
    type(key_table), allocatable :: tables(:)
    integer :: i, k
    copy = deck
    call make_tables(copy, tables)
    lines = '! '//trim(deck%file)//', with every default filled in'
    do i = 1, size(tables)
      lines = lines//new_line('a')//'&'//trim(tables(i)%group)
      do k = 1, tables(i)%n
        if (is_set(tables(i)%key(k))) lines = lines//new_line('a')// &
          key_line(tables(i)%key(k), trim(deck%run%units))
      end do
      lines = lines//new_line('a')//'/'
    end do
  end function deck_text

  pure logical function is_set(key)
    type(key_type), intent(in) :: key
    integer :: i
    is_set = .true.
    if (key%kind == kind_real) is_set = any([(key%real_element(i) > unset, i=1, key%n)])
  end function is_set

  function key_line(key, system) result(line)
    type(key_type), intent(in) :: key
    character(*), intent(in) :: system
    character(:), allocatable :: line
    character(:), allocatable :: label
    integer :: i
    line = '  '//trim(key%name)//' = '
    select case (key%kind)
    case (kind_real)
      do i = 1, key%n
        if (.not. key%real_element(i) > unset) exit
        if (i > 1) line = line//', '
        if (mod(i, 6) == 1 .and. i > 1) line = line//new_line('a')//'    '
        line = line//exact_text(key%real_element(i))
      end do
      label = trim(unit_label(key%dimension, system))
      if (label /= '-') line = line//' ! '//label
    case (kind_integer)
      do i = 1, key%n
        if (i > 1) line = line//', '
        line = line//str(key%integer_element(i))
      end do
    case (kind_logical)
      line = line//trim(merge('.true. ', '.false.', key%logical_value))
    case default
      line = line//''''
      do i = 1, len_trim(key%text_value)
        line = line//key%text_value(i:i)
        if (key%text_value(i:i) == '''') line = line//''''
      end do
      line = line//''''
    end select
  end function key_line

end module deck_write
