!> Contact with rigs: pressure where the plate rests on a frame from which it may lift off, springs of clamps, and
!> reactions.
!>
!> A frame is rigid and constrains w at its nodes by an inequality. The law is that of surfaces (`surface_contact`)
!> with the gap -w and one multiplier per node, updated until it converges.
module rig_contact
  use field_mappings, only: area_field
  use kinds, only: wp
  use archives, only: archive_t
  use exact_sums, only: exact_sum_t
  use rank_totals, only: totals_of
  use surface_contact, only: contact_pressure, contact_residual, updated_multiplier
  use models, only: model_t
  use support_parameters, only: max_supports
  implicit none
  private
  public :: rig_contact_t, new_rig_contact

  !> State of the contact with frames; unallocated lists: no unilateral frame.
  type :: rig_contact_t
    !> Multiplier and contact pressure, (local points)
    real(wp), allocatable :: multiplier(:), pressure(:)
    !> Derivative of the pressure with respect to the gap, not positive, (local points)
    real(wp), allocatable :: slope(:)
    !> Largest pressure so far
    real(wp) :: peak = 0
    !> Forces of the rigs computed in an explicit step, (max_supports)
    real(wp), allocatable :: found(:)
  contains
    procedure :: add_to_residual
    procedure :: add_springs
    procedure :: update_contact
    procedure :: work
    procedure :: keep_contact_closed
    procedure :: add_stiffness
    procedure :: reactions
    procedure :: visit
  end type rig_contact_t

