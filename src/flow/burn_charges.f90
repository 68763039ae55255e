!> The charges and detonators of a deck as the programmed burn takes them.
module burn_charges
  use burn, only: burning_charge, detonator_type, detonator_point, detonator_line, detonator_plane
  use chapman_jouguet, only: chapman_jouguet_state
  use deck_types, only: deck_type, charge_group, detonator_group
  use equation_of_state, only: eos_type
  use errors, only: fatal, warn, exit_bad_input
  use flow_shapes, only: filled_shape
  use kinds, only: wp
  use mesh, only: mesh_type
  use parallel, only: is_root
  use text, only: str
  implicit none
  private
  public :: charges_of_deck, is_programmed, unburnt_state_energy

  real(wp), parameter :: speed_tolerance = 0.03_wp !< of a given detonation speed against that of the JWL
  real(wp), parameter :: near = 3 !< cells that a detonator may lie outside of its charge without a warning

contains

  !> All charges of the deck, in its order. shape, material: of each charge; eos: of the flow's materials.
  function charges_of_deck(mesh, deck, shape, material, eos) result(charges)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(filled_shape), intent(in) :: shape(:)
    integer, intent(in) :: material(:)
    type(eos_type), intent(in) :: eos(:)
    type(burning_charge), allocatable :: charges(:)
    integer :: c
    allocate (charges(size(deck%charge)))
    do c = 1, size(charges)
      charges(c)%shape = shape(c)
      charges(c)%material = material(c)
      allocate (charges(c)%detonator(0))
      if (.not. is_programmed(deck%charge(c)) .or. deck%charge(c)%is_mapped()) cycle ! a mapped one has burnt
      charges(c)%energy = eos(material(c))%jwl%energy_per_volume/eos(material(c))%density &
        - unburnt_state_energy(eos(material(c)), deck%flow%ambient_pressure)
      charges(c)%speed = speed_of(deck%charge(c), eos(material(c)))
      charges(c)%detonator = detonators_of(deck, c)
      if (size(charges(c)%detonator) == 0) charges(c)%detonator = [detonator_type(position=deck%charge(c)%center)]
    end do
    call warn_of_far_detonators(mesh, deck, charges)
  end function charges_of_deck

  pure logical function is_programmed(charge)
    type(charge_group), intent(in) :: charge
    is_programmed = charge%detonation == 'programmed'
  end function is_programmed

  !> Energy per mass of unburnt explosive, in the reckoning of the products.
  pure real(wp) function unburnt_state_energy(eos, ambient_pressure)
    type(eos_type), intent(in) :: eos
    real(wp), intent(in) :: ambient_pressure
    unburnt_state_energy = eos%energy(eos%density, ambient_pressure)
  end function unburnt_state_energy

  !> Speed of the front: the given one, or that of Chapman and Jouguet. Fatal (bad input) where the JWL has none.
  real(wp) function speed_of(charge, eos) result(speed)
    type(charge_group), intent(in) :: charge
    type(eos_type), intent(in) :: eos
    real(wp) :: pressure, relative_volume
    call chapman_jouguet_state(eos%jwl, speed, pressure, relative_volume)
    if (.not. speed > 0) call fatal('charge on line '//str(charge%line)//': the JWL constants of '''// &
      trim(charge%explosive)//''' allow no detonation', exit_bad_input)
    if (.not. charge%detonation_speed > 0) return
    if (abs(charge%detonation_speed - speed) > speed_tolerance*speed .and. is_root()) call warn('charge on line '// &
      str(charge%line)//': detonation_speed is '//str(charge%detonation_speed, 4)//', the JWL constants of '''// &
      trim(charge%explosive)//''' make it '//str(speed, 4))
    speed = charge%detonation_speed
  end function speed_of

  !> The detonators that light charge number c.
  pure function detonators_of(deck, c) result(detonators)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    type(detonator_type), allocatable :: detonators(:)
    integer :: i
    allocate (detonators(0))
    if (.not. allocated(deck%detonator)) return
    do i = 1, size(deck%detonator)
      if (lights(deck%detonator(i), c)) detonators = [detonators, detonator_of(deck%detonator(i))]
    end do
  end function detonators_of

  pure logical function lights(detonator, c)
    type(detonator_group), intent(in) :: detonator
    integer, intent(in) :: c
    lights = detonator%charge == 0 .or. detonator%charge == c
  end function lights

  pure function detonator_of(group) result(detonator)
    type(detonator_group), intent(in) :: group
    type(detonator_type) :: detonator
    detonator%position = group%position
    detonator%time = group%time
    select case (trim(group%shape))
    case ('line')
      detonator%kind = detonator_line
      detonator%end = group%end
    case ('plane')
      detonator%kind = detonator_plane
      detonator%normal = group%normal
    case default
      detonator%kind = detonator_point
    end select
  end function detonator_of

  !> A detonator that no charge is near to is mostly a slip. Planes reach everywhere.
  subroutine warn_of_far_detonators(mesh, deck, charges)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    type(burning_charge), intent(in) :: charges(:)
    type(detonator_type) :: detonator
    real(wp) :: distance
    integer :: i, c
    if (.not. allocated(deck%detonator) .or. .not. is_root()) return
    do i = 1, size(deck%detonator)
      detonator = detonator_of(deck%detonator(i))
      if (detonator%kind == detonator_plane) cycle
      distance = huge(1.0_wp)
      do c = 1, size(charges)
        if (size(charges(c)%detonator) == 0 .or. .not. lights(deck%detonator(i), c)) cycle
        distance = min(distance, charges(c)%shape%distance(detonator%position))
        if (detonator%kind == detonator_line) distance = min(distance, charges(c)%shape%distance(detonator%end), &
          charges(c)%shape%distance(0.5_wp*(detonator%position + detonator%end)))
      end do
      if (distance > near*maxval(mesh%spacing, mesh%active) .and. distance < huge(1.0_wp)) call warn('detonator '//str(i)// &
        ' on line '//str(deck%detonator(i)%line)//' lies '//str(distance, 4)//' outside of what it lights')
    end do
  end subroutine warn_of_far_detonators

end module burn_charges
