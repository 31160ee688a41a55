!> Sections of the elements against their mean strains, where plies have another modulus along the fibres in
!> compression: the changes by compressed sub-plies, which are updated where a sign changes.
module mean_sections
  use batch_resultants, only: mean_resultants
  use element_batches, only: batch_of, lane_of, lanes
  use kinds, only: wp
  use mean_stiffnesses, only: change_values, mean_change, sub_ply_middle, mean_strains_at
  use composite_plates, only: composite_plate_t
  use ply_stacks, only: ply_stack_t
  use plies, only: ply_t, compressed, uniaxial_strain
  implicit none
  private
  public :: mean_sections_t, new_mean_sections

  !> The sections.
  type :: mean_sections_t
    !> Change of each section by its compressed sub-plies, (lanes, change_values, batches)
    real(wp), allocatable :: change(:, :, :)
    !> Uniaxial strain of each undamaged sub-ply: factors of the six mean strains, and a constant, (7, sub-plies)
    real(wp), allocatable, private :: factors(:, :)
    !> Change by each undamaged sub-ply in compression, (change_values, sub-plies)
    real(wp), allocatable, private :: contributions(:, :)
    !> Signs of the stresses of sub-plies: -1 in compression, otherwise 1, (lanes, sub-plies, batches)
    real(wp), allocatable, private :: signs(:, :, :)
    !> First and last sub-ply of each element, (lanes, 2, batches); 1, 0 in unused lanes
    integer, allocatable, private :: range(:, :, :)
    !> True for elements whose change is not that of their undamaged sub-plies, (lanes, batches)
    logical, allocatable, private :: is_set(:, :)
  contains
    procedure :: update
    procedure :: set_element
    procedure :: add_excess
    procedure :: resultants
  end type mean_sections_t

