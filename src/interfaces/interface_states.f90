!> State of all interfaces and of the contact with rigs: ties, contact, release of ties, ratio of energy release rate to
!> its critical value.
module interface_states
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: growth_equilibrium
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use contact_and_ties, only: contact_and_ties_t, new_contact_and_ties
  use cohesive_interfaces, only: cohesive_interfaces_t, new_cohesive_interfaces
  use interface_flaws, only: visit_flaws
  use cohesive_sliding, only: update_friction_limits, visit_friction
  use tie_release, only: tie_release_t, new_tie_release
  use rig_contact, only: rig_contact_t, new_rig_contact
  implicit none
  private
  public :: interface_state_t, new_interface_state

  !> State of all interfaces.
  type :: interface_state_t
    !> Ties and contacts of the surfaces
    type(contact_and_ties_t) :: contact
    !> Points with cohesive laws
    type(cohesive_interfaces_t) :: cohesive
    !> Released ties with forces that are ramped down, and the energy released
    type(tie_release_t) :: ties
    type(rig_contact_t) :: rig
    !> Largest energy release rate on the fronts over its critical value
    real(wp) :: release_ratio = 0
    !> The same for fronts that can grow, not at the border of their zone
    real(wp) :: growth_ratio = 0
    !> True after a front or damage has reached the border of its zone, where growth ends, (zones)
    logical, allocatable :: border_reached(:)
  contains
    procedure :: add_to_residual
    procedure :: update_contact
    procedure :: keep_contact_closed
    procedure :: contact_work
    procedure :: unreleased
    procedure :: added_stiffness
    procedure :: visit
  end type interface_state_t

contains

  !> All interfaces with their starters.
  pure function new_interface_state(model) result(self)
    type(model_t), intent(in) :: model
    type(interface_state_t) :: self

    allocate (self%border_reached(size(model%plate%mesh%zones)), source=.false.)
    self%contact = new_contact_and_ties(model%plate)
    self%ties = new_tie_release(model%plate)
    self%rig = new_rig_contact(model)
    if (model%plate%map%layered) self%cohesive = new_cohesive_interfaces(model%plate, self%contact%free)
  end function new_interface_state

  !> Adds the forces of ties and contact to a residual and sets that of tied jumps to zero.
  subroutine add_to_residual(self, model, displacement, residual)
    class(interface_state_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(inout) :: residual(:, :)

    call self%ties%add_to_residual(model%plate, residual)
    call self%contact%add_to_residual(model%plate, displacement, residual)
    call self%rig%add_to_residual(model, displacement, residual)
  end subroutine add_to_residual

  !> Sets the multipliers of surfaces and frames to the contact pressures found.
  subroutine update_contact(self, model, displacement, tolerance, updates, converged)
    class(interface_state_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: displacement(:, :)
    !> Tolerance of complementarity
    real(wp), intent(in) :: tolerance
    !> Number of updates before convergence
    integer, intent(inout) :: updates
    !> True if they have
    logical, intent(out) :: converged
    logical :: rig_converged
    integer :: rig_updates

    rig_updates = updates
    call self%contact%update_contact(model%plate, displacement, tolerance, updates, converged)
    call self%rig%update_contact(model, displacement, tolerance, rig_updates, rig_converged)
    converged = converged .and. rig_converged
    updates = max(updates, rig_updates)
    if (converged) call update_friction_limits(self%cohesive, model%plate, displacement, updates, converged)
  end subroutine update_contact

  !> Keeps closed contacts of surfaces and frames closed in the predictor.
  subroutine keep_contact_closed(self, model, guess)
    class(interface_state_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Predictor of the unknowns at its end, (5, points)
    real(wp), intent(inout) :: guess(:, :)

    call self%contact%keep_contact_closed(model%plate, guess)
    call self%rig%keep_contact_closed(model, guess)
  end subroutine keep_contact_closed

  !> Work of contact and penalty ties in a step, of this rank's points.
  pure real(wp) function contact_work(self, model, displacement, change) result(work)
    class(interface_state_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Unknowns at the end of the step and their change, (5, points)
    real(wp), intent(in) :: displacement(:, :), change(:, :)

    work = self%rig%work(model, change)
    if (model%plate%map%layered) work = work + self%contact%work(model%plate, displacement, change)
  end function contact_work

  !> Energy recorded as fracture energy but not yet released by fronts in equilibrium, which is not an error of the
  !> integrator.
  pure real(wp) function unreleased(self, model)
    class(interface_state_t), intent(in) :: self
    type(model_t), intent(in) :: model
    integer :: zone

    unreleased = 0
    do zone = 1, size(self%border_reached)
      if (model%plate%setup%delaminations(zone)%growth /= growth_equilibrium) cycle
      unreleased = unreleased + max(0.0_wp, self%contact%fracture(zone) - self%ties%set_free(zone))
    end do
  end function unreleased

  !> Stiffness that ties, contact and cohesive laws add to the diagonal of the operator.
  pure subroutine added_stiffness(self, model, diagonal, stiffness_factor, added)
    class(interface_state_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Diagonal of the operator without it, (5, points)
    real(wp), intent(in) :: diagonal(:, :)
    !> Factor of internal forces in the operator
    real(wp), intent(in) :: stiffness_factor
    !> Stiffness added to the three jumps, (3, points); ghosts zero
    real(wp), intent(out) :: added(:, :)
    integer :: i

    call self%contact%added_stiffness(model%plate, diagonal, added)
    if (allocated(self%cohesive%cohesive)) then
      do i = 1, model%plate%distribution%owned
        if (self%cohesive%cohesive(i)) added(:, i) = stiffness_factor*self%cohesive%stiffness(:, i)
      end do
    end if
    call self%rig%add_stiffness(model, stiffness_factor, added)
  end subroutine added_stiffness

  !> Saves or loads the state.
  subroutine visit(self, archive, model)
    class(interface_state_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    integer, allocatable :: reached(:)

    call archive%item('release_ratio', self%release_ratio)
    call archive%item('growth_ratio', self%growth_ratio)
    reached = merge(1, 0, self%border_reached)
    call archive%item('border_reached', reached)
    self%border_reached = reached == 1
    call self%contact%visit(archive, model%plate)
    call self%ties%visit(archive, model%plate)
    call self%cohesive%visit(archive, model%plate)
    call visit_friction(self%cohesive, archive, model%plate)
    call visit_flaws(self%cohesive, archive, model%plate)
    call self%rig%visit(archive, model)
  end subroutine visit
end module interface_states
