!> The set of criteria that the deck chooses: what `ply_criteria` asks in place of `hou_criteria`.
module failure_criteria
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: failure_modes
  use hou_criteria, only: failure_indices
  use hashin_criteria, only: hashin_indices
  implicit none
  private
  public :: chosen_indices

  !> The new set, after `criteria_hou` of ply_damage_parameters.
  integer, parameter, public :: criteria_hashin = 2

contains

  !> Largest value of each criterion over several points of a ply: its middle, or its two faces.
  pure function chosen_indices(criteria, material, stresses) result(indices)
    !> criteria_hou or criteria_hashin
    integer, intent(in) :: criteria
    !> Material of the ply
    type(material_t), intent(in) :: material
    !> Stresses of the points, (5, points)
    real(wp), intent(in) :: stresses(:, :)
    !> Values in the order of the modes
    real(wp) :: indices(failure_modes)
    integer :: point

    indices = -huge(indices)
    do point = 1, size(stresses, 2)
      select case (criteria)
      case (criteria_hashin)
        indices = max(indices, hashin_indices(material, stresses(:, point)))
      case default
        indices = max(indices, failure_indices(material, stresses(:, point)))
      end select
    end do
  end function chosen_indices
end module failure_criteria
