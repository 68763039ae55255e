!> The books of the whole scene: what is there, what crossed its borders, what flow and solid gave each other, and what is missing.
module balance
  use burn, only: unburnt_energy
  use flow_totals, only: flow_totals_type, sum_flow
  use immersed_boundary, only: booked_impulse, booked_reference, booked_kinetic, booked_gas
  use kinds, only: wp
  use scene, only: scene_type
  use solid_state, only: book_impulse, book_coupling_impulse, book_coupling_work, book_lost_mass, book_lost_momentum, &
    book_lost_kinetic, book_lost_internal, book_gravity_impulse, n_supports, n_books, n_contact_books, book_contact_work
  use solid_totals, only: solid_totals_type, sum_solid
  implicit none
  private
  public :: take_balance

  !> Sums at one time. Drifts are against the first balance, relative to the largest sum of that kind so far.
  type, public :: balance_type
    type(flow_totals_type) :: flow
    type(solid_totals_type) :: solid
    real(wp) :: mass = 0 !< flow, solid and what left
    real(wp) :: momentum(3) = 0 !< flow and solid less all impulses from outside
    !> Flow, unburnt explosive, solid, what left, what friction took, and what forcing took and did not give to the solid; less
    !> afterburn.
    real(wp) :: energy = 0
    real(wp) :: momentum_scale = 0 !< sum of the sizes of all momenta and impulses
    real(wp) :: exchanged(3) = 0 !< momentum that the solid has from the flow
    real(wp) :: work_on_solid = 0 !< work of the flow on the solid
    real(wp) :: taken_from_flow = 0 !< kinetic energy that forcing took from the flow
    real(wp) :: uncovered_mass = 0, uncovered_energy = 0 !< gas added where cells opened less gas taken where they closed
    real(wp) :: support_impulse(3) = 0 !< of all supports and symmetry faces on the solid
    real(wp) :: boundary_energy = 0 !< that entered the flow through the faces of the domain
    real(wp) :: unburnt = 0 !< energy that programmed charges are still to release
  end type balance_type

contains

  !> The balance of the present state; to be called by all ranks. The same bits on any number of ranks.
  function take_balance(scene) result(balance)
    type(scene_type), intent(in) :: scene
    type(balance_type) :: balance
    integer :: m, e, n, d
    real(wp), allocatable :: books(:)
    if (scene%has_flow) then
      if (scene%stages%flow_over) then
        balance%flow = scene%stages%last_flow
      else
        balance%flow = sum_flow(scene%mesh, scene%flow)
      end if
      m = scene%flow%layout%momentum_flux
      e = scene%flow%layout%energy_flux
      n = scene%flow%n_materials
      associate (flow => balance%flow)
        balance%mass = sum(flow%mass) - sum(flow%entered(:n, :))
        balance%momentum = flow%momentum - sum(flow%entered(m:m + 2, :), dim=2)
        balance%unburnt = unburnt_energy(scene%mesh, scene%flow)
        balance%energy = flow%kinetic + sum(flow%internal) + balance%unburnt - flow%afterburnt - sum(flow%entered(e, :))
        balance%boundary_energy = sum(flow%entered(e, :))
        balance%mass = balance%mass - sum(flow%through_walls(:n))
        balance%momentum = balance%momentum - flow%through_walls(m:m + 2)
        balance%energy = balance%energy - flow%through_walls(e)
        balance%momentum_scale = sum(abs(flow%momentum)) + sum(abs(flow%entered(m:m + 2, :)))
      end associate
    end if
    if (scene%has_solid) then
      balance%solid = sum_solid(scene%mesh, scene%solid)
      associate (solid => balance%solid)
        do d = 1, 3
          balance%support_impulse(d) = sum(solid%books(book_impulse + d - 1:book_impulse + 3*n_supports - 1:3))
        end do
        balance%mass = balance%mass + sum(solid%mass) + solid%books(book_lost_mass)
        balance%momentum = balance%momentum + sum(solid%momentum, dim=2) - balance%support_impulse &
                           + solid%books(book_lost_momentum:book_lost_momentum + 2) &
                           - solid%books(book_gravity_impulse:book_gravity_impulse + 2)
        balance%energy = balance%energy + sum(solid%kinetic + solid%internal + solid%potential) &
                         + solid%books(book_lost_kinetic) + solid%books(book_lost_internal) &
                         + sum(solid%books(n_books + book_contact_work::n_contact_books))
        balance%momentum_scale = balance%momentum_scale + sum(abs(solid%momentum)) &
                                 + sum(abs(solid%books(book_impulse:book_impulse + 3*n_supports - 1)))
      end associate
    end if
    if (scene%coupled) then
      allocate (books(size(scene%coupling%books)))
      books = scene%coupling%books
      balance%exchanged = books(booked_impulse:booked_impulse + 2)
      balance%taken_from_flow = books(booked_kinetic)
      balance%work_on_solid = balance%solid%books(book_coupling_work)
      balance%uncovered_mass = sum(books(booked_gas:booked_gas + n - 1))
      balance%uncovered_energy = books(booked_gas + e - 1)
      balance%mass = balance%mass - balance%uncovered_mass
      balance%momentum = balance%momentum + books(booked_reference:booked_reference + 2) &
                         - books(booked_gas + m - 1:booked_gas + m + 1) &
                         + books(booked_impulse:booked_impulse + 2) &
                         - balance%solid%books(book_coupling_impulse:book_coupling_impulse + 2)
      balance%energy = balance%energy - balance%uncovered_energy + balance%taken_from_flow - balance%work_on_solid
      balance%momentum_scale = balance%momentum_scale + sum(abs(balance%exchanged))
    end if
  end function take_balance

end module balance
