!> Sums over the solid: mass, momentum, energies by material, failed mass, plastic work, and the books.
module solid_totals
  use kinds, only: wp
  use mesh, only: mesh_type
  use particles, only: at_position, at_velocity, at_mass, at_energy, at_damage, at_plastic_work, at_plastic_strain
  use reductions, only: reduce_sum
  use solid_material, only: model_rigid
  use solid_state, only: solid_type, book_lost_count
  implicit none
  private
  public :: sum_solid

  !> Sums by set (material), and the sums over time of what crossed the solid's borders.
  type, public :: solid_totals_type
    real(wp), allocatable :: count(:) !< particles
    real(wp), allocatable :: mass(:)
    real(wp), allocatable :: momentum(:, :) !< (3, set)
    real(wp) :: outside(3) = 0 !< momentum of the parts of rigid bodies that have left the domain, which move on with the rest
    real(wp), allocatable :: kinetic(:)
    real(wp), allocatable :: internal(:)
    real(wp), allocatable :: potential(:) !< energy in the field of gravity, zero at the origin
    real(wp), allocatable :: plastic_work(:)
    real(wp), allocatable :: failed_mass(:) !< of particles whose damage is 1
    real(wp), allocatable :: largest_strain(:) !< plastic strain, on this rank only
    real(wp), allocatable :: books(:) !< book_* of solid_state
  end type solid_totals_type

  integer, parameter :: n_sums = 10

contains

  !> The same bits on any number of ranks: summed by particle in (cell, id) order, by set, then by brick in the order of the curve.
  function sum_solid(mesh, solid) result(totals)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    type(solid_totals_type) :: totals
    real(wp) :: partial(n_sums*solid%n_sets + size(solid%books, 1), mesh%n_local), sums(n_sums)
    real(wp) :: all(n_sums*solid%n_sets + size(solid%books, 1))
    integer :: b, set, n
    n = solid%n_sets
    allocate (totals%largest_strain(n), source=0.0_wp)
    do b = 1, mesh%n_local
      do set = 1, n
        associate (blk => solid%block(set, b))
          call sum_block(solid%gravity, solid%material(set)%failure_damage, blk%n, blk%capacity, size(blk%f, 2), blk%f, sums)
          partial(n_sums*(set - 1) + 1:n_sums*set, b) = sums
          if (blk%n > 0) totals%largest_strain(set) = max(totals%largest_strain(set), maxval(blk%f(:blk%n, at_plastic_strain)))
        end associate
      end do
      partial(n_sums*n + 1:, b) = solid%books(:, b)
    end do
    call reduce_sum(mesh, partial, all)
    totals%count = all(1:n_sums*n:n_sums)
    totals%mass = all(2:n_sums*n:n_sums)
    totals%kinetic = all(3:n_sums*n:n_sums)
    totals%internal = all(4:n_sums*n:n_sums)
    totals%potential = all(5:n_sums*n:n_sums)
    totals%plastic_work = all(6:n_sums*n:n_sums)
    totals%failed_mass = all(7:n_sums*n:n_sums)
    allocate (totals%momentum(3, n))
    totals%momentum(1, :) = all(8:n_sums*n:n_sums)
    totals%momentum(2, :) = all(9:n_sums*n:n_sums)
    totals%momentum(3, :) = all(10:n_sums*n:n_sums)
    totals%books = all(n_sums*n + 1:)
    if (.not. totals%books(book_lost_count) > 0) return
    do b = 1, size(solid%rigid)
      totals%outside = totals%outside + solid%rigid(b)%mass*solid%rigid(b)%velocity
    end do
    do set = 1, n
      if (solid%material(set)%model == model_rigid) totals%outside = totals%outside - totals%momentum(:, set)
    end do
  end function sum_solid

  pure subroutine sum_block(gravity, failure_damage, n, capacity, n_field, f, sums)
    real(wp), intent(in) :: gravity(3), failure_damage
    integer, intent(in) :: n, capacity, n_field
    real(wp), intent(in) :: f(capacity, n_field)
    real(wp), intent(out) :: sums(n_sums)
    real(wp) :: m, v(3)
    integer :: i
    sums = 0
    sums(1) = n
    do i = 1, n
      m = f(i, at_mass)
      v = f(i, at_velocity:at_velocity + 2)
      sums(2) = sums(2) + m
      sums(3) = sums(3) + 0.5_wp*m*(v(1)**2 + v(2)**2 + v(3)**2)
      sums(4) = sums(4) + f(i, at_energy)
      sums(5) = sums(5) - m*dot_product(gravity, f(i, at_position:at_position + 2))
      sums(6) = sums(6) + f(i, at_plastic_work)
      if (f(i, at_damage) >= failure_damage) sums(7) = sums(7) + m
      sums(8:10) = sums(8:10) + m*v
    end do
  end subroutine sum_block

end module solid_totals
