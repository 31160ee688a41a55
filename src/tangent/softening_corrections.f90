!> Corrections of an iteration with cohesive points in equilibrium on the plate as the factored operator has it.
module softening_corrections
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use outside_forces, only: outside_force_t
  use plate_answers, only: linear_plate_t, plate_answers_t
  use softening_equilibria, only: find_equilibrium
  use softening_points, only: softening_points_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: softening_memory_t

  !> Answers of one correction at most, and of a step until the operator is renewed, which costs about as much: with
  !> 12, 20, 30 and 40 the whole of peanut.nml takes .85, .79, .80 and 1 of the time.
  integer, parameter :: most_answers = 30, most_kept = 30

  !> What earlier corrections of a step have found.
  type :: softening_memory_t
    !> Answers of the operator
    type(plate_answers_t), private :: kept
    !> Factorizations and changes of the operator when they were found
    integer, private :: factorizations = -1, switches = -1
    !> True: so many points soften in this step that none of them gets an answer of its own
    logical :: crowded = .false.
    !> True: points have snapped in this step, so there may be other equilibria
    logical :: bursts = .false.
  contains
    !> Turns the operator's answer into a correction.
    procedure :: correct => soften
    !> Forgets all.
    procedure :: forget
    !> True if it has answers of an operator.
    procedure, private :: in_use
    !> True once the operator should be renewed.
    procedure :: is_full
  end type softening_memory_t

  !> The plate as the operator has it.
  type, extends(linear_plate_t) :: operator_plate_t
    !> The factored operator
    type(tangent_operator_t), pointer :: operator => null()
    !> Mesh, numbering and interfaces of the plate
    type(model_t), pointer :: model => null()
  contains
    procedure :: answer
    procedure :: sum => sum_over
    procedure :: size => size_of
  end type operator_plate_t

contains

  !> Forgets all, as a step begins.
  pure subroutine forget(self)
    !> The memory
    class(softening_memory_t), intent(inout) :: self

    self%factorizations = -1
    self%crowded = .false.
    self%bursts = .false.
  end subroutine forget

  !> True if it has answers of an operator as it is now.
  pure logical function in_use(self, operator)
    !> The memory
    class(softening_memory_t), intent(in) :: self
    !> The operator
    type(tangent_operator_t), intent(in) :: operator

    in_use = self%factorizations == operator%factorizations .and. self%switches == operator%switches
  end function in_use

  !> True once the operator should be renewed: more answers would cost more than a factorization.
  pure logical function is_full(self, operator)
    !> The memory
    class(softening_memory_t), intent(in) :: self
    !> The operator
    type(tangent_operator_t), intent(in) :: operator

    is_full = self%in_use(operator) .and. self%kept%kept > most_kept
  end function is_full

  !> Turns the operator's answer to a residual into a correction with cohesive points and the impactor in equilibrium.
  subroutine soften(self, operator, model, old, displacement, outside, residual, correction, error)
    !> The memory
    class(softening_memory_t), intent(inout) :: self
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> Displacement before the correction, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Force of the impactor; unallocated: there is none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> The residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(operator_plate_t) :: plate
    type(softening_points_t) :: points
    real(wp), allocatable :: pattern(:, :)

    plate%operator => operator
    plate%model => model
    call gather_points(operator, model, old, displacement, points)
    allocate (pattern, mold=residual)
    pattern = 0
    if (allocated(outside)) pattern(3, :) = model%patch/model%mesh%multiplicity
    ! Answers of another operator are none of this one's.
    if (.not. self%in_use(operator)) &
      call self%kept%clear(size(residual, 2), model%distribution%owned, most_kept + most_answers)
    self%factorizations = operator%factorizations
    self%switches = operator%switches
    call operator%follow_changes(model, correction)
    call operator%timers%start('softening')
    call find_equilibrium(plate, self%kept, points, outside, pattern, residual, most_answers, correction, error, &
                          self%bursts)
    call operator%timers%stop('softening')
  end subroutine soften

  !> Gathers this rank's cohesive points.
  pure subroutine gather_points(operator, model, old, displacement, self)
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    type(model_t), intent(in) :: model
    !> Cohesive interfaces in the last accepted state
    type(cohesive_interfaces_t), intent(in) :: old
    !> Displacement before the correction, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> The points
    type(softening_points_t), intent(out) :: self
    type(cohesive_point_t) :: new
    integer :: i, k

    self%places = pack([(i, i=1, model%distribution%owned)], old%cohesive(:model%distribution%owned))
    allocate (self%list(size(self%places)))
    do k = 1, size(self%places)
      i = self%places(k)
      associate (point => self%list(k))
        point%faces = old%faces_of(model, model%zone(i), old%strength(i))
        point%old = old%points(i)
        point%area = model%contact_area(i)*operator%stiffness_factor
        point%jumps = displacement(1:3, i)
        point%held = operator%present(:, i)
        call point%faces%traction(point%jumps, point%old, point%traction, new)
      end associate
    end do
  end subroutine gather_points

  !> Motion under forces.
  subroutine answer(self, forces, motion, error)
    !> The plate
    class(operator_plate_t), intent(inout) :: self
    !> Forces at the owned points, (5, local points)
    real(wp), intent(in) :: forces(:, :)
    !> Motion, (5, local points)
    real(wp), intent(inout) :: motion(:, :)
    !> Set if there is none
    type(error_t), allocatable, intent(inout) :: error

    call self%operator%correct(self%model, forces, motion, error)
    if (.not. allocated(error)) call self%operator%follow_changes(self%model, motion)
  end subroutine answer

  !> Sums over the ranks.
  subroutine sum_over(self, sums)
    !> The plate
    class(operator_plate_t), intent(in) :: self
    !> Sums of this rank's owned points on entry, of all on return
    real(wp), intent(inout) :: sums(:)

    call self%model%communicator%sum(sums)
  end subroutine sum_over

  !> Size of forces: that of the motions which they cause of each unknown alone, by the operator's diagonal. The same on
  !> every rank.
  real(wp) function size_of(self, forces)
    !> The plate
    class(operator_plate_t), intent(in) :: self
    !> Forces, (5, local points)
    real(wp), intent(in) :: forces(:, :)
    real(wp), allocatable :: folded(:, :), diagonal(:, :)

    associate (operator => self%operator, numbering => self%operator%numbering)
      folded = forces(:, :numbering%owned)
      call numbering%fold(folded)
      diagonal = operator%diagonal(:, :numbering%owned)
      diagonal(:3, :) = diagonal(:3, :) + operator%present(:, :numbering%owned)
      size_of = sum(folded**2/diagonal, mask=numbering%equation(:, :numbering%owned) >= 0)
    end associate
    call self%model%communicator%sum(size_of)
    size_of = sqrt(size_of)
  end function size_of
end module softening_corrections
