!> Afterburn: the products of an oxygen-poor explosive go on burning with the air. Their energy is released at a constant rate per
!> mass of products, wherever these are, between two times; how the air gets to them is not computed.
module afterburn
  use kinds, only: wp
  implicit none
  private
  public :: released_in_step, release_afterburn

  !> Of one material of the flow; off without energy.
  type, public :: afterburn_type
    real(wp) :: energy = 0 !< per mass, released from start to end
    real(wp) :: start = 0, end = 1 !< times
  end type afterburn_type

contains

  !> Energy per mass released in a step of length dt that begins at a time. Steps that follow each other add up to the energy,
  !> also where the release begins or ends within one.
  elemental real(wp) function released_in_step(afterburn, time, dt) result(energy)
    type(afterburn_type), intent(in) :: afterburn
    real(wp), intent(in) :: time, dt
    energy = 0
    if (.not. afterburn%energy > 0) return
    energy = afterburn%energy*max(min(time + dt, afterburn%end) - max(time, afterburn%start), 0.0_wp) &
      /(afterburn%end - afterburn%start)
  end function released_in_step

  !> Energy per volume released in the cells of a row in a whole step at the rate of the state whose partial density is mass, taken
  !> off d, what fluxes take from the total energy, and off d_material, what they take from that of the material, where there
  !> is one. energy: per mass.
  pure subroutine release_afterburn(n, energy, mass, d, released, d_material)
    integer, intent(in) :: n
    real(wp), intent(in) :: energy, mass(n)
    real(wp), intent(inout) :: d(n), released(n)
    real(wp), intent(inout), optional :: d_material(n)
    released = energy*mass
    d = d - released
    if (present(d_material)) d_material = d_material - released
  end subroutine release_afterburn

end module afterburn
