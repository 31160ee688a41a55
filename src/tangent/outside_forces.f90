!> Forces on a plate from outside that depend on its motion.
module outside_forces
  use kinds, only: wp
  implicit none
  private
  public :: outside_force_t

  !> A force from outside that depends on the plate's motion, such as that of an impactor.
  type, abstract :: outside_force_t
  contains
    !> The force at a motion.
    procedure(force_at), deferred :: at
  end type outside_force_t

  abstract interface
    !> The force at a motion.
    subroutine force_at(self, motion, force, slope)
      import :: outside_force_t, wp
      !> The force, which remembers the latest motion
      class(outside_force_t), intent(inout) :: self
      !> Change of the motion on which the force does work
      real(wp), intent(in) :: motion
      !> Change of the force, and its slope, not positive
      real(wp), intent(out) :: force, slope
    end subroutine force_at
  end interface
end module outside_forces
