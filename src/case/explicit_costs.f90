!> Cost of a run by central differences: steps and processor time.
module explicit_costs
  use contact_durations, only: stiffened_duration
  use deck_contents, only: deck_t
  use elastic_impacts, only: elastic_impact_t
  use element_steps, only: smallest_element_step
  use kinds, only: wp
  use mathematical_constants, only: pi
  use model_sizes, only: model_size_t
  use nose_steps, only: steps_below_nose
  use delamination_parameters, only: law_cohesive
  use plate_options, only: kinematics_von_karman
  use setup_elastic_impacts, only: contact_end, start_elastic_impact
  use setup_scales, only: free_span
  use step_timings, only: measured_element_time
  use stepping_parameters, only: end_of_run
  use text, only: counted, rounded_text, to_text
  use time_deck, only: key_step, time_group
  use usual_units, only: in_usual_unit, time_kind
  implicit none
  private
  public :: expected_steps, explicit_sentence, duration_text, untaken_step

contains

  !> Sentence on the steps and the time of a run.
  function explicit_sentence(deck, model_size) result(sentence)
    type(deck_t), intent(in) :: deck
    type(model_size_t), intent(in) :: model_size
    character(len=:), allocatable :: sentence
    real(wp) :: end, steps, step, seconds
    character(len=:), allocatable :: bound, time_bound
    logical :: lengthened

    end = expected_end(deck)
    steps = expected_steps(deck)
    step = end/steps
    bound = ''
    if (model_size%at_most) bound = 'at most '
    ! Damage lengthens the contact by a time that is known roughly.
    lengthened = deck%stepping%time%extends_to_contact_end .and. &
                 (any(deck%setup%delaminations%law == law_cohesive) .or. deck%setup%has_crack_bands())
    time_bound = bound
    if (lengthened) time_bound = 'about '
    seconds = measured_element_time(deck)
    sentence = 'About '//counted(rounded_text(max(1.0_wp, anint(steps))), 'step')//' of '// &
               in_usual_unit(step, time_kind, deck%case%units)//' for '// &
               bound//counted(rounded_text(model_size%elements), 'element')//' of all layers: '// &
               time_bound//duration_text(seconds*steps*model_size%elements)//' of one processor'
    if (deck%setup%has_crack_bands()) sentence = sentence//' as long as plies do not soften'
    if (lengthened) sentence = sentence//'; damage may change the number of steps by a third'
    sentence = sentence//'.'
  end function explicit_sentence

  !> Expected number of steps of a run. Below a nose more are taken during contact; the squares of frequencies by slopes
  !> and by the contact are added.
  real(wp) function expected_steps(deck) result(steps)
    type(deck_t), intent(in) :: deck
    real(wp) :: end, contact, slopes

    end = expected_end(deck)
    slopes = shortened(deck)
    contact = 0
    if (deck%setup%is_impact()) contact = min(end, deck%expected%last_touch)
    if (deck%expected%is_cut) contact = end
    steps = ((end - contact)*slopes + contact*sqrt(slopes**2 + steps_below_nose(deck)**2 - 1))/deck%stepping%time%step
  end function expected_steps

  !> Expected end of a run: that of the deck, or later where the run continues until the impactor has left and the plate
  !> is at rest. A contact longer than the deck's end is found by an elastic impact of its own.
  real(wp) function expected_end(deck) result(end)
    type(deck_t), intent(in) :: deck
    type(elastic_impact_t) :: elastic

    end = deck%stepping%time%end
    if (.not. (deck%setup%is_impact() .and. deck%expected%of_impact)) return
    elastic%last_touch = deck%expected%last_touch
    elastic%deflection = deck%expected%deflection
    if (deck%expected%is_cut .and. (deck%stepping%central%settle > 0 .or. &
                                    deck%stepping%time%extends_to_contact_end)) &
      elastic = contact_end(start_elastic_impact(deck%setup, deck%expected%scales), 0.0_wp)
    end = end_of_run(deck%stepping, deck%setup%loading%start + stiffened_duration(deck%setup, deck%expected%scales, &
                                                                         elastic%last_touch, elastic%deflection))
  end function expected_end

  !> Sentence on the step of the deck where it is longer than the step that is used; otherwise empty.
  function untaken_step(deck, step) result(sentence)
    type(deck_t), intent(in) :: deck
    !> The step that is used
    real(wp), intent(in) :: step
    character(len=:), allocatable :: sentence
    real(wp) :: given

    sentence = ''
    if (.not. deck%settings%is_given(time_group, key_step)) return
    given = deck%settings%real_of(time_group, key_step)/2**deck%case%refine
    if (given > step) sentence = 'The step of the deck, '// &
      in_usual_unit(given, time_kind, deck%case%units)//', is longer and is not taken.'
  end function untaken_step

  !> Ratio of the stable step of the flat plate to that of the deflected one, with the largest slope of half a sine.
  real(wp) function shortened(deck) result(ratio)
    type(deck_t), intent(in) :: deck
    real(wp) :: slope, steep

    ratio = 1
    if (deck%setup%mesh%kinematics /= kinematics_von_karman) return
    slope = pi*deck%stepping%expected%deflection/minval(free_span(deck%setup))
    steep = smallest_element_step(deck, slope)
    if (steep > 0) ratio = smallest_element_step(deck)/steep
  end function shortened

  !> A time in a suitable unit.
  pure function duration_text(seconds) result(words)
    !> The time in seconds
    real(wp), intent(in) :: seconds
    !> In seconds, minutes or hours
    character(len=:), allocatable :: words

    if (seconds < 100) then
      words = rounded_text(max(1.0_wp, seconds), 2)//' s'
    else if (seconds < 6000) then
      words = to_text(nint(seconds/60))//' min'
    else
      words = to_text(nint(min(seconds/3600, 1.0e9_wp)))//' h'
    end if
  end function duration_text
end module explicit_costs
