!> Contact of bodies that have velocity fields of their own: at nodes that two of them share, they may part freely, may not
!> approach where their surfaces meet, and rub by Coulomb's law (Bardenhagen, Guilkey et al. 2001).
!>
!> The normal is that of gradients of volume (Nairn 2013, Huang et al. 2011), the same for both with opposite signs, so what one
!> field gains the other loses, to round-off. Fields of which no contact was asked stick to each other, as if they were one. Pairs
!> are treated in the order of their fields; where more than two fields meet, several times.
module contact
  use blocks, only: block
  use contact_surfaces, only: reach_of
  use kinds, only: wp
  use mesh, only: mesh_type
  use solid_state, only: solid_type, contact_pair, contact_nodes, contact_open, contact_slip, contact_stick, &
    book_contact_impulse, book_contact_work, n_books, n_contact_books
  implicit none
  private
  public :: meet_fields, keep_contact, rub, friction_work

  !> Surfaces meet where they are nearer than this, in cells: what two particles per cell may hide of a surface on the nodes.
  real(wp), parameter :: closeness = 0.13_wp
  !> A body whose surface lies farther than this beyond a node, in cells, fills what the node sees: it has no surface there.
  real(wp), parameter :: filled = 0.85_wp
  integer, parameter :: sweeps = 4 !< over the pairs where more than two fields meet

