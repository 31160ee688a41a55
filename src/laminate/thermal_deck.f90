!> Residual stress in the deck: row of its table, filling and checks.
module thermal_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use material_parameters, only: material_t
  implicit none
  private
  public :: fill_thermal, check_thermal

  !> Name that checks across groups use.
  character(len=*), parameter, public :: thermal_group = 'thermal'
  !> Row of the group.
  character(len=group_row_length), parameter, public :: thermal_group_row = &
    'thermal | optional | Residual stress of plies that were joined at another temperature.'
  !> Row of the key.
  character(len=key_row_length), parameter, public :: thermal_rows(*) = [character(len=key_row_length) :: &
    'thermal | delta_T | real | 1 | temperature | required | any | &
      &Temperature less that at which the plies had no stress; negative after cooling from the cure.']

contains

  !> The change of the temperature.
  subroutine fill_thermal(settings, change)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives it
    real(wp), intent(inout) :: change

    change = settings%real_of(thermal_group, 'delta_T')
  end subroutine fill_thermal

  !> A change of temperature without effect.
  subroutine check_thermal(settings, materials, problems)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> All materials
    type(material_t), intent(in) :: materials(:)
    !> Remarks are added
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (all([(all(abs(materials(i)%expansion) <= 0), i=1, size(materials))])) &
      call remark(settings, problems, thermal_group, '', 'has no effect: no material has alpha1 or alpha2.')
  end subroutine check_thermal
end module thermal_deck
