!> Failure criteria of the plies of one element, from stresses averaged over its nine points (section 3.2 of the paper).
module ply_criteria
  use kinds, only: wp
  use element_batches, only: batch_of, lane_of
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes, stress_at_faces
  use ply_stresses, only: middle_stress, face_stresses, mean_shear_strain
  use failure_criteria, only: chosen_indices
  use models, only: model_t
  implicit none
  private
  public :: failure_measures, strains_of_plies

contains

  !> How near the plies of an element are to each mode of failure, whether or not they failed so before: 1 where the
  !> criterion is met. Roots of the criteria's values, so that they grow with the load.
  function failure_measures(model, stiffness, element, elasticity, strains) result(measures)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Element of this rank
    integer, intent(in) :: element
    !> Present elastic constants of its plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Mean strains of the element
    real(wp), intent(in) :: strains(8)
    !> The measures
    real(wp) :: measures(failure_modes, size(elasticity))
    real(wp), allocatable :: stresses(:, :)
    real(wp) :: local(8)
    integer :: i

    local = strains_of_plies(model, stiffness, element, elasticity, strains)
    measures = 0
    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      do i = 1, size(elasticity)
        associate (ply => model%plies(range(1) + i - 1))
          associate (strength => model%scene%materials(ply%material))
            if (model%scene%ply_damage%stress == stress_at_faces) then
              stresses = face_stresses(ply, elasticity(i), local)
            else
              stresses = spread(middle_stress(ply, elasticity(i), local), 2, 1)
            end if
            measures(:, i) = chosen_indices(model%scene%ply_damage%criteria, strength, stresses)
          end associate
        end associate
      end do
    end associate
    measures = sqrt(max(measures, 0.0_wp))
  end function failure_measures

  !> Strains of an element that the stresses of its plies follow from: its own, but for one transverse shear strain
  !> whose stresses add up to the shear force.
  pure function strains_of_plies(model, stiffness, element, elasticity, strains) result(local)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Element of this rank
    integer, intent(in) :: element
    !> Present elastic constants of its plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Mean strains of the element
    real(wp), intent(in) :: strains(8)
    !> Strains for ply_stress
    real(wp) :: local(8)

    local = strains
    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      local(7:8) = mean_shear_strain(model%plies(range(1):range(2)), elasticity, &
                                     stiffness(lane_of(element), :, batch_of(element)), strains(7:8))
    end associate
  end function strains_of_plies
end module ply_criteria
