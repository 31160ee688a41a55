!> Failure criteria of the plies of one element, from stresses averaged over its nine points (section 3.2 of the paper).
module ply_criteria
  use kinds, only: wp
  use element_batches, only: batch_of, lane_of
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes, stress_at_faces
  use ply_stresses, only: middle_stress, face_stresses
  use failure_criteria, only: chosen_indices
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: failure_measures, shear_force

contains

  !> Failure indices of the plies of an element in each mode, failed or not: 1 where the criterion is met. They are the
  !> square roots of the criteria, and thus proportional to the load except for the linear terms of crushing after Hou
  !> and Hashin.
  function failure_measures(plate, stiffness, element, elasticity, strains) result(measures)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    integer, intent(in) :: element
    !> Present elastic constants of its plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Mean strains of the element
    real(wp), intent(in) :: strains(8)
    !> The measures
    real(wp) :: measures(failure_modes, size(elasticity))
    real(wp), allocatable :: stresses(:, :)
    real(wp) :: shear(2, size(elasticity))
    integer :: i

    shear = plate%layup%stacks(plate%layup%stack(element))%shear_stresses(shear_force(stiffness, element, strains(7:8)))
    do i = 1, size(elasticity)
      associate (ply => plate%layup%stacks(plate%layup%stack(element))%plies(i), setup => plate%setup)
        if (setup%ply_damage%stress == stress_at_faces) then
          stresses = face_stresses(ply, elasticity(i), strains(:6), shear(:, i))
        else
          stresses = spread(middle_stress(ply, elasticity(i), strains(:6), shear(:, i)), 2, 1)
        end if
        measures(:, i) = chosen_indices(setup%ply_damage%criteria, setup%materials(ply%material), stresses, &
                                        setup%ply_damage%kinking)
      end associate
    end do
    measures = sqrt(max(measures, 0.0_wp))
  end function failure_measures

  !> Shear forces of an element, Q = S gamma.
  pure function shear_force(stiffness, element, strain) result(force)
    real(wp), intent(in) :: stiffness(:, :, :)
    integer, intent(in) :: element
    !> Mean shear strains gxz, gyz of the element
    real(wp), intent(in) :: strain(2)
    !> Qx and Qy per length
    real(wp) :: force(2)

    associate (s => stiffness(lane_of(element), 19:21, batch_of(element)))
      force = [dot_product(s(1:2), strain), dot_product(s(2:3), strain)]
    end associate
  end function shear_force
end module ply_criteria
