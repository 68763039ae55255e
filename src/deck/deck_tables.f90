!> The groups of the deck: their names, which may be repeated, and the tables of keys of all groups of one deck.
module deck_tables
  use deck_keys, only: key_table
  use deck_types, only: deck_type
  use deck_run, only: run_keys
  use deck_mesh, only: mesh_keys
  use deck_boundary, only: boundary_keys
  use deck_flow, only: flow_keys
  use deck_material, only: material_keys
  use deck_material_test, only: material_test_keys
  use deck_region, only: region_keys
  use deck_charge, only: charge_keys
  use deck_detonator, only: detonator_keys
  use deck_solid, only: solid_keys
  use deck_body, only: body_keys, hole_keys
  use deck_reinforcement, only: reinforcement_keys
  use deck_heterogeneity, only: heterogeneity_keys
  use deck_clamp, only: clamp_keys
  use deck_contact, only: contact_keys
  use deck_coupling, only: coupling_keys
  use deck_stages, only: stages_keys
  use deck_gauge, only: gauge_keys
  use deck_output, only: output_keys
  implicit none
  private
  public :: allocate_groups, group_count, group_number, make_table, make_tables, find_table, may_repeat

  character(16), parameter, public :: group_names(20) = [character(16) :: 'run', 'mesh', 'boundary', 'flow', 'material', &
    'region', 'charge', 'detonator', 'solid', 'body', 'hole', 'reinforcement', 'heterogeneity', 'clamp', 'contact', &
    'coupling', 'stages', 'gauge', 'output', 'material_test'] !< in deck order

contains

  !> Place of the name in group_names, 0 if there is no such group.
  pure integer function group_number(name) result(g)
    character(*), intent(in) :: name
    do g = 1, size(group_names)
      if (group_names(g) == name) return
    end do
    g = 0
  end function group_number

  !> True for a group that a deck may hold more than once.
  pure logical function may_repeat(group)
    character(*), intent(in) :: group
    select case (group)
    case ('material', 'region', 'charge', 'detonator', 'body', 'hole', 'reinforcement', 'heterogeneity', 'clamp', 'contact', &
      'gauge', 'material_test')
      may_repeat = .true.
    case default
      may_repeat = .false.
    end select
  end function may_repeat

  !> Makes room for the repeated groups. count: number of each group in the order of group_names.
  subroutine allocate_groups(deck, count)
    type(deck_type), intent(inout) :: deck
    integer, intent(in) :: count(size(group_names))
    allocate (deck%material(count(5)), deck%region(count(6)), deck%charge(count(7)), deck%detonator(count(8)))
    allocate (deck%body(count(10)), deck%hole(count(11)), deck%reinforcement(count(12)), deck%heterogeneity(count(13)))
    allocate (deck%clamp(count(14)), deck%contact(count(15)), deck%gauge(count(18)), deck%material_test(count(20)))
  end subroutine allocate_groups

  !> How many groups of this name the deck type holds (1 for one that may not be repeated, whether the file has it or not).
  pure integer function group_count(deck, group) result(n)
    type(deck_type), intent(in) :: deck
    character(*), intent(in) :: group
    n = 1
    select case (group)
    case ('material')
      n = size(deck%material)
    case ('region')
      n = size(deck%region)
    case ('charge')
      n = size(deck%charge)
    case ('detonator')
      n = size(deck%detonator)
    case ('body')
      n = size(deck%body)
    case ('hole')
      n = size(deck%hole)
    case ('reinforcement')
      n = size(deck%reinforcement)
    case ('heterogeneity')
      n = size(deck%heterogeneity)
    case ('clamp')
      n = size(deck%clamp)
    case ('contact')
      n = size(deck%contact)
    case ('gauge')
      n = size(deck%gauge)
    case ('material_test')
      n = size(deck%material_test)
    end select
  end function group_count

  !> The table of group number i of this name, pointing into the deck.
  subroutine make_table(deck, group, i, table)
    type(deck_type), intent(inout), target :: deck
    character(*), intent(in) :: group
    integer, intent(in) :: i
    type(key_table), intent(inout) :: table
    select case (group)
    case ('run')
      call run_keys(deck%run, table)
    case ('mesh')
      call mesh_keys(deck%mesh, table)
    case ('boundary')
      call boundary_keys(deck%boundary, table)
    case ('flow')
      call flow_keys(deck%flow, table)
    case ('material')
      call material_keys(deck%material(i), table)
    case ('region')
      call region_keys(deck%region(i), table)
    case ('charge')
      call charge_keys(deck%charge(i), table)
    case ('detonator')
      call detonator_keys(deck%detonator(i), table)
    case ('solid')
      call solid_keys(deck%solid, table)
    case ('body')
      call body_keys(deck%body(i), table)
    case ('hole')
      call hole_keys(deck%hole(i), table)
    case ('reinforcement')
      call reinforcement_keys(deck%reinforcement(i), table)
    case ('heterogeneity')
      call heterogeneity_keys(deck%heterogeneity(i), table)
    case ('clamp')
      call clamp_keys(deck%clamp(i), table)
    case ('contact')
      call contact_keys(deck%contact(i), table)
    case ('coupling')
      call coupling_keys(deck%coupling, table)
    case ('stages')
      call stages_keys(deck%stages, table)
    case ('gauge')
      call gauge_keys(deck%gauge(i), table)
    case ('output')
      call output_keys(deck%output, table)
    case ('material_test')
      call material_test_keys(deck%material_test(i), table)
    end select
    table%index = i
  end subroutine make_table

  !> The tables of all groups, in the order of group_names and, in one name, of the deck.
  !> They point into the deck, which must be a target and live as long as they do.
  subroutine make_tables(deck, tables)
    type(deck_type), intent(inout), target :: deck
    type(key_table), allocatable, intent(out) :: tables(:)
    integer :: g, i, n
    allocate (tables(sum([(group_count(deck, group_names(g)), g=1, size(group_names))])))
    n = 0
    do g = 1, size(group_names)
      do i = 1, group_count(deck, group_names(g))
        n = n + 1
        call make_table(deck, group_names(g), i, tables(n))
      end do
    end do
  end subroutine make_tables

  !> Place in tables of group number i of this name, 0 if there is none.
  pure integer function find_table(tables, group, i) result(k)
    type(key_table), intent(in) :: tables(:)
    character(*), intent(in) :: group
    integer, intent(in) :: i
    do k = 1, size(tables)
      if (tables(k)%group == group) exit
    end do
    k = k + i - 1
    if (k > size(tables)) then
      k = 0
    else if (tables(k)%group /= group) then
      k = 0
    end if
  end function find_table

end module deck_tables
