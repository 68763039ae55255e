!> brisance --material-test DECK: each &material_test of the deck drives one material point along its path and writes the curve.
module material_test
  use constants, only: third
  use csv_series, only: series, open_series, put_row, close_series
  use deck_material_test, only: material_test_group
  use deck_types, only: deck_type, find_material
  use errors, only: fatal, exit_bad_input
  use file_system, only: make_directory
  use johnson_cook, only: johnson_cook_temperature
  use kinds, only: wp
  use log, only: say
  use material_point, only: point_type, start_point, drive, drive_held, pressure_of, mises_of, lateral_stress_of
  use parallel, only: is_root
  use particles, only: at_mass, at_volume, at_stress, at_energy, at_plastic_strain, at_damage, at_plastic_work
  use solid_material, only: make_solid_material, model_johnson_cook
  use text, only: lowercase, str
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: tell_material_tests, run_material_tests

  !> What the summary tells of a test.
  type :: extremes_type
    integer :: steps = 0
    real(wp) :: highest = 0, lowest = 0 !< stress_xx
    real(wp) :: mises = 0, pressure = 0
  end type extremes_type

contains

  !> Lists the tests of the deck. Fatal (bad input) where it has none.
  subroutine tell_material_tests(deck)
    type(deck_type), intent(in) :: deck
    character(:), allocatable :: names
    integer :: i
    if (size(deck%material_test) == 0) call fatal('the deck has no &material_test', exit_bad_input)
    if (len_trim(deck%run%title) > 0) call say(trim(deck%run%title))
    names = ''
    do i = 1, size(deck%material_test)
      if (first_of(deck, i) == i) names = names//', '//trim(deck%material_test(i)%name)
    end do
    call say('material tests: '//names(3:))
  end subroutine tell_material_tests

  !> Runs all tests of a checked deck and writes <name>.csv for each into its output folder. To be called by every rank: the first
  !> one runs them.
  subroutine run_material_tests(deck)
    type(deck_type), intent(in) :: deck
    integer :: i
    if (.not. is_root()) return
    call make_directory(trim(deck%output%directory))
    do i = 1, size(deck%material_test)
      if (first_of(deck, i) == i) call run_test(deck, i, trim(deck%output%directory))
    end do
  end subroutine run_material_tests

  !> Number of the first segment of the test that segment i belongs to.
  pure integer function first_of(deck, i)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: i
    do first_of = 1, i
      if (lowercase(deck%material_test(first_of)%name) == lowercase(deck%material_test(i)%name)) return
    end do
  end function first_of

  subroutine run_test(deck, first, folder)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: first
    character(*), intent(in) :: folder
    type(point_type) :: point
    type(series) :: table
    type(extremes_type) :: extremes
    type(unit_labels_type) :: labels
    character(:), allocatable :: file
    real(wp) :: time, strain(6)
    integer :: i
    labels = unit_labels(trim(deck%run%units))
    associate (test => deck%material_test(first))
      point = start_point(make_solid_material(deck%material(find_material(deck, test%material)), .false.), test%length)
      file = folder//'/'//file_name(trim(test%name))//'.csv'
    end associate
    call open_series(table, file, headings(point, labels))
    time = 0
    strain = 0
    call put_row(table, row_of(point, time, strain))
    do i = first, size(deck%material_test)
      if (first_of(deck, i) == first) call run_segment(deck%material_test(i), point, time, strain, table, extremes)
    end do
    call close_series(table)
    associate (test => deck%material_test(first))
      call say('material test '//trim(test%name)//': material '//trim(test%material)//' ('// &
        trim(deck%material(find_material(deck, test%material))%model)//'), '//str(extremes%steps)//' steps')
      call say('  stress_xx '//str(extremes%lowest, 5)//' to '//str(extremes%highest, 5)//' '//trim(labels%pressure)// &
        ', von Mises up to '//str(extremes%mises, 5)//', pressure up to '//str(extremes%pressure, 5))
      call say('  at the end: plastic strain '//str(point%f(1, at_plastic_strain), 4)//', damage '// &
        str(point%f(1, at_damage), 4)//', energy '//str(point%f(1, at_energy)/point%f(1, at_mass), 5)//' '// &
        trim(labels%energy_per_mass)//'; '//file)
    end associate
  end subroutine run_test

  !> Drives the point along one segment, a row for each step.
  subroutine run_segment(test, point, time, strain, table, extremes)
    type(material_test_group), intent(in) :: test
    type(point_type), intent(inout) :: point
    real(wp), intent(inout) :: time, strain(6)
    type(series), intent(inout) :: table
    type(extremes_type), intent(inout) :: extremes
    real(wp) :: dt, axial, lateral, held, rate(3, 3)
    logical :: is_held, has_target
    integer :: step
    dt = abs(test%strain)/(test%strain_rate*test%steps)
    axial = sign(test%strain_rate, test%strain)
    rate = axial*direction(test)
    is_held = test%path == 'uniaxial_stress' .or. test%path == 'triaxial'
    held = 0
    if (test%path == 'triaxial') held = lateral_stress_of(point)
    lateral = -0.2_wp*axial ! a guess: Poisson's ratio of many solids
    has_target = test%path == 'hydrostatic' .and. abs(test%pressure) < huge(1.0_wp)
    do step = 1, test%steps
      if (is_held) then
        call drive_held(point, axial, held, dt, lateral)
        rate(2, 2) = lateral
        rate(3, 3) = lateral
      else
        call drive(point, rate, 1, dt)
      end if
      time = time + dt
      strain = strain + dt*[rate(1, 1), rate(2, 2), rate(3, 3), 0.5_wp*(rate(2, 3) + rate(3, 2)), &
        0.5_wp*(rate(1, 3) + rate(3, 1)), 0.5_wp*(rate(1, 2) + rate(2, 1))]
      call put_row(table, row_of(point, time, strain))
      extremes%steps = extremes%steps + 1
      extremes%highest = max(extremes%highest, point%f(1, at_stress))
      extremes%lowest = min(extremes%lowest, point%f(1, at_stress))
      extremes%mises = max(extremes%mises, mises_of(point))
      extremes%pressure = max(extremes%pressure, pressure_of(point))
      if (has_target) then
        if ((pressure_of(point) - test%pressure)*sign(1.0_wp, test%strain) <= 0) exit
      end if
    end do
  end subroutine run_segment

  !> Velocity gradient of a path at unit strain rate.
  pure function direction(test) result(gradient)
    type(material_test_group), intent(in) :: test
    real(wp) :: gradient(3, 3)
    integer :: d
    gradient = 0
    select case (test%path)
    case ('hydrostatic')
      do d = 1, 3
        gradient(d, d) = third
      end do
    case ('shear')
      gradient(1, 2) = 1
    case ('gradient')
      gradient = transpose(reshape(test%gradient, [3, 3]))
    case default
      gradient(1, 1) = 1
    end select
  end function direction

  pure function headings(point, labels) result(columns)
    type(point_type), intent(in) :: point
    type(unit_labels_type), intent(in) :: labels
    character(40), allocatable :: columns(:)
    character(2), parameter :: axes(6) = ['xx', 'yy', 'zz', 'yz', 'xz', 'xy']
    integer :: k
    columns = [character(40) :: 'time ['//trim(labels%time)//']', ('strain_'//axes(k)//' [-]', k=1, 6), 'compression [-]', &
      ('stress_'//axes(k)//' ['//trim(labels%pressure)//']', k=1, 6), 'pressure ['//trim(labels%pressure)//']', &
      'von_mises ['//trim(labels%pressure)//']', 'plastic_strain [-]', 'damage [-]', &
      'internal_energy ['//trim(labels%energy_per_mass)//']']
    if (point%material%model == model_johnson_cook) &
      columns = [character(40) :: columns, 'temperature ['//trim(labels%temperature)//']']
  end function headings

  !> Strains are integrals of the strain rate; compression is r/r0 - 1.
  pure function row_of(point, time, strain) result(row)
    type(point_type), intent(in) :: point
    real(wp), intent(in) :: time, strain(6)
    real(wp), allocatable :: row(:)
    associate (f => point%f, m => point%material)
      row = [time, strain, f(1, at_mass)/(m%density*f(1, at_volume)) - 1, f(1, at_stress:at_stress + 5), pressure_of(point), &
        mises_of(point), f(1, at_plastic_strain), f(1, at_damage), f(1, at_energy)/f(1, at_mass)]
      if (m%model == model_johnson_cook) row = [row, johnson_cook_temperature(m%taylor_quinney/m%specific_heat, &
        m%reference_temperature, f(1, at_plastic_work), f(1, at_mass))]
    end associate
  end function row_of

  !> A name that a shell takes without quotes.
  pure function file_name(name) result(plain)
    character(*), intent(in) :: name
    character(len(name)) :: plain
    integer :: i
    plain = name
    do i = 1, len(name)
      if (scan(name(i:i), ' :*?|&<>()[]{}$!#~''') > 0) plain(i:i) = '_'
    end do
  end function file_name

end module material_test
