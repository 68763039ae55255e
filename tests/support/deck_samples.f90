!> Small decks that are right, and what to ask of the messages that a wrong one gives.
module deck_samples
  implicit none
  private
  public :: flow_deck, coupled_deck, told, place_of

  character, parameter, public :: nl = new_line('a')

contains

  !> A shock tube in the unit system given; eight lines.
  pure function flow_deck(units) result(text)
    character(*), intent(in) :: units
    character(:), allocatable :: text
    text = '&run end_time = 1e-3, units = '''//units//''''//nl//'/'//nl// &
      '&mesh cells = 8, upper = 1.0 /'//nl// &
      '&material name = ''gas'', eos = ''ideal_gas'', gamma = 1.4 /'//nl// &
      '&region'//nl//'  shape = ''all'', material = ''gas'', density = 1.0, pressure = 1e5'//nl//'/'//nl
  end function flow_deck

  !> A charge, a slab with bars and a hole, and gauges, in SI; every repeated group is there.
  pure function coupled_deck() result(text)
    character(:), allocatable :: text
    text = '&run end_time = 1e-3, title = ''it''''s "a" title'' /'//nl// &
      '&mesh cells = 3*16, upper = 3*0.8, brick = 3*8 /'//nl// &
      '&boundary x_low = ''symmetry'', y_low = ''symmetry'', z_low = ''symmetry'', solid_x_high = ''clamped'' /'//nl// &
      '&material name = ''air'', library = ''AIR'' /'//nl// &
      '&material name = ''tnt'', library = ''TNT'' /'//nl// &
      '&material name = ''concrete'', library = ''CONCRETE_39MPA'' /'//nl// &
      '&material name = ''steel'', library = ''STEEL_REBAR'' /'//nl// &
      '&region shape = ''all'', material = ''air'', pressure = 101325.0 /'//nl// &
      '&charge explosive = ''tnt'', mass = 0.46, center = 3*0.0 /'//nl// &
      '&body name = ''slab'', material = ''concrete'', shape = ''box'''//nl// &
      '  lower = 0.0, 0.0, 0.4, upper = 0.6, 0.6, 0.5, spacing = 0.025 /'//nl// &
      '&hole body = ''slab'', shape = ''cylinder'', start = 0.1, 0.1, 0.4, end = 0.1, 0.1, 0.5, radius = 0.05 /'//nl// &
      '&reinforcement body = ''slab'', material = ''steel'', diameter = 0.03, start = 0.0, 0.3, 0.45'//nl// &
      '  end = 0.6, 0.3, 0.45, count = 2, step = 0.0, 0.2, 0.0 /'//nl// &
      '&clamp lower = 0.55, 0.0, 0.4, upper = 0.6, 0.6, 0.5, fixed = ''xz'' /'//nl// &
      '&gauge name = ''wall'', position = 0.0, 0.0, 0.39 /'//nl// &
      '&gauge name = ''back'', kind = ''solid'', position = 0.0, 0.0, 0.5 /'//nl// &
      '&output snapshot_interval = 1e-4, snapshot_times = 1.5e-5, 2.5e-5, peak_maps = .false. /'//nl
  end function coupled_deck

  !> True if one of the messages holds the text.
  pure logical function told(messages, text)
    character(*), intent(in) :: messages(:)
    character(*), intent(in) :: text
    told = place_of(messages, text) > 0
  end function told

  !> Number of the first message that holds the text, 0 if none does.
  pure integer function place_of(messages, text)
    character(*), intent(in) :: messages(:)
    character(*), intent(in) :: text
    do place_of = 1, size(messages)
      if (index(messages(place_of), text) > 0) return
    end do
    place_of = 0
  end function place_of

end module deck_samples
