!> Output in the deck: rows of its table, assignment and checks.
module output_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use output_parameters, only: output_t, field_displacement, field_rotation, field_velocity, field_gap, &
                               field_contact_pressure, field_delamination, field_energy_release, field_ply_damage
  use kinds, only: wp
  use short_numbers, only: text_at_least
  use text, only: joined, lower_case, to_text, words_of
  implicit none
  private
  public :: fill_output, check_intervals, remark_idle_fields

  !> Names that checks across groups use.
  character(len=*), parameter, public :: output_group = 'output', key_fields_every = 'fields_every', &
                                         key_history_every = 'history_every', key_force_filter = 'force_filter'
  character(len=*), parameter :: group = output_group
  character(len=group_row_length), parameter, public :: output_group_row = &
    'output | settings | Folder of the results, intervals of output, and fields.'
  character(len=key_row_length), parameter, public :: output_rows(*) = [character(len=key_row_length) :: &
    'output | directory | text | 1 | - | ''.'' | not empty | &
      &Folder of the results, made if it is not there; --output overrides it.', &
    'output | history_every | real | 1 | time | = 0, with central differences about 2000 rows | >= 0 | &
      &Time between rows of the history; 0: every accepted step.', &
    'output | fields_every | real | 1 | time | 0 | >= 0 | &
      &Time between fields written; 0: only the last.', &
    'output | checkpoint_every | real | 1 | time | 0 | >= 0 | &
      &Time between checkpoints; 0: only at the end, or when a queue stops the run.', &
    'output | checkpoint_at_end | logical | 1 | - | .true. | .true. .false. | &
      &Whether a checkpoint is written at the end, from which &initial_state of another deck can start.', &
    'output | force_filter | real | 1 | 1/time | none | > 0 | &
      &Corner frequency of the low-pass filter of force_filtered, a Butterworth filter of 4th order. | &
      &&impactor, not &static', &
    'output | fields | choice | 1 or more | - | = all but stresses and onset | displacement rotation velocity gap &
      &contact_pressure delamination energy_release ply_damage stress face_stress onset | Fields, separated by commas.']

  !> Default fields: all but the stresses, which are many, and the onset index.
  character(len=*), parameter :: usual_fields = &
    field_displacement//','//field_rotation//','//field_velocity//','//field_gap//','//field_contact_pressure//','// &
    field_delamination//','//field_energy_release//','//field_ply_damage

  !> Largest number of events of a run, the same as of its steps: default integers reach 2.1e9.
  real(wp), parameter :: max_events = 1.0e8_wp
  !> Ratio of an interval to the step below which the interval is reported: the number of steps is then more than
  !> doubled. It affects a warning only.
  real(wp), parameter :: short = 0.5_wp

contains

  !> The output.
  subroutine fill_output(settings, output)
    !> Keys in effect; receives the default fields
    type(settings_t), intent(inout) :: settings
    type(output_t), intent(inout) :: output

    output%directory = settings%text_of(group, 'directory')
    output%history_every = settings%real_of(group, key_history_every)
    output%fields_every = settings%real_of(group, key_fields_every)
    output%checkpoint_every = settings%real_of(group, 'checkpoint_every')
    output%checkpoint_at_end = settings%logical_of(group, 'checkpoint_at_end')
    output%force_filter = settings%real_of(group, key_force_filter)
    if (.not. settings%is_given(group, 'fields')) call settings%derive(group, 'fields', usual_fields, .true.)
    output%fields = lower_case(joined(words_of(joined(settings%texts_of(group, 'fields'), ','), ','), ','))
  end subroutine fill_output

  !> Reports intervals far below the step, which would shorten every step.
  subroutine check_intervals(settings, step, end, problems)
    type(settings_t), intent(in) :: settings
    !> First step and end of the run
    real(wp), intent(in) :: step, end
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: keys(*) = [character(len=16) :: 'history_every', 'fields_every', 'checkpoint_every']
    real(wp) :: every
    integer :: i

    do i = 1, size(keys)
      every = settings%real_of(group, trim(keys(i)))
      if (.not. every > 0) cycle
      if (end > max_events*every) then
        call report(settings, problems, group, trim(keys(i)), 'makes more than '//to_text(max_events)//' steps; '// &
                  'allowed: from '//text_at_least(end/max_events)//'.')
      else if (every < short*step) then
        call remark(settings, problems, group, trim(keys(i)), 'every step becomes that short, '// &
                    to_text(nint(step/every))//' times as many as with steps of '//to_text(step)//'.')
      end if
    end do
  end subroutine check_intervals

  !> Remarks on requested fields of physics that is not modelled.
  subroutine remark_idle_fields(settings, output, has_interfaces, has_ply_damage, problems)
    type(settings_t), intent(in) :: settings
    type(output_t), intent(in) :: output
    !> True: there are interfaces that may delaminate
    logical, intent(in) :: has_interfaces
    !> True: plies may fail
    logical, intent(in) :: has_ply_damage
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: of_interfaces(*) = [character(len=16) :: field_gap, field_contact_pressure, &
                                                       field_delamination, field_energy_release]
    integer :: i

    if (.not. (settings%is_given(group, 'fields') .and. settings%is_known(group, 'fields'))) return
    do i = 1, size(of_interfaces)
      if (.not. has_interfaces) call idle(trim(of_interfaces(i)), '&delamination')
    end do
    if (.not. has_ply_damage) call idle(field_ply_damage, '&ply_damage')

  contains

    !> Remarks on one field.
    subroutine idle(field, needed)
      !> The field
      character(len=*), intent(in) :: field
      !> The group it needs
      character(len=*), intent(in) :: needed

      if (output%requests(field)) call remark(settings, problems, group, 'fields', ''''//field// &
                                           ''' has no effect without '//needed//'.')
    end subroutine idle
  end subroutine remark_idle_fields
end module output_deck
