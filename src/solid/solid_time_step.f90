!> The largest time step of the solid and what sets it.
module solid_time_step
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_velocity
  use reductions, only: reduce_max
  use solid_state, only: solid_type
  implicit none
  private
  public :: solid_limit

  !> What sets the solid's time step.
  type, public :: solid_limit_type
    real(wp) :: dt = huge(1.0_wp) !< time step
    real(wp) :: position(3) = 0 !< of the particle
    integer :: set = 0 !< its material: index in solid%material
    integer :: id = 0 !< its number
    real(wp) :: signal = 0 !< c + |v|
    real(wp) :: speed = 0 !< |v|
  end type solid_limit_type

contains

  !> dt = cfl h/(c + |v|) over all particles, h the smallest cell spacing; the same on every rank. The solid must be projected.
  !>
  !> Linear functions alone allow no such bound: as a particle nears a cell face, the mass of the node behind it goes to zero
  !> and the frequency of the element without limit (Ni & Zhang 2020). MUSL takes its strain from velocities that are mapped
  !> back from the particles, in which a light node follows its particles; what remains is the frequency of the mesh, so a
  !> factor of 1/2 is safe, which tests confirm for particles anywhere in their cells.
  function solid_limit(mesh, solid) result(limit)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(solid_limit_type) :: limit
    real(wp) :: companion(6), best
    integer :: b, set
    best = 0
    companion = 0
    do b = 1, mesh%n_local
      do set = 1, solid%n_sets
        if (solid%limit(set, b)%signal <= best) cycle
        best = solid%limit(set, b)%signal
        associate (blk => solid%block(set, b), i => solid%limit(set, b)%index)
          companion(1:3) = blk%f(i, at_position:at_position + 2)
          companion(4) = set
          companion(5) = blk%id(i)
          companion(6) = norm2(blk%f(i, at_velocity:at_velocity + 2))
        end associate
      end do
    end do
    call reduce_max(best, companion)
    if (best <= 0) return
    limit%dt = solid%cfl*minval(mesh%spacing, mesh%active)/best
    limit%position = companion(1:3)
    limit%set = nint(companion(4))
    limit%id = nint(companion(5))
    limit%signal = best
    limit%speed = companion(6)
  end function solid_limit

end module solid_time_step
