!> Checks of doublers and ply drops with other groups: interfaces, frames, patch and symmetry, and their comparison with
!> those of another deck.
module deck_zones
  use deck_comparisons, only: both, differ, list_objection, material_objection, short_list
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark, report
  use kinds, only: wp
  use ply_stacks, only: ply_stack_t
  use ply_zone_parameters, only: back_face, doubler_t, ply_drop_t, ply_zone_t
  use roundings, only: rounding
  use support_parameters, only: window_rectangle, window_circle
  use text, only: to_text
  use zone_deck, only: doubler_group, key_plies, key_zone_at, key_zone_size, ply_drop_group
  implicit none
  private
  public :: check_zones_across_groups, zone_objection, zones_are_symmetric

contains

  !> All checks of combinations of groups.
  subroutine check_zones_across_groups(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (allocated(deck%setup%zones%doublers)) then
      do i = 1, size(deck%setup%zones%doublers)
        call check_window(deck, deck%setup%zones%doublers(i), doubler_group, i, problems)
        call remark_patch(deck, deck%setup%zones%doublers(i), doubler_group, i, problems)
      end do
    end if
    if (allocated(deck%setup%zones%drops)) then
      do i = 1, size(deck%setup%zones%drops)
        ! Frames lie on the back.
        if (deck%setup%zones%drops(i)%flat_face /= back_face) &
          call check_window(deck, deck%setup%zones%drops(i), ply_drop_group, i, problems)
        call remark_patch(deck, deck%setup%zones%drops(i), ply_drop_group, i, problems)
        call check_interfaces(deck, i, problems)
      end do
    end if
  end subroutine check_zones_across_groups

  !> Refuses a zone that reaches beyond the window of a frame, which touches the laminate itself.
  subroutine check_window(deck, zone, group, place, problems)
    type(deck_t), intent(in) :: deck
    class(ply_zone_t), intent(in) :: zone
    !> Its group, and index among the groups of this name
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    real(wp) :: reach(2)
    integer :: i

    reach = (abs(zone%at) + zone%size/2)*(1 - rounding)
    do i = 1, size(deck%setup%supports)
      associate (support => deck%setup%supports(i))
        if (support%shape == window_rectangle .and. any(reach > support%window/2)) then
          call report(deck%settings, problems, group, key_zone_size, 'it reaches beyond the window of the frame, '// &
                      'which would cut it; allowed: within '//short_list(support%window)//'.', place)
        else if (support%shape == window_circle .and. norm2(reach) > support%radius) then
          call report(deck%settings, problems, group, key_zone_size, 'it reaches beyond the window of the frame, '// &
                      'which would cut it; allowed: within a circle of radius '//to_text(support%radius)//'.', place)
        end if
      end associate
    end do
  end subroutine check_window

  !> Warns of a patch that lies across the edge of a zone.
  subroutine remark_patch(deck, zone, group, place, problems)
    type(deck_t), intent(in) :: deck
    class(ply_zone_t), intent(in) :: zone
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    type(ply_zone_t) :: patch, inner

    if (.not. (deck%setup%impactor%is_present .and. deck%setup%mesh%patch > 0)) return
    patch%at = deck%setup%mesh%struck
    patch%size = deck%setup%mesh%patch
    inner%at = zone%at
    inner%size = zone%size - 2*deck%setup%mesh%patch
    if (.not. zone%overlaps(patch, rounding*maxval(deck%setup%plate%length))) return
    if (all(abs(patch%at - zone%at) <= inner%size/2 + patch%size/2 + rounding*zone%size)) return
    call remark(deck%settings, problems, group, key_zone_at, 'its edge lies under the impactor; the step of the '// &
                'surface there has no effect on the contact.', place)
  end subroutine remark_patch

  !> Refuses interfaces that a ply drop moves or interrupts.
  subroutine check_interfaces(deck, place, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the drop
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    logical, allocatable :: here(:)
    type(ply_stack_t) :: whole, rest
    integer :: i

    if (problems%errors() > 0 .or. size(deck%setup%delaminations) == 0) return
    here = deck%setup%zones%at([huge(1.0_wp), huge(1.0_wp)])
    whole = deck%setup%zones%stack(deck%setup%laminate, deck%setup%materials, here)
    here(size(here) - size(deck%setup%zones%drops) + place) = .true.
    rest = deck%setup%zones%stack(deck%setup%laminate, deck%setup%materials, here)
    do i = 1, size(deck%setup%delaminations)
      associate (below => deck%setup%delaminations(i)%below_ply)
        if (below < 1 .or. below >= size(whole%plies)) cycle
        if (rest%has(below) .and. rest%has(below + 1)) then
          if (abs(whole%plies(below)%z_bottom - rest%plies(rest%place(below))%z_bottom) <= &
              rounding*sum(deck%setup%laminate%thickness)) cycle
        end if
        call report(deck%settings, problems, ply_drop_group, key_plies, 'the interface below ply '// &
                    to_text(below)//' of &delamination ends or changes its height there, which is not modelled; '// &
                    'allowed: interfaces between plies that are not missing, on the side of the flat face.', place)
        return
      end associate
    end do
  end subroutine check_interfaces

  !> True if the image of each zone is a zone with the same plies.
  pure logical function zones_are_symmetric(deck, signs) result(alike)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: signs(2)
    real(wp) :: distance
    integer :: i, k

    alike = .true.
    distance = rounding*maxval(deck%setup%plate%length)
    associate (zones => deck%setup%zones)
      if (allocated(zones%doublers)) then
        do i = 1, size(zones%doublers)
          alike = alike .and. any([(zones%doublers(i)%is_image_of(zones%doublers(k), signs, distance) .and. &
                                    have_same_plies(zones%doublers(i), zones%doublers(k)), k=1, size(zones%doublers))])
        end do
      end if
      if (allocated(zones%drops)) then
        do i = 1, size(zones%drops)
          alike = alike .and. any([(zones%drops(i)%is_image_of(zones%drops(k), signs, distance) .and. &
                                    have_same_drops(zones%drops(i), zones%drops(k)), k=1, size(zones%drops))])
        end do
      end if
    end associate
  end function zones_are_symmetric

  !> True if two doublers have the same plies on the same face, both bonded rigidly or both by an interface.
  pure logical function have_same_plies(a, b) result(same)
    !> The doublers
    type(doubler_t), intent(in) :: a, b

    same = a%face == b%face .and. (a%is_cohesive .eqv. b%is_cohesive) .and. &
           size(a%laminate%angle) == size(b%laminate%angle)
    if (same) same = all(a%laminate%material == b%laminate%material) .and. &
                     .not. any(differ(a%laminate%angle, b%laminate%angle)) .and. &
                     .not. any(differ(a%laminate%thickness, b%laminate%thickness))
  end function have_same_plies

  !> True if the same plies are missing.
  pure logical function have_same_drops(a, b) result(same)
    !> The drops
    type(ply_drop_t), intent(in) :: a, b

    same = a%flat_face == b%flat_face .and. size(a%plies) == size(b%plies)
    if (same) same = all(a%plies == b%plies)
  end function have_same_drops

  !> First difference of the zones of two decks.
  function zone_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection
    integer :: i

    objection = ''
    if (zone_count(deck, 1) /= zone_count(old, 1)) then
      objection = both('number of doublers', to_text(zone_count(deck, 1)), to_text(zone_count(old, 1)))
    else if (zone_count(deck, 2) /= zone_count(old, 2)) then
      objection = both('number of ply drops', to_text(zone_count(deck, 2)), to_text(zone_count(old, 2)))
    end if
    do i = 1, zone_count(deck, 1)
      if (objection /= '') return
      associate (mine => deck%setup%zones%doublers(i), its => old%setup%zones%doublers(i))
        objection = place_objection('&doubler '''//mine%name//'''', mine, its, deck%setup%initial%cut_at)
        if (objection == '') objection = plies_objection(deck, old, i)
      end associate
    end do
    do i = 1, zone_count(deck, 2)
      if (objection /= '') return
      associate (mine => deck%setup%zones%drops(i), its => old%setup%zones%drops(i))
        objection = place_objection('&ply_drop '//to_text(i), mine, its, deck%setup%initial%cut_at)
        if (objection == '' .and. .not. have_same_drops(mine, its)) &
          objection = both('plies of &ply_drop '//to_text(i), short_list(real(mine%plies, wp)), &
                           short_list(real(its%plies, wp)))
      end associate
    end do
  end function zone_objection

  !> Number of doublers (1) or of ply drops (2).
  pure integer function zone_count(deck, kind) result(number)
    type(deck_t), intent(in) :: deck
    !> 1 or 2
    integer, intent(in) :: kind

    number = 0
    if (kind == 1 .and. allocated(deck%setup%zones%doublers)) number = size(deck%setup%zones%doublers)
    if (kind == 2 .and. allocated(deck%setup%zones%drops)) number = size(deck%setup%zones%drops)
  end function zone_count

  !> Difference of the places of a zone in two decks.
  function place_objection(name, mine, its, cut_at) result(objection)
    !> Of the zone
    character(len=*), intent(in) :: name
    !> That of the deck, and that of the other run
    class(ply_zone_t), intent(in) :: mine, its
    !> Centre of the deck's plate on that of the other run
    real(wp), intent(in) :: cut_at(2)
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection

    objection = ''
    if (any(differ(mine%at + cut_at, its%at))) then
      objection = both('centre of '//name, short_list(mine%at + cut_at), short_list(its%at))
    else if (any(differ(mine%size, its%size))) then
      objection = both('size of '//name, short_list(mine%size), short_list(its%size))
    end if
  end function place_objection

  !> First difference of the plies of a doubler in two decks.
  function plies_objection(deck, old, i) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> The doubler
    integer, intent(in) :: i
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection

    objection = ''
    associate (mine => deck%setup%zones%doublers(i), its => old%setup%zones%doublers(i))
      if (mine%is_cohesive .neqv. its%is_cohesive) then
        objection = both('bond of &doubler '''//mine%name//'''', &
                         trim(merge('cohesive', 'rigid   ', mine%is_cohesive)), &
                         trim(merge('cohesive', 'rigid   ', its%is_cohesive)))
      else if (mine%face /= its%face) then
        objection = both('face of &doubler '''//mine%name//'''', &
                         trim(merge('''back'' ', '''front''', mine%face == back_face)), &
                         trim(merge('''back'' ', '''front''', its%face == back_face)))
      end if
      if (objection == '') objection = list_objection('plies of &doubler '''//mine%name//'''', mine%laminate%angle, &
                                                      its%laminate%angle)
      if (objection == '') objection = list_objection('ply_thickness of &doubler '''//mine%name//'''', &
                                                      mine%laminate%thickness(:1), its%laminate%thickness(:1))
      if (objection == '') objection = material_objection(deck, old, mine%laminate%material, its%laminate%material, &
                                                          '&doubler '''//mine%name//'''')
    end associate
  end function plies_objection

  !> Name of a bond.
  pure function bond_name(doubler) result(name)
    type(doubler_t), intent(in) :: doubler
    character(len=:), allocatable :: name

    name = trim(merge('cohesive', 'rigid   ', doubler%is_cohesive))
  end function bond_name

  !> Name of a face.
  pure function face_name(face) result(name)
    !> front_face or back_face
    integer, intent(in) :: face
    !> As the deck has it
    character(len=:), allocatable :: name

    name = ''''//trim(merge('back ', 'front', face == back_face))//''''
  end function face_name
end module deck_zones
