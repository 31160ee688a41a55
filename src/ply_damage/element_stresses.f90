!> Stresses of the plies in every element for the failure criteria, averaged over its nine points.
module element_stresses
  use kinds, only: wp
  use plies, only: elasticity_t, ply_t
  use ply_stresses, only: middle_stress, face_stresses
  use criterion_strains, only: mean_strains_of_elements
  use ply_criteria, only: shear_force
  use ply_failures, only: ply_failure_t
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: element_strains, stress_of_ply, stresses_of_ply

contains

  !> Mean strains and shear forces of every element, from which the stresses of its plies are computed.
  function element_strains(plate, failures, displacement) result(strains)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy; shear forces Qx, Qy, (8, elements)
    real(wp), allocatable :: strains(:, :)
    integer :: element

    strains = mean_strains_of_elements(plate, displacement)
    do element = 1, size(strains, 2)
      strains(7:8, element) = shear_force(failures%stiffness, element, strains(7:8, element))
    end do
  end function element_strains

  !> Stresses of a ply in its own axes, with its reduced stiffness.
  pure function stresses_of_ply(plate, failures, strains, ply) result(stresses)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Result of element_strains
    real(wp), intent(in) :: strains(:, :)
    integer, intent(in) :: ply
    !> s11, s22, s12, s13, s23 in the ply's mid-plane, on its top and on its bottom; zero in elements without
    !> this ply, (5, 3, elements)
    real(wp), allocatable :: stresses(:, :, :)
    type(ply_t) :: strained
    integer :: element, place

    allocate (stresses(5, 3, size(strains, 2)), source=0.0_wp)
    do element = 1, size(strains, 2)
      associate (stack => plate%layup%stacks(plate%layup%stack(element)))
        place = stack%place(ply)
        if (place == 0) cycle
        associate (shear => stack%shear_stresses(strains(7:8, element)), &
                   elasticity => failures%elasticity(plate, ply, element))
          strained = strained_ply(plate, failures, place, element)
          stresses(:, 1, element) = middle_stress(strained, elasticity, strains(:6, element), shear(:, place))
          stresses(:, 2:3, element) = face_stresses(strained, elasticity, strains(:6, element), shear(:, place))
          stresses(1:2, :, element) = stresses(1:2, :, element) + spread(failures%carried_by_cracks(ply, element), 2, 3)
        end associate
      end associate
    end do
  end function stresses_of_ply

  !> Stress of one ply of one element in its own axes and its mid-plane: s11, s22, s12, s13, s23.
  pure function stress_of_ply(plate, failures, elasticity, strains, shear, place, element) result(stress)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Reduced elastic constants of the ply
    type(elasticity_t), intent(in) :: elasticity
    !> Of the element, from element_strains; transverse shear stresses of the ply, xz and yz
    real(wp), intent(in) :: strains(:), shear(2)
    !> Place of the ply in the element's stack, and element of this rank
    integer, intent(in) :: place, element
    !> The stress
    real(wp) :: stress(5)

    associate (number => plate%layup%stacks(plate%layup%stack(element))%number(place))
      stress = middle_stress(strained_ply(plate, failures, place, element), elasticity, strains(:6), shear)
      stress(1:2) = stress(1:2) + failures%carried_by_cracks(number, element)
    end associate
  end function stress_of_ply

  !> A ply of an element with its permanent strain.
  pure function strained_ply(plate, failures, place, element) result(ply)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Place of the ply in the element's stack, and element of this rank
    integer, intent(in) :: place, element
    type(ply_t) :: ply

    associate (stack => plate%layup%stacks(plate%layup%stack(element)))
      ply = stack%plies(place)
      if (.not. allocated(failures%bands)) return
      associate (states => failures%bands%states)
        ply%free_strain(3) = states%trial(states%at(stack%number(place), element))%permanent
      end associate
    end associate
  end function strained_ply
end module element_stresses
