!> Errors of step and mesh for a setup, by preliminary elastic impacts: the largest step and elements for a permitted
!> error of peak force and history.
module setup_elastic_impacts
  use kinds, only: wp
  use mathematical_constants, only: pi
  use modal_plates, only: modal_plate_t, reduced
  use elastic_impacts, only: elastic_impact_t, run_elastic_impact, difference, bound_of_difference, &
                             difference_at_peak, figures_of
  use setup_scales, only: setup_scales_t, plate_modes, contact_side
  use setups, only: setup_t
  implicit none
  private
  public :: setup_elastic_impact_t, expected_scales_t, start_elastic_impact, run_of, contact_end, largest_step, &
            largest_cell, expected_scales_of, with_scaled_inertia

  !> A setup prepared for preliminary elastic impacts.
  type :: setup_elastic_impact_t
    type(setup_t) :: setup
    !> Its scales
    type(setup_scales_t) :: scales
    !> The plate with all modes that any of the steps considered resolves
    type(modal_plate_t) :: plate
  end type setup_elastic_impact_t

  !> Expected results of a run with the mesh and step of the deck.
  type :: expected_scales_t
    type(setup_scales_t) :: scales
    !> True: there is an impact, and the other components are valid
    logical :: of_impact = .false.
    !> Largest force, indentation and deflection
    real(wp) :: force = 0, indentation = 0, deflection = 0
    !> Number of contacts
    integer :: contacts = 0
    !> End of the last contact with a force above 1 % of the peak, and of any contact
    real(wp) :: last_contact = 0, last_touch = 0
    !> True: it ends later, as the calculation ends in contact
    logical :: is_cut = .false.
    !> Side of the elements near the struck point
    real(wp) :: edge = 0
    !> Relative errors of the force's peak and history, by the step and by the mesh; negative: not known
    real(wp) :: step_error(2) = -1, mesh_error(2) = -1
    !> Errors by step, mesh and scaled inertia together of the results in a summary, in the order of `figures_of`;
    !> negative: not known
    real(wp) :: figure_error(5) = -1
    !> Side of the area that carries the contact force, and effect of a larger patch on peak and history
    real(wp) :: contact_side = 0, patch_error(2) = -1
  end type expected_scales_t

  !> Modes are listed up to this circular frequency times the step, 1.3 steps per period; higher ones are not resolved
  !> and contribute their static compliance.
  real(wp), parameter :: resolved_angle = 5
  !> Modes with ten and more periods in the rise time of first contact respond quasi-statically. With a finer step that
  !> resolved more modes the errors in the decks of `input/` differed by less than 1 %, and the forces did not.
  real(wp), parameter :: excited = 60
  !> Number of steps of the first elastic impact in one contact time. For the finest one it is divided by the root of
  !> the permitted error: the method is of second order, and the error of a step of a tenth of the contact time is about
  !> 1 %.
  real(wp), parameter :: first_steps = 2, fine_steps = 4.5_wp
  !> Number of steps in one contact time up to which modes are stored.
  real(wp), parameter :: max_fine = 128
  !> Largest number of steps of an elastic impact: they take a tenth of a second, while a run with as many steps takes
  !> hours.
  integer, parameter :: max_steps = 262144
  !> Smallest number of steps per contact.
  integer, parameter :: min_steps = 24
  !> Elements in a wave of first contact with an error of 1 %, and the power of the error that their side grows with.
  !> With 3.1 and 3.5 the peak of two random setups was 1.33 and 1.09 % off; the history's error falls with the power
  !> 3.6 of their number.
  real(wp), parameter :: wave_elements = 4.5_wp, wave_power = 1/3.6_wp
  !> Smallest number of elements per wave for which this is valid.
  real(wp), parameter :: fewest_elements = 3.1_wp
  !> Relative error of a mode's frequency on elements of side e divided by (kappa e)**4, with its wave number kappa.
  !> Calibrated by `tests/bench/elastic_models.py`.
  real(wp), parameter :: dispersion = 6.0e-4_wp
  !> Longest first elastic impact, in half periods of the impactor on the static stiffness of the plate: twice the
  !> contact time; repeated contacts lasted up to 1.4 half periods.
  real(wp), parameter :: waited = 4.5_wp

