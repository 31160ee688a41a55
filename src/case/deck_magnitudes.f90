!> Values of a deck whose magnitude shows their unit: sizes, moduli, strengths, toughnesses, masses, velocities.
module deck_magnitudes
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_settings, only: settings_t
  use delamination_deck, only: key_strength_shear, key_toughness, key_toughness_shear
  use delamination_parameters, only: toughnesses
  use impactor_deck, only: impactor_group, key_mass, key_radius, key_velocity
  use interface_places, only: delamination_group
  use kinds, only: wp
  use laminate_deck, only: key_ply_thickness, key_thicknesses, laminate_group
  use material_deck, only: key_along, key_density, key_isotropic, key_other_moduli, material_group, strength_keys, &
                           toughness_keys
  use plate_deck, only: key_length, plate_group
  use text, only: line_t, words_of
  use unit_systems, only: of_density, of_fibre_toughness, of_length, of_mass, of_pressure, of_radius, of_strength, &
                          of_thickness, of_toughness, of_velocity
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
  subroutine magnitudes_of(deck, problems, list)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(in) :: problems
    !> The values
    type(magnitude_t), allocatable, intent(out) :: list(:)

    allocate (list(0))
    call add(list, of_length, minval(deck%plate%length), plate_group, key_length, 1)
    if (allocated(deck%laminate%thickness)) call add(list, of_thickness, sum(deck%laminate%thickness), laminate_group, &
                                                     thickness_key(deck%settings), 1)
    call add_materials(deck, problems, list)
    call add_interfaces(deck, list)
    if (.not. deck%has_impactor) return
    if (deck%moves_impactor()) then
      call add(list, of_mass, deck%impactor%mass, impactor_group, key_mass, 1)
      call add(list, of_velocity, deck%impactor%velocity, impactor_group, key_velocity, 1)
    end if
    call add(list, of_radius, deck%impactor%radius, impactor_group, key_radius, 1)
  end subroutine magnitudes_of

  !> The key by which the deck gives the thickness of plies.
  function thickness_key(settings) result(key)
    type(settings_t), intent(in) :: settings
    !> Its name
    character(len=:), allocatable :: key

    key = key_thicknesses
    if (settings%is_given(laminate_group, key_ply_thickness)) key = key_ply_thickness
  end function thickness_key

  !> Values of the materials. In-plane moduli and strengths of a honeycomb have no lower limit: of materials without
  !> errors only the largest modulus and the strengths of the stiffest one are considered.
  subroutine add_materials(deck, problems, list)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(in) :: problems
    !> Values are added
    type(magnitude_t), allocatable, intent(inout) :: list(:)
    integer :: stiffest, i

    if (size(deck%materials) == 0) return
    stiffest = maxloc([(max(deck%settings%real_of(material_group, key_isotropic, i), &
                            deck%settings%real_of(material_group, key_along, i)), i=1, size(deck%materials))], 1)
    do i = 1, size(deck%materials)
      if (problems%concern(material_group, place=i)) then
        call add_keys(deck, of_pressure, key_isotropic//' '//key_along//' '//key_other_moduli, i, list)
      else if (i == stiffest) then
        call add_keys(deck, of_pressure, key_isotropic//' '//key_along, i, list)
      end if
      call add_keys(deck, of_density, key_density, i, list)
    end do
    do i = 1, size(strength_keys)
      call add_keys(deck, of_strength, strength_keys(i), stiffest, list)
    end do
    do i = 1, size(toughness_keys)
      call add_keys(deck, merge(of_fibre_toughness, of_toughness, i <= 2), toughness_keys(i), stiffest, list)
    end do
  end subroutine add_materials

  !> Values of keys of a material.
  subroutine add_keys(deck, quantity, keys, place, list)
    type(deck_t), intent(in) :: deck
    !> Kind of the quantities
    integer, intent(in) :: quantity
    !> Names, separated by blanks
    character(len=*), intent(in) :: keys
    !> Index of the material
    integer, intent(in) :: place
    !> Values are added
    type(magnitude_t), allocatable, intent(inout) :: list(:)
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    do i = 1, size(names)
      call add(list, quantity, deck%settings%real_of(material_group, names(i)%text, place), material_group, &
               names(i)%text, place)
    end do
  end subroutine add_keys

  !> Values of the interfaces; those of one group share them.
  subroutine add_interfaces(deck, list)
    type(deck_t), intent(in) :: deck
    !> Values are added
    type(magnitude_t), allocatable, intent(inout) :: list(:)
    real(wp) :: toughness(2)
    integer :: i

    do i = 1, size(deck%delaminations)
      associate (d => deck%delaminations(i))
        if (any(deck%delaminations(:i - 1)%group == d%group)) cycle
        toughness = toughnesses(d)
        call add(list, of_toughness, toughness(2), delamination_group, &
                 trim(merge(key_toughness//repeat(' ', len(key_toughness_shear) - len(key_toughness)), &
                            key_toughness_shear, d%toughness > 0)), d%group)
        ! The strength in opening may be as small as large cells require.
        if (deck%settings%is_given(delamination_group, key_strength_shear, d%group)) &
          call add(list, of_strength, d%strength_shear, delamination_group, key_strength_shear, d%group)
      end associate
    end do
  end subroutine add_interfaces

  !> Adds a value if it is given.
  subroutine add(list, quantity, value, group, key, place)
    !> Receives it
    type(magnitude_t), allocatable, intent(inout) :: list(:)
    !> Kind of the quantity
    integer, intent(in) :: quantity
    !> The value
    real(wp), intent(in) :: value
    !> Group and key
    character(len=*), intent(in) :: group, key
    !> Index among the groups of this name
    integer, intent(in) :: place
    type(magnitude_t) :: item

    if (.not. value > 0) return
    item%quantity = quantity
    item%value = value
    item%group = group
    item%key = key
    item%place = place
    list = [list, item]
  end subroutine add
end module deck_magnitudes
