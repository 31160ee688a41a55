!> Remarks on keys of an interface that have no effect.
module delamination_idle_keys
  use deck_problems, only: problems_t
  use deck_remarks, only: remark_idle
  use deck_settings, only: settings_t
  use delamination_parameters, only: contact_continuous_penalty, contact_none, delamination_t, growth_equilibrium, &
                                     law_cohesive, release_vcct, tie_penalty
  use interface_places, only: delamination_group
  implicit none
  private
  public :: remark_idle_keys

  !> Keys that have no effect on a cohesive interface, and on one with a front.
  character(len=*), parameter, public :: fronts_only = 'energy_release growth tie penalty unloading smoothing '// &
                                                       'contact_exponent'
  character(len=*), parameter :: law_only = 'strength_opening strength_shear stiffness friction growth_control '// &
                                            'cracks_as_flaws shear_cracks'

contains

  !> Remarks on keys of an interface without effect.
  subroutine remark_idle_keys(settings, delamination, place, problems)
    type(settings_t), intent(in) :: settings
    !> The interface
    type(delamination_t), intent(in) :: delamination
    !> Index of the group
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    associate (d => delamination)
      if (d%law == law_cohesive) call idle(fronts_only, 'with law = ''cohesive''')
      if (d%law /= law_cohesive) call idle(law_only, 'without law = ''cohesive''')
      if (d%contact == contact_none) call idle('friction', 'as contact = ''none'' lets surfaces penetrate')
      if (.not. d%starter > 0) call idle('starter_shape starter_at', 'without starter')
      if (d%toughness > 0) call idle('eta', 'as G_c is given')
      if (d%law == law_cohesive) return
      if (d%tie /= tie_penalty) call idle('penalty', 'without tie = ''penalty''')
      if (d%contact /= contact_continuous_penalty) &
        call idle('contact_exponent', 'without contact = ''continuous_penalty''')
      if (d%energy_release /= release_vcct .and. d%growth /= growth_equilibrium) &
        call idle('smoothing', 'without energy_release = ''vcct'' or growth = ''equilibrium''')
    end associate

  contains

    !> Remarks on one key.
    subroutine idle(key, reason)
      !> The key
      character(len=*), intent(in) :: key
      !> Reason why it has no effect
      character(len=*), intent(in) :: reason

      call remark_idle(settings, problems, delamination_group, key, 'has no effect '//reason//'.', place)
    end subroutine idle
  end subroutine remark_idle_keys
end module delamination_idle_keys
