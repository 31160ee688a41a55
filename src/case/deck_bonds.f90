!> Checks of the bonds of doublers that may delaminate with ply drops and stringers.
module deck_bonds
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report
  use delamination_deck, only: key_starter, key_strip
  use delamination_parameters, only: delamination_t
  use interface_places, only: delamination_group
  use kinds, only: wp
  use ply_zone_parameters, only: doubler_t, front_face, ply_zone_t
  use roundings, only: rounding
  use stringer_deck, only: stringer_group
  use stringers, only: face_front, stringer_t
  use zone_deck, only: key_plies, ply_drop_group
  implicit none
  private
  public :: check_bonds_across_groups

contains

  !> Refuses ply drops that move the face at a bond, and stringers of which only a part lies on a doubler that may come
  !> off.
  subroutine check_bonds_across_groups(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i, k

    if (.not. allocated(deck%setup%zones%doublers)) return
    do i = 1, size(deck%setup%delaminations)
      if (deck%setup%delaminations(i)%bonds_doublers()) call check_starter(deck, deck%setup%delaminations(i), problems)
    end do
    do i = 1, size(deck%setup%zones%doublers)
      associate (doubler => deck%setup%zones%doublers(i))
        if (.not. doubler%is_cohesive) cycle
        call check_drops(deck, doubler, problems)
        do k = 1, size(deck%setup%stringers)
          if (ends_on(deck%setup%stringers(k), doubler, rounding*maxval(deck%setup%plate%length))) &
            call report(deck%settings, problems, stringer_group, '', 'it crosses or follows an edge of doubler '''// &
                        doubler%name//''', whose bond may delaminate; allowed: on this doubler from end to end and '// &
                        'off its edges, or beside it.', k)
        end do
      end associate
    end do
  end subroutine check_bonds_across_groups

  !> Refuses a starter beside the doublers, which would have no effect.
  subroutine check_starter(deck, bond, problems)
    type(deck_t), intent(in) :: deck
    !> The bond
    type(delamination_t), intent(in) :: bond
    type(problems_t), intent(inout) :: problems
    type(ply_zone_t) :: starter
    character(len=:), allocatable :: key
    integer :: i

    if (any(bond%doublers == 0) .or. .not. (bond%starter > 0 .or. bond%has_strip())) return
    starter%at = deck%setup%mesh%struck + bond%starter_at
    starter%size = bond%starter
    key = key_starter
    if (bond%has_strip()) then
      key = key_strip
      starter%at(1) = deck%setup%mesh%struck(1) + sum(bond%starter_strip)/2
      starter%size = [bond%starter_strip(2) - bond%starter_strip(1), 2*deck%setup%plate%length(2)]
    end if
    if (any([(starter%overlaps(deck%setup%zones%doublers(bond%doublers(i)), 0.0_wp), i=1, size(bond%doublers))])) return
    call report(deck%settings, problems, delamination_group, key, 'the starter lies beside the doublers; allowed: '// &
                'within one of them.', bond%group)
  end subroutine check_starter

  !> Refuses ply drops that move the face of the laminate at a bond.
  subroutine check_drops(deck, doubler, problems)
    type(deck_t), intent(in) :: deck
    type(doubler_t), intent(in) :: doubler
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. allocated(deck%setup%zones%drops)) return
    do i = 1, size(deck%setup%zones%drops)
      associate (drop => deck%setup%zones%drops(i))
        if (drop%flat_face == doubler%face) cycle
        if (.not. drop%overlaps(doubler, rounding*maxval(deck%setup%plate%length))) cycle
        call report(deck%settings, problems, ply_drop_group, key_plies, 'the bond of doubler '''//doubler%name// &
                    ''', which may delaminate, changes its height there; allowed: flat_face = '''// &
                    trim(merge('front', 'back ', doubler%face == front_face))//''', or not below this doubler.', i)
      end associate
    end do
  end subroutine check_drops

  !> True for a stringer of which only a part lies on a doubler, or that follows its edge.
  pure logical function ends_on(stringer, doubler, distance)
    type(stringer_t), intent(in) :: stringer
    type(doubler_t), intent(in) :: doubler
    !> Distance that is round-off
    real(wp), intent(in) :: distance
    real(wp) :: along(2), across(2)
    logical :: is_inside

    along = doubler%edges(stringer%along)
    across = doubler%edges(3 - stringer%along)
    ends_on = .false.
    if ((stringer%face == face_front) .neqv. (doubler%face == front_face)) return
    if (stringer%ends(2) <= along(1) + distance .or. stringer%ends(1) >= along(2) - distance) return
    if (stringer%at < across(1) - distance .or. stringer%at > across(2) + distance) return
    is_inside = stringer%at > across(1) + distance .and. stringer%at < across(2) - distance
    ends_on = .not. (is_inside .and. stringer%ends(1) >= along(1) - distance .and. &
                     stringer%ends(2) <= along(2) + distance)
  end function ends_on
end module deck_bonds
