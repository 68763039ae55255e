!> Small scenes of solids for tests: a deck put together in code, and what is made of it.
module solid_scenes
  use deck_types, only: number_bodies, deck_type, material_group, body_group
  use halo, only: halo_type, plan_halo
  use kinds, only: wp
  use mesh, only: mesh_type, build_mesh
  use particle_generation, only: piece_type
  use solid_setup, only: setup_solid
  use solid_state, only: solid_type
  use solid_step, only: project_solid
  implicit none
  private
  public :: empty_deck, metal, concrete, add_box, start_scene, set_faces

  !> All that a run of the solid needs.
  type, public :: solid_scene
    type(mesh_type) :: mesh
    type(halo_type) :: halo
    type(deck_type) :: deck
    type(solid_type) :: solid
    type(piece_type), allocatable :: pieces(:)
  end type solid_scene

contains

  !> A deck without anything; every face of the domain is free for the solid.
  subroutine empty_deck(deck)
    type(deck_type), intent(out) :: deck
    allocate (deck%material(0), deck%region(0), deck%charge(0), deck%body(0), deck%hole(0), deck%reinforcement(0))
    allocate (deck%heterogeneity(0), deck%clamp(0), deck%contact(0), deck%gauge(0), deck%material_test(0))
    call set_faces(deck, 'free')
  end subroutine empty_deck

  !> Gives all six faces the same kind.
  subroutine set_faces(deck, kind)
    type(deck_type), intent(inout) :: deck
    character(*), intent(in) :: kind
    deck%boundary%solid_x_low = kind
    deck%boundary%solid_x_high = kind
    deck%boundary%solid_y_low = kind
    deck%boundary%solid_y_high = kind
    deck%boundary%solid_z_low = kind
    deck%boundary%solid_z_high = kind
  end subroutine set_faces

  !> A metal with numbers near those of steel (SI).
  function metal(name, model) result(group)
    character(*), intent(in) :: name, model
    type(material_group) :: group
    group%name = name
    group%model = model
    group%density = 8000
    group%youngs_modulus = 200e9_wp
    group%poissons_ratio = 0.3_wp
    group%yield_stress = 300e6_wp
    group%hardening_modulus = 1e9_wp
    group%jc_a = 300e6_wp
    group%jc_b = 500e6_wp
    group%jc_n = 0.5_wp
    group%jc_c = 0.02_wp
    group%jc_m = 1
    group%melt_temperature = 1300
    group%reference_temperature = 300
    group%specific_heat = 400
    group%reference_strain_rate = 1
    group%failure = 'strain'
    group%bulk_viscosity_linear = 0
    group%bulk_viscosity_quadratic = 0
  end function metal

  !> The concrete of the slab (SI).
  function concrete(name) result(group)
    character(*), intent(in) :: name
    type(material_group) :: group
    group%name = name
    group%model = 'hjc'
    group%density = 2440
    group%youngs_modulus = 35.66e9_wp
    group%poissons_ratio = 0.2_wp
    group%hjc_a = 0.79_wp
    group%hjc_b = 1.6_wp
    group%hjc_n = 0.61_wp
    group%hjc_c = 0.007_wp
    group%hjc_fc = 39.5e6_wp
    group%hjc_smax = 7
    group%hjc_t = 4.1e6_wp
    group%hjc_d1 = 0.04_wp
    group%hjc_d2 = 1
    group%hjc_ef_min = 0.0008_wp
    group%hjc_p_crush = 16e6_wp
    group%hjc_mu_crush = 0.001_wp
    group%hjc_k1 = 85e9_wp
    group%hjc_k2 = -171e9_wp
    group%hjc_k3 = 208e9_wp
    group%hjc_p_lock = 0.8e9_wp
    group%hjc_mu_lock = 0.1_wp
    group%hjc_lock_strain = 'lock'
    group%reference_strain_rate = 1
    group%failure = 'damage'
    group%bulk_viscosity_linear = 0
    group%bulk_viscosity_quadratic = 0
  end function concrete

  !> Adds a box to the deck.
  subroutine add_box(deck, name, material, lower, upper, spacing, velocity)
    type(deck_type), intent(inout) :: deck
    character(*), intent(in) :: name, material
    real(wp), intent(in) :: lower(3), upper(3), spacing
    real(wp), intent(in), optional :: velocity(3)
    type(body_group) :: group
    group%name = name
    group%material = material
    group%shape = 'box'
    group%lower = lower
    group%upper = upper
    group%spacing = spacing
    if (present(velocity)) group%velocity = velocity
    deck%body = [deck%body, group]
  end subroutine add_box

  !> Mesh, particles and first projection of the scene's deck. brick: cells of a brick, 0 to have it chosen; loaded: particles
  !> carry forces from outside.
  subroutine start_scene(scene, cells, lower, upper, brick, periodic, loaded)
    type(solid_scene), intent(inout) :: scene
    integer, intent(in) :: cells(3), brick(3)
    real(wp), intent(in) :: lower(3), upper(3)
    logical, intent(in), optional :: periodic(3), loaded
    logical :: wraps(3)
    wraps = .false.
    if (present(periodic)) wraps = periodic
    call build_mesh(scene%mesh, cells, lower, upper, brick, wraps, 2)
    call plan_halo(scene%mesh, scene%halo)
    call number_bodies(scene%deck)
    call setup_solid(scene%mesh, scene%deck, scene%solid, scene%pieces, loaded)
    call project_solid(scene%mesh, scene%halo, scene%solid)
  end subroutine start_scene

end module solid_scenes
