!> The numerical scheme of the flow: which reconstruction, what is done at interfaces and at shocks.
module flow_scheme
  use deck_flow, only: reconstruction_names, limiter_names, interface_names, shock_names
  implicit none
  private
  public :: scheme_from_words, ghost_layers

  integer, parameter, public :: muscl = 1, fifth_order = 2 !< in the order of their names in the deck
  integer, parameter, public :: venkatakrishnan = 1, minmod = 2, van_leer = 3, third_order = 4 !< limiters of MUSCL

  type, public :: scheme_type
    integer :: reconstruction = fifth_order
    integer :: limiter = third_order !< of muscl
    logical :: sharpen = .false. !< interfaces by THINC: see interface_sharpening
    logical :: cure_shocks = .true. !< no carbuncle, see shock_sensor; right starts of jumps, see strong_fans
  end type scheme_type

contains

  !> The scheme that the words of a deck name; a word that is not in its list stands for the first of it.
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
