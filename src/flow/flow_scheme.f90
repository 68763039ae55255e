!> The numerical scheme of the flow: which reconstruction, what is done at interfaces and at shocks.
module flow_scheme
  implicit none
  private
  public :: scheme_from_words, ghost_layers

  integer, parameter, public :: muscl = 1, fifth_order = 2
  integer, parameter, public :: venkatakrishnan = 1, minmod = 2, van_leer = 3, third_order = 4 !< limiters of MUSCL
  character(15), parameter, public :: reconstruction_names(2) = [character(15) :: 'muscl', 'fifth_order']
  character(15), parameter, public :: limiter_names(4) = [character(15) :: 'venkatakrishnan', 'minmod', 'van_leer', 'third_order']
  character(15), parameter, public :: interface_names(2) = [character(15) :: 'diffuse', 'thinc']
  character(15), parameter, public :: shock_names(2) = [character(15) :: 'plain', 'sensor']

  type, public :: scheme_type
    integer :: reconstruction = fifth_order
    integer :: limiter = third_order !< of muscl
    logical :: sharpen = .true. !< interfaces by THINC
    logical :: cure_shocks = .true. !< shear waves are dissipated at shocks: no carbuncle
  end type scheme_type

contains

  !> The scheme that the words of a deck name; a word that is in none of the lists takes the first of its list.
  pure function scheme_from_words(reconstruction, limiter, interface, shocks) result(scheme)
    character(*), intent(in) :: reconstruction, limiter, interface, shocks
    type(scheme_type) :: scheme
    scheme%reconstruction = max(1, findloc(reconstruction_names == reconstruction, .true., dim=1))
    scheme%limiter = max(1, findloc(limiter_names == limiter, .true., dim=1))
    scheme%sharpen = interface == 'thinc'
    scheme%cure_shocks = shocks == 'sensor'
  end function scheme_from_words

  !> Layers of ghost cells that the scheme reads.
  pure integer function ghost_layers(scheme)
    type(scheme_type), intent(in) :: scheme
    ghost_layers = merge(3, 2, scheme%reconstruction == fifth_order)
  end function ghost_layers

end module flow_scheme