contains

  !> Initial state: the plate in contact with its frames without pressure, except for the reaction of clamps with a
  !> force. Slopes are those of contact, so that frames support it from the first step.
  pure function new_rig_contact(model) result(self)
    type(model_t), intent(in) :: model
    type(rig_contact_t) :: self

    if (.not. model%rig%unilateral) return
    allocate (self%multiplier(size(model%rig%frame)), self%pressure(size(model%rig%frame)), &
              self%slope(size(model%rig%frame)), source=0.0_wp)
    where (model%rig%frame > 0) self%slope = -model%rig_law%stiffness
    where (model%rig%frame > 0 .and. model%rig%clamp_preload > 0) &
      self%multiplier = model%rig%clamp_preload/model%rig_area
    self%pressure = self%multiplier
  end function new_rig_contact

  !> Owned points on unilateral frames.
  pure function on_frame(model) result(points)
    type(model_t), intent(in) :: model
    !> Points of this rank, ascending
    integer, allocatable :: points(:)
    integer :: i

    points = pack([(i, i=1, model%plate%distribution%owned)], model%rig%frame(:model%plate%distribution%owned) > 0)
  end function on_frame

  !> Adds the pressure's forces to a residual.
  pure subroutine add_to_residual(self, model, displacement, residual)
    !> The state; receives pressures and slopes
    class(rig_contact_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(inout) :: residual(:, :)
    integer :: i

    if (.not. model%rig%unilateral) return
    do i = 1, model%plate%distribution%owned
      if (model%rig%frame(i) == 0) cycle
      call contact_pressure(model%rig_law, 0.0_wp, -displacement(3, i), self%multiplier(i), self%pressure(i), &
                            self%slope(i))
      ! A gap of zero counts as contact, which supports the plate in the first step.
      if (self%multiplier(i) + model%rig_law%stiffness*displacement(3, i) >= 0) &
        self%slope(i) = -model%rig_law%stiffness
      residual(3, i) = residual(3, i) - model%rig_area(i)*self%pressure(i)
    end do
  end subroutine add_to_residual

  !> Adds the forces of springs and of clamps with a force to internal forces, and their stored energy.
  pure subroutine add_springs(self, model, displacement, force, energy)
    class(rig_contact_t), intent(in) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: displacement(:, :)
    !> Internal forces at the owned points, (5, points)
    real(wp), intent(inout) :: force(:, :)
    !> Energy of this rank
    real(wp), intent(inout) :: energy
    integer :: i

    if (.not. model%rig%elastic) return
    do i = 1, model%plate%distribution%owned
      force(1:3, i) = force(1:3, i) + model%rig%springs(:, i)*displacement(1:3, i)
      energy = energy + dot_product(model%rig%springs(:, i), displacement(1:3, i)**2)/2
      force(3, i) = force(3, i) - model%rig%clamp_preload(i)
      energy = energy - model%rig%clamp_preload(i)*displacement(3, i)
    end do
  end subroutine add_springs

  !> Sets the multipliers to the pressures found; they have converged once they agree with the gaps.
  subroutine update_contact(self, model, displacement, tolerance, updates, converged)
    class(rig_contact_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: displacement(:, :)
    !> Tolerance of complementarity
    real(wp), intent(in) :: tolerance
    !> Number of updates before convergence
    integer, intent(inout) :: updates
    !> True if they have
    logical, intent(out) :: converged
    integer, allocatable :: points(:)
    real(wp) :: mismatch, largest

    converged = .true.
    if (.not. model%rig%unilateral) return
    points = on_frame(model)
    largest = maxval([0.0_wp, self%pressure(points)])
    mismatch = maxval([0.0_wp, contact_residual(model%rig_law, -displacement(3, points), self%pressure(points))])
    call model%plate%communicator%maximum(largest)
    call model%plate%communicator%maximum(mismatch)
    self%peak = max(self%peak, largest)
    if (self%peak > 0) converged = mismatch <= tolerance*self%peak
    self%multiplier(points) = updated_multiplier(model%rig_law, -displacement(3, points), self%pressure(points))
    updates = updates + merge(1, 0, mismatch > 0)
  end subroutine update_contact

  !> Work of the pressure in a step, of this rank's points.
  pure real(wp) function work(self, model, change)
    class(rig_contact_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Change of the unknowns, (5, points)
    real(wp), intent(in) :: change(:, :)

    work = 0
    if (.not. model%rig%unilateral) return
    associate (points => on_frame(model))
      work = -sum(model%rig_area(points)*self%pressure(points)*change(3, points))
    end associate
  end function work

  !> Keeps closed contacts closed in the predictor, and open ones from penetrating.
  subroutine keep_contact_closed(self, model, guess)
    class(rig_contact_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Predictor of the unknowns at its end, (5, points)
    real(wp), intent(inout) :: guess(:, :)
    integer, allocatable :: points(:)

    if (.not. model%rig%unilateral) return
    points = on_frame(model)
    guess(3, points) = merge(0.0_wp, min(0.0_wp, guess(3, points)), self%multiplier(points) > 0)
    call model%plate%halo%update(guess)
  end subroutine keep_contact_closed

  !> Adds the stiffness of frames and clamps to that of the diagonal.
  pure subroutine add_stiffness(self, model, stiffness_factor, added)
    class(rig_contact_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Factor of internal forces in the operator
    real(wp), intent(in) :: stiffness_factor
    !> Stiffness added to u, v and w, (3, points); ghosts zero
    real(wp), intent(inout) :: added(:, :)
    real(wp) :: open
    integer :: i

    if (.not. (model%rig%unilateral .or. model%rig%elastic)) return
    open = 0
    ! An iteration of load steps may lift the plate off all its frames, so that nothing supports it.
    if (.not. model%plate%setup%has_inertia()) open = model%plate%negligible_stiffness()
    do i = 1, model%plate%distribution%owned
      added(:, i) = added(:, i) + stiffness_factor*model%rig%springs(:, i)
      if (model%rig%frame(i) > 0) added(3, i) = added(3, i) + model%rig_area(i)*max(-self%slope(i), open)
    end do
  end subroutine add_stiffness

  !> Forces of each rig on the full plate, positive against the impact: residual of the equations of motion at
  !> constrained w, pressure on its frame, and springs of its clamps. The same on every rank.
  function reactions(self, model, displacement, internal, inertia, loads)
    class(rig_contact_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Unknowns, internal forces and inertia forces at the owned points, (5, points)
    real(wp), intent(in) :: displacement(:, :), internal(:, :), inertia(:, :)
    !> Forces of pressure and lines at the owned points, (5, points)
    real(wp), intent(in) :: loads(:, :)
    !> A force a rig, 0 for those that the deck does not have
    real(wp) :: reactions(max_supports)
    type(exact_sum_t) :: sums(max_supports)
    integer :: i

    reactions = 0
    if (.not. allocated(model%rig%constrained_by)) return
    if (allocated(self%found)) then
      reactions = self%found
      return
    end if
    do i = 1, model%plate%distribution%owned
      associate (constrained_by => model%rig%constrained_by(i), frame => model%rig%frame(i), &
                 clamps => model%rig%clamps(i))
        if (constrained_by > 0) then
          call sums(constrained_by)%add(loads(3, i) - internal(3, i) - inertia(3, i))
        else
          if (frame > 0) call sums(frame)%add(model%rig_area(i)*self%pressure(i))
          if (clamps > 0) call sums(clamps)%add(model%rig%springs(3, i)*displacement(3, i) - model%rig%clamp_preload(i))
        end if
      end associate
    end do
    do i = 1, size(model%rig%line_rig)
      associate (rig => model%rig%line_rig(i))
        if (rig == 0) cycle
        call sums(rig)%add(model%rig%line_stiffness(i) &
                           *dot_product(model%rig%line_weights(:, i), displacement(3, model%rig%line_points(:, i))))
      end associate
    end do
    reactions = totals_of(model%plate%communicator, sums)*model%plate%mesh%multiplicity
  end function reactions

  !> Saves or loads.
  subroutine visit(self, archive, model)
    class(rig_contact_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    real(wp), allocatable :: fields(:, :)

    if (.not. model%rig%unilateral) return
    call archive%item('rig/peak', self%peak)
    allocate (fields(3, size(self%pressure)))
    fields(1, :) = self%multiplier
    fields(2, :) = self%pressure
    fields(3, :) = self%slope
    call model%plate%visit_points(archive, 'rig/pressures', fields, area_field)
    if (.not. archive%loading) return
    self%multiplier = fields(1, :)
    self%pressure = fields(2, :)
    self%slope = fields(3, :)
  end subroutine visit
end module rig_contact
