!> Self-test of an equation of state at the start of a run.
module eos_check
  use kinds, only: wp
  use equation_of_state, only: eos_type
  use text, only: str
  implicit none
  private
  public :: check_eos

contains

  !> Counts the states, on a grid of densities and pressures around (r, p), whose pressure does not come back from its energy
  !> to 1e-9 or whose c**2 is not positive. first: describes the first of them. r: density; p: a typical pressure, positive.
  subroutine check_eos(eos, r, p, n_failed, first)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: r, p
    integer, intent(out) :: n_failed
    character(:), allocatable, intent(out) :: first
    real(wp), parameter :: tolerance = 1e-9_wp
    real(wp) :: density, trial, back, scale
    integer :: i, j
    logical :: good
    n_failed = 0
    first = ''
    do i = -12, 1
      density = r*1.5_wp**i
      do j = -6, 6
        trial = eos%lowest_pressure(density)
        trial = trial + (p + abs(trial))*10.0_wp**j
        back = eos%pressure(density, eos%energy(density, trial))
        scale = max(abs(trial), abs(eos%pressure(density, 0.0_wp)), eos%grueneisen*density*abs(eos%energy(density, trial)))
        good = abs(back - trial) <= tolerance*scale .and. eos%sound_speed_squared(density, trial) > 0
        if (good) cycle
        n_failed = n_failed + 1
        if (n_failed == 1) first = eos%name()//' at density '//str(density)//' and pressure '//str(trial)// &
          ': pressure '//str(back)//' came back, c**2 = '//str(eos%sound_speed_squared(density, trial))
      end do
    end do
  end subroutine check_eos

end module eos_check
