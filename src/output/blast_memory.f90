!> What a place has felt of a blast before that entered the scene: peak maps and gauges go on from there.
module blast_memory
  use gauges, only: gauges_type
  use kinds, only: wp
  use mesh, only: mesh_type
  use peak_maps, only: peak_maps_type, n_peaks
  use radial_profile, only: blast_type, felt_whole_impulse, n_felt
  implicit none
  private
  public :: remember_blasts

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

end module blast_memory
