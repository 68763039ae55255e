!> Which bodies share a velocity field, and which fields touch: from the contacts of a deck.
!>
!> Bodies share a field if no contact between them was asked for and each has the same contacts as the other: then the two fields
!> that meet at a node tell which law holds between them, whatever bodies they are of. Bodies without any contact share one field.
module contact_fields
  use kinds, only: wp
  use solid_state, only: contact_pair
  implicit none
  private
  public :: choose_fields

contains

  !> field: of each body, numbered in the order of the bodies; pair: fields that touch. friction(i, j) = friction(j, i): between two
  !> bodies, negative where they stick.
  pure subroutine choose_fields(friction, name, field, pair)
    real(wp), intent(in) :: friction(:, :)
    character(*), intent(in) :: name(:)
    integer, allocatable, intent(out) :: field(:)
    type(contact_pair), allocatable, intent(out) :: pair(:)
    integer :: first(size(name)), n, i, f, g
    allocate (field(size(name)), pair(0))
    n = 0
    do i = 1, size(name)
      do f = 1, n
        if (alike(friction, first(f), i)) exit
      end do
      field(i) = f
      if (f <= n) cycle
      n = f
      first(n) = i
    end do
    do f = 1, n - 1
      do g = f + 1, n
        if (friction(first(f), first(g)) < 0) cycle
        pair = [pair, contact_pair([f, g], friction(first(f), first(g)), trim(label(name, field, f))//'.'//label(name, field, g))]
      end do
    end do
  end subroutine choose_fields

  !> True if two bodies stick to each other and have the same contacts with all others.
  pure logical function alike(friction, i, j)
    real(wp), intent(in) :: friction(:, :)
    integer, intent(in) :: i, j
    integer :: k
    alike = friction(i, j) < 0
    do k = 1, size(friction, 1)
      if (k == i .or. k == j) cycle
      alike = alike .and. .not. abs(friction(i, k) - friction(j, k)) > 0
    end do
  end function alike

  !> Name of a field: of its body, or of the first of them and how many there are besides.
  pure function label(name, field, f) result(text)
    character(*), intent(in) :: name(:)
    integer, intent(in) :: field(:), f
    character(:), allocatable :: text
    character(8) :: others
    text = trim(name(findloc(field, f, dim=1)))
    if (count(field == f) == 1) return
    write (others, '(i0)') count(field == f) - 1
    text = text//'+'//trim(others)
  end function label

end module contact_fields
