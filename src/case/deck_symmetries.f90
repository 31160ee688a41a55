!> Symmetries of the case: those of laminate, edges, rigs, struck point and interfaces.
module deck_symmetries
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_zones, only: zones_are_symmetric
  use deck_remarks, only: report, are_clear
  use delamination_deck, only: key_starter_at, key_strip
  use delamination_parameters, only: law_front
  use impactor_deck, only: impactor_group, key_at
  use interface_places, only: delamination_group
  use kinds, only: wp
  use line_deck, only: line_group
  use line_loads, only: along_x
  use laminate_parameters, only: shear_five_sixths
  use mesh_parameters, only: has_symmetric_imperfection, is_halved, is_mirrored, same_place, symmetry_half_x, &
                             symmetry_half_y, symmetry_none, symmetry_point, &
                             symmetry_quarter
  use plate_deck, only: plate_group, key_symmetry
  use plies, only: ply_t, material_objection
  use ply_damage_deck, only: key_seed, ply_damage_group
  use ply_stacks, only: ply_stack_t
  use stacking, only: stacked_plies, section_stiffness
  use support_deck, only: support_group, key_clamps
  use stringer_deck, only: key_stringer_at, stringer_group
  use stringers, only: have_images
  use text, only: lower_case
  use zone_deck, only: doubler_group, key_zone_at, ply_drop_group
  implicit none
  private
  public :: check_symmetry, note_symmetry, symmetry_sentence

  !> Tolerance of zero coupling stiffness, relative to the stiffness it couples: round-off of plies whose couplings
  !> cancel is 1e-16, and one degree in one of a hundred plies gives 1e-4.
  real(wp), parameter :: no_coupling = 1.0e-9_wp

