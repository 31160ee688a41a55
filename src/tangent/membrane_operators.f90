!> The factored operator of the plate's motion in its own plane alone, two unknowns of five a point. With von Karman's
!> strains a correction by the whole operator leaves forces in that plane, as the slopes have changed since its
!> factorization, and hardly any others. They are taken by this operator for a fifth of a solve; it does not know the
!> slopes and stays what it is until step or stiffness change.
module membrane_operators
  use errors, only: error_t
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use models, only: model_t
  use numberings, only: numbering_t, number_equations
  use operator_assembly, only: assemble_elements
  use operator_solvers, only: set_solver_up, solve_field
  use plate_options, only: kinematics_von_karman
  use timers, only: timer_set_t
  implicit none
  private
  public :: membrane_operator_t, create_membrane_operator

  !> Coupling of membrane and bending, over their own stiffness, that counts as none.
  real(wp), parameter :: uncoupled = 1.0e-9_wp

  !> A factor of stiffness and mass of u and v.
  type :: membrane_operator_t
    !> Equations of u and v
    type(numbering_t), private :: numbering
    !> The linear solver that holds the factor
    class(linear_solver_t), allocatable, private :: solver
    !> Factors of stiffness and mass in it; none yet: 0
    real(wp), private :: stiffness_factor = 0, mass_factor = 0
    !> True once one did not suffice: none is tried before the whole operator is renewed
    logical :: fails = .false.
  contains
    !> Factors the operator, if it is not what it was.
    procedure :: renew
    !> True where a correction in the plane should do.
    procedure :: suffices
    !> Correction of the displacement for a residual.
    procedure :: correct
    !> Frees the factor.
    procedure :: release
  end type membrane_operator_t

contains

  !> Numbers the equations and sets the solver up, for a model that it suits.
  subroutine create_membrane_operator(model, factorization, self, error)
    type(model_t), intent(in) :: model
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> The operator; unallocated: it is not worth having
    type(membrane_operator_t), allocatable, intent(out) :: self
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(inout) :: error
    logical, allocatable :: held(:, :)

    if (.not. stretches(model)) return
    allocate (self)
    held = model%held
    held(3:, :) = .true.
    call number_equations(model%mesh, model%distribution, held, self%numbering, model%images)
    call set_solver_up(model, self%numbering, factorization, self%solver, error)
    if (.not. allocated(error)) deallocate (self%numbering%columns)
  end subroutine create_membrane_operator

  !> True: slopes stretch the plate, and nothing else couples its motion in its plane with that across it.
  pure logical function stretches(model)
    type(model_t), intent(in) :: model

    stretches = model%scene%kinematics == kinematics_von_karman .and. .not. model%scene%has_static .and. &
                .not. model%has_bonds
    if (.not. stretches) return
    associate (c => model%section%stiffness)
      stretches = all(abs(c(7:12)) <= uncoupled*sqrt(maxval(abs(c(1:6)))*maxval(abs(c(13:18)))))
    end associate
  end function stretches

  !> Factors the operator, if it is not what it was.
  subroutine renew(self, model, stiffness, displacement, stiffness_factor, mass_factor, error)
    !> The operator
    class(membrane_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Set if the operator is singular
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: diagonal(:, :)

    self%fails = .false.
    if (.not. model%scene%has_ply_damage .and. abs(self%stiffness_factor - stiffness_factor) <= 0 .and. &
        abs(self%mass_factor - mass_factor) <= 0) return
    allocate (diagonal, mold=displacement)
    call self%solver%clear()
    call assemble_elements(model, stiffness, self%numbering, displacement, stiffness_factor, mass_factor, self%solver, &
                           diagonal)
    call self%solver%finish_assembly(error)
    if (.not. allocated(error)) call self%solver%factorize(error)
    if (allocated(error)) return
    self%stiffness_factor = stiffness_factor
    self%mass_factor = mass_factor
  end subroutine renew

  !> True where forces out of the plane are within the tolerance and those in the plane are not, the same on every rank.
  !> To be asked of a residual that is over it.
  logical function suffices(self, model, numbering, residual, norm, tolerance)
    !> The operator
    class(membrane_operator_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Equations of all unknowns
    type(numbering_t), intent(in) :: numbering
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Its relative size, and that which is accepted
    real(wp), intent(in) :: norm, tolerance
    real(wp) :: squares(3), forces(5, numbering%owned)

    suffices = .false.
    if (self%fails .or. .not. norm <= huge(norm)) return
    forces = residual(:, :numbering%owned)
    call numbering%fold(forces)
    where (numbering%equation(:, :numbering%owned) < 0) forces = 0
    squares = [sum(forces(1:2, :)**2), sum(forces(3, :)**2), sum(forces(4:5, :)**2)/model%thickness**2]
    call model%communicator%sum(squares)
    suffices = norm*sqrt(sum(squares(2:))) <= tolerance*sqrt(sum(squares))
  end function suffices

  !> Correction of the displacement for the residual in the plane, ghosts included.
  subroutine correct(self, model, timers, residual, correction, error)
    !> The operator
    class(membrane_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time spent in the parts of a step
    type(timer_set_t), intent(inout) :: timers
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(inout) :: error

    call solve_field(model, self%numbering, self%solver, timers, 'solve in plane', residual, correction, error)
  end subroutine correct

  !> Frees the factor.
  subroutine release(self)
    !> The operator
    class(membrane_operator_t), intent(inout) :: self

    call self%solver%release()
  end subroutine release
end module membrane_operators
