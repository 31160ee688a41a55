!> Strains that the failure criteria take their stresses from: means over each element and, if the deck asks for it,
!> over its surroundings.
module criterion_strains
  use kinds, only: wp
  use element_batches, only: lanes, first_element
  use strain_recovery, only: mean_strains
  use neighbourhoods, only: even, odd_in_x, odd_in_y, odd_in_both
  use models, only: model_t
  implicit none
  private
  public :: mean_strains_of_elements

contains

  !> Mean strains of this rank's elements, averaged over their surroundings. All ranks must call together.
  function mean_strains_of_elements(model, displacement) result(strains)
    type(model_t), intent(in) :: model
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy; transverse shear gxz, gyz of the plate, (8, elements)
    real(wp), allocatable :: strains(:, :)
    integer, parameter :: signs(8) = [even, even, odd_in_both, even, even, odd_in_both, odd_in_x, odd_in_y]
    real(wp) :: means(lanes, 8)
    real(wp), allocatable :: motion(:, :), everywhere(:)
    integer :: b, lane

    allocate (strains(8, model%elements%elements))
    motion = model%motion_of(displacement)
    do b = 1, model%elements%batches
      call mean_strains(model%elements, b, model%scene%kinematics, motion, means)
      do lane = 1, model%elements%lanes_used(b)
        strains(:, first_element(b) + lane - 1) = means(lane, :)
      end do
    end do
    if (.not. allocated(model%surroundings)) return
    everywhere = spread_out(model, strains)
    call model%communicator%sum(everywhere)
    strains = model%surroundings%means(reshape(everywhere, [8, model%mesh%elements()]), signs)
  end function mean_strains_of_elements

  !> Strains of this rank's elements in a list for the whole mesh.
  pure function spread_out(model, strains) result(everywhere)
    type(model_t), intent(in) :: model
    !> Strains, (8, elements)
    real(wp), intent(in) :: strains(:, :)
    !> The same, zero for elements of other ranks, (8*elements of the mesh)
    real(wp), allocatable :: everywhere(:)
    real(wp) :: table(8, model%mesh%elements())

    table = 0
    table(:, model%distribution%elements) = strains
    everywhere = reshape(table, [size(table)])
  end function spread_out
end module criterion_strains
