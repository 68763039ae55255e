!> Shocks and spall in bars of one dimension (uniaxial strain) against theory.
module solid_shocks
  use deck_types, only: material_group
  use kinds, only: wp
  use particles, only: at_position, at_velocity, at_mass, at_volume, at_stress, at_energy, at_damage
  use solid_numerics, only: numerics_type, choose_numerics
  use solid_scenes, only: solid_scene, empty_deck, metal, concrete, add_box, start_scene
  use solid_step, only: advance_solid, project_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: run_copper, run_spall

  !> Two halves of copper that meet.
  type, public :: copper_type
    real(wp) :: pressure = 0 !< behind the shock, Pa
    real(wp) :: speed = 0 !< at which the shocks leave the plane of impact, m/s
    real(wp) :: density = 0 !< behind the shock
    real(wp) :: energy = 0 !< internal, behind the shock, J/kg
    real(wp) :: balance = 0 !< kinetic and internal energy over the first, less 1
  end type copper_type

  !> A bar of concrete with a compressive pulse that comes back from its free end as tension.
  type, public :: spall_type
    real(wp) :: distance = 0 !< from the free end to the first failed particle
    real(wp) :: theory = 0 !< the same
    real(wp) :: time = 0 !< when it failed, after the front of the pulse has met the free end
    real(wp) :: speed = 0 !< of the piece that flies off, 0 if nothing fails
  end type spall_type

