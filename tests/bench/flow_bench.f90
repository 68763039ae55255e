!> Runs the test problems of the flow and prints a line of comma-separated values for each: accuracy over resolutions and schemes,
!> stability at the Courant numbers that are promised, speed by scene and brick; and the speed of particles. tools/bench calls it
!> and makes tables and pictures.
program flow_bench
  use bench_options, only: options_type, read_options, wanted
  use calibration, only: calibration_type, calibrate
  use errors, only: exit_bad_input, exit_done
  use flow_problem, only: problem_type, outcome_type, add_problem
  use flow_problem_run, only: run_problem
  use flow_scheme, only: scheme_type
  use flow_speed, only: speed_type, time_steps
  use flow_state, only: n_repairs, repair_names
  use flow_suite, only: all_problems, scheme_named, promised_cfl
  use kinds, only: wp
  use parallel, only: parallel_start, parallel_stop
  use process, only: exit_process
  use solid_speed, only: n_solid_scenes, particle_speed, solid_scene_names, solid_scene_titles, time_particles
  use speed_scenes, only: add_speed_scenes
  implicit none
  character(48), parameter :: accuracy_schemes(4) = [character(48) :: 'paper', 'muscl+third_order+sensor', &
    'fifth_order+sensor', 'fifth_order+thinc+sensor']
  character(48), parameter :: default_scheme(1) = [character(48) :: 'fifth_order+sensor']
  type(options_type) :: options
  type(calibration_type) :: machine
  type(problem_type), allocatable :: list(:)
  integer :: status

  call parallel_start()
  options = read_options()
  status = exit_done
  if (.not. options%valid) then
    status = exit_bad_input
  else
    machine = calibrate()
    select case (options%command)
    case ('accuracy'); call run_accuracy()
    case ('stability'); call run_stability()
    case ('speed'); call run_speed()
    case ('particles'); call run_particles()
    case ('list'); call print_list()
    end select
  end if
  call parallel_stop()
  call exit_process(status)

