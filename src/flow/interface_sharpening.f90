!> Sharp material interfaces: in mixed cells the volume fraction is a hyperbolic tangent, not a polynomial (THINC; Xiao, Honma &
!> Kono 2005), its steepness across the direction of the sweep that of the interface's normal (THINC/SW; Xiao, Ii & Chen 2011).
!> The densities of the materials on the faces keep their reconstructed values, so that pressure and velocity stay uniform across
!> a moving interface (Shyue & Xiao 2014).
module interface_sharpening
  use flow_layout, only: layout_type
  use kinds, only: wp
  implicit none
  private
  public :: sharpen_faces

  real(wp), parameter :: steepness = 1.6_wp !< of the tangent: nine tenths of an interface lie in two cells
  real(wp), parameter :: least_steepness = 0.01_wp !< where the interface lies along the sweep
  real(wp), parameter :: mixed = 1e-4_wp !< least fraction in a cell that an interface crosses

contains

  !> Replaces the face values low and high of a row of n cells. q: state, first cell of variable 1 at q(1); stride: distance of
  !> neighbours in the three directions, over_h: one over the cell size there, both 0 in inactive ones; along: the direction of
  !> the sweep; reach: largest stride; a_low, a_high, factor: work space.
  pure subroutine sharpen_faces(n, ld, layout, stride, over_h, along, reach, q, low, high, a_low, a_high, factor)
    integer, intent(in) :: n, ld, stride(3), along, reach
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: over_h(3), q(1 - reach:*)
    real(wp), intent(inout) :: low(ld, *), high(ld, *), a_low(ld, *), a_high(ld, *), factor(ld)
    real(wp) :: greatest
    integer :: i, k, row
    do k = 1, layout%n_fractions
      row = (layout%fraction(k) - 1)*ld
      greatest = most_mixed(n, q(row + 1))
      if (greatest > mixed) exit
    end do
    if (.not. greatest > mixed) return
    do k = 1, layout%n_fractions
      row = layout%fraction(k)
      do i = 1, n
        a_low(i, k) = low(i, row)
        a_high(i, k) = high(i, row)
      end do
      row = (row - 1)*ld
      call tangent_faces(n, stride, over_h, along, reach, q(row + 1 - reach), a_low(1, k), a_high(1, k))
    end do
    call spread_to_materials(n, ld, layout, a_low, low, factor)
    call spread_to_materials(n, ld, layout, a_high, high, factor)
  end subroutine sharpen_faces

  pure real(wp) function most_mixed(n, a)
    integer, intent(in) :: n
    real(wp), intent(in) :: a(n)
    integer :: i
    most_mixed = 0
    !$omp simd reduction(max:most_mixed)
    do i = 1, n
      most_mixed = max(most_mixed, min(a(i), 1 - a(i)))
    end do
  end function most_mixed

  !> Face values of one fraction where it is mixed and monotone along the sweep; others stay.
  pure subroutine tangent_faces(n, stride, over_h, along, reach, a, low, high)
    integer, intent(in) :: n, stride(3), along, reach
    real(wp), intent(in) :: over_h(3), a(1 - reach:*)
    real(wp), intent(inout) :: low(n), high(n)
    real(wp), parameter :: nothing = 1e-30_wp
    real(wp) :: x, y, slope, across_x, across_y, across_z, steep, grow, cosine, tangent, sign, least, range, place
    logical :: sharp
    integer :: i, s, sx, sy, sz
    s = stride(along)
    sx = stride(1); sy = stride(2); sz = stride(3)
    !$omp simd private(x, y, slope, across_x, across_y, across_z, steep, grow, cosine, tangent, sign, least, range, place, sharp)
    do i = 1, n
      x = a(i + s) - a(i)
      y = a(i) - a(i - s)
      across_x = (a(i + sx) - a(i - sx))*over_h(1)
      across_y = (a(i + sy) - a(i - sy))*over_h(2)
      across_z = (a(i + sz) - a(i - sz))*over_h(3)
      slope = abs(x + y)*over_h(along)/sqrt(across_x*across_x + across_y*across_y + across_z*across_z + nothing)
      steep = steepness*slope + least_steepness
      grow = exp(steep)
      cosine = 0.5_wp*(grow + 1/grow)
      tangent = (grow - 1/grow)/(grow + 1/grow)
      sign = merge(1.0_wp, -1.0_wp, x + y > 0)
      range = abs(x + y)
      least = min(a(i - s), a(i + s))
      place = 2*(a(i) - least)/(range + nothing) - 1
      place = min(max(place, -1.0_wp), 1.0_wp)
      place = (exp(steep*sign*place)/cosine - 1)/tangent
      sharp = x*y > 0 .and. a(i) > mixed .and. a(i) < 1 - mixed
      low(i) = merge(least + 0.5_wp*range*(1 + sign*place), low(i), sharp)
      high(i) = merge(least + 0.5_wp*range*(1 + sign*(tangent + place)/(1 + tangent*place)), high(i), sharp)
    end do
  end subroutine tangent_faces

  !> Scales partial densities and energies to new fractions a on a face, and adds the densities up.
  pure subroutine spread_to_materials(n, ld, layout, a, face, factor)
    integer, intent(in) :: n, ld
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: a(ld, *)
    real(wp), intent(inout) :: face(ld, *), factor(ld)
    integer :: i, k, row, fraction
    do k = 1, layout%n_materials
      row = layout%fraction(k)
      if (row > 0) then
        !$omp simd
        do i = 1, n
          factor(i) = a(i, k)/face(i, row)
        end do
      else ! the second of two
        row = layout%fraction(1)
        !$omp simd
        do i = 1, n
          factor(i) = (1 - a(i, 1))/(1 - face(i, row))
        end do
      end if
      !$omp simd
      do i = 1, n
        face(i, k) = face(i, k)*factor(i)
      end do
      row = layout%energy_row(k)
      if (row == 0) cycle
      !$omp simd
      do i = 1, n
        face(i, row) = face(i, row)*factor(i)
      end do
    end do
    !$omp simd
    do i = 1, n
      factor(i) = face(i, 1) + face(i, 2)
    end do
    do k = 3, layout%n_materials
      !$omp simd
      do i = 1, n
        factor(i) = factor(i) + face(i, k)
      end do
    end do
    row = layout%density_row
    do k = 1, layout%n_fractions
      fraction = layout%first_fraction_row + k - 1
      !$omp simd
      do i = 1, n
        face(i, row) = merge(factor(i), face(i, row), abs(a(i, k) - face(i, fraction)) > 0)
        face(i, fraction) = a(i, k)
      end do
    end do
  end subroutine spread_to_materials

end module interface_sharpening
