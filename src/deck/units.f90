!> The unit systems of a deck: all are decimal multiples of SI, so a conversion is a power of ten and loses nothing.
module units
  use kinds, only: wp
  implicit none
  private
  public :: unit_labels, unit_label, decimal_exponent, from_si, to_si, unit_system_known

  character(16), parameter, public :: unit_system_names(4) = &
    [character(16) :: 'SI', 'mm-ms-g-MPa', 'cm-us-g-Mbar', 'none'] !< allowed values of &run units

  ! Exponents of mass, length, time, temperature.
  integer, parameter, public :: of_nothing(4) = [0, 0, 0, 0]
  integer, parameter, public :: of_mass(4) = [1, 0, 0, 0]
  integer, parameter, public :: of_length(4) = [0, 1, 0, 0]
  integer, parameter, public :: of_time(4) = [0, 0, 1, 0]
  integer, parameter, public :: of_temperature(4) = [0, 0, 0, 1]
  integer, parameter, public :: of_rate(4) = [0, 0, -1, 0]
  integer, parameter, public :: of_velocity(4) = [0, 1, -1, 0]
  integer, parameter, public :: of_acceleration(4) = [0, 1, -2, 0]
  integer, parameter, public :: of_density(4) = [1, -3, 0, 0]
  integer, parameter, public :: of_pressure(4) = [1, -1, -2, 0] !< also energy per volume
  integer, parameter, public :: of_energy(4) = [1, 2, -2, 0]
  integer, parameter, public :: of_energy_per_mass(4) = [0, 2, -2, 0]
  integer, parameter, public :: of_energy_per_area(4) = [1, 0, -2, 0]
  integer, parameter, public :: of_specific_heat(4) = [0, 2, -2, -1]
  integer, parameter, public :: of_momentum(4) = [1, 1, -1, 0]
  integer, parameter, public :: of_force(4) = [1, 1, -2, 0]
  integer, parameter, public :: of_impulse(4) = [1, -1, -1, 0] !< pressure times time

  !> Labels of the units in which a run's numbers stand, for headings and axes ('-' without a system).
  type, public :: unit_labels_type
    character(16) :: system = 'SI'
    character(16) :: length = 'm', time = 's', mass = 'kg', temperature = 'K', velocity = 'm/s', acceleration = 'm/s^2'
    character(16) :: density = 'kg/m^3', pressure = 'Pa', energy = 'J', energy_per_mass = 'J/kg'
    character(16) :: momentum = 'N s', force = 'N', impulse = 'Pa s', specific_heat = 'J/(kg K)', rate = '1/s'
    character(16) :: energy_per_area = 'J/m^2'
  end type unit_labels_type

contains

  !> True if the name is one of unit_system_names.
  pure logical function unit_system_known(system)
    character(*), intent(in) :: system
    unit_system_known = any(unit_system_names == system)
  end function unit_system_known

  !> The labels of a unit system; those of SI for an unknown name.
  pure function unit_labels(system) result(labels)
    character(*), intent(in) :: system
    type(unit_labels_type) :: labels
    select case (system)
    case ('mm-ms-g-MPa')
      labels = unit_labels_type('', 'mm', 'ms', 'g', 'K', 'mm/ms', 'mm/ms^2', 'g/mm^3', 'MPa', 'mJ', 'mJ/g', &
        'g mm/ms', 'N', 'MPa ms', 'mJ/(g K)', '1/ms', 'mJ/mm^2')
    case ('cm-us-g-Mbar')
      labels = unit_labels_type('', 'cm', 'us', 'g', 'K', 'cm/us', 'cm/us^2', 'g/cm^3', 'Mbar', 'Mbar cm^3', 'Mbar cm^3/g', &
        'g cm/us', 'Mbar cm^2', 'Mbar us', 'Mbar cm^3/(g K)', '1/us', &
        'Mbar cm')
    case ('none')
      labels = unit_labels_type('', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-', '-')
    end select
    labels%system = system
  end function unit_labels

  !> The label for one dimension (an of_... vector) in a system; '-' for a pure number.
  pure function unit_label(dimension, system) result(label)
    integer, intent(in) :: dimension(4)
    character(*), intent(in) :: system
    character(16) :: label
    type(unit_labels_type) :: labels
    labels = unit_labels(system)
    label = '-'
    if (all(dimension == of_mass)) label = labels%mass
    if (all(dimension == of_length)) label = labels%length
    if (all(dimension == of_time)) label = labels%time
    if (all(dimension == of_temperature)) label = labels%temperature
    if (all(dimension == of_rate)) label = labels%rate
    if (all(dimension == of_velocity)) label = labels%velocity
    if (all(dimension == of_acceleration)) label = labels%acceleration
    if (all(dimension == of_density)) label = labels%density
    if (all(dimension == of_pressure)) label = labels%pressure
    if (all(dimension == of_energy)) label = labels%energy
    if (all(dimension == of_energy_per_mass)) label = labels%energy_per_mass
    if (all(dimension == of_energy_per_area)) label = labels%energy_per_area
    if (all(dimension == of_specific_heat)) label = labels%specific_heat
    if (all(dimension == of_momentum)) label = labels%momentum
    if (all(dimension == of_force)) label = labels%force
    if (all(dimension == of_impulse)) label = labels%impulse
  end function unit_label

  !> n in: a quantity of this dimension that is 1 in SI is 10**n in the system.
  pure integer function decimal_exponent(dimension, system) result(n)
    integer, intent(in) :: dimension(4)
    character(*), intent(in) :: system
    integer :: units_in_si(3)
    select case (system)
    case ('mm-ms-g-MPa')
      units_in_si = [3, 3, 3]
    case ('cm-us-g-Mbar')
      units_in_si = [3, 2, 6]
    case default
      units_in_si = 0
    end select
    n = sum(dimension(1:3)*units_in_si)
  end function decimal_exponent

  !> A number in SI as a number in the system.
  elemental real(wp) function from_si(value, mass, length, time, system) result(converted)
    real(wp), intent(in) :: value
    integer, intent(in) :: mass, length, time !< exponents of the dimension
    character(*), intent(in) :: system
    converted = shifted(value, decimal_exponent([mass, length, time, 0], system))
  end function from_si

  !> A number in the system as a number in SI.
  elemental real(wp) function to_si(value, mass, length, time, system) result(converted)
    real(wp), intent(in) :: value
    integer, intent(in) :: mass, length, time !< exponents of the dimension
    character(*), intent(in) :: system
    converted = shifted(value, -decimal_exponent([mass, length, time, 0], system))
  end function to_si

  ! Dividing by a positive power of ten is exact to the last bit where multiplying by 10**(-n) is not.
  pure real(wp) function shifted(value, n)
    real(wp), intent(in) :: value
    integer, intent(in) :: n
    if (n >= 0) then
      shifted = value*10.0_wp**n
    else
      shifted = value/10.0_wp**(-n)
    end if
  end function shifted

end module units
