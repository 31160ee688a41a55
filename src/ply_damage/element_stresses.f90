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
  public :: element_strains, has_ply, stress_of_ply, stresses_of_ply

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
    integer :: element

    allocate (stresses(5, 3, size(strains, 2)), source=0.0_wp)
    do element = 1, size(strains, 2)
      if (.not. has_ply(plate, ply, element)) cycle
      associate (shear => shear_of_ply(plate, strains, ply, element), &
                 elasticity => failures%elasticity(plate, ply, element))
        strained = strained_ply(plate, failures, ply, element)
        stresses(:, 1, element) = middle_stress(strained, elasticity, strains(:6, element), shear)
        stresses(:, 2:3, element) = face_stresses(strained, elasticity, strains(:6, element), shear)
        stresses(1:2, :, element) = stresses(1:2, :, element) + spread(failures%carried_by_cracks(ply, element), 2, 3)
      end associate
    end do
  end function stresses_of_ply

  !> Stress of one ply of one element in its own axes and its mid-plane: s11, s22, s12, s13, s23.
  pure function stress_of_ply(plate, failures, elasticity, strains, ply, element) result(stress)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Reduced elastic constants of the ply
    type(elasticity_t), intent(in) :: elasticity
    !> Result of element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Ply of the laminate, and element of this rank with this ply
    integer, intent(in) :: ply, element
    !> The stress
    real(wp) :: stress(5)
    type(ply_t) :: strained

    strained = strained_ply(plate, failures, ply, element)
    stress = middle_stress(strained, elasticity, strains(:6, element), &
                           shear_of_ply(plate, strains, ply, element))
    stress(1:2) = stress(1:2) + failures%carried_by_cracks(ply, element)
  end function stress_of_ply

  !> A ply of an element with its permanent strain.
  pure function strained_ply(plate, failures, number, element) result(ply)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of its plies
    type(ply_failure_t), intent(in) :: failures
    !> Number of the ply, and element of this rank that has it
    integer, intent(in) :: number, element
    type(ply_t) :: ply

    associate (stack => plate%layup%stacks(plate%layup%stack(element)))
      ply = stack%plies(stack%place(number))
    end associate
    if (allocated(failures%bands)) ply%free_strain(3) = failures%bands%states%permanent_shear(number, element)
  end function strained_ply

  !> Transverse shear stress of one ply of one element.
  pure function shear_of_ply(plate, strains, ply, element) result(shear)
    type(composite_plate_t), intent(in) :: plate
    !> Result of element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Ply of the laminate, and element of this rank with this ply
    integer, intent(in) :: ply, element
    !> xz, yz
    real(wp) :: shear(2)

    associate (stack => plate%layup%stacks(plate%layup%stack(element)))
      associate (all => stack%shear_stresses(strains(7:8, element)))
        shear = all(:, stack%place(ply))
      end associate
    end associate
  end function shear_of_ply

  !> True if an element of this rank has a ply.
  pure logical function has_ply(plate, ply, element)
    type(composite_plate_t), intent(in) :: plate
    !> Ply of the laminate, and element
    integer, intent(in) :: ply, element

    has_ply = plate%layup%stacks(plate%layup%stack(element))%has(ply)
  end function has_ply
end module element_stresses
