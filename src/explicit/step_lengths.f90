!> Lengths of the steps between which velocities are found.
module step_lengths
  use kinds, only: wp
  implicit none
  private
  public :: step_lengths_t

  !> A step and the one before it.
  type :: step_lengths_t
    !> Length of the step, and of the one before; 0: there was none
    real(wp) :: now = 0, last = 0
  contains
    !> Time between the velocities in the middles of both steps.
    procedure :: mean
  end type step_lengths_t

contains

  !> Time between the velocities in the middles of both steps.
  pure real(wp) function mean(self)
    !> The steps
    class(step_lengths_t), intent(in) :: self

    mean = (self%now + self%last)/2
  end function mean
end module step_lengths
