!> Sharp material interfaces: in mixed cells the volume fraction is a hyperbolic tangent, not a polynomial (THINC; Xiao, Honma &
!> Kono 2005), its steepness across the direction of the sweep that of the interface's normal (THINC/SW; Xiao, Ii & Chen 2011).
!> The materials keep on the faces the densities that they have in the cell, so that pressure and velocity stay uniform across
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
    call spread_to_materials(n, ld, layout, reach, q, a_low, low, factor)
    call spread_to_materials(n, ld, layout, reach, q, a_high, high, factor)
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

  !> Takes new fractions a on a face; where they are new, partial densities and energies are those of the cell in the new
  !> proportion (their reconstructed ratios to a steep fraction mean nothing), and the density is their sum.
  pure subroutine spread_to_materials(n, ld, layout, reach, q, a, face, factor)
    integer, intent(in) :: n, ld, reach
    type(layout_type), intent(in) :: layout
    real(wp), intent(in) :: q(1 - reach:*), a(ld, *)
    real(wp), intent(inout) :: face(ld, *), factor(ld)
    integer :: i, k, row, fraction
    do k = 1, layout%n_materials
      if (k <= layout%n_fractions) then
        fraction = layout%first_fraction_row + k - 1
        !$omp simd
        do i = 1, n
          factor(i) = merge(a(i, k)/q((fraction - 1)*ld + i), 0.0_wp, abs(a(i, k) - face(i, fraction)) > 0)
        end do
      else ! the second of two
        fraction = layout%first_fraction_row
        !$omp simd
        do i = 1, n
          factor(i) = merge((1 - a(i, 1))/(1 - q((fraction - 1)*ld + i)), 0.0_wp, abs(a(i, 1) - face(i, fraction)) > 0)
        end do
      end if
      call scale_row(n, factor, q((k - 1)*ld + 1), face(1, k))
      row = layout%energy_row(k)
      if (row > 0) call scale_row(n, factor, q((row - 1)*ld + 1), face(1, row))
    end do
    row = layout%density_row
    do k = 1, layout%n_fractions
      fraction = layout%first_fraction_row + k - 1
      do i = 1, n
        if (.not. abs(a(i, k) - face(i, fraction)) > 0) cycle
        face(i, row) = sum(face(i, :layout%n_materials))
        face(i, fraction) = a(i, k)
      end do
    end do
  end subroutine spread_to_materials

  !> factor times the value of the cell, where the factor is not 0.
  pure subroutine scale_row(n, factor, cell, face)
    integer, intent(in) :: n
    real(wp), intent(in) :: factor(n), cell(n)
    real(wp), intent(inout) :: face(n)
    integer :: i
    !$omp simd
    do i = 1, n
      face(i) = merge(factor(i)*cell(i), face(i), factor(i) > 0)
    end do
  end subroutine scale_row

end module interface_sharpening
