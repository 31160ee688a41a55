!> Fills in the keys of a published material, in the units of the deck, where the deck does not give them.
module deck_library
  use case_deck, only: case_group, key_units
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use delamination_deck, only: key_toughness, key_toughness_opening, key_toughness_shear
  use interface_places, only: delamination_group
  use material_deck, only: key_library, material_group
  use material_library, only: library_value_t, library_values
  use text, only: lower_case, to_text
  use unit_systems, only: decades_of, of_density, of_pressure, of_toughness, system_named
  implicit none
  private
  public :: take_library

contains

  !> Fills in values of all materials with `library`, and of interfaces without toughness.
  subroutine take_library(settings, problems)
    !> Keys in effect; receive the values
    type(settings_t), intent(inout) :: settings
    !> A fault is added if the deck's units are not known
    type(problems_t), intent(inout) :: problems
    type(vocabulary_t) :: vocabulary
    integer :: place, system, first

    first = findloc([(settings%is_known(material_group, key_library, place), &
                      place=1, settings%groups_named(material_group))], .true., dim=1)
    if (first == 0) return
    system = system_named(settings%text_of(case_group, key_units))
    if (system == 0) then
      if (are_clear(settings, problems, case_group, key_units)) call report(settings, problems, material_group, &
        key_library, 'the values are known in SI; give the units of the deck by '//key_units//' of &'// &
        case_group//'.', first)
      ! Reported once; values are filled in with an arbitrary system, so that no check reports them as missing.
      system = 1
    end if
    call load_deck_table(vocabulary)
    do place = 1, settings%groups_named(material_group)
      call adopt_values(vocabulary, system, settings%text_of(material_group, key_library, place), material_group, &
                        place, settings)
    end do
    if (.not. is_one_material(settings)) return
    do place = 1, settings%groups_named(delamination_group)
      if (any([settings%is_given(delamination_group, key_toughness, place), &
               settings%is_given(delamination_group, key_toughness_opening, place), &
               settings%is_given(delamination_group, key_toughness_shear, place)])) cycle
      call adopt_values(vocabulary, system, settings%text_of(material_group, key_library), delamination_group, place, &
                        settings)
    end do
  end subroutine take_library

  !> True if all materials of the deck are the same published one.
  pure logical function is_one_material(settings)
    type(settings_t), intent(in) :: settings
    integer :: place

    is_one_material = all([(lower_case(settings%text_of(material_group, key_library, place)) == &
                            lower_case(settings%text_of(material_group, key_library)), &
                            place=1, settings%groups_named(material_group))])
  end function is_one_material

  !> Fills in the missing keys of one group.
  subroutine adopt_values(vocabulary, system, name, group, place, settings)
    !> The table of the deck, with the units of keys
    type(vocabulary_t), intent(in) :: vocabulary
    !> Index of the deck's system of units
    integer, intent(in) :: system
    !> Published material; empty: none
    character(len=*), intent(in) :: name
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    !> Keys in effect; receive the values
    type(settings_t), intent(inout) :: settings
    type(library_value_t), allocatable :: values(:)
    integer :: i

    values = library_values(name)
    do i = 1, size(values)
      if (values(i)%group /= group) cycle
      associate (unit => vocabulary%keys(vocabulary%key_index(group, values(i)%key))%unit)
        call settings%adopt(group, values(i)%key, values(i)%figures//'e'// &
                            to_text(values(i)%exponent - decades(unit, system)), &
                            'library '//lower_case(name)//', source '//values(i)%source, place)
      end associate
    end do
  end subroutine adopt_values

  !> Power of ten by which a value in a system of units differs from that in SI.
  pure integer function decades(unit, system)
    !> Physical dimension, as the table of the deck names it
    character(len=*), intent(in) :: unit
    integer, intent(in) :: system

    select case (unit)
    case ('pressure')
      decades = decades_of(of_pressure, system)
    case ('mass/volume')
      decades = decades_of(of_density, system)
    case ('energy/area')
      decades = decades_of(of_toughness, system)
    case default
      decades = 0
    end select
  end function decades
end module deck_library
