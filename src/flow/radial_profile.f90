!> What a run of one charge leaves of its blast: the state in equal shells around the centre, or around an axis and cut across it
!> into layers, and what each of these cells has felt so far.
module radial_profile
  use kinds, only: wp
  implicit none
  private

  integer, parameter, public :: felt_peak = 1, felt_impulse = 2, felt_arrival = 3 !< as the peak maps have them
  integer, parameter, public :: felt_whole_impulse = 4 !< integral of the overpressure, negative phase and all, as gauges have it
  integer, parameter, public :: n_felt = 4
  !> Velocities: along the radius and, where there are layers, along the axis.
  integer, parameter, public :: seen_pressure = 1, seen_density = 2, seen_velocity = 3, seen_along = 4, n_seen = 4

  type, public :: radial_profile_type
    integer :: radial_power = 2 !< 2: shells around a point, 1: around an axis
    real(wp) :: thickness = 0 !< of a shell
    real(wp) :: height = 0 !< of a layer; 0: the shells are not cut
    real(wp) :: bottom = 0 !< place of the lowest layer along the axis, from the centre
    real(wp) :: finest = 0 !< thickness of the shells that the charge was laid into
    real(wp) :: time = 0 !< of the state
    real(wp) :: front = 0 !< largest distance from the centre that the leading wave has reached
    real(wp) :: afterburnt = 0 !< energy that afterburn has released
    real(wp) :: energy_error = 0 !< by which repairs have changed the energy, over that of the charge
    real(wp) :: end_distance(2) = 0 !< from the centre to the faces across the axis, low and high
    character(16) :: end_kind(2) = '' !< what these faces are, as a deck says it
    real(wp), allocatable :: state(:, :, :) !< (row of the flow, shell, layer): from the centre to where nothing has come yet
    real(wp), allocatable :: felt(:, :, :) !< (felt_*, shell, layer)
    real(wp), allocatable :: gauge(:, :) !< places at which a history was taken: radius, and along the axis (2, gauge)
    real(wp), allocatable :: seen_at(:) !< times of it
    real(wp), allocatable :: seen(:, :, :) !< (seen_*, gauge, time)
  contains
    procedure :: has_layers
    procedure :: felt_at
  end type radial_profile_type

  !> A blast that entered a scene.
  type, public :: blast_type
    real(wp) :: center(3) = 0
    integer :: axis = 0 !< direction of the mesh that layers lie across; 0: there are none
    type(radial_profile_type) :: profile
  contains
    procedure :: place_of
    procedure :: has_reached
  end type blast_type

contains

  pure logical function has_layers(self)
    class(radial_profile_type), intent(in) :: self
    has_layers = self%height > 0
  end function has_layers

  !> What has been felt at a place (radius, along the axis), linear between the middles of the cells; of the cell itself where the
  !> wave arrives between.
  pure function felt_at(self, place) result(felt)
    class(radial_profile_type), intent(in) :: self
    real(wp), intent(in) :: place(2)
    real(wp) :: felt(n_felt), part(2), below(n_felt), above(n_felt)
    integer :: i(2), n(2)
    n = [size(self%felt, 2), size(self%felt, 3)]
    call between(place(1)/self%thickness, n(1), i(1), part(1))
    i(2) = 1
    part(2) = 0
    if (self%has_layers()) call between((place(2) - self%bottom)/self%height, n(2), i(2), part(2))
    n = min(i + 1, n)
    if (any(self%felt(felt_arrival, i(1):n(1), i(2):n(2)) < 0)) part = nint(part)
    below = (1 - part(1))*self%felt(:, i(1), i(2)) + part(1)*self%felt(:, n(1), i(2))
    above = (1 - part(1))*self%felt(:, i(1), n(2)) + part(1)*self%felt(:, n(1), n(2))
    felt = (1 - part(2))*below + part(2)*above
  end function felt_at

  !> The cells i and i + 1 of n between whose middles a place lies, counted in cells from the low face of the first.
  pure subroutine between(place, n, i, part)
    real(wp), intent(in) :: place
    integer, intent(in) :: n
    integer, intent(out) :: i
    real(wp), intent(out) :: part
    part = min(max(place + 0.5_wp, 1.0_wp), real(n, wp))
    i = max(min(int(part), n - 1), 1)
    part = part - i
  end subroutine between

  !> Radius, and place along the axis, of a point of the scene; active: directions of its mesh.
  pure function place_of(self, x, active) result(place)
    class(blast_type), intent(in) :: self
    real(wp), intent(in) :: x(3)
    logical, intent(in) :: active(3)
    real(wp) :: place(2), away(3)
    away = merge(x - self%center, 0.0_wp, active)
    place(2) = 0
    if (self%axis > 0) then
      place(2) = away(self%axis)
      away(self%axis) = 0
    end if
    place(1) = norm2(away)
  end function place_of

  !> True within the largest distance that the wave has come to.
  pure logical function has_reached(self, x, active)
    class(blast_type), intent(in) :: self
    real(wp), intent(in) :: x(3)
    logical, intent(in) :: active(3)
    has_reached = norm2(self%place_of(x, active)) < self%profile%front
  end function has_reached

end module radial_profile
