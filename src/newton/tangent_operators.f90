!> The factored operator that gives a correction of the displacement for a residual of equilibrium. It is a
!> preconditioner that may lag behind the state: as the residual has the exact internal force, its age affects the
!> number of iterations, not the converged solution.
module tangent_operators
  use field_mappings, only: area_field, motion_field
  use kinds, only: wp
  use archives, only: archive_t
  use errors, only: error_t
  use section_bounds, only: uniform_stiffness
  use section_stiffnesses, only: visit_stiffness
  use timers, only: timer_set_t
  use contact_patches, only: contact_patch_t
  use krylov_solvers, only: krylov_solver_t
  use linear_solvers, only: linear_solver_t
  use numberings, only: numbering_t, number_equations
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use states, only: state_t
  use operator_assembly, only: assemble_elements, assemble_diagonal, assemble_tangents, is_positive_definite, &
                               has_separate_membrane
  implicit none
  private
  public :: tangent_operator_t

  !> Factorization of `stiffness_factor*tangent + mass_factor*mass`. It has many components because it includes the data
  !> from which it was computed.
  type :: tangent_operator_t
    !> Equations of the unconstrained unknowns
    type(numbering_t) :: numbering
    !> The linear solver that holds the factor
    type(linear_solver_t), allocatable :: solver
    !> Solvers with the current tangent
    type(krylov_solver_t) :: minimal_residuals, conjugate_gradients
    !> True after a factorization
    logical :: ready = .false.
    !> Factors of stiffness and mass in the factored operator
    real(wp) :: stiffness_factor = 0, mass_factor = 0
    !> Displacement at which the tangent was taken, (5, points)
    real(wp), allocatable :: displacement(:, :)
    !> Section stiffness of the elements at that time, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Diagonal of the operator, (5, points)
    real(wp), allocatable :: diagonal(:, :)
    !> Unit-load solution: displacement under a unit force of the impactor, (5, points), and its rows on this rank
    real(wp), allocatable :: response(:, :), response_rows(:)
    !> Stiffness added to the three jumps of each point, (3, points)
    real(wp), allocatable :: added(:, :)
    !> Deflection of the struck point at which the tangent was taken
    real(wp) :: deflection = 0
    !> Mean deflection of the patch per unit force
    real(wp) :: compliance = 0
    !> Factorizations, and corrections solved for, so far
    integer :: factorizations = 0, solves = 0
    !> Time spent in the parts of a step
    type(timer_set_t) :: timers
  contains
    procedure :: create
    procedure :: renew
    procedure :: correct
    procedure :: find_response
    procedure :: solve_rows
    procedure :: rows_of
    procedure :: has_outdated_constraints
    procedure :: factorize
    procedure :: visit
    procedure :: release
  end type tangent_operator_t