contains

  !> Changes the velocities of the fields at the shared nodes of local brick b: variables first+1.. of velocity(field).
  !> meeting: its normals and states are set; change: gets the same changes; books: get this brick's part of impulses and work.
  pure subroutine meet_fields(mesh, solid, b, meeting, first, velocity, change, books)
    type(mesh_type), intent(in) :: mesh
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: b, first
    type(contact_nodes), intent(inout) :: meeting
    type(block), intent(inout) :: velocity(:)
    type(block), intent(inout), optional :: change(:)
    real(wp), intent(inout), optional :: books(:)
    real(wp), dimension(solid%n_fields) :: mass, volume
    real(wp) :: v(3, solid%n_fields), old(3, solid%n_fields), start(3, solid%n_fields)
    real(wp) :: surface(6, solid%n_fields), spacing(3)
    real(wp) :: booked(n_contact_books, size(solid%pair))
    integer :: n, field, p, at
    spacing = mesh%spacing
    if (solid%order == 2) spacing = sqrt(1.5_wp)*mesh%spacing ! splines are wider than linear functions
    do n = 1, size(meeting%share, 2)
      associate (node => meeting%node(:, n), share => meeting%share(:, n))
        do field = 1, solid%n_fields
          mass(field) = solid%node(field, b)%a(node(1), 1, node(2), node(3))
          v(:, field) = velocity(field)%a(node(1), first + 1:first + 3, node(2), node(3))
          surface(:, field) = solid%surface(field, b)%a(node(1), 1:6, node(2), node(3))
          volume(field) = solid%surface(field, b)%a(node(1), 7, node(2), node(3))
        end do
        old = v
        start = v
        if (present(change)) then
          do field = 1, solid%n_fields
            start(:, field) = v(:, field) - change(field)%a(node(1), :, node(2), node(3))
          end do
        end if
        call meet_at_node(solid%pair, spacing, mass, volume, surface, v, meeting%normal(:, :, n), meeting%state(:, n), booked)
        do field = 1, solid%n_fields
          if (.not. mass(field) > 0) cycle
          velocity(field)%a(node(1), first + 1:first + 3, node(2), node(3)) = v(:, field)
          if (present(change)) change(field)%a(node(1), :, node(2), node(3)) = change(field)%a(node(1), :, node(2), node(3)) &
            + (v(:, field) - old(:, field))
        end do
        if (.not. present(books)) cycle
        do p = 1, size(solid%pair)
          associate (pair => solid%pair(p)%field)
            if (meeting%state(p, n) == contact_open) cycle
            if (present(change)) booked(book_contact_work, p) = friction_work(booked(:3, p), meeting%normal(:, p, n), &
              start(:, pair(1)) - start(:, pair(2)), v(:, pair(1)) - v(:, pair(2)))
            at = n_books + n_contact_books*(p - 1)
            books(at + 1:at + n_contact_books) = books(at + 1:at + n_contact_books) &
              + sum(share(pair))/sum(volume(pair))*booked(:, p)
          end associate
        end do
      end associate
    end do
  end subroutine meet_fields

  !> All fields at one node. surface: gradient of volume (1..3) and first moment of volume about the node (4..6).
  pure subroutine meet_at_node(pairs, spacing, mass, volume, surface, v, normal, state, booked)
    type(contact_pair), intent(in) :: pairs(:)
    real(wp), intent(in) :: spacing(3), mass(:), volume(:), surface(:, :)
    real(wp), intent(inout) :: v(:, :)
    real(wp), intent(out) :: normal(:, :) !< (3, pair)
    integer, intent(out) :: state(:) !< by pair
    real(wp), intent(out) :: booked(:, :) !< (n_contact_books, pair)
    real(wp) :: impulse(3)
    logical :: near(size(pairs))
    integer :: p, sweep, now
    booked = 0
    normal = 0
    state = contact_open
    do p = 1, size(pairs)
      near(p) = all(mass(pairs(p)%field) > 0)
      if (near(p)) call look_between(spacing, volume(pairs(p)%field), surface(:, pairs(p)%field), normal(:, p), near(p))
    end do
    do sweep = 1, merge(sweeps, 1, count(mass > 0) > 2)
      do p = 1, size(pairs)
        if (.not. near(p)) cycle
        associate (a => pairs(p)%field(1), b => pairs(p)%field(2), to => booked(:, p))
          call rub(pairs(p)%friction, mass([a, b]), normal(:, p), v(:, a), v(:, b), impulse, now)
          if (now /= contact_open) state(p) = now
          to(book_contact_impulse:book_contact_impulse + 2) = to(book_contact_impulse:book_contact_impulse + 2) + impulse
        end associate
      end do
    end do
    if (size(mass) > 2) call stick(pairs, mass, v)
  end subroutine meet_at_node

  !> Brings velocities that were mapped again to what the contact of this step allows: no difference along the normal, and none at
  !> all where the fields stick. Whether they touch is not asked again: to take back what approaches only, and leave what parts,
  !> would compress the bodies.
  pure subroutine keep_contact(pairs, meeting, nodes, velocity)
    type(contact_pair), intent(in) :: pairs(:)
    type(contact_nodes), intent(in) :: meeting
    type(block), intent(in) :: nodes(:) !< by field: mass
    type(block), intent(inout) :: velocity(:) !< by field
    real(wp) :: mass(size(nodes)), v(3, size(nodes)), jump(3), part
    integer :: n, field, p, sweep
    do n = 1, size(meeting%share, 2)
      associate (node => meeting%node(:, n))
        do field = 1, size(nodes)
          mass(field) = nodes(field)%a(node(1), 1, node(2), node(3))
          v(:, field) = velocity(field)%a(node(1), :, node(2), node(3))
        end do
        do sweep = 1, merge(sweeps, 1, count(mass > 0) > 2)
          do p = 1, size(pairs)
            if (meeting%state(p, n) == contact_open) cycle
            associate (a => pairs(p)%field(1), b => pairs(p)%field(2), normal => meeting%normal(:, p, n))
              jump = v(:, a) - v(:, b)
              if (meeting%state(p, n) == contact_slip) jump = dot_product(jump, normal)*normal
              part = mass(b)/(mass(a) + mass(b))
              v(:, a) = v(:, a) - part*jump
              v(:, b) = v(:, b) + (1 - part)*jump
            end associate
          end do
        end do
        if (size(nodes) > 2) call stick(pairs, mass, v)
        do field = 1, size(nodes)
          if (mass(field) > 0) velocity(field)%a(node(1), :, node(2), node(3)) = v(:, field)
        end do
      end associate
    end do
  end subroutine keep_contact

  !> The normal between two fields, from the first to the second, and whether their surfaces meet along it: of the normals of the
  !> two and that of both together the one along which their surfaces lie farthest apart. So the corner of a block that slides
  !> on a plane has the normal of the plane.
  pure subroutine look_between(spacing, volume, surface, normal, meet)
    real(wp), intent(in) :: spacing(3), volume(2), surface(6, 2)
    real(wp), intent(out) :: normal(3)
    logical, intent(out) :: meet
    real(wp) :: candidate(3, 3), size, reach(2), rank, best, distance
    integer :: c
    candidate(:, 1) = surface(1:3, 1) - surface(1:3, 2)
    candidate(:, 2) = surface(1:3, 1)
    candidate(:, 3) = -surface(1:3, 2)
    best = -huge(1.0_wp)
    distance = 0
    normal = 0
    do c = 1, 3
      size = norm2(candidate(:, c))
      if (.not. size > 0) cycle
      candidate(:, c) = candidate(:, c)/size
      size = norm2(spacing*candidate(:, c))
      reach(1) = reach_of(dot_product(surface(4:6, 1), candidate(:, c))/(volume(1)*size))
      reach(2) = reach_of(-dot_product(surface(4:6, 2), candidate(:, c))/(volume(2)*size))
      rank = -sum(reach) - 2*count(reach > filled)
      if (rank > best + 1e-6_wp) then
        best = rank
        distance = -sum(reach)
        normal = candidate(:, c)
      end if
    end do
    meet = best > -huge(1.0_wp) .and. distance < closeness
  end subroutine look_between

  !> Two velocities that approach along the normal (from a to b) lose that part of their difference, and of the part across as much
  !> as friction may take. impulse: on a; state: contact_open, _slip or _stick.
  pure subroutine rub(friction, mass, normal, a, b, impulse, state)
    real(wp), intent(in) :: friction, mass(2), normal(3)
    real(wp), intent(inout) :: a(3), b(3)
    real(wp), intent(out) :: impulse(3)
    integer, intent(out) :: state
    real(wp) :: across(3), jump(3), approach, slip, kept
    impulse = 0
    state = contact_open
    approach = dot_product(a - b, normal)
    if (.not. approach > 0) return
    across = (a - b) - approach*normal
    slip = norm2(across)
    kept = 0
    state = contact_stick
    if (slip > friction*approach) then
      kept = 1 - friction*approach/slip
      state = contact_slip
    end if
    jump = approach*normal + (1 - kept)*across
    a = a - (mass(2)/(mass(1) + mass(2)))*jump
    b = b + (mass(1)/(mass(1) + mass(2)))*jump
    impulse = -mass(1)*(mass(2)/(mass(1) + mass(2)))*jump
  end subroutine rub

  !> What the motion of two fields loses to the part across the normal of an impulse, in a step that changes the difference of
  !> their velocities from start to finish: with the mean of the two, as the particles' velocities change by differences.
  pure real(wp) function friction_work(impulse, normal, start, finish) result(work)
    real(wp), intent(in) :: impulse(3), normal(3), start(3), finish(3)
    work = -0.5_wp*dot_product(impulse - dot_product(impulse, normal)*normal, start + finish)
  end function friction_work

  !> Fields that do not touch by any pair take their common velocity, and so do all that stick to one of them.
  pure subroutine stick(pairs, mass, v)
    type(contact_pair), intent(in) :: pairs(:)
    real(wp), intent(in) :: mass(:)
    real(wp), intent(inout) :: v(:, :)
    integer :: group(size(mass)), a, b, p, d, i
    logical :: together
    group = [(a, a=1, size(mass))]
    do a = 1, size(mass) - 1
      do b = a + 1, size(mass)
        if (.not. (mass(a) > 0 .and. mass(b) > 0)) cycle
        together = .true.
        do p = 1, size(pairs)
          together = together .and. .not. (all(pairs(p)%field == [a, b]) .or. all(pairs(p)%field == [b, a]))
        end do
        if (together) where (group == group(b)) group = group(a)
      end do
    end do
    do i = 1, size(mass)
      if (count(group == i .and. mass > 0) < 2) cycle
      do d = 1, 3
        where (group == i .and. mass > 0) v(d, :) = sum(mass*v(d, :), mask=group == i .and. mass > 0)/sum(mass, mask=group == i)
      end do
    end do
  end subroutine stick

end module contact
