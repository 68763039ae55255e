!> What tests of contact share.
module contact_scenes
  use deck_types, only: contact_group, material_group
  use kinds, only: wp
  use solid_scenes, only: solid_scene, metal
  use solid_step, only: advance_solid
  use solid_time_step, only: solid_limit, solid_limit_type
  implicit none
  private
  public :: run_until, material, let_touch

contains

  !> Steps up to a time.
  subroutine run_until(scene, time)
    type(solid_scene), intent(inout) :: scene
    real(wp), intent(in) :: time
    type(solid_limit_type) :: limit
    real(wp) :: dt
    do while (scene%solid%time < time*(1 - 1e-12_wp))
      limit = solid_limit(scene%mesh, scene%solid)
      dt = min(limit%dt, time - scene%solid%time)
      call advance_solid(scene%mesh, scene%halo, scene%solid, dt)
      scene%solid%time = scene%solid%time + dt
    end do
  end subroutine run_until

  !> 1000 kg/m3, elastic.
  function material(youngs_modulus) result(group)
    real(wp), intent(in) :: youngs_modulus
    type(material_group) :: group
    group = metal('m', 'elastic')
    group%density = 1000
    group%youngs_modulus = youngs_modulus
  end function material

  !> Asks for contact of all bodies.
  subroutine let_touch(scene, friction)
    type(solid_scene), intent(inout) :: scene
    real(wp), intent(in) :: friction
    type(contact_group) :: touching
    touching%friction = friction
    scene%deck%contact = [touching]
  end subroutine let_touch

end module contact_scenes
