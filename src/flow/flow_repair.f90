!> Cells whose new state is no state: marked, so that their stage is redone with first-order fluxes; if that does not help lifted
!> where that can be done and counted, fatal where not.
module flow_repair
  use blocks, only: block, allocate_cells
  use errors, only: fatal
  use flow_state, only: flow_type, repair_low_pressure, repair_first_order
  use halo, only: halo_type, fill
  use kinds, only: wp
  use mesh, only: mesh_type
  use material_rows, only: smallest_mass
  use mixture, only: close_cell
  use text, only: str
  implicit none
  private
  public :: repair_brick, count_repair, cell_centre, mark_troubled, none_troubled, troubled_around

contains

  !> Marks the troubled cells of a buffer, on all bricks and in their ghosts: 1, or 2 those that were marked and are still so.
  !> suspect: local bricks that have some; is_new: there are new marks. All ranks take part.
  subroutine mark_troubled(mesh, halo, flow, buffer, suspect, is_new)
    type(mesh_type), intent(in) :: mesh
    type(halo_type), intent(inout) :: halo
    type(flow_type), intent(inout) :: flow
    integer, intent(in) :: buffer
    logical, intent(in) :: suspect(:)
    logical, intent(out) :: is_new
    real(wp) :: lowest
    integer :: b, i, j, k
    is_new = .false.
    lowest = flow%lowest_pressure()
    if (.not. allocated(flow%troubled(mesh%n_local + 1)%a)) &
      call allocate_cells(flow%troubled(mesh%n_local + 1), mesh%brick_cells, mesh%ghost, 1, 0.0_wp)
    do b = 1, mesh%n_local
      if (.not. allocated(flow%troubled(b)%a)) then
        if (flow%w(b, buffer)%shares > 0) then
          flow%troubled(b)%shares = mesh%n_local + 1
        else
          call allocate_cells(flow%troubled(b), mesh%brick_cells, mesh%ghost, 1, 0.0_wp)
        end if
      end if
      if (.not. suspect(b)) cycle
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            if (is_closed(flow, b, i, j, k) .or. flow%troubled(b)%a(i, 1, j, k) > 1) cycle
            associate (cell => flow%w(b, buffer)%a(i, :, j, k))
              if (good(flow, cell, lowest) .and. (flow%n_materials == 1 .or. all(cell(:flow%n_materials) > smallest_mass))) cycle
            end associate
            is_new = .true.
            flow%troubled(b)%a(i, 1, j, k) = flow%troubled(b)%a(i, 1, j, k) + 1
            if (flow%troubled(b)%a(i, 1, j, k) < 2) call count_repair(mesh, flow, repair_first_order, 1, b, [i, j, k])
          end do
        end do
      end do
    end do
    call fill(mesh, halo, flow%troubled, 1, only_faces=.true.)
  end subroutine mark_troubled

  !> True if a brick or the cells around it hold marked cells.
  pure logical function troubled_around(troubled)
    type(block), intent(in) :: troubled
    troubled_around = allocated(troubled%a)
    if (troubled_around) troubled_around = any(troubled%a > 0)
  end function troubled_around

  !> Takes all marks away.
  subroutine none_troubled(flow)
    type(flow_type), intent(inout) :: flow
    integer :: b
    do b = 1, size(flow%troubled)
      if (allocated(flow%troubled(b)%a)) deallocate (flow%troubled(b)%a)
      flow%troubled(b)%shares = 0
    end do
  end subroutine none_troubled

  pure logical function is_closed(flow, b, i, j, k)
    type(flow_type), intent(in) :: flow
    integer, intent(in) :: b, i, j, k
    is_closed = .false.
    if (allocated(flow%open(b)%a)) is_closed = .not. flow%open(b)%a(i, 1, j, k) > 0
  end function is_closed

  !> Pressure above the lowest one, sound speed a positive number.
  pure logical function good(flow, cell, lowest)
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: cell(:), lowest
    associate (p => cell(flow%layout%pressure_row), c => cell(flow%layout%sound_speed_row))
      good = p > lowest .and. c > 0 .and. c <= huge(1.0_wp)
    end associate
    ! the sound speed is stored as the root of the absolute square
    if (good) good = cell(flow%layout%density_row) > 0
  end function good

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
          if (is_closed(flow, b, i, j, k)) cycle
          cell = flow%w(b, buffer)%a(i, :, j, k)
          if (good(flow, cell, lowest)) cycle
          if (all(abs(cell) <= huge(1.0_wp)) .and. cell(flow%layout%density_row) > 0) then
            cell(flow%layout%pressure_row) = max(cell(flow%layout%pressure_row), lowest + flow%floor_pressure)
            call close_cell(flow%layout, flow%eos, cell)
          end if
          if (.not. good(flow, cell, lowest)) &
            call fatal(description(mesh, flow, b, buffer, [i, j, k]))
          flow%w(b, buffer)%a(i, :, j, k) = cell
          call count_repair(mesh, flow, repair_low_pressure, 1, b, [i, j, k])
        end do
      end do
    end do
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
