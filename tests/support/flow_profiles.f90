!> What is read off a scene of flow: density, velocity and pressure of all cells, and where something crosses a level.
module flow_profiles
  use flow_scenes, only: flow_scene
  use kinds, only: wp
  use mixture, only: cell_fractions
  implicit none
  private
  public :: profile_of, coarse_profile, all_positive, crossing, fraction_profile, front_distance

  !> All cells of a scene, x fastest.
  type, public :: profile_type
    real(wp), allocatable :: x(:, :) !< centres (3, cells)
    real(wp), allocatable :: state(:, :) !< density, velocity and pressure (5, cells)
  end type profile_type

contains

  !> The cells of a scene on one rank. along: the direction of the mesh that the problem's x points to.
  function profile_of(scene, along) result(profile)
    type(flow_scene), intent(in) :: scene
    integer, intent(in), optional :: along
    type(profile_type) :: profile
    integer :: b, i, j, k, q, turn, cell(3)
    turn = 0
    if (present(along)) turn = along - 1
    allocate (profile%x(3, product(scene%mesh%cells)), profile%state(5, product(scene%mesh%cells)))
    do b = 1, scene%mesh%n_local
      associate (n => scene%mesh%brick_cells, all => scene%mesh%cells, &
                 w => scene%flow%w(scene%flow%holder(b), scene%flow%current)%a, &
        brick => scene%mesh%brick(scene%mesh%local(b)), layout => scene%flow%layout)
        do k = 1, n(3)
          do j = 1, n(2)
            do i = 1, n(1)
              cell = brick%location*n + [i, j, k]
              q = cell(1) + all(1)*(cell(2) - 1 + all(2)*(cell(3) - 1))
              profile%x(:, q) = cshift(brick%origin + ([i, j, k] - 0.5_wp)*scene%mesh%spacing, turn)
              profile%state(1, q) = w(i, layout%density(), j, k)
              profile%state(2:4, q) = cshift(w(i, layout%velocity(1):layout%velocity(3), j, k), turn)
              profile%state(5, q) = w(i, layout%pressure(), j, k)
            end do
          end do
        end do
      end associate
    end do
  end function profile_of

  !> Means of a fine profile in one dimension over n cells that it divides.
  function coarse_profile(fine, n) result(state)
    type(profile_type), intent(in) :: fine
    integer, intent(in) :: n
    real(wp) :: state(5, n)
    integer :: i, share
    share = size(fine%x, 2)/n
    do i = 1, n
      state(:, i) = sum(fine%state(:, (i - 1)*share + 1:i*share), 2)/share
    end do
  end function coarse_profile

  !> Whether every cell has positive densities, fractions between 0 and 1 and a pressure and sound speed that exist.
  logical function all_positive(scene)
    type(flow_scene), intent(in) :: scene
    real(wp) :: cell(scene%flow%layout%n_rows), a(scene%flow%n_materials)
    integer :: b, i, j, k
    all_positive = .true.
    associate (layout => scene%flow%layout, n => scene%mesh%brick_cells)
      do b = 1, scene%mesh%n_local
        do k = 1, n(3)
          do j = 1, n(2)
            do i = 1, n(1)
              cell = scene%flow%w(scene%flow%holder(b), scene%flow%current)%a(i, :, j, k)
              a = cell_fractions(layout, cell)
              all_positive = all_positive .and. all(abs(cell) <= huge(1.0_wp)) .and. all(cell(:layout%n_materials) >= 0) .and. &
                cell(layout%density()) > 0 .and. all(a >= 0 .and. a <= 1) .and. &
                cell(layout%pressure()) > scene%flow%lowest_pressure() .and. cell(layout%sound_speed()) > 0
            end do
          end do
        end do
      end do
    end associate
  end function all_positive

  !> Volume fraction of material k along x, in the first row of cells; of a scene in one brick along x.
  function fraction_profile(scene, k) result(fraction)
    type(flow_scene), intent(in) :: scene
    integer, intent(in) :: k
    real(wp) :: fraction(scene%mesh%cells(1)), a(scene%flow%n_materials)
    integer :: i
    do i = 1, size(fraction)
      a = cell_fractions(scene%flow%layout, scene%flow%w(1, scene%flow%current)%a(i, :, 1, 1))
      fraction(i) = a(k)
    end do
  end function fraction_profile

  !> Distance from the origin, the low corner, at which the pressure falls through a level, from outside towards the diagonal of the
  !> directions in `line`, by linear interpolation between cells in all directions. cells: of the profile; h: spacing. 0: nowhere.
  real(wp) function front_distance(profile, cells, h, line, level)
    type(profile_type), intent(in) :: profile
    integer, intent(in) :: cells(3)
    real(wp), intent(in) :: h, level
    logical, intent(in) :: line(3)
    real(wp), parameter :: step = 0.02_wp !< of the search, in spacings
    real(wp) :: ray(3), at(3)
    integer :: i
    ray = merge(1.0_wp, 0.0_wp, line)/sqrt(real(count(line), wp))
    do i = int(minval(cells, line)*sqrt(real(count(line), wp))/step), 1, -1
      at = max(ray*i*step, merge(0.5_wp, 0.0_wp, cells > 1)) ! not below the centres of the first cells
      if (pressure_at(at) > level) exit
    end do
    front_distance = merge(norm2(at)*h, 0.0_wp, i > 0)

  contains

    !> At a point given in spacings.
    pure real(wp) function pressure_at(at)
      real(wp), intent(in) :: at(3)
      real(wp) :: part(3), weight(0:1, 3)
      integer :: first(3), second(3), i, j, k, corner(3)
      first = max(1, min(int(at + 0.5_wp), cells - 1))
      second = min(first + 1, cells)
      part = min(max(at + 0.5_wp - first, 0.0_wp), 1.0_wp)
      weight(0, :) = 1 - part
      weight(1, :) = part
      pressure_at = 0
      do k = 0, 1
        do j = 0, 1
          do i = 0, 1
            corner = merge(second, first, [i, j, k] == 1)
            pressure_at = pressure_at + weight(i, 1)*weight(j, 2)*weight(k, 3) &
              *profile%state(5, corner(1) + cells(1)*(corner(2) - 1 + cells(2)*(corner(3) - 1)))
          end do
        end do
      end do
    end function pressure_at

  end function front_distance

  !> Position, counted in cells (1 is the centre of the first), where values cross the level: the last or the first. 0: nowhere.
  pure real(wp) function crossing(values, level, last)
    real(wp), intent(in) :: values(:), level
    logical, intent(in) :: last
    integer :: i, from, to, step
    crossing = 0
    from = merge(size(values) - 1, 1, last)
    to = merge(1, size(values) - 1, last)
    step = merge(-1, 1, last)
    do i = from, to, step
      if ((values(i) > level) .eqv. (values(i + 1) > level)) cycle
      crossing = i + (level - values(i))/(values(i + 1) - values(i))
      return
    end do
  end function crossing

end module flow_profiles
