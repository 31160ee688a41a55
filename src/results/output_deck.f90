!> What is written, how often and where in the deck: rows of its table, filling and checks.
module output_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use output_parameters, only: output_t, field_displacement, field_rotation, field_velocity, field_gap, &
                               field_contact_pressure, field_delamination, field_energy_release, field_ply_damage
  use text, only: joined, lower_case, words_of
  implicit none
  private
  public :: fill_output, remark_idle_fields

  character(len=*), parameter :: group = 'output'
  !> Row of the group.
  character(len=group_row_length), parameter, public :: output_group_row = &
    'output | settings | What is written, how often and where.'
  !> Rows of the keys.
  character(len=key_row_length), parameter, public :: output_rows(*) = [character(len=key_row_length) :: &
    'output | directory | text | 1 | - | ''.'' | not empty | &
      &Folder of the results, made if it isn''t there; --output overrides it.', &
    'output | history_every | real | 1 | time | 0 | >= 0 | &
      &Time between rows of the history; 0: every accepted step.', &
    'output | fields_every | real | 1 | time | 0 | >= 0 | &
      &Time between fields written; 0: only the last.', &
    'output | checkpoint_every | real | 1 | time | 0 | >= 0 | &
      &Time between checkpoints; 0: only when a queue stops the run.', &
    'output | fields | choice | 1 or more | - | = all but the stresses | displacement rotation velocity gap &
      &contact_pressure delamination energy_release ply_damage stress face_stress | Fields written, parted by commas.']

  !> Fields written unless the deck chooses: all but the stresses, which are many.
  character(len=*), parameter :: usual_fields = &
    field_displacement//','//field_rotation//','//field_velocity//','//field_gap//','//field_contact_pressure//','// &
    field_delamination//','//field_energy_release//','//field_ply_damage

contains

  !> What is written.
  subroutine fill_output(settings, output)
    !> Keys in effect; gets the fields that are usual
    type(settings_t), intent(inout) :: settings
    !> Receives them
    type(output_t), intent(inout) :: output

    output%directory = settings%text_of(group, 'directory')
    output%history_every = settings%real_of(group, 'history_every')
    output%fields_every = settings%real_of(group, 'fields_every')
    output%checkpoint_every = settings%real_of(group, 'checkpoint_every')
    if (.not. settings%is_given(group, 'fields')) call settings%derive(group, 'fields', usual_fields, .true.)
    output%fields = lower_case(joined(words_of(joined(settings%texts_of(group, 'fields'), ','), ','), ','))
  end subroutine fill_output

  !> Fields that are asked for but belong to physics that isn't modelled.
  subroutine remark_idle_fields(settings, output, has_interfaces, has_ply_damage, problems)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> What is written
    type(output_t), intent(in) :: output
    !> True: there are interfaces that may delaminate
    logical, intent(in) :: has_interfaces
    !> True: plies may fail
    logical, intent(in) :: has_ply_damage
    !> Remarks are added
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

      if (output%wants(field)) call remark(settings, problems, group, 'fields', ''''//field// &
                                           ''' has no effect without '//needed//'.')
    end subroutine idle
  end subroutine remark_idle_fields
end module output_deck
