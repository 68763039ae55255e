!> Where each variable of the flow stands: rows of the state (primitive variables) and of the fluxes (conserved variables and
!> what the two equations that are not conserved need).
!> One material:  density, velocity, pressure, [energy], c.
!> Two materials: partial densities a_k r_k, velocity, pressure, fraction a_1, [energies], density of the mixture, c.
!> More:          the same with the fractions of all.
!> The energies (per volume of the cell) are stored only of materials whose energy is not a linear function of the pressure with
!> constant coefficients, that is of all but gases: that spares their exponentials on the faces.
module flow_layout
  use equation_of_state, only: eos_type, max_materials
  implicit none
  private
  public :: new_layout, max_materials

  !> Of what is booked, after the six faces of the domain: what afterburn releases, what passes walls that move or stand askew.
  integer, parameter, public :: book_afterburn = 7, book_walls = 8, n_flow_books = 8

  type, public :: layout_type
    integer :: n_materials = 1
    integer :: n_rows = 6 !< rows of the state
    integer :: n_reconstructed = 5 !< rows 1..this are reconstructed on faces
    integer :: velocity_row = 2 !< of x; y and z follow
    integer :: pressure_row = 5
    integer :: first_fraction_row = 0 !< 0 with one material
    integer :: n_fractions = 0 !< fractions stored: the second of two is 1 - the first
    integer :: energy_row(max_materials) = 0 !< 0 where the energy is not stored
    integer :: density_row = 1 !< of the mixture
    integer :: sound_speed_row = 6
    integer :: n_fluxes = 5
    integer :: n_conserved = 5 !< fluxes 1..this are of conserved quantities: masses, momentum, total energy
    integer :: momentum_flux = 2 !< of x; y and z follow
    integer :: energy_flux = 5
    integer :: first_fraction_flux = 0 !< n_fractions of them
    integer :: first_material_energy_flux = 0 !< N of them
    integer :: face_velocity_flux = 0
  contains
    procedure :: partial_density => row_of_partial_density !< row of a_k r_k (the density itself with one material)
    procedure :: velocity => row_of_velocity !< row of the velocity in direction 1, 2 or 3
    procedure :: pressure => row_of_pressure
    procedure :: fraction => row_of_fraction !< row of a_k; 0 for the second of two and for a single material
    procedure :: energy => row_of_energy !< row of the energy of material k per volume of the cell; 0 where not stored
    procedure :: density => row_of_density !< row of the density of the mixture
    procedure :: sound_speed => row_of_sound_speed !< row of the sound speed of the mixture
  end type layout_type

contains

  !> Layout for the given materials.
  pure function new_layout(eos) result(layout)
    type(eos_type), intent(in) :: eos(:)
    type(layout_type) :: layout
    integer :: n, k, row
    n = size(eos)
    layout%n_materials = n
    layout%velocity_row = n + 1
    layout%pressure_row = n + 4
    row = n + 4
    if (n > 1) then
      layout%first_fraction_row = n + 5
      layout%n_fractions = merge(1, n, n == 2)
      row = n + 4 + layout%n_fractions
    end if
    do k = 1, n
      if (eos(k)%is_gas) cycle
      row = row + 1
      layout%energy_row(k) = row
    end do
    if (n > 1) then
      row = row + 1
      layout%density_row = row
    end if
    layout%n_reconstructed = row
    layout%sound_speed_row = row + 1
    layout%n_rows = row + 1
    layout%momentum_flux = n + 1
    layout%energy_flux = n + 4
    layout%n_conserved = n + 4
    layout%n_fluxes = n + 4
    if (n > 1) then
      layout%first_fraction_flux = n + 5
      layout%first_material_energy_flux = n + 5 + layout%n_fractions
      layout%face_velocity_flux = 2*n + 5 + layout%n_fractions
      layout%n_fluxes = layout%face_velocity_flux
    end if
  end function new_layout

  pure integer function row_of_partial_density(self, k)
    class(layout_type), intent(in) :: self
    integer, intent(in) :: k
    row_of_partial_density = min(k, self%n_materials)
  end function row_of_partial_density

  pure integer function row_of_velocity(self, direction)
    class(layout_type), intent(in) :: self
    integer, intent(in) :: direction
    row_of_velocity = self%velocity_row + direction - 1
  end function row_of_velocity

  pure integer function row_of_pressure(self)
    class(layout_type), intent(in) :: self
    row_of_pressure = self%pressure_row
  end function row_of_pressure

  pure integer function row_of_fraction(self, k)
    class(layout_type), intent(in) :: self
    integer, intent(in) :: k
    row_of_fraction = 0
    if (k <= self%n_fractions) row_of_fraction = self%first_fraction_row + k - 1
  end function row_of_fraction

  pure integer function row_of_energy(self, k)
    class(layout_type), intent(in) :: self
    integer, intent(in) :: k
    row_of_energy = self%energy_row(k)
  end function row_of_energy

  pure integer function row_of_density(self)
    class(layout_type), intent(in) :: self
    row_of_density = self%density_row
  end function row_of_density

  pure integer function row_of_sound_speed(self)
    class(layout_type), intent(in) :: self
    row_of_sound_speed = self%sound_speed_row
  end function row_of_sound_speed

end module flow_layout
