!> From the deck to a scene that is ready to run.
module setup
  use body_loads, only: start_loads
  use deck, only: read_deck
  use flow_initial, only: setup_flow, flow_scheme_of
  use flow_scheme, only: ghost_layers
  use halo, only: plan_halo
  use immersed_boundary, only: start_coupling, immerse_solid
  use kinds, only: wp
  use log, only: say, be_quiet
  use mesh, only: build_mesh, assign_ranks
  use options, only: options_type
  use particle_generation, only: piece_type
  use plan, only: brick_weights, even_axes
  use scene, only: scene_type
  use solid_setup, only: setup_solid
  use solid_step, only: project_solid
  use stages, only: start_stages
  use text, only: str, lowercase
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: read_scene, lay_out_scene, make_scene

contains

  !> Reads and checks the deck, applies the options, and lays out the mesh if the deck has a scene. Nothing large is allocated and
  !> nothing is written.
  subroutine read_scene(options, scene)
    type(options_type), intent(in) :: options
    type(scene_type), intent(out) :: scene
    if (options%quiet) call be_quiet()
    call read_deck(options%deck, scene%deck, options%overrides)
    if (len(options%output) > 0) scene%deck%output%directory = options%output
    if (options%wall_limit > 0) scene%deck%run%wall_limit = options%wall_limit
    if (.not. (scene%deck%has_flow .or. scene%deck%has_solid)) return ! material tests only
    call lay_out_scene(scene)
    scene%clock%end_time = min(scene%clock%end_time, options%until)
  end subroutine read_scene

  !> Which solvers the deck asks for, the mesh, and each rank's part of it.
  subroutine lay_out_scene(scene)
    type(scene_type), intent(inout) :: scene
    logical :: periodic(3)
    integer :: d, layers
    associate (deck => scene%deck)
      layers = ghost_layers(flow_scheme_of(deck))
      periodic = [(trim(deck%boundary%flow_face(d, 1)) == 'periodic', d=1, 3)]
      call build_mesh(scene%mesh, deck%mesh%cells, deck%mesh%lower, deck%mesh%upper, deck%mesh%brick, periodic, layers)
      if (deck%has_solid) call build_mesh(scene%mesh, deck%mesh%cells, deck%mesh%lower, deck%mesh%upper, deck%mesh%brick, &
                                          periodic, layers, even_axes(deck, scene%mesh))
      scene%mesh%radial_power = deck%mesh%radial_power()
      call assign_ranks(scene%mesh, brick_weights(deck, scene%mesh))
      scene%has_flow = deck%has_flow
      scene%has_solid = deck%has_solid
      scene%coupled = deck%has_flow .and. deck%has_solid .and. trim(lowercase(deck%coupling%method)) /= 'none'
      scene%clock%end_time = deck%run%end_time
    end associate
  end subroutine lay_out_scene

  !> Fills the mesh with gas and particles.
  subroutine make_scene(scene)
    type(scene_type), intent(inout) :: scene
    type(piece_type), allocatable :: pieces(:)
    real(wp) :: ambient
    call plan_halo(scene%mesh, scene%halo)
    if (scene%has_flow) call setup_flow(scene%mesh, scene%deck, scene%flow)
    if (scene%has_solid) then
      call setup_solid(scene%mesh, scene%deck, scene%solid, pieces)
      call say_pieces(scene, pieces)
      call project_solid(scene%mesh, scene%halo, scene%solid)
    end if
    if (scene%coupled) then
      ambient = scene%deck%flow%ambient_pressure
      call start_coupling(scene%coupling, scene%mesh, scene%flow, ambient, &
                          trim(lowercase(scene%deck%coupling%method)) == 'moving_wall')
      scene%flow%slip = trim(lowercase(scene%deck%coupling%wall)) == 'slip'
      call immerse_solid(scene%mesh, scene%halo, scene%solid, scene%flow, scene%coupling)
      if (scene%deck%output%loads) call start_loads(scene%loads, scene%mesh, scene%solid, 0.01_wp*abs(ambient))
    end if
    call start_stages(scene%stages, scene%deck%stages, scene%solid, scene%coupled)
  end subroutine make_scene

  !> Tells what the bodies came to; shapes of the same name and material, the bars of a mesh say, in one line.
  subroutine say_pieces(scene, pieces)
    type(scene_type), intent(in) :: scene
    type(piece_type), intent(in) :: pieces(:)
    type(unit_labels_type) :: labels
    integer :: first, last, n
    labels = unit_labels(trim(scene%deck%run%units))
    n = size(pieces)
    first = 1
    do while (first <= n)
      last = first
      do while (last < n)
        if (pieces(last + 1)%name /= pieces(first)%name .or. pieces(last + 1)%set /= pieces(first)%set) exit
        last = last + 1
      end do
      associate (same => pieces(first:last), material => scene%solid%material(pieces(first)%set))
        call say('body '//trim(same(1)%name)//': '//str(sum(same%count))//' particles of '//trim(material%name)//' in '// &
                 str(size(same))//trim(merge(' shape ', ' shapes', size(same) == 1))//', mass '// &
                 str(sum(same%volume)*material%density)//' '//trim(labels%mass)// &
                 ', particle volume over that of its lattice '//str(minval(same%scale), 4))
      end associate
      first = last + 1
    end do
  end subroutine say_pieces

end module setup
