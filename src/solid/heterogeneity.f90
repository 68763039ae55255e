!> Strength that varies from place to place: gives the particles of the deck's heterogeneous bodies their factors.
!>
!> The whole field is made on every rank, read at this rank's particles and dropped, so no answer depends on ranks or bricks. The
!> factors are columns of the particles and travel with them, into restart files as well.
module heterogeneity
  use deck_types, only: deck_type, heterogeneity_group, find_body, find_material
  use kinds, only: wp
  use mesh, only: mesh_type
  use particle_generation, only: piece_type
  use particles, only: at_position
  use random_field, only: random_field_type, make_random_field, correlation_gaussian, correlation_exponential, &
    distribution_lognormal, distribution_weibull
  use solid_material, only: claim_columns
  use solid_state, only: solid_type
  implicit none
  private
  public :: claim_factors, set_factors

contains

  !> Columns for the factors in the materials that have them. used: material of the deck of each set; before particles are made.
  subroutine claim_factors(deck, used, solid)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:)
    type(solid_type), intent(inout) :: solid
    integer :: i, set
    if (.not. allocated(deck%heterogeneity)) return
    do i = 1, size(deck%heterogeneity)
      do set = 1, solid%n_sets
        if (used(set) /= material_of(deck, deck%heterogeneity(i))) cycle
        associate (m => solid%material(set))
          if (m%at_strength == 0) call claim_columns(m, 1, m%at_strength)
          if (m%at_stiffness == 0 .and. deck%heterogeneity(i)%stiffness_exponent > 0) call claim_columns(m, 1, m%at_stiffness)
        end associate
      end do
    end do
  end subroutine claim_factors

  !> Number of the material in the deck that a group is about.
  pure integer function material_of(deck, group) result(material)
    type(deck_type), intent(in) :: deck
    type(heterogeneity_group), intent(in) :: group
    material = find_material(deck, group%material)
    if (material == 0 .and. find_body(deck, group%body) > 0) material = find_material(deck, &
      deck%body(find_body(deck, group%body))%material)
  end function material_of

  !> Fills the columns: 1 where no group applies, of several groups the last. body: number of each name in deck%body.
  subroutine set_factors(mesh, deck, used, body, pieces, solid)
    type(mesh_type), intent(in) :: mesh
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: used(:), body(:)
    type(piece_type), intent(in) :: pieces(:)
    type(solid_type), intent(inout) :: solid
    type(random_field_type) :: field
    integer :: i, b, set, number
    logical :: concerned(size(pieces))
    if (.not. allocated(deck%heterogeneity)) return
    do set = 1, solid%n_sets
      associate (m => solid%material(set))
        do b = 1, mesh%n_local
          associate (blk => solid%block(set, b))
            if (m%at_strength > 0) blk%f(:blk%n, m%at_strength) = 1
            if (m%at_stiffness > 0) blk%f(:blk%n, m%at_stiffness) = 1
          end associate
        end do
      end associate
    end do
    do i = 1, size(deck%heterogeneity)
      associate (group => deck%heterogeneity(i))
        number = 0
        if (group%body /= '') number = body(find_body(deck, group%body))
        concerned = used(pieces%set) == material_of(deck, group) .and. (number == 0 .or. pieces%body == number)
        if (.not. any(concerned)) cycle
        field = field_over(mesh, group, pack(pieces, concerned))
        do set = 1, solid%n_sets
          if (used(set) == material_of(deck, group)) call apply_field(group, field, set, number, solid)
        end do
      end associate
    end do
  end subroutine set_factors

  !> The field over the box around all pieces that a group is about, as far as they lie in the domain.
  function field_over(mesh, group, pieces) result(field)
    type(mesh_type), intent(in) :: mesh
    type(heterogeneity_group), intent(in) :: group
    type(piece_type), intent(in) :: pieces(:)
    type(random_field_type) :: field
    real(wp) :: lower(3), upper(3)
    integer :: i
    lower = mesh%upper
    upper = mesh%lower
    do i = 1, size(pieces)
      lower = min(lower, max(pieces(i)%shape%lower, mesh%lower))
      upper = max(upper, min(pieces(i)%shape%upper, mesh%upper))
    end do
    field = make_random_field(lower, upper, mesh%active, group%correlation_length, &
      merge(correlation_gaussian, correlation_exponential, group%correlation == 'gaussian'), &
      merge(distribution_lognormal, distribution_weibull, group%distribution == 'lognormal'), group%coefficient_of_variation, &
      group%seed)
  end function field_over

  subroutine apply_field(group, field, set, number, solid)
    type(heterogeneity_group), intent(in) :: group
    type(random_field_type), intent(in) :: field
    integer, intent(in) :: set, number
    type(solid_type), intent(inout) :: solid
    real(wp) :: factor
    integer :: b, i
    associate (m => solid%material(set))
      do b = 1, size(solid%block, 2)
        associate (blk => solid%block(set, b))
          do i = 1, blk%n
            if (number > 0 .and. blk%body(i) /= number) cycle
            factor = field%factor_at(blk%f(i, at_position:at_position + 2))
            blk%f(i, m%at_strength) = factor
            if (m%at_stiffness > 0) blk%f(i, m%at_stiffness) = factor**group%stiffness_exponent
          end do
        end associate
      end do
    end associate
  end subroutine apply_field

end module heterogeneity
