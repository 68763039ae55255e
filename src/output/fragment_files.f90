!> Fragments as a table, fragments_<step>.csv: one row for each, the heaviest first.
module fragment_files
  use errors, only: fatal
  use file_system, only: rename_file
  use fragments, only: fragment_type
  use kinds, only: wp
  use parallel, only: is_root
  use text, only: str
  use units, only: unit_labels_type
  implicit none
  private
  public :: write_fragments

contains

  !> Writes the table. Materials of a fragment stand with a + between them, that of the most mass first. The root writes.
  subroutine write_fragments(name, fragment, material, body, labels)
    character(*), intent(in) :: name, material(:), body(:)
    type(fragment_type), intent(in) :: fragment(:)
    type(unit_labels_type), intent(in) :: labels
    integer :: unit, status, i
    if (.not. is_root()) return
    open (newunit=unit, file=name//'.part', status='replace', action='write', iostat=status)
    if (status /= 0) call fatal('can''t write "'//name//'"')
    write (unit, '(a)', iostat=status) heading(labels)
    do i = 1, size(fragment)
      if (status == 0) write (unit, '(a)', iostat=status) str(i)//','//trim(body(fragment(i)%body))//','// &
        materials_of(fragment(i), material)//','//str(fragment(i)%particles)//numbers(figures(fragment(i)))
    end do
    close (unit)
    if (status /= 0) call fatal('can''t write "'//name//'" (is the disk full?)')
    call rename_file(name//'.part', name)
  end subroutine write_fragments

  pure function heading(labels) result(line)
    type(unit_labels_type), intent(in) :: labels
    character(:), allocatable :: line, length, velocity, spin
    length = ' ['//trim(labels%length)//']'
    velocity = ' ['//trim(labels%velocity)//']'
    spin = ' ['//trim(labels%energy)//' '//trim(labels%time)//']'
    line = 'fragment,body,material,particles,mass ['//trim(labels%mass)//'],diameter'//length// &
      ',position_x'//length//',position_y'//length//',position_z'//length// &
      ',velocity_x'//velocity//',velocity_y'//velocity//',velocity_z'//velocity// &
      ',spin_x'//spin//',spin_y'//spin//',spin_z'//spin//',kinetic_energy ['//trim(labels%energy)//']'// &
      ',size_x'//length//',size_y'//length//',size_z'//length
  end function heading

  !> Box: around the middles of the particles and half a spacing at each side.
  pure function figures(f) result(values)
    type(fragment_type), intent(in) :: f
    real(wp) :: values(15)
    values = [f%mass, f%diameter, f%position, f%velocity, f%spin, f%kinetic_energy, f%upper - f%lower + f%spacing]
  end function figures

  pure function numbers(values) result(text)
    real(wp), intent(in) :: values(:)
    character(:), allocatable :: text
    character(24) :: field
    integer :: i
    text = ''
    do i = 1, size(values)
      write (field, '(es24.16e3)') values(i) + 0.0_wp ! -0 becomes 0
      text = text//','//trim(adjustl(field))
    end do
  end function numbers

  pure function materials_of(fragment, material) result(names)
    type(fragment_type), intent(in) :: fragment
    character(*), intent(in) :: material(:)
    character(:), allocatable :: names
    logical :: left(size(material))
    integer :: i, set
    left = fragment%material_mass > 0
    names = ''
    do i = 1, count(left)
      set = maxloc(fragment%material_mass, dim=1, mask=left)
      left(set) = .false.
      if (i > 1) names = names//'+'
      names = names//trim(material(set))
    end do
  end function materials_of

end module fragment_files
