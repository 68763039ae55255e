!> Programmed burn of TNT in scenes without a deck: tubes that are lit at their closed low end, and bare sheets.
module burning_tubes
  use burn, only: set_up_burn, unburnt_energy, burning_charge, detonator_type, detonator_plane
  use detonation_wave, only: detonation_type, new_detonation
  use equation_of_state, only: eos_type, new_ideal_gas, new_jwl
  use flow_scenes, only: flow_scene, make_scene, run_until, row_of_cells
  use flow_scheme, only: scheme_type
  use flow_shapes, only: shape_all
  use flow_state, only: face_symmetry, face_outflow, n_repairs
  use flow_totals, only: flow_totals_type, sum_flow
  use kinds, only: wp, i8
  implicit none
  private
  public :: tnt, detonation_of_tnt, burning_tnt, make_tube, run_tube, front_of

  real(wp), parameter, public :: ambient_pressure = 101325
  real(wp), parameter, public :: tube_length = 0.1_wp, tube_time = 13e-6_wp !< the front is at 90 mm then
  real(wp), parameter :: early = 5e-6_wp !< from here on its speed is measured
  real(wp), parameter :: trace = 1e-8_wp

  !> What a tube gives, relative to the exact wave.
  type, public :: tube_result
    real(wp) :: speed = 0 !< mean speed of the front from 5 to 13 us, over D
    real(wp) :: lead = 0 !< of the front before its place, in cells
    real(wp) :: peak = 0 !< highest pressure over that of Chapman and Jouguet
    real(wp) :: error(3) = 0 !< of density, velocity, pressure: L1 over the mean of the exact profile's size
    real(wp) :: released = 0 !< over mass times energy of what has been passed
    real(wp) :: drift(2) = 0 !< of mass and of energy, unburnt included
    integer(i8) :: repairs(n_repairs) = 0
  end type tube_result

contains

  function tnt() result(eos)
    type(eos_type) :: eos
    eos = new_jwl(371.2e9_wp, 3.21e9_wp, 4.15_wp, 0.95_wp, 0.3_wp, 1630.0_wp, 7e9_wp)
  end function tnt

  function detonation_of_tnt() result(wave)
    type(detonation_type) :: wave
    wave = new_detonation(tnt(), 1630.0_wp, 7e9_wp/1630)
  end function detonation_of_tnt

  !> A charge of TNT, material 1, that fills all; to be given a shape and detonators.
  function burning_tnt(detonators) result(charge)
    type(detonator_type), intent(in) :: detonators(:)
    type(burning_charge) :: charge
    type(detonation_type) :: wave
    type(eos_type) :: eos
    wave = detonation_of_tnt()
    eos = tnt()
    charge%shape%kind = shape_all
    charge%material = 1
    charge%speed = wave%speed
    charge%energy = 7e9_wp/1630 - eos%energy(1630.0_wp, ambient_pressure)
    charge%detonator = detonators
  end function burning_tnt

  !> A tube of n cells full of TNT at rest, its low end closed and lit; with air: a trace of air is in it.
  subroutine make_tube(scene, n, scheme, with_air, width)
    type(flow_scene), intent(out) :: scene
    integer, intent(in) :: n
    type(scheme_type), intent(in) :: scheme
    logical, intent(in) :: with_air
    real(wp), intent(in) :: width
    integer :: faces(2, 3)
    faces = face_outflow
    faces(1, 1) = face_symmetry
    if (with_air) then
      call make_scene(scene, [tnt(), new_ideal_gas(1.4_wp)], [n, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [tube_length, 1.0_wp, 1.0_wp], &
        [0, 0, 0], face_outflow, explosive, faces, scheme)
      scene%flow%trace_fraction = trace
    else
      call make_scene(scene, [tnt()], [n, 1, 1], [0.0_wp, 0.0_wp, 0.0_wp], [tube_length, 1.0_wp, 1.0_wp], [0, 0, 0], &
        face_outflow, explosive, faces, scheme)
    end if
    scene%flow%floor_pressure = 1e-9_wp*ambient_pressure
    call set_up_burn(scene%mesh, scene%flow, [burning_tnt([detonator_type(detonator_plane, normal=[1.0_wp, 0.0_wp, 0.0_wp])])], &
      width)
  end subroutine make_tube

  subroutine explosive(x, r, a, u, p)
    real(wp), intent(in) :: x(3)
    real(wp), intent(out) :: r(:), a(:), u(3), p
    r = 1.225_wp + 0*x(1)
    r(1) = 1630
    a = trace
    a(1) = 1 - trace*(size(a) - 1)
    u = 0
    p = ambient_pressure
  end subroutine explosive

  !> Place at which the pressure first exceeds half of Chapman and Jouguet's, seen from the high end.
  real(wp) function front_of(scene, half_pressure) result(x)
    type(flow_scene), intent(in) :: scene
    real(wp), intent(in) :: half_pressure
    real(wp) :: p(scene%mesh%cells(1))
    integer :: i
    p = row_of_cells(scene, 1, scene%flow%layout%pressure())
    i = size(p) - 1
    do while (p(i) < half_pressure .and. i > 1)
      i = i - 1
    end do
    x = scene%mesh%spacing(1)*(i - 0.5_wp + (p(i) - half_pressure)/(p(i) - p(i + 1)))
  end function front_of

  !> Runs a tube that has been made, and measures it.
  subroutine run_tube(scene, cfl, result)
    type(flow_scene), intent(inout) :: scene
    real(wp), intent(in) :: cfl
    type(tube_result), intent(out) :: result
    type(detonation_type) :: wave
    type(flow_totals_type) :: before, after
    real(wp) :: x, to_burn, burnt, exact(3, scene%mesh%cells(1)), found(3, scene%mesh%cells(1))
    integer :: i
    wave = detonation_of_tnt()
    scene%flow%cfl = cfl
    before = sum_flow(scene%mesh, scene%flow)
    to_burn = unburnt_energy(scene%mesh, scene%flow)
    call run_until(scene, early)
    x = front_of(scene, 0.5_wp*wave%pressure)
    call run_until(scene, tube_time)
    result%lead = front_of(scene, 0.5_wp*wave%pressure)
    result%speed = (result%lead - x)/(tube_time - early)/wave%speed
    result%lead = (result%lead - wave%speed*tube_time)/scene%mesh%spacing(1)
    found(1, :) = row_of_cells(scene, 1, scene%flow%layout%density())
    found(2, :) = row_of_cells(scene, 1, scene%flow%layout%velocity(1))
    found(3, :) = row_of_cells(scene, 1, scene%flow%layout%pressure())
    do i = 1, size(exact, 2)
      exact(:, i) = wave%closed_end((i - 0.5_wp)*scene%mesh%spacing(1)/tube_time)
    end do
    result%peak = maxval(found(3, :))/wave%pressure
    result%error = sum(abs(found - exact), dim=2)/sum(abs(exact), dim=2)
    after = sum_flow(scene%mesh, scene%flow)
    scene%flow%time = scene%time
    burnt = to_burn - unburnt_energy(scene%mesh, scene%flow)
    result%released = burnt/(1630*wave%speed*tube_time*to_burn/sum(before%mass))
    result%drift(1) = (sum(after%mass) - sum(before%mass))/sum(before%mass)
    result%drift(2) = (sum(after%internal) + after%kinetic - sum(before%internal) - burnt)/burnt
    result%repairs = scene%flow%repairs%count
  end subroutine run_tube

end module burning_tubes
