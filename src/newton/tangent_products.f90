!> Product of the current tangent with a vector, theory (N1), without its matrix: by the directional derivative of the
!> element forces, or by adding the change of the tangent to the product with the matrix that was factored. The factored
!> operator is the preconditioner.
module tangent_products
  use kinds, only: wp
  use errors, only: error_t
  use krylov_solvers, only: linear_system_t
  use models, only: model_t
  use tangent_forces, only: add_tangent_force
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: tangent_product_t

  !> The tangent.
  type, extends(linear_system_t) :: tangent_product_t
    !> Mesh, numbering and interfaces of the plate
    type(model_t), pointer :: model => null()
    !> The factored operator, with its equations
    type(tangent_operator_t), pointer :: operator => null()
    !> Factors of stiffness and mass, and the increase of the latter over that in the factored operator
    real(wp) :: stiffness_factor = 0, mass_factor = 0, mass_change = 0
    !> True: the element tangents differ from those in the factored operator
    logical :: elements = .false.
    !> Displacement at which element tangents are taken, ghosts up to date, (5, points)
    real(wp), pointer, contiguous :: displacement(:, :) => null()
    !> Section stiffness of the elements, (lanes, 21, batches), and resultants of stress-free strains,
    !> if there are any
    real(wp), pointer, contiguous :: stiffness(:, :, :) => null(), free(:, :, :) => null()
    !> Changes of the sections against mean strains, (lanes, change_values, batches); null: none
    real(wp), pointer, contiguous :: mean_change(:, :, :) => null()
    !> Stiffness of the jumps of each point: all of it with element tangents, else its increase over that in the
    !> factored operator, (3, 3, points); unallocated: none
    real(wp), allocatable :: jumps(:, :, :)
    !> True: cohesive points soften, so that the tangent may be indefinite
    logical :: softens = .false.
    !> Diagonal, (5, points); unallocated: the tangent is the factored operator
    real(wp), allocatable :: diagonal(:, :)
    !> Decrease of the impactor's force per mean deflection of the patch
    real(wp) :: force_slope = 0
    !> Right-hand side of a unit force
    real(wp), allocatable :: pattern(:)
  contains
    procedure :: multiply
    procedure :: precondition
    procedure :: is_factored
    procedure :: mean
    procedure :: set_jump_stiffness
    procedure :: set_skew_part
    procedure, private :: add_elements
  end type tangent_product_t