contains

  subroutine print_list()
    integer :: i
    call all_problems(list)
    do i = 1, size(list)
      print '(a,t24,a)', trim(list(i)%name), trim(list(i)%title)
    end do
  end subroutine print_list

  !> The schemes asked for, or these. Fatal words end in none.
  function schemes_or(default) result(names)
    character(48), intent(in) :: default(:)
    character(48), allocatable :: names(:)
    names = default
    if (size(options%schemes) > 0) names = options%schemes
  end function schemes_or

  subroutine run_accuracy()
    character(48), allocatable :: schemes(:)
    integer, allocatable :: cells(:)
    integer :: i, k, s
    schemes = schemes_or(accuracy_schemes)
    call all_problems(list)
    call print_head()
    do i = 1, size(list)
      if (.not. wanted(list(i)%name, options%cases)) cycle
      if (options%quick .and. list(i)%is_long) cycle
      cells = list(i)%resolutions
      if (options%quick) cells = cells(:min(2, size(cells)))
      if (size(options%cells) > 0 .and. size(cells) > 0) cells = options%cells
      do s = 1, size(schemes)
        do k = 1, size(cells)
          call run_one(list(i), cells(k), cfl_or([0.5_wp], 1), schemes(s))
        end do
      end do
    end do
  end subroutine run_accuracy

  subroutine run_stability()
    character(48), allocatable :: schemes(:)
    real(wp), allocatable :: cfl(:)
    integer :: i, k, s
    schemes = schemes_or(default_scheme)
    cfl = promised_cfl
    if (size(options%cfl) > 0) cfl = options%cfl
    call all_problems(list)
    call print_head()
    do i = 1, size(list)
      if (.not. (list(i)%is_hard .and. wanted(list(i)%name, options%cases))) cycle
      if (options%quick .and. list(i)%is_long) cycle
      do s = 1, size(schemes)
        do k = 1, size(cfl)
          call run_one(list(i), 0, cfl(k), schemes(s))
        end do
      end do
    end do
  end subroutine run_stability

  pure real(wp) function cfl_or(default, i)
    real(wp), intent(in) :: default(:)
    integer, intent(in) :: i
    cfl_or = default(i)
    if (size(options%cfl) >= i) cfl_or = options%cfl(i)
  end function cfl_or

  subroutine run_one(problem, n, cfl, scheme_name)
    type(problem_type), intent(in) :: problem
    integer, intent(in) :: n
    real(wp), intent(in) :: cfl
    character(*), intent(in) :: scheme_name
    type(scheme_type) :: scheme
    type(outcome_type) :: outcome
    logical :: known
    call scheme_named(scheme_name, scheme, known)
    if (known) then
      call run_problem(problem, n, cfl, scheme, scheme_name, outcome)
      call print_line(problem, outcome)
    else
      print '(2a)', '# no such scheme: ', trim(scheme_name)
    end if
  end subroutine run_one

  subroutine print_head()
    integer :: i
    print '(a,*(:,",",a))', 'case,scheme,cells_x,cells_y,cells_z,cfl,verdict,steps,wall_s,ns_per_cell_stage', &
      (trim(repair_names(i)), i=1, n_repairs), 'triad_gb_s,multiply_add_gflop_s,measures,title'
  end subroutine print_head

  !> measures: name=value or name=value<bound, with | between.
  subroutine print_line(problem, outcome)
    type(problem_type), intent(in) :: problem
    type(outcome_type), intent(in) :: outcome
    character(:), allocatable :: measures, verdict
    character(48) :: number
    integer :: i
    measures = ''
    do i = 1, size(outcome%measure)
      associate (m => outcome%measure(i))
        write (number, '(es11.4e3)') m%value
        if (m%bound < huge(1.0_wp)) write (number, '(es11.4e3,a,es9.2)') m%value, '<', m%bound
        measures = measures//trim(m%name)//'='//trim(adjustl(number))//'|'
      end associate
    end do
    verdict = outcome%failures()
    if (len(verdict) == 0) verdict = 'passes'
    write (*, '(3a,3(",",i0),",",f4.2,3a,i0,",",es10.4e2,",",f0.2,*(:,",",i0))', advance='no') trim(problem%name), ',', &
      trim(outcome%scheme), outcome%cells, outcome%cfl, ',"', verdict, '",', outcome%steps, outcome%wall, outcome%nanoseconds, &
      outcome%repairs
    print '(2(",",f0.2),5a)', machine%triad, machine%multiply_add, ',"', measures, '","', trim(problem%title), '"'
    flush (6)
  end subroutine print_line

  subroutine run_speed()
    character(48), allocatable :: schemes(:)
    integer, parameter :: sides(2, 2:3) = reshape([32, 64, 16, 32], [2, 2])
    type(speed_type) :: speed
    type(scheme_type) :: scheme
    logical :: known
    integer :: i, k, s, d
    schemes = schemes_or([character(48) :: 'paper', default_scheme])
    call add_speed_scenes(list)
    print '(a)', 'case,scheme,cells,brick,ns_per_cell_stage,bookkeeping_share,triad_gb_s,multiply_add_gflop_s,title'
    do i = 1, size(list)
      if (.not. wanted(list(i)%name, options%cases)) cycle
      d = count(list(i)%cells > 1)
      do s = 1, size(schemes)
        call scheme_named(schemes(s), scheme, known)
        if (.not. known) cycle
        do k = 1, 2
          speed = time_steps(list(i), scheme, sides(k, d), merge(3, 10, options%quick))
          machine = calibrate()
          print '(3a,2(",",i0),",",f0.2,",",f6.4,2(",",f0.2),3a)', trim(list(i)%name), ',', trim(schemes(s)), list(i)%cells(1), &
            sides(k, d), speed%nanoseconds, speed%bookkeeping, machine%triad, machine%multiply_add, ',"', trim(list(i)%title), '"'
          flush (6)
        end do
      end do
    end do
  end subroutine run_speed

  subroutine run_particles()
    type(particle_speed) :: speed
    integer :: i, k
    print '(a)', 'case,particles,bricks,ns_per_particle_step,triad_gb_s,multiply_add_gflop_s,title'
    do i = 1, n_solid_scenes
      if (.not. wanted(solid_scene_names(i), options%cases)) cycle
      do k = 1, merge(1, 2, options%quick)
        speed = time_particles(i, k == 2, merge(60, 300, options%quick))
        machine = calibrate()
        print '(a,2(",",i0),3(",",f0.2),3a)', trim(solid_scene_names(i)), speed%particles, merge(8, 0, k == 2), speed%nanoseconds, &
          machine%triad, machine%multiply_add, ',"', trim(solid_scene_titles(i)), '"'
        flush (6)
      end do
    end do
  end subroutine run_particles

end program flow_bench
