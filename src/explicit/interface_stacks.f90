!> Nodes with several layers and the interfaces between them, and their data of earlier steps.
module interface_stacks
  use archives, only: archive_t
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_laws, only: cohesive_law_t
  use cohesive_points, only: opened
  use field_mappings, only: vector_fields
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  implicit none
  private
  public :: jump_history_t, interface_stacks_t, create_interface_stacks, last_layer

  !> Earlier steps of the jumps at a point.
  type :: jump_history_t
    !> Forces on the jumps in the last step
    real(wp) :: forces(3) = 0
    !> Change of the jumps in the last step, and in the one before. Damping does not reduce them: with those of the
    !> undamped motion the weighted mean is stable for springs of any stiffness, with reduced ones it is not.
    real(wp) :: change(3) = 0, earlier(3) = 0
    !> Energy dissipated by contact of surfaces, and algorithmic dissipation of the tractions
    real(wp) :: lost(2) = 0
    !> Friction, for its heat: number of further steps whose forces depend on the last slip, change of the energy of
    !> sticking in the last step and negative heat of earlier steps, both per area
    real(wp) :: rubbing(3) = 0
    !> Work on the cohesive law of damaged surfaces in the last step
    real(wp) :: work = 0
    !> Change of the elastic jumps of sticking surfaces in the last step, and in the one before
    real(wp) :: sticking(4) = 0
  end type jump_history_t

  !> Stacks of layers, of nodes with one layer, too. Points of a stack follow each other downwards; each but the first
  !> carries the interface above it.
  type :: interface_stacks_t
    !> First point and number of layers of each independent stack, (stacks)
    integer, allocatable :: first(:), layers(:)
    !> Area of the interface above a point at the node, with that of dependent points, (points)
    real(wp), allocatable :: area(:)
    !> Stiffness of the undamaged interface against shear and opening, force per jump, (2, points)
    real(wp), allocatable :: stiffness(:, :)
    !> Twice the energy of the undamaged interface at a node below which damage neither starts nor grows, (points)
    real(wp), allocatable :: min_onset(:)
    !> Factor of the strengths with which it was found; 0: not yet, (points)
    real(wp), allocatable, private :: strength(:)
    !> True: it was found with damage held
    logical, private :: is_held = .false.
    !> True for stacks with a damaged interface, (stacks)
    logical, allocatable :: damaged(:)
    !> Earlier steps of the jumps, (points)
    type(jump_history_t), allocatable :: history(:)
  contains
    procedure :: find_damaged
    !> Onset energies, reduced by flaws.
    procedure :: find_onsets
    procedure :: begin_softening
    procedure :: may_separate
    procedure :: mark_damaged
    procedure :: copy_to_dependents
    procedure :: visit
  end type interface_stacks_t

