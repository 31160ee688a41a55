!> Values of a deck whose magnitude shows their unit: those of keys whose rows have a usual range.
module deck_magnitudes
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_vocabulary, only: key_entry_t, vocabulary_t
  use delamination_deck, only: key_strength_shear
  use impactor_deck, only: impactor_group, key_radius
  use kinds, only: wp
  use laminate_deck, only: laminate_group
  use material_deck, only: key_along, key_density, key_isotropic, key_other_moduli, material_group
  use usual_ranges, only: quantity_named
  implicit none
  private
  public :: magnitude_t, magnitudes_of

  !> One value of the deck, and the key to be named in a warning.
  type :: magnitude_t
    !> Kind of the quantity
    integer :: quantity = 0
    !> Its value
    real(wp) :: value = 0
    !> Group and key
    character(len=16) :: group = '', key = ''
    !> Index among the groups of this name
    integer :: place = 1
  end type magnitude_t

contains

  !> The values. They are those of the keys, as a deck with errors is not filled.
  subroutine magnitudes_of(deck, vocabulary, problems, list)
    type(deck_t), intent(in) :: deck
    !> The table with the usual ranges
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(in) :: problems
    !> The values
    type(magnitude_t), allocatable, intent(out) :: list(:)
    real(wp) :: value
    integer :: i, place

    allocate (list(0))
    do i = 1, size(vocabulary%keys)
      associate (key => vocabulary%keys(i))
        if (key%usual == '') cycle
        do place = 1, deck%settings%groups_named(key%group)
          if (.not. shows_unit(deck, key, place, problems)) cycle
          value = value_of(deck, key, place)
          if (value > 0) list = [list, magnitude_t(quantity_named(key%usual), value, key%group, key%name, place)]
        end do
      end associate
    end do
  end subroutine magnitudes_of

  !> True for a value that must be in the range. In-plane moduli and strengths of a honeycomb have no lower limit: of
  !> materials without errors only the largest modulus and the strengths of the stiffest one are considered. Impactors
  !> of load steps have no motion, and strengths that follow from those of plies are considered there.
  logical function shows_unit(deck, key, place, problems) result(shows)
    type(deck_t), intent(in) :: deck
    type(key_entry_t), intent(in) :: key
    integer, intent(in) :: place
    type(problems_t), intent(in) :: problems
    integer :: i

    shows = .true.
    associate (s => deck%settings)
      if (key%group == material_group .and. key%name /= key_density) then
        shows = place == maxloc([(max(s%real_of(material_group, key_isotropic, i), &
                                      s%real_of(material_group, key_along, i)), &
                                  i=1, s%groups_named(material_group))], 1) .and. &
                index(' '//key_other_moduli//' ', ' '//key%name//' ') == 0
        if (key%usual == 'modulus') shows = shows .or. problems%concern(material_group, place=place)
      else if (key%group == laminate_group .or. key%name == key_strength_shear) then
        shows = s%is_given(key%group, key%name, place)
      else if (key%group == impactor_group .and. key%name /= key_radius) then
        shows = deck%setup%moves_impactor()
      end if
    end associate
  end function shows_unit

  !> The value of a key, the least of several; of plies the thickness of the laminate.
  pure real(wp) function value_of(deck, key, place) result(value)
    type(deck_t), intent(in) :: deck
    type(key_entry_t), intent(in) :: key
    integer, intent(in) :: place

    value = 0
    if (key%group == laminate_group) then
      if (allocated(deck%setup%laminate%thickness)) value = sum(deck%setup%laminate%thickness)
    else if (deck%settings%is_known(key%group, key%name, place)) then
      value = minval(deck%settings%reals_of(key%group, key%name, place))
    end if
  end function value_of
end module deck_magnitudes
