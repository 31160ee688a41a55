!> Rigs of the deck: rows of its table, filling and checks.
module support_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark_idle, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use mesh_parameters, only: plate_t, edge_free, is_mirrored, symmetry_point
  use plate_deck, only: plate_group, key_length
  use roundings, only: rounding
  use support_parameters, only: support_t, max_supports, window_none, window_rectangle, window_circle, bearing_edge, &
                                bearing_face
  use text, only: to_text
  implicit none
  private
  public :: fill_supports, check_rigs, check_static_rigs

  !> Names that checks across groups use.
  character(len=*), parameter, public :: support_group = 'support', key_clamps = 'clamps', key_window = 'window', &
                                         key_unilateral = 'unilateral', &
                                         key_window_radius = 'radius'
  character(len=*), parameter :: group = support_group
  character(len=group_row_length), parameter, public :: support_group_row = &
    'support | several | A rig under a plate with free edges: a frame with a window, clamps at points, or both.'
  character(len=key_row_length), parameter, public :: support_rows(*) = [character(len=key_row_length) :: &
    'support | shape | choice | 1 | - | ''rectangle'' | rectangle circle | &
      &Shape of the frame''s window, which is centred on the plate.', &
    'support | window | real | 2 | length | none | > 0 | &
      &Lengths along x and y of a rectangular window; its edges become lines of the mesh. | shape = rectangle', &
    'support | radius | real | 1 | length | none | > 0 | &
      &Radius of a circular window. | shape = circle', &
    'support | unilateral | logical | 1 | - | .false. | .true. .false. | &
      &Whether the plate may lift off the frame, which then supports it by pressure only. | window or radius', &
    'support | bearing | choice | 1 | - | = face if unilateral, else edge | edge face | &
      &Where a frame supports the plate: at the edge of its window, as a simple support, or over its face. | &
      &window or radius', &
    'support | sides | choice | 1 | - | = as bearing | edge face | &
      &Bearing of the sides parallel to x of a rectangular window, if it differs from that of the ends. | &
      &shape = rectangle, window', &
    'support | clamps | real | 1 or more | length | none | any | &
      &Points from the plate''s centre, x and y in turn, at which clamps hold u, v and w, or with in_plane = free w.', &
    'support | clamp_stiffness | real | 1 | force/length | none | > 0 | &
      &Stiffness of each clamp along u, v and w; left out: clamps are rigid. | clamps', &
    'support | clamp_force | real | 1 | force | none | > 0 | &
      &Force of each clamp on the plate; a larger lifting force opens the clamp. Left out: no limit. | clamps']

contains

  !> All rigs, in the order of the deck.
  subroutine fill_supports(settings, supports)
    !> Keys in effect; receives the defaults of keys left out
    type(settings_t), intent(inout) :: settings
    type(support_t), allocatable, intent(out) :: supports(:)
    real(wp), allocatable :: clamps(:)
    integer :: place

    allocate (supports(settings%groups_named(group)))
    do place = 1, size(supports)
      associate (s => supports(place))
        if (settings%is_known(group, key_window, place)) s%window = settings%reals_of(group, key_window, place)
        s%radius = settings%real_of(group, key_window_radius, place)
        s%shape = code_of(settings%text_of(group, 'shape', place), 'rectangle circle', &
                          [window_rectangle, window_circle])
        if (.not. settings%is_given(group, trim(merge(key_window, key_window_radius, s%shape == window_rectangle)), &
                                    place)) s%shape = window_none
        s%unilateral = settings%logical_of(group, key_unilateral, place)
        if (.not. settings%is_given(group, 'bearing', place)) &
          call settings%derive(group, 'bearing', trim(merge('face', 'edge', s%unilateral)), .true., place)
        s%bearing = code_of(settings%text_of(group, 'bearing', place), 'edge face', [bearing_edge, bearing_face])
        if (.not. settings%is_given(group, 'sides', place)) &
          call settings%derive(group, 'sides', settings%text_of(group, 'bearing', place), .true., place)
        s%sides = code_of(settings%text_of(group, 'sides', place), 'edge face', [bearing_edge, bearing_face])
        s%clamp_stiffness = settings%real_of(group, 'clamp_stiffness', place)
        s%clamp_force = settings%real_of(group, 'clamp_force', place)
        clamps = settings%reals_of(group, key_clamps, place)
        if (size(clamps) > 1) s%clamps = reshape(clamps, [2, size(clamps)/2])
      end associate
    end do
  end subroutine fill_supports

  !> Checks each rig, and its fit to the plate.
  subroutine check_rigs(settings, plate, supports, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: supports(:)
    type(problems_t), intent(inout) :: problems
    integer :: place

    if (size(supports) > max_supports) call report(settings, problems, group, '', 'is one too many; allowed: up to '// &
                                                  to_text(max_supports)//'.', max_supports + 1)
    if (size(supports) > 0 .and. any(plate%edges /= edge_free) .and. &
        are_clear(settings, problems, plate_group, 'edges')) &
      call report(settings, problems, plate_group, 'edges', &
                  'a plate on a rig has free edges; allowed with &support: '// &
                '''free''.')
    do place = 1, size(supports)
      call check_parts(settings, supports(place), place, problems)
      if (.not. are_clear(settings, problems, plate_group, key_length)) cycle
      call check_window(settings, plate, supports(place), place, problems)
      call check_clamps(settings, plate, supports(place), place, problems)
      if (has_idle_clamps(supports(place), supports)) &
        call remark_idle(settings, problems, group, 'clamp_force', 'has no effect where a frame holds the plate; '// &
                         'with unilateral = .true. it may lift off.', place)
    end do
  end subroutine check_rigs

  !> True if clamps exert a force only where a bilateral frame supports the plate.
  pure logical function has_idle_clamps(clamped, supports)
    !> The rig with the clamps
    type(support_t), intent(in) :: clamped
    !> All rigs
    type(support_t), intent(in) :: supports(:)
    integer :: i, j

    has_idle_clamps = .false.
    if (.not. clamped%clamp_force > 0 .or. .not. allocated(clamped%clamps)) return
    do i = 1, size(supports)
      if (supports(i)%shape == window_none .or. supports(i)%unilateral .or. supports(i)%bearing == bearing_edge) cycle
      has_idle_clamps = has_idle_clamps .or. &
                        all([(supports(i)%beyond(clamped%clamps(:, j)) >= 0, j=1, size(clamped%clamps, 2))])
    end do
  end function has_idle_clamps

  !> Checks that a rig has a support, and no key without effect for its shape.
  subroutine check_parts(settings, support, place, problems)
    type(settings_t), intent(in) :: settings
    type(support_t), intent(in) :: support
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    logical :: circle

    circle = settings%text_of(group, 'shape', place) == 'circle'
    if (support%shape == window_none .and. settings%is_given(group, 'shape', place) .and. &
        are_clear(settings, problems, group, key_window//' '//key_window_radius//' shape', place)) then
      call report(settings, problems, group, trim(merge(key_window_radius, key_window, circle)), &
                'is missing; give it with this shape.', place)
    else if (support%shape == window_none .and. .not. allocated(support%clamps) .and. &
             are_clear(settings, problems, group, key_window//' '//key_window_radius//' clamps', place)) then
      call report(settings, problems, group, '', &
                  'supports nothing; give a window, a radius with shape = ''circle'', or '// &
                'clamps.', place)
    end if
    if (support%shape == window_circle .and. support%unilateral .and. support%bearing == bearing_edge .and. &
        are_clear(settings, problems, group, 'shape unilateral bearing', place)) &
      call report(settings, problems, group, 'bearing', &
                  'the plate can lift off an edge only along a line of the mesh, which '// &
                  'a circle is not; allowed with a circle and unilateral: ''face''.', place)
    if (support%clamp_stiffness > 0 .and. support%clamp_force > 0) &
      call report(settings, problems, group, 'clamp_force', 'says that clamps press, and clamp_stiffness that they '// &
                'are springs; give one of them.', place)
  end subroutine check_parts

  !> A window that the plate covers.
  subroutine check_window(settings, plate, support, place, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: support
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    if (support%shape == window_rectangle .and. any(support%window > plate%length)) then
      call report(settings, problems, group, key_window, 'is larger than the plate, which would not be supported; '// &
                'allowed: up to '//to_text(plate%length(1))//', '//to_text(plate%length(2))//'.', place)
    else if (support%shape == window_circle .and. 2*support%radius > minval(plate%length)) then
      call report(settings, problems, group, key_window_radius, 'is larger than half the plate''s width; allowed: '// &
                'up to '//to_text(minval(plate%length)/2)//'.', place)
    end if
  end subroutine check_window

  !> Clamps given in pairs of coordinates, on the plate.
  subroutine check_clamps(settings, plate, support, place, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: support
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. are_clear(settings, problems, group, key_clamps, place)) return
    if (modulo(size(settings%reals_of(group, key_clamps, place)), 2) == 1) then
      call report(settings, problems, group, key_clamps, &
                  'a coordinate is missing; allowed: x and y of each clamp in '// &
                'turn.', place)
    else if (allocated(support%clamps)) then
      if (any([(any(abs(support%clamps(:, i)) > plate%length/2), i=1, size(support%clamps, 2))])) &
        call report(settings, problems, group, key_clamps, 'a clamp lies off the plate; allowed: up to '// &
                  to_text(plate%length(1)/2)//', '//to_text(plate%length(2)/2)// &
                  ' in both directions from its centre.', place)
    end if
  end subroutine check_clamps

  !> Checks that rigs support the plate without inertia.
  subroutine check_static_rigs(settings, symmetry, lines_hold, supports, problems)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: symmetry
    !> True: lines prescribe a deflection or a slope
    logical, intent(in) :: lines_hold
    type(support_t), intent(in) :: supports(:)
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: points(:)
    integer :: place

    if (problems%concern(group)) return
    allocate (points(0))
    do place = 1, size(supports)
      if (allocated(supports(place)%clamps) .and. .not. supports(place)%clamp_force > 0) &
        points = [points, supports(place)%clamps]
    end do
    if (size(points) == 2) then
      call report(settings, problems, group, key_clamps, 'one clamp lets the plate turn in a static analysis; '// &
                'allowed: none, or two and more.')
    else if (any(supports%shape /= window_none)) then
      return
    else if (size(points) < 6) then
      call report(settings, problems, group, '', 'nothing holds the plate in a static analysis; give a window, or '// &
                'three clamps.')
    else if (.not. lines_hold .and. turns_about(reshape(points, [2, size(points)/2]), symmetry)) then
      call report(settings, problems, group, key_clamps, 'all clamps lie on one line, about which the plate turns '// &
                'in a static analysis; give one beside it, or a window.')
    end if
  end subroutine check_static_rigs

  !> True if points lie on one line, and symmetry lets the plate turn about it.
  pure logical function turns_about(points, symmetry)
    !> Coordinates from the plate's centre, (2, points)
    real(wp), intent(in) :: points(:, :)
    integer, intent(in) :: symmetry
    real(wp) :: arms(2, size(points, 2)), along(2)

    arms = points - spread(points(:, 1), 2, size(points, 2))
    along = arms(:, maxloc(norm2(arms, 1), dim=1))
    turns_about = all(abs(along(1)*arms(2, :) - along(2)*arms(1, :)) <= rounding*sum(along**2))
    ! The deflection of a rotation about this line is odd across it. A plate that is its own image by reflection across
    ! the line, or by a turn of 180 degrees, has no such motion.
    turns_about = turns_about .and. symmetry /= symmetry_point .and. &
                  all(.not. is_mirrored(symmetry) .or. abs([along(2), along(1)]) <= rounding*norm2(along))
  end function turns_about
end module support_deck
