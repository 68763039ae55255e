!> Prints the tables of docs/validation.md for shapes, transfers and schemes of the solid: solid_bench motions | vibrations | shocks
!> | orders.
program solid_bench
  use iso_fortran_env, only: output_unit
  use kinds, only: wp
  use manufactured_solids, only: run_manufactured, manufactured_type
  use parallel, only: parallel_start, parallel_stop
  use solid_motions, only: run_rotation, run_extension, run_discs, rotation_type, extension_type, discs_type
  use solid_shocks, only: run_copper, run_spall, copper_type, spall_type
  use solid_numerics, only: numerics_type, numerics_name, all_numerics
  use solid_vibrations, only: run_bar, run_pulse, run_cylinder, bar_type, cylinder_type
  implicit none
  type(numerics_type), allocatable :: list(:)
  character(16) :: word
  integer :: i
  call parallel_start()
  call get_command_argument(1, word)
  list = [all_numerics(stable=.true.), numerics_type(flip=0.99_wp), numerics_type(shape='quadratic', flip=0.99_wp)]
  select case (word)
  case ('motions')
    call print_head([character(32) :: 'extension 1 %: stress', '5 %: stress', 'discs: kinetic', 'energy', 'turns: angular', &
      'kinetic', 'spurious stress', 'radius'])
    do i = 1, size(list)
      call print_motions(list(i))
    end do
  case ('vibrations')
    call print_head([character(32) :: 'bar: frequency', 'loss per cycle', 'large: frequency', 'loss per cycle', 'pulse: speed', &
      'cylinder: displacement', 'stress'])
    do i = 1, size(list)
      call print_vibrations(list(i))
    end do
  case ('shocks')
    call print_head([character(32) :: 'copper: pressure', 'speed', 'energy', 'cfl 1/4: pressure', 'speed', 'energy', &
      'spall 1.2', 'spall 2'])
    do i = 1, size(list)
      call print_shocks(list(i))
    end do
  case ('orders')
    call print_orders('axis_aligned', 'elastic', [1e-4_wp, 0.02_wp], 8, 4)
    call print_orders('axis_aligned', 'neo_hookean', [1e-4_wp, 0.02_wp], 8, 4)
    call print_orders('vortex', 'elastic', [1e-4_wp, 0.05_wp], 8, 3)
    call print_orders('vortex', 'neo_hookean', [1e-4_wp, 0.05_wp], 8, 3)
  case default
    print '(a)', 'usage: solid_bench motions | vibrations | shocks | orders'
  end select
  call parallel_stop()

contains

  subroutine print_head(names)
    character(*), intent(in) :: names(:)
    integer :: k
    print '(*(a))', '| shape, transfer, scheme |', (' '//trim(names(k))//' |', k=1, size(names))
    print '(*(a))', '|', ('---|', k=0, size(names))
  end subroutine print_head

  subroutine print_row(numerics, values)
    type(numerics_type), intent(in) :: numerics
    real(wp), intent(in) :: values(:)
    print '(3a, *(es10.2, " |"))', '| ', numerics_name(numerics), ' |', values
    flush (output_unit)
  end subroutine print_row

  subroutine print_motions(numerics)
    type(numerics_type), intent(in) :: numerics
    type(extension_type) :: small, large
    type(discs_type) :: discs
    type(rotation_type) :: rotation
    small = run_extension(numerics, 1.01_wp)
    large = run_extension(numerics, 1.05_wp)
    discs = run_discs(numerics)
    rotation = run_rotation(numerics, 10.0_wp)
    call print_row(numerics, [small%stress, large%stress, discs%kinetic - 1, discs%energy, rotation%angular_momentum, &
      rotation%kinetic, rotation%stress, rotation%radius])
  end subroutine print_motions

  subroutine print_vibrations(numerics)
    type(numerics_type), intent(in) :: numerics
    type(bar_type) :: small, large
    type(cylinder_type) :: cylinder
    small = run_bar(numerics, 10, 1e-3_wp)
    large = run_bar(numerics, 10, 0.5_wp)
    cylinder = run_cylinder(numerics, 12)
    call print_row(numerics, [small%frequency, small%loss, large%frequency, large%loss, run_pulse(numerics), &
      cylinder%displacement, cylinder%stress])
  end subroutine print_vibrations

  !> Relative errors; of the energy: change of the whole.
  subroutine print_shocks(numerics)
    type(numerics_type), intent(in) :: numerics
    type(numerics_type) :: slower
    type(copper_type) :: copper(2)
    type(spall_type) :: spall(2)
    integer :: k
    slower = numerics
    slower%cfl = 0.25_wp
    copper(1) = run_copper(numerics, 200)
    copper(2) = run_copper(slower, 200)
    spall(1) = run_spall(numerics, 300, 1.2_wp)
    spall(2) = run_spall(numerics, 300, 2.0_wp)
    call print_row(numerics, [(copper(k)%pressure/171.75e9_wp - 1, copper(k)%speed/5167.5_wp - 1, copper(k)%balance, k=1, 2), &
      spall%distance/spall%theory - 1])
  end subroutine print_shocks

  !> Errors and orders over n meshes that start with `cells` and double.
  subroutine print_orders(motion, law, amplitudes, cells, n)
    character(*), intent(in) :: motion, law
    real(wp), intent(in) :: amplitudes(:)
    integer, intent(in) :: cells, n
    type(manufactured_type) :: problem
    real(wp) :: error(n)
    integer :: a, k, m
    print '(/, 4a)', motion, ', ', law, ': error and order on meshes that double'
    print '(*(a))', '| shape, transfer, scheme | amplitude |', (' cells | order |', k=1, n)
    print '(*(a))', '|', ('---|', k=0, 2*n + 1)
    problem%motion = motion
    problem%law = law
    do k = 1, size(list)
      if (list(k)%scheme == 'usf') cycle
      do a = 1, size(amplitudes)
        problem%amplitude = amplitudes(a)
        do m = 1, n
          error(m) = run_manufactured(problem, list(k), cells*2**(m - 1))
        end do
        print '(3a, es9.1, " |", es10.2, " | |", *(es10.2, " |", f5.2, " |"))', '| ', numerics_name(list(k)), ' |', amplitudes(a), &
          error(1), (error(m), log(error(m - 1)/error(m))/log(2.0_wp), m=2, n)
        flush (output_unit)
      end do
    end do
  end subroutine print_orders

end program solid_bench