contains

  !> Stacks of a model.
  function create_interface_stacks(model, cohesive, inertia) result(self)
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(nodal_inertia_t), intent(in) :: inertia
    type(interface_stacks_t) :: self
    integer :: i, points

    associate (above => model%plate%map%above, owned => model%plate%distribution%owned)
      points = size(above)
      self%first = pack([(i, i=1, owned)], .not. inertia%is_dependent(:owned) .and. above(:owned) == 0)
      self%layers = [(last_layer(above, self%first(i)) - self%first(i) + 1, i=1, size(self%first))]
    end associate
    allocate (self%damaged(size(self%first)), self%history(points))
    self%area = model%plate%interfaces%contact_area
    do i = 1, size(inertia%dependents)
      self%area(inertia%masters(i)) = self%area(inertia%masters(i)) + self%area(inertia%dependents(i))
      self%area(inertia%dependents(i)) = 0
    end do
    allocate (self%stiffness(2, points), self%min_onset(points), self%strength(points), source=0.0_wp)
    do i = 1, model%plate%distribution%owned
      if (model%plate%zone(i) == 0) cycle
      associate (law => model%plate%interfaces%cohesive_laws(model%plate%zone(i)))
        self%stiffness(:, i) = self%area(i)*[law%stiffness_shear, law%stiffness_opening]
      end associate
    end do
    call self%find_onsets(model, cohesive)
    call self%find_damaged(cohesive)
  end function create_interface_stacks

  !> Point of the lowest layer of the node of a point of this rank.
  pure integer function last_layer(above, i) result(point)
    !> Point above each point; 0: none
    integer, intent(in) :: above(:)
    integer, intent(in) :: i

    do point = i, size(above) - 1
      if (above(point + 1) /= point) return
    end do
  end function last_layer

  !> Onset energies where the strengths have changed: N Y = G_c, and the toughness of a mixture of modes is at least
  !> that of the weaker pure mode. The interfaces of a node below a clamp with a force do not separate: the clamp acts
  !> on one node of the mesh, which could not carry a force that lifts the upper layers.
  pure subroutine find_onsets(self, model, cohesive)
    class(interface_stacks_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(cohesive_law_t) :: law
    integer :: i

    if (.not. allocated(cohesive%cohesive)) return
    if (self%is_held .neqv. cohesive%is_held) self%strength = 0
    self%is_held = cohesive%is_held
    do i = 1, model%plate%distribution%owned
      if (model%plate%zone(i) == 0 .or. .not. abs(cohesive%strength(i) - self%strength(i)) > 0) cycle
      self%strength(i) = cohesive%strength(i)
      law = cohesive%law_at(model%plate, i)
      self%min_onset(i) = 2*self%area(i)*min(law%toughness_opening, law%toughness_shear)/law%failure_ratio
    end do
    if (.not. model%rig%elastic) return
    do i = 1, model%plate%distribution%owned
      if (model%rig%clamp_preload(i) > 0) self%min_onset(i + 1:last_layer(model%plate%map%above, i)) = huge(1.0_wp)
    end do
  end subroutine find_onsets

  !> Marks damaged stacks.
  pure subroutine find_damaged(self, cohesive)
    class(interface_stacks_t), intent(inout) :: self
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: i

    self%damaged = .false.
    if (.not. allocated(cohesive%points)) return
    do i = 1, size(self%first)
      associate (from => self%first(i) + 1, to => self%first(i) + self%layers(i) - 1)
        self%damaged(i) = any(cohesive%points(from:to)%damage > 0 .or. cohesive%by_energy(from:to))
      end associate
    end do
  end subroutine find_damaged

  !> True for an independent point that no clamp holds.
  pure logical function may_separate(self, p)
    class(interface_stacks_t), intent(in) :: self
    integer, intent(in) :: p

    may_separate = self%area(p) > 0 .and. self%min_onset(p) < huge(1.0_wp)
  end function may_separate

  !> Reduces the law of an undamaged point, and treats its stack as damaged. A smaller stiffness of opening stores less
  !> energy; the difference, a small part of the toughness, is recorded as algorithmic.
  pure subroutine begin_softening(self, plate, cohesive, p, factors, u)
    class(interface_stacks_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces; receive the law
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    integer, intent(in) :: p
    !> Factors of the strengths and of the stiffness of opening
    real(wp), intent(in) :: factors(2)
    real(wp), intent(in) :: u(:, :)
    integer :: first

    cohesive%strength(p) = factors(1)
    cohesive%opening(p) = factors(2)
    cohesive%by_energy(p) = .true.
    self%history(p)%lost(2) = self%history(p)%lost(2) + (1 - factors(2))*self%stiffness(2, p)*max(0.0_wp, u(3, p))**2/2
    first = p
    do while (plate%map%above(first) > 0)
      first = plate%map%above(first)
    end do
    call self%mark_damaged(findloc(self%first, first, 1), plate, cohesive, u)
  end subroutine begin_softening

  !> Treats a stack as damaged from the next step on.
  pure subroutine mark_damaged(self, i, plate, cohesive, u)
    class(interface_stacks_t), intent(inout) :: self
    !> Index of the stack
    integer, intent(in) :: i
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces; their surfaces receive the present jumps as slips
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), intent(in) :: u(:, :)
    real(wp) :: from(3), to(3)
    integer :: p

    if (self%damaged(i)) return
    self%damaged(i) = .true.
    do p = self%first(i) + 1, self%first(i) + self%layers(i) - 1
      cohesive%points(p)%sliding%slip = u(1:2, p)
      to = u(1:3, p)
      from = to - self%history(p)%change
      ! The pressure of surfaces in contact is not part of the law.
      if (prevents_penetration(plate, plate%zone(p))) then
        from = opened(from)
        to = opened(to)
      end if
      self%history(p)%work = sum(self%stiffness([1, 1, 2], p)*(to**2 - from**2))/2
    end do
  end subroutine mark_damaged

  !> Copies the state of the interfaces of masters to their dependents.
  pure subroutine copy_to_dependents(self, inertia, cohesive)
    class(interface_stacks_t), intent(in) :: self
    type(nodal_inertia_t), intent(in) :: inertia
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    integer :: i

    if (.not. any(self%damaged)) return
    do i = 1, size(inertia%dependents)
      associate (dependent => inertia%dependents(i))
        if (.not. cohesive%cohesive(dependent)) cycle
        cohesive%points(dependent) = cohesive%points(inertia%masters(i))
        cohesive%strength(dependent) = cohesive%strength(inertia%masters(i))
        cohesive%opening(dependent) = cohesive%opening(inertia%masters(i))
        cohesive%by_energy(dependent) = cohesive%by_energy(inertia%masters(i))
        cohesive%points(dependent)%sliding%slip = inertia%signs(1:2, i)*cohesive%points(dependent)%sliding%slip
      end associate
    end do
  end subroutine copy_to_dependents

  !> Writes or reads the history.
  subroutine visit(self, archive, plate)
    class(interface_stacks_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp) :: values(19, size(self%history))
    integer :: i

    do i = 1, size(self%history)
      associate (h => self%history(i))
        values(:, i) = [h%forces, h%change, h%earlier, h%lost, h%rubbing, h%work, h%sticking]
      end associate
    end do
    call plate%visit_points(archive, 'explicit/interfaces', values, vector_fields([1, 4, 7, 16, 18]))
    do i = 1, size(self%history)
      associate (v => values(:, i))
        self%history(i) = jump_history_t(v(1:3), v(4:6), v(7:9), v(10:11), v(12:14), v(15), v(16:19))
      end associate
    end do
  end subroutine visit
end module interface_stacks
