!> What a run is going to be, before anything large is allocated: cells, bricks, particles, memory, time step, run time.
module plan
  use charge_reach, only: cells_in_charge, charge_radius, reach_of_charge, start_axis
  use chapman_jouguet, only: chapman_jouguet_state
  use deck_types, only: deck_type, find_material, unset
  use equation_of_state, only: eos_type
  use geometry, only: geometry_names
  use kinds, only: wp, i8
  use log, only: say
  use material_eos, only: eos_of
  use mesh, only: mesh_type
  use parallel, only: n_ranks
  use report, only: duration_text, memory_text
  use scene, only: scene_type
  use start_mesh, only: mesh_of_start, start_mesh_type
  use text, only: str
  use units, only: unit_labels, unit_labels_type
  implicit none
  private
  public :: print_plan, brick_weights, even_axes

  ! Typical costs and sizes, for the estimates only.
  real(wp), parameter :: seconds_per_cell_step = 2.0e-7_wp, seconds_per_particle_step = 1.2e-7_wp
  integer, parameter :: bytes_per_real = 8, particle_columns = 22

contains

  !> Prints the plan.
  subroutine print_plan(scene)
    type(scene_type), intent(in) :: scene
    type(unit_labels_type) :: labels
    real(wp) :: particles, cells, bytes, dt, steps, seconds, stored
    labels = unit_labels(trim(scene%deck%run%units))
    associate (deck => scene%deck, mesh => scene%mesh)
      if (len_trim(deck%run%title) > 0) call say(trim(deck%run%title))
      cells = product(real(mesh%cells, wp))
      particles = sum(planned_particles(deck, mesh))
      stored = product(real(mesh%brick_cells + 2*mesh%ghost, wp))*size(mesh%brick)
      bytes = 0
      if (deck%has_flow) bytes = bytes + 3*bytes_per_real*flow_rows(deck)*stored
      bytes = bytes + bytes_per_real*particle_columns*particles
      call say('mesh: '//geometry_text(mesh)//product_text(mesh, mesh%cells)//' cells of '//trim(str(mesh%spacing(1)))//' '// &
               trim(labels%length)//', '//str(size(mesh%brick))//' bricks of '//product_text(mesh, mesh%brick_cells)//', '// &
               str(n_ranks)//trim(merge(' rank ', ' ranks', n_ranks == 1)))
      if (deck%has_flow) call say('flow: '//trim(materials_text(deck))//', scheme '//scheme_text(deck))
      call tell_explosives(deck, labels)
      call tell_starts(deck, labels)
      if (deck%has_solid) call say('solid: about '//str(nint(particles))//' particles, scheme '//trim(deck%solid%scheme))
      if (deck%has_flow .and. deck%has_solid) call say('coupling: '//trim(deck%coupling%method))
      call say('memory: about '//memory_text(int(bytes, i8)))
      dt = estimated_step(scene)
      steps = deck%run%end_time/dt
      seconds = steps*(merge(cells, 0.0_wp, deck%has_flow)*seconds_per_cell_step + particles*seconds_per_particle_step)/n_ranks
      call say('time: '//str(deck%run%end_time)//' '//trim(labels%time)//' in about '//str(nint(steps))//' steps of '// &
               str(dt, 3)//' '//trim(labels%time)//', about '//duration_text(seconds))
    end associate
  end subroutine print_plan

  !> What kind of mesh it is, where it is not Cartesian.
  function geometry_text(mesh) result(text)
    type(mesh_type), intent(in) :: mesh
    character(:), allocatable :: text
    text = ''
    if (mesh%radial_power > 0) text = trim(geometry_names(mesh%radial_power))//', '
    if (mesh%radial_power > 0 .and. mesh%active(2)) text = 'axisymmetric, '
  end function geometry_text

  !> Detonation of each explosive of a charge, as it follows from its own JWL constants.
  subroutine tell_explosives(deck, labels)
    type(deck_type), intent(in) :: deck
    type(unit_labels_type), intent(in) :: labels
    type(eos_type) :: eos
    real(wp) :: speed, pressure, relative_volume
    integer :: c, m
    logical :: told(size(deck%material))
    told = .false.
    do c = 1, size(deck%charge)
      m = find_material(deck, deck%charge(c)%explosive)
      if (told(m)) cycle
      told(m) = .true.
      eos = eos_of(deck%material(m))
      call chapman_jouguet_state(eos%jwl, speed, pressure, relative_volume)
      call say('explosive '//trim(deck%material(m)%name)//': Chapman-Jouguet detonation at '//str(speed, 5)//' '// &
               trim(labels%velocity)//', pressure '//str(pressure, 5)//' '//trim(labels%pressure)//', relative volume '// &
               str(relative_volume, 4))
    end do
  end subroutine tell_explosives

  !> What is done with charges that enter the scene as a blast.
  subroutine tell_starts(deck, labels)
    type(deck_type), intent(in) :: deck
    type(unit_labels_type), intent(in) :: labels
    character, parameter :: axis_name(3) = ['x', 'y', 'z']
    character(:), allocatable :: obstacle, line
    type(start_mesh_type) :: mesh
    real(wp) :: reach, h
    integer :: c
    do c = 1, size(deck%charge)
      associate (charge => deck%charge(c))
        if (.not. charge%is_mapped()) cycle
        call reach_of_charge(deck, c, reach, obstacle)
        h = charge_radius(deck, c)/cells_in_charge(deck, c)
        line = '2 cells before it meets '//obstacle
        if (charge%start_stop > unset) then
          reach = charge%start_stop
          line = 'as the deck says'
        end if
        if (start_axis(deck, c) > 0) then
          mesh = mesh_of_start(deck, c)
          call say('start of charge '//str(c)//': axisymmetric along '//axis_name(start_axis(deck, c))//', '// &
                   str(cells_in_charge(deck, c))//' cells in its radius, of '//str(mesh%thickness, 4)//' to '// &
                   str(mesh%coarsest_thickness(), 4)//' '//trim(labels%length)//' as the wave grows to the distance '// &
                   str(reach, 5)//' '//trim(labels%length)//', '//line)
        else
          call say('start of charge '//str(c)//': '//trim(charge%start)//', '//str(cells_in_charge(deck, c))// &
                   ' cells in its radius, '//str(ceiling(reach/h))//' of '//str(h, 4)//' '//trim(labels%length)// &
                   ' to the radius '//str(reach, 5)//' '//trim(labels%length)//', '//line)
        end if
        if (charge%start_file /= '') call say('  kept in '//trim(charge%start_file)//', or taken from there')
      end associate
    end do
  end subroutine tell_starts

  !> Cost of each brick, for the share of the ranks: cells of the flow and particles that start there.
  function brick_weights(deck, mesh) result(weight)
    type(deck_type), intent(in) :: deck
    type(mesh_type), intent(in) :: mesh
    real(wp), allocatable :: weight(:)
    weight = planned_particles(deck, mesh)*seconds_per_particle_step
    if (deck%has_flow) weight = weight + product(mesh%brick_cells)*seconds_per_cell_step
    weight = weight + 1.0e-3_wp*product(mesh%brick_cells)*seconds_per_cell_step
  end function brick_weights

  !> Directions in the order in which cutting the domain in halves shares out the particles: the evenest last, which the curve of the
  !> bricks cuts first. Flow and solid take turns in a step, so each rank needs its part of both.
  function even_axes(deck, mesh) result(order)
    type(deck_type), intent(in) :: deck
    type(mesh_type), intent(in) :: mesh
    integer :: order(3)
    real(wp), allocatable :: count(:)
    real(wp) :: uneven(3)
    integer :: b, d
    allocate (count(size(mesh%brick)))
    count = planned_particles(deck, mesh)
    uneven = 0
    do d = 1, 3
      do b = 1, size(mesh%brick)
        uneven(d) = uneven(d) + count(b)*sign(1.0_wp, mesh%brick(b)%location(d) + 0.5_wp - 0.5_wp*mesh%bricks(d))
      end do
    end do
    uneven = merge(abs(uneven), huge(1.0_wp), mesh%active)
    order = [1, 2, 3]
    do d = 1, 2 ! insertion sort of three
      do b = 3, d + 1, -1
        if (uneven(order(b)) > uneven(order(b - 1))) order(b - 1:b) = order([b, b - 1])
      end do
    end do
  end function even_axes

  !> Particles that each brick will hold, from the boxes around the bodies.
  function planned_particles(deck, mesh) result(count)
    type(deck_type), intent(in) :: deck
    type(mesh_type), intent(in) :: mesh
    real(wp), allocatable :: count(:)
    real(wp) :: low(3), high(3), lower(3), upper(3), filled
    integer :: b, i
    allocate (count(size(mesh%brick)), source=0.0_wp)
    do i = 1, size(deck%body)
      associate (body => deck%body(i))
        filled = 1
        select case (trim(body%shape))
        case ('box')
          lower = body%lower
          upper = body%upper
        case ('sphere')
          lower = body%center - body%radius
          upper = body%center + body%radius
          filled = 0.52_wp
        case default
          lower = min(body%start, body%end) - body%radius*merge(0, 1, abs(body%start - body%end) > 0)
          upper = max(body%start, body%end) + body%radius*merge(0, 1, abs(body%start - body%end) > 0)
          filled = 0.79_wp
        end select
        do b = 1, size(mesh%brick)
          low = max(mesh%brick(b)%origin, lower)
          high = min(mesh%brick(b)%origin + mesh%brick_cells*mesh%spacing, upper)
          count(b) = count(b) + filled*product(max(merge((high - low)/body%spacing, 1.0_wp, mesh%active), 0.0_wp))
        end do
      end associate
    end do
  end function planned_particles

  !> Rows of the flow state; the exact figure comes with the layout.
  integer function flow_rows(deck)
    type(deck_type), intent(in) :: deck
    integer :: n
    n = count_flow_materials(deck)
    flow_rows = merge(6, 2*n + 6, n == 1)
  end function flow_rows

  integer function count_flow_materials(deck) result(n)
    type(deck_type), intent(in) :: deck
    integer :: i
    n = count([(flows(deck, i), i=1, size(deck%material))])
  end function count_flow_materials

  !> True for a material that a region or a charge is made of; solids can have an eos too.
  pure logical function flows(deck, i)
    type(deck_type), intent(in) :: deck
    integer, intent(in) :: i
    integer :: k
    flows = any([(find_material(deck, deck%region(k)%material) == i, k=1, size(deck%region))]) &
      .or. any([(find_material(deck, deck%charge(k)%explosive) == i, k=1, size(deck%charge))])
  end function flows

  function materials_text(deck) result(line)
    type(deck_type), intent(in) :: deck
    character(:), allocatable :: line
    integer :: i
    line = ''
    do i = 1, size(deck%material)
      if (.not. flows(deck, i)) cycle
      if (len(line) > 0) line = line//', '
      line = line//trim(deck%material(i)%name)//' ('//trim(deck%material(i)%eos)//')'
    end do
  end function materials_text

  !> The words of &flow that tell the scheme.
  function scheme_text(deck) result(line)
    type(deck_type), intent(in) :: deck
    character(:), allocatable :: line
    associate (flow => deck%flow)
      line = trim(flow%reconstruction)
      if (flow%reconstruction == 'muscl') line = line//' ('//trim(flow%limiter)//')'
      line = line//' + '//trim(flow%riemann)
      if (flow%interface /= 'diffuse') line = line//' + '//trim(flow%interface)
      if (flow%shocks /= 'plain') line = line//' + '//trim(flow%shocks)
    end associate
  end function scheme_text

  !> A time step from the sound speeds that the materials of the deck have at rest.
  real(wp) function estimated_step(scene) result(dt)
    type(scene_type), intent(in) :: scene
    real(wp) :: speed
    integer :: i
    dt = huge(1.0_wp)
    associate (deck => scene%deck, mesh => scene%mesh)
      do i = 1, size(deck%material)
        associate (m => deck%material(i))
          speed = 0
          if (len_trim(m%model) > 0 .and. m%density > 0 .and. m%youngs_modulus > 0) then
            speed = sqrt(m%youngs_modulus*(1 - m%poissons_ratio)/((1 + m%poissons_ratio)*(1 - 2*m%poissons_ratio)*m%density))
            dt = min(dt, deck%solid%cfl*minval(mesh%spacing, mesh%active)/speed)
          end if
        end associate
      end do
      do i = 1, size(deck%region)
        if (deck%region(i)%pressure > 0 .and. deck%region(i)%density > 0) then
          speed = sqrt(1.4_wp*deck%region(i)%pressure/deck%region(i)%density) + norm2(deck%region(i)%velocity)
          dt = min(dt, deck%flow%cfl/(mesh%dimensions*2*speed/minval(mesh%spacing, mesh%active)))
        end if
      end do
    end associate
    if (dt >= huge(1.0_wp)) dt = scene%deck%run%end_time/1000
  end function estimated_step

  function product_text(mesh, n) result(line)
    type(mesh_type), intent(in) :: mesh
    integer, intent(in) :: n(3)
    character(:), allocatable :: line
    integer :: d
    line = ''
    do d = 1, 3
      if (.not. mesh%active(d)) cycle
      if (len(line) > 0) line = line//' x '
      line = line//str(n(d))
    end do
  end function product_text

end module plan