contains

  !> Sections with all sub-plies in tension.
  function new_mean_sections(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(mean_sections_t) :: self
    integer :: first(plate%layup%plies + 1, size(plate%layup%laminates)), range(2), k, element

    call number_sub_plies(self, plate%layup%laminates, first)
    associate (batches => plate%elements%batches)
      allocate (self%change(lanes, change_values, batches), source=0.0_wp)
      allocate (self%signs(lanes, size(self%factors, 2), batches), source=1.0_wp)
      allocate (self%range(lanes, 2, batches), self%is_set(lanes, batches))
      self%is_set = .false.
      self%range(:, 1, :) = 1
      self%range(:, 2, :) = 0
    end associate
    do element = 1, plate%elements%elements
      k = plate%mesh%layers(plate%layup%stack(element))%laminate
      range = plate%layup%stacks(plate%layup%stack(element))%places()
      self%range(lane_of(element), :, batch_of(element)) = [first(range(1), k), first(range(2) + 1, k) - 1]
    end do
  end function new_mean_sections

  !> Numbers the sub-plies of the different laminates consecutively, with their factors and contributions.
  pure subroutine number_sub_plies(self, laminates, first)
    type(mean_sections_t), intent(inout) :: self
    !> The laminates
    type(ply_stack_t), intent(in) :: laminates(:)
    !> First sub-ply of each ply of a laminate and after its last one, (plies + 1, laminates)
    integer, intent(out) :: first(:, :)
    integer :: i, place, number, next

    next = 1
    do i = 1, size(laminates)
      do place = 1, size(laminates(i)%plies)
        first(place, i) = next
        next = next + laminates(i)%plies(place)%sub_plies
      end do
      first(size(laminates(i)%plies) + 1:, i) = next
    end do
    allocate (self%factors(7, next - 1), self%contributions(change_values, next - 1))
    do i = 1, size(laminates)
      do place = 1, size(laminates(i)%number)
        associate (ply => laminates(i)%plies(place))
          do number = 1, ply%sub_plies
            next = first(place, i) + number - 1
            self%factors(:, next) = uniaxial_factors(ply, sub_ply_middle(ply, number))
            self%contributions(:, next) = mean_change(ply, ply%elasticity, compressed(ply%elasticity), &
                                                      sub_ply_middle(ply, number))
          end do
        end associate
      end do
    end do
  end subroutine number_sub_plies

  !> Factors of the mean strains of an element in the uniaxial strain of an undamaged ply at a height, and a constant.
  pure function uniaxial_factors(ply, z) result(factors)
    type(ply_t), intent(in) :: ply
    !> The height
    real(wp), intent(in) :: z
    !> The factors
    real(wp) :: factors(7)
    real(wp) :: unit(6)
    integer :: i

    unit = 0
    factors(7) = uniaxial_strain(ply%elasticity, mean_strains_at(ply, unit, z))
    do i = 1, 6
      unit = 0
      unit(i) = 1
      factors(i) = uniaxial_strain(ply%elasticity, mean_strains_at(ply, unit, z) + ply%free_strain(:2))
    end do
  end function uniaxial_factors

  !> Finds the compressed sub-plies of the undamaged elements of a batch; sections change where a sign changes.
  pure subroutine update(self, b, means, undamaged)
    class(mean_sections_t), intent(inout) :: self
    integer, intent(in) :: b
    !> Mean strains of its elements, (lanes, 6)
    real(wp), intent(in) :: means(lanes, 6)
    !> False for elements that are set otherwise
    logical, intent(in) :: undamaged(lanes)
    real(wp) :: sign, change(lanes)
    logical :: changed(lanes)
    integer :: k, lane

    change = 0
    do k = minval(self%range(:, 1, b), self%range(:, 2, b) > 0), maxval(self%range(:, 2, b))
      do lane = 1, lanes
        associate (f => self%factors(:, k), e => means(lane, :))
          sign = merge(-1.0_wp, 1.0_wp, f(1)*e(1) + f(2)*e(2) + f(3)*e(3) + f(4)*e(4) + f(5)*e(5) + f(6)*e(6) &
                                        + f(7) < 0)
        end associate
        change(lane) = change(lane) + abs(sign - self%signs(lane, k, b))
        self%signs(lane, k, b) = sign
      end do
    end do
    changed = (change > 0 .or. self%is_set(:, b)) .and. undamaged
    if (.not. any(changed)) return
    do lane = 1, lanes
      if (changed(lane)) self%change(lane, :, b) = sum_of_compressed(self, lane, b)
    end do
    self%is_set(:, b) = self%is_set(:, b) .and. .not. changed
  end subroutine update

  !> Change of the section of an undamaged element.
  pure function sum_of_compressed(self, lane, b) result(change)
    type(mean_sections_t), intent(in) :: self
    !> Lane and batch of the element
    integer, intent(in) :: lane, b
    !> The change
    real(wp) :: change(change_values)
    integer :: k

    change = 0
    do k = self%range(lane, 1, b), self%range(lane, 2, b)
      if (self%signs(lane, k, b) < 0) change = change + self%contributions(:, k)
    end do
  end function sum_of_compressed

  !> Sets the change of the section of a damaged element.
  pure subroutine set_element(self, element, change)
    class(mean_sections_t), intent(inout) :: self
    integer, intent(in) :: element
    !> The change
    real(wp), intent(in) :: change(change_values)

    self%change(lane_of(element), :, batch_of(element)) = change
    self%is_set(lane_of(element), batch_of(element)) = .true.
  end subroutine set_element

  !> Adds the stiffness of undamaged sub-plies in compression where it exceeds that in tension: an upper bound.
  pure subroutine add_excess(self, stiffness)
    class(mean_sections_t), intent(in) :: self
    real(wp), intent(inout) :: stiffness(:, :, :)
    integer :: b, lane, k

    do b = 1, size(stiffness, 3)
      do lane = 1, lanes
        do k = self%range(lane, 1, b), self%range(lane, 2, b)
          associate (c => self%contributions(:18, k))
            if (c(1) + c(4) > 0) stiffness(lane, :18, b) = stiffness(lane, :18, b) + c
          end associate
        end do
      end do
    end do
  end subroutine add_excess

  !> Contribution of the mean strains to the resultants of stress-free strains of a batch.
  pure function resultants(self, b, means)
    class(mean_sections_t), intent(in) :: self
    integer, intent(in) :: b
    !> Mean strains of its elements, (lanes, 6)
    real(wp), intent(in) :: means(lanes, 6)
    !> Nxx to Mxy, energy, (lanes, 7)
    real(wp) :: resultants(lanes, 7)

    associate (change => self%change(:, :, b), forces => resultants(:, :6))
      forces = mean_resultants(change(:, :18), means)
      resultants(:, 7) = change(:, 25) - sum(forces*means, 2)/2
      forces = change(:, 19:24) - forces
    end associate
  end function resultants
end module mean_sections
