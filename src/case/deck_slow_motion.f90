!> Load steps of a softening plate may find no equilibrium beyond the limit load. Slow motion in time, and steps
!> controlled by the dissipated energy, pass the limit load. Warnings where this is expected, with the keys to write.
module deck_slow_motion
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delamination_parameters, only: law_cohesive
  use kinds, only: wp
  use short_numbers, only: short_text
  use solver_deck, only: solver_group
  use static_deck, only: key_dissipation, static_group
  implicit none
  private
  public :: check_softening_steps, slow_motion_advice

  !> Periods of the first bending mode in which a travel is quasi-static: its kinetic energy stays below a few per cent
  !> of the work (doc/manual/slow_motion.md).
  integer, parameter :: periods = 20
  !> Factor s of rotary inertia in such a motion. It slows the first bending, of a wave number k = pi/L over the span L,
  !> by the share (s - 1) (k h)**2/24 (theory of explicit steps): 3.7 (h/L)**2, below 1 % from 20 thicknesses on.
  real(wp), parameter :: slow_scaling = 10

contains

  !> Remarks on an impactor in load steps where plies or several interfaces soften.
  subroutine check_softening_steps(deck, problems)
    !> The deck, checked, with its scales
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (problems%errors() > 0 .or. .not. is_pressed(deck)) return
    if (.not. (deck%setup%has_crack_bands() .or. count(deck%setup%delaminations%law == law_cohesive) > 1)) return
    call remark(deck%settings, problems, static_group, '', 'load steps may find no equilibrium where plies or '// &
                'several interfaces soften'//slow_motion(deck)//'.')
  end subroutine check_softening_steps

  !> Sentence on an alternative to a load step without equilibrium.
  function slow_motion_advice(deck) result(clause)
    type(deck_t), intent(in) :: deck
    !> Follows a sentence that ends with a full stop; empty if there is no alternative
    character(len=:), allocatable :: clause

    clause = ''
    if (is_pressed(deck) .and. (deck%setup%ply_damage%is_present .or. size(deck%setup%delaminations) > 0)) then
      clause = ' With softening there may be no equilibrium'//slow_motion(deck)//'.'
    else if (deck%setup%is_static() .and. .not. deck%setup%loading%dissipation > 0 .and. &
             any(deck%setup%delaminations%law == law_cohesive)) then
      clause = ' With a softening interface there may be no equilibrium at this load: use &'//static_group//' '// &
               key_dissipation//' to trace its growth.'
    else if (deck%setup%is_static() .and. any(deck%setup%supports%unilateral)) then
      clause = ' Contact with a frame may take more iterations: give a larger &'//solver_group//' max_iterations.'
    end if
  end function slow_motion_advice

  !> True: load steps of an impactor's travel, on plies whose density is known.
  pure logical function is_pressed(deck)
    type(deck_t), intent(in) :: deck

    is_pressed = deck%setup%presses_impactor() .and. deck%setup%impactor%travel > 0
  end function is_pressed

  !> The keys to write.
  function slow_motion(deck) result(clause)
    type(deck_t), intent(in) :: deck
    !> Continues a sentence
    character(len=:), allocatable :: clause
    real(wp) :: period

    clause = ': press in slow motion, with &time integrator=''central_difference'''
    period = deck%expected%scales%first_period
    if (period > 0) clause = clause//' end='//short_text(periods*period)//' mass_scaling='//short_text(slow_scaling)// &
                             ' in place of &static ('//short_text(period)//' is the period of the first bending mode)'
    if (.not. period > 0) &
      clause = clause//', an end of some periods of the plate and densities in place of &static'
  end function slow_motion
end module deck_slow_motion
