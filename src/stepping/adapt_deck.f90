!> Adaptive steps and refactorization in the deck: rows of its table and their filling.
module adapt_deck
  use deck_choices, only: code_of
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use stepping_parameters, only: adapt_t, refactor_deflection, refactor_iterations, rule_local_error, rule_stress_rate
  implicit none
  private
  public :: fill_adapt

  !> Names that checks across groups use.
  character(len=*), parameter, public :: adapt_group = 'adapt', key_growth_step = 'growth_step'
  !> Keys that determine the length of adaptive steps.
  character(len=*), parameter, public :: keys_of_lengths = 'rule tolerance stress_change'
  character(len=group_row_length), parameter, public :: adapt_group_row = &
    'adapt | settings | Adaptive time step and the rule for renewing the factored stiffness.'
  character(len=key_row_length), parameter, public :: adapt_rows(*) = [character(len=key_row_length) :: &
    'adapt | on | logical | 1 | - | .true. | .true. .false. | &
      &Whether the time step adapts; without the group: .false.', &
    'adapt | rule | choice | 1 | - | = ''local_error'', with stress_change ''stress_rate'' | stress_rate local_error | &
      &Step control by the stress rate at the struck point, or by the error of each step. | on = .true.', &
    'adapt | tolerance | real | 1 | - | 0.001 | > 0, <= 1 | &
      &Permitted error of a step, as a fraction of the largest force and deflection (local_error). | on = .true.', &
    'adapt | refactor | choice | 1 | - | ''iterations'' | deflection iterations | &
      &When the stiffness is factorized again: as the deflection grows, or as iterations increase.', &
    'adapt | stiffness_update | real | 1 | - | 0.003 | > 0, <= 10 | &
      &Change of the deflection over the thickness, after which the stiffness is factorized again (deflection).', &
    'adapt | stress_change | real | 1 | - | 0.05 | > 0, <= 1 | &
      &Change of the struck point''s stress intended in a step, as a fraction of its largest so far (stress_rate). | &
      &on = .true.', &
    'adapt | iterations | integer | 1 | - | 16 | >= 1, <= 1000 | &
      &Additional iterations with an old factorization after which a new one is computed.', &
    'adapt | growth_step | real | 1 | - | 0.25 | > 0, <= 1 | &
      &Part of a step to which it is shortened after a front has grown; 1: not at all. | &
      &&delamination growth = one_per_step']

contains

  !> Adaptivity; without the group all steps have the length given.
  subroutine fill_adapt(settings, adapt)
    !> Keys in effect; receives the default without the group
    type(settings_t), intent(inout) :: settings
    type(adapt_t), intent(inout) :: adapt

    if (.not. settings%has_group(adapt_group)) call settings%derive(adapt_group, 'on', '.false.', .false.)
    adapt%on = settings%logical_of(adapt_group, 'on')
    if (.not. settings%is_given(adapt_group, 'rule')) call settings%derive(adapt_group, 'rule', &
      trim(merge('stress_rate', 'local_error', settings%is_given(adapt_group, 'stress_change'))), .true.)
    adapt%rule = code_of(settings%text_of(adapt_group, 'rule'), 'stress_rate local_error', &
                         [rule_stress_rate, rule_local_error])
    adapt%tolerance = settings%real_of(adapt_group, 'tolerance')
    adapt%refactor = code_of(settings%text_of(adapt_group, 'refactor'), 'deflection iterations', &
                             [refactor_deflection, refactor_iterations])
    adapt%stiffness_update = settings%real_of(adapt_group, 'stiffness_update')
    adapt%stress_change = settings%real_of(adapt_group, 'stress_change')
    adapt%iterations = settings%integer_of(adapt_group, 'iterations')
    adapt%growth_step = settings%real_of(adapt_group, key_growth_step)
  end subroutine fill_adapt
end module adapt_deck