contains

  !> Numbers the equations of a model and creates the solver.
  subroutine create(self, model, factorization, error)
    class(tangent_operator_t), intent(out) :: self
    type(model_t), intent(in) :: model
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> Set if the solver cannot be created
    type(error_t), allocatable, intent(out) :: error

    allocate (self%displacement(5, size(model%plate%distribution%points)), source=0.0_wp)
    self%response = self%displacement
    self%diagonal = self%displacement
    self%added = self%displacement(:3, :)
    self%stiffness = model%plate%elements%stiffness
    self%timers%profile = model%plate%profile
    allocate (self%solver)
    self%solver%factorization = factorization
    call set_pattern(self, model, has_separate_membrane(model, self%stiffness, self%displacement), error)
    if (allocated(error)) return
    allocate (self%response_rows(self%numbering%rows), source=0.0_wp)
  end subroutine create

  !> Numbers the equations and creates the matrix.
  subroutine set_pattern(self, model, is_separate, error)
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> True: in-plane displacements are not coupled with bending
    logical, intent(in) :: is_separate
    !> Set if the solver cannot be created
    type(error_t), allocatable, intent(inout) :: error

    call number_equations(model%plate%mesh, model%plate%distribution, model%held_unknowns(), self%numbering, &
                          model%plate%constraints%images, is_separate)
    associate (numbering => self%numbering)
      call self%solver%define(model%plate%communicator, numbering%first_row, numbering%total, numbering%row_start, &
                              numbering%columns, is_positive_definite(model%plate), error)
    end associate
    ! The solver has its own copy of this large list.
    deallocate (self%numbering%columns)
  end subroutine set_pattern

  !> Assembles and factorizes the operator at a state, and computes the unit-load solution.
  subroutine renew(self, model, state, stiffness_factor, mass_factor, error)
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The state, ghosts of its displacement up to date
    type(state_t), intent(in) :: state
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Set if the operator is singular
    type(error_t), allocatable, intent(out) :: error

    self%displacement = state%motion%displacement
    self%stiffness = uniform_stiffness(state%plies)
    self%stiffness_factor = stiffness_factor
    self%mass_factor = mass_factor
    call self%timers%start('assembly')
    call assemble(self, model, error)
    if (allocated(error)) return
    if (allocated(state%interfaces%cohesive%tangents)) &
      call assemble_tangents(model%plate, self%numbering, state%interfaces%cohesive%tangents, self%solver)
    call state%interfaces%added_stiffness(model, self%diagonal, stiffness_factor, self%added)
    call self%timers%stop('assembly')
    call self%factorize(model, state%impact%patch, error)
  end subroutine renew

  !> Factorizes the assembled matrix with the stiffness added to the jumps, and computes the unit-load solution.
  subroutine factorize(self, model, contact, error)
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Patch under the impactor
    type(contact_patch_t), intent(in) :: contact
    !> Set if the operator is singular
    type(error_t), allocatable, intent(inout) :: error

    if (model%has_point_stiffness) call assemble_diagonal(model%plate, self%numbering, self%added, self%solver)
    call self%solver%matrix%finish_assembly(error)
    call self%timers%start('factorization')
    if (.not. allocated(error)) call self%solver%factorize(error)
    call self%timers%stop('factorization')
    self%ready = .not. allocated(error)
    if (.not. self%ready) return
    self%factorizations = self%factorizations + 1
    self%response = 0
    self%compliance = 0
    if (model%plate%setup%impactor%is_present) call self%find_response(model%plate, contact, error)
  end subroutine factorize

  !> Computes the unit-load solution of the impactor's force.
  subroutine find_response(self, plate, contact, error)
    class(tangent_operator_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Patch under the impactor
    type(contact_patch_t), intent(in) :: contact
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: force(:, :)

    allocate (force, mold=self%response)
    force = 0
    force(3, :) = contact%weights/plate%mesh%multiplicity
    call self%correct(plate, force, self%response, error)
    if (allocated(error)) return
    self%response_rows = self%rows_of(self%response)
    self%compliance = contact%mean(plate%communicator, self%response)
  end subroutine find_response

  !> Solution on this rank's rows with the present factorization.
  subroutine solve_rows(self, forces, motion, error)
    class(tangent_operator_t), intent(inout) :: self
    !> Forces on the rows
    real(wp), intent(in) :: forces(:)
    !> Displacement under them
    real(wp), intent(out) :: motion(:)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(inout) :: error

    call self%timers%start('solve')
    call self%solver%solve(forces, motion, error)
    call self%timers%stop('solve')
  end subroutine solve_rows

  !> This rank's rows of a displacement field, or of a field of forces at the points that define the unknowns.
  pure function rows_of(self, field) result(rows)
    class(tangent_operator_t), intent(in) :: self
    !> (5, points)
    real(wp), intent(in) :: field(:, :)
    !> (rows)
    real(wp) :: rows(self%numbering%rows)
    integer :: row, point, component

    do row = 1, size(rows)
      call self%numbering%place_of(self%numbering%first_row + row - 1, point, component)
      rows(row) = field(component, point)
    end do
  end function rows_of

  !> True if ties and contacts have changed at more equations than the number of solves that cost one factorization:
  !> each change adds a dimension to the Krylov space. Collective.
  logical function has_outdated_constraints(self, plate, current, max_changes)
    class(tangent_operator_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Present stiffness added to the jumps, (3, points)
    real(wp), intent(in) :: current(:, :)
    !> Number of changes that the iteration may account for
    integer, intent(in) :: max_changes
    real(wp) :: changed

    associate (owned => plate%distribution%owned)
      changed = count(abs(current(:, :owned) - self%added(:, :owned)) > self%diagonal(:3, :owned) &
                      .and. self%numbering%equation(:3, :owned) >= 0)
    end associate
    call plate%communicator%sum(changed)
    has_outdated_constraints = changed > max_changes
  end function has_outdated_constraints

  !> Correction of the displacement for a residual, ghosts included.
  subroutine correct(self, plate, residual, correction, error)
    class(tangent_operator_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: residual(:, :)
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: forces(self%numbering%rows), rows(self%numbering%rows)

    call self%numbering%gather(residual, forces)
    call self%solve_rows(forces, rows, error)
    if (allocated(error)) return
    call self%numbering%scatter(rows, correction)
    call plate%halo%update(correction)
  end subroutine correct

  !> Saves the data that the factorization was computed from, or loads them and factorizes: the factorization affects
  !> the iterations.
  subroutine visit(self, archive, model, contact, error)
    class(tangent_operator_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Patch under the impactor
    type(contact_patch_t), intent(in) :: contact
    !> Set if the factorization fails
    type(error_t), allocatable, intent(out) :: error

    call archive%item('operator/ready', self%ready)
    call archive%item('operator/stiffness_factor', self%stiffness_factor)
    call archive%item('operator/mass_factor', self%mass_factor)
    call model%plate%visit_points(archive, 'operator/displacement', self%displacement, motion_field)
    if (model%has_point_stiffness) call model%plate%visit_points(archive, 'operator/added', self%added, area_field)
    if (model%plate%setup%has_variable_sections()) &
      call visit_stiffness(archive, 'operator/stiffness', model%plate, self%stiffness)
    if (archive%loading .and. self%ready) then
      call model%plate%halo%update(self%displacement)
      call assemble(self, model, error)
      if (.not. allocated(error)) call self%factorize(model, contact, error)
    end if
    call archive%item('operator/factorizations', self%factorizations)
    call archive%item('operator/solves', self%solves)
  end subroutine visit

  !> Assembles the elements at the displacement at which the tangent is taken.
  subroutine assemble(self, model, error)
    class(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if a matrix with another pattern cannot be created
    type(error_t), allocatable, intent(inout) :: error
    logical :: is_separate

    is_separate = has_separate_membrane(model, self%stiffness, self%displacement)
    if (is_separate .neqv. self%numbering%is_separate) call set_pattern(self, model, is_separate, error)
    if (allocated(error)) return
    self%deflection = model%plate%deflection(self%displacement)
    call self%solver%matrix%clear(merge(2, 1, is_separate)*size(model%plate%distribution%connectivity, 2))
    call assemble_elements(model, self%stiffness, self%numbering, self%displacement, self%stiffness_factor, &
                           self%mass_factor, self%solver, self%diagonal)
  end subroutine assemble

  !> Deallocates the factors.
  subroutine release(self)
    class(tangent_operator_t), intent(inout) :: self

    if (allocated(self%solver)) call self%solver%release()
    call self%minimal_residuals%release()
    call self%conjugate_gradients%release()
  end subroutine release
end module tangent_operators
