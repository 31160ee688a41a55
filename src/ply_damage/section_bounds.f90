!> Section stiffness of elements for operators and bounds, where the moduli in tension and compression differ.
module section_bounds
  use kinds, only: wp
  use ply_failures, only: ply_failure_t
  implicit none
  private
  public :: uniform_stiffness, largest_stiffness

contains

  !> Section stiffness for all strains, with the moduli that the mean strains of each element have: that of the
  !> operator.
  pure function uniform_stiffness(self) result(stiffness)
    type(ply_failure_t), intent(in) :: self
    !> (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)

    stiffness = self%stiffness
    if (allocated(self%mean_change)) stiffness(:, :18, :) = stiffness(:, :18, :) + self%mean_change(:, :18, :)
  end function uniform_stiffness

  !> Upper bound of the section stiffness for any sign of the stresses.
  pure function largest_stiffness(self) result(stiffness)
    type(ply_failure_t), intent(in) :: self
    !> (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)

    stiffness = self%stiffness
    if (allocated(self%signs)) call self%signs%signs%add_excess(stiffness)
    if (.not. allocated(self%bands)) return
    if (allocated(self%bands%signs)) call self%bands%signs%add_excess(stiffness)
  end function largest_stiffness
end module section_bounds
