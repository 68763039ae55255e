!> &material (repeated): constants of one material, for the flow (eos) and for the solid (model).
module deck_material
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_density, of_energy_per_area, of_energy_per_mass, of_pressure, of_rate, of_specific_heat, of_temperature, &
    of_time, of_velocity
  implicit none
  private
  public :: material_keys

  character(word_length), parameter, public :: eos_names(7) = &
    [character(word_length) :: '', 'ideal_gas', 'stiffened_gas', 'jwl', 'cochran_chan', 'shock', 'polynomial']
  character(word_length), parameter, public :: solid_eos_names(3) = & !< from which a metal can take its pressure
    [character(word_length) :: 'cochran_chan', 'shock', 'polynomial']
  character(word_length), parameter, public :: model_names(12) = [character(word_length) :: '', 'elastic', &
    'perfect_plasticity', 'linear_hardening', 'johnson_cook', 'simplified_johnson_cook', 'hjc', 'rht', 'drucker_prager', &
    'neo_hookean', 'fluid', 'rigid']

  !> Real constants that neither the deck nor the library gives are `unset`.
  type, public :: material_group
    character(word_length) :: name = ''
    character(word_length) :: library = '' !< file of the material library, without .nml
    character(word_length) :: eos = ''
    character(word_length) :: model = ''
    real(wp) :: density = unset !< at rest: of the explosive, of the solid; default of the regions
    ! ideal and stiffened gas
    real(wp) :: gamma = unset, p_infinity = unset, energy_offset = 0
    ! JWL
    real(wp) :: jwl_a = unset, jwl_b = unset, jwl_r1 = unset, jwl_r2 = unset, jwl_omega = unset
    real(wp) :: energy_per_volume = unset !< E0, per initial volume
    real(wp) :: afterburn_energy = 0 !< per mass, released at a constant rate from start to end
    real(wp) :: afterburn_start = 0, afterburn_end = unset
    ! condensed matter that flows
    real(wp) :: grueneisen = unset !< constant
    real(wp) :: cochran_chan_a1 = unset, cochran_chan_a2 = unset, cochran_chan_e1 = unset, cochran_chan_e2 = unset
    real(wp) :: sound_speed = unset, hugoniot_slope = unset !< c0 and s of us = c0 + s up
    real(wp) :: polynomial_k1 = unset, polynomial_k2 = 0, polynomial_k3 = 0
    ! elasticity and plasticity
    real(wp) :: youngs_modulus = unset, poissons_ratio = unset
    real(wp) :: yield_stress = unset, hardening_modulus = unset
    real(wp) :: ultimate_stress = 0 !< the yield stress rises no further, 0: no limit
    real(wp) :: failure_strain = 0 !< plastic strain, 0: none
    real(wp) :: tensile_limit = 0 !< largest tensile mean stress, 0: none
    character(word_length) :: tensile_rule = 'failure' !< what happens there: 'failure' or 'limit'
    ! Johnson-Cook
    real(wp) :: jc_a = unset, jc_b = unset, jc_n = unset, jc_c = unset, jc_m = unset
    real(wp) :: melt_temperature = unset, reference_temperature = unset, specific_heat = unset
    real(wp) :: taylor_quinney = 0.9_wp !< part of the plastic work that heats
    real(wp) :: reference_strain_rate = unset !< set to 1 per second by the checks
    real(wp) :: jc_d1 = unset, jc_d2 = unset, jc_d3 = unset, jc_d4 = unset, jc_d5 = 0 !< failure strain
    ! Drucker-Prager
    real(wp) :: friction_angle = unset, cohesion = unset, dilatancy_angle = 0 !< angles in degrees
    ! concrete
    character(word_length) :: tensile_rate_factor = 'none' !< 'none', 'ceb' or 'malvar'
    real(wp) :: fracture_energy = 0 !< per area of a crack
    ! Holmquist-Johnson-Cook concrete
    real(wp) :: hjc_a = unset, hjc_b = unset, hjc_n = unset, hjc_c = unset, hjc_fc = unset, hjc_smax = unset
    real(wp) :: hjc_t = unset, hjc_d1 = unset, hjc_d2 = unset, hjc_ef_min = unset
    real(wp) :: hjc_p_crush = unset, hjc_mu_crush = unset, hjc_k1 = unset, hjc_k2 = unset, hjc_k3 = unset
    real(wp) :: hjc_p_lock = unset, hjc_mu_lock = unset
    character(word_length) :: hjc_lock_strain = 'lock' !< what hjc_mu_lock is: 'lock' or 'plastic_lock'
    ! Riedel-Hiermaier-Thoma concrete
    real(wp) :: rht_fc = unset !< all others follow where they are not given
    real(wp) :: rht_fs = 0.18_wp, rht_ft = 0.1_wp, rht_a = 1.6_wp, rht_n = 0.61_wp, rht_q0 = 0.6805_wp, rht_b = 0.0105_wp
    real(wp) :: rht_gc = 0.53_wp, rht_gt = 0.7_wp, rht_xi = 0.5_wp, rht_af = 1.6_wp, rht_nf = 0.61_wp
    real(wp) :: rht_d1 = 0.04_wp, rht_d2 = 1, rht_ef_min = 0.01_wp
    real(wp) :: rht_beta_c = unset, rht_beta_t = unset, rht_p_crush = unset, rht_p_lock = unset
    real(wp) :: rht_alpha = 1.1884_wp, rht_n_compaction = 3
    real(wp) :: rht_a1 = unset, rht_a2 = unset, rht_a3 = unset, rht_t1 = unset, rht_t2 = 0, rht_b0 = 1.22_wp, rht_b1 = 1.22_wp
    character(word_length) :: failure = '' !< set by the checks to 'damage', 'strain', 'fracture_energy' or 'none'
    real(wp) :: per_second = 1, ten_megapascal = 1e7_wp !< 1/s and 10 MPa in the units of the deck, set by the checks; no keys
    real(wp) :: bulk_viscosity_linear = 0.06_wp, bulk_viscosity_quadratic = 1.5_wp
    integer :: line = 0
  end type material_group

