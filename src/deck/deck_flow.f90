!> &flow: the numerics of the flow solver.
module deck_flow
  use kinds, only: wp
  use constants, only: unset
  use deck_keys, only: key_table, word_length
  use units, only: of_acceleration, of_pressure
  implicit none
  private
  public :: flow_keys

  character(word_length), parameter, public :: reconstruction_names(2) = [character(word_length) :: 'muscl', 'fifth_order']
  character(word_length), parameter, public :: limiter_names(4) = [character(word_length) :: 'venkatakrishnan', 'minmod', &
    'van_leer', 'third_order']
  character(word_length), parameter, public :: interface_names(2) = [character(word_length) :: 'diffuse', 'thinc']
  character(word_length), parameter, public :: shock_names(2) = [character(word_length) :: 'plain', 'sensor']

  type, public :: flow_group
    real(wp) :: cfl = 0.8_wp !< limit of the sum over directions of (|u|+c) dt/h
    real(wp) :: trace_fraction = 1e-8_wp !< volume fraction of a material where there is none of it
    character(word_length) :: reconstruction = 'fifth_order'
    character(word_length) :: limiter = 'third_order' !< of muscl
    character(word_length) :: interface = 'diffuse'
    character(word_length) :: shocks = 'sensor'
    character(word_length) :: riemann = 'hllc'
    real(wp) :: burn_width = 5 !< cells over which the energy of a programmed charge is released
    real(wp) :: gravity(3) = 0
    logical :: sleep = .true.
    real(wp) :: ambient_pressure = unset !< overpressures are against it; set by the checks from the last 'all' region
    integer :: line = 0
  end type flow_group

contains

  subroutine flow_keys(group, table)
    type(flow_group), intent(inout), target :: group
    type(key_table), intent(inout) :: table
    call table%start('flow', group%line)
    call table%add('cfl', group%cfl, more_than=0.0_wp, at_most=1.0_wp)
    call table%add('trace_fraction', group%trace_fraction, more_than=0.0_wp, at_most=1e-3_wp)
    call table%add('reconstruction', group%reconstruction, reconstruction_names)
    call table%add('limiter', group%limiter, limiter_names)
    call table%add('interface', group%interface, interface_names)
    call table%add('shocks', group%shocks, shock_names)
    call table%add('riemann', group%riemann, [character(word_length) :: 'hllc'])
    call table%add('burn_width', group%burn_width, at_least=1.0_wp, at_most=20.0_wp)
    call table%add('sleep', group%sleep)
    call table%add('gravity', group%gravity, of_acceleration, usual=[-1e4_wp, 1e4_wp])
    call table%add('ambient_pressure', group%ambient_pressure, of_pressure, usual=[-1e9_wp, 1e9_wp])
  end subroutine flow_keys

end module deck_flow
