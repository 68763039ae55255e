!> brisance: what a blast does to a structure.
program brisance
  use charge_start, only: start_charges
  use errors, only: exit_done
  use main_loop, only: run_scene
  use material_test, only: run_material_tests, tell_material_tests
  use options, only: options_type, read_options, usage
  use parallel, only: parallel_start, parallel_stop, is_root
  use plan, only: print_plan
  use process, only: exit_process
  use records, only: records_type, open_records, close_records
  use scene, only: scene_type
  use setup, only: read_scene, make_scene
  use stopping, only: watch_signals, start_wall_clock
  use version, only: version_string
  implicit none
  type(options_type) :: options
  type(scene_type) :: scene
  type(records_type) :: records
  integer :: status

  call parallel_start()
  call start_wall_clock()
  call watch_signals()
  options = read_options()
  status = exit_done
  if (options%help) then
    if (is_root()) print '(a)', usage()
  else if (options%version) then
    if (is_root()) print '(2a)', 'brisance ', version_string
  else
    call read_scene(options, scene)
    if (options%material_test .or. .not. (scene%deck%has_flow .or. scene%deck%has_solid)) then
      call tell_material_tests(scene%deck)
      if (.not. options%check) call run_material_tests(scene%deck)
    else
      if (is_root() .and. .not. options%quiet) call print_plan(scene)
      if (.not. options%check) then
        call make_scene(scene)
        if (.not. options%restart) call start_charges(scene)
        call open_records(scene, options, records)
        call run_scene(scene, records, status)
        call close_records(scene, records, status)
      end if
    end if
  end if
  call parallel_stop()
  call exit_process(status)
end program brisance
