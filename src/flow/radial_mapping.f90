!> A blast that has been computed on a fine mesh of its own, in shells around its centre or in shells around an axis that are cut
!> into layers, is laid into the cells of a scene.
!>
!> Each cell gets the sums over the parts of shells in it: masses, momentum and total energy as they are, volume fractions as shares
!> of its volume; its pressure is the one that goes with them. So a region of one pressure at rest keeps it, whatever lies in it.
!> What keeps all sums exact is one correction of the volumes: with C the volume of a cell within a sphere, found by cutting the
!> cell up, and B the true volume of the ball in the domain,  C' = C + (B - sum C) C (V - C)/sum C (V - C).  Each shell then has its
!> volume, and each cell its own, to round-off. C' grows with the radius as C does. Layers are cut exactly, so with them the same is
!> done across the axis alone, where balls are discs.
!>
!> Momentum: the radial momentum P of the shells leaves, along a direction d of the mesh and on one side of the centre, the momentum
!> P <|n_d|>/2 (a quarter of P in three dimensions). That along an axis goes over as it is. The sums over the cells are brought to
!> that, cell by cell in proportion to the size of their momentum; what changes in kinetic energy is taken from the heat.
module radial_mapping
  use constants, only: pi
  use flow_layout, only: book_afterburn
  use flow_state, only: flow_type, face_symmetry
  use geometry, only: cell_volumes
  use kinds, only: wp
  use mesh, only: mesh_type
  use mixture, only: cell_energies, cell_fractions, cell_from, close_cell
  use radial_profile, only: blast_type, radial_profile_type
  use radial_shells, only: shells_of_box, volume_of_ball
  use reductions, only: reduce_sum
  use sleeping_bricks, only: wake
  implicit none
  private
  public :: map_profile, part_of_blast

  real(wp), parameter :: on_plane = 1e-6_wp !< of a cell: planes of the mesh this near to the centre pass through it
  integer, parameter :: at_once = 256 !< shells whose volumes are summed over all bricks together

