!> Fields of the interfaces. Values of an interface are stored in the layer below it.
module interface_fields
  use contact_and_ties, only: contact_and_ties_t
  use delaminated_regions, only: create_region, delaminated_region_t
  use delamination_parameters, only: law_cohesive
  use errors, only: error_t
  use fields_file, only: fields_file_t
  use front_energy_release, only: front_energy_release_t, release_along_front
  use interface_figures, only: figures_of, interface_figures_t
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use motions, only: motion_t
  use joined_stacks, only: joined_stacks_of
  use onset_index, only: onset_of_elements
  use output_parameters, only: output_t, field_gap, field_contact_pressure, field_delamination, field_energy_release, &
                               field_onset
  use projected_areas, only: area_dissipated, area_rules, projected_areas_of
  use result_tables, only: result_row_length
  implicit none
  private
  public :: delaminated_above, starters_above, write_interface_fields

  !> The fields. A new one needs a row here, its output below, and a choice of &output.
  character(len=result_row_length), parameter, public :: interface_field_rows(*) = &
    [character(len=result_row_length) :: &
    'jump | points | length | '//field_gap//' | &delamination | Relative displacement across the interface on top of &
      &a layer, lower minus upper surface; its z component is the gap.', &
    'contact_pressure | points | pressure | '//field_contact_pressure//' | &delamination | Contact pressure in the &
      &interface on top of a layer.', &
    'delaminated_above | cells | - | '//field_delamination//' | &delamination | 1 in elements whose interface on top &
      &has delaminated, else 0; with a cohesive law the dissipated fraction of its toughness.', &
    'damage_above | points | - | '//field_delamination//' | &delamination | Damage of the cohesive interface on top of &
      &a layer: relative loss of its stiffness, 0 to 1; 0 where fronts release ties.', &
    'dissipated_above | points | - | '//field_delamination//' | &delamination | Fraction of the toughness &
      &dissipated by the cohesive interface on top of a layer, 0 to 1: its integral is the delaminated area.', &
    'shear_share_above | points | - | '//field_delamination//' | &delamination | Fraction of shear in the energy of &
      &the cohesive interface on top of a layer (mode mixture).', &
    'energy_release_above | cells | - | '//field_energy_release//' | &delamination | G/G_c of the interface on top in &
      &the intact elements next to a front, 0 elsewhere.', &
    'onset_index | cells | - | '//field_onset//' | - | Largest index of interlaminar stress in and on top of an &
      &element, quadratic in shear and opening over their strengths; stresses by equilibrium through tied layers.', &
    'onset_ply | cells | - | '//field_onset//' | - | Ply above the interface where onset_index is reached; 0 if no &
      &strength is known.']

contains

  !> Writes the requested fields.
  subroutine write_interface_fields(plate, stiffness, interfaces, motion, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(interface_state_t), intent(in) :: interfaces
    type(motion_t), intent(in) :: motion
    type(output_t), intent(in) :: output
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(inout) :: error

    if (output%requests(field_onset)) call write_onset(plate, stiffness, interfaces, motion, fields, error)
    if (.not. plate%map%layered) return
    associate (contact => interfaces%contact)
      if (output%requests(field_gap)) call fields%write_point_field('jump', merge(motion%displacement(1:3, :), 0.0_wp, &
                                                                             spread(plate%zone > 0, 1, 3)), error)
      if (output%requests(field_contact_pressure)) &
        call fields%write_point_field('contact_pressure', reshape(contact%pressure + interfaces%cohesive%pressure( &
          plate, motion%displacement), [1, size(plate%zone)]), error)
      if (output%requests(field_delamination)) then
        call fields%write_cell_field('delaminated_above', delaminated_above(plate, interfaces), error)
        call fields%write_point_field('damage_above', reshape(interfaces%cohesive%damage(plate), &
                                                              [1, size(plate%zone)]), error)
        call fields%write_point_field('dissipated_above', reshape(interfaces%cohesive%dissipated_fractions(plate), &
                                                                  [1, size(plate%zone)]), error)
        call fields%write_point_field('shear_share_above', reshape(interfaces%cohesive%shear_share( &
          plate, motion%displacement), [1, size(plate%zone)]), error)
        call write_figures(plate, interfaces, fields, error)
      end if
      if (output%requests(field_energy_release)) &
        call fields%write_cell_field('energy_release_above', release_ahead(plate, stiffness, contact, motion), error)
    end associate
  end subroutine write_interface_fields

  !> Writes the quantities of interfaces in history and summary, for pictures at the times of the fields.
  subroutine write_figures(plate, interfaces, fields, error)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(inout) :: error
    type(interface_figures_t) :: figures(size(plate%mesh%zones))
    real(wp) :: bounds(4, size(figures)), areas(area_rules)
    integer :: zone

    figures = figures_of(plate, interfaces)
    do zone = 1, size(figures)
      bounds(:, zone) = reshape(figures(zone)%bounds, [4])
    end do
    call fields%write_figures('ply_above', real(reshape(plate%mesh%zones%below_ply, [1, size(figures)]), wp), error)
    call fields%write_figures('is_cohesive', reshape(merge(1.0_wp, 0.0_wp, plate%setup%delaminations%law == &
                                                           law_cohesive), [1, size(figures)]), error)
    call fields%write_figures('stage', real(reshape(figures%stage, [1, size(figures)]), wp), error)
    call fields%write_figures('area', reshape(figures%area, [1, size(figures)]), error)
    call fields%write_figures('bounds', bounds, error)
    areas = projected_areas_of(plate, interfaces)
    call fields%write_figures('projected_area', reshape([areas(area_dissipated)], [1, 1]), error)
  end subroutine write_figures

  !> Writes the onset index of delamination.
  subroutine write_onset(plate, stiffness, interfaces, motion, fields, error)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(interface_state_t), intent(in) :: interfaces
    type(motion_t), intent(in) :: motion
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: delaminated(:, :), onset(:, :)

    allocate (delaminated(1, plate%elements%elements), source=0.0_wp)
    if (plate%map%layered) delaminated = delaminated_above(plate, interfaces)
    onset = onset_of_elements(plate, joined_stacks_of(plate, stiffness, delaminated, motion%displacement))
    call fields%write_cell_field('onset_index', onset(1:1, :), error)
    call fields%write_cell_field('onset_ply', onset(2:2, :), error)
  end subroutine write_onset

  !> 1 in elements whose interface above has delaminated.
  function delaminated_above(plate, interfaces) result(delaminated)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> 1 or 0, with a cohesive law between them, (1, elements)
    real(wp), allocatable :: delaminated(:, :)
    !> Fractions of an element's area at its nodes
    real(wp), parameter :: simpson(3) = [1, 4, 1]/6.0_wp, weights(9) = [simpson*simpson(1), simpson*simpson(2), &
                                                                        simpson*simpson(3)]
    real(wp), allocatable :: dissipated_fractions(:, :)
    integer :: zone, i, place(2)

    allocate (delaminated(1, plate%elements%elements), source=0.0_wp)
    dissipated_fractions = reshape(interfaces%cohesive%dissipated_fractions(plate), [1, size(plate%zone)])
    call plate%halo%update(dissipated_fractions)
    do i = 1, plate%elements%elements
      associate (mesh => plate%mesh, element => plate%distribution%elements(i))
        place = mesh%place_of(mesh%element_cell(element))
        do zone = 1, size(mesh%zones)
          if (.not. mesh%is_below(element, zone)) cycle
          if (plate%setup%delaminations(zone)%law == law_cohesive) then
            delaminated(1, i) = dot_product(weights, dissipated_fractions(1, plate%distribution%connectivity(:, i)))
          else if (interfaces%contact%regions(zone)%is_delaminated(place(1), place(2))) then
            delaminated(1, i) = 1
          end if
        end do
      end associate
    end do
  end function delaminated_above

  !> 1 in elements whose interface on top was delaminated before the run, else 0.
  function starters_above(plate) result(starters)
    type(composite_plate_t), intent(in) :: plate
    !> (elements)
    integer, allocatable :: starters(:)
    type(delaminated_region_t) :: region
    integer :: zone, i, place(2)

    allocate (starters(plate%elements%elements), source=0)
    associate (mesh => plate%mesh)
      do zone = 1, size(mesh%zones)
        associate (starter => plate%setup%delaminations(zone))
          region = create_region(mesh, zone, starter%starter, starter%starter_strip, starter%starter_round, &
                                 starter%starter_at)
        end associate
        do i = 1, size(starters)
          associate (element => plate%distribution%elements(i))
            if (.not. mesh%is_below(element, zone)) cycle
            place = mesh%place_of(mesh%element_cell(element))
            if (region%is_delaminated(place(1), place(2))) starters(i) = 1
          end associate
        end do
      end do
    end associate
  end function starters_above

  !> Ratio of energy release rate to its critical value in the intact cells ahead of the fronts, zero elsewhere. At the
  !> border of a zone it is given for the last delaminated cell.
  function release_ahead(plate, stiffness, contact, motion) result(ratio)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Delaminated cells
    type(contact_and_ties_t), intent(in) :: contact
    type(motion_t), intent(in) :: motion
    !> G/G_c of the interface above, (1, elements)
    real(wp), allocatable :: ratio(:, :)
    type(front_energy_release_t) :: front
    integer :: zone, s, element, place(2)

    allocate (ratio(1, plate%elements%elements), source=0.0_wp)
    do zone = 1, size(plate%mesh%zones)
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      front = release_along_front(plate, stiffness, contact, motion, zone, &
                                  plate%setup%delaminations(zone)%energy_release)
      do s = 1, size(front%segments)
        place = merge(front%segments(s)%inside, front%segments(s)%outside, front%segments(s)%at_border)
        element = plate%distribution%local_element(plate%mesh%element_at( &
                  plate%mesh%cell_at(place(1), place(2)), plate%mesh%zones(zone)%below_ply + 1))
        if (element > 0) ratio(1, element) = max(ratio(1, element), front%ratio(s))
      end do
    end do
  end function release_ahead
end module interface_fields