contains

  !> True if the tangent equals the factored operator, except for the slope of the impactor's force.
  pure logical function is_factored(self)
    class(tangent_product_t), intent(in) :: self

    is_factored = .not. (self%elements .or. allocated(self%jumps) .or. abs(self%mass_change) > 0)
  end function is_factored

  !> The tangent times a vector. Collective.
  subroutine multiply(self, vector, product, error)
    class(tangent_product_t), intent(inout) :: self
    !> Motion of this rank's rows
    real(wp), intent(in) :: vector(:)
    !> Their forces
    real(wp), intent(out) :: product(:)
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: field(:, :), force(:, :), inertia(:, :), rows(:)
    real(wp) :: factor
    integer :: i

    product = 0
    if (.not. self%elements) call self%operator%solver%matrix%multiply(vector, product, error)
    if (.not. self%is_factored()) then
      allocate (field, force, inertia, mold=self%displacement)
      field = 0
      call self%operator%numbering%scatter(vector, field)
      call self%model%plate%halo%update(field)
      force = 0
      if (self%elements) call self%add_elements(field, force)
      factor = merge(self%mass_factor, self%mass_change, self%elements)
      if (abs(factor) > 0) then
        call self%model%inertia(field, inertia)
        force = force + factor*inertia
      end if
      if (allocated(self%jumps)) then
        do i = 1, self%operator%numbering%owned
          force(1:3, i) = force(1:3, i) + matmul(self%jumps(:, :, i), field(1:3, i))
        end do
      end if
      allocate (rows, mold=product)
      call self%operator%numbering%gather(force, rows)
      product = product + rows
    end if
    if (self%force_slope > 0) product = product + self%force_slope*self%mean(vector)*self%pattern
  end subroutine multiply

  !> Solution by the factored operator, with the rank-one term of the impactor's force (Sherman, Morrison). Collective.
  subroutine precondition(self, vector, product, error)
    class(tangent_product_t), intent(inout) :: self
    !> Forces on this rank's rows
    real(wp), intent(in) :: vector(:)
    !> Their motion
    real(wp), intent(out) :: product(:)
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error

    associate (operator => self%operator, slope => self%force_slope)
      call operator%solve_rows(vector, product, error)
      operator%solves = operator%solves + 1
      if (allocated(error) .or. .not. slope > 0) return
      product = product - slope*self%mean(product)/(1 + slope*operator%compliance)*operator%response_rows
    end associate
  end subroutine precondition

  !> Mean deflection of the patch in a motion. Collective.
  real(wp) function mean(self, motion)
    class(tangent_product_t), intent(in) :: self
    !> Motion of this rank's rows
    real(wp), intent(in) :: motion(:)

    mean = self%model%plate%mesh%multiplicity*dot_product(self%pattern, motion)
    call self%model%plate%communicator%sum(mean)
  end function mean

  !> Sets the stiffness of the jumps: diagonals of ties, contacts and frames, and tangents of cohesive laws. Collective.
  subroutine set_jump_stiffness(self, factored, now, cohesive, tangents)
    !> The tangent, its elements already set
    class(tangent_product_t), intent(inout) :: self
    !> Diagonals in the factored operator, and at present, (3, points)
    real(wp), intent(in) :: factored(:, :), now(:, :)
    !> True at points with a cohesive law; unallocated: none
    logical, allocatable, intent(in) :: cohesive(:)
    !> Their tangents times the factor of stiffness, (3, 3, points); used with `cohesive` only
    real(wp), intent(in) :: tangents(:, :, :)
    real(wp) :: softening
    integer :: i, k

    allocate (self%jumps(3, 3, self%operator%numbering%owned), source=0.0_wp)
    do i = 1, self%operator%numbering%owned
      do k = 1, 3
        self%jumps(k, k, i) = now(k, i)
      end do
      if (allocated(cohesive)) then
        if (cohesive(i)) then
          self%jumps(:, :, i) = tangents(:, :, i)
          ! The tangent may be indefinite where the damage of a point grows.
          associate (t => tangents(:, :, i))
            self%softens = self%softens .or. any([t(1, 1), t(2, 2), t(3, 3)] < 0) &
                           .or. any(abs([t(1, 2), t(1, 3), t(2, 3)]) > 0)
          end associate
        end if
      end if
      if (self%elements) cycle
      do k = 1, 3
        self%jumps(k, k, i) = self%jumps(k, k, i) - factored(k, i)
      end do
    end do
    call drop_if_zero(self)
    softening = merge(1.0_wp, 0.0_wp, self%softens)
    call self%model%plate%communicator%maximum(softening)
    self%softens = softening > 0
  end subroutine set_jump_stiffness

  !> Sets the skew-symmetric parts of the tangents of cohesive laws. Collective.
  subroutine set_skew_part(self, tangents)
    class(tangent_product_t), intent(inout) :: self
    !> Force per jump, (3, 3, points)
    real(wp), intent(in) :: tangents(:, :, :)
    integer :: i

    allocate (self%jumps(3, 3, self%operator%numbering%owned), source=0.0_wp)
    do i = 1, self%operator%numbering%owned
      if (self%model%plate%zone(i) > 0) self%jumps(:, :, i) = (tangents(:, :, i) - transpose(tangents(:, :, i)))/2
    end do
    call drop_if_zero(self)
  end subroutine set_skew_part

  !> Deallocates the stiffness of jumps if it is zero. Collective.
  subroutine drop_if_zero(self)
    type(tangent_product_t), intent(inout) :: self
    real(wp) :: largest

    largest = maxval([0.0_wp, abs(self%jumps)])
    call self%model%plate%communicator%maximum(largest)
    if (.not. largest > 0) deallocate (self%jumps)
  end subroutine drop_if_zero

  !> Adds the forces of elements and line supports.
  subroutine add_elements(self, motion, force)
    class(tangent_product_t), intent(in) :: self
    !> The motion, ghosts up to date, (5, points)
    real(wp), intent(in) :: motion(:, :)
    !> Forces at the owned points, (5, points); overwritten
    real(wp), intent(inout) :: force(:, :)
    real(wp), allocatable :: columns(:, :), lines(:, :), zero_motion(:, :)
    real(wp) :: energy

    associate (model => self%model)
      allocate (columns(5, max(size(force, 2), model%plate%borders%columns)), source=0.0_wp)
      call add_tangent_force(model%plate%elements, self%stiffness, model%plate%setup%mesh%kinematics, &
                             model%plate%motion_of(self%displacement), model%plate%motion_of(motion), columns, &
                             self%free, self%mean_change)
      call model%plate%borders%add(columns)
      force = columns(:, :size(force, 2))
      if (model%plate%map%layered) call model%plate%map%to_unknowns(force)
      energy = 0
      call model%rig%add_line_forces(motion, force, energy)
      force = self%stiffness_factor*force
      if (size(model%loads%lines) == 0) return
      allocate (lines, zero_motion, mold=force)
      zero_motion = 0
      call model%loads%line_forces(zero_motion, 0.0_wp, lines, prescribed=.true.)
      force = force + lines
      call model%loads%line_forces(motion, 0.0_wp, lines, prescribed=.true.)
      force = force - lines
    end associate
  end subroutine add_elements
end module tangent_products
