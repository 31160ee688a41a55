!> Bonds between the laminate and its doublers that may delaminate: filling from the deck and checks.
module doubler_bonds
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use deck_settings, only: settings_t
  use delamination_parameters, only: delamination_t
  use interface_places, only: delamination_group, key_below_ply
  use kinds, only: wp
  use ply_zone_parameters, only: back_face, front_face
  use ply_zones, only: ply_zones_t
  use text, only: line_t, to_text
  use zone_deck, only: doubler_group, ply_drop_group
  implicit none
  private
  public :: check_bonds, is_bond, names_of_doublers, new_bond, weaker_beside

  !> Name of the key.
  character(len=*), parameter, public :: key_bond = 'doubler'
  character(len=*), parameter :: group = delamination_group, &
                                 unavailable = 'is not available for the bond of a doubler; leave it out.'

contains

  !> True for a group of the bond of doublers.
  pure logical function is_bond(settings, place)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: place

    is_bond = settings%is_given(group, key_bond, place)
  end function is_bond

  !> The bond of the doublers of a group, which receive that it is cohesive.
  subroutine new_bond(settings, place, plies, zones, bond)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: place
    !> Number of plies of the laminate
    integer, intent(in) :: plies
    !> Doublers of the plate
    type(ply_zones_t), intent(inout) :: zones
    !> Receives doublers and position
    type(delamination_t), intent(out) :: bond
    type(line_t), allocatable :: names(:)
    integer :: i, k

    names = settings%texts_of(group, key_bond, place)
    bond%group = place
    bond%below_ply = plies
    allocate (bond%doublers(size(names)), source=0)
    allocate (bond%beside(0))
    if (.not. allocated(zones%doublers)) return
    do i = 1, size(names)
      do k = 1, size(zones%doublers)
        if (zones%doublers(k)%name /= names(i)%text) cycle
        bond%doublers(i) = k
        if (zones%doublers(k)%face == front_face) then
          bond%beside = [bond%beside, plies + plies_of(zones, k)]
        else
          bond%beside = [bond%beside, plies + 1 + plies_of(zones, k - 1)]
        end if
        zones%doublers(k)%is_cohesive = .true.
        ! The first one decides; others on another face are refused.
        if (i == 1 .and. zones%doublers(k)%face == front_face) bond%below_ply = 0
      end do
    end do
  end subroutine new_bond

  !> Number of plies of the first doublers.
  pure integer function plies_of(zones, doublers) result(plies)
    type(ply_zones_t), intent(in) :: zones
    !> How many
    integer, intent(in) :: doublers
    integer :: i

    plies = 0
    do i = 1, doublers
      plies = plies + size(zones%doublers(i)%laminate%angle)
    end do
  end function plies_of

  !> Strengths of the weaker ply beside an interface.
  pure function weaker_beside(interface, strengths, of_doublers) result(weaker)
    !> The interface
    type(delamination_t), intent(in) :: interface
    !> Strengths YT and S12 of each ply of the laminate and of the doublers, 0 where not given, (2, plies)
    real(wp), intent(in) :: strengths(:, :), of_doublers(:, :)
    real(wp) :: weaker(2)
    integer :: above, i

    weaker = 0
    associate (plies => size(strengths, 2))
      if (plies == 0) return
      if (interface%bonds_doublers()) then
        weaker = strengths(:, merge(1, plies, interface%is_on_front()))
        do i = 1, size(interface%beside)
          if (interface%beside(i) - plies <= size(of_doublers, 2)) &
            weaker = min(weaker, of_doublers(:, interface%beside(i) - plies))
        end do
      else
        above = max(1, min(interface%below_ply, plies - 1))  ! one outside, which is refused: the nearest
        weaker = minval(strengths(:, above:min(above + 1, plies)), dim=2)
      end if
    end associate
  end function weaker_beside

  !> Checks which doublers are named, and that what their groups request is modelled.
  subroutine check_bonds(settings, zones, delaminations, problems)
    type(settings_t), intent(in) :: settings
    type(ply_zones_t), intent(in) :: zones
    type(delamination_t), intent(in) :: delaminations(:)
    type(problems_t), intent(inout) :: problems
    integer :: i, place
    logical :: known(2)

    do place = 1, settings%groups_named(group)
      if (.not. are_clear(settings, problems, group, key_below_ply//' '//key_bond, place)) cycle
      if (is_bond(settings, place) .and. settings%is_given(group, key_below_ply, place)) then
        call report(settings, problems, group, key_bond, 'the interface lies below a ply of the laminate or '// &
                    'between the laminate and a doubler; give below_ply or doubler, not both.', place)
      else if (.not. (is_bond(settings, place) .or. settings%is_given(group, key_below_ply, place))) then
        call report(settings, problems, group, key_below_ply, 'is missing; give it, or doubler.', place)
      end if
    end do
    known = .false.
    do i = 1, size(delaminations)
      if (.not. delaminations(i)%bonds_doublers()) cycle
      associate (face => merge(front_face, back_face, delaminations(i)%is_on_front()))
        if (known(face)) then
          call report(settings, problems, group, key_bond, 'the bond of doublers on the '// &
                      trim(merge('struck face', 'back       ', face == front_face))//' has been given before; '// &
                      'name all doublers of a face in one group.', delaminations(i)%group)
        else if (.not. (problems%concern(doubler_group) .or. problems%concern(ply_drop_group))) then
          call check_bond(settings, zones, delaminations(i), problems)
        end if
        known(face) = .true.
      end associate
    end do
  end subroutine check_bonds

  !> Checks one bond.
  subroutine check_bond(settings, zones, bond, problems)
    type(settings_t), intent(in) :: settings
    type(ply_zones_t), intent(in) :: zones
    !> The bond
    type(delamination_t), intent(in) :: bond
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: names(:)
    integer :: i

    names = settings%texts_of(group, key_bond, bond%group)
    do i = 1, size(bond%doublers)
      if (bond%doublers(i) == 0) then
        call refuse(key_bond, 'no &doubler is named '''//names(i)%text//''''//allowed_names(zones))
      else if (any(bond%doublers(:i - 1) == bond%doublers(i))) then
        call refuse(key_bond, 'doubler '''//names(i)%text//''' is named twice.')
      else if ((zones%doublers(bond%doublers(i))%face == front_face) .neqv. bond%is_on_front()) then
        call refuse(key_bond, 'doubler '''//names(i)%text//''' is on the other face than '''//names(1)%text// &
                    '''; give the doublers of each face a group of their own.')
      end if
    end do
    if (settings%text_of(group, 'law', bond%group) == 'front') &
      call refuse('law', 'the bond of a doubler is cohesive; allowed: law = ''cohesive''.')
    if (bond%cracks_as_flaws) call refuse('cracks_as_flaws', unavailable)
    if (bond%shear_cracks) call refuse('shear_cracks', unavailable)

  contains

    !> Reports a key that has no other problem.
    subroutine refuse(key, sentence)
      !> The key, and what to say
      character(len=*), intent(in) :: key, sentence

      if (are_clear(settings, problems, group, key, bond%group)) &
        call report(settings, problems, group, key, sentence, bond%group)
    end subroutine refuse
  end subroutine check_bond

  !> Names of the doublers of a bond, separated by commas.
  pure function names_of_doublers(zones, bond) result(names)
    type(ply_zones_t), intent(in) :: zones
    !> The bond
    type(delamination_t), intent(in) :: bond
    character(len=:), allocatable :: names
    integer :: i

    names = ''
    do i = 1, size(bond%doublers)
      names = names//', '//zones%doublers(bond%doublers(i))%name
    end do
    names = names(3:)
  end function names_of_doublers

  !> Names of all doublers as the end of a sentence.
  pure function allowed_names(zones) result(ending)
    type(ply_zones_t), intent(in) :: zones
    character(len=:), allocatable :: ending
    integer :: i

    ending = '; the deck has no &doubler.'
    if (.not. allocated(zones%doublers)) return
    ending = ''
    do i = 1, size(zones%doublers)
      ending = ending//', '''//zones%doublers(i)%name//''''
    end do
    ending = '; allowed: '//ending(3:)//'.'
  end function allowed_names
end module doubler_bonds
