!> Sums over the flow: masses, momentum and energies of the open cells, what entered through the faces of the domain, and
!> what afterburn released.
module flow_totals
  use blocks, only: row_length
  use flow_layout, only: book_afterburn, book_walls, n_flow_books
  use flow_state, only: flow_type
  use geometry, only: cell_volumes
  use kinds, only: wp
  use mesh, only: mesh_type
  use reductions, only: reduce_sum
  implicit none
  private
  public :: sum_flow

  type, public :: flow_totals_type
    real(wp), allocatable :: mass(:) !< by material
    real(wp) :: momentum(3) = 0 !< along a radius of the mesh it is no sum, and 0
    real(wp), allocatable :: internal(:) !< by material
    real(wp) :: kinetic = 0
    real(wp), allocatable :: entered(:, :) !< conserved quantity, face (x low, x high, y low, ...) since the start
    real(wp), allocatable :: through_walls(:) !< conserved quantities that walls that move gave, without what pressure does
    real(wp) :: afterburnt = 0 !< energy that afterburn has released since the start
  end type flow_totals_type

contains

  !> The sums over all ranks, brick by brick in global order: the same bits on any number of ranks.
  function sum_flow(mesh, flow) result(totals)
    type(mesh_type), intent(in) :: mesh
    type(flow_type), intent(in) :: flow
    type(flow_totals_type) :: totals
    real(wp), allocatable :: partial(:, :), total(:), row(:, :)
    real(wp), allocatable :: books(:, :)
    integer :: n, b, h, ld, sums, booked, q, summed
    n = flow%n_materials
    sums = 2*n + 4
    booked = n_flow_books*flow%layout%n_conserved
    allocate (partial(sums + booked, mesh%n_local), total(sums + booked))
    ld = row_length(mesh%brick_cells, mesh%ghost)
    allocate (row(ld, sums))
    summed = 0
    do b = 1, mesh%n_local
      h = flow%holder(b)
      if (h /= summed .or. allocated(flow%open(b)%a)) call sum_brick(b, h, ld, row)
      summed = merge(0, h, allocated(flow%open(b)%a)) ! a sleeping brick that follows has the same sums
      do q = 1, sums
        if (mesh%radial_power > 0) then
          partial(q, b) = sum(cell_volumes(mesh, b)*row(1:mesh%brick_cells(1), q))
        else
          partial(q, b) = mesh%cell_volume*sum(row(1:mesh%brick_cells(1), q))
        end if
      end do
      partial(sums + 1:, b) = reshape(flow%books(:, :, b), [booked])
    end do
    call reduce_sum(mesh, partial, total)
    totals%mass = total(:n)
    totals%internal = total(n + 1:2*n)
    totals%momentum = total(2*n + 1:2*n + 3)
    totals%kinetic = total(2*n + 4)
    books = reshape(total(sums + 1:), [flow%layout%n_conserved, n_flow_books])
    totals%entered = books(:, :6)
    totals%through_walls = books(:, book_walls)
    totals%afterburnt = books(flow%layout%energy_flux, book_afterburn)
    if (mesh%radial_power > 0) then
      totals%momentum(1) = 0
      totals%entered(flow%layout%momentum_flux, :) = 0
    end if
  contains
    !> Adds all rows of cells of a brick, cell by cell along x: the sum along x comes last.
    subroutine sum_brick(b, h, ld, row)
      integer, intent(in) :: b, h, ld
      real(wp), intent(inout) :: row(ld, sums)
      real(wp) :: open(ld), last(ld), a(ld), offset
      integer :: i, j, k, m, e, p, r, u, nx
      p = flow%layout%pressure_row
      r = flow%layout%density_row
      u = flow%layout%velocity_row
      nx = mesh%brick_cells(1)
      row = 0
      associate (w => flow%w(h, flow%current)%a)
        do k = 1, mesh%brick_cells(3)
          do j = 1, mesh%brick_cells(2)
            open = 1
            if (allocated(flow%open(b)%a)) open(:nx) = merge(1.0_wp, 0.0_wp, flow%open(b)%a(1:nx, 1, j, k) > 0)
            last = 1
            do m = 1, n
              e = flow%layout%energy(m)
              offset = 0
              if (flow%eos(m)%is_gas) offset = flow%eos(m)%gas%energy_offset
              a = last
              if (m < n) a(:nx) = w(1:nx, flow%layout%fraction(m), j, k)
              last = last - a
              !$omp simd
              do i = 1, nx
                row(i, m) = row(i, m) + open(i)*w(i, m, j, k)
                row(i, n + m) = row(i, n + m) + open(i)*offset*w(i, m, j, k)
              end do
              if (e > 0) then
                row(:nx, n + m) = row(:nx, n + m) + open(:nx)*w(1:nx, e, j, k)
              else
                row(:nx, n + m) = row(:nx, n + m) + open(:nx)*a(:nx)*(w(1:nx, p, j, k)*flow%eos(m)%over_g &
                  + flow%eos(m)%rest_energy)
              end if
            end do
            !$omp simd
            do i = 1, nx
              row(i, 2*n + 1) = row(i, 2*n + 1) + open(i)*w(i, r, j, k)*w(i, u, j, k)
              row(i, 2*n + 2) = row(i, 2*n + 2) + open(i)*w(i, r, j, k)*w(i, u + 1, j, k)
              row(i, 2*n + 3) = row(i, 2*n + 3) + open(i)*w(i, r, j, k)*w(i, u + 2, j, k)
              row(i, 2*n + 4) = row(i, 2*n + 4) + open(i)*0.5_wp*w(i, r, j, k) &
                *(w(i, u, j, k)**2 + w(i, u + 1, j, k)**2 + w(i, u + 2, j, k)**2)
            end do
          end do
        end do
      end associate
    end subroutine sum_brick
  end function sum_flow

end module flow_totals
