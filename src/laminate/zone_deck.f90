!> Doublers and ply drops of the deck: rows of their tables, filling and checks.
module zone_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use laminate_deck, only: find_material, key_bending_error, laminate_group
  use laminate_parameters, only: laminate_t
  use material_parameters, only: material_t
  use ply_zone_parameters, only: back_face, doubler_t, front_face, ply_drop_t, ply_zone_t
  use ply_zones, only: ply_zones_t
  use roundings, only: rounding
  use stacking_sequences, only: read_sequence
  use text, only: line_t, to_text
  implicit none
  private
  public :: check_zones, fill_zones

  !> Names that checks across groups use.
  character(len=*), parameter, public :: doubler_group = 'doubler', ply_drop_group = 'ply_drop', &
                                         key_zone_at = 'at', key_zone_size = 'size', key_plies = 'plies'
  character(len=*), parameter :: key_name = 'name', key_face = 'face', key_materials = 'materials', &
                                 key_stacking = 'stacking', key_ply_thickness = 'ply_thickness', &
                                 key_flat_face = 'flat_face'
  character(len=group_row_length), parameter, public :: zone_group_rows(2) = [character(len=group_row_length) :: &
    'doubler | several | Plies bonded to a face of the laminate in a rectangle or a band of the plate.', &
    'ply_drop | several | Plies of the laminate that are missing in a rectangle or a band of the plate.']
  character(len=key_row_length), parameter, public :: zone_rows(*) = [character(len=key_row_length) :: &
    'doubler | name | text | 1 | - | required | not empty | &
      &Name of the doubler in messages and tables.', &
    'doubler | face | choice | 1 | - | ''back'' | front back | &
      &Face of the laminate it is bonded to: the struck one (front) or the opposite one (back).', &
    'doubler | at | real | 2 | length | required | any | &
      &Its centre from the plate''s centre, x and y.', &
    'doubler | size | real | 2 | length | required | > 0 | &
      &Its lengths along x and y; as long as the plate makes a band.', &
    'doubler | materials | text | 1 or more | - | required | names of &material groups | &
      &Material of each of its plies; one value serves all.', &
    'doubler | stacking | text | 1 | - | required | not empty | &
      &Its plies from the struck face towards the back, as in [45/0/-45/90]s.', &
    'doubler | ply_thickness | real | 1 | length | required | > 0 | &
      &Thickness of each of its plies.', &
    'ply_drop | plies | integer | 1 or more | - | required | >= 1, <= 1000 | &
      &Numbers of the missing plies.', &
    'ply_drop | at | real | 2 | length | required | any | &
      &Centre of the rectangle from the plate''s centre, x and y.', &
    'ply_drop | size | real | 2 | length | required | > 0 | &
      &Lengths of the rectangle along x and y; as long as the plate makes a band.', &
    'ply_drop | flat_face | choice | 1 | - | ''front'' | front back | &
      &Face of the laminate that stays flat; plies beyond the missing ones move towards it.']

contains

  !> All doublers and ply drops. Invalid lists of plies remain unallocated.
  subroutine fill_zones(settings, materials, zones, problems)
    type(settings_t), intent(in) :: settings
    type(material_t), intent(in) :: materials(:)
    type(ply_zones_t), intent(inout) :: zones
    type(problems_t), intent(inout) :: problems
    integer :: place

    if (settings%has_group(doubler_group)) then
      allocate (zones%doublers(settings%groups_named(doubler_group)))
      do place = 1, size(zones%doublers)
        call fill_doubler(settings, materials, place, zones%doublers(place), problems)
      end do
    end if
    if (settings%has_group(ply_drop_group)) then
      allocate (zones%drops(settings%groups_named(ply_drop_group)))
      do place = 1, size(zones%drops)
        associate (drop => zones%drops(place))
          call fill_rectangle(settings, ply_drop_group, place, drop%at, drop%size)
          drop%plies = settings%integers_of(ply_drop_group, key_plies, place)
          drop%flat_face = face_named(settings, ply_drop_group, key_flat_face, place)
        end associate
      end do
    end if
  end subroutine fill_zones

  !> Centre and sides of a zone.
  subroutine fill_rectangle(settings, group, place, at, sides)
    type(settings_t), intent(in) :: settings
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    !> Receive them
    real(wp), intent(inout) :: at(2), sides(2)

    if (settings%is_known(group, key_zone_at, place)) at = settings%reals_of(group, key_zone_at, place)
    if (settings%is_known(group, key_zone_size, place)) sides = settings%reals_of(group, key_zone_size, place)
  end subroutine fill_rectangle

  !> A face of the laminate.
  integer function face_named(settings, group, key, place) result(face)
    type(settings_t), intent(in) :: settings
    !> Group and key
    character(len=*), intent(in) :: group, key
    integer, intent(in) :: place

    face = code_of(settings%text_of(group, key, place), 'front back', [front_face, back_face])
  end function face_named

  !> One doubler.
  subroutine fill_doubler(settings, materials, place, doubler, problems)
    type(settings_t), intent(in) :: settings
    type(material_t), intent(in) :: materials(:)
    integer, intent(in) :: place
    type(doubler_t), intent(inout) :: doubler
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: fault
    type(line_t), allocatable :: names(:)
    integer, allocatable :: indices(:)
    integer :: i

    doubler%name = trim(settings%text_of(doubler_group, key_name, place))
    doubler%face = face_named(settings, doubler_group, key_face, place)
    call fill_rectangle(settings, doubler_group, place, doubler%at, doubler%size)
    allocate (doubler%laminate%angle(0), doubler%laminate%thickness(0), doubler%laminate%material(0))
    doubler%laminate%bending_error = settings%real_of(laminate_group, key_bending_error)
    if (.not. settings%is_known(doubler_group, key_stacking, place)) return
    associate (laminate => doubler%laminate)
      call read_sequence(settings%text_of(doubler_group, key_stacking, place), laminate%angle, fault)
      if (fault /= '') then
        call report(settings, problems, doubler_group, key_stacking, fault//'.', place)
        laminate%angle = [real(wp) ::]
        return
      end if
      laminate%thickness = spread(settings%real_of(doubler_group, key_ply_thickness, place), 1, size(laminate%angle))
    end associate
    names = settings%texts_of(doubler_group, key_materials, place)
    allocate (indices(size(names)))
    do i = 1, size(names)
      call find_material(settings, materials, trim(names(i)%text), problems, indices(i), doubler_group, place)
    end do
    if (any(indices == 0) .or. size(indices) == 0) return
    if (size(indices) > 1 .and. size(indices) /= size(doubler%laminate%angle)) then
      call report(settings, problems, doubler_group, key_materials, to_text(size(indices))//' values, but '// &
                  'stacking has '//to_text(size(doubler%laminate%angle))//' plies; allowed: 1 value for all plies '// &
                  'or 1 per ply.', place)
      return
    end if
    doubler%laminate%material = [(indices(min(i, size(indices))), i=1, size(doubler%laminate%angle))]
  end subroutine fill_doubler

  !> Checks of the zones and their plies.
  subroutine check_zones(settings, zones, plies, length, problems)
    type(settings_t), intent(in) :: settings
    type(ply_zones_t), intent(in) :: zones
    !> Number of plies of the plate's laminate; 0: not known
    integer, intent(in) :: plies
    real(wp), intent(in) :: length(2)
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. all(length > 0)) return
    if (allocated(zones%doublers)) then
      do i = 1, size(zones%doublers)
        call check_rectangle(settings, doubler_group, i, zones%doublers(i), length, problems)
      end do
      call check_doublers(settings, zones%doublers, length, problems)
    end if
    if (allocated(zones%drops)) then
      do i = 1, size(zones%drops)
        call check_rectangle(settings, ply_drop_group, i, zones%drops(i), length, problems)
      end do
      call check_drops(settings, zones%drops, plies, length, problems)
    end if
  end subroutine check_zones

  !> Refuses zones that reach beyond the plate.
  subroutine check_rectangle(settings, group, place, zone, length, problems)
    type(settings_t), intent(in) :: settings
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    class(ply_zone_t), intent(in) :: zone
    real(wp), intent(in) :: length(2)
    type(problems_t), intent(inout) :: problems
    integer :: direction

    if (.not. are_clear(settings, problems, group, key_zone_at//' '//key_zone_size, place)) return
    do direction = 1, 2
      associate (edges => zone%edges(direction), half => length(direction)/2)
        if (any(abs(edges) > half*(1 + rounding))) then
          call report(settings, problems, group, key_zone_size, 'it reaches from '//to_text(edges(1))//' to '// &
                      to_text(edges(2))//' along '//merge('x', 'y', direction == 1)//', beyond the plate; allowed: '// &
                      to_text(-half)//' to '//to_text(half)//'.', place)
          return
        end if
      end associate
    end do
  end subroutine check_rectangle

  !> Refuses equal names, and doublers on top of each other.
  subroutine check_doublers(settings, doublers, length, problems)
    type(settings_t), intent(in) :: settings
    type(doubler_t), intent(in) :: doublers(:)
    real(wp), intent(in) :: length(2)
    type(problems_t), intent(inout) :: problems
    integer :: i, j

    do i = 2, size(doublers)
      do j = 1, i - 1
        if (doublers(i)%name == doublers(j)%name .and. doublers(i)%name /= '') &
          call report(settings, problems, doubler_group, key_name, &
                      'another doubler has this name; give each its own.', i)
        if (doublers(i)%face /= doublers(j)%face) cycle
        if (.not. doublers(i)%overlaps(doublers(j), rounding*maxval(length))) cycle
        call report(settings, problems, doubler_group, key_zone_at, 'it overlaps doubler '''//doublers(j)%name// &
                    ''' on the same face; allowed: side by side, or one doubler with all plies where they overlap.', i)
        exit
      end do
    end do
  end subroutine check_doublers

  !> Refuses drops of plies that do not exist, and drops after which no ply is left or the flat face is not defined.
  subroutine check_drops(settings, drops, plies, length, problems)
    type(settings_t), intent(in) :: settings
    type(ply_drop_t), intent(in) :: drops(:)
    !> Number of plies of the plate's laminate; 0: not known
    integer, intent(in) :: plies
    real(wp), intent(in) :: length(2)
    type(problems_t), intent(inout) :: problems
    logical :: missing(plies)
    integer :: i, j

    if (plies == 0 .or. problems%concern(ply_drop_group)) return
    do i = 1, size(drops)
      if (any(drops(i)%plies > plies)) then
        call report(settings, problems, ply_drop_group, key_plies, 'the laminate has no ply '// &
                    to_text(maxval(drops(i)%plies))//'; allowed: 1 to '//to_text(plies)//'.', i)
        return
      end if
      missing = .false.
      do j = 1, size(drops)
        if (.not. drops(i)%overlaps(drops(j), rounding*maxval(length))) cycle
        missing(drops(j)%plies) = .true.
        if (j < i .and. drops(i)%flat_face /= drops(j)%flat_face) &
          call report(settings, problems, ply_drop_group, key_flat_face, 'it overlaps another &ply_drop with the '// &
                      'other flat face; give both the same.', i)
      end do
      if (all(missing)) call report(settings, problems, ply_drop_group, key_plies, &
                                    'no ply of the laminate would be left; leave at least one.', i)
    end do
  end subroutine check_drops
end module zone_deck
