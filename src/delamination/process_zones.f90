!> Process zone of a cohesive interface: the length ahead of a front over which traction decreases from the strength to
!> zero, its resolution by a mesh, and the warning of the check.
!>
!> Between plates the length depends on their thickness h and bending modulus E', not on the interface alone: sqrt(E'
!> G_IIc h)/tau in shear, (E' G_Ic/sigma**2)**(1/4) h**(3/4) in opening. In strips under end moments the ratio of the
!> largest moment to the exact one was 1.012, 1.04 and 1.33 with 3.4, 1.7 and 0.9 cells in the process zone in shear; in
!> opening it was 2 to 5 % too large with 3.3 cells, 4 to 5 % with 2.3 and 7 to 19 % with 1.6. That is by the strengths
!> alone; errors with growth by energy are those of `growth_errors`.
module process_zones
  use growth_errors, only: area_errors, load_errors
  use kinds, only: wp
  use short_numbers, only: short_text, text_at_most
  use text, only: to_text
  implicit none
  private
  public :: process_zone_t, shear_zone_length, opening_zone_length, resolved_shear_strength, &
            resolved_opening_strength, resolved_part, resolving_cell, is_resolved, cells_in_zones, &
            process_zone_warning

  !> Number of cells in a process zone that resolve it: the moment at growth is then about 2.5 % too large in shear and
  !> 4 % in opening, by the figures above.
  real(wp), parameter, public :: resolving_cells = 2.5_wp
  !> Ratios of the strengths to those that the cells resolve above which the check warns, in shear and in opening. The
  !> process zones then have 2.5/1.5 = 1.7 and 2.5/sqrt(1.2) = 2.3 cells, and the moments are 4 and 5 % too large.
  real(wp), parameter :: tolerated_shear = 1.5_wp, tolerated_opening = 1.2_wp

  !> Data of the process zone of an interface.
  type :: process_zone_t
    !> Bending modulus 12 D/h**3 of the thinner layer in the direction of growth
    real(wp) :: modulus = 0
    !> Thickness of the thinner layer
    real(wp) :: thickness = 0
    !> Toughness of pure opening G_Ic and of pure shear G_IIc, energy per area
    real(wp) :: toughness_opening = 0, toughness_shear = 0
    !> Strength sigma of pure opening and tau of pure shear
    real(wp) :: strength_opening = 0, strength_shear = 0
    !> Longest side of a cell in the layered zone
    real(wp) :: cell = 0
    !> True: loads may open the interface, so that opening may govern. Under an impactor delaminations grow in shear:
    !> with .9 cells in the process zone of opening the force is within 2 % of the closed form
    !> (input/verify/cohesive_threshold.nml).
    logical :: is_pulled = .true.
    !> True: the energy release rate starts softening beside delaminated points (`energy_onsets`)
    logical :: by_energy = .false.
    !> True: a starter grows in load steps or implicit steps, without an impactor
    logical :: is_implicit_specimen = .false.
  end type process_zone_t

contains

  !> Length of the process zone in shear, sqrt(E' G_IIc h)/tau.
  pure real(wp) function shear_zone_length(zone) result(length)
    type(process_zone_t), intent(in) :: zone

    length = sqrt(zone%modulus*zone%toughness_shear*zone%thickness)/zone%strength_shear
  end function shear_zone_length

  !> Length of the process zone in opening, (E' G_Ic/sigma**2)**(1/4) h**(3/4).
  pure real(wp) function opening_zone_length(zone) result(length)
    type(process_zone_t), intent(in) :: zone

    length = sqrt(sqrt(zone%modulus*zone%toughness_opening*zone%thickness**3)/zone%strength_opening)
  end function opening_zone_length

  !> Shear strength with a process zone of 2.5 cells.
  pure real(wp) function resolved_shear_strength(zone) result(strength)
    type(process_zone_t), intent(in) :: zone

    strength = sqrt(zone%modulus*zone%toughness_shear*zone%thickness)/(resolving_cells*zone%cell)
  end function resolved_shear_strength

  !> Strength of opening with a process zone of 2.5 cells.
  pure real(wp) function resolved_opening_strength(zone) result(strength)
    type(process_zone_t), intent(in) :: zone

    strength = sqrt(zone%modulus*zone%toughness_opening*zone%thickness**3)/(resolving_cells*zone%cell)**2
  end function resolved_opening_strength

  !> Fraction of the governing strengths that the cells resolve, at most 1.
  pure real(wp) function resolved_part(zone) result(part)
    type(process_zone_t), intent(in) :: zone

    part = min(1.0_wp, resolved_shear_strength(zone)/zone%strength_shear)
    if (zone%is_pulled) part = min(part, resolved_opening_strength(zone)/zone%strength_opening)
  end function resolved_part

  !> Longest side of cells with at least 2.5 cells in the governing process zones.
  pure real(wp) function resolving_cell(zone) result(cell)
    type(process_zone_t), intent(in) :: zone

    cell = shear_zone_length(zone)/resolving_cells
    if (zone%is_pulled) cell = min(cell, opening_zone_length(zone)/resolving_cells)
  end function resolving_cell

  !> False: the check warns of cells that are too long, with fewer than 1.7 in the process zone in shear or 2.3 in that
  !> in opening.
  pure logical function is_resolved(zone)
    type(process_zone_t), intent(in) :: zone

    is_resolved = zone%strength_shear <= tolerated_shear*resolved_shear_strength(zone)
    if (zone%is_pulled) is_resolved = is_resolved .and. &
                                      zone%strength_opening <= tolerated_opening*resolved_opening_strength(zone)
  end function is_resolved

  !> Number of cells in the process zones of shear and opening.
  pure function cells_in_zones(zone) result(cells)
    type(process_zone_t), intent(in) :: zone
    !> In shear and in opening
    real(wp) :: cells(2)

    cells = [shear_zone_length(zone), opening_zone_length(zone)]/zone%cell
  end function cells_in_zones

  !> Warning of the check for an interface; empty if its process zone is resolved. Numbers have the units of the deck,
  !> lengths the given one.
  pure function process_zone_warning(zone, below_ply, fewest, unit, size_of_unit) result(warning)
    type(process_zone_t), intent(in) :: zone
    !> Ply above the interface
    integer, intent(in) :: below_ply
    !> Fewest cells in the process zones of shear and opening of all interfaces, whose expected errors are reported
    real(wp), intent(in) :: fewest(2)
    !> Unit of lengths after a blank; empty: that of the deck
    character(len=*), intent(in) :: unit
    !> That unit in units of the deck
    real(wp), intent(in) :: size_of_unit
    !> Two sentences, or empty
    character(len=:), allocatable :: warning
    real(wp) :: cells(2)

    warning = ''
    if (is_resolved(zone)) return
    cells = cells_in_zones(zone)
    warning = 'delamination below ply '//to_text(below_ply)//': the process zone is '// &
              short_text(shear_zone_length(zone)/size_of_unit)//unit//' long in shear ('// &
              short_text(opening_zone_length(zone)/size_of_unit)//unit//' in opening), that is '// &
              in_cells(cells(1))//' ('//in_cells(cells(2))//') cells; '
    if (zone%by_energy) then
      warning = warning//'with growth_control = ''energy'' expect '//expected_errors(zone, fewest)
      return
    end if
    warning = warning//'the strengths alone control growth, and the load at growth is too large (4 % at 1.7 cells, '// &
              '33 % at 0.9). '
    if (zone%is_implicit_specimen) then
      warning = warning//'Take cells of at most '//text_at_most(resolving_cell(zone)/size_of_unit)//unit// &
                ', or strength_shear <= '//text_at_most(resolved_shear_strength(zone))//' (strength_opening <= '// &
                text_at_most(resolved_opening_strength(zone))//'), as growth depends on the toughness.'
    else
      warning = warning//'With integrator = ''central_difference'' of &time and growth_control = ''energy'' expect '// &
                expected_errors(zone, fewest)
    end if
  end function process_zone_warning

  !> Errors with growth by energy, as measured.
  pure function expected_errors(zone, fewest) result(errors)
    type(process_zone_t), intent(in) :: zone
    !> Fewest cells in the process zones of shear and opening
    real(wp), intent(in) :: fewest(2)
    !> A clause and a sentence
    character(len=:), allocatable :: errors

    errors = measured(load_errors(merge(minval(fewest), fewest(1), zone%is_pulled)), 'load at growth', &
                      'strips with such cells')
    if (.not. zone%is_pulled) errors = errors//', and '//measured(area_errors(fewest(1)), 'area', 'impacts')
    errors = errors//'. `implam explain growth_errors` lists measured errors, --verify runs finer cells.'
  end function expected_errors

  !> Errors of a quantity, which may not have been measured with such cells.
  pure function measured(range, quantity, specimens) result(clause)
    !> The range of errors, or 'unknown'
    character(len=*), intent(in) :: range
    !> The quantity, and where it was measured
    character(len=*), intent(in) :: quantity, specimens
    !> Such as errors of -6 to 2 % of the area, as in impacts
    character(len=:), allocatable :: clause

    clause = 'unknown errors of the '//quantity
    if (range /= 'unknown') clause = 'errors of '//range//' % of the '//quantity//', as in '//specimens
  end function measured

  !> A number of cells, to one decimal, or to three digits if that would be zero.
  pure function in_cells(cells) result(number)
    !> The number
    real(wp), intent(in) :: cells
    !> Such as 1.7
    character(len=:), allocatable :: number
    character(len=24) :: buffer

    write (buffer, '(f24.1)') cells
    number = trim(adjustl(buffer))
    if (number(1:1) == '.') number = '0'//number
    if (number == '0.0') number = short_text(cells)
  end function in_cells
end module process_zones
