!> Warns of values of the deck that are probably in another unit than the others.
!>
!> The system of units is that of `&case units`, or by default the one with the fewest unusual values. A value is
!> reported only if its size is unusual in that system and usual in another common unit. Three values are compared with
!> others rather than with ranges: the run's time with the plate's period, the mass of a steel ball with its radius, and
!> the contact stiffness with Sun's formula.
module deck_units
  use deck_contents, only: deck_t
  use deck_magnitudes, only: magnitude_t, magnitudes_of
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_vocabulary, only: vocabulary_t
  use delamination_deck, only: key_starter, key_zone
  use gauge_deck, only: gauge_group, key_gauge_at
  use hertz_contact, only: sun_stiffness
  use impactor_deck, only: impactor_group, key_at, key_energy, key_mass
  use indentation_deck, only: indentation_group, key_k
  use interface_places, only: delamination_group
  use kinds, only: wp
  use line_deck, only: line_group, key_line_at => key_at
  use mathematical_constants, only: pi
  use mesh_deck, only: key_cell, key_core, key_lines, key_patch, mesh_group
  use short_numbers, only: short_text
  use support_deck, only: key_clamps, key_window, support_group
  use time_deck, only: time_group, key_end
  use unit_systems, only: base_units, is_unusual, system_named, unit_that_fits, unit_name, systems, quantities, &
                          of_length, of_mass, of_pressure, of_radius, of_thickness, of_time
  implicit none
  private
  public :: check_units

  !> Usual range of the end of the run over the plate's period or the contact, whichever is longer. It is wide enough
  !> for any run, and confused units change the ratio by 1e3 or 1e6. It affects a warning only, as all below.
  real(wp), parameter :: shortest_run = 5.0e-3_wp, longest_run = 100
  !> Ratio of the duration of a contact to its rise time: two in a symmetric contact, and a margin for repeated
  !> contacts.
  real(wp), parameter :: contact_rises = 10
  !> Density of steel, kg/m^3, and the relative tolerance for a ball of steel: steels have 7700 to 8050.
  real(wp), parameter :: steel = 7850, near = 0.03_wp
  !> Ratios of the contact stiffness to that of Sun's formula for a rigid ball: usual and improbable ones. That of an
  !> elastic plate is .5 (input/verify/karas.nml); N/mm^1.5 in place of N/m^1.5 changes the ratio by 3e4.
  real(wp), parameter :: usual_stiffness(2) = [0.02_wp, 5.0_wp], odd_stiffness(2) = [1.0e-3_wp, 1.0e3_wp]
  !> Slowest drop weight, m/s: 50 mm of height, where ASTM D7136 has 300 mm or more. Energy over thickness of a plate,
  !> J/m, beyond which the impactor passes through: ASTM D7136 has 6.7 J/mm, perforation takes up to 60 J/mm.
  real(wp), parameter :: slowest_drop = 0.99_wp, highest_energy = 1.0e5_wp
  !> Keys of lengths in the plane of the plate.
  character(len=*), parameter :: groups_of_lengths(*) = [character(len=12) :: mesh_group, mesh_group, mesh_group, &
    mesh_group, mesh_group, delamination_group, delamination_group, support_group, support_group, impactor_group, &
    line_group, gauge_group]
  character(len=*), parameter :: keys_of_lengths(*) = [character(len=7) :: key_patch, key_core, key_cell, key_lines, &
    key_zone, key_starter, key_window, key_clamps, key_at, key_line_at, key_gauge_at]
  !> N/m^1.5 in one N/mm^1.5: 1000**1.5.
  real(wp), parameter :: per_millimetre = 31622.8_wp