contains

  !> Replaces the flow around the centre of a blast; the last shell of its last layer and all beyond are still. Materials are those
  !> of the flow, in its order. To be called by all ranks; the same bits on any number of them.
  subroutine map_profile(mesh, flow, blast)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(blast_type), intent(in) :: blast
    real(wp) :: correction(size(blast%profile%state, 2)), radial_momentum
    logical :: is_hit(mesh%n_local)
    integer :: b
    correction = corrections(mesh, flow, blast)
    call fill_cells(mesh, flow, blast, correction, is_hit, radial_momentum)
    call set_momentum(mesh, flow, blast, radial_momentum, is_hit)
    do b = 1, mesh%n_local
      if (mesh%local(b) == 1) flow%books(flow%layout%energy_flux, book_afterburn, b) = &
        flow%books(flow%layout%energy_flux, book_afterburn, b) + blast%profile%afterburnt*part_of_blast(mesh, flow, blast)
    end do
  end subroutine map_profile

  !> Part of a blast that lies in the domain: symmetry planes through its centre halve it. Layers know of those across the axis.
  pure real(wp) function part_of_blast(mesh, flow, blast) result(part)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(blast_type), intent(in) :: blast
    part = 0.5_wp**count(halved(mesh, flow, blast))
  end function part_of_blast

  !> Directions in which the shells lie.
  pure function across(mesh, blast)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast
    logical :: across(3)
    across = mesh%active .and. [1, 2, 3] /= blast%axis
  end function across

  !> Directions of shells in which a symmetry plane passes through the centre; a radius of the mesh has the whole turn.
  pure function halved(mesh, flow, blast)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(blast_type), intent(in) :: blast
    logical :: halved(3)
    halved = (abs(blast%center - mesh%lower) <= on_plane*mesh%spacing .and. flow%face(1, :) == face_symmetry) &
             .or. (abs(blast%center - mesh%upper) <= on_plane*mesh%spacing .and. flow%face(2, :) == face_symmetry)
    halved = halved .and. across(mesh, blast)
    if (mesh%radial_power > 0) halved(1) = .false.
  end function halved

  !> Centre of a cell of local brick b, from the centre of the blast.
  pure function place_of(mesh, center, b, cell) result(x)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: center(3)
    integer, intent(in) :: b, cell(3)
    real(wp) :: x(3)
    x = mesh%lower + (mesh%brick(mesh%local(b))%location*mesh%brick_cells + cell - 0.5_wp)*mesh%spacing - center
    if (mesh%radial_power > 0) x(1) = x(1) + center(1)
  end function place_of

  !> Cells along x, y, z of a brick that stand for all cells of it that have the same shares of shells, and how many those are.
  pure subroutine columns_of_brick(mesh, blast, columns, n_along)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast
    integer, intent(out) :: columns(3), n_along
    columns = mesh%brick_cells
    n_along = 1
    if (blast%axis == 0) return
    n_along = columns(blast%axis)
    columns(blast%axis) = 1
  end subroutine columns_of_brick

  !> For each shell (B - sum C)/sum C (V - C)/V at its outer radius; the same on every rank.
  function corrections(mesh, flow, blast) result(correction)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(blast_type), intent(in) :: blast
    real(wp) :: correction(size(blast%profile%state, 2))
    real(wp), allocatable :: partial(:, :, :), volume(:), way(:, :)
    real(wp) :: total(2*at_once), within, length, whole(mesh%brick_cells(1))
    integer :: b, i, j, k, s, n, first, last, columns(3), n_along
    n = size(correction)
    allocate (partial(2, n, mesh%n_local), source=0.0_wp)
    call columns_of_brick(mesh, blast, columns, n_along)
    do b = 1, mesh%n_local
      whole = cell_volumes(mesh, b)
      do k = 1, columns(3)
        do j = 1, columns(2)
          do i = 1, columns(1)
            call shells_of_box(place_of(mesh, blast%center, b, [i, j, k]), mesh%spacing, across(mesh, blast), mesh%radial_power, &
                               blast%profile%thickness, n, first, last, volume, way)
            within = 0
            do s = first, last
              within = within + volume(s - first + 1)
              partial(1, s, b) = partial(1, s, b) + n_along*volume(s - first + 1)
              partial(2, s, b) = partial(2, s, b) + n_along*within*max(1 - within/whole(i), 0.0_wp)
            end do
          end do
        end do
      end do
    end do
    length = 1
    if (blast%axis > 0) length = mesh%cells(blast%axis)*mesh%spacing(blast%axis)
    length = length*part_of_blast(mesh, flow, blast)
    within = 0
    do first = 1, n, at_once
      last = min(first + at_once - 1, n)
      call reduce_sum(mesh, reshape(partial(:, first:last, :), [2*(last - first + 1), mesh%n_local]), &
                      total(:2*(last - first + 1)))
      do s = first, last
        within = within + total(2*(s - first) + 1)
        correction(s) = 0
        if (total(2*(s - first) + 2) > 0) correction(s) = (length*volume_of_ball(blast%profile%radial_power, &
          s*blast%profile%thickness) - within)/total(2*(s - first) + 2)
      end do
    end do
  end function corrections

  !> The states of all cells that the blast has changed. is_hit: local bricks with such cells; radial_momentum: of the whole blast.
  subroutine fill_cells(mesh, flow, blast, correction, is_hit, radial_momentum)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(blast_type), intent(in) :: blast
    real(wp), intent(in) :: correction(:)
    logical, intent(out) :: is_hit(:)
    real(wp), intent(out) :: radial_momentum
    real(wp), allocatable :: volume(:), way(:, :), shell(:, :, :), radial(:, :, :), share(:), part(:)
    logical, allocatable :: is_still(:, :)
    real(wp) :: content(2*flow%n_materials + 3), momentum(3), along(3), whole(mesh%brick_cells(1)), inner, outer, within
    integer :: b, i, j, k, l, s, m, first, last, lowest, highest, columns(3), n_along, cell(3)
    call open_profile(flow, blast%profile, shell, radial, is_still, radial_momentum)
    along = merge(1.0_wp, 0.0_wp, [1, 2, 3] == blast%axis)
    call columns_of_brick(mesh, blast, columns, n_along)
    is_hit = .false.
    do b = 1, mesh%n_local
      whole = cell_volumes(mesh, b)
      do k = 1, columns(3)
        do j = 1, columns(2)
          do i = 1, columns(1)
            cell = [i, j, k]
            call shells_of_box(place_of(mesh, blast%center, b, cell), mesh%spacing, across(mesh, blast), mesh%radial_power, &
                               blast%profile%thickness, size(correction), first, last, volume, way)
            if (first > last) cycle
            share = volume(:last - first + 1)
            within = 0
            outer = 0
            do s = first, last
              inner = outer
              within = within + volume(s - first + 1)
              outer = corrected(within, whole(i), correction(s))
              share(s - first + 1) = (outer - inner)/whole(i)
              way(:, s - first + 1) = way(:, s - first + 1)/max(volume(s - first + 1), tiny(1.0_wp))
            end do
            do l = 1, n_along
              if (blast%axis > 0) cell(blast%axis) = l
              call layers_of_cell(mesh, blast, place_of(mesh, blast%center, b, cell), lowest, highest, part)
              if (lowest > highest) cycle
              if (all(is_still(first:last, lowest:highest))) cycle ! as the cell is
              if (.not. is_hit(b)) call wake(flow, b)
              is_hit(b) = .true.
              associate (state => flow%w(b, flow%current)%a(cell(1), :, cell(2), cell(3)), over => sum(share)*sum(part))
                ! what the blast leaves of the cell keeps its state
                call open_state(flow, state, content, momentum)
                content = (1 - over)*content
                momentum = (1 - over)*momentum
                do m = lowest, highest
                  do s = first, last
                    inner = share(s - first + 1)*part(m - lowest + 1)
                    content = content + inner*shell(:, s, m)
                    momentum = momentum + inner*(radial(1, s, m)*way(:, s - first + 1) + radial(2, s, m)*along)
                  end do
                end do
                state = closed_state(flow, content, momentum)
              end associate
            end do
          end do
        end do
      end do
    end do
  end subroutine fill_cells

  !> All cells of a profile as what they hold. radial: momentum per volume along the radius and the axis; is_still: where the state
  !> is that of the outermost cell; radial_momentum: of all of it.
  subroutine open_profile(flow, profile, shell, radial, is_still, radial_momentum)
    type(flow_type), intent(in) :: flow
    type(radial_profile_type), intent(in) :: profile
    real(wp), allocatable, intent(out) :: shell(:, :, :), radial(:, :, :)
    logical, allocatable, intent(out) :: is_still(:, :)
    real(wp), intent(out) :: radial_momentum
    real(wp) :: height, of_layer
    integer :: s, m, n(3)
    n = shape(profile%state)
    allocate (shell(2*flow%n_materials + 3, n(2), n(3)), radial(3, n(2), n(3)), is_still(n(2), n(3)))
    height = 1
    if (profile%has_layers()) height = profile%height
    radial_momentum = 0
    do m = 1, n(3)
      of_layer = 0
      do s = 1, n(2)
        associate (state => profile%state(:, s, m))
          call open_state(flow, state, shell(:, s, m), radial(:, s, m))
          is_still(s, m) = all(abs(state - profile%state(:, n(2), n(3))) <= 0)
        end associate
        of_layer = of_layer + radial(1, s, m)*(volume_of_ball(profile%radial_power, s*profile%thickness) &
                                               - volume_of_ball(profile%radial_power, (s - 1)*profile%thickness))
      end do
      radial_momentum = radial_momentum + height*of_layer
    end do
  end subroutine open_profile

  !> The layers that have a part of a cell at x, none if lowest > highest, and those parts; shells that are not cut have one.
  subroutine layers_of_cell(mesh, blast, x, lowest, highest, part)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast
    real(wp), intent(in) :: x(3)
    integer, intent(out) :: lowest, highest
    real(wp), allocatable, intent(inout) :: part(:)
    real(wp) :: low, high
    integer :: m
    lowest = 1
    highest = 1
    if (blast%axis == 0) then
      part = [1.0_wp]
      return
    end if
    associate (profile => blast%profile, h => mesh%spacing(blast%axis))
      low = x(blast%axis) - 0.5_wp*h - profile%bottom
      high = x(blast%axis) + 0.5_wp*h - profile%bottom
      lowest = max(floor(low/profile%height) + 1, 1)
      highest = min(ceiling(high/profile%height), size(profile%state, 3))
      part = [(max(min(high, m*profile%height) - max(low, (m - 1)*profile%height), 0.0_wp)/h, m=lowest, highest)]
    end associate
  end subroutine layers_of_cell

  pure real(wp) function corrected(within, whole, correction)
    real(wp), intent(in) :: within, whole, correction
    corrected = within*(1 + correction*max(1 - within/whole, 0.0_wp))
  end function corrected

  !> What a state holds per volume: masses and fractions of the materials, the sum of fractions over Grueneisen's constants and
  !> that times the pressure, internal and kinetic energy; and the momentum.
  pure subroutine open_state(flow, cell, content, momentum)
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: cell(:)
    real(wp), intent(out) :: content(:), momentum(3)
    integer :: n
    n = flow%n_materials
    associate (layout => flow%layout, u => cell(flow%layout%velocity_row:flow%layout%velocity_row + 2))
      content(:n) = cell(:n)
      content(n + 1:2*n) = cell_fractions(layout, cell)
      content(2*n + 1) = sum(content(n + 1:2*n)*flow%eos%over_g)
      content(2*n + 2) = content(2*n + 1)*cell(layout%pressure_row)
      content(2*n + 3) = sum(cell_energies(layout, flow%eos, cell)) + 0.5_wp*cell(layout%density_row)*sum(u**2)
      momentum = cell(layout%density_row)*u
    end associate
  end subroutine open_state

  !> The state that holds these. The pressure is written as a deviation from the mean one, so that one pressure stays one.
  pure function closed_state(flow, content, momentum) result(cell)
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: content(:), momentum(3)
    real(wp) :: cell(flow%layout%n_rows), a(flow%n_materials), u(3)
    integer :: n
    n = flow%n_materials
    a = content(n + 1:2*n)/sum(content(n + 1:2*n))
    u = momentum/sum(content(:n))
    cell = cell_from(flow%layout, flow%eos, content(:n)/a, a, u, content(2*n + 2)/content(2*n + 1))
    associate (p => cell(flow%layout%pressure_row))
      p = p + (content(2*n + 3) - 0.5_wp*sum(momentum*u) - sum(cell_energies(flow%layout, flow%eos, cell))) &
          /sum(a*flow%eos%over_g)
    end associate
    call close_cell(flow%layout, flow%eos, cell)
  end function closed_state

  !> Brings the momentum on each side of the centre to what the radial momentum of the blast leaves there.
  subroutine set_momentum(mesh, flow, blast, radial_momentum, is_hit)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(inout) :: flow
    type(blast_type), intent(in) :: blast
    real(wp), intent(in) :: radial_momentum
    logical, intent(in) :: is_hit(:)
    real(wp) :: excess(2, 3)
    integer :: b, i, j, k
    excess = momentum_excess(mesh, flow, blast, radial_momentum, is_hit)
    do b = 1, mesh%n_local
      if (.not. is_hit(b)) cycle
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            call change_velocity(flow, place_of(mesh, blast%center, b, [i, j, k]), excess, &
                                 flow%w(b, flow%current)%a(i, :, j, k))
          end do
        end do
      end do
    end do
  end subroutine set_momentum

  !> What is missing of the momentum away from the centre, over the sum of the sizes of the cells' momenta; side (low, high),
  !> direction.
  function momentum_excess(mesh, flow, blast, radial_momentum, is_hit) result(excess)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(blast_type), intent(in) :: blast
    real(wp), intent(in) :: radial_momentum
    logical, intent(in) :: is_hit(:)
    real(wp) :: excess(2, 3)
    real(wp) :: partial(12, mesh%n_local), total(12), away(2, 3), size_of(2, 3), volume(mesh%brick_cells(1)), momentum(3), x(3), &
      wanted
    integer :: b, i, j, k, d, q
    logical :: half(3), along_shells(3)
    partial = 0
    do b = 1, mesh%n_local
      if (.not. is_hit(b)) cycle
      volume = cell_volumes(mesh, b)
      do k = 1, mesh%brick_cells(3)
        do j = 1, mesh%brick_cells(2)
          do i = 1, mesh%brick_cells(1)
            associate (cell => flow%w(b, flow%current)%a(i, :, j, k), u => flow%layout%velocity_row)
              momentum = volume(i)*cell(flow%layout%density_row)*cell(u:u + 2)
            end associate
            x = place_of(mesh, blast%center, b, [i, j, k])
            do d = 1, 3
              q = 2*d - 2 + side_of(x(d))
              partial(q, b) = partial(q, b) + way_of(x(d))*momentum(d)
              partial(q + 6, b) = partial(q + 6, b) + abs(momentum(d))
            end do
          end do
        end do
      end do
    end do
    call reduce_sum(mesh, partial, total)
    away = reshape(total(:6), [2, 3])
    size_of = reshape(total(7:), [2, 3])
    along_shells = across(mesh, blast)
    half = halved(mesh, flow, blast)
    if (mesh%radial_power > 0) half(1) = .true. ! a radius has one side
    excess = 0
    do d = 1, 3
      if (.not. along_shells(d)) cycle
      wanted = radial_momentum*part_of_blast(mesh, flow, blast)*mean_way(count(along_shells), mesh%radial_power, d)
      if (.not. half(d)) wanted = 0.5_wp*wanted
      if (.not. (half(d) .or. passes_through(mesh, blast%center, d))) wanted = 0.5_wp*sum(away(:, d))
      where (size_of(:, d) > 0) excess(:, d) = (wanted - away(:, d))/size_of(:, d)
    end do
  end function momentum_excess

  !> Changes the velocity of a cell at x by excess parts of its size, at the same total energy.
  pure subroutine change_velocity(flow, x, excess, cell)
    type(flow_type), intent(in) :: flow
    real(wp), intent(in) :: x(3), excess(2, 3)
    real(wp), intent(inout) :: cell(:)
    real(wp) :: before
    integer :: d
    associate (layout => flow%layout, u => cell(flow%layout%velocity_row:flow%layout%velocity_row + 2))
      if (.not. any(abs(u) > 0)) return
      before = sum(u**2)
      do d = 1, 3
        u(d) = u(d) + way_of(x(d))*excess(side_of(x(d)), d)*abs(u(d))
      end do
      cell(layout%pressure_row) = cell(layout%pressure_row) + 0.5_wp*cell(layout%density_row)*(before - sum(u**2)) &
                                  /sum(cell_fractions(layout, cell)*flow%eos%over_g)
    end associate
    call close_cell(flow%layout, flow%eos, cell)
  end subroutine change_velocity

  pure integer function side_of(x)
    real(wp), intent(in) :: x
    side_of = merge(2, 1, x >= 0)
  end function side_of

  pure real(wp) function way_of(x)
    real(wp), intent(in) :: x
    way_of = merge(1.0_wp, -1.0_wp, x >= 0)
  end function way_of

  !> Mean over all directions of the size of the unit vector's part along d of the mesh. dimensions: of the mesh, in which shells
  !> lie.
  pure real(wp) function mean_way(dimensions, radial_power, d)
    integer, intent(in) :: dimensions, radial_power, d
    if (d == 1 .and. radial_power > 0 .and. dimensions == 1) then
      mean_way = 1
    else if (radial_power + dimensions == 2) then
      mean_way = 2/pi
    else
      mean_way = merge(pi/4, 0.5_wp, d == 1 .and. radial_power > 0)
    end if
  end function mean_way

  !> True if a plane between cells passes through the centre.
  pure logical function passes_through(mesh, center, d)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: center(3)
    integer, intent(in) :: d
    real(wp) :: place
    place = (center(d) - mesh%lower(d))/mesh%spacing(d)
    passes_through = abs(place - nint(place)) <= on_plane
  end function passes_through

end module radial_mapping
