!> Runs the problems of the solid with all numerics and prints what came out, for tools/bench.
program solid_bench
  use kinds, only: wp
  use parallel, only: parallel_start, parallel_stop
  use solid_motions, only: run_flight, run_rotation, run_extension, run_discs, flight_type, rotation_type, extension_type, &
    discs_type
  use solid_numerics, only: numerics_type, numerics_name, all_numerics
  use solid_vibrations, only: run_bar, run_pulse, bar_type
  implicit none
  type(numerics_type), allocatable :: list(:)
  type(numerics_type) :: n
  type(flight_type) :: flight
  type(rotation_type) :: rotation
  type(extension_type) :: extension
  type(discs_type) :: discs
  type(bar_type) :: bar
  integer :: i
  character(8) :: word
  call parallel_start()
  list = all_numerics()
  list = [list, numerics_type(flip=0.99_wp), numerics_type(flip=0.9_wp)]
  call get_command_argument(1, word)
  if (word /= '') then
    read (word, *) i
    list = list(i:i)
  end if
  do i = 1, size(list)
    n = list(i)
    print '(/, a)', numerics_name(n)
    flight = run_flight(n, 1000)
    print '(a, 3es11.2, i6)', ' flight: velocity, position, stress, cells', &
      flight%velocity, flight%position, flight%stress, flight%cells
    extension = run_extension(n, 1.1_wp)
    print '(a, 3es11.2)', ' extension: velocity, volume, stress', extension%velocity, extension%volume, extension%stress
    discs = run_discs(n)
    print '(a, 5es11.2)', ' discs: momentum, lowest, kinetic, energy, angular', &
      discs%momentum, discs%lowest, discs%kinetic, discs%energy, discs%angular_momentum
    bar = run_bar(n, 10, 1e-3_wp)
    print '(a, 3es11.2)', ' bar: frequency, loss per cycle, balance', bar%frequency, bar%loss, bar%balance
    bar = run_bar(n, 10, 0.75_wp)
    print '(a, 3es11.2)', ' bar, large: frequency, loss per cycle, balance', bar%frequency, bar%loss, bar%balance
    print '(a, es11.2)', ' pulse: speed', run_pulse(n)
    rotation = run_rotation(n, 10.0_wp)
    print '(a, 7es11.2)', ' rotation: turns, angular, kinetic, energy, stress, momentum, radius', &
      rotation%turns, rotation%angular_momentum, &
      rotation%kinetic, rotation%energy, rotation%stress, rotation%momentum, rotation%radius
  end do
  call parallel_stop()
end program solid_bench
