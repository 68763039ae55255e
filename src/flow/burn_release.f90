!> Programmed burn: the energy of an explosive is released as the detonation front, whose arrival time in each cell is known from
!> the start, passes over it. The part that has not burnt falls to nil as the square of the time left: a steady front stays on its
!> Rayleigh line, where p = p_CJ (1 - sqrt(unburnt part)) for a constant gamma, so the pressure rises about linearly and meets the
!> products without the infinite slope that a linear release would give it there. The total energy per volume that the flow
!> conserves is E + q m u with q the energy of detonation per mass, m the partial density and u the unburnt part, and its flux
!> carries q u with the mass; so what is released over the whole burn is q times the mass, to round-off, whatever the mesh and the
!> time step.
module burn_release
  use kinds, only: wp
  implicit none
  private
  public :: release_energy, unburnt_part

contains

  !> Energy per volume released in each cell of a row in a stage, divided by the stage's part: what a flux of energy would have to
  !> bring. time: of the states start, from and new; energy: per mass; burn_rate: one over the time that a cell takes to burn;
  !> arrival: with ghosts, of the first cell at arrival(1); stride: distance of neighbours in the three directions, 0 in inactive
  !> ones; mass_from, mass_start: partial density; d_mass: what its fluxes take; the other arrays: rates and mass fluxes of the
  !> faces, as in module flow_differences.
  pure subroutine release_energy(n, part, time, energy, burn_rate, stride, reach, arrival, mass_from, mass_start, d_mass, &
    rate_low, &
      rate_high, rate, x, y_low, y_high, z_low, z_high, released)
    integer, intent(in) :: n, stride(3), reach
    real(wp), intent(in) :: part, time(3), energy, burn_rate, arrival(1 - reach:*), rate(3), x(n + 1)
    real(wp), intent(in), dimension(n) :: mass_from, mass_start, d_mass, rate_low, rate_high, y_low, y_high, z_low, z_high
    real(wp), intent(inout) :: released(n)
    real(wp) :: start, from, new, leaving, mass
    integer :: i
    do i = 1, n
      start = mass_start(i)*unburnt_part(time(1), arrival(i), burn_rate)
      from = mass_from(i)*unburnt_part(time(2), arrival(i), burn_rate)
      mass = mass_start(i) + part*((mass_from(i) - mass_start(i)) - d_mass(i))
      new = mass*unburnt_part(time(3), arrival(i), burn_rate)
      leaving = rate_high(i)*x(i + 1)*on_face(i, stride(1)) - rate_low(i)*x(i)*on_face(i, -stride(1))
      if (stride(2) > 0) leaving = leaving + rate(2)*(y_high(i)*on_face(i, stride(2)) - y_low(i)*on_face(i, -stride(2)))
      if (stride(3) > 0) leaving = leaving + rate(3)*(z_high(i)*on_face(i, stride(3)) - z_low(i)*on_face(i, -stride(3)))
      released(i) = energy*((start - new)/part + (from - start) - leaving)
    end do
  contains
    pure real(wp) function on_face(i, s)
      integer, intent(in) :: i, s
      on_face = unburnt_part(time(2), 0.5_wp*(arrival(i) + arrival(i + s)), burn_rate)
    end function on_face
  end subroutine release_energy

  !> Part of an explosive that has not burnt at a time, for a front whose middle arrives at `arrival`.
  elemental real(wp) function unburnt_part(time, arrival, burn_rate)
    real(wp), intent(in) :: time, arrival, burn_rate
    unburnt_part = min(max(0.5_wp - burn_rate*(time - arrival), 0.0_wp), 1.0_wp)**2
  end function unburnt_part

end module burn_release
