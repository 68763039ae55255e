!> The whole deck as one type, and the types of its groups under one roof.
module deck_types
  use constants, only: unset
  use deck_keys, only: word_length, path_length
  use deck_run, only: run_group
  use deck_mesh, only: mesh_group
  use deck_boundary, only: boundary_group
  use deck_flow, only: flow_group
  use deck_material, only: material_group
  use deck_material_test, only: material_test_group
  use deck_region, only: region_group
  use deck_charge, only: charge_group
  use deck_detonator, only: detonator_group
  use deck_solid, only: solid_group
  use deck_body, only: body_group, hole_group
  use deck_reinforcement, only: reinforcement_group
  use deck_heterogeneity, only: heterogeneity_group
  use deck_clamp, only: clamp_group
  use deck_contact, only: contact_group
  use deck_coupling, only: coupling_group
  use deck_stages, only: stages_group
  use deck_gauge, only: gauge_group
  use deck_output, only: output_group
  use text, only: lowercase
  implicit none
  private
  public :: unset, word_length, path_length
  public :: run_group, mesh_group, boundary_group, flow_group, material_group, region_group, charge_group, &
    detonator_group, solid_group, material_test_group
  public :: body_group, hole_group, reinforcement_group, heterogeneity_group, clamp_group, contact_group, coupling_group, &
    stages_group, gauge_group, output_group
  public :: find_material, find_body, number_bodies

  !> Everything that a run is asked to do. All numbers are in the unit system run%units; repeated groups stand in the
  !> order of the deck and have size 0 where the deck has none.
  type, public :: deck_type
    character(path_length) :: file = '' !< where it was read from
    character(word_length) :: name = '' !< the file's name without folder and ending
    type(run_group) :: run
    type(mesh_group) :: mesh
    type(boundary_group) :: boundary
    type(flow_group) :: flow
    type(material_group), allocatable :: material(:)
    type(region_group), allocatable :: region(:)
    type(charge_group), allocatable :: charge(:)
    type(detonator_group), allocatable :: detonator(:)
    type(solid_group) :: solid
    type(body_group), allocatable :: body(:)
    type(hole_group), allocatable :: hole(:)
    type(reinforcement_group), allocatable :: reinforcement(:)
    type(heterogeneity_group), allocatable :: heterogeneity(:)
    type(clamp_group), allocatable :: clamp(:)
    type(contact_group), allocatable :: contact(:)
    type(coupling_group) :: coupling
    type(stages_group) :: stages
    type(gauge_group), allocatable :: gauge(:)
    type(output_group) :: output
    type(material_test_group), allocatable :: material_test(:)
    logical :: has_flow = .false. !< there is a region or a charge
    logical :: has_solid = .false. !< there is a body
  end type deck_type

contains

  !> Index of the material of this name (upper and lower case alike), 0 if there is none.
  pure integer function find_material(deck, name) result(i)
    type(deck_type), intent(in) :: deck
    character(*), intent(in) :: name
    do i = 1, size(deck%material)
      if (lowercase(trim(deck%material(i)%name)) == lowercase(trim(name))) return
    end do
    i = 0
  end function find_material

  !> Index of the first body of this name (upper and lower case alike), 0 if there is none.
  pure integer function find_body(deck, name) result(i)
    type(deck_type), intent(in) :: deck
    character(*), intent(in) :: name
    do i = 1, size(deck%body)
      if (lowercase(trim(deck%body(i)%name)) == lowercase(trim(name))) return
    end do
    i = 0
  end function find_body

  !> Numbers the bodies by their names in the order of the deck.
  pure subroutine number_bodies(deck)
    type(deck_type), intent(inout) :: deck
    character(word_length) :: name(size(deck%body))
    integer :: i, n
    n = 0
    do i = 1, size(deck%body)
      name(i) = lowercase(deck%body(i)%name)
      deck%body(i)%first = findloc(name(:i), name(i), dim=1)
      if (deck%body(i)%first == i) then
        n = n + 1
        deck%body(i)%number = n
      else
        deck%body(i)%number = deck%body(deck%body(i)%first)%number
      end if
    end do
  end subroutine number_bodies

end module deck_types
