!> Time of the stress update of each constitutive model, in ns per particle: the fastest of many short windows.
!>
!> The particles (5 MB of columns at most) are strained to and fro past yield, so every branch of a model is taken.
program material_bench
  use cell_functions, only: chunk
  use deck_types, only: material_group
  use kinds, only: wp, i8
  use material_samples, only: sample_names, sample_material
  use particles, only: at_mass, at_volume
  use solid_material, only: solid_material_type, make_solid_material
  use stress_update, only: update_stress, signal_speeds
  implicit none
  integer, parameter :: n_particles = 16*chunk, windows = 60
  real(wp) :: gradient(chunk, 9), signal(chunk), update, signals
  real(wp), allocatable :: f(:, :)
  type(solid_material_type) :: material
  integer :: k
  print '(a)', '! ns per particle   update   signal'
  do k = 1, size(sample_names)
    material = make_solid_material(sample_material(trim(sample_names(k))), .true.)
    call time_model()
    print '(a24, 2f9.1)', sample_names(k), update, signals
  end do

contains

  subroutine time_model()
    integer :: first, window, i, j
    real(wp) :: began, way
    allocate (f(n_particles, material%n_field), source=0.0_wp)
    f(:, at_volume) = 1e-9_wp
    f(:, at_mass) = material%density*1e-9_wp
    update = huge(update)
    signals = huge(signals)
    do window = 1, windows
      way = merge(1e-3_wp, -1e-3_wp, mod(window, 4) < 2)
      do j = 1, 9
        do i = 1, chunk
          gradient(i, j) = way*(mod(i + 3*j, 7) - 3 + merge(3, 0, mod(j, 4) == 1))*0.1_wp
        end do
      end do
      began = clock()
      do first = 1, n_particles, chunk
        call update_stress(material, 1e-6_wp, 1e-3_wp, chunk, n_particles, size(f, 2), f, first, gradient)
      end do
      update = min(update, clock() - began)
      began = clock()
      do first = 1, n_particles, chunk
        call signal_speeds(material, chunk, n_particles, size(f, 2), f, first, signal)
      end do
      signals = min(signals, clock() - began)
    end do
    update = update*1e9_wp/n_particles
    signals = signals*1e9_wp/n_particles
    if (any(f /= f) .or. any(signal /= signal)) print '(2a)', trim(material%name), ': not a number'
    deallocate (f)
  end subroutine time_model

  real(wp) function clock()
    integer(i8) :: now, rate
    call system_clock(now, rate)
    clock = real(now, wp)/real(rate, wp)
  end function clock

end program material_bench
