!> Mesh, step and output intervals by the requested accuracy, where the deck does not give them.
module deck_accuracy
  use case_deck, only: case_group, key_accuracy, has_accuracy
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_process_zones, only: shortest_shear_zone
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use impact_parameters, only: integrator_trapezoidal
  use impactor_deck, only: impactor_group, key_integrator
  use kinds, only: wp
  use mesh_deck, only: mesh_group, key_elements, key_patch, key_core, key_cell, key_grading, fill_mesh
  use mesh_parameters, only: is_halved
  use output_deck, only: output_group, key_fields_every
  use elastic_impacts, only: elastic_impact_t
  use growth_errors, only: cells_for_area
  use setup_elastic_impacts, only: setup_elastic_impact_t, start_elastic_impact, contact_end, largest_step, largest_cell
  use setup_scales, only: setup_scales_t, scales_of, contact_side
  use short_numbers, only: short_text
  use stepping_parameters, only: is_explicit, past_contact
  use text, only: line_t, append, counted, to_text
  use time_deck, only: time_group, key_end, key_step
  implicit none
  private
  public :: check_left_out, choose_by_accuracy

  !> Ratio of the permitted error of the history to that of the peak: 3 % and 1 %, as a small shift in time changes a
  !> steep history more than its peak (doc/studies/speed.md). Half of each is permitted for the mesh, half for the step.
  real(wp), parameter :: history_over_peak = 3, share = 0.5_wp
  !> Largest number of elements from the plate's centre to an edge, twice that from edge to edge, with
  !> factorizations and without: more take hours. Central differences take about .2 us an element and step
  !> (doc/performance.md): 1e5 steps of 400 x 400 elements are an hour.
  integer, parameter :: max_factored = 100, max_explicit = 400
  !> Extent of the core with the required elements on either side of the patch, in wavelengths of first contact, if
  !> these elements are too many for the full plate. On random model 9 of `tests/bench/elastic_models.py` the error of
  !> the first peak is 2.9 % without, 0.3 % with one wave, 0.03 % with two.
  real(wp), parameter :: core_waves = 2
  !> Elements across the smaller side of the zone of an interface that may delaminate.
  integer, parameter :: zone_elements = 24
  !> Number of times at which fields are written in a run, and the largest accuracy, %, with which they are written:
  !> they would take half of the time of a draft.
  integer, parameter :: fields_written = 10
  !> Between a draft, 5 %, and the standard, 1 %.
  real(wp), parameter :: max_with_fields = 2
  !> Elements in the plate's shorter side and steps in its first period, without an impactor, for an error of 1 %. The
  !> error is of fourth order in the elements: 16 give the first nine frequencies along a side within .6 % (`dispersion`
  !> of `setup_elastic_impacts`). It is of second order in the step: 40 lengthen a period by .2 % (Newmark's method,
  !> (omega h)**2/12), 1 % after five periods.
  real(wp), parameter :: part_of_side = 1.0_wp/16, part_of_period = 1.0_wp/40

