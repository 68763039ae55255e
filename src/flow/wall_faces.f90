!> Flux on the face between an open cell and a closed one, which stands for a wall that moves.
!>
!> The closed cell mirrors the open one in the wall: same density and pressure, the velocity turned about the wall's own normal
!> (slip) or reversed (no slip) in the frame of the wall. The Riemann problem of the two has its contact at the speed of the wall, by
!> symmetry; its flux through the resting face lets gas pass where the wall moves or stands askew to the mesh, as if the gas
!> went on behind the face. So a uniform flow along a wall stays uniform, and a wall that crosses a cell pushes before it what it
!> covers. What passes is booked; over the cells of a straight wall, and over the time a wall needs to cross a cell, it sums up to
!> nil.
module wall_faces
  use equation_of_state, only: eos_type
  use flow_layout, only: layout_type
  use kinds, only: wp
  use mixture, only: cell_energies, cell_fractions
  implicit none
  private
  public :: wall_flux

contains

  !> Fluxes in the direction d of the mesh. side: 1 where the wall is on the high side of the cell, -1 on the low side; cell: rows
  !> of the open cell; velocity: of the wall; normal: of the wall, unit length, either sign, or nil for that of the face; slip: gas
  !> glides along the wall; lowest: of the pressures that can be. flux: rows as in flow_layout; pressure: on the face, part of the momentum flux.
  pure subroutine wall_flux(layout, eos, d, side, cell, velocity, normal, slip, lowest, flux, pressure)
    type(layout_type), intent(in) :: layout
    type(eos_type), intent(in) :: eos(layout%n_materials)
    integer, intent(in) :: d, side
    real(wp), intent(in) :: cell(:), velocity(3), normal(3), lowest
    logical, intent(in) :: slip
    real(wp), intent(out) :: flux(:), pressure
    real(wp) :: v(3), mirrored(3), upwind(3), energy(layout%n_materials), density, p, c, u, u_mirrored, contact, wave, squeeze
    real(wp) :: p_contact, chi, u_face, mass, work, rise
    real(wp) :: fraction(layout%n_materials)
    integer :: n, k
    n = layout%n_materials
    v = cell(layout%velocity_row:layout%velocity_row + 2)
    density = cell(layout%density_row)
    p = cell(layout%pressure_row)
    c = cell(layout%sound_speed_row)
    if (slip .and. any(abs(normal) > 0)) then
      mirrored = v - 2*sum((v - velocity)*normal)*normal
    else if (slip) then ! between two walls: along the axis
      mirrored = v
      mirrored(d) = 2*velocity(d) - v(d)
    else
      mirrored = 2*velocity - v
    end if
    ! along the axis from the cell to the wall
    u = side*v(d)
    u_mirrored = side*mirrored(d)
    contact = 0.5_wp*(u + u_mirrored)
    wave = min(u, u_mirrored) - c
    squeeze = (wave - u)/(wave - contact)
    rise = density*(wave - u)*(contact - u)
    if (rise < 0) rise = rise/(1 - rise/max(p - lowest, tiny(p))) ! a wall that flees leaves the gas some pressure
    p_contact = p + rise
    upwind = v
    if (contact < 0) upwind = mirrored
    if (contact >= 0 .and. wave >= 0) then ! faster than sound into the wall's cell
      chi = 1
      u_face = u
      pressure = p
    else if (contact < 0 .and. max(u, u_mirrored) + c <= 0) then
      chi = 1
      u_face = u_mirrored
      pressure = p
    else
      chi = squeeze
      u_face = contact
      pressure = p_contact
    end if
    work = 0.5_wp*(pressure + p)*(chi - 1)
    energy = cell_energies(layout, eos, cell)
    mass = side*density*chi*u_face
    upwind(d) = side*u_face
    flux(1:n) = side*chi*u_face*cell(1:n)
    flux(layout%momentum_flux:layout%momentum_flux + 2) = mass*upwind
    flux(layout%momentum_flux + d - 1) = flux(layout%momentum_flux + d - 1) + pressure
    flux(layout%energy_flux) = side*u_face*(chi*sum(energy) + work + pressure) + 0.5_wp*mass*sum(upwind**2)
    if (n == 1) return
    fraction = cell_fractions(layout, cell)
    k = layout%n_fractions
    flux(layout%first_fraction_flux:layout%first_fraction_flux + k - 1) = side*u_face*fraction(:k)
    k = layout%first_material_energy_flux
    flux(k:k + n - 1) = side*u_face*(chi*energy + work*fraction)
    flux(layout%face_velocity_flux) = side*u_face
  end subroutine wall_flux

end module wall_faces
