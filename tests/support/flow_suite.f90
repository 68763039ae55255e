!> All test problems of the flow, and the schemes by name. A new problem is one more entry in one of the modules used here.
module flow_suite
  use deck_flow, only: reconstruction_names, limiter_names
  use flow_problem, only: problem_type, outcome_type
  use flow_problem_run, only: run_problem
  use flow_scheme, only: scheme_type, muscl, venkatakrishnan
  use gas_problems, only: add_smooth_flows, add_shock_problems
  use interface_problems, only: add_interface_problems
  use kinds, only: wp
  use tube_problems, only: add_gas_tubes, add_material_tubes
  implicit none
  private
  public :: all_problems, problem_named, scheme_named, faults_of

  real(wp), parameter, public :: promised_cfl(2) = [0.5_wp, 0.8_wp] !< Courant numbers at which all is to work

contains

  subroutine all_problems(list)
    type(problem_type), allocatable, intent(out) :: list(:)
    call add_smooth_flows(list)
    call add_gas_tubes(list)
    call add_material_tubes(list)
    call add_shock_problems(list)
    call add_interface_problems(list)
  end subroutine all_problems

  !> The problem of that name; one without a name if there is none.
  function problem_named(name) result(problem)
    character(*), intent(in) :: name
    type(problem_type) :: problem
    type(problem_type), allocatable :: list(:)
    integer :: i
    call all_problems(list)
    do i = 1, size(list)
      if (list(i)%name == name) problem = list(i)
    end do
  end function problem_named

  !> What is wrong with a problem, in words, empty if nothing: at its own resolution, with the scheme that decks get and both
  !> Courant numbers that are promised.
  function faults_of(name) result(text)
    character(*), intent(in) :: name
    character(:), allocatable :: text
    type(problem_type) :: problem
    type(outcome_type) :: outcome
    integer :: i
    text = ''
    problem = problem_named(name)
    if (problem%name == '') text = 'there is no problem '//name
    do i = 1, merge(size(promised_cfl), 0, problem%name /= '')
      call run_problem(problem, 0, promised_cfl(i), scheme_type(), 'default', outcome)
      text = text//outcome%failures()
    end do
  end function faults_of

  !> The scheme that words joined by + make: a reconstruction, a limiter, thinc, sensor. What is not named is as in the paper
  !> (muscl, venkatakrishnan, interfaces left alone, shocks left alone), which is the scheme `paper`. known: false for other words.
  subroutine scheme_named(name, scheme, known)
    character(*), intent(in) :: name
    type(scheme_type), intent(out) :: scheme
    logical, intent(out) :: known
    character(:), allocatable :: rest
    integer :: plus
    scheme = scheme_type(muscl, venkatakrishnan, .false., .false.)
    known = .true.
    if (name == 'paper') return
    rest = trim(name)//'+'
    do while (len(rest) > 0)
      plus = index(rest, '+')
      associate (word => rest(:plus - 1))
        if (any(reconstruction_names == word)) then
          scheme%reconstruction = findloc(reconstruction_names == word, .true., dim=1)
        else if (any(limiter_names == word)) then
          scheme%limiter = findloc(limiter_names == word, .true., dim=1)
        else if (word == 'thinc') then
          scheme%sharpen = .true.
        else if (word == 'sensor') then
          scheme%cure_shocks = .true.
        else
          known = .false.
        end if
      end associate
      rest = rest(plus + 1:)
    end do
  end subroutine scheme_named

end module flow_suite
