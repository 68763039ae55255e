!> history.csv: masses, momenta and energies of the scene over time, and what keeps them in balance.
module history
  use balance, only: balance_type
  use csv_series, only: series, open_series, put_row
  use kinds, only: wp
  use scene, only: scene_type
  use solid_state, only: book_lost_mass, book_lost_count, book_contact_impulse, book_contact_work, n_books, n_contact_books, &
    material_names, sum_by_material
  use text, only: append
  use units, only: unit_labels_type
  implicit none
  private
  public :: open_history, put_history

  integer, parameter :: column_length = 96

contains

  !> Opens the table; resume_time: go on after a restart.
  subroutine open_history(table, file, scene, labels, resume_time)
    type(series), intent(out) :: table
    character(*), intent(in) :: file
    type(scene_type), intent(in) :: scene
    type(unit_labels_type), intent(in) :: labels
    real(wp), intent(in), optional :: resume_time
    character(column_length), allocatable :: column(:)
    character(64), allocatable :: material(:)
    integer :: k
    allocate (column(0))
    call add('time', labels%time)
    call add('dt', labels%time)
    call add('flow steps', '-')
    call add('solid steps', '-')
    if (scene%has_flow) then
      do k = 1, scene%flow%n_materials
        call add('flow.mass.'//trim(scene%flow%name(k)), labels%mass)
      end do
      do k = 1, scene%flow%n_materials
        call add('flow.internal_energy.'//trim(scene%flow%name(k)), labels%energy)
      end do
      call add('flow.kinetic_energy', labels%energy)
      call add_vector('flow.momentum', labels%momentum)
      call add('flow.energy_through_boundary', labels%energy)
      if (scene%flow%burn_total > 0) call add('flow.energy_to_release', labels%energy)
      if (any(scene%flow%afterburn%energy > 0)) call add('flow.energy_of_afterburn', labels%energy)
    end if
    if (scene%has_solid) then
      material = material_names(scene%solid)
      do k = 1, size(material)
        call add('solid.mass.'//trim(material(k)), labels%mass)
        call add('solid.internal_energy.'//trim(material(k)), labels%energy)
        call add('solid.kinetic_energy.'//trim(material(k)), labels%energy)
        call add('solid.plastic_work.'//trim(material(k)), labels%energy)
        call add('solid.failed_mass.'//trim(material(k)), labels%mass)
      end do
      call add_vector('solid.momentum', labels%momentum)
      call add_vector('solid.impulse_of_supports', labels%momentum)
      call add('solid.mass_that_left', labels%mass)
      call add('solid.particles_that_left', '-')
      if (allocated(scene%solid%pair)) then
        do k = 1, size(scene%solid%pair)
          call add_vector('contact.impulse.'//trim(scene%solid%pair(k)%name), labels%momentum)
          call add('contact.friction_work.'//trim(scene%solid%pair(k)%name), labels%energy)
        end do
      end if
    end if
    if (scene%coupled) then
      call add_vector('coupling.impulse_on_solid', labels%momentum)
      call add_vector('coupling.impulse_undelivered', labels%momentum)
      call add('coupling.work_on_solid', labels%energy)
      call add('coupling.energy_taken_from_flow', labels%energy)
      call add('coupling.mass_uncovered', labels%mass)
      call add('coupling.energy_uncovered', labels%energy)
    end if
    call add('balance.mass', labels%mass)
    call add_vector('balance.momentum', labels%momentum)
    call add('balance.energy', labels%energy)
    call open_series(table, file, column, resume_time)

  contains

    subroutine add(name, unit)
      character(*), intent(in) :: name, unit
      call append(column, name//' ['//trim(unit)//']')
    end subroutine add

    subroutine add_vector(name, unit)
      character(*), intent(in) :: name, unit
      integer :: d
      do d = 1, 3
        if (scene%mesh%active(d)) call add(name//'_'//'xyz'(d:d), unit)
      end do
    end subroutine add_vector

  end subroutine open_history

  !> Adds the row of the present time, in the order of the columns above.
  subroutine put_history(table, scene, balance)
    type(series), intent(inout) :: table
    type(scene_type), intent(in) :: scene
    type(balance_type), intent(in) :: balance
    real(wp), allocatable :: row(:), by_material(:, :)
    integer :: k
    allocate (row(0))
    row = [row, scene%clock%time, scene%clock%dt, real(scene%clock%flow_steps, wp), real(scene%clock%solid_steps, wp)]
    if (scene%has_flow) row = [row, balance%flow%mass, balance%flow%internal, balance%flow%kinetic, &
                               pack(balance%flow%momentum, scene%mesh%active), balance%boundary_energy]
    if (scene%has_flow) then
      if (scene%flow%burn_total > 0) row = [row, balance%unburnt]
      if (any(scene%flow%afterburn%energy > 0)) row = [row, balance%flow%afterburnt]
    end if
    if (scene%has_solid) then
      associate (solid => balance%solid)
        associate (s => scene%solid)
          by_material = reshape([sum_by_material(s, solid%mass), sum_by_material(s, solid%internal), &
                                 sum_by_material(s, solid%kinetic), sum_by_material(s, solid%plastic_work), &
                                 sum_by_material(s, solid%failed_mass)], [size(material_names(s)), 5])
        end associate
        do k = 1, size(by_material, 1)
          row = [row, by_material(k, :)]
        end do
        row = [row, pack(sum(solid%momentum, dim=2), scene%mesh%active), pack(balance%support_impulse, scene%mesh%active), &
               solid%books(book_lost_mass), solid%books(book_lost_count)]
        if (allocated(scene%solid%pair)) then
          do k = 1, size(scene%solid%pair)
            associate (books => solid%books(n_books + n_contact_books*(k - 1) + 1:n_books + n_contact_books*k))
              row = [row, pack(books(book_contact_impulse:book_contact_impulse + 2), scene%mesh%active), books(book_contact_work)]
            end associate
          end do
        end if
      end associate
    end if
    if (scene%coupled) row = [row, pack(balance%exchanged, scene%mesh%active), &
                              pack(balance%undelivered, scene%mesh%active), balance%work_on_solid, balance%taken_from_flow, &
                              balance%uncovered_mass, balance%uncovered_energy]
    row = [row, balance%mass, pack(balance%momentum, scene%mesh%active), balance%energy]
    call put_row(table, row)
  end subroutine put_history

end module history
