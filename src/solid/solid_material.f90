!> Constants of one solid material, with those that follow from what the deck gives.
module solid_material
  use constants, only: third, unset
  use deck_types, only: material_group
  use equation_of_state, only: eos_type
  use errors, only: fatal, exit_bad_input
  use kinds, only: wp
  use material_eos, only: eos_of
  use particles, only: n_fields_basic
  use text, only: str
  implicit none
  private
  public :: make_solid_material, lock_compression, claim_columns

  integer, parameter, public :: model_elastic = 1
  integer, parameter, public :: model_perfect_plasticity = 2
  integer, parameter, public :: model_linear_hardening = 3
  integer, parameter, public :: model_johnson_cook = 4
  integer, parameter, public :: model_simplified_johnson_cook = 5
  integer, parameter, public :: model_hjc = 6
  integer, parameter, public :: model_fluid = 7

  !> Constants of the concrete of Holmquist, Johnson & Cook (1993), named as there.
  type, public :: hjc_constants
    real(wp) :: a = 0, b = 0, n = 1, c = 0 !< strength
    real(wp) :: fc = 1, s_max = 0, t = 0 !< compressive strength, largest normalised strength, tensile pressure
    real(wp) :: d1 = 1, d2 = 1, ef_min = 0 !< damage
    real(wp) :: p_crush = 0, mu_crush = 1, p_lock = 0, mu_lock = 0 !< compaction
    real(wp) :: k1 = 0, k2 = 0, k3 = 0 !< fully dense material
    real(wp) :: k_elastic = 0 !< bulk modulus below crushing: p_crush/mu_crush
    real(wp) :: mu_plock = 1 !< compression at which p_lock is reached
    real(wp) :: slope = 0 !< of the compaction line: (p_lock - p_crush)/(mu_plock - mu_crush)
  end type hjc_constants

  !> One material of the solid; everything in the units of the deck.
  type, public :: solid_material_type
    character(64) :: name = ''
    integer :: model = 0 !< model_*
    integer :: n_field = n_fields_basic !< columns that its particles have
    integer :: at_compaction = 0 !< column of the largest compression r/r0 - 1 reached so far; 0: none
    integer :: at_strength = 0 !< column of the factor on the strength; 0: none
    integer :: at_stiffness = 0 !< column of the factor on the elastic moduli; 0: none
    real(wp) :: density = 0 !< at rest
    real(wp) :: shear_modulus = 0, bulk_modulus = 0
    real(wp) :: yield_stress = 0, hardening_modulus = 0
    real(wp) :: ultimate_stress = huge(1.0_wp) !< the yield stress rises no further
    real(wp) :: failure_strain = huge(1.0_wp) !< plastic strain at failure
    real(wp) :: failure_damage = huge(1.0_wp) !< damage from which a particle is failed: 1, or huge where none fails
    real(wp) :: jc_a = 0, jc_b = 0, jc_n = 1, jc_c = 0, jc_m = 1
    real(wp) :: melt_temperature = 0, reference_temperature = 0, specific_heat = 1, taylor_quinney = 0
    real(wp) :: reference_strain_rate = 1
    real(wp) :: linear_viscosity = 0, quadratic_viscosity = 0 !< factors of the bulk viscosity
    real(wp) :: sound_speed = 0 !< longitudinal, at rest
    type(hjc_constants) :: hjc
    type(eos_type) :: eos !< of a fluid
  end type solid_material_type

