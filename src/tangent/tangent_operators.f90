!> The factored operator that turns a residual of equilibrium into a correction of the displacement.
!> It is a preconditioner that may lag behind the state: with the exact internal force in the residual
!> its age changes the number of iterations, never the converged answer.
module tangent_operators
  use kinds, only: wp
  use errors, only: error_t
  use timers, only: timer_set_t
  use linear_solvers, only: linear_solver_t
  use numberings, only: numbering_t, number_equations
  use models, only: model_t
  use interface_states, only: interface_state_t
  use anderson_acceleration, only: anderson_t
  use operator_assembly, only: assemble_elements, assemble_diagonal, assemble_tangents
  use membrane_operators, only: membrane_operator_t, create_membrane_operator
  use operator_solvers, only: set_solver_up, solve_field
  use woodbury_updates, only: woodbury_updates_t, list_changes
  implicit none
  private
  public :: tangent_operator_t

  !> Changes that are followed before a factorization is cheaper: each adds to every correction.
  integer, parameter :: most_changes = 500
  !> Columns kept since a factorization, and numbers in all of them together: 0.8 GB however large the model.
  integer, parameter :: most_columns = 800
  real(wp), parameter :: most_numbers = 1.0e8_wp
  !> Columns found at once: more no longer are found faster, and ask for memory that is new to the process each time.
  integer, parameter :: columns_at_once = 64

  !> A factor of `stiffness_factor*tangent + mass_factor*mass`, with many components because it keeps what made it.
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
    !> Section stiffness of the elements at that time, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Diagonal of the operator, (5, points)
    real(wp), allocatable :: diagonal(:, :)
    !> Displacement under a unit force of the impactor, and without the changes since the factorization, (5, points)
    real(wp), allocatable :: response(:, :), fresh_response(:, :)
    !> Stiffness added to the three jumps of each point when factored, and with the changes since then, (3, points)
    real(wp), allocatable :: added(:, :), present(:, :)
    !> Changes of ties and contacts since then
    type(woodbury_updates_t) :: changes
    !> The operator of the motion in the plane alone, where that is worth having
    type(membrane_operator_t), allocatable :: membrane
    !> What the iterations of the present step have shown
    type(anderson_t) :: anderson
    !> Deflection of the struck point at which the tangent was taken
    real(wp) :: deflection = 0
    !> Mean deflection of the patch under that force
    real(wp) :: compliance = 0
    !> True: condensed corrections take the place of Woodbury's
    logical :: condenses = .false.
    !> Iterations of the present step before which ties or contacts had changed
    integer :: switches = 0
    !> Factorizations, and corrections solved for, so far
    integer :: factorizations = 0, solves = 0
    !> Time spent in the parts of a step
    type(timer_set_t) :: timers
  contains
    !> Numbers the equations and sets the solver up.
    procedure :: create
    !> Assembles and factors the operator at a displacement.
    procedure :: renew
    !> Follows changes of ties and contacts without a factorization.
    procedure :: follow
    !> Correction of the displacement for a residual.
    procedure :: correct
    !> Answers to unit forces, and to one of the impactor, and what changes since the factorization make of an answer.
    procedure :: find_columns
    procedure :: find_response
    procedure :: follow_changes
    !> Factors what has been assembled, and puts changes since then in force.
    procedure :: factorize
    procedure :: put_in_force
    !> Frees the factors.
    procedure :: release
  end type tangent_operator_t

