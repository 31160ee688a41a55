!> The factored operator that turns a residual of equilibrium into a correction of the displacement.
!> It is a preconditioner that may lag behind the state: with the exact internal force in the residual
!> its age changes the number of iterations, never the converged answer.
module tangent_operators
  use kinds, only: wp
  use errors, only: error_t
  use archives, only: archive_t
  use element_batches, only: lanes, first_element
  use element_tangents, only: tangent
  use linear_solvers, only: linear_solver_t
  use petsc_solvers, only: petsc_solver_t
  use plate_options, only: kinematics_linear
  use dynamics_parameters, only: factorization_cholmod
  use numberings, only: numbering_t, number_equations
  use models, only: model_t
  implicit none
  private
  public :: tangent_operator_t

  !> A factor of `stiffness_factor * tangent stiffness + mass_factor * mass`.
  type :: tangent_operator_t
    !> Equations of the unknowns that are not held
    type(numbering_t) :: numbering
    !> The linear solver that holds the factor
    class(linear_solver_t), allocatable :: solver
    !> True once there is a factor
    logical :: ready = .false.
    !> Factors of stiffness and mass in the factored operator
    real(wp) :: stiffness_factor = 0, mass_factor = 0
    !> Displacement at which the tangent was taken, (5, points)
    real(wp), allocatable :: displacement(:, :)
    !> Diagonal of the operator, (5, points)
    real(wp), allocatable :: diagonal(:, :)
    !> Displacement under a unit force of the impactor, (5, points)
    real(wp), allocatable :: response(:, :)
    !> Deflection of the struck point at which the tangent was taken
    real(wp) :: deflection = 0
    !> Mean deflection of the patch under that force
    real(wp) :: compliance = 0
    !> Factorisations and solves so far
    integer :: factorizations = 0, solves = 0
  contains
    !> Numbers the equations and sets the solver up.
    procedure :: create
    !> Assembles and factors the operator at a displacement.
    procedure :: renew
    !> Correction of the displacement for a residual.
    procedure :: correct
    !> Saves what is needed to make the same factor again, or loads it and makes it.
    procedure :: visit
  end type tangent_operator_t

contains

  !> Numbers the equations of a model and sets the solver up.
  subroutine create(self, model, error)
    !> The operator
    class(tangent_operator_t), intent(out) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error
    type(petsc_solver_t) :: solver
    integer :: points

    points = size(model%distribution%points)
    allocate (self%displacement(5, points), self%response(5, points), self%diagonal(5, points), source=0.0_wp)
    call number_equations(model%mesh, model%distribution, model%held, self%numbering)
    if (model%scene%solver%factorization == factorization_cholmod) solver%package = 'cholmod'
    allocate (self%solver, source=solver)
    call self%solver%define(model%communicator, self%numbering%first_row, self%numbering%total, &
                            self%numbering%row_start, self%numbering%columns, .not. model%scene%has_static .or. &
                            model%scene%kinematics == kinematics_linear, error)
  end subroutine create

  !> Assembles and factors the operator at a displacement, and finds the response to a unit force.
  subroutine renew(self, model, displacement, stiffness_factor, mass_factor, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Set if the operator is singular
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: force(:, :)

    self%displacement = displacement
    self%deflection = model%deflection(displacement)
    self%stiffness_factor = stiffness_factor
    self%mass_factor = mass_factor
    call assemble(self, model, error)
    if (.not. allocated(error)) call self%solver%factorize(error)
    self%ready = .not. allocated(error)
    if (.not. self%ready) return
    self%factorizations = self%factorizations + 1
    self%response = 0
    self%compliance = 0
    if (.not. model%scene%has_impactor) return
    allocate (force(5, size(self%response, 2)), source=0.0_wp)
    force(3, :) = model%patch/model%mesh%multiplicity
    call self%correct(model, force, self%response, error)
    self%compliance = model%patch_mean(self%response)
  end subroutine renew

  !> Assembles the operator at the stored displacement and factors.
  subroutine assemble(self, model, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Set if the assembly fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: matrices(:, :, :)
    real(wp) :: consistent_factor
    integer :: b, lane, point, a, component

    self%diagonal = 0
    consistent_factor = self%mass_factor
    if (allocated(model%lumped)) consistent_factor = 0
    allocate (matrices(lanes, 45, 45))
    call self%solver%clear()
    do b = 1, model%elements%batches
      call tangent(model%elements, b, model%scene%kinematics, self%displacement, self%stiffness_factor, &
                   consistent_factor, matrices)
      do lane = 1, model%elements%lanes_used(b)
        associate (points => model%distribution%connectivity(:, first_element(b) + lane - 1))
          call self%solver%add(reshape(self%numbering%equation(:, points), [45]), matrices(lane, :, :))
          do a = 1, 9
            self%diagonal(:, points(a)) = self%diagonal(:, points(a)) &
              + [(matrices(lane, 5*(a - 1) + component, 5*(a - 1) + component), component=1, 5)]
          end do
        end associate
      end do
    end do
    call model%halo%accumulate(self%diagonal)
    if (allocated(model%lumped)) then
      do point = 1, model%distribution%owned
        call self%solver%add(self%numbering%equation(:, point), self%mass_factor*nodal_mass(model%lumped(:, point)))
      end do
    end if
    call self%solver%finish_assembly(error)
  end subroutine assemble

  !> Mass matrix of one point from its nodal I0, I1, I2.
  pure function nodal_mass(lumped) result(mass)
    !> I0, I1, I2
    real(wp), intent(in) :: lumped(3)
    !> Mass of u, v, w, theta_x, theta_y
    real(wp) :: mass(5, 5)
    integer :: i

    mass = 0
    do i = 1, 3
      mass(i, i) = lumped(1)
    end do
    do i = 1, 2
      mass(i, 3 + i) = lumped(2)
      mass(3 + i, i) = lumped(2)
      mass(3 + i, 3 + i) = lumped(3)
    end do
  end function nodal_mass

  !> Correction of the displacement for a residual, ghosts included.
  subroutine correct(self, model, residual, correction, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: right_hand_side(self%numbering%rows), solution(self%numbering%rows)

    call self%numbering%gather(residual, right_hand_side)
    call self%solver%solve(right_hand_side, solution, error)
    self%solves = self%solves + 1
    if (allocated(error)) return
    call self%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine correct

  !> Saves what is needed to make the same factor again, or loads it and makes it: a lagged factor
  !> shapes the iterations, so a restart must go on with the very same one.
  subroutine visit(self, archive, model, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    !> The model
    type(model_t), intent(in) :: model
    !> Set if the factor cannot be made again
    type(error_t), allocatable, intent(out) :: error
    integer :: factorizations, solves

    call archive%item('operator/ready', self%ready)
    call archive%item('operator/stiffness_factor', self%stiffness_factor)
    call archive%item('operator/mass_factor', self%mass_factor)
    call archive%item('operator/factorizations', self%factorizations)
    call archive%item('operator/solves', self%solves)
    associate (share => model%distribution)
      call archive%field('operator/displacement', share%points(:share%owned), model%mesh%points(), self%displacement)
    end associate
    if (.not. archive%loading .or. .not. self%ready) return
    factorizations = self%factorizations
    solves = self%solves
    call model%halo%update(self%displacement)
    call self%renew(model, self%displacement, self%stiffness_factor, self%mass_factor, error)
    self%factorizations = factorizations
    self%solves = solves
  end subroutine visit
end module tangent_operators
