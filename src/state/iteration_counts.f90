!> Numbers of iterations of a step or of a run.
module iteration_counts
  implicit none
  private
  public :: iteration_counts_t

  !> Iterations of equilibrium, of the contact force and of the contact pressures.
  type :: iteration_counts_t
    !> Iterations of each
    integer :: equilibrium = 0, force = 0, contact = 0
  contains
    procedure :: plus
  end type iteration_counts_t

contains

  !> Sums of two counts.
  pure type(iteration_counts_t) function plus(self, other) result(sums)
    class(iteration_counts_t), intent(in) :: self
    !> The counts added
    type(iteration_counts_t), intent(in) :: other

    sums%equilibrium = self%equilibrium + other%equilibrium
    sums%force = self%force + other%force
    sums%contact = self%contact + other%contact
  end function plus
end module iteration_counts
