!> The largest time step of the solid and what sets it.
module solid_time_step
  use cell_functions, only: cell_frame, chunk, edge
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_velocity, at_mass
  use reductions, only: reduce_max
  use solid_material, only: model_rigid
  use solid_state, only: solid_type, limit_type, frame_of, scheme_usl
  use stress_update, only: signal_speeds
  implicit none
  private
  public :: find_limit, solid_limit

  !> What sets the solid's time step.
  type, public :: solid_limit_type
    real(wp) :: dt = 0.1_wp*huge(1.0_wp) !< time step
    real(wp) :: position(3) = 0 !< of the particle
    integer :: set = 0 !< its material: index in solid%material
    integer :: id = 0 !< its number
    real(wp) :: signal = 0 !< c + |v|
    real(wp) :: speed = 0 !< |v|
  end type solid_limit_type

contains

  !> The fastest signal of a block; of equal ones the first.
  subroutine find_limit(mesh, solid, set, local)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(inout) :: solid
    integer, intent(in) :: set, local
    real(wp) :: signal(chunk), largest
    integer :: first, n, i, cell
    cell = 1
    associate (blk => solid%block(set, local), limit => solid%limit(set, local))
      limit = limit_type()
      do first = 1, blk%n, chunk
        n = min(chunk, blk%n - first + 1)
        call signal_speeds(solid%material(set), n, blk%capacity, size(blk%f, 2), blk%f, first, signal)
        if (solid%material(set)%model == model_rigid) then
          ! no sound; one that is let fall from rest has a speed to come
          signal(:n) = signal(:n) + sqrt(norm2(solid%gravity)*minval(mesh%spacing, mesh%active))
        else if (solid%scheme == scheme_usl .and. solid%order == 1) then
          call heed_light_nodes(frame_of(mesh, solid%order, local), blk%capacity, size(blk%f, 2), blk%f, blk%cell_start, first, &
            n, cell, signal)
        end if
        largest = 0
        !$omp simd reduction(max:largest)
        do i = 1, n
          largest = max(largest, signal(i))
        end do
        if (largest <= limit%signal) cycle
        limit%signal = largest
        do i = n, 1, -1
          if (signal(i) >= largest) limit%index = first + i - 1
        end do
      end do
    end associate
  end subroutine find_limit

  !> Raises signal speeds so that cfl h/signal resolves the frequency of each cell with linear functions,
  !> w^2 = (c/h)^2 sum 1/(t (1 - t)) over the directions, t the centre of mass of its particles in the cell (Ni & Zhang 2020); that
  !> of the mesh is at most that of its cells. cell: that of particle `first`, on return that of the last one.
  pure subroutine heed_light_nodes(frame, capacity, n_field, f, cell_start, first, n, cell, signal)
    type(cell_frame), intent(in) :: frame
    integer, intent(in) :: capacity, n_field, cell_start(:), first, n
    real(wp), intent(in) :: f(capacity, n_field)
    integer, intent(inout) :: cell
    real(wp), intent(inout) :: signal(chunk)
    real(wp) :: frequency, mass, t
    integer :: i, d, a, b
    do i = first, first + n - 1
      do while (cell_start(cell + 1) <= i)
        cell = cell + 1
      end do
      a = cell_start(cell)
      b = cell_start(cell + 1) - 1
      mass = sum(f(a:b, at_mass))
      frequency = 0
      do d = 1, 3
        if (.not. frame%active(d)) cycle
        t = modulo((dot_product(f(a:b, at_mass), f(a:b, at_position + d - 1))/mass - frame%lower(d))*frame%inverse(d), 1.0_wp)
        t = min(max(t, edge), 1 - edge)
        frequency = frequency + 1/(t*(1 - t))
      end do
      signal(i - first + 1) = signal(i - first + 1)*max(1.0_wp, 0.5_wp*sqrt(frequency))
    end do
  end subroutine heed_light_nodes

  !> dt = cfl h/(c + |v|) over all particles, h the smallest cell spacing; the same on every rank. The solid must be projected.
  !>
  !> Linear functions alone allow no such bound: as a particle nears a cell face, the mass of the node behind it goes to zero
  !> and the frequency of the cell without limit (Ni & Zhang 2020). MUSL and USF take their strain from velocities that are mapped
  !> from the particles, in which a light node follows its particles; what remains is the frequency of the mesh, so a factor of 1/2
  !> is safe, which tests confirm for particles anywhere in their cells. USL strains with the node's own velocity and has to resolve
  !> that frequency: see heed_light_nodes.
  !>
  !> Quadratic functions go to zero with their slopes: N'^2/N is at most 6/h^2 in sum, and the frequency of a cell in one direction
  !> at most sqrt(6) c/h wherever its particles are. Three directions together allow dt = 0.47 h/c at the worst place of all
  !> particles at once, tests find 1/2 safe with every scheme.
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
