!> Charges that ask for a start of their own: each is run on a fine mesh, radial or axisymmetric, or taken from a file of such a
!> run, until its wave nearly meets something, and laid into the scene, whose clock goes on from there. All at the same time.
module charge_start
  use axisymmetric_run, only: axisymmetric_deck, run_axisymmetrically
  use charge_reach, only: cells_in_charge, charge_extents, reach_of_charge, start_axis
  use checksum, only: empty_checksum, hexadecimal, mix_integer
  use constants, only: unset
  use deck, only: deck_text
  use deck_types, only: deck_type
  use errors, only: fatal, warn, exit_bad_input
  use kinds, only: wp, i8
  use log, only: say
  use parallel, only: is_root
  use radial_mapping, only: map_profile
  use radial_profile, only: blast_type, radial_profile_type
  use radial_run, only: run_radially, radial_deck
  use scene, only: scene_type
  use start_mesh, only: mesh_of_start
  use start_files, only: start_file_exists, read_start_file, write_start_file
  use text, only: str
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: start_charges, fingerprint_of_start

  real(wp), parameter :: noticeable = 0.01_wp !< of the energy of a charge
  real(wp), parameter :: same = 1e-9_wp !< of two lengths that are one

contains

  !> Lays the blasts into a scene that has been made; nothing without charges that ask for it. To be called by all ranks.
  subroutine start_charges(scene)
    type(scene_type), intent(inout) :: scene
    type(unit_labels_type) :: labels
    real(wp) :: stop_radius(size(scene%deck%charge)), time
    logical :: is_read(size(scene%deck%charge))
    integer, allocatable :: list(:)
    integer :: c, i
    list = pack([(c, c=1, size(scene%deck%charge))], scene%deck%charge%is_mapped())
    if (size(list) == 0) return
    labels = unit_labels(trim(scene%deck%run%units))
    call scene%watch%start('start')
    allocate (scene%blast(size(list)))
    associate (deck => scene%deck, blast => scene%blast)
      do i = 1, size(list)
        stop_radius(i) = stop_of(deck, list(i))
        blast(i)%center = deck%charge(list(i))%center
        blast(i)%axis = start_axis(deck, list(i))
      end do
      call find_blasts(deck, list, stop_radius(:size(list)), blast, is_read(:size(list)), time)
      call check_later_charges(deck, time)
      do i = 1, size(list)
        c = list(i)
        call map_profile(scene%mesh, scene%flow, blast(i))
        if (deck%charge(c)%start_file /= '' .and. .not. is_read(i)) call write_start_file(trim(deck%charge(c)%start_file), &
          blast(i)%profile, fingerprint_of_start(deck, c), stop_radius(i))
        if (abs(blast(i)%profile%energy_error) > noticeable .and. is_root()) call warn('start of charge '//str(c)// &
          ': repairs have changed its energy by '//str(100*blast(i)%profile%energy_error, 3)//' %')
        call say('start of charge '//str(c)//': its wave has come to the '// &
                 trim(merge('distance', 'radius  ', blast(i)%axis > 0))//' '//str(blast(i)%profile%front, 5)//' '// &
                 trim(labels%length)//' at '//str(time, 6)//' '//trim(labels%time)//origin(deck%charge(c)%start_file, is_read(i)))
      end do
      scene%clock%time = time
      scene%flow%time = time
    end associate
    call scene%watch%stop('start')
  end subroutine start_charges

  function origin(file, is_read) result(text)
    character(*), intent(in) :: file
    logical, intent(in) :: is_read
    character(:), allocatable :: text
    text = ''
    if (is_read) text = ', from '//trim(file)
    if (file /= '' .and. .not. is_read) text = ', kept in '//trim(file)
  end function origin

  real(wp) function stop_of(deck, c) result(stop_radius)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    character(:), allocatable :: obstacle
    stop_radius = deck%charge(c)%start_stop
    if (.not. stop_radius > unset) call reach_of_charge(deck, c, stop_radius, obstacle)
  end function stop_of

  !> The blasts of the charges in the list, all at one time: when the first of them has come to its stop.
  subroutine find_blasts(deck, list, stop_radius, blast, is_read, time)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: list(:)
    real(wp), intent(in) :: stop_radius(:)
    type(blast_type), intent(inout) :: blast(:)
    logical, intent(out) :: is_read(:)
    real(wp), intent(out) :: time
    integer :: i
    time = huge(1.0_wp)
    do i = 1, size(list)
      is_read(i) = .false.
      if (deck%charge(list(i))%start_file /= '') is_read(i) = start_file_exists(trim(deck%charge(list(i))%start_file))
      if (is_read(i)) call take_from_file(deck, list(i), stop_radius(i), blast(i)%profile)
      if (is_read(i)) time = min(time, blast(i)%profile%time)
    end do
    do i = 1, size(list)
      if (.not. is_read(i)) blast(i)%profile = blast_of(deck, list(i), stop_radius(i), time)
      time = min(time, blast(i)%profile%time)
    end do
    do i = 1, size(list)
      if (.not. blast(i)%profile%time > time) cycle
      if (is_read(i)) call fatal('start_file '''//trim(deck%charge(list(i))%start_file)//''' is of the time '// &
        str(blast(i)%profile%time, 6)//', but another charge of the deck enters the scene at '//str(time, 6), exit_bad_input)
      blast(i)%profile = blast_of(deck, list(i), stop_radius(i), time)
    end do
  end subroutine find_blasts

  !> The blast of charge c, computed.
  function blast_of(deck, c, stop_radius, latest) result(profile)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(in) :: stop_radius, latest
    type(radial_profile_type) :: profile
    character(:), allocatable :: obstacle
    real(wp) :: reach
    if (start_axis(deck, c) == 0) then
      profile = run_radially(deck, c, stop_radius, latest)
      return
    end if
    profile = run_axisymmetrically(deck, c, stop_radius, latest)
    call reach_of_charge(deck, c, reach, obstacle)
    if (profile%front > reach + 4*profile%thickness) call fatal('charge '//str(c)//': it burns until '//str(profile%time, 5)// &
      ', when its wave has come to '//str(profile%front, 5)//', but it meets '//obstacle//' after '//str(reach, 5), exit_bad_input)
  end function blast_of

  !> The blast of charge c from its file. Fatal (bad input) where it does not fit the deck.
  subroutine take_from_file(deck, c, stop_radius, profile)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    real(wp), intent(in) :: stop_radius
    type(radial_profile_type), intent(out) :: profile
    character(:), allocatable :: obstacle
    real(wp) :: stopped_at, reach, finest, distance(2)
    integer :: axis, side
    associate (charge => deck%charge(c))
      call read_start_file(trim(charge%start_file), profile, fingerprint_of_start(deck, c), stopped_at)
      call reach_of_charge(deck, c, reach, obstacle)
      if (profile%front > reach + 2*profile%thickness) call refuse('its wave has come to '//str(profile%front, 5)// &
        ', but here it meets '//obstacle//' after '//str(reach, 5))
      if (charge%start_stop > unset .and. abs(stopped_at - stop_radius) > same*stop_radius) call refuse('it was stopped at '// &
        str(stopped_at, 5)//', not at start_stop')
      finest = minval(charge_extents(deck, c))
      if (charge%start_cells > 0 .and. abs(profile%finest*charge%start_cells - finest) > same*finest) &
        call refuse('its mesh has other cells than start_cells says')
      axis = start_axis(deck, c)
      if (axis == 0) return
      distance = [charge%center(axis) - deck%mesh%lower(axis), deck%mesh%upper(axis) - charge%center(axis)]
      do side = 1, 2
        if (min(distance(side), profile%end_distance(side)) > profile%front) cycle
        if (abs(distance(side) - profile%end_distance(side)) > same*profile%front .or. &
            deck%boundary%flow_face(axis, side) /= profile%end_kind(side)) call refuse('its wave has met a face '''// &
          trim(profile%end_kind(side))//''' across the axis at a distance of '//str(profile%end_distance(side), 5)// &
          ', the deck has '''//trim(deck%boundary%flow_face(axis, side))//''' at '//str(distance(side), 5))
      end do
    end associate
  contains
    subroutine refuse(reason)
      character(*), intent(in) :: reason
      call fatal('start_file '''//trim(deck%charge(c)%start_file)//''' does not fit: '//reason, exit_bad_input)
    end subroutine refuse
  end subroutine take_from_file

  !> Charges that are filled in as they were at first must not be lit before the blasts enter.
  subroutine check_later_charges(deck, time)
    type(deck_type), intent(in) :: deck
    real(wp), intent(in) :: time
    integer :: i
    if (all(deck%charge%is_mapped())) return
    do i = 1, size(deck%detonator)
      if (deck%detonator(i)%charge > 0) then
        if (deck%charge(deck%detonator(i)%charge)%is_mapped()) cycle
      end if
      if (deck%detonator(i)%time < time) call fatal('detonator on line '//str(deck%detonator(i)%line)// &
        ': it lights a charge before '//str(time, 6)// &
        ', when the blast of another enters the scene: that one needs a smaller start_stop', exit_bad_input)
    end do
  end subroutine check_later_charges

  !> A fingerprint of all that the run of charge c depends on, but for its mesh and its stop.
  function fingerprint_of_start(deck, c) result(digits)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: c
    character(16) :: digits
    type(deck_type) :: alone, none
    character(:), allocatable :: text
    integer(i8) :: mixed
    real(wp) :: room
    integer :: i
    if (start_axis(deck, c) == 0) then
      alone = radial_deck(deck, c, 2*cells_in_charge(deck, c))
    else
      alone = axisymmetric_deck(deck, c, mesh_of_start(deck, c), 0, 2, room)
      alone%charge%start = 'axisymmetric'
    end if
    alone%mesh%cells = 2
    alone%mesh%lower = 0
    alone%mesh%upper = 1
    alone%boundary%y_low = none%boundary%y_low
    alone%boundary%y_high = none%boundary%y_high
    alone%charge%start_axis = ''
    alone%gauge = alone%gauge(:0)
    alone%charge%start_cells = 0
    alone%charge%start_stop = unset
    alone%charge%start_file = ''
    alone%run = none%run
    alone%run%units = deck%run%units
    alone%output = none%output
    alone%solid = none%solid
    alone%coupling = none%coupling
    alone%material = pack(alone%material, [(flows(i), i=1, size(alone%material))])
    alone%material%library = ''
    do i = 1, 3
      alone%charge%center(i) = 0
    end do
    alone%hole = alone%hole(:0)
    alone%reinforcement = alone%reinforcement(:0)
    alone%heterogeneity = alone%heterogeneity(:0)
    alone%clamp = alone%clamp(:0)
    alone%contact = alone%contact(:0)
    alone%material_test = alone%material_test(:0)
    alone%file = ''
    text = deck_text(alone)
    mixed = empty_checksum
    do i = 1, len(text)
      mixed = mix_integer(mixed, int(iachar(text(i:i)), i8))
    end do
    digits = hexadecimal(mixed)
  contains
    logical function flows(m)
      integer, intent(in) :: m
      flows = any(alone%region%material == alone%material(m)%name) .or. any(alone%charge%explosive == alone%material(m)%name)
    end function flows
  end function fingerprint_of_start

end module charge_start
