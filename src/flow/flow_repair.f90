!> Cells whose new state is no state: lifted where that can be done and counted, fatal where not.
module flow_repair
  use errors, only: fatal
  use flow_state, only: flow_type, repair_low_pressure
  use kinds, only: wp
  use mesh, only: mesh_type
  use mixture, only: close_cell
  use text, only: str
  implicit none
  private
  public :: repair_brick, count_repair, cell_centre

contains

  !> Looks for bad cells of local brick b in a buffer. A pressure that is finite but not above its lowest value is lifted to it, and
  !> the energy that this adds is left to show in the balance; anything else ends the run with the cell and its neighbours.
  subroutine repair_brick(mesh, flow, b, buffer)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: b, buffer
    real(wp) :: cell(flow%layout%n_rows), lowest
    integer :: i, j, k
    lowest = flow%lowest_pressure()
    do k = 1, mesh%brick_cells(3)
      do j = 1, mesh%brick_cells(2)
        do i = 1, mesh%brick_cells(1)
          if (allocated(flow%open(b)%a)) then
            if (.not. flow%open(b)%a(i, 1, j, k) > 0) cycle
          end if
          cell = flow%w(b, buffer)%a(i, :, j, k)
          if (good(cell(flow%layout%pressure_row), cell(flow%layout%sound_speed_row))) cycle
          if (all(abs(cell) <= huge(1.0_wp)) .and. cell(flow%layout%density_row) > 0) then
            cell(flow%layout%pressure_row) = max(cell(flow%layout%pressure_row), lowest + flow%floor_pressure)
            call close_cell(flow%layout, flow%eos, cell)
          end if
          if (.not. good(cell(flow%layout%pressure_row), cell(flow%layout%sound_speed_row))) &
            call fatal(description(mesh, flow, b, buffer, [i, j, k]))
          flow%w(b, buffer)%a(i, :, j, k) = cell
          call count_repair(mesh, flow, repair_low_pressure, 1, b, [i, j, k])
        end do
      end do
    end do
  contains
    pure logical function good(p, c)
      real(wp), intent(in) :: p, c
      good = p > lowest .and. c > 0 .and. c <= huge(1.0_wp)
    end function good
  end subroutine repair_brick

  !> Adds to the count of a kind of repair. cell: the last cell concerned, of local brick b.
  subroutine count_repair(mesh, flow, kind, n, b, cell)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: kind, n, b, cell(3)
    if (n == 0) return
    flow%repairs%count(kind) = flow%repairs%count(kind) + n
    flow%repairs%position(:, kind) = cell_centre(mesh, b, cell)
  end subroutine count_repair

  !> Centre of a cell of local brick b.
  pure function cell_centre(mesh, b, cell) result(position)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: b, cell(3)
    real(wp) :: position(3)
    position = mesh%brick(mesh%local(b))%origin + (cell - 0.5_wp)*mesh%spacing
  end function cell_centre

  !> The cell, where it is, its state and its neighbours', in words.
  function description(mesh, flow, b, buffer, cell) result(message)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: b, buffer, cell(3)
    character(:), allocatable :: message
    character(*), parameter :: line = new_line('a')//'  '
    integer :: d, side, k, next(3)
    real(wp) :: position(3)
    position = cell_centre(mesh, b, cell)
    message = 'flow: no valid state in cell '//triple(mesh%brick(mesh%local(b))%location*mesh%brick_cells + cell)//' at '// &
      str(position(1))//' '//str(position(2))//' '//str(position(3))//line//'here   '//state(cell)
    do d = 1, 3
      if (.not. mesh%active(d)) cycle
      do side = -1, 1, 2
        next = cell
        next(d) = next(d) + side
        message = message//line//'xyz'(d:d)//merge(' below', ' above', side < 0)//' '//state(next)
      end do
    end do
    do k = 1, flow%n_materials
      message = message//line//'material '//str(k)//' is '//trim(flow%name(k))
    end do
  contains
    function triple(i) result(text)
      integer, intent(in) :: i(3)
      character(:), allocatable :: text
      text = '('//str(i(1))//', '//str(i(2))//', '//str(i(3))//')'
    end function triple
    function state(at) result(text)
      integer, intent(in) :: at(3)
      character(:), allocatable :: text
      integer :: q
      associate (w => flow%w(b, buffer)%a, layout => flow%layout)
        text = 'p '//str(w(at(1), layout%pressure_row, at(2), at(3)))//', velocity'
        do q = 1, 3
          text = text//' '//str(w(at(1), layout%velocity(q), at(2), at(3)))
        end do
        text = text//', partial densities'
        do q = 1, layout%n_materials
          text = text//' '//str(w(at(1), q, at(2), at(3)))
        end do
        if (layout%n_materials > 1) text = text//', fractions'
        do q = 1, layout%n_fractions
          text = text//' '//str(w(at(1), layout%fraction(q), at(2), at(3)))
        end do
      end associate
    end function state
  end function description

end module flow_repair
