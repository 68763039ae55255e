!> What fills a cell at the start: volumes of the regions and charges in it, and the one state that they make together.
module flow_filling
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use flow_shapes, only: filled_shape
  use kinds, only: wp
  use mixture, only: cell_from
  use relaxation_fallback, only: relax_cell
  implicit none
  private
  public :: share_of_regions, no_surface_cuts, mixed_cell, trace_density, halvings_for

  !> One region or charge: a shape and what it is filled with.
  type, public :: filling_type
    type(filled_shape) :: shape
    integer :: material = 0 !< of the flow
    real(wp) :: density = 0, pressure = 0, velocity(3) = 0
    integer :: halvings = 4 !< of a cell that its surface cuts
  end type filling_type

contains

  !> Part of the volume of a box that each filling shows in, later ones covering earlier ones; sum 1 where all is filled.
  pure subroutine share_of_regions(filling, center, width, share)
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: center(3), width(3)
    real(wp), intent(out) :: share(:)
    share = 0
    call add_shares(filling, center, width, 0, 1.0_wp, share)
  end subroutine share_of_regions

  !> True if no surface of a filling cuts a box, or comes near enough for round-off to matter: all boxes in it have the same shares.
  pure logical function no_surface_cuts(filling, center, width)
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: center(3), width(3)
    integer :: r
    no_surface_cuts = .true.
    do r = 1, size(filling)
      associate (shape => filling(r)%shape)
        if (abs(shape%distance(center)) < 0.500001_wp*norm2(merge(width, 0.0_wp, shape%active))) no_surface_cuts = .false.
      end associate
    end do
  end function no_surface_cuts

  pure recursive subroutine add_shares(filling, center, width, level, weight, share)
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: center(3), width(3), weight
    integer, intent(in) :: level
    real(wp), intent(inout) :: share(:)
    real(wp) :: half, d, left, part, whole, child(3), middle(3)
    integer :: r, i
    logical :: upper(3)
    left = weight
    do r = size(filling), 1, -1
      associate (shape => filling(r)%shape)
        half = 0.5_wp*norm2(merge(width, 0.0_wp, shape%active))
        d = shape%distance(center)
        if (d >= half) cycle
        if (d > -half) then
          if (level < filling(r)%halvings) then
            whole = shape%volume_of_box(center, width)
            child = merge(0.5_wp*width, width, shape%active)
            do i = 0, 7
              upper = [btest(i, 0), btest(i, 1), btest(i, 2)]
              if (any(upper .and. .not. shape%active)) cycle
              middle = center + merge(merge(0.25_wp, -0.25_wp, upper)*width, 0.0_wp, shape%active)
              call add_shares(filling(:r), middle, child, level + 1, left*(shape%volume_of_box(middle, child)/whole), share)
            end do
            return
          end if
          part = shape%part_of_box(center, width)
          share(r) = share(r) + part*left
          left = left*(1 - part)
          cycle
        end if
      end associate
      share(r) = share(r) + left
      return
    end do
  end subroutine add_shares

  !> How often to halve a cell of size h that the surface of a shape of size r cuts: to a fortieth of the shape, 1/16 at least.
  pure integer function halvings_for(r, h, dimensions)
    real(wp), intent(in) :: r, h
    integer, intent(in) :: dimensions
    integer, parameter :: least(3) = [8, 5, 4]
    halvings_for = min(max(least(dimensions), ceiling(log(40*h/r)/log(2.0_wp))), 8)
  end function halvings_for

  !> State of a cell from the shares of its fillings: masses, momentum and total energy are kept; different pressures are relaxed.
  !> Materials that are not there get the trace fraction and a density that fits the pressure (density(k), pressure(k): a state of
  !> each material on whose isentrope it lies).
  function mixed_cell(layout, eos, filling, share, trace, density, pressure) result(cell)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(:)
    type(filling_type), intent(in) :: filling(:)
    real(wp), intent(in) :: share(:), trace, density(:), pressure(:)
    real(wp) :: cell(layout%n_rows)
    real(wp), dimension(layout%n_materials) :: a, m, e, r
    real(wp) :: momentum(3), total, p, lowest, highest, weight
    integer :: i, k, n
    n = layout%n_materials
    a = 0; m = 0; e = 0; momentum = 0; total = 0
    lowest = huge(1.0_wp); highest = -huge(1.0_wp)
    do i = 1, size(filling)
      if (.not. share(i) > 0) cycle
      associate (f => filling(i))
        k = f%material
        a(k) = a(k) + share(i)
        m(k) = m(k) + share(i)*f%density
        e(k) = e(k) + share(i)*f%density*(eos(k)%energy(f%density, f%pressure) - offset(k))
        momentum = momentum + share(i)*f%density*f%velocity
        total = total + share(i)*f%density*0.5_wp*sum(f%velocity**2)
        lowest = min(lowest, f%pressure)
        highest = max(highest, f%pressure)
      end associate
    end do
    total = total - 0.5_wp*sum(momentum**2)/sum(m) ! what the velocities lose by becoming one heats the cell
    p = lowest
    if (highest > lowest .or. total > 1e-12_wp*sum(abs(e))) then
      where (m > 0) e = e + total*m/sum(m)
      call relax_present()
    end if
    do k = 1, n
      if (a(k) > 0) r(k) = m(k)/a(k)
      if (.not. a(k) > 0) r(k) = trace_density(eos(k), density(k), pressure(k), p)
    end do
    weight = sum(max(a, trace))
    cell = cell_from(layout, eos, r, max(a, trace)/weight, momentum/sum(m), p)
  contains
    pure real(wp) function offset(k)
      integer, intent(in) :: k
      offset = 0
      if (eos(k)%is_gas) offset = eos(k)%gas%energy_offset
    end function offset
    !> One pressure for the materials that are there, at the energy that they have together.
    subroutine relax_present()
      integer :: list(layout%n_materials), j, c
      real(wp) :: ap(layout%n_materials), capacity, energy
      c = 0
      do j = 1, n
        if (.not. a(j) > 0) cycle
        c = c + 1
        list(c) = j
      end do
      ap(:c) = a(list(:c))
      if (c > 1) then
        call relax_cell(eos(list(:c)), m(list(:c)), e(list(:c)), ap(:c), p)
        a(list(:c)) = ap(:c)
      end if
      capacity = 0
      energy = sum(e)
      do j = 1, n
        if (.not. a(j) > 0) cycle
        capacity = capacity + a(j)*eos(j)%over_g
        energy = energy + a(j)*eos(j)%over_g*reference(j)
      end do
      p = energy/capacity
    end subroutine relax_present
    !> f of p = f(r) + g r e.
    pure real(wp) function reference(j)
      integer, intent(in) :: j
      if (eos(j)%is_gas) then
        reference = -eos(j)%gas%gamma*eos(j)%gas%p_infinity
      else
        reference = eos(j)%pressure(m(j)/a(j), 0.0_wp)
      end if
    end function reference
  end function mixed_cell

  !> Density of a material at pressure p on the isentrope through (density, pressure), within bounds that keep it sensible.
  pure real(wp) function trace_density(eos, density, pressure, p)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: density, pressure, p
    real(wp) :: lowest
    lowest = merge(-eos%gas%p_infinity, 0.0_wp, eos%is_gas)
    trace_density = eos%isentrope_density(density, pressure, max(p, lowest + 1e-9_wp*abs(pressure - lowest)))
    trace_density = min(max(trace_density, 1e-6_wp*density), 3*density)
  end function trace_density

end module flow_filling
