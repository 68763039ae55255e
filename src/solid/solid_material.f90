!> Constants of one solid material, with those that follow from what the deck gives.
module solid_material
  use constants, only: third, unset
  use deck_material, only: material_group, solid_eos_names
  use equation_of_state, only: eos_type
  use errors, only: fatal, exit_bad_input
  use drucker_prager, only: drucker_prager_type, make_drucker_prager
  use hjc, only: hjc_constants, make_hjc
  use johnson_cook_damage, only: johnson_cook_damage_type
  use kinds, only: wp
  use material_eos, only: eos_of
  use particles, only: n_fields_basic
  use rht, only: rht_constants, make_rht
  implicit none
  private
  public :: make_solid_material, claim_columns

  integer, parameter, public :: model_elastic = 1
  integer, parameter, public :: model_perfect_plasticity = 2
  integer, parameter, public :: model_linear_hardening = 3
  integer, parameter, public :: model_johnson_cook = 4
  integer, parameter, public :: model_simplified_johnson_cook = 5
  integer, parameter, public :: model_hjc = 6
  integer, parameter, public :: model_fluid = 7
  integer, parameter, public :: model_rht = 8
  integer, parameter, public :: model_drucker_prager = 9
  integer, parameter, public :: model_neo_hookean = 10
  integer, parameter, public :: model_rigid = 11 !< no law at all: see rigid_bodies

  integer, parameter, public :: pressure_of_model = 1 !< the model has its own law
  integer, parameter, public :: pressure_linear = 2 !< K mu
  integer, parameter, public :: pressure_eos = 3 !< an equation of state

  !> One material of the solid; everything in the units of the deck.
  type, public :: solid_material_type
    character(64) :: name = ''
    integer :: model = 0 !< model_*
    integer :: n_field = n_fields_basic !< columns that its particles have
    integer :: pressure = pressure_linear !< pressure_*
    integer :: at_own = n_fields_basic !< first of the columns that the model has for itself
    integer :: at_strength = 0 !< column of the factor on the strength; 0: none
    integer :: at_stiffness = 0 !< column of the factor on the elastic moduli; 0: none
    real(wp) :: density = 0 !< at rest
    real(wp) :: shear_modulus = 0, bulk_modulus = 0
    real(wp) :: yield_stress = 0, hardening_modulus = 0
    real(wp) :: ultimate_stress = huge(1.0_wp) !< the yield stress rises no further
    real(wp) :: failure_strain = huge(1.0_wp) !< plastic strain at failure
    real(wp) :: failure_damage = huge(1.0_wp) !< damage from which a particle is failed: 1, or huge where none fails
    real(wp) :: fracture_energy = 0 !< of a metal, per area: dissipated from failure_strain on; 0: fails at once
    logical :: keeps_friction = .false. !< failed particles still bear shear under pressure
    real(wp) :: tensile_limit = huge(1.0_wp) !< largest tensile pressure
    logical :: tension_fails = .false. !< a particle fails there; otherwise its pressure stays there
    real(wp) :: jc_a = 0, jc_b = 0, jc_n = 1, jc_c = 0, jc_m = 1
    real(wp) :: melt_temperature = 0, reference_temperature = 0, specific_heat = 1, taylor_quinney = 0
    real(wp) :: reference_strain_rate = 1
    real(wp) :: linear_viscosity = 0, quadratic_viscosity = 0 !< factors of the bulk viscosity
    real(wp) :: sound_speed = 0 !< longitudinal, at rest
    type(johnson_cook_damage_type) :: jc_damage
    type(hjc_constants) :: hjc
    type(rht_constants) :: rht
    type(drucker_prager_type) :: drucker_prager
    type(eos_type) :: eos !< of a fluid, or of a metal under shock
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
    case ('rht')
      m%model = model_rht
    case ('drucker_prager')
      m%model = model_drucker_prager
    case ('neo_hookean')
      m%model = model_neo_hookean
    case ('fluid')
      m%model = model_fluid
    case ('rigid')
      m%model = model_rigid
    case default
      call fatal("material '"//trim(group%name)//"': model '"//trim(group%model)//"' is none of the solid's", exit_bad_input)
    end select
    if (m%model == model_fluid) then
      m%eos = eos_of(group)
      m%pressure = pressure_eos
      return
    end if
    if (m%model == model_rigid) then
      call claim_columns(m, 3, m%at_own) ! the place in the body, at the start
      return
    end if
    m%shear_modulus = group%youngs_modulus/(2*(1 + group%poissons_ratio))
    m%bulk_modulus = group%youngs_modulus/(3*(1 - 2*group%poissons_ratio))
    select case (m%model)
    case (model_hjc)
      m%hjc = make_hjc(group)
      m%pressure = pressure_of_model
      m%bulk_modulus = m%hjc%k_elastic
      call claim_columns(m, merge(2, 1, m%hjc%fracture_energy > 0), m%at_own)
      if (group%failure /= 'none') m%failure_damage = 1
    case (model_rht)
      m%rht = make_rht(group)
      m%pressure = pressure_of_model
      m%bulk_modulus = m%rht%a1/m%rht%alpha
      call claim_columns(m, merge(2, 1, m%rht%fracture_energy > 0), m%at_own)
      m%keeps_friction = .true.
      if (group%failure /= 'none') m%failure_damage = 1
    case (model_drucker_prager)
      m%drucker_prager = make_drucker_prager(group)
      m%pressure = pressure_of_model
      call claim_columns(m, 1, m%at_own)
      m%keeps_friction = .true.
      call fail_by_strain(group, m)
    case (model_neo_hookean)
      m%pressure = pressure_of_model
      call claim_columns(m, 6, m%at_own)
    case default
      call make_metal(group, m)
    end select
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

  pure subroutine fail_by_strain(group, m)
    type(material_group), intent(in) :: group
    type(solid_material_type), intent(inout) :: m
    if (.not. group%failure_strain > 0 .or. group%failure == 'none') return
    m%failure_strain = group%failure_strain
    m%failure_damage = 1
  end subroutine fail_by_strain

  subroutine make_metal(group, m)
    type(material_group), intent(in) :: group
    type(solid_material_type), intent(inout) :: m
    if (any(group%eos == solid_eos_names)) then
      m%pressure = pressure_eos
      m%eos = eos_of(group)
      m%bulk_modulus = m%density*m%eos%sound_speed_squared(m%density, 0.0_wp)
    end if
    if (group%tensile_limit > 0) then
      m%tensile_limit = group%tensile_limit
      m%tension_fails = group%tensile_rule == 'failure'
      if (m%tension_fails) m%failure_damage = 1
    end if
    if (group%yield_stress > unset) m%yield_stress = group%yield_stress
    if (m%model == model_linear_hardening) then
      if (group%hardening_modulus > unset) m%hardening_modulus = group%hardening_modulus
      if (group%ultimate_stress > 0) m%ultimate_stress = group%ultimate_stress
    end if
    if (group%failure == 'damage') then
      m%failure_damage = 1
      m%jc_damage = johnson_cook_damage_type(.true., group%jc_d1, group%jc_d2, group%jc_d3, group%jc_d4, group%jc_d5)
    else
      call fail_by_strain(group, m)
      if (group%failure == 'fracture_energy') m%fracture_energy = group%fracture_energy
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
    m%jc_damage%heating = m%taylor_quinney/(m%specific_heat*(m%melt_temperature - m%reference_temperature))
  end subroutine make_metal

end module solid_material
