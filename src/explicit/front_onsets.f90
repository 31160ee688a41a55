!> Onset of damage beside delaminated points by the energy release rate, theory (D15) to (D17), in steps by central
!> differences.
module front_onsets
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_laws, only: cohesive_law_t
  use delamination_parameters, only: growth_by_energy, law_cohesive
  use energy_onsets, only: onset_share, reduce_law, release_over_toughness
  use front_stencils, only: ahead, behind, create_front_stencils, far_behind, front_stencils_t, jump_signs
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: front_onsets_t, create_front_onsets

  !> Number of steps between two searches. A stress wave crosses at most two nodes in this time, a front, which follows
  !> bending waves, less than one.
  integer, parameter :: steps_between_searches = 4
  !> Values of a point: tractions, jumps, and damage.
  integer, parameter :: of_tractions(3) = [1, 2, 3], of_jumps(3) = [4, 5, 6], of_damage = 7

  !> Search for points that begin to soften.
  type :: front_onsets_t
    !> Nodes before and behind each point; no points where strengths control growth
    type(front_stencils_t) :: stencils
    !> Values of the points of the mesh that this rank needs, (7, points of the mesh)
    real(wp), allocatable, private :: values(:, :)
  contains
    procedure :: find
  end type front_onsets_t

contains

  !> The search in a model. Collective.
  function create_front_onsets(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(front_onsets_t) :: self

    allocate (self%stencils%points(0))
    if (.not. plate%map%layered) return
    if (.not. any(plate%setup%delaminations%law == law_cohesive .and. &
                  plate%setup%delaminations%growth_control == growth_by_energy)) return
    self%stencils = create_front_stencils(plate)
    allocate (self%values(7, plate%mesh%points()), source=0.0_wp)
  end function create_front_onsets

  !> Finds undamaged points at which the energy release rate has reached the onset, and reduces their laws. Collective.
  subroutine find(self, plate, step, stacks, cohesive, u)
    class(front_onsets_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Number of the step
    integer, intent(in) :: step
    type(interface_stacks_t), intent(inout) :: stacks
    !> The interfaces; receive the laws
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), intent(in) :: u(:, :)
    integer :: i

    if (.not. allocated(self%values) .or. modulo(step, steps_between_searches) > 0) return
    if (cohesive%is_held) return
    call gather(self, plate, stacks, cohesive, u)
    do i = 1, size(self%stencils%points)
      associate (p => self%stencils%points(i))
        if (cohesive%points(p)%damage > 0 .or. cohesive%by_energy(p) .or. .not. stacks%may_separate(p)) cycle
        if (plate%setup%delaminations(plate%zone(p))%growth_control /= growth_by_energy) cycle
        call find_at(self, plate, i, stacks, cohesive, u)
      end associate
    end do
  end subroutine find

  !> Collects the values of this rank's points and of those of other ranks in their stencils. Collective.
  subroutine gather(self, plate, stacks, cohesive, u)
    !> The search; receives the values
    type(front_onsets_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(interface_stacks_t), intent(in) :: stacks
    type(cohesive_interfaces_t), intent(in) :: cohesive
    real(wp), intent(in) :: u(:, :)
    integer :: i

    do i = 1, size(self%stencils%points)
      associate (p => self%stencils%points(i))
        if (.not. stacks%area(p) > 0) cycle
        associate (value => self%values(:, plate%distribution%points(p)))
          value(of_tractions) = stacks%history(p)%forces/stacks%area(p)
          value(of_jumps) = u(1:3, p)
          value(of_damage) = cohesive%points(p)%damage
        end associate
      end associate
    end do
    call copy_to_images(self, plate, stacks)
    call self%stencils%exchange%update(self%values)
  end subroutine gather

  !> Gives points that share the equations of their image in a full plate the values of that image, the first of all
  !> images, which is on the same rank.
  subroutine copy_to_images(self, plate, stacks)
    !> The search, with the values of independent points; receives those of their images
    type(front_onsets_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(interface_stacks_t), intent(in) :: stacks
    real(wp) :: signs(3)
    integer :: i, k, point

    associate (images => plate%constraints%images)
      if (.not. allocated(images%points)) return
      do i = 1, size(self%stencils%points)
        if (stacks%area(self%stencils%points(i)) > 0) cycle
        point = plate%distribution%points(self%stencils%points(i))
        k = minloc(images%points(point, :), dim=1)
        if (images%points(point, k) >= point) cycle
        signs = images%signs(:3, k)
        self%values(:, point) = self%values(:, images%points(point, k))*[signs, signs, 1.0_wp]
      end do
    end associate
  end subroutine copy_to_images

  !> Reduces the law of a point if the energy release rate has reached the onset in one of the directions of growth.
  pure subroutine find_at(self, plate, i, stacks, cohesive, u)
    type(front_onsets_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Index of the point among those with an interface
    integer, intent(in) :: i
    type(interface_stacks_t), intent(inout) :: stacks
    !> The interfaces; receive the law
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), intent(in) :: u(:, :)
    real(wp) :: rate, largest, strength, opening
    integer :: d, direction

    associate (p => self%stencils%points(i), near => self%stencils%near(:, :, i), &
               images => self%stencils%images(:, :, i))
      largest = 0
      direction = 0
      do d = 1, size(near, 2)
        if (any(near(behind:far_behind, d) == 0)) cycle
        if (.not. self%values(of_damage, near(behind, d)) > 0) cycle
        rate = rate_in(self, plate%interfaces%cohesive_laws(plate%zone(p)), plate%distribution%points(p), near(:, d), &
                       images(:, d), self%stencils%widths(:, d, i))
        if (.not. rate > largest) cycle
        largest = rate
        direction = d
      end do
      if (largest < onset_share) return
      call reduce_law(plate%interfaces%cohesive_laws(plate%zone(p)), u(1:3, p), &
                      stacks%history(p)%forces/stacks%area(p), taken(self, of_jumps, near(behind, direction), &
                      images(behind, direction)), strength, opening)
      if (strength < cohesive%strength(p) .or. (opening < 1 .and. .not. cohesive%strength(p) < 1)) &
        call stacks%begin_softening(plate, cohesive, p, [strength, opening], u)
    end associate
  end subroutine find_at

  !> Energy release rate over the toughness for growth in one direction.
  pure real(wp) function rate_in(self, law, point, near, images, widths) result(rate)
    type(front_onsets_t), intent(in) :: self
    !> The law of the undamaged interface
    type(cohesive_law_t), intent(in) :: law
    !> The point of the mesh, those ahead and behind, and their columns of `jump_signs`
    integer, intent(in) :: point, near(3), images(3)
    !> Lengths that belong to the point and to the node ahead
    real(wp), intent(in) :: widths(2)
    real(wp) :: tractions(3, 2), jumps(3, 2)

    tractions(:, 1) = self%values(of_tractions, point)
    tractions(:, 2) = taken(self, of_tractions, near(ahead), images(ahead))
    jumps(:, 1) = taken(self, of_jumps, near(behind), images(behind))
    jumps(:, 2) = taken(self, of_jumps, near(far_behind), images(far_behind))
    rate = release_over_toughness(law, tractions, jumps, widths)
  end function rate_in

  !> Traction or jump of a node of a stencil; zero without a node.
  pure function taken(self, which, point, image) result(vector)
    type(front_onsets_t), intent(in) :: self
    !> Indices of the values
    integer, intent(in) :: which(3)
    !> The point of the mesh, and its column of `jump_signs`
    integer, intent(in) :: point, image
    !> Two shears and opening
    real(wp) :: vector(3)

    vector = 0
    if (point == 0) return
    vector = jump_signs(:, image)*self%values(which, point)
  end function taken
end module front_onsets
