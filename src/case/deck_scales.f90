!> Scales that the setup must resolve, by preliminary elastic impacts, with warnings on mesh and step.
module deck_scales
  use case_deck, only: case_group, key_accuracy
  use cell_grids, only: cells_from_struck
  use cell_lines, only: cell_line_t
  use central_difference_energies, only: min_periods
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delamination_deck, only: key_stiffness
  use interface_flexibility, only: added_share
  use interface_places, only: delamination_group
  use kinds, only: wp
  use mesh_deck, only: mesh_group, key_core, key_elements, key_patch
  use setup_elastic_impacts, only: expected_scales_of
  use setup_scales, only: setup_scales_t, scales_of
  use short_numbers, only: short_text
  use stepping_parameters, only: is_explicit, expected_response_t
  use time_deck, only: key_settle, key_step, time_group
  implicit none
  private
  public :: check_scales

  !> Errors of peak and history, by preliminary elastic impacts, above which a warning is given: 5 % is the error of the
  !> peak with accuracy='draft'; a small shift in time changes a history more. They affect warnings only.
  real(wp), parameter :: error_limits(2) = [0.05_wp, 0.2_wp]
  !> The same for the size of the patch, with twice the limit for the peak, as the effect of the patch is an estimate
  !> itself.
  real(wp), parameter :: patch_error_limits(2) = [0.1_wp, 0.2_wp]
  !> Share of the interfaces in the deflection above which a warning is given. The largest force changes by half as
  !> much, as that of a heavy impactor is proportional to the root of the stiffness: by the limit of the errors.
  real(wp), parameter :: max_interface_share = 2*error_limits(1)
  !> Ratio of estimated to requested error above which it is reported: estimates are 1.2 to 2 times the true errors.
  real(wp), parameter :: max_error_ratio = 1.5_wp
  !> Steps of elastic impacts per rise time of first contact for runs with many more, as by central differences: their
  !> error is below .1 %, and an upper bound of that of the run.
  real(wp), parameter :: fine_steps = 64

contains

  !> Estimates the run, and warns of a step, a mesh and a patch that do not resolve the impact.
  subroutine check_scales(deck, problems)
    !> The deck, checked; receives the expected results
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    type(setup_scales_t) :: scales
    real(wp) :: step

    if (problems%errors() > 0) return
    scales = scales_of(deck%setup)
    if (deck%setup%is_impact()) then
      step = deck%stepping%time%step
      if (is_explicit(deck%stepping)) step = max(step, scales%contact_time/fine_steps)
      deck%expected = expected_scales_of(deck%setup, scales, step, deck%stepping%time%end, &
                                edge_near(deck, merge(scales%wave_length, maxval(deck%setup%plate%length), &
                                                      deck%settings%is_given(mesh_group, key_core) .or. &
                                                      .not. deck%settings%is_known(mesh_group, key_core))), &
                                         deck%stepping%central%mass_scaling)
      associate (o => deck%expected)
        deck%stepping%expected = expected_response_t(scales%contact_time, o%force, o%deflection, o%last_contact)
      end associate
      call check_resolution(deck, problems)
      call check_accuracy(deck, problems)
    end if
    deck%expected%scales = scales
    call check_interface_share(deck, problems)
    if (.not. (deck%has_time .and. is_explicit(deck%stepping))) return
    associate (duration => deck%stepping%central%settle, least => min_periods*scales%first_period)
      if (duration > 0 .and. duration < least) call remark(deck%settings, problems, time_group, key_settle, &
        'is too short to bring the plate to rest: give at least '//short_text(least)//', '// &
        short_text(min_periods)//' periods of the first bending mode.')
    end associate
  end subroutine check_scales

  !> Warns of many interfaces whose initial stiffness makes the plate softer. Their flexibility is inversely
  !> proportional to it.
  subroutine check_interface_share(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    associate (share => added_share(deck%setup, deck%expected%scales%compliance))
      if (share > max_interface_share) call remark(deck%settings, problems, delamination_group, key_stiffness, &
        'of the intact interfaces adds '//short_text(100*share)//' % to the static deflection of the struck point; '// &
        short_text(share/max_interface_share)//' times the stiffness would add '// &
        short_text(100*max_interface_share)//' %.', 1)
    end associate
  end subroutine check_interface_share

  !> Warns of a step, a mesh and a patch that do not resolve the impact.
  subroutine check_resolution(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    associate (o => deck%expected)
      ! A step that the program has chosen keeps the accuracy that the deck requests.
      if (any(o%step_error > error_limits) .and. deck%settings%is_given(time_group, key_step)) &
        call remark(deck%settings, problems, time_group, key_step, &
        'is too long for this impact: by a preliminary elastic impact the error of the largest force '// &
        'would be '//short_text(100*o%step_error(1))//' %, of the history '//short_text(100*o%step_error(2))// &
        ' %; make it shorter, or leave it out with &case accuracy.')
      if (any(o%mesh_error > error_limits)) call remark(deck%settings, problems, mesh_group, key_elements, &
        'are too large for this impact, '//short_text(o%edge)//' near the struck point: by a preliminary elastic '// &
        'impact the error of the largest force would be '//short_text(100*o%mesh_error(1))//' %, of the history '// &
        short_text(100*o%mesh_error(2))//' %; give more, or leave them out with &case accuracy.')
      ! A nose presses where it touches, on a part of the patch too.
      if (any(o%patch_error > patch_error_limits) .and. .not. deck%setup%impactor%spreads) &
        call remark(deck%settings, problems, mesh_group, key_patch, &
        'is larger than the contact, with a force distributed over '//short_text(o%contact_side)// &
        ' in the middle of the thickness: the largest force changes by '//short_text(100*o%patch_error(1))// &
        ' %, its history by '//short_text(100*o%patch_error(2))//' %.')
    end associate
  end subroutine check_resolution

  !> Reports a requested accuracy that mesh and step do not reach, or that cannot be verified because the contact is too
  !> long for preliminary elastic impacts with half the step.
  subroutine check_accuracy(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (.not. deck%case%accuracy > 0) return
    associate (o => deck%expected)
      if (o%step_error(1) < 0 .or. o%mesh_error(1) < 0) then
        call remark(deck%settings, problems, case_group, key_accuracy, 'cannot be verified by preliminary elastic '// &
                    'impacts for this step: the number of steps is too large.')
      else if (100*(o%step_error(1) + o%mesh_error(1)) > max_error_ratio*deck%case%accuracy) then
        call remark(deck%settings, problems, case_group, key_accuracy, 'is not reached: by a preliminary elastic '// &
                    'impact the error of the largest force will be '// &
                    short_text(100*(o%step_error(1) + o%mesh_error(1)))//' %.')
      end if
    end associate
  end subroutine check_accuracy

  !> Mean edge of the elements within a distance of the struck point on both sides, along the direction where it is
  !> longer.
  pure real(wp) function edge_near(deck, distance) result(edge)
    type(deck_t), intent(in) :: deck
    real(wp), intent(in) :: distance
    type(cell_line_t) :: line
    integer :: direction

    edge = 0
    do direction = 1, 2
      line = cells_from_struck(deck%setup%plate, deck%setup%mesh, direction)
      edge = max(edge, line%mean_side(distance))
    end do
  end function edge_near
end module deck_scales