contains

  !> Takes a checked group of the deck. viscosity: is there any bulk viscosity.
  function make_solid_material(group, viscosity) result(m)
    type(material_group), intent(in) :: group
    logical, intent(in) :: viscosity
    type(solid_material_type) :: m
    m%name = group%name
    m%density = group%density
    if (viscosity) then
      m%linear_viscosity = group%bulk_viscosity_linear
      m%quadratic_viscosity = group%bulk_viscosity_quadratic
    end if
    if (group%reference_strain_rate > unset) m%reference_strain_rate = group%reference_strain_rate
    select case (group%model)
    case ('elastic')
      m%model = model_elastic
    case ('perfect_plasticity')
      m%model = model_perfect_plasticity
    case ('linear_hardening')
      m%model = model_linear_hardening
    case ('johnson_cook')
      m%model = model_johnson_cook
    case ('simplified_johnson_cook')
      m%model = model_simplified_johnson_cook
    case ('hjc')
      m%model = model_hjc
    case ('fluid')
      m%model = model_fluid
    case default
      call fatal("material '"//trim(group%name)//"': model '"//trim(group%model)//"' is none of the solid's", exit_bad_input)
    end select
    if (m%model == model_fluid) then
      m%eos = eos_of(group)
      return
    end if
    m%shear_modulus = group%youngs_modulus/(2*(1 + group%poissons_ratio))
    m%bulk_modulus = group%youngs_modulus/(3*(1 - 2*group%poissons_ratio))
    if (m%model == model_hjc) then
      call make_hjc(group, m)
    else
      call make_metal(group, m)
    end if
    m%sound_speed = sqrt((m%bulk_modulus + 4*third*m%shear_modulus)/m%density)
  end function make_solid_material

  !> Gives the material's particles `width` more columns; first: where they start.
  pure subroutine claim_columns(m, width, first)
    type(solid_material_type), intent(inout) :: m
    integer, intent(in) :: width
    integer, intent(out) :: first
    first = m%n_field + 1
    m%n_field = m%n_field + width
  end subroutine claim_columns

  subroutine make_metal(group, m)
    type(material_group), intent(in) :: group
    type(solid_material_type), intent(inout) :: m
    if (group%yield_stress > unset) m%yield_stress = group%yield_stress
    if (m%model == model_linear_hardening) then
      if (group%hardening_modulus > unset) m%hardening_modulus = group%hardening_modulus
      if (group%ultimate_stress > 0) m%ultimate_stress = group%ultimate_stress
    end if
    if (group%failure_strain > 0 .and. group%failure /= 'none') then
      m%failure_strain = group%failure_strain
      m%failure_damage = 1
    end if
    if (m%model /= model_johnson_cook .and. m%model /= model_simplified_johnson_cook) return
    m%jc_a = group%jc_a
    m%jc_b = group%jc_b
    m%jc_n = group%jc_n
    m%jc_c = group%jc_c
    if (m%model == model_simplified_johnson_cook) return
    m%jc_m = group%jc_m
    m%melt_temperature = group%melt_temperature
    m%reference_temperature = group%reference_temperature
    m%specific_heat = group%specific_heat
    m%taylor_quinney = group%taylor_quinney
  end subroutine make_metal

  subroutine make_hjc(group, m)
    type(material_group), intent(in) :: group
    type(solid_material_type), intent(inout) :: m
    call claim_columns(m, 1, m%at_compaction)
    associate (h => m%hjc)
      h%a = group%hjc_a
      h%b = group%hjc_b
      h%n = group%hjc_n
      h%c = group%hjc_c
      h%fc = group%hjc_fc
      h%s_max = group%hjc_smax
      h%t = group%hjc_t
      h%d1 = group%hjc_d1
      h%d2 = group%hjc_d2
      h%ef_min = group%hjc_ef_min
      h%p_crush = group%hjc_p_crush
      h%mu_crush = group%hjc_mu_crush
      h%k1 = group%hjc_k1
      h%k2 = group%hjc_k2
      h%k3 = group%hjc_k3
      h%p_lock = group%hjc_p_lock
      h%k_elastic = h%p_crush/h%mu_crush
      m%bulk_modulus = h%k_elastic
      call lock_compression(h, group%hjc_mu_lock, group%hjc_lock_strain == 'plastic_lock')
      if (h%mu_plock <= h%mu_crush .or. h%p_lock <= h%p_crush) call fatal("material '"//trim(group%name)// &
        "': hjc: locking (mu "//str(h%mu_plock)//") must come after crushing (mu "//str(h%mu_crush)//')', exit_bad_input)
      h%slope = (h%p_lock - h%p_crush)/(h%mu_plock - h%mu_crush)
    end associate
    if (group%failure /= 'none') m%failure_damage = 1
  end subroutine make_hjc

  !> Fills mu_lock and mu_plock from the one that is given and p_lock = K1 m + K2 m^2 + K3 m^3, m = (mu_plock - mu_lock)/(1 +
  !> mu_lock).
  !>
  !> given: mu_plock where at_pressure, else mu_lock (the reading of Holmquist, Johnson & Cook 1993).
  pure subroutine lock_compression(h, given, at_pressure)
    type(hjc_constants), intent(inout) :: h
    real(wp), intent(in) :: given
    logical, intent(in) :: at_pressure
    real(wp) :: m, step
    integer :: iteration
    m = h%p_lock/h%k1
    do iteration = 1, 50
      step = (h%p_lock - m*(h%k1 + m*(h%k2 + m*h%k3)))/(h%k1 + m*(2*h%k2 + m*3*h%k3))
      m = m + step
      if (abs(step) <= 1e-15_wp*abs(m)) exit
    end do
    if (at_pressure) then
      h%mu_plock = given
      h%mu_lock = (given - m)/(1 + m)
    else
      h%mu_lock = given
      h%mu_plock = given + m*(1 + given)
    end if
  end subroutine lock_compression

end module solid_material