contains

  !> Warns of values in other units.
  subroutine check_units(deck, vocabulary, problems)
    !> The deck, checked, with its expected results
    type(deck_t), intent(in) :: deck
    !> The table with the usual ranges
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(inout) :: problems
    type(magnitude_t), allocatable :: list(:)
    character(len=:), allocatable :: fits
    integer :: system, i

    call magnitudes_of(deck, vocabulary, problems, list)
    system = probable_system(deck, list)
    if (system == 0) return
    do i = 1, size(list)
      if (.not. is_unusual(list(i)%quantity, list(i)%value, system)) cycle
      if (is_soft(list, i, system)) cycle
      fits = unit_that_fits(list(i)%quantity, list(i)%value)
      if (fits == '') cycle
      call report_unit(deck, problems, list(i), system, trim(merge('of the laminate is unusual', &
                       'is unusual                ', list(i)%quantity == of_thickness)), fits)
    end do
    call check_lengths(deck, system, problems)
    ! The other values are those of the model, which a deck with errors does not have.
    if (problems%errors() > 0) return
    if (deck%has_time .and. .not. deck%setup%is_static()) call check_times(deck, system, problems)
    if (deck%setup%moves_impactor()) then
      call check_mass(deck, system, problems)
      call check_ball(deck, system, problems)
    end if
  end subroutine check_units

  !> True for a modulus of a material of which some are unusual, but not all, and more than one: those of a honeycomb.
  pure logical function is_soft(list, place, system)
    !> Values of the deck
    type(magnitude_t), intent(in) :: list(:)
    !> Index of the modulus
    integer, intent(in) :: place
    integer, intent(in) :: system
    logical :: of_material(size(list))
    integer :: unusual, i

    of_material = list%quantity == of_pressure .and. list%quantity == list(place)%quantity .and. &
                  list%place == list(place)%place
    unusual = count([(of_material(i) .and. is_unusual(of_pressure, list(i)%value, system), i=1, size(list))])
    is_soft = unusual > 1 .and. unusual < count(of_material)
  end function is_soft

  !> Adds a warning.
  subroutine report_unit(deck, problems, item, system, finding, fits)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    !> The value
    type(magnitude_t), intent(in) :: item
    integer, intent(in) :: system
    !> The finding
    character(len=*), intent(in) :: finding
    !> Unit that fits
    character(len=*), intent(in) :: fits

    call remark(deck%settings, problems, trim(item%group), trim(item%key), short_text(item%value)//' '// &
                unit_name(item%quantity, system)//' '//finding//' compared with the other values, which fit '// &
                trim(systems(system))//'; it is probably in '//fits//'.', item%place)
  end subroutine report_unit

  !> The system of the deck, or otherwise the one with the fewest unusual kinds of quantities; 0: none fits, the deck
  !> has units of its own.
  pure integer function probable_system(deck, list) result(system)
    type(deck_t), intent(in) :: deck
    !> Its values
    type(magnitude_t), intent(in) :: list(:)
    logical :: odd(quantities)
    integer :: number(size(systems)), present_kinds, kind, i, k

    system = system_named(deck%case%units)
    if (system > 0) return
    present_kinds = count([(any(list%quantity == i), i=1, quantities)])
    do i = 1, size(systems)
      odd = [(any([(list(k)%quantity == kind .and. is_unusual(list(k)%quantity, list(k)%value, i), &
                    k=1, size(list))]), kind=1, quantities)]
      ! Lengths of all kinds count as one.
      odd(of_length) = odd(of_length) .or. odd(of_thickness) .or. odd(of_radius)
      odd([of_thickness, of_radius]) = .false.
      number(i) = count(odd)
    end do
    system = minloc(number, 1)
    ! Without an impactor there are too few values to determine the system, and plates of unit density are common.
    if (2*number(system) > present_kinds .or. .not. deck%setup%impactor%is_present) system = 0
  end function probable_system

  !> Checks the end of the run against the expected events.
  subroutine check_times(deck, system, problems)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: system
    type(problems_t), intent(inout) :: problems
    real(wp) :: longest, ratio
    integer :: i
    ! Ratios of units of time, in whose order the names below are
    real(wp), parameter :: thousands(4) = [1.0e-3_wp, 1.0e-6_wp, 1.0e3_wp, 1.0e6_wp]
    character(len=2), parameter :: of_si(4) = [character(len=2) :: 'ms', 'us', '', ''], &
                                   of_ms(4) = [character(len=2) :: 'us', '', 's', '']

    if (deck%settings%is_known(time_group, key_end) .and. .not. deck%settings%is_given(time_group, key_end)) return
    longest = max(deck%expected%scales%first_period, contact_rises*deck%expected%scales%contact_time)
    if (deck%setup%impactor%is_present) &
      longest = max(longest, pi*sqrt(deck%setup%impactor%mass*deck%expected%scales%compliance))
    if (.not. longest > 0) return
    ratio = deck%stepping%time%end/longest
    if (ratio > shortest_run .and. ratio < longest_run) return
    do i = 1, size(thousands)
      if (ratio*thousands(i) < shortest_run .or. ratio*thousands(i) > longest_run) cycle
      associate (unit => merge(of_ms(i), of_si(i), unit_name(of_time, system) == 'ms'))
        if (unit /= '') call report_unit(deck, problems, &
                                       magnitude_t(of_time, deck%stepping%time%end, time_group, key_end), &
                                       system, 'is '//short_text(ratio)//' times the expected duration', trim(unit))
      end associate
      return
    end do
  end subroutine check_times

  !> Checks lengths that do not fit on the plate, which would do so in millimetres.
  subroutine check_lengths(deck, system, problems)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: system
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: values(:)
    character(len=:), allocatable :: group, key
    real(wp) :: side
    integer :: i, place

    side = maxval(deck%setup%plate%length)
    if (unit_name(of_length, system) /= 'm' .or. is_unusual(of_length, side, system)) return
    do i = 1, size(keys_of_lengths)
      group = trim(groups_of_lengths(i))
      key = trim(keys_of_lengths(i))
      do place = 1, deck%settings%groups_named(group)
        if (.not. deck%settings%is_given(group, key, place)) cycle
        values = abs(deck%settings%reals_of(group, key, place))
        if (.not. any(values > side) .or. any(values > 1000*side)) cycle
        call remark(deck%settings, problems, group, key, short_text(maxval(values))//' m is more than the '// &
                    'plate''s length of '//short_text(side)//' m; it is probably in mm.', place)
      end do
    end do
  end subroutine check_lengths

  !> Checks the mass of a drop weight against its speed, or the energy against the thickness of the plate.
  subroutine check_mass(deck, system, problems)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: system
    type(problems_t), intent(inout) :: problems
    real(wp) :: base(3), speed, energy
    character(len=:), allocatable :: finding

    associate (impactor => deck%setup%impactor)
      base = base_units(system)
      speed = impactor%velocity*base(1)/base(3)
      energy = 0.5_wp*impactor%mass*base(2)*speed**2/(sum(deck%setup%laminate%thickness)*base(1))
      if (is_unusual(of_mass, impactor%mass, system)) return
      if (deck%settings%is_given(impactor_group, key_energy)) then
        if (energy >= highest_energy .and. energy/1000 < highest_energy) &
          call remark(deck%settings, problems, impactor_group, key_energy, 'is '//short_text(energy/1000)// &
                      ' J per mm of thickness, beyond perforation; it is probably in mJ.')
        if (speed > slowest_drop .or. speed*sqrt(1000.0_wp) < slowest_drop) return
        finding = 'has a speed of only '//short_text(speed)//' m/s with the energy of the deck'
      else
        if (energy < highest_energy) return
        finding = 'has an energy of '//short_text(energy/1000)//' J per mm of thickness'
      end if
      call remark(deck%settings, problems, impactor_group, key_mass, short_text(impactor%mass)//' '// &
                  unit_name(of_mass, system)//' '//finding//'; the mass is probably in '// &
                  trim(merge('kg', 'g ', unit_name(of_mass, system) == 't'))//'.')
    end associate
  end subroutine check_mass

  !> Checks mass and contact stiffness of the ball against its radius.
  subroutine check_ball(deck, system, problems)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: system
    type(problems_t), intent(inout) :: problems
    real(wp) :: base(3), ball, ratio

    associate (impactor => deck%setup%impactor, law => deck%setup%impactor%indentation)
      if (.not. impactor%radius > 0) return
      if (is_unusual(of_radius, impactor%radius, system)) return
      base = base_units(system)
      ball = impactor%mass*base(2)/(4*pi/3*(impactor%radius*base(1))**3)
      if (abs(ball/(1000*steel) - 1) < near) then
        call report_unit(deck, problems, magnitude_t(of_mass, impactor%mass, impactor_group, key_mass), system, &
                       'is a thousand times that of a steel ball,', &
                       trim(merge('kg', 'g ', unit_name(of_mass, system) == 't')))
      end if
      if (.not. deck%settings%is_given(indentation_group, key_k)) return
      ratio = law%k/sun_stiffness(impactor%radius, 1/deck%setup%materials(deck%setup%laminate%material(1))%e2)
      if (ratio > odd_stiffness(1) .and. ratio < odd_stiffness(2)) return
      if (usual(ratio*per_millimetre)) call remark(deck%settings, problems, indentation_group, key_k, 'is '// &
        short_text(ratio)//' times that of Sun''s formula; it is probably in N/mm^1.5.')
      if (usual(ratio/per_millimetre)) call remark(deck%settings, problems, indentation_group, key_k, 'is '// &
        short_text(ratio)//' times that of Sun''s formula; it is probably in N/m^1.5.')
    end associate
  end subroutine check_ball

  !> True: a usual contact stiffness.
  pure logical function usual(ratio)
    !> Its ratio to that of Sun's formula
    real(wp), intent(in) :: ratio

    usual = ratio > usual_stiffness(1) .and. ratio < usual_stiffness(2)
  end function usual
end module deck_units