contains

  !> Checks keys that are optional only with `accuracy`.
  subroutine check_left_out(settings, needs_lengths, problems)
    type(settings_t), intent(in) :: settings
    !> True: length and end of the steps are needed
    logical, intent(in) :: needs_lengths
    type(problems_t), intent(inout) :: problems

    if (has_accuracy(settings)) return
    if (settings%has_group(mesh_group)) then
      call require(mesh_group, key_elements, '2 integers >= 2')
    else if (.not. problems%concern(mesh_group)) then
      call problems%error(0, mesh_group, '', '&'//mesh_group//' is missing; `implam explain '//mesh_group// &
                          '` lists its keys.')
    end if
    if (.not. (needs_lengths .and. settings%has_group(time_group))) return
    call require(time_group, key_end, '1 real value > 0')
    call require(time_group, key_step, '1 real value > 0')

  contains

    !> Reports a key that is missing.
    subroutine require(group, key, allowed)
      !> Group and key
      character(len=*), intent(in) :: group, key
      !> Its values
      character(len=*), intent(in) :: allowed

      if (settings%is_given(group, key) .or. problems%concern(group, key)) return
      call problems%error(settings%line_of_group(group), group, key, '&'//group//' '//key//' is missing; allowed: '// &
                          allowed//', or &case accuracy, which chooses it.', 1)
    end subroutine require
  end subroutine check_left_out

  !> Chooses the keys that the deck leaves out, if the keys they depend on are valid.
  subroutine choose_by_accuracy(deck, problems)
    !> Plate, laminate, impactor and interfaces are filled; receives mesh and times
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    type(setup_scales_t) :: scales

    if (problems%errors() > 0) return
    scales = scales_of(deck%setup)
    if (deck%setup%is_impact() .and. scales%area_mass > 0) then
      call choose_for_impact(deck, scales, problems)
    else
      call choose_for_pressure(deck, scales, problems)
    end if
    call fill_mesh(deck%settings, deck%setup%mesh)
  end subroutine choose_by_accuracy

  !> Patch, end, step and mesh of an impact, by preliminary elastic impacts.
  subroutine choose_for_impact(deck, scales, problems)
    type(deck_t), intent(inout) :: deck
    type(setup_scales_t), intent(in) :: scales
    type(problems_t), intent(inout) :: problems
    type(setup_elastic_impact_t) :: elastic
    type(elastic_impact_t) :: first
    real(wp) :: end, step, bounds(2), error(2)
    logical :: follows

    bounds = share*deck%case%accuracy/100*[1.0_wp, history_over_peak]
    end = deck%settings%real_of(time_group, key_end)
    elastic = start_elastic_impact(deck%setup, scales)
    first = contact_end(elastic, end)
    if (.not. deck%setup%mesh%patch > 0) then
      call choose_one(deck, mesh_group, key_patch, &
                      min(contact_side(deck%setup, first%indentation), minval(deck%setup%plate%length)/4))
      deck%setup%mesh%patch = deck%settings%real_of(mesh_group, key_patch)
      call append(deck%reasons, &
                  'Patch '//short_text(deck%setup%mesh%patch)//': the circle of contact at an indentation '// &
                  'of '//short_text(first%indentation)//', spread over the thickness.')
      elastic = start_elastic_impact(deck%setup, scales)
      first = contact_end(elastic, end)
    end if
    deck%stepping%time%extends_to_contact_end = is_explicit(deck%stepping) .and. .not. end > 0
    if (.not. end > 0) then
      call choose_one(deck, time_group, key_end, past_contact*first%last_contact)
      end = deck%settings%real_of(time_group, key_end)
      call append(deck%reasons, 'End '//short_text(end)//': the contact, '//counted(to_text(first%contacts), 'time')// &
                  ', is over at '//short_text(first%last_contact)//' in a preliminary elastic impact by modes.')
    end if
    step = deck%settings%real_of(time_group, key_step)
    follows = .not. step > 0
    if (follows) then
      call largest_step(elastic, end, bounds, step, error)
      if (.not. is_explicit(deck%stepping)) then
        call choose_one(deck, time_group, key_step, step)
        step = deck%settings%real_of(time_group, key_step)
        call append(deck%reasons, 'Step '//short_text(step)//': '//counted(to_text(ceiling(end/step)), 'step')// &
                    '; by preliminary elastic impacts it changes the force history by '// &
                    short_text(100*error(2))//' %.')
      end if
    end if
    if (.not. (is_explicit(deck%stepping) .or. deck%settings%is_given(impactor_group, key_integrator))) then
      ! The integrator of the preliminary elastic impacts, which permits long steps; gear4 would shorten them.
      call deck%settings%choose(impactor_group, key_integrator, [line_t('trapezoidal')], quoted=.true.)
      deck%setup%impactor%integrator = integrator_trapezoidal
    end if
    ! Fields are written at the ends of steps; a draft has only the last.
    if (.not. (deck%settings%is_given(output_group, key_fields_every) .or. deck%case%accuracy > max_with_fields)) &
      call deck%settings%choose(output_group, key_fields_every, &
                                [line_t(to_text(step*max(1, nint(end/step/fields_written))))])
    if (deck%settings%is_given(mesh_group, key_elements)) return
    call choose_elements(deck, largest_cell(elastic, step, min(end, past_contact*first%last_contact), bounds, &
                                            follows), scales, problems)
  end subroutine choose_for_impact

  !> Mesh, and in time the step, of a plate under pressure.
  subroutine choose_for_pressure(deck, scales, problems)
    type(deck_t), intent(inout) :: deck
    type(setup_scales_t), intent(in) :: scales
    type(problems_t), intent(inout) :: problems

    if (.not. deck%settings%is_given(mesh_group, key_elements)) &
      call choose_elements(deck, part_of_side*minval(deck%setup%plate%length)*deck%case%accuracy**0.25_wp, scales, &
                           problems)
    if (deck%setup%is_static()) return
    if (.not. deck%settings%is_given(time_group, key_end)) then
      call problems%error(deck%settings%line_of_group(time_group), time_group, key_end, '&'//time_group//' '// &
                          key_end//' is missing; &case accuracy chooses it where an impactor comes with a velocity.', 1)
    else if (.not. (deck%settings%is_given(time_group, key_step) .or. is_explicit(deck%stepping))) then
      call choose_one(deck, time_group, key_step, part_of_period*scales%first_period*sqrt(deck%case%accuracy))
    end if
  end subroutine choose_for_pressure

  !> Number and grading of elements with a largest side.
  subroutine choose_elements(deck, side, scales, problems)
    type(deck_t), intent(inout) :: deck
    !> Largest side
    real(wp), intent(in) :: side
    type(setup_scales_t), intent(in) :: scales
    type(problems_t), intent(inout) :: problems
    real(wp) :: half(2), cell, length, cells
    integer :: number(2), parts(2), max_along
    type(line_t), allocatable :: words(:)

    parts = merge(1, 2, is_halved(deck%setup%plate%symmetry))
    max_along = merge(max_explicit, max_factored, deck%has_time .and. is_explicit(deck%stepping))
    half = deck%setup%plate%length/2
    cell = side
    if (deck%settings%is_known(mesh_group, key_cell)) cell = max(cell, deck%setup%mesh%cell)
    length = shortest_shear_zone(deck)
    cells = cells_for_area(history_over_peak*deck%case%accuracy)
    if (length > 0) then
      cell = min(cell, length/cells)
    else if (size(deck%setup%delaminations) > 0) then
      cell = min(cell, smallest_zone(deck)/zone_elements)
    end if
    number = max(2, ceiling(min(half/cell, 1.0e6_wp) - 0.01_wp))
    if (deck%setup%mesh%patch > 0) &
      number = max(number, 1 + max(1, ceiling(min((half - deck%setup%mesh%patch/2)/cell, 1.0e6_wp) - 0.01_wp)))
    if (any(number > max_along)) then
      call remark(deck%settings, problems, case_group, key_accuracy, 'requires more than '//to_text(max_along)// &
                  ' elements from the struck point to an edge, which are not chosen; expect larger errors.')
      call choose_core(deck, cell, scales%wave_length)
    end if
    number = min(number, max_along)*parts
    call append(words, to_text(number(1)))
    call append(words, to_text(number(2)))
    call deck%settings%choose(mesh_group, key_elements, words)
    if (.not. deck%settings%is_given(mesh_group, key_grading)) &
      call deck%settings%choose(mesh_group, key_grading, [line_t('1')])
    if (scales%wave_length > 0) then
      call append(deck%reasons, 'Elements of '//short_text(cell)//': the waves of first contact are '// &
                  short_text(scales%wave_length)//' long.')
    end if
    if (length > 0) call append(deck%reasons, 'The shortest process zone of shear, '//short_text(length)// &
                                ' long, has at least '//short_text(cells)//' cells.')
  end subroutine choose_elements

  !> Core of elements of the required size around the struck point, so large that waves of first contact do not leave it
  !> before this contact ends. Across a narrow plate it ends two elements before the edges.
  subroutine choose_core(deck, cell, wave_length)
    type(deck_t), intent(inout) :: deck
    !> Side of the elements
    real(wp), intent(in) :: cell
    !> Length of the waves; 0: no impactor
    real(wp), intent(in) :: wave_length
    type(line_t), allocatable :: words(:)
    real(wp) :: extents(2)

    if (deck%settings%is_known(mesh_group, key_core) .or. deck%settings%is_known(mesh_group, key_cell)) return
    if (size(deck%setup%delaminations) > 0 .or. .not. wave_length > 0) return
    extents = min(deck%setup%mesh%patch + 2*core_waves*wave_length, &
                  deck%setup%plate%length - 2*abs(deck%setup%mesh%struck) - 4*cell)
    if (any(extents <= deck%setup%mesh%patch)) return
    call append(words, short_text(extents(1)))
    call append(words, short_text(extents(2)))
    call deck%settings%choose(mesh_group, key_core, words)
    call choose_one(deck, mesh_group, key_cell, cell)
  end subroutine choose_core

  !> Smallest side of the zones; that of the plate if none is given.
  pure real(wp) function smallest_zone(deck) result(side)
    type(deck_t), intent(in) :: deck
    integer :: i

    side = minval(deck%setup%plate%length)
    do i = 1, size(deck%setup%delaminations)
      if (deck%setup%delaminations(i)%bonds_doublers()) cycle
      if (.not. deck%setup%delaminations(i)%is_adaptive) side = min(side, minval(deck%setup%delaminations(i)%zone))
    end do
  end function smallest_zone

  !> Sets one number, to three digits.
  subroutine choose_one(deck, group, key, value)
    type(deck_t), intent(inout) :: deck
    !> Group and key
    character(len=*), intent(in) :: group, key
    real(wp), intent(in) :: value

    call deck%settings%choose(group, key, [line_t(short_text(value))])
  end subroutine choose_one
end module deck_accuracy