contains

  !> Refuses a symmetry that the deck does not have.
  subroutine check_symmetry(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: name, part

    if (deck%setup%plate%symmetry == symmetry_none) return
    name = ''''//lower_case(deck%settings%text_of(plate_group, key_symmetry))//''''
    part = trim(merge('quarter', 'half   ', deck%setup%plate%symmetry == symmetry_quarter))
    associate (s => deck%settings, symmetry => deck%setup%plate%symmetry)
      if (any(is_mirrored(symmetry)) .and. is_coupled(deck)) call report(s, problems, plate_group, key_symmetry, &
        coupled_part(deck)//' couples bending or extension with shear or twist (A16, A26, B16, B26, D16, D26 or '// &
        'A45 is not 0), so a '//part//' cannot represent the plate; use ''none'' or ''point''.')
      if (is_eccentric(deck%setup%mesh%struck, symmetry) .and. are_clear(s, problems, impactor_group, key_at)) &
        call report(s, problems, impactor_group, key_at, 'the struck point is not on the lines of symmetry = '// &
                    name// &
                  '; use ''none''.')
      if (deck%setup%ply_damage%scatters()) call report(s, problems, ply_damage_group, key_seed, &
        'strengths that scatter from place to place have no image under symmetry = '//name//'; use ''none''.')
      call check_starters(deck, name, problems)
      if (.not. supports_are_symmetric(deck, symmetry) .and. .not. problems%concern(support_group)) &
        call report(s, problems, support_group, key_clamps, 'clamps have no image under symmetry = '//name// &
                  '; list all clamps of the full plate, or use ''none''.')
      if (.not. has_zone_images(deck, symmetry)) &
        call report(s, problems, trim(merge(doubler_group//' ', ply_drop_group, &
                                            allocated(deck%setup%zones%doublers))), &
                    key_zone_at, 'a doubler or ply drop has no image with the same plies under symmetry = '//name// &
                    '; list all of the full plate, or use ''none''.')
      if (.not. have_images(deck%setup%stringers, deck%setup%plate, symmetry, same_place) .and. &
          .not. problems%concern(stringer_group)) &
        call report(s, problems, stringer_group, key_stringer_at, 'a stringer has no image under symmetry = '// &
                    name//'; give all stringers of the full plate, or use ''none''.')
      if (symmetry == symmetry_point .and. any(deck%setup%delaminations%law == law_front)) &
        call report(s, problems, plate_group, key_symmetry, &
        'fronts are not modelled across the cut of a plate with point symmetry; use ''none'', or law = ''cohesive''.')
      if (symmetry == symmetry_point .and. .not. problems%concern(line_group)) then
        if (any(deck%setup%lines%direction == along_x .or. .not. deck%setup%lines%at > 0)) &
          call report(s, problems, plate_group, key_symmetry, 'a line along x or at x = 0 has no image '// &
                    'on the same line; use ''none'', or lines along y at x > 0, whose images are included.')
      end if
    end associate
  end subroutine check_symmetry

  !> Refuses starters beside the lines of symmetry.
  subroutine check_starters(deck, name, problems)
    type(deck_t), intent(in) :: deck
    !> Name of the symmetry, in quotes
    character(len=*), intent(in) :: name
    type(problems_t), intent(inout) :: problems
    logical :: halved(2), eccentric
    integer :: i

    halved = is_halved(deck%setup%plate%symmetry)
    do i = 1, size(deck%setup%delaminations)
      if (i > 1) then
        if (deck%setup%delaminations(i)%group == deck%setup%delaminations(i - 1)%group) cycle
      end if
      if (is_eccentric(deck%setup%delaminations(i)%starter_at, deck%setup%plate%symmetry) .and. &
          are_clear(deck%settings, problems, delamination_group, key_starter_at, deck%setup%delaminations(i)%group)) &
        call report(deck%settings, problems, delamination_group, key_starter_at, &
                    'the starter is not on the lines '// &
                  'of symmetry = '//name//'; use ''none''.', deck%setup%delaminations(i)%group)
      associate (strip => deck%setup%delaminations(i)%starter_strip)
        eccentric = halved(1) .and. abs(sum(strip)) > same_place*maxval(abs(strip))
      end associate
      if (eccentric .and. &
          are_clear(deck%settings, problems, delamination_group, key_strip, deck%setup%delaminations(i)%group)) &
        call report(deck%settings, problems, delamination_group, key_strip, 'the strip is not its own image under '// &
                    'symmetry = '//name//'; give two x of equal size and opposite sign, or use ''none''.', &
                    deck%setup%delaminations(i)%group)
    end do
  end subroutine check_starters

  !> True if a point is not on a line of symmetry.
  pure logical function is_eccentric(point, symmetry)
    !> Its position, from the centre of the plate
    real(wp), intent(in) :: point(2)
    integer, intent(in) :: symmetry

    is_eccentric = any(abs(point) > 0 .and. (is_halved(symmetry) .or. symmetry == symmetry_point))
  end function is_eccentric

  !> Sentence on the smallest part of the plate that need be modelled; empty if the deck already models only this part.
  function symmetry_sentence(deck) result(sentence)
    type(deck_t), intent(in) :: deck
    character(len=:), allocatable :: sentence
    character(len=*), parameter :: names(5) = [character(len=7) :: 'none', 'quarter', 'half_x', 'half_y', 'point']
    integer :: part

    sentence = ''
    part = smallest_part(deck)
    if (part /= deck%setup%plate%symmetry) sentence = 'Laminate, supports and struck point allow symmetry = '''// &
                                                trim(names(part))//''', which reduces the model.'
  end function symmetry_sentence

  !> The smallest part of the plate that need be modelled; that of the deck if there is none smaller.
  integer function smallest_part(deck) result(part)
    type(deck_t), intent(in) :: deck
    integer, parameter :: parts(4) = [symmetry_quarter, symmetry_half_x, symmetry_half_y, symmetry_point]
    integer :: i

    part = deck%setup%plate%symmetry
    if (deck%setup%ply_damage%scatters()) return
    do i = 1, size(parts)
      if (part == symmetry_quarter .or. part /= symmetry_none .and. i > 1) return
      if (suits(deck, parts(i))) part = parts(i)
    end do
  end function smallest_part

  !> Sets the symmetry that is enforced on a full plate during failure; without failure the solution is symmetric in any
  !> case. A state from another run need not be symmetric.
  subroutine note_symmetry(deck)
    type(deck_t), intent(inout) :: deck

    if (deck%setup%plate%symmetry /= symmetry_none .or. deck%setup%initial%is_inherited) return
    if (deck%setup%ply_damage%is_present .or. size(deck%setup%delaminations) > 0) &
      deck%setup%plate%kept = smallest_part(deck)
  end subroutine note_symmetry

  !> True if a part of the plate suffices.
  logical function suits(deck, symmetry)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: symmetry
    logical :: alike(2)
    integer :: i

    alike = deck%setup%plate%edges([1, 3]) == deck%setup%plate%edges([2, 4])
    ! Lines and strips may have no images.
    suits = size(deck%setup%lines) == 0 .and. &
            .not. any([(deck%setup%delaminations(i)%has_strip(), i=1, size(deck%setup%delaminations))]) .and. &
            .not. any([(is_eccentric(deck%setup%delaminations(i)%starter_at, symmetry), &
                        i=1, size(deck%setup%delaminations))]) .and. &
            all(alike .or. .not. is_halved(symmetry)) .and. (symmetry /= symmetry_point .or. all(alike)) .and. &
            .not. is_eccentric(deck%setup%mesh%struck, symmetry) .and. supports_are_symmetric(deck, symmetry) .and. &
            have_images(deck%setup%stringers, deck%setup%plate, symmetry, same_place) .and. &
            has_symmetric_imperfection(deck%setup%plate, symmetry) .and. has_zone_images(deck, symmetry)
    if (.not. suits) return
    if (symmetry == symmetry_point) then
      suits = .not. any(deck%setup%delaminations%law == law_front)
    else
      suits = .not. is_coupled(deck)
    end if
  end function suits

  !> True if the image of each doubler and ply drop is one with the same plies.
  pure logical function has_zone_images(deck, symmetry) result(alike)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: symmetry
    logical :: mirrored(2)

    mirrored = is_mirrored(symmetry)
    alike = .true.
    if (mirrored(1)) alike = alike .and. zones_are_symmetric(deck, [-1, 1])
    if (mirrored(2)) alike = alike .and. zones_are_symmetric(deck, [1, -1])
    if (symmetry == symmetry_point) alike = alike .and. zones_are_symmetric(deck, [-1, -1])
  end function has_zone_images

  !> True if each clamp has its images in the rig; windows lie at the centre.
  pure logical function supports_are_symmetric(deck, symmetry) result(alike)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: symmetry
    logical :: mirrored(2)
    integer :: i

    mirrored = is_mirrored(symmetry)
    alike = .true.
    do i = 1, size(deck%setup%supports)
      if (.not. allocated(deck%setup%supports(i)%clamps)) cycle
      associate (clamps => deck%setup%supports(i)%clamps)
        if (mirrored(1)) alike = alike .and. have_images([-1, 1])
        if (mirrored(2)) alike = alike .and. have_images([1, -1])
        if (symmetry == symmetry_point) alike = alike .and. have_images([-1, -1])
      end associate
    end do

  contains

    !> True if the image of each clamp is a clamp.
    pure logical function have_images(signs)
      integer, intent(in) :: signs(2)
      integer :: j, k

      associate (clamps => deck%setup%supports(i)%clamps)
        have_images = all([(any([(maxval(abs(signs*clamps(:, j) - clamps(:, k))) <= &
                                  same_place*maxval(deck%setup%plate%length), k=1, size(clamps, 2))]), &
                            j=1, size(clamps, 2))])
      end associate
    end function have_images
  end function supports_are_symmetric

  !> Subject of a message on coupling: the laminate, or parts of it.
  pure function coupled_part(deck) result(words)
    type(deck_t), intent(in) :: deck
    !> Such as `the laminate`
    character(len=:), allocatable :: words

    words = 'the laminate'
    if (couples(stacked_plies(deck%setup%laminate, deck%setup%materials))) return
    words = 'a layer between interfaces'
    if (deck%setup%ply_damage%is_present) words = 'a ply that may fail'
  end function coupled_part

  !> True: the laminate is valid and not symmetric about the axes of the plate, or a part of it is not: a layer between
  !> interfaces, or with damage each ply.
  pure logical function is_coupled(deck)
    type(deck_t), intent(in) :: deck
    type(ply_t), allocatable :: plies(:)
    integer, allocatable :: last(:)
    integer :: i

    is_coupled = .false.
    associate (laminate => deck%setup%laminate)
      if (.not. (allocated(laminate%angle) .and. allocated(laminate%thickness))) return
      if (.not. allocated(laminate%material)) return
      if (any([(material_objection(deck%setup%materials(laminate%material(i))) /= '', i=1, size(laminate%material))])) &
        return
      plies = stacked_plies(laminate, deck%setup%materials)
    end associate
    is_coupled = couples(plies) .or. zones_are_coupled(deck)
    last = [pack(deck%setup%delaminations%below_ply, deck%setup%delaminations%below_ply > 0 .and. &
                 deck%setup%delaminations%below_ply < size(plies)), size(plies)]
    if (deck%setup%ply_damage%is_present) last = [(i, i=1, size(plies))]
    do i = 1, size(last)
      if (i == 1) then
        is_coupled = is_coupled .or. couples(plies(:last(1)))
      else if (last(i) > last(i - 1)) then
        is_coupled = is_coupled .or. couples(plies(last(i - 1) + 1:last(i)))
      end if
    end do
  end function is_coupled

  !> True if the plies somewhere on the plate couple bending or extension with shear or twist: all, or with damage or
  !> interfaces a ply of a doubler.
  pure logical function zones_are_coupled(deck) result(coupled)
    type(deck_t), intent(in) :: deck
    logical, allocatable :: known(:, :)
    real(wp), allocatable :: shares(:)
    type(ply_stack_t) :: stack
    integer :: i, k

    coupled = .false.
    if (deck%setup%zones%is_empty()) return
    call deck%setup%zones%find_shares(deck%setup%plate%length, known, shares)
    do i = 1, size(shares)
      if (.not. shares(i) > 0) cycle
      stack = deck%setup%zones%stack(deck%setup%laminate, deck%setup%materials, known(:, i))
      coupled = coupled .or. couples(stack%plies)
      if (deck%setup%ply_damage%is_present .or. size(deck%setup%delaminations) > 0) &
        coupled = coupled .or. any([(couples(stack%plies(k:k)), k=1, size(stack%plies))])
    end do
  end function zones_are_coupled

  !> True if some plies couple bending or extension with shear or twist.
  pure logical function couples(plies)
    !> Neighbouring plies
    type(ply_t), intent(in) :: plies(:)
    real(wp) :: stiffness(21), thickness, scales(7)

    stiffness = section_stiffness(plies, plies%elasticity, shear_five_sixths)
    thickness = 2*max(abs(plies(1)%z_top), abs(plies(size(plies))%z_bottom))
    scales(1:2) = maxval(stiffness(1:6))
    scales(3:4) = scales(1)*thickness
    scales(5:6) = scales(1)*thickness**2
    scales(7) = maxval(stiffness(19:21))
    couples = any(abs(stiffness([3, 5, 9, 11, 15, 17, 20])) > no_coupling*scales)
  end function couples
end module deck_symmetries
