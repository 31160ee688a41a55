!> Contact patch of the impactor on the plate. The model has that of the deck; the state has the present one, which
!> steps change where it follows the impactor's nose.
module contact_patches
  use communicators, only: communicator_t
  use kinds, only: wp
  use rank_totals, only: total_of
  implicit none
  private
  public :: contact_patch_t

  !> The patch under the impactor.
  type :: contact_patch_t
    !> Weights whose product with w is the mean deflection of the patch, (local points); ghosts zero
    real(wp), allocatable :: weights(:)
    !> Points with a weight
    integer, allocatable :: points(:)
    !> Offset that keeps the mean deflection continuous when the patch changes, minus the mean deflection at the start,
    !> where the impactor touches the plate
    real(wp) :: offset = 0
    !> Under a nose: position of its tip at first contact, and area under pressure on the full plate
    real(wp) :: touched_at = 0, area = 0
  contains
    !> Mean of a deflection, and deflection of the plate under the impactor.
    procedure :: mean
    procedure :: deflection
    procedure :: spread
    procedure :: add_force
  end type contact_patch_t

contains

  !> Mean of a deflection over the patch, the same on every rank.
  real(wp) function mean(self, communicator, displacement)
    class(contact_patch_t), intent(in) :: self
    type(communicator_t), intent(in) :: communicator
    real(wp), intent(in) :: displacement(:, :)

    mean = total_of(communicator, self%weights(self%points)*displacement(3, self%points))
  end function mean

  !> Deflection of the plate under the impactor, the same on every rank.
  real(wp) function deflection(self, communicator, displacement)
    class(contact_patch_t), intent(in) :: self
    type(communicator_t), intent(in) :: communicator
    real(wp), intent(in) :: displacement(:, :)

    deflection = self%mean(communicator, displacement) + self%offset
  end function deflection

  !> Sets other weights.
  pure subroutine spread(self, weights, offset)
    class(contact_patch_t), intent(inout) :: self
    !> Weights, (local points); ghosts zero
    real(wp), intent(in) :: weights(:)
    !> Offset that keeps the mean deflection continuous
    real(wp), intent(in) :: offset
    integer :: point

    self%weights = weights
    self%points = pack([(point, point=1, size(weights))], abs(weights) > 0)
    self%offset = offset
  end subroutine spread

  !> Adds the nodal forces of a force.
  pure subroutine add_force(self, force, forces)
    class(contact_patch_t), intent(in) :: self
    !> The force on the modelled part
    real(wp), intent(in) :: force
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%points)
      associate (point => self%points(i))
        forces(3, point) = forces(3, point) + force*self%weights(point)
      end associate
    end do
  end subroutine add_force
end module contact_patches