contains

  subroutine material_keys(group, table)
    type(material_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    real(wp), parameter :: usual_modulus(2) = [1e6_wp, 1.5e12_wp], usual_strength(2) = [1e4_wp, 1e10_wp], none = 0
    call table%start('material', group%line)
    call table%add('name', group%name, required=.true.)
    call table%add('library', group%library)
    call table%add('eos', group%eos, eos_names)
    call table%add('model', group%model, model_names)
    call table%add('density', group%density, of_density, more_than=none, usual=[1e-3_wp, 2.5e4_wp])
    call table%add('gamma', group%gamma, more_than=1.0_wp)
    call table%add('p_infinity', group%p_infinity, of_pressure, at_least=none, usual=[0.0_wp, 1e11_wp])
    call table%add('energy_offset', group%energy_offset, of_energy_per_mass, usual=[-1e8_wp, 1e8_wp])
    call table%add('jwl_a', group%jwl_a, of_pressure, more_than=none, usual=[1e9_wp, 1e13_wp])
    call table%add('jwl_b', group%jwl_b, of_pressure, usual=[-1e11_wp, 1e12_wp])
    call table%add('jwl_r1', group%jwl_r1, more_than=none)
    call table%add('jwl_r2', group%jwl_r2, more_than=none)
    call table%add('jwl_omega', group%jwl_omega, more_than=none)
    call table%add('energy_per_volume', group%energy_per_volume, of_pressure, more_than=none, usual=[1e8_wp, 5e10_wp])
    call table%add('afterburn_energy', group%afterburn_energy, of_energy_per_mass, at_least=none, usual=[0.0_wp, 5e7_wp])
    call table%add('afterburn_start', group%afterburn_start, of_time, at_least=none)
    call table%add('afterburn_end', group%afterburn_end, of_time, more_than=none)
    call table%add('grueneisen', group%grueneisen, more_than=none, at_most=10.0_wp)
    call table%add('cochran_chan_a1', group%cochran_chan_a1, of_pressure, more_than=none, usual=[1e7_wp, 1e13_wp])
    call table%add('cochran_chan_a2', group%cochran_chan_a2, of_pressure, at_least=none, usual=[0.0_wp, 1e13_wp])
    call table%add('cochran_chan_e1', group%cochran_chan_e1, more_than=1.0_wp, at_most=20.0_wp)
    call table%add('cochran_chan_e2', group%cochran_chan_e2, more_than=1.0_wp, at_most=20.0_wp)
    call table%add('sound_speed', group%sound_speed, of_velocity, more_than=none, usual=[100.0_wp, 2e4_wp])
    call table%add('hugoniot_slope', group%hugoniot_slope, more_than=none, at_most=10.0_wp)
    call table%add('polynomial_k1', group%polynomial_k1, of_pressure, more_than=none, usual=[1e7_wp, 1e12_wp])
    call table%add('polynomial_k2', group%polynomial_k2, of_pressure, usual=[-1e13_wp, 1e13_wp])
    call table%add('polynomial_k3', group%polynomial_k3, of_pressure, usual=[-1e13_wp, 1e13_wp])
    call table%add('youngs_modulus', group%youngs_modulus, of_pressure, more_than=none, usual=usual_modulus)
    call table%add('poissons_ratio', group%poissons_ratio, more_than=-1.0_wp, less_than=0.5_wp)
    call table%add('yield_stress', group%yield_stress, of_pressure, more_than=none, usual=usual_strength)
    call table%add('hardening_modulus', group%hardening_modulus, of_pressure, at_least=none, usual=[0.0_wp, 1e11_wp])
    call table%add('ultimate_stress', group%ultimate_stress, of_pressure, at_least=none, usual=[0.0_wp, 1e10_wp])
    call table%add('failure_strain', group%failure_strain, at_least=none)
    call table%add('tensile_limit', group%tensile_limit, of_pressure, at_least=none, usual=[0.0_wp, 1e10_wp])
    call table%add('tensile_rule', group%tensile_rule, [character(word_length) :: 'failure', 'limit'])
    call table%add('jc_a', group%jc_a, of_pressure, more_than=none, usual=usual_strength)
    call table%add('jc_b', group%jc_b, of_pressure, at_least=none, usual=[0.0_wp, 1e11_wp])
    call table%add('jc_n', group%jc_n, more_than=none, at_most=2.0_wp)
    call table%add('jc_c', group%jc_c, at_least=none, at_most=1.0_wp)
    call table%add('jc_m', group%jc_m, more_than=none)
    call table%add('melt_temperature', group%melt_temperature, of_temperature, more_than=none, usual=[200.0_wp, 4500.0_wp])
    call table%add('reference_temperature', group%reference_temperature, of_temperature, at_least=none, &
      usual=[1.0_wp, 2000.0_wp])
    call table%add('specific_heat', group%specific_heat, of_specific_heat, more_than=none, usual=[50.0_wp, 2e4_wp])
    call table%add('taylor_quinney', group%taylor_quinney, at_least=none, at_most=1.0_wp)
    call table%add('reference_strain_rate', group%reference_strain_rate, of_rate, more_than=none, usual=[1e-6_wp, 1e6_wp])
    call table%add('jc_d1', group%jc_d1, at_least=-10.0_wp, at_most=10.0_wp)
    call table%add('jc_d2', group%jc_d2, at_least=-100.0_wp, at_most=100.0_wp)
    call table%add('jc_d3', group%jc_d3, at_least=-20.0_wp, at_most=20.0_wp)
    call table%add('jc_d4', group%jc_d4, at_least=-1.0_wp, at_most=1.0_wp)
    call table%add('jc_d5', group%jc_d5, at_least=-1.0_wp, at_most=20.0_wp)
    call table%add('friction_angle', group%friction_angle, at_least=none, less_than=90.0_wp)
    call table%add('cohesion', group%cohesion, of_pressure, at_least=none, usual=[0.0_wp, 1e9_wp])
    call table%add('dilatancy_angle', group%dilatancy_angle, at_least=none, less_than=90.0_wp)
    call table%add('tensile_rate_factor', group%tensile_rate_factor, [character(word_length) :: 'none', 'ceb', 'malvar'])
    call table%add('fracture_energy', group%fracture_energy, of_energy_per_area, at_least=none, usual=[1.0_wp, 1e6_wp])
    call table%add('hjc_a', group%hjc_a, at_least=none)
    call table%add('hjc_b', group%hjc_b, at_least=none)
    call table%add('hjc_n', group%hjc_n, more_than=none)
    call table%add('hjc_c', group%hjc_c, at_least=none, at_most=1.0_wp)
    call table%add('hjc_fc', group%hjc_fc, of_pressure, more_than=none, usual=[1e6_wp, 1e9_wp])
    call table%add('hjc_smax', group%hjc_smax, more_than=none)
    call table%add('hjc_t', group%hjc_t, of_pressure, more_than=none, usual=[1e4_wp, 1e9_wp])
    call table%add('hjc_d1', group%hjc_d1, more_than=none)
    call table%add('hjc_d2', group%hjc_d2, more_than=none)
    call table%add('hjc_ef_min', group%hjc_ef_min, more_than=none, at_most=1.0_wp)
    call table%add('hjc_p_crush', group%hjc_p_crush, of_pressure, more_than=none, usual=[1e5_wp, 1e10_wp])
    call table%add('hjc_mu_crush', group%hjc_mu_crush, more_than=none, less_than=1.0_wp)
    call table%add('hjc_k1', group%hjc_k1, of_pressure, more_than=none, usual=[1e8_wp, 1e12_wp])
    call table%add('hjc_k2', group%hjc_k2, of_pressure)
    call table%add('hjc_k3', group%hjc_k3, of_pressure)
    call table%add('hjc_p_lock', group%hjc_p_lock, of_pressure, more_than=none, usual=[1e7_wp, 1e11_wp])
    call table%add('hjc_mu_lock', group%hjc_mu_lock, more_than=none, less_than=1.0_wp)
    call table%add('hjc_lock_strain', group%hjc_lock_strain, [character(word_length) :: 'lock', 'plastic_lock'])
    call table%add('rht_fc', group%rht_fc, of_pressure, more_than=none, usual=[1e6_wp, 1e9_wp])
    call table%add('rht_fs', group%rht_fs, more_than=none, less_than=1.0_wp)
    call table%add('rht_ft', group%rht_ft, more_than=none, less_than=1.0_wp)
    call table%add('rht_a', group%rht_a, more_than=none)
    call table%add('rht_n', group%rht_n, more_than=none, at_most=1.0_wp)
    call table%add('rht_q0', group%rht_q0, at_least=0.51_wp, at_most=1.0_wp)
    call table%add('rht_b', group%rht_b, at_least=none)
    call table%add('rht_gc', group%rht_gc, more_than=none, at_most=1.0_wp)
    call table%add('rht_gt', group%rht_gt, more_than=none, at_most=1.0_wp)
    call table%add('rht_xi', group%rht_xi, more_than=none)
    call table%add('rht_af', group%rht_af, at_least=none)
    call table%add('rht_nf', group%rht_nf, more_than=none)
    call table%add('rht_d1', group%rht_d1, more_than=none)
    call table%add('rht_d2', group%rht_d2, more_than=none)
    call table%add('rht_ef_min', group%rht_ef_min, more_than=none, at_most=1.0_wp)
    call table%add('rht_beta_c', group%rht_beta_c, at_least=none, at_most=1.0_wp)
    call table%add('rht_beta_t', group%rht_beta_t, at_least=none, at_most=1.0_wp)
    call table%add('rht_p_crush', group%rht_p_crush, of_pressure, more_than=none, usual=[1e5_wp, 1e10_wp])
    call table%add('rht_p_lock', group%rht_p_lock, of_pressure, more_than=none, usual=[1e7_wp, 1e11_wp])
    call table%add('rht_alpha', group%rht_alpha, more_than=1.0_wp, at_most=3.0_wp)
    call table%add('rht_n_compaction', group%rht_n_compaction, at_least=1.0_wp, at_most=10.0_wp)
    call table%add('rht_a1', group%rht_a1, of_pressure, more_than=none, usual=[1e8_wp, 1e12_wp])
    call table%add('rht_a2', group%rht_a2, of_pressure)
    call table%add('rht_a3', group%rht_a3, of_pressure)
    call table%add('rht_t1', group%rht_t1, of_pressure, more_than=none, usual=[1e8_wp, 1e12_wp])
    call table%add('rht_t2', group%rht_t2, of_pressure)
    call table%add('rht_b0', group%rht_b0, at_least=none, at_most=10.0_wp)
    call table%add('rht_b1', group%rht_b1, at_least=none, at_most=10.0_wp)
    call table%add('failure', group%failure, [character(word_length) :: '', 'damage', 'strain', 'fracture_energy', 'none'])
    call table%add('bulk_viscosity_linear', group%bulk_viscosity_linear, at_least=none, at_most=2.0_wp)
    call table%add('bulk_viscosity_quadratic', group%bulk_viscosity_quadratic, at_least=none, at_most=10.0_wp)
  end subroutine material_keys

end module deck_material
