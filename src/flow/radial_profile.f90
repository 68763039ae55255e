!> What a one-dimensional run leaves of a blast: its state in equal shells around the centre and what each of them has felt so far.
module radial_profile
  use kinds, only: wp
  implicit none
  private

  integer, parameter, public :: felt_peak = 1, felt_impulse = 2, felt_arrival = 3 !< as the peak maps have them
  integer, parameter, public :: felt_whole_impulse = 4 !< integral of the overpressure, negative phase and all, as gauges have it
  integer, parameter, public :: n_felt = 4
  integer, parameter, public :: seen_pressure = 1, seen_density = 2, seen_velocity = 3, n_seen = 3 !< along the radius

  type, public :: radial_profile_type
    integer :: radial_power = 2 !< 2: shells around a point, 1: around an axis
    real(wp) :: thickness = 0 !< of a shell
    real(wp) :: time = 0 !< of the state
    real(wp) :: front = 0 !< radius that the leading wave has reached
    real(wp) :: afterburnt = 0 !< energy that afterburn has released
    real(wp), allocatable :: state(:, :) !< (row of the flow, shell), from the centre to where nothing has come yet
    real(wp), allocatable :: felt(:, :) !< (felt_*, shell)
    real(wp), allocatable :: gauge(:) !< radii at which a history was taken
    real(wp), allocatable :: seen_at(:) !< times of it
    real(wp), allocatable :: seen(:, :, :) !< (seen_*, gauge, time)
  contains
    procedure :: felt_at
  end type radial_profile_type

  !> A blast that entered a scene.
  type, public :: blast_type
    real(wp) :: center(3) = 0
    type(radial_profile_type) :: profile
  end type blast_type

contains

  !> What has been felt at a radius, linear between the middles of the shells; of the shell itself where the wave arrives between.
  pure function felt_at(self, radius) result(felt)
    class(radial_profile_type), intent(in) :: self
    real(wp), intent(in) :: radius
    real(wp) :: felt(n_felt), place, part
    integer :: i, n
    n = size(self%felt, 2)
    place = min(max(radius/self%thickness + 0.5_wp, 1.0_wp), real(n, wp))
    i = min(int(place), n - 1)
    part = place - i
    if (any(self%felt(felt_arrival, i:i + 1) < 0)) part = nint(part)
    felt = (1 - part)*self%felt(:, i) + part*self%felt(:, i + 1)
  end function felt_at

end module radial_profile
