!> Particles that no computation should go on with: volumes that are not positive, values that are not finite.
module particle_checks
  use cell_functions, only: chunk
  use errors, only: fatal
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_velocity, at_volume, at_stress
  use solid_state, only: solid_type, cell_coordinate
  use text, only: str
  implicit none
  private
  public :: check_particles, in_reach, particle_error

contains

  !> Fatal if a particle of a block has a volume that is not positive, or a velocity or a stress that is not finite.
  subroutine check_particles(mesh, solid, set, local)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: set, local
    integer :: first, n, i
    associate (blk => solid%block(set, local))
      do first = 1, blk%n, chunk
        n = min(chunk, blk%n - first + 1)
        if (.not. any_bad(n, blk%f(first, at_velocity), blk%f(first, at_velocity + 1), blk%f(first, at_velocity + 2), &
                          blk%f(first, at_volume), blk%f(first, at_stress), blk%f(first, at_stress + 1), &
                          blk%f(first, at_stress + 2), blk%f(first, at_stress + 3), blk%f(first, at_stress + 4), &
                          blk%f(first, at_stress + 5))) cycle
        do i = first, first + n - 1
          if (.not. (blk%f(i, at_volume) > 0 .and. blk%f(i, at_volume) < huge(1.0_wp))) &
            call particle_error(mesh, solid, set, local, i, 'has the volume '//str(blk%f(i, at_volume)))
          if (.not. all(abs(blk%f(i, at_stress:at_stress + 5)) < huge(1.0_wp))) &
            call particle_error(mesh, solid, set, local, i, 'has a stress that is not finite')
          if (.not. all(abs(blk%f(i, at_velocity:at_velocity + 2)) < huge(1.0_wp))) &
            call particle_error(mesh, solid, set, local, i, 'has a velocity that is not finite')
        end do
      end do
    end associate
  end subroutine check_particles

  pure logical function any_bad(n, vx, vy, vz, volume, s1, s2, s3, s4, s5, s6)
    integer, intent(in) :: n
    real(wp), intent(in), dimension(n) :: vx, vy, vz, volume, s1, s2, s3, s4, s5, s6
    real(wp) :: worst, largest
    integer :: i
    worst = 0
    !$omp simd private(largest) reduction(max:worst)
    do i = 1, n
      largest = ((abs(s1(i)) + abs(s2(i))) + (abs(s3(i)) + abs(s4(i)))) + ((abs(s5(i)) + abs(s6(i))) + volume(i)) &
        + (abs(vx(i)) + abs(vy(i)) + abs(vz(i)))
      worst = max(worst, merge(merge(0.0_wp, 1.0_wp, largest < huge(1.0_wp)), 1.0_wp, volume(i) > 0))
    end do
    any_bad = worst > 0
  end function any_bad

  !> Whether a position is finite and not so far off that its cell cannot be counted.
  pure logical function in_reach(mesh, x)
    type(mesh_type), intent(in) :: mesh
    real(wp), intent(in) :: x(3)
    in_reach = all(abs(x - mesh%lower) < 5e8_wp*mesh%spacing)
  end function in_reach

  !> Ends the run with a message that names the particle, its material, place and cell, the step and what limits it.
  subroutine particle_error(mesh, solid, set, local, index, what)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: set, local, index
    character(*), intent(in) :: what
    character(:), allocatable :: place, cell, limiter
    integer :: d
    place = ''
    cell = ''
    limiter = ''
    associate (blk => solid%block(set, local))
      do d = 1, 3
        if (d > 1) place = place//', '
        place = place//str(blk%f(index, at_position + d - 1))
      end do
      if (in_reach(mesh, blk%f(index, at_position:at_position + 2))) then
        do d = 1, 3
          cell = cell//' '//str(cell_coordinate(mesh, d, blk%f(index, at_position + d - 1)) + 1)
        end do
        cell = ', cell'//cell
      end if
      if (allocated(solid%limiter)) then
        if (len(solid%limiter) > 0) limiter = ', step limited by '//solid%limiter
      end if
      call fatal("solid: particle "//str(blk%id(index))//" of '"//trim(solid%material(set)%name)//"' at ("//place//')'// &
        cell//' '//what//' (step '//str(solid%step)//', time '//str(solid%time)//limiter//')')
    end associate
  end subroutine particle_error

end module particle_checks