contains

  !> A bar of copper of `cells` cells on its length of 0.1 m flies at 2500 m/s against a plane of symmetry, which is another one
  !> that comes at it. Hugoniot: us = 3970 + 1.479 up, density 8960, Grueneisen 2.12: 171.75 GPa, 5167.5 m/s.
  function run_copper(numerics, cells) result(copper)
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: cells
    type(copper_type) :: copper
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    type(material_group) :: group
    type(solid_totals_type) :: totals
    real(wp), parameter :: speed = 2500, shock = 5167.5_wp
    real(wp) :: time, front(2), marks(2), start, x, next
    integer :: i, n, mark
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    group = metal('copper', 'perfect_plasticity')
    group%density = 8960
    group%youngs_modulus = 124e9_wp
    group%poissons_ratio = 0.34_wp
    group%yield_stress = 1e6_wp
    group%eos = 'shock'
    group%sound_speed = 3970
    group%hugoniot_slope = 1.479_wp
    group%grueneisen = 2.12_wp
    group%bulk_viscosity_linear = 0.06_wp
    group%bulk_viscosity_quadratic = 1.5_wp
    scene%deck%material = [group]
    scene%deck%boundary%solid_x_low = 'symmetry'
    call add_box(scene%deck, 'bar', 'copper', [0.0_wp, 0.0_wp, 0.0_wp], [0.1_wp, 1.0_wp, 1.0_wp], 0.05_wp/cells, &
      [-speed, 0.0_wp, 0.0_wp])
    call start_scene(scene, [cells + 10, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [0.1_wp*(cells + 10)/cells, 1.0_wp, 1.0_wp], &
      [cells + 10, 1, 1])
    totals = sum_solid(scene%mesh, scene%solid)
    start = sum(totals%kinetic)
    time = 0
    marks = [0.2_wp, 0.5_wp]*0.1_wp/shock
    do mark = 1, 2
      do while (time < marks(mark))
        limit = solid_limit(scene%mesh, scene%solid)
        call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
        time = time + limit%dt
      end do
      ! the front is where the particles have half their speed
      front(mark) = 0
      next = 0.1_wp
      associate (blk => scene%solid%block(1, 1))
        do i = 1, blk%n
          if (blk%f(i, at_velocity) > -0.5_wp*speed) front(mark) = max(front(mark), blk%f(i, at_position))
        end do
      end associate
      marks(mark) = time
    end do
    copper%speed = (front(2) - front(1))/(marks(2) - marks(1))
    n = 0
    associate (blk => scene%solid%block(1, 1))
      do i = 1, blk%n
        x = blk%f(i, at_position)/front(2)
        if (x < 0.3_wp .or. x > 0.8_wp) cycle
        n = n + 1
        copper%pressure = copper%pressure - sum(blk%f(i, at_stress:at_stress + 2))/3
        copper%density = copper%density + blk%f(i, at_mass)/blk%f(i, at_volume)
        copper%energy = copper%energy + blk%f(i, at_energy)/blk%f(i, at_mass)
      end do
    end associate
    copper%pressure = copper%pressure/n
    copper%density = copper%density/n
    copper%energy = copper%energy/n
    totals = sum_solid(scene%mesh, scene%solid)
    copper%balance = (sum(totals%kinetic) + sum(totals%internal))/start - 1
  end function run_copper

  !> A bar of HJC concrete, 0.6 m long, carries a pulse of compression to its free end, where it comes back as tension. The pulse
  !> rises over 0.04 m and falls linearly over 0.2 m. When its peak, reflected, is at the distance d from the end, it meets what of
  !> the compression still comes in, so the tension there is 2 d/0.2 of the peak, and no more later: the first spall is at d =
  !> 0.1/peak, peak the ratio of the pulse to the strength in uniaxial strain. The concrete breaks as it yields (a tiny strain to
  !> fracture), as the theory has it.
  function run_spall(numerics, cells, peak) result(spall)
    type(numerics_type), intent(in) :: numerics
    integer, intent(in) :: cells
    real(wp), intent(in) :: peak
    type(spall_type) :: spall
    type(solid_scene) :: scene
    type(solid_limit_type) :: limit
    type(material_group) :: group
    real(wp), parameter :: length = 0.6_wp, wide = 0.2_wp, rise = 0.04_wp
    real(wp) :: bulk, shear, modulus, c, strength, stress, x, time, arrival
    integer :: i
    call empty_deck(scene%deck)
    call choose_numerics(scene%deck, numerics)
    group = concrete('concrete')
    group%bulk_viscosity_linear = 0.06_wp
    group%bulk_viscosity_quadratic = 1.5_wp
    group%hjc_ef_min = 1e-5_wp
    group%hjc_d1 = 1e-5_wp
    scene%deck%material = [group]
    call add_box(scene%deck, 'bar', 'concrete', [0.0_wp, 0.0_wp, 0.0_wp], [length, 1.0_wp, 1.0_wp], 0.5_wp*length/cells)
    call start_scene(scene, [cells + 10, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [length*(cells + 10)/cells, 1.0_wp, 1.0_wp], &
      [cells + 10, 1, 1])
    bulk = group%hjc_p_crush/group%hjc_mu_crush
    shear = group%youngs_modulus/(2*(1 + group%poissons_ratio))
    modulus = bulk + 4*shear/3
    c = sqrt(modulus/group%density)
    ! tension p in uniaxial strain comes with q = 2 G/K p, and yields where that is A fc (1 - p/T)
    strength = group%hjc_a*group%hjc_fc/(2*shear/bulk + group%hjc_a*group%hjc_fc/group%hjc_t)*modulus/bulk
    associate (blk => scene%solid%block(1, 1))
      do i = 1, blk%n
        ! peak at x = 0.5
        x = 0.5_wp - blk%f(i, at_position)
        if (x < -rise .or. x > wide) cycle
        stress = -peak*strength*min(1 - x/wide, 1 + x/rise)
        blk%f(i, at_velocity) = -stress/(group%density*c)
        blk%f(i, at_stress) = stress
        blk%f(i, at_stress + 1:at_stress + 2) = stress*(bulk - 2*shear/3)/modulus
        blk%f(i, at_volume) = blk%f(i, at_volume)*(1 + stress/modulus)
      end do
    end associate
    call project_solid(scene%mesh, scene%halo, scene%solid)
    spall%theory = 0.5_wp*wide/peak
    arrival = (length - 0.5_wp)/c
    time = 0
    do while (time < arrival + wide/c)
      limit = solid_limit(scene%mesh, scene%solid)
      call advance_solid(scene%mesh, scene%halo, scene%solid, limit%dt)
      time = time + limit%dt
      associate (blk => scene%solid%block(1, 1))
        if (spall%time <= 0 .and. any(blk%f(:blk%n, at_damage) >= 1)) then
          spall%time = time - arrival
          spall%distance = length - maxval(blk%f(:blk%n, at_position), blk%f(:blk%n, at_damage) >= 1)
        end if
      end associate
    end do
    associate (blk => scene%solid%block(1, 1))
      spall%speed = maxval(blk%f(:blk%n, at_velocity))
    end associate
  end function run_spall

end module solid_shocks
