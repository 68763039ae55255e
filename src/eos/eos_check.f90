!> Self-test of an equation of state at the start of a run.
module eos_check
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use text, only: str
  implicit none
  private
  public :: check_eos, shocked_density

contains

  !> Counts the states, on a grid of densities and pressures, whose pressure does not come back from its energy to 1e-9, or where
  !> f of p = f(r) + g r e is not finite or c**2 not positive. first: describes the first of them. r: density; p: a typical
  !> pressure, positive; highest: the highest pressure of the scene, default p. Densities go from 1e-4 r, of thin products and
  !> traces, to a tenth more than the strongest shock makes of r, and to 1.65 r at least (products at the Chapman-Jouguet point
  !> have about 1.35 r).
  subroutine check_eos(eos, r, p, n_failed, first, highest)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p
    integer, intent(out) :: n_failed
    character(:), allocatable, intent(out) :: first
    real(wp), intent(in), optional :: highest
    real(wp), parameter :: tolerance = 1e-9_wp, sparsest = 1e-4_wp
    integer, parameter :: n_densities = 40
    real(wp) :: density, densest, trial, back, scale, f
    integer :: i, j
    logical :: good
    n_failed = 0
    first = ''
    densest = 1.5_wp*r
    if (present(highest)) densest = max(densest, shocked_density(eos, r, p, highest))
    densest = 1.1_wp*densest
    do i = 0, n_densities
      density = densest*(sparsest*r/densest)**(real(i, wp)/n_densities)
      f = eos%pressure(density, 0.0_wp)
      do j = -6, 6
        trial = eos%lowest_pressure(density)
        trial = trial + (p + abs(trial))*10.0_wp**j
        back = eos%pressure(density, eos%energy(density, trial))
        scale = max(abs(trial), abs(f), eos%grueneisen*density*abs(eos%energy(density, trial)))
        good = abs(f) < huge(f) .and. abs(back - trial) <= tolerance*scale .and. eos%sound_speed_squared(density, trial) > 0
        if (good) cycle
        n_failed = n_failed + 1
        if (n_failed == 1) first = eos%name()//' at density '//str(density)//' and pressure '//str(trial)// &
          ': pressure '//str(back)//' came back, c**2 = '//str(eos%sound_speed_squared(density, trial))
      end do
    end do
  end subroutine check_eos

  !> Density behind a shock of pressure p_new into the state (r, p): the Hugoniot e - e0 = (p_new + p) (1/r - 1/r_new)/2. No
  !> shock brings it above r (1 + 2/g). r itself where p_new is not above p.
  pure real(wp) function shocked_density(eos, r, p, p_new)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p, p_new
    real(wp) :: low, high, start
    integer :: i
    shocked_density = r
    if (.not. p_new > p) return
    start = eos%energy(r, p)
    low = r
    high = r*(1 + 2/eos%grueneisen)
    do i = 1, 60
      shocked_density = 0.5_wp*(low + high)
      if (eos%pressure(shocked_density, start + 0.5_wp*(p_new + p)*(1/r - 1/shocked_density)) < p_new) then
        low = shocked_density
      else
        high = shocked_density
      end if
    end do
  end function shocked_density

end module eos_check
