!> One material of each constitutive model, with numbers of real ones (SI), for tests of all models alike.
module material_samples
  use deck_types, only: material_group
  use kinds, only: wp
  use solid_scenes, only: metal, concrete
  implicit none
  private
  public :: sample_material, copper, rht_concrete

  character(24), parameter, public :: sample_names(14) = [character(24) :: 'elastic', 'perfect_plasticity', 'linear_hardening', &
    'simplified_johnson_cook', 'johnson_cook', 'johnson_cook_damage', 'copper_shock', 'johnson_cook_shock', 'hjc', 'hjc_fracture', &
    'rht', 'rht_fracture', 'drucker_prager', 'neo_hookean']

contains

  !> The sample of this name.
  function sample_material(name) result(group)
    character(*), intent(in) :: name
    type(material_group) :: group
    select case (name)
    case ('hjc')
      group = concrete(name)
    case ('hjc_fracture')
      group = concrete(name)
      group%failure = 'fracture_energy'
      group%fracture_energy = 100
      group%tensile_rate_factor = 'malvar'
    case ('rht')
      group = rht_concrete(name)
    case ('rht_fracture')
      group = rht_concrete(name)
      group%failure = 'fracture_energy'
      group%fracture_energy = 100
    case ('copper_shock')
      group = copper(name, 'elastic')
    case ('johnson_cook_shock')
      group = copper(name, 'johnson_cook')
    case ('johnson_cook_damage')
      group = metal(name, 'johnson_cook')
      group%failure = 'damage'
      group%jc_d1 = 0.05_wp
      group%jc_d2 = 3.44_wp
      group%jc_d3 = -2.12_wp
      group%jc_d4 = 0.002_wp
      group%jc_d5 = 0.61_wp
    case default
      group = metal(name, name)
      group%friction_angle = 30
      group%cohesion = 1e6_wp
    end select
    group%bulk_viscosity_linear = 0.06_wp
    group%bulk_viscosity_quadratic = 1.5_wp
  end function sample_material

  !> Copper with its shock equation of state.
  function copper(name, model) result(group)
    character(*), intent(in) :: name, model
    type(material_group) :: group
    group = metal(name, model)
    group%eos = 'shock'
    group%density = 8960
    group%youngs_modulus = 124e9_wp
    group%poissons_ratio = 0.34_wp
    group%sound_speed = 3970
    group%hugoniot_slope = 1.479_wp
    group%grueneisen = 2.12_wp
  end function copper

  !> The concrete of Borrvall & Riedel, 35 MPa; the constants that the checks of a deck would fill in.
  function rht_concrete(name) result(group)
    character(*), intent(in) :: name
    type(material_group) :: group
    group%name = name
    group%model = 'rht'
    group%density = 2314
    group%youngs_modulus = 40e9_wp
    group%poissons_ratio = 0.2_wp
    group%rht_fc = 35e6_wp
    group%rht_beta_c = 0.032_wp
    group%rht_beta_t = 0.0364_wp
    group%rht_p_crush = 23.3e6_wp
    group%rht_p_lock = 6e9_wp
    group%rht_a1 = 35.27e9_wp
    group%rht_a2 = 39.58e9_wp
    group%rht_a3 = 9.04e9_wp
    group%rht_t1 = 35.27e9_wp
    group%failure = 'damage'
    group%bulk_viscosity_linear = 0
    group%bulk_viscosity_quadratic = 0
  end function rht_concrete

end module material_samples
