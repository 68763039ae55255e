!> Checks of the materials: every constant that the laws need, and numbers that fit together.
module deck_check_material
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, kind_real
  use deck_material, only: material_group, material_keys
  use deck_problems, only: problem_list
  use text, only: join, str
  use units, only: from_si, to_si
  implicit none
  private
  public :: check_material, check_name, check_cells_of_cracks

  integer, parameter :: key_length = 24
  character(key_length), parameter :: damage_keys(4) = [character(key_length) :: 'jc_d1', 'jc_d2', 'jc_d3', 'jc_d4']
  character(key_length), parameter :: cracking(6) = [character(key_length) :: 'hjc', 'rht', 'perfect_plasticity', &
    'linear_hardening', 'johnson_cook', 'simplified_johnson_cook']
  character(key_length), parameter :: damaged_metals(4) = [character(key_length) :: 'perfect_plasticity', 'linear_hardening', &
    'johnson_cook', 'simplified_johnson_cook']

contains

  !> Checks one material and fills in what follows from the rest: failure, reference_strain_rate, hardening_modulus.
  subroutine check_material(material, system, table, problems, warnings)
    type(material_group), intent(inout) :: material
    character(*), intent(in) :: system !< unit system of the deck
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    call check_name(material%name, table, problems)
    if (table%incomplete) return
    if (material%eos == '' .and. material%model == '') then
      if (.not. (table%is_given('eos') .or. table%is_given('model'))) call problems%add_at_key(table, '', &
        'a material needs an eos (to flow), a model (for a solid), or a library that has them')
      return
    end if
    call fill_material(material, system)
    if (.not. has_all_constants(material, table, problems)) return
    call warn_of_idle_constants(material, table, warnings)
    call check_failure(material, table, problems, warnings)
    if (material%model == 'hjc') call check_hjc(material, table, problems, warnings)
    if (material%eos == 'cochran_chan') call check_cochran_chan(material, table, problems)
    if (material%eos == 'jwl') call check_afterburn(material, table, problems, warnings)
    if (material%model == 'rht') call check_rht(material, table, problems)
    if (material%model == 'drucker_prager' .and. material%dilatancy_angle > material%friction_angle) &
      call problems%add_at_key(table, 'dilatancy_angle', 'must not lie above friction_angle: shearing would make energy')
    if (material%model == 'johnson_cook' .and. material%melt_temperature <= material%reference_temperature) &
      call problems%add_at_key(table, 'melt_temperature', 'must lie above reference_temperature')
    if (material%model == 'linear_hardening' .and. material%ultimate_stress > 0.0_wp .and. &
        material%ultimate_stress < material%yield_stress) &
      call problems%add_at_key(table, 'ultimate_stress', 'must not lie below yield_stress (0: no limit)')
    if (system /= 'none') call check_sense(material, system, table, warnings)
  end subroutine check_material

  !> Cells in which the elastic energy at the tensile strength alone exceeds the fracture energy cannot soften as they should.
  subroutine check_cells_of_cracks(material, cell, table, warnings)
    type(material_group), intent(in) :: material
    real(wp), intent(in) :: cell !< size
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: warnings
    real(wp) :: strength, largest
    if (material%failure /= 'fracture_energy' .or. table%incomplete) return
    select case (material%model)
    case ('hjc')
      strength = material%hjc_a*material%hjc_fc/(1 + material%hjc_a*material%hjc_fc/(3*material%hjc_t))
    case ('rht')
      strength = material%rht_ft*material%rht_fc
    case default
      return
    end select
    if (.not. strength > 0.0_wp) return
    largest = 2*material%youngs_modulus*material%fracture_energy/strength**2
    if (cell > largest) call warnings%add_at_key(table, 'fracture_energy', 'is less than the elastic energy of a cell of '// &
      str(cell, 3)//' at the tensile strength: such a crack costs more; cells must be smaller than '//str(largest, 3))
  end subroutine check_cells_of_cracks

  !> Names stand in the headings of tables and in paths inside files.
  subroutine check_name(name, table, problems)
    character(*), intent(in) :: name
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    if (scan(name, ',;/\"''') > 0) then
      call problems%add_at_key(table, 'name', 'a name has none of , ; / \ and no quotes')
    else if (name == '' .and. table%is_given('name')) then
      call problems%add_at_key(table, 'name', 'the name is empty')
    end if
  end subroutine check_name

  subroutine fill_material(material, system)
    type(material_group), intent(inout) :: material
    character(*), intent(in) :: system
    if (material%model /= '' .and. .not. material%reference_strain_rate > unset) &
      material%reference_strain_rate = from_si(1.0_wp, 0, 0, -1, system)
    if (material%model == 'linear_hardening' .and. .not. material%hardening_modulus > unset .and. &
        material%yield_stress > unset .and. material%ultimate_stress > 0.0_wp .and. material%failure_strain > 0.0_wp) &
      material%hardening_modulus = max(0.0_wp, material%ultimate_stress - material%yield_stress)/material%failure_strain
    material%per_second = from_si(1.0_wp, 0, 0, -1, system)
    material%ten_megapascal = from_si(1e7_wp, 1, -1, -2, system)
    if (material%model == 'rht' .and. material%rht_fc > unset) call fill_rht(material, system)
    if (material%failure /= '') return
    material%failure = 'none'
    if (material%failure_strain > 0.0_wp) material%failure = 'strain'
    if (material%jc_d1 > unset .or. material%model == 'hjc' .or. material%model == 'rht') material%failure = 'damage'
    if (material%fracture_energy > 0.0_wp .and. any(material%model == cracking)) material%failure = 'fracture_energy'
  end subroutine fill_material

  !> What the strength gives (exponents of the rate, pore crushing at 2/3 fc) and what all concretes share (curve of the solid).
  subroutine fill_rht(material, system)
    type(material_group), intent(inout) :: material
    character(*), intent(in) :: system
    real(wp) :: gpa, fc
    gpa = from_si(1e9_wp, 1, -1, -2, system)
    fc = 10*material%rht_fc/material%ten_megapascal
    if (.not. material%rht_beta_c > unset) material%rht_beta_c = 4/(20 + 3*fc)
    if (.not. material%rht_beta_t > unset) material%rht_beta_t = 2/(20 + fc)
    if (.not. material%rht_p_crush > unset) material%rht_p_crush = material%rht_fc*2/3
    if (.not. material%rht_p_lock > unset) material%rht_p_lock = 6*gpa
    if (.not. material%rht_a1 > unset) material%rht_a1 = 35.27_wp*gpa
    if (.not. material%rht_a2 > unset) material%rht_a2 = 39.58_wp*gpa
    if (.not. material%rht_a3 > unset) material%rht_a3 = 9.04_wp*gpa
    if (.not. material%rht_t1 > unset) material%rht_t1 = material%rht_a1
  end subroutine fill_rht

  logical function has_all_constants(material, table, problems)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    character(key_length), allocatable :: missing(:)
    character(:), allocatable :: hint
    missing = unset_keys(needs_of_eos(material%eos), table)
    has_all_constants = size(missing) == 0
    if (size(missing) > 0) call problems%add_at_key(table, 'eos', 'eos '''//trim(material%eos)//''' also needs '// &
      join(missing, ', '))
    missing = unset_keys(needs_of_model(material%model), table)
    has_all_constants = has_all_constants .and. size(missing) == 0
    hint = ''
    if (any(missing == 'hardening_modulus')) hint = &
      ' (hardening_modulus may follow from yield_stress, ultimate_stress and failure_strain)'
    if (size(missing) > 0) call problems%add_at_key(table, 'model', 'model '''//trim(material%model)//''' also needs '// &
      join(missing, ', ')//hint)
    if (material%model == 'fluid' .and. material%eos == '') then
      has_all_constants = .false.
      call problems%add_at_key(table, 'model', 'model ''fluid'' also needs an eos')
    end if
  end function has_all_constants

  ! Those of the names whose number is unset though the deck did not try to give it.
  pure function unset_keys(names, table) result(missing)
    character(key_length), intent(in) :: names(:)
    type(key_table), intent(in) :: table
    character(key_length), allocatable :: missing(:)
    logical :: absent(size(names))
    integer :: i
    do i = 1, size(names)
      absent(i) = .not. (table%key(table%find(names(i)))%real_element(1) > unset .or. table%is_given(names(i)))
    end do
    missing = pack(names, absent)
  end function unset_keys

  pure function needs_of_eos(eos) result(names)
    character(*), intent(in) :: eos
    character(key_length), allocatable :: names(:)
    names = [character(key_length) ::]
    select case (eos)
    case ('ideal_gas')
      names = [character(key_length) :: 'gamma']
    case ('stiffened_gas')
      names = [character(key_length) :: 'gamma', 'p_infinity']
    case ('jwl')
      names = [character(key_length) :: 'density', 'jwl_a', 'jwl_b', 'jwl_r1', 'jwl_r2', 'jwl_omega', 'energy_per_volume']
    case ('cochran_chan')
      names = [character(key_length) :: 'density', 'grueneisen', 'cochran_chan_a1', 'cochran_chan_a2', 'cochran_chan_e1', &
        'cochran_chan_e2']
    case ('shock')
      names = [character(key_length) :: 'density', 'grueneisen', 'sound_speed', 'hugoniot_slope']
    case ('polynomial')
      names = [character(key_length) :: 'density', 'grueneisen', 'polynomial_k1']
    end select
  end function needs_of_eos

  pure function needs_of_model(model) result(names)
    character(*), intent(in) :: model
    character(key_length), allocatable :: names(:)
    names = [character(key_length) ::]
    if (model == '') return
    names = [character(key_length) :: 'density']
    if (model == 'fluid' .or. model == 'rigid') return
    names = [character(key_length) :: names, 'youngs_modulus', 'poissons_ratio']
    select case (model)
    case ('perfect_plasticity')
      names = [character(key_length) :: names, 'yield_stress']
    case ('linear_hardening')
      names = [character(key_length) :: names, 'yield_stress', 'hardening_modulus']
    case ('simplified_johnson_cook')
      names = [character(key_length) :: names, 'jc_a', 'jc_b', 'jc_n', 'jc_c']
    case ('johnson_cook')
      names = [character(key_length) :: names, 'jc_a', 'jc_b', 'jc_n', 'jc_c', 'jc_m', 'melt_temperature', &
        'reference_temperature', 'specific_heat']
    case ('rht')
      names = [character(key_length) :: names, 'rht_fc']
    case ('drucker_prager')
      names = [character(key_length) :: names, 'friction_angle', 'cohesion']
    case ('hjc')
      names = [character(key_length) :: names, 'hjc_a', 'hjc_b', 'hjc_n', 'hjc_c', 'hjc_fc', 'hjc_smax', 'hjc_t', &
        'hjc_d1', 'hjc_d2', 'hjc_ef_min', 'hjc_p_crush', 'hjc_mu_crush', 'hjc_k1', 'hjc_k2', 'hjc_k3', 'hjc_p_lock', &
        'hjc_mu_lock']
    end select
  end function needs_of_model

  pure function options_of(material) result(names)
    type(material_group), intent(in) :: material
    character(key_length), allocatable :: names(:)
    names = [character(key_length) :: 'name', 'library', 'eos', 'model', 'density']
    if (any(material%eos == [character(key_length) :: 'ideal_gas', 'stiffened_gas'])) &
      names = [character(key_length) :: names, 'energy_offset']
    if (material%eos == 'jwl') names = [character(key_length) :: names, 'afterburn_energy', 'afterburn_start', 'afterburn_end']
    if (material%eos == 'polynomial') names = [character(key_length) :: names, 'polynomial_k2', 'polynomial_k3']
    if (material%model /= '' .and. material%model /= 'rigid') names = [character(key_length) :: names, 'bulk_viscosity_linear', &
      'bulk_viscosity_quadratic', 'failure', 'failure_strain']
    select case (material%model)
    case ('elastic')
      names = [character(key_length) :: names, 'tensile_limit']
    case ('perfect_plasticity')
      names = [character(key_length) :: names, damage_keys, 'tensile_limit', 'fracture_energy']
    case ('linear_hardening')
      names = [character(key_length) :: names, damage_keys, 'tensile_limit', 'ultimate_stress', 'fracture_energy']
    case ('simplified_johnson_cook')
      names = [character(key_length) :: names, damage_keys, 'tensile_limit', 'reference_strain_rate', &
        'fracture_energy']
    case ('johnson_cook')
      names = [character(key_length) :: names, damage_keys, 'jc_d5', 'tensile_limit', 'taylor_quinney', &
        'reference_strain_rate', 'fracture_energy']
    case ('drucker_prager')
      names = [character(key_length) :: names, 'dilatancy_angle', 'tensile_limit']
    case ('hjc')
      names = [character(key_length) :: names, 'hjc_lock_strain', 'reference_strain_rate', 'fracture_energy']
    case ('rht')
      names = [character(key_length) :: names, 'fracture_energy', 'rht_fs', 'rht_ft', 'rht_a', 'rht_n', 'rht_q0', 'rht_b', &
        'rht_gc', 'rht_gt', 'rht_xi', 'rht_af', 'rht_nf', 'rht_d1', 'rht_d2', 'rht_ef_min', 'rht_beta_c', 'rht_beta_t', &
        'rht_p_crush', 'rht_p_lock', 'rht_alpha', 'rht_n_compaction', 'rht_a1', 'rht_a2', 'rht_a3', 'rht_t1', 'rht_t2', 'rht_b0', &
        'rht_b1']
    end select
  end function options_of

  ! Constants that the deck gives and no law of this material reads. Those that stand at their default say nothing.
  subroutine warn_of_idle_constants(material, table, warnings)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: warnings
    type(material_group), target :: fresh
    type(key_table) :: defaults
    character(key_length), allocatable :: used(:)
    character(:), allocatable :: laws
    integer :: i
    allocate (used(0))
    used = [character(key_length) :: needs_of_eos(material%eos), needs_of_model(material%model), options_of(material)]
    laws = 'eos '''//trim(material%eos)//''''
    if (material%eos == '') laws = 'model '''//trim(material%model)//''''
    if (material%eos /= '' .and. material%model /= '') laws = laws//' and model '''//trim(material%model)//''''
    call material_keys(fresh, defaults)
    do i = 1, table%n
      associate (key => table%key(i))
        if (key%kind /= kind_real .or. .not. any(key%given) .or. any(used == key%name)) cycle
        if (abs(key%real_element(1) - defaults%key(i)%real_element(1)) <= 0.0_wp) cycle
        if (key%name == 'reference_strain_rate' .and. material%model /= '') cycle
        call warnings%add_at_key(table, trim(key%name), 'has no effect with '//laws)
      end associate
    end do
  end subroutine warn_of_idle_constants

  subroutine check_failure(material, table, problems, warnings)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    character(key_length), allocatable :: missing(:)
    if (material%failure == 'strain' .and. .not. material%failure_strain > 0.0_wp) then
      call problems%add_at_key(table, 'failure', 'failure = ''strain'' also needs failure_strain')
    else if (material%failure == 'fracture_energy') then
      if (.not. any(material%model == cracking)) then
        call problems%add_at_key(table, 'failure', 'fracture_energy is for hjc, rht and metals with plasticity')
      else if (any(material%model == damaged_metals) .and. .not. material%failure_strain > 0.0_wp) then
        call problems%add_at_key(table, 'failure', 'failure = ''fracture_energy'' of a metal also needs failure_strain')
      else if (.not. material%fracture_energy > 0.0_wp) then
        call problems%add_at_key(table, 'failure', 'failure = ''fracture_energy'' also needs fracture_energy')
      end if
    else if (material%failure == 'damage' .and. any(material%model == damaged_metals)) then
      missing = unset_keys(damage_keys, table)
      if (size(missing) > 0) call problems%add_at_key(table, 'failure', &
        'failure = ''damage'' of a metal also needs '//join(missing, ', '))
    else if (material%failure == 'damage' .and. material%model /= 'hjc' .and. material%model /= 'rht') then
      call problems%add_at_key(table, 'failure', 'model '''//trim(material%model)//''' has no damage (allowed: strain, none)')
    end if
    if (material%fracture_energy > 0.0_wp .and. material%failure /= 'fracture_energy' .and. &
      any(material%model == cracking)) call warnings%add_at_key(table, 'fracture_energy', &
      'has no effect with failure = '''//trim(material%failure)//'''; failure = ''fracture_energy'' uses it')
    if (material%tensile_rate_factor /= 'none' .and. material%model /= 'hjc') &
      call problems%add_at_key(table, 'tensile_rate_factor', 'is for the model hjc (rht has rates of its own)')
  end subroutine check_failure

  subroutine check_rht(material, table, problems)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    real(wp) :: c, section
    if (material%rht_p_lock <= material%rht_p_crush) &
      call problems%add_at_key(table, 'rht_p_lock', 'must lie above rht_p_crush')
    ! the strength must vanish at a tensile pressure, which must lie beyond that of uniaxial tension
    c = 3*(1 - material%rht_q0**2)
    section = (sqrt(c*(1 - material%rht_q0**2)) + (2*material%rht_q0 - 1)*sqrt(max(c + 5*material%rht_q0**2 - 4*material%rht_q0, &
      0.0_wp)))/(c + (1 - 2*material%rht_q0)**2) ! between the meridians, at 30 degrees
    if (section*material%rht_ft >= material%rht_q0*material%rht_fs) call problems%add_at_key(table, 'rht_ft', &
      'must be less than '//str(material%rht_q0*material%rht_fs/section, 3)//', or the strength does not vanish in tension')
  end subroutine check_rht

  ! Sound at rest: r c**2 = A1 (E1 - 1 - g) - A2 (E2 - 1 - g) at V = 1 and p = 0. Thinned out the second term is left alone.
  subroutine check_cochran_chan(material, table, problems)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems
    if (min(material%grueneisen, material%cochran_chan_a1, material%cochran_chan_a2, material%cochran_chan_e1, &
      material%cochran_chan_e2) <= unset) return ! given, but out of range
    associate (g => material%grueneisen, e1 => material%cochran_chan_e1, e2 => material%cochran_chan_e2)
      if (e2 >= e1) then
        call problems%add_at_key(table, 'cochran_chan_e2', 'must be less than cochran_chan_e1')
      else if (e2 - 1 > g) then
        call problems%add_at_key(table, 'grueneisen', 'must not be less than cochran_chan_e2 - 1: thinned out it has no sound')
      else if (material%cochran_chan_a1*(e1 - 1 - g) - material%cochran_chan_a2*(e2 - 1 - g) <= 0.0_wp) then
        call problems%add_at_key(table, 'cochran_chan_a1', 'with these constants there is no sound at rest')
      end if
    end associate
  end subroutine check_cochran_chan

  ! The crush curve must rise from (0, 0) over crush and lock, and its last part must reach P_lock.
  subroutine check_hjc(material, table, problems, warnings)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    real(wp) :: m, mu_plock, mu_lock, ratio, slope
    integer :: i
    if (material%hjc_p_lock <= material%hjc_p_crush) then
      call problems%add_at_key(table, 'hjc_p_lock', 'must lie above hjc_p_crush')
      return
    end if
    if (material%hjc_mu_lock <= material%hjc_mu_crush) then
      call problems%add_at_key(table, 'hjc_mu_lock', 'must lie above hjc_mu_crush')
      return
    end if
    if (material%hjc_t >= material%hjc_fc) call problems%add_at_key(table, 'hjc_t', 'the tensile limit must lie below hjc_fc')
    m = strain_at_lock(material)
    if (m < 0.0_wp) then
      call problems%add_at_key(table, 'hjc_k1', 'K1 m + K2 m^2 + K3 m^3 does not reach hjc_p_lock for m up to 1')
      return
    end if
    do i = 0, 100
      slope = material%hjc_k1 + m*0.02_wp*i*(2*material%hjc_k2 + 3*material%hjc_k3*m*0.02_wp*i)
      if (slope > 0.0_wp) cycle
      call problems%add_at_key(table, 'hjc_k2', 'K1 m + K2 m^2 + K3 m^3 falls with m at m = '//str(m*0.02_wp*i, 3))
      return
    end do
    if (material%hjc_lock_strain == 'lock') then
      mu_lock = material%hjc_mu_lock
      mu_plock = mu_lock + m*(1 + mu_lock)
    else
      mu_plock = material%hjc_mu_lock
      mu_lock = (mu_plock - m)/(1 + m)
      if (mu_lock <= 0.0_wp) call problems%add_at_key(table, 'hjc_mu_lock', 'as the strain at hjc_p_lock it must be more than '// &
        str(m, 4)//', where K1 m + K2 m^2 + K3 m^3 reaches it')
    end if
    slope = (material%hjc_p_lock - material%hjc_p_crush)/(mu_plock - material%hjc_mu_crush)
    ratio = material%hjc_p_crush/material%hjc_mu_crush
    if (slope > ratio .and. slope > material%hjc_k1) call warnings%add_at_key(table, 'hjc_p_lock', &
      'the crush phase is stiffer than the elastic phase before it and the solid behind it')
    ratio = ratio/(material%youngs_modulus/(3*(1 - 2*material%poissons_ratio)))
    if (ratio < 0.2_wp .or. ratio > 5.0_wp) call warnings%add_at_key(table, 'hjc_p_crush', &
      'hjc_p_crush/hjc_mu_crush is '//str(ratio, 3)//' times the bulk modulus from youngs_modulus and poissons_ratio')
  end subroutine check_hjc

  ! m in (0, 1] where the solid's pressure first reaches P_lock; -1 if it does not.
  pure real(wp) function strain_at_lock(material) result(m)
    type(material_group), intent(in) :: material
    real(wp) :: low, high
    integer :: i
    integer, parameter :: n = 1000
    do i = 1, n
      high = real(i, wp)/n
      if (solid_pressure(material, high) >= material%hjc_p_lock) exit
    end do
    m = -1
    if (i > n) return
    low = high - 1.0_wp/n
    do i = 1, 60
      m = 0.5_wp*(low + high)
      if (solid_pressure(material, m) < material%hjc_p_lock) then
        low = m
      else
        high = m
      end if
    end do
  end function strain_at_lock

  subroutine check_afterburn(material, table, problems, warnings)
    type(material_group), intent(in) :: material
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: problems, warnings
    if (.not. material%afterburn_energy > 0.0_wp) then
      if (material%afterburn_start > 0.0_wp .or. material%afterburn_end > unset) call warnings%add_at_key(table, &
        'afterburn_energy', 'is 0: no afterburn between the times that are given')
    else if (.not. (material%afterburn_end > unset .or. table%is_given('afterburn_end'))) then
      call problems%add_at_key(table, 'afterburn_energy', 'also needs afterburn_end')
    else if (.not. material%afterburn_end > material%afterburn_start) then
      call problems%add_at_key(table, 'afterburn_end', 'must lie after afterburn_start')
    end if
  end subroutine check_afterburn

  pure real(wp) function solid_pressure(material, m)
    type(material_group), intent(in) :: material
    real(wp), intent(in) :: m
    solid_pressure = m*(material%hjc_k1 + m*(material%hjc_k2 + m*material%hjc_k3))
  end function solid_pressure

  ! Numbers that are each possible but not together: mostly one of them is in another unit system.
  subroutine check_sense(material, system, table, warnings)
    type(material_group), intent(in) :: material
    character(*), intent(in) :: system
    type(key_table), intent(in) :: table
    type(problem_list), intent(inout) :: warnings
    real(wp) :: density, speed, energy
    logical :: is_condensed
    density = 0
    is_condensed = any(material%eos == [character(key_length) :: 'cochran_chan', 'shock', 'polynomial'])
    if (material%density > unset) density = to_si(material%density, 1, -3, 0, system)
    if ((material%model /= '' .or. material%eos == 'jwl' .or. is_condensed) .and. density < 50.0_wp) then
      if (material%model /= 'fluid') call warnings%add_at_key(table, 'density', 'is '//str(density, 3)// &
        ' kg/m^3, less than any solid, liquid or explosive')
    else if (material%youngs_modulus > unset .and. material%model /= '') then
      speed = sqrt(to_si(material%youngs_modulus, 1, -1, -2, system)/density)
      if (speed < 20.0_wp .or. speed > 3e4_wp) call warnings%add_at_key(table, 'youngs_modulus', &
        'with this density gives sound a speed of '//str(speed, 3)//' m/s: are both in the units '//system//'?')
    else if (material%eos == 'polynomial' .and. material%polynomial_k1 > unset) then
      speed = sqrt(to_si(material%polynomial_k1, 1, -1, -2, system)/density)
      if (speed < 100.0_wp .or. speed > 3e4_wp) call warnings%add_at_key(table, 'polynomial_k1', &
        'with this density gives sound a speed of '//str(speed, 3)//' m/s: are both in the units '//system//'?')
    else if (material%eos == 'jwl') then
      energy = to_si(material%energy_per_volume, 1, -1, -2, system)/density
      if (energy < 3e5_wp .or. energy > 3e7_wp) call warnings%add_at_key(table, 'energy_per_volume', &
        'with this density gives '//str(energy*1e-6_wp, 3)//' MJ/kg, TNT has 4.3: are both in the units '//system//'?')
    end if
  end subroutine check_sense

end module deck_check_material