contains

  !> Prepares a setup for preliminary elastic impacts.
  pure function start_elastic_impact(setup, scales) result(elastic)
    !> The setup, with an impactor that has a velocity
    type(setup_t), intent(in) :: setup
    type(setup_scales_t), intent(in) :: scales
    type(setup_elastic_impact_t) :: elastic

    elastic = setup_elastic_impact_t(setup, scales, plate_modes(setup, resolved_angle*max_fine/scales%contact_time))
  end function start_elastic_impact

  !> A preliminary elastic impact with a given step; `complete` is false if it would take too many steps.
  pure function run_of(self, step, end, cell) result(run)
    type(setup_elastic_impact_t), intent(in) :: self
    real(wp), intent(in) :: step
    !> End; 0: that of the contact
    real(wp), intent(in) :: end
    !> Side of the elements; 0: infinitely fine
    real(wp), intent(in) :: cell
    type(elastic_impact_t) :: run
    type(modal_plate_t) :: plate
    integer :: steps

    plate = reduced(self%plate, resolved_angle/step)
    ! Modes too short for the elements become so stiff that they do not contribute.
    if (cell > 0) plate%frequency = plate%frequency*(1 + dispersion*maxval(plate%wave_number*cell, 1)**4)
    steps = max_steps
    if (end > 0) steps = min(steps, max(1, nint(end/step)))
    run = run_elastic_impact(plate, self%setup%impactor, self%setup%impactor%indentation, step, steps, end > 0)
    if (end > 0) run%complete = steps >= nint(end/step)
  end function run_of

  !> The contact from first contact to its end by a first, coarse elastic impact, no longer than the run. Its steps are
  !> longer where a heavy impactor remains on the plate for a long time.
  pure function contact_end(self, end) result(run)
    type(setup_elastic_impact_t), intent(in) :: self
    !> End of the run; 0: not known
    real(wp), intent(in) :: end
    type(elastic_impact_t) :: run
    real(wp) :: horizon

    horizon = end
    if (.not. end > 0) horizon = waited*pi*sqrt(self%setup%impactor%mass*self%scales%compliance)
    run = run_of(self, max(self%scales%contact_time/first_steps, horizon/max_steps), end, 0.0_wp)
  end function contact_end

  !> Expected results with given step and elements. The method is of second order in the step.
  pure function expected_scales_of(setup, scales, step, end, edge, scaling) result(expected)
    !> The setup, with an impactor that has a velocity
    type(setup_t), intent(in) :: setup
    type(setup_scales_t), intent(in) :: scales
    !> Step and end of the run
    real(wp), intent(in) :: step, end
    !> Side of the elements near the struck point
    real(wp), intent(in) :: edge
    !> Factor of rotary inertia of the run, 1 if absent
    real(wp), intent(in), optional :: scaling
    !> Forces, times and errors
    type(expected_scales_t) :: expected
    type(setup_elastic_impact_t) :: elastic
    type(elastic_impact_t) :: coarse, fine, meshed, scaled(2)

    expected%of_impact = .true.
    expected%edge = edge
    elastic = setup_elastic_impact_t(setup, scales, &
                                     plate_modes(setup, max(resolved_angle/step, min(2*resolved_angle/step, &
                                                                                     excited/scales%contact_time))))
    coarse = run_of(elastic, step, end, 0.0_wp)
    if (nint(end/(step/2)) <= max_steps) then
      fine = run_of(elastic, step/2, end, 0.0_wp)
      expected%step_error = difference(coarse, fine, 2)*4/3
    else
      fine = coarse
    end if
    if (coarse%complete) then
      meshed = run_of(elastic, step, end, edge)
      expected%mesh_error = difference(meshed, coarse, 1)
      scaled = coarse
      if (present(scaling)) then
        if (scaling > 1) scaled = [with_scaled_inertia(elastic, scaling, step, end), &
                                   with_scaled_inertia(elastic, 2*scaling - 1, step, end)]
      end if
      if (expected%step_error(1) >= 0) &
        expected%figure_error = errors_of_figures(scales, edge, coarse, fine, meshed, scaled)
    end if
    expected%force = fine%peak
    expected%indentation = fine%indentation
    expected%deflection = fine%deflection
    expected%contacts = fine%contacts
    expected%last_contact = fine%last_contact
    expected%last_touch = fine%last_touch
    expected%is_cut = fine%is_cut
    expected%contact_side = contact_side(setup, fine%indentation)
    if (.not. setup%mesh%patch > expected%contact_side) return
    elastic%setup%mesh%patch = expected%contact_side
    elastic%plate = plate_modes(elastic%setup, resolved_angle/step)
    expected%patch_error = difference(run_of(elastic, step, end, 0.0_wp), coarse, 1)
  end function expected_scales_of

  !> The elastic impact with the scaled rotary inertia of a run.
  pure function with_scaled_inertia(elastic, scaling, step, end) result(run)
    type(setup_elastic_impact_t), intent(in) :: elastic
    !> The factor
    real(wp), intent(in) :: scaling
    !> Step and end of the run
    real(wp), intent(in) :: step, end
    type(elastic_impact_t) :: run

    run = run_of(setup_elastic_impact_t(elastic%setup, elastic%scales, &
                                        plate_modes(elastic%setup, maxval(elastic%plate%frequency), scaling)), &
                 step, end, 0.0_wp)
  end function with_scaled_inertia

  !> Errors by step, mesh and scaled inertia together of the results of a summary. The change by scaled inertia is the
  !> larger one of those with the added inertia and with twice that: the scaled in-plane inertia is not in the modes,
  !> and changes of vibrations may cancel in a peak. The error of the largest force is at least the root mean square
  !> error of the forces around it and, where the force of first contact is the largest, the error of its waves in the
  !> elements around the patch.
  pure function errors_of_figures(scales, edge, coarse, fine, meshed, scaled) result(errors)
    type(setup_scales_t), intent(in) :: scales
    !> Side of the elements near the struck point
    real(wp), intent(in) :: edge
    !> Elastic impacts with the step of the run, with half of it, and with the mesh
    type(elastic_impact_t), intent(in) :: coarse, fine, meshed
    !> With the scaled rotary inertia, and with twice the added inertia
    type(elastic_impact_t), intent(in) :: scaled(2)
    !> In the order of `figures_of`
    real(wp) :: errors(5)
    integer :: beside, at

    errors = abs(figures_of(coarse) - figures_of(fine))*4/3 + abs(figures_of(meshed) - figures_of(coarse)) + &
             max(abs(figures_of(scaled(1)) - figures_of(coarse)), &
                 abs(figures_of(scaled(2)) - figures_of(coarse)))
    beside = nint(scales%contact_time/(2*coarse%step))
    errors(1) = max(errors(1), hypot(difference_at_peak(coarse, fine, 2, beside)*4/3, &
                                     difference_at_peak(meshed, coarse, 1, beside)))
    at = maxloc(fine%force, 1)
    if (all(fine%force(2:at) >= fine%force(:at - 1))) &
      errors(1) = max(errors(1), fine%peak*error_with(scales, edge))
  end function errors_of_figures

  !> Relative error of the force of first contact with such elements: the inverse of the side in `largest_cell`.
  pure real(wp) function error_with(scales, edge) result(error)
    type(setup_scales_t), intent(in) :: scales
    !> Side of the elements
    real(wp), intent(in) :: edge

    error = (wave_elements*min(edge/scales%wave_length, 1/fewest_elements))**(1/wave_power)/200
  end function error_with

  !> The largest step with errors within bounds.
  pure subroutine largest_step(self, end, bounds, step, error)
    type(setup_elastic_impact_t), intent(in) :: self
    !> End of the time considered
    real(wp), intent(in) :: end
    !> Relative errors of peak and history allowed
    real(wp), intent(in) :: bounds(2)
    real(wp), intent(out) :: step
    real(wp), intent(out) :: error(2)
    type(elastic_impact_t) :: finest, coarse
    real(wp) :: longer
    integer :: finer, steps, ratio

    ! The errors of coarse elastic impacts may cancel in their difference, so each is compared with the finest possible
    ! one.
    finer = 1
    do while (2*2**finer*min_steps <= max_steps)
      if (2**finer*min_steps*self%scales%contact_time >= fine_steps/sqrt(bounds(1))*end) exit
      finer = finer + 1
    end do
    ratio = 2**finer
    finest = run_of(self, end/(ratio*min_steps), end, 0.0_wp)
    do
      steps = min_steps*2**finer/ratio
      step = end/steps
      error = bound_of_difference(run_of(self, step, end, 0.0_wp), finest, ratio)/(1 - 1/real(ratio, wp)**2)
      if (all(error <= bounds) .or. ratio == 2) exit
      ratio = ratio/2
    end do
    if (all(error <= bounds)) then
      longer = end/ceiling(end/(step*min(1.5_wp, sqrt(minval(bounds/max(error, tiny(1.0_wp)))))))
      ! The sampled peak depends on the times of the steps, too, so that its error is not a smooth function of the step.
      coarse = run_of(self, longer, end, 0.0_wp)
      if (abs(coarse%peak/finest%peak - 1) <= bounds(1)) step = longer
    else if (finest%complete) then
      ! The error of the finest one is smaller by the order of the method.
      step = finest%step
      error = error/4
    else
      error = -1
    end if
  end subroutine largest_step

  !> The largest elements with errors within bounds.
  pure function largest_cell(self, step, end, bounds, follows) result(cell)
    type(setup_elastic_impact_t), intent(in) :: self
    real(wp), intent(in) :: step
    !> End of the time considered
    real(wp), intent(in) :: end
    !> Relative errors of peak and history allowed
    real(wp), intent(in) :: bounds(2)
    !> True: the step resolves the impact within these bounds; a longer one gives no information on the elements
    logical, intent(in) :: follows
    !> Side of the elements
    real(wp) :: cell
    type(elastic_impact_t) :: exact
    ! Elements are at most a sixth finer than needed, which is less than the error of the estimate.
    real(wp), parameter :: finer = 0.85_wp
    real(wp) :: longer

    longer = 1
    if (follows) longer = max(1.0_wp, first_steps*step/self%scales%contact_time)
    exact = run_of(self, step, end, 0.0_wp)
    ! Modes give the error of waves on the mesh, but not that of the first waves in the elements around the patch. Steps
    ! longer than the rise time do not resolve the first waves; the shortest resolved waves are longer by the root of
    ! the ratio.
    cell = min(minval(self%setup%plate%length)/4, &
               self%scales%wave_length/wave_elements*(200*bounds(1))**wave_power*sqrt(longer))
    do while (cell > self%scales%wave_length/20)
      if (all(bound_of_difference(run_of(self, step, end, cell), exact, 1) <= bounds)) exit
      cell = cell*finer
    end do
  end function largest_cell
end module setup_elastic_impacts
