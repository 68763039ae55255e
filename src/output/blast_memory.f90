!> What a place has felt of a blast before that entered the scene: peak maps and gauges go on from there.
module blast_memory
  use blocks, only: own
  use gauges, only: gauges_type, note_gauges
  use kinds, only: wp
  use mesh, only: mesh_type
  use peak_maps, only: peak_maps_type, n_peaks
  use radial_profile, only: blast_type, felt_whole_impulse, n_felt, seen_along, seen_pressure, seen_density, seen_velocity
  implicit none
  private
  public :: remember_blasts, write_history

  real(wp), parameter :: same_place = 1e-9_wp !< of a radius

contains

  !> Sets the maps (where there are any) and the impulses of the flow gauges inside the blasts.
  subroutine remember_blasts(mesh, blast, peaks, gauges)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast(:)
    type(peak_maps_type), intent(inout) :: peaks
    type(gauges_type), intent(inout) :: gauges
    real(wp) :: felt(n_felt), x(3)
    integer :: i, b, j, k, l, g, f
    do i = 1, size(blast)
      if (allocated(peaks%map)) then
        do b = 1, mesh%n_local
          do l = 1, mesh%brick_cells(3)
            do k = 1, mesh%brick_cells(2)
              do j = 1, mesh%brick_cells(1)
                x = mesh%brick(mesh%local(b))%origin + ([j, k, l] - 0.5_wp)*mesh%spacing
                if (.not. blast(i)%has_reached(x, mesh%active)) cycle
                felt = blast(i)%profile%felt_at(blast(i)%place_of(x, mesh%active))
                call own(peaks%map, b)
                peaks%map(b)%a(j, :, k, l) = felt(:n_peaks)
              end do
            end do
          end do
        end do
      end if
      f = 0
      do g = 1, gauges%n
        if (.not. gauges%in_flow(g)) cycle
        f = f + 1
        if (.not. blast(i)%has_reached(gauges%position(:, g), mesh%active)) cycle
        felt = blast(i)%profile%felt_at(blast(i)%place_of(gauges%position(:, g), mesh%active))
        gauges%impulse(f) = felt(felt_whole_impulse)
      end do
    end do
  end subroutine remember_blasts

  !> Writes the rows of the gauges up to the time at which a blast entered the scene, from its run; to be called before
  !> remember_blasts. None where several blasts entered, or where one comes from a file that has other gauges.
  subroutine write_history(mesh, blast, gauges)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast(:)
    type(gauges_type), intent(inout) :: gauges
    integer :: known(gauges%flow%n), i, g, f, axis
    real(wp) :: out(3, gauges%flow%n), flow(5, gauges%flow%n), place(2), dt
    if (gauges%n == 0 .or. size(blast) > 1) return
    f = 0
    axis = blast(1)%axis
    associate (profile => blast(1)%profile)
      do g = 1, gauges%n
        if (.not. gauges%in_flow(g)) cycle
        f = f + 1
        place = blast(1)%place_of(gauges%position(:, g), mesh%active)
        out(:, f) = merge(gauges%position(:, g) - blast(1)%center, 0.0_wp, mesh%active .and. [1, 2, 3] /= axis) &
                    /max(place(1), tiny(1.0_wp))
        known(f) = 0
        do i = 1, size(profile%gauge, 2)
          if (known(f) == 0 .and. norm2(profile%gauge(:, i) - place) <= same_place*norm2(place)) known(f) = i
        end do
      end do
      if (any(known == 0)) return
      dt = 0
      do i = 1, size(profile%seen_at) - 1 ! the last is the first of the scene
        if (i > 1) dt = profile%seen_at(i) - profile%seen_at(i - 1)
        do f = 1, size(known)
          associate (seen => profile%seen(:, known(f), i))
            flow(1:2, f) = seen([seen_pressure, seen_density])
            flow(3:, f) = out(:, f)*seen(seen_velocity)
            if (axis > 0) flow(2 + axis, f) = seen(seen_along)
          end associate
        end do
        call note_gauges(gauges, mesh, profile%seen_at(i), dt, flow)
      end do
    end associate
  end subroutine write_history

end module blast_memory
