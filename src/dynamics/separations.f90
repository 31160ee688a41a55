!> Joined, separated and touching faces: which jumps are free, and the pressure where faces touch.
!>
!> The pressure acts as one constant force over a step while its gap is judged at the end of the step.
!> Its work is then minus the pressure times the gap that closed: contact never creates energy,
!> whatever the integrator of the plate.
module separations
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: contact_none, tie_penalty, unloading_glued
  use delaminated_regions, only: delaminated_region_t, create_region
  use face_contact, only: contact_pressure, unmet_contact, updated_decay, updated_multiplier
  use models, only: model_t
  implicit none
  private
  public :: separation_t, new_separation

  !> State of all interfaces.
  type :: separation_t
    !> Delaminated cells of each zone, the same on every rank
    type(delaminated_region_t), allocatable :: regions(:)
    !> True where a lower point's jumps are free, (local points)
    logical, allocatable :: free(:)
    !> Estimate of the contact pressure and the pressure found, (local points)
    real(wp), allocatable :: multiplier(:), pressure(:)
    !> Slope of the pressure by the gap, not positive, (local points)
    real(wp), allocatable :: slope(:)
    !> Decay of the pressure with an open gap (beta of Eq. 12), 1/length, (zones), the same on every rank
    real(wp), allocatable :: decay(:)
    !> Largest pressure so far
    real(wp) :: peak = 0
    !> True: separated faces move together (the paper's shortcut for unloading)
    logical :: glued = .false.
  contains
    !> Finds which jumps are free, after a growth.
    procedure :: free_jumps
    !> Adds the contact and penalty forces to a residual and takes the residual of held jumps out.
    procedure :: act
    !> Takes the pressures found as the next estimates; they have settled once they go with the gaps.
    procedure :: settle
    !> How far pressures and gaps are from contact.
    procedure :: complementarity
    !> Work of contact and penalty ties in a step.
    procedure :: work
    !> Keeps held jumps as they are.
    procedure :: hold
    !> Keeps touching faces together in a first guess, and open ones from passing through each other.
    procedure :: keep_touching
    !> Stiffness that ties and contact add to the diagonal.
    procedure :: added_stiffness
    !> Largest penetration.
    procedure :: penetration
    !> Delaminated area of the whole plate.
    procedure :: area
    !> Saves or loads.
    procedure :: visit
  end type separation_t

  !> Stiffness that stands for a held jump, over the diagonal of the operator: hard enough to hold it to five
  !> digits in a preconditioner, soft enough to be taken out again without a factorisation.
  real(wp), parameter, public :: held_stiffness = 1.0e5_wp

contains

  !> All interfaces with their starters.
  pure function new_separation(model) result(self)
    !> The model
    type(model_t), intent(in) :: model
    !> The state
    type(separation_t) :: self
    integer :: zone, points

    points = size(model%zone)
    allocate (self%regions(size(model%mesh%zones)))
    do zone = 1, size(self%regions)
      self%regions(zone) = create_region(model%mesh, zone, model%scene%delaminations(zone)%starter)
    end do
    allocate (self%decay(size(self%regions)), source=0.0_wp)
    if (.not. model%map%layered) return
    allocate (self%free(points), source=.false.)
    allocate (self%multiplier(points), self%pressure(points), self%slope(points), source=0.0_wp)
    call self%free_jumps(model)
  end function new_separation

  !> Finds which jumps are free: those at nodes around which all cells have come apart.
  pure subroutine free_jumps(self, model)
    !> The state
    class(separation_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    integer :: i, line(2), node

    do i = 1, size(self%free)
      if (model%zone(i) == 0) cycle
      node = model%mesh%point_node(model%distribution%points(i)) - 1
      line = [modulo(node, 2*model%mesh%cells(1) + 1), node/(2*model%mesh%cells(1) + 1)]
      self%free(i) = self%regions(model%zone(i))%released(line(1), line(2))
    end do
  end subroutine free_jumps

  !> True where the three jumps of a point are held by exact ties or glue.
  pure logical function holds(self, model, i)
    !> The state
    type(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Point of this rank
    integer, intent(in) :: i

    holds = .false.
    if (model%zone(i) == 0) return
    associate (interface => model%scene%delaminations(model%zone(i)))
      if (self%free(i)) then
        holds = self%glued .and. interface%unloading == unloading_glued
      else
        holds = interface%tie /= tie_penalty
      end if
    end associate
  end function holds

  !> Adds the contact and penalty forces to a residual and takes the residual of held jumps out of it.
  subroutine act(self, model, displacement, residual)
    !> The state; receives pressures and slopes
    class(separation_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Residual at the owned points, (5, points)
    real(wp), intent(inout) :: residual(:, :)
    integer :: i

    if (.not. model%map%layered) return
    do i = 1, model%distribution%owned
      if (model%zone(i) == 0) cycle
      if (holds(self, model, i)) then
        residual(1:3, i) = 0
        self%pressure(i) = 0
        self%slope(i) = 0
      else if (self%free(i)) then
        call press(self, model, i, displacement(3, i))
        residual(3, i) = residual(3, i) + model%contact_area(i)*self%pressure(i)
      else
        residual(1:3, i) = residual(1:3, i) - tie_stiffness(model, i)*displacement(1:3, i)
      end if
    end do
  end subroutine act

  !> Pressure and its slope at a point whose faces are separated.
  pure subroutine press(self, model, i, gap)
    !> The state
    type(separation_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Point of this rank
    integer, intent(in) :: i
    !> Gap
    real(wp), intent(in) :: gap

    self%pressure(i) = 0
    self%slope(i) = 0
    associate (zone => model%zone(i))
      if (model%scene%delaminations(zone)%contact == contact_none) return
      call contact_pressure(model%contact_laws(zone), self%decay(zone), gap, self%multiplier(i), self%pressure(i), &
                            self%slope(i))
    end associate
  end subroutine press

  !> Stiffness of a penalty tie at a point.
  pure real(wp) function tie_stiffness(model, i) result(stiffness)
    !> The model
    type(model_t), intent(in) :: model
    !> Point of this rank
    integer, intent(in) :: i

    associate (interface => model%scene%delaminations(model%zone(i)))
      stiffness = interface%penalty_stiffness
      if (stiffness <= 0) stiffness = 1.0e6_wp*model%contact_laws(model%zone(i))%layer_stiffness
      stiffness = stiffness*model%contact_area(i)
    end associate
  end function tie_stiffness

  !> Takes the pressures found as the next estimates; they have settled once they go with the gaps.
  subroutine settle(self, model, displacement, tolerance, rounds, settled)
    !> The state
    class(separation_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Complementarity at which they have settled
    real(wp), intent(in) :: tolerance
    !> Counts the times that there was something to settle
    integer, intent(inout) :: rounds
    !> True if they have
    logical, intent(out) :: settled
    real(wp) :: unmet

    unmet = self%complementarity(model, displacement)
    settled = unmet <= tolerance
    call update_multipliers(self, model, displacement, settled)
    rounds = rounds + merge(1, 0, unmet > 0)
  end subroutine settle

  !> Takes the pressures found as the next estimates, and the decay that suits the gaps. Pressures are those of
  !> the last residual.
  subroutine update_multipliers(self, model, displacement, settled)
    !> The state
    type(separation_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> True: the pressures go with the gaps, the step is done
    logical, intent(in) :: settled
    real(wp) :: sums(2, size(self%decay)), largest(size(self%decay))
    integer :: i, zone

    if (.not. model%map%layered) return
    sums = 0
    largest = 0
    do i = 1, model%distribution%owned
      if (.not. touches(self, model, i)) cycle
      zone = model%zone(i)
      associate (gap => displacement(3, i), pressure => self%pressure(i))
        sums(:, zone) = sums(:, zone) + model%contact_area(i)*pressure*[abs(gap), 1.0_wp]
        largest(zone) = max(largest(zone), pressure)
        self%multiplier(i) = updated_multiplier(model%contact_laws(zone), gap, pressure)
      end associate
    end do
    do zone = 1, size(largest)
      call model%communicator%sum(sums(:, zone))
      call model%communicator%maximum(largest(zone))
    end do
    self%decay = updated_decay(model%contact_laws, sums(1, :), sums(2, :), largest, settled)
    self%peak = max(self%peak, maxval(largest))
  end subroutine update_multipliers

  !> True where the faces at a point are apart and may press on each other.
  pure logical function touches(self, model, i)
    !> The state
    type(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Point of this rank
    integer, intent(in) :: i

    touches = self%free(i)
    if (touches) touches = .not. holds(self, model, i)
  end function touches

  !> How far pressures and gaps are from contact, where faces with a gap have no pressure and none is negative:
  !> the largest part of the pressure that is unmet over the largest pressure so far. The same on every rank.
  real(wp) function complementarity(self, model, displacement)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    real(wp) :: peak
    integer :: i

    complementarity = 0
    if (.not. model%map%layered) return
    peak = self%peak
    do i = 1, model%distribution%owned
      if (.not. touches(self, model, i)) cycle
      peak = max(peak, self%pressure(i))
      complementarity = max(complementarity, unmet_contact(model%contact_laws(model%zone(i)), displacement(3, i), &
                                                           self%pressure(i)))
    end do
    call model%communicator%maximum(complementarity)
    call model%communicator%maximum(peak)
    complementarity = merge(complementarity/max(peak, tiny(peak)), 0.0_wp, peak > 0)
  end function complementarity

  !> Work of contact and penalty ties in a step, of this rank's points.
  pure real(wp) function work(self, model, displacement, change)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns at the end of the step and their change, (5, points)
    real(wp), intent(in) :: displacement(:, :), change(:, :)
    integer :: i

    work = 0
    do i = 1, model%distribution%owned
      if (model%zone(i) == 0 .or. holds(self, model, i)) cycle
      if (self%free(i)) then
        work = work + model%contact_area(i)*self%pressure(i)*change(3, i)
      else
        work = work - tie_stiffness(model, i)*dot_product(displacement(1:3, i), change(1:3, i))
      end if
    end do
  end function work

  !> Keeps held jumps as they are.
  pure subroutine hold(self, model, correction)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Correction of the unknowns, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    integer :: i

    if (.not. model%map%layered) return
    do i = 1, size(self%free)
      if (holds(self, model, i)) correction(1:3, i) = 0
    end do
  end subroutine hold

  !> Keeps touching faces together in a first guess, and open ones from passing through each other: the stiff
  !> law would answer small errors of a guess with large pressures.
  subroutine keep_touching(self, model, guess)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Guess of the unknowns at its end, (5, points)
    real(wp), intent(inout) :: guess(:, :)
    integer :: i

    if (.not. model%map%layered) return
    ! Pressures are known to a point's owner only.
    do i = 1, model%distribution%owned
      if (.not. touches(self, model, i)) cycle
      if (model%scene%delaminations(model%zone(i))%contact == contact_none) cycle
      if (self%multiplier(i) > 0) then
        guess(3, i) = 0
      else
        guess(3, i) = max(0.0_wp, guess(3, i))
      end if
    end do
    call model%halo%update(guess)
  end subroutine keep_touching

  !> Stiffness that ties and contact add to the diagonal of the operator.
  pure subroutine added_stiffness(self, model, diagonal, added)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Diagonal of the operator without it, (5, points)
    real(wp), intent(in) :: diagonal(:, :)
    !> Stiffness added to the three jumps, (3, points); ghosts zero
    real(wp), intent(out) :: added(:, :)
    integer :: i

    added = 0
    if (.not. model%map%layered) return
    do i = 1, model%distribution%owned
      if (model%zone(i) == 0) cycle
      if (holds(self, model, i)) then
        added(:, i) = held_stiffness*maxval(diagonal(1:3, i))
      else if (self%free(i)) then
        added(3, i) = -model%contact_area(i)*self%slope(i)
      else
        added(:, i) = tie_stiffness(model, i)
      end if
    end do
  end subroutine added_stiffness

  !> Largest penetration of separated faces, the same on every rank.
  real(wp) function penetration(self, model, displacement)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    integer :: i

    penetration = 0
    if (.not. model%map%layered) return
    do i = 1, model%distribution%owned
      if (self%free(i)) penetration = max(penetration, -displacement(3, i))
    end do
    call model%communicator%maximum(penetration)
  end function penetration

  !> Delaminated area of all interfaces of the whole plate.
  pure real(wp) function area(self, model)
    !> The state
    class(separation_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    integer :: zone, i, j

    area = 0
    do zone = 1, size(self%regions)
      do j = self%regions(zone)%rows(1), self%regions(zone)%rows(2)
        do i = self%regions(zone)%columns(1), self%regions(zone)%columns(2)
          if (self%regions(zone)%is_delaminated(i, j)) area = area + model%mesh%cell_area([i, j])
        end do
      end do
    end do
    area = area*model%mesh%multiplicity
  end function area

  !> Saves or loads.
  subroutine visit(self, archive, model)
    !> The state
    class(separation_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    !> The model
    type(model_t), intent(in) :: model
    real(wp), allocatable :: fields(:, :)
    integer :: zone

    if (.not. model%map%layered) return
    do zone = 1, size(self%regions)
      call self%regions(zone)%visit(archive, 'zone'//achar(iachar('0') + zone))
    end do
    call archive%item('separation/peak', self%peak)
    call archive%item('separation/glued', self%glued)
    call archive%item('separation/decay', self%decay)
    allocate (fields(3, size(self%free)))
    fields(1, :) = self%multiplier
    fields(2, :) = self%pressure
    fields(3, :) = self%slope
    associate (share => model%distribution)
      call archive%field('separation/pressures', share%points(:share%owned), model%mesh%points(), fields)
    end associate
    if (.not. archive%loading) return
    self%multiplier = fields(1, :)
    self%pressure = fields(2, :)
    self%slope = fields(3, :)
    call self%free_jumps(model)
  end subroutine visit
end module separations