contains

  !> Numbers the equations of a model and sets the solver up.
  subroutine create(self, model, factorization, error)
    !> The operator
    class(tangent_operator_t), intent(out) :: self
    type(model_t), intent(in) :: model
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error

    allocate (self%displacement(5, size(model%distribution%points)), source=0.0_wp)
    self%response = self%displacement
    self%diagonal = self%displacement
    self%added = self%displacement(:3, :)
    self%present = self%added
    self%stiffness = model%elements%stiffness
    call number_equations(model%mesh, model%distribution, model%held, self%numbering, model%images)
    self%timers%profile = model%profile
    call set_solver_up(model, self%numbering, factorization, self%solver, error)
    if (allocated(error)) return
    ! The solver has its own copy of this large list.
    deallocate (self%numbering%columns)
    call create_membrane_operator(model, factorization, self%membrane, error)
  end subroutine create

  !> Assembles and factors the operator at a displacement, and finds the response to a unit force.
  subroutine renew(self, model, stiffness, interfaces, displacement, stiffness_factor, mass_factor, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Ties, contacts and cohesive laws
    type(interface_state_t), intent(in) :: interfaces
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Set if the operator is singular
    type(error_t), allocatable, intent(out) :: error

    self%displacement = displacement
    self%stiffness = stiffness
    self%deflection = model%deflection(displacement)
    self%stiffness_factor = stiffness_factor
    self%mass_factor = mass_factor
    call self%timers%start('assembly')
    call self%solver%clear()
    call assemble_elements(model, stiffness, self%numbering, displacement, stiffness_factor, mass_factor, self%solver, &
                           self%diagonal)
    if (allocated(interfaces%cohesive%tangents)) &
      call assemble_tangents(model, self%numbering, interfaces%cohesive%tangents, self%solver)
    call interfaces%added_stiffness(model, self%diagonal, stiffness_factor, self%added)
    self%present = self%added
    call self%timers%stop('assembly')
    call self%factorize(model, error)
  end subroutine renew

  !> Factors what has been assembled, the stiffness added to the jumps included, and finds the response
  !> to a unit force.
  subroutine factorize(self, model, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the operator is singular
    type(error_t), allocatable, intent(inout) :: error

    if (model%has_bonds) call assemble_diagonal(model, self%numbering, self%added, self%solver)
    call self%solver%finish_assembly(error)
    call self%timers%start('factorization')
    if (.not. allocated(error)) call self%solver%factorize(error)
    if (allocated(self%membrane) .and. .not. allocated(error)) &
      call self%membrane%renew(model, self%stiffness, self%displacement, self%stiffness_factor, self%mass_factor, error)
    call self%timers%stop('factorization')
    self%ready = .not. allocated(error)
    if (.not. self%ready) return
    self%factorizations = self%factorizations + 1
    call self%changes%clear()
    call self%anderson%forget()
    self%response = 0
    self%compliance = 0
    if (model%scene%has_impactor) call self%find_response(model, error)
    self%fresh_response = self%response
  end subroutine factorize

  !> Finds the response to a unit force of the impactor.
  subroutine find_response(self, model, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: force(:, :)

    allocate (force, mold=self%response)
    force = 0
    force(3, :) = model%patch/model%mesh%multiplicity
    call solve_field(model, self%numbering, self%solver, self%timers, 'solve', force, self%response, error)
    self%compliance = model%patch_mean(self%response)
  end subroutine find_response

  !> Follows changes of ties and contacts since the factorization.
  subroutine follow(self, model, interfaces, possible, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Ties, contacts and cohesive laws now
    type(interface_state_t), intent(in) :: interfaces
    !> False: they are too many, the operator has to be renewed
    logical, intent(out) :: possible
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: wanted(:, :), stiffness(:)
    integer, allocatable :: equations(:)
    integer :: k

    possible = .true.
    if (.not. model%has_bonds) return
    allocate (wanted, mold=self%added)
    call interfaces%added_stiffness(model, self%diagonal, self%stiffness_factor, wanted)
    if (self%condenses) where (spread(interfaces%cohesive%cohesive, 1, 3)) wanted = self%present
    call list_changes(model%communicator, self%numbering, self%diagonal, self%added, wanted, equations, stiffness)
    possible = size(equations) <= most_changes .and. &
               self%changes%kept + count([(self%changes%column_of(equations(k)) == 0, k=1, size(equations))]) &
               <= min(most_columns, int(most_numbers/self%numbering%total))
    if (.not. possible .or. self%changes%same(equations, stiffness)) return
    call self%put_in_force(model, equations, stiffness, error)
    if (allocated(error)) return
    self%switches = self%switches + 1
    call self%anderson%forget()
  end subroutine follow

  !> Puts changes in force, after finding the columns that they lack, and finds the response to a unit force anew.
  subroutine put_in_force(self, model, equations, stiffness, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Equations changed, the same on every rank, ascending
    integer, intent(in) :: equations(:)
    !> Stiffness added to their diagonals, none zero
    real(wp), intent(in) :: stiffness(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    integer :: k, first

    associate (wanting => pack(equations, [(self%changes%column_of(equations(k)) == 0, k=1, size(equations))]))
      do first = 1, size(wanting), columns_at_once
        call find_columns(self, model, wanting(first:min(first + columns_at_once - 1, size(wanting))), error)
        if (allocated(error)) return
      end do
    end associate
    call self%changes%set(equations, stiffness)
    call self%changes%spread_out(self%numbering, self%present)
    self%present = self%added + self%present
    if (self%condenses) return
    self%response = self%fresh_response
    call self%follow_changes(model, self%response)
    self%compliance = model%patch_mean(self%response)
  end subroutine put_in_force

  !> Finds columns together.
  subroutine find_columns(self, model, equations, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Equations wanted, none of which has its column yet, the same on every rank
    integer, intent(in) :: equations(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: forces(:, :), values(:, :), fields(:, :, :)
    integer :: begin, number, k

    if (size(equations) == 0) return
    number = min(columns_at_once, size(equations))
    allocate (forces(self%numbering%rows, number), values(self%numbering%rows, number))
    allocate (fields(5, size(self%response, 2), size(equations)), source=0.0_wp)
    do begin = 0, size(equations) - 1, columns_at_once
      number = min(columns_at_once, size(equations) - begin)
      forces = 0
      do k = 1, number
        associate (equation => equations(begin + k))
          if (self%numbering%owns(equation)) forces(equation - self%numbering%first_row + 1, k) = 1
        end associate
      end do
      call self%timers%start('solve', part='answers to unit forces')
      call self%solver%solve_many(forces(:, :number), values(:, :number), error)
      call self%timers%stop('solve')
      if (allocated(error)) return
      do k = 1, number
        call self%numbering%scatter(values(:, k), fields(:, :, begin + k))
        call model%halo%update(fields(:, :, begin + k))
      end do
    end do
    call self%changes%keep(model%communicator, self%numbering, equations, fields)
  end subroutine find_columns

  !> Correction of the displacement for a residual, ghosts included.
  subroutine correct(self, model, residual, correction, error)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(out) :: error

    call solve_field(model, self%numbering, self%solver, self%timers, 'solve', residual, correction, error)
    self%solves = self%solves + 1
    if (.not. (allocated(error) .or. self%condenses)) call self%follow_changes(model, correction)
  end subroutine correct

  !> Turns a solution of the operator as it was factored into one of the operator as it is now.
  subroutine follow_changes(self, model, solution)
    !> The operator
    class(tangent_operator_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Solution, ghosts included, (5, points)
    real(wp), intent(inout) :: solution(:, :)

    if (size(self%changes%equations) == 0) return
    call self%changes%correct(model%communicator, self%numbering, solution)
    call model%halo%update(solution)
  end subroutine follow_changes

  !> Frees the factors.
  subroutine release(self)
    !> The operator
    class(tangent_operator_t), intent(inout) :: self

    if (allocated(self%solver)) call self%solver%release()
    if (allocated(self%membrane)) call self%membrane%release()
  end subroutine release
end module tangent_operators
