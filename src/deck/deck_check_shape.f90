!> Shapes of regions, bodies and holes: their keys are complete, they lie where the domain is, and which points they hold.
!> In a dimension of one cell a shape has no say: its numbers there are set to what stands for "all of it".
module deck_check_shape
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use deck_mesh, only: mesh_group
  use deck_problems, only: problem_list
  use text, only: join
  implicit none
  private
  public :: check_shape, check_point, check_axis, inside_shape

  !> The numbers of a shape, whichever group they come from; those of other shapes are unset.
  type, public :: shape_type
    character(word_length) :: kind = ''
    real(wp) :: lower(3) = unset, upper(3) = unset
    real(wp) :: center(3) = unset, radius = unset
    real(wp) :: start(3) = unset, end(3) = unset
    real(wp) :: point(3) = unset, normal(3) = unset
  end type shape_type

  character, parameter :: axis_name(3) = ['x', 'y', 'z']

contains

  !> Checks a shape and fills in the dimensions that are not computed.
  subroutine check_shape(shape, mesh, table, problems, warnings)
    type(shape_type), intent(inout) :: shape
    type(mesh_group), intent(in) :: mesh
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    character(8), parameter :: all_keys(8) = &
      [character(8) :: 'lower', 'upper', 'center', 'radius', 'start', 'end', 'point', 'normal']
    character(8), allocatable :: needed(:)
    logical :: missing(size(all_keys)), complete
    integer :: i
    if (shape%kind == '') return
    allocate (needed, source=keys_of_shape(shape%kind))
    missing = .false.
    do i = 1, size(all_keys)
      if (any(needed == all_keys(i))) then
        missing(i) = .not. table%is_given(trim(all_keys(i)))
      else if (table%is_given(trim(all_keys(i)))) then
        call problems%add_at_key(table, trim(all_keys(i)), 'a shape '''//trim(shape%kind)//''' has none'// &
          needs_text(shape%kind, needed))
      end if
    end do
    if (any(missing)) then
      call problems%add_at_key(table, 'shape', 'a shape '''//trim(shape%kind)//''' also needs '// &
        join(pack(all_keys, missing), ', '))
      return
    end if
    complete = .true.
    do i = 1, size(needed)
      select case (needed(i))
      case ('lower')
        call check_point(shape%lower, mesh%lower, 'lower', mesh, table, problems, complete)
      case ('upper')
        call check_point(shape%upper, mesh%upper, 'upper', mesh, table, problems, complete)
      case ('center')
        call check_point(shape%center, middle(mesh), 'center', mesh, table, problems, complete)
      case ('point')
        call check_point(shape%point, middle(mesh), 'point', mesh, table, problems, complete)
      case ('normal')
        call check_point(shape%normal, [0.0_wp, 0.0_wp, 0.0_wp], 'normal', mesh, table, problems, complete)
      end select
    end do
    if (any(shape%kind == [character(8) :: 'cylinder', 'ogive'])) call check_axis(shape%start, shape%end, mesh, table, problems, &
      complete)
    if (.not. complete) return
    if (shape%kind == 'box') then
      do i = 1, 3
        if (shape%upper(i) <= shape%lower(i)) call problems%add_at_key(table, 'upper', &
          'upper is not above lower in '//axis_name(i))
      end do
    else if (shape%kind == 'half_space') then
      if (.not. any(abs(shape%normal) > 0.0_wp)) call problems%add_at_key(table, 'normal', 'the normal has no length')
    end if
    call check_place(shape, mesh, table, warnings)
  end subroutine check_shape

  pure function keys_of_shape(kind) result(keys)
    character(*), intent(in) :: kind
    character(8), allocatable :: keys(:)
    keys = [character(8) ::]
    select case (kind)
    case ('box')
      keys = [character(8) :: 'lower', 'upper']
    case ('sphere')
      keys = [character(8) :: 'center', 'radius']
    case ('cylinder', 'ogive')
      keys = [character(8) :: 'start', 'end', 'radius']
    case ('half_space')
      keys = [character(8) :: 'point', 'normal']
    end select
  end function keys_of_shape

  pure function needs_text(kind, needed) result(text)
    character(*), intent(in) :: kind, needed(:)
    character(:), allocatable :: text
    text = ''
    if (kind /= 'all') text = '; it has '//join(needed, ', ')
  end function needs_text

  pure function middle(mesh)
    type(mesh_group), intent(in) :: mesh
    real(wp) :: middle(3)
    middle = 0
    where (mesh%upper > unset) middle = 0.5_wp*mesh%lower + 0.5_wp*mesh%upper
  end function middle

  !> Computed dimensions must be given; the others take the value of `otherwise`. complete becomes false if one is missing.
  subroutine check_point(point, otherwise, key, mesh, table, problems, complete)
    real(wp), intent(inout) :: point(3)
    real(wp), intent(in) :: otherwise(3)
    character(*), intent(in) :: key
    type(mesh_group), intent(in) :: mesh
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical, intent(inout) :: complete
    character(:), allocatable :: missing
    missing = missing_elements(point, mesh)
    if (missing /= '') then
      complete = .false.
      ! a value that could not be read was reported already, and counts as given
      if (.not. all_given(table, key, mesh)) call problems%add_at_key(table, key, 'no number for '//missing)
    end if
    where (.not. mesh%active()) point = otherwise
  end subroutine check_point

  pure logical function all_given(table, key, mesh)
    type(key_table), intent(in) :: table
    character(*), intent(in) :: key
    type(mesh_group), intent(in) :: mesh
    integer :: k
    k = table%find(key)
    all_given = k > 0
    if (k > 0) all_given = all(table%key(k)%given .or. .not. mesh%active())
  end function all_given

  ! Names of the computed dimensions in which the point is not set: 'y, z'.
  pure function missing_elements(point, mesh) result(names)
    real(wp), intent(in) :: point(3)
    type(mesh_group), intent(in) :: mesh
    character(:), allocatable :: names
    names = join(pack(axis_name, mesh%active() .and. .not. point > unset), ', ')
  end function missing_elements

  !> Checks the ends of an axis. It may point along a dimension that is not computed, if it says so.
  subroutine check_axis(start, end, mesh, table, problems, complete)
    real(wp), intent(inout) :: start(3), end(3)
    type(mesh_group), intent(in) :: mesh
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    logical, intent(inout) :: complete
    real(wp) :: given_start(3), given_end(3)
    given_start = start
    given_end = end
    call check_point(start, middle(mesh), 'start', mesh, table, problems, complete)
    call check_point(end, middle(mesh), 'end', mesh, table, problems, complete)
    where (given_start > unset .and. given_end > unset .and. abs(given_start - given_end) > 0.0_wp)
      start = given_start
      end = given_end
    end where
    if (.not. complete) return
    if (.not. any(abs(end - start) > 0.0_wp)) call problems%add_at_key(table, 'end', 'start and end are the same point')
  end subroutine check_axis

  subroutine check_place(shape, mesh, table, warnings)
    type(shape_type), intent(in) :: shape
    type(mesh_group), intent(in) :: mesh
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: warnings
    real(wp) :: low(3), high(3)
    select case (shape%kind)
    case ('box')
      low = shape%lower
      high = shape%upper
    case ('sphere')
      low = shape%center - shape%radius
      high = shape%center + shape%radius
    case ('cylinder', 'ogive')
      low = min(shape%start, shape%end) - shape%radius
      high = max(shape%start, shape%end) + shape%radius
    case default
      return
    end select
    if (any(mesh%active() .and. mesh%upper > unset .and. (high <= mesh%lower .or. low >= mesh%upper))) &
      call warnings%add_at_key(table, 'shape', 'this '//trim(shape%kind)//' lies outside of the domain')
  end subroutine check_place

  !> True if the point lies in the shape (which must have passed its check).
  pure logical function inside_shape(shape, point) result(inside)
    type(shape_type), intent(in) :: shape
    real(wp), intent(in) :: point(3)
    real(wp) :: axis(3), along
    inside = .false.
    select case (shape%kind)
    case ('all')
      inside = .true.
    case ('box')
      inside = all(point >= shape%lower .and. point <= shape%upper)
    case ('sphere')
      inside = norm2(point - shape%center) <= shape%radius
    case ('cylinder', 'ogive')
      axis = shape%end - shape%start
      along = dot_product(point - shape%start, axis)/dot_product(axis, axis)
      inside = along >= 0.0_wp .and. along <= 1.0_wp .and. norm2(point - shape%start - along*axis) <= shape%radius
    case ('half_space')
      inside = dot_product(point - shape%point, shape%normal) <= 0.0_wp
    end select
  end function inside_shape

end module deck_check_shape
