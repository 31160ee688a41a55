!> What is written, how often and where: from the deck into its parameters.
module deck_output
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use text, only: joined, lower_case, words_of
  implicit none
  private
  public :: fill_output

  !> Fields written unless the deck chooses: all but the stresses, which are many.
  character(len=*), parameter :: usual_fields = 'displacement,rotation,velocity,gap,contact_pressure,delamination,'// &
                                                'energy_release,ply_damage'

contains

  !> Fills the parameters of the output.
  subroutine fill_output(deck, problems)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Remarks are added
    type(problems_t), intent(inout) :: problems

    associate (s => deck%settings, output => deck%output)
      output%directory = s%text_of('output', 'directory')
      output%history_every = s%real_of('output', 'history_every')
      output%fields_every = s%real_of('output', 'fields_every')
      output%checkpoint_every = s%real_of('output', 'checkpoint_every')
      if (.not. s%is_given('output', 'fields')) call s%derive('output', 'fields', usual_fields, .true.)
      output%fields = lower_case(joined(words_of(joined(s%texts_of('output', 'fields'), ','), ','), ','))
      if (s%is_given('output', 'fields') .and. s%is_known('output', 'fields')) call remark_idle_fields(deck, problems)
    end associate
  end subroutine fill_output

  !> Fields that are asked for but belong to physics that isn't modelled.
  subroutine remark_idle_fields(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Remarks are added
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: of_interfaces(*) = [character(len=16) :: 'gap', 'contact_pressure', &
                                                       'delamination', 'energy_release']
    integer :: i

    do i = 1, size(of_interfaces)
      if (.not. deck%settings%has_group('delamination')) call idle(trim(of_interfaces(i)), '&delamination')
    end do
    if (.not. deck%has_ply_damage) call idle('ply_damage', '&ply_damage')

  contains

    !> Remarks on one field.
    subroutine idle(field, group)
      !> The field
      character(len=*), intent(in) :: field
      !> The group it needs
      character(len=*), intent(in) :: group

      if (deck%output%wants(field)) call remark(deck%settings, problems, 'output', 'fields', ''''//field// &
                                                ''' has no effect without '//group//'.')
    end subroutine idle
  end subroutine remark_idle_fields
end module deck_output
