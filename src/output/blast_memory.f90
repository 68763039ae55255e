!> What a place has felt of a blast before that entered the scene: peak maps and gauges go on from there.
module blast_memory
  use blocks, only: own
  use gauges, only: gauges_type, note_gauges
  use kinds, only: wp
  use mesh, only: mesh_type
  use peak_maps, only: peak_maps_type, n_peaks
  use radial_profile, only: blast_type, felt_whole_impulse, n_felt, seen_pressure, seen_density, seen_velocity
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
                if (.not. reached(blast(i), x)) cycle
                felt = blast(i)%profile%felt_at(radius(blast(i), x))
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
        if (.not. reached(blast(i), gauges%position(:, g))) cycle
        felt = blast(i)%profile%felt_at(radius(blast(i), gauges%position(:, g)))
        gauges%impulse(f) = felt(felt_whole_impulse)
      end do
    end do
  contains
    pure real(wp) function radius(blast, x)
      type(blast_type), intent(in) :: blast
      real(wp), intent(in) :: x(3)
      radius = norm2(merge(x - blast%center, 0.0_wp, mesh%active))
    end function radius
    pure logical function reached(blast, x)
      type(blast_type), intent(in) :: blast
      real(wp), intent(in) :: x(3)
      reached = radius(blast, x) < blast%profile%front
    end function reached
  end subroutine remember_blasts

  !> Writes the rows of the gauges up to the time at which a blast entered the scene, from its run; to be called before
  !> remember_blasts. None where several blasts entered, or where one comes from a file that has other gauges.
  subroutine write_history(mesh, blast, gauges)
    type(mesh_type), intent(in) :: mesh
    type(blast_type), intent(in) :: blast(:)
    type(gauges_type), intent(inout) :: gauges
    integer :: place(gauges%flow%n), i, g, f
    real(wp) :: away(3, gauges%flow%n), flow(5, gauges%flow%n), radius, dt
    if (gauges%n == 0 .or. size(blast) > 1) return
    f = 0
    associate (profile => blast(1)%profile)
      do g = 1, gauges%n
        if (.not. gauges%in_flow(g)) cycle
        f = f + 1
        away(:, f) = merge(gauges%position(:, g) - blast(1)%center, 0.0_wp, mesh%active)
        radius = norm2(away(:, f))
        away(:, f) = away(:, f)/max(radius, tiny(1.0_wp))
        place(f) = findloc(abs(profile%gauge - radius) <= same_place*radius, .true., dim=1)
      end do
      if (any(place == 0)) return
      dt = 0
      do i = 1, size(profile%seen_at) - 1 ! the last is the first of the scene
        if (i > 1) dt = profile%seen_at(i) - profile%seen_at(i - 1)
        do f = 1, size(place)
          flow(1:2, f) = profile%seen([seen_pressure, seen_density], place(f), i)
          flow(3:, f) = away(:, f)*profile%seen(seen_velocity, place(f), i)
        end do
        call note_gauges(gauges, mesh, profile%seen_at(i), dt, flow)
      end do
    end associate
  end subroutine write_history

end module blast_memory
