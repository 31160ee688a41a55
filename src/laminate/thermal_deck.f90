!> Residual stress in the deck: row of its table, filling and checks.
module thermal_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use material_deck, only: material_group
  use material_parameters, only: largest_strain, material_t
  use text, only: rounded_text
  implicit none
  private
  public :: fill_thermal, check_thermal

  !> Name that checks across groups use.
  character(len=*), parameter, public :: thermal_group = 'thermal'
  character(len=group_row_length), parameter, public :: thermal_group_row = &
    'thermal | optional | Residual stress of the cure.'
  character(len=key_row_length), parameter, public :: thermal_rows(*) = [character(len=key_row_length) :: &
    'thermal | delta_T | real | 1 | temperature | required | any | &
      &Temperature minus the stress-free temperature; negative after cooling from the cure.']

contains

  !> The change of the temperature.
  subroutine fill_thermal(settings, change)
    type(settings_t), intent(in) :: settings
    !> Receives it
    real(wp), intent(inout) :: change

    change = settings%real_of(thermal_group, 'delta_T')
  end subroutine fill_thermal

  !> Warns of a change of temperature without effect, or with strains that are not small, as when expansions are given
  !> in 1e-6 per degree.
  subroutine check_thermal(settings, materials, problems)
    type(settings_t), intent(in) :: settings
    type(material_t), intent(in) :: materials(:)
    type(problems_t), intent(inout) :: problems
    real(wp) :: change
    integer :: i, direction

    if (all([(all(abs(materials(i)%expansion) <= 0), i=1, size(materials))])) &
      call remark(settings, problems, thermal_group, '', 'has no effect: no material has alpha1 or alpha2.')
    change = settings%real_of(thermal_group, 'delta_T')
    do i = 1, size(materials)
      do direction = 1, 2
        if (abs(change*materials(i)%expansion(direction)) > largest_strain) &
          call remark(settings, problems, material_group, merge('alpha1', 'alpha2', direction == 1), &
                      'causes a free strain of '//rounded_text(change*materials(i)%expansion(direction))// &
                      ' with delta_T, but the model assumes small strains; give it per degree, such as 28e-6.', i)
      end do
    end do
  end subroutine check_thermal
end module thermal_deck
