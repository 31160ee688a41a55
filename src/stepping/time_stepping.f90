!> Time or load stepping: steps are tried, and accepted or repeated with a shorter length.
module time_stepping
  use kinds, only: wp
  use archives, only: archive_t
  use errors, only: error_t
  use explicit_steps, only: advance_explicit, complete_step
  use initial_equilibrium, only: find_initial_equilibrium, has_initial_motion
  use linear_solver_parameters, only: linear_solver_parameters_t
  use load_steps, only: load_steps_t
  use models, only: model_t
  use motion_steps, only: motion_steps_t
  use single_rank_equilibria, only: equilibrate_initial_stresses
  use states, only: new_state
  use step_acceptance, only: accept_step, reject_step, assess_error
  use steppers, only: stepper_t
  use stepping_parameters, only: stepping_t, is_explicit
  implicit none
  private
  public :: time_stepper_t

  !> A stepper through time or load.
  type, extends(stepper_t) :: time_stepper_t
  contains
    procedure :: start
    procedure :: advance
    procedure :: complete_state
    procedure :: visit
  end type time_stepper_t

contains

  !> Initial state: the plate at rest and the impactor at first contact.
  subroutine start(self, model, stepping, linear_solver, resumed, error)
    class(time_stepper_t), intent(out) :: self
    type(model_t), intent(in) :: model
    !> Parameters of steps
    type(stepping_t), intent(in) :: stepping
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> True: a state will be loaded, so that no initial state is computed
    logical, intent(in) :: resumed
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    self%smallest_step = stepping%time%step_min
    allocate (self%now, source=new_state(model))
    if (is_explicit(stepping)) then
      allocate (self%explicit)
      self%unknowns = count(.not. model%fixed)
      if (.not. resumed .and. has_initial_motion(model)) &
        call equilibrate_initial_stresses(self%operator, model, linear_solver, self%now, error)
      if (.not. allocated(error)) call self%explicit%start(model, stepping%central, self%now)
      return
    end if
    allocate (self%trial, source=self%now)
    if (model%setup%is_static()) then
      allocate (load_steps_t :: self%kind)
    else
      allocate (motion_steps_t :: self%kind)
    end if
    if (model%setup%static%dissipation > 0) allocate (self%now%path%change, source=self%now%motion%displacement)
    call self%operator%create(model, linear_solver%factorization, error)
    self%unknowns = self%operator%numbering%total
    if (.not. allocated(error)) call find_initial_equilibrium(model, self%operator, self%now, error)
    if (.not. allocated(error)) call self%kind%start(self, model, error)
  end subroutine start

  !> Takes one step, at most to the next event; the step is tried again with half its length until
  !> equilibrium is reached or the smallest step of the deck has failed.
  subroutine advance(self, model, event, error)
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time, or load factor, that must not be exceeded
    real(wp), intent(in) :: event
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: step, shortest

    if (allocated(self%explicit)) then
      call advance_explicit(self%explicit, model, event, self%now)
      self%controller%last = self%explicit%steps%now
      return
    end if
    if (self%is_error_controlled .and. self%now%step == 0) call self%controller%begin(self%stepping, event)
    call find_step(self, model, event, step, shortest, error)
    if (allocated(error)) return
    if (self%is_error_controlled) &
      self%exceeds_tolerance = self%error > self%stepping%controls%shortening_error .and. &
                               step <= shortest*(1 + 1.0e-9_wp)
    if (abs(self%trial%time - event) <= 1.0e-9_wp*step) self%trial%time = event
    call accept_step(self, model, step)
    call self%kind%equilibrate(self, model, error)
  end subroutine advance

  !> Tries steps, each shorter than the one before, until one has converged with an error within the tolerance.
  subroutine find_step(self, model, event, step, shortest, error)
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time, or load factor, that must not be exceeded
    real(wp), intent(in) :: event
    !> Step found
    real(wp), intent(out) :: step
    !> Shortest step allowed under error control
    real(wp), intent(out) :: shortest
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(inout) :: error
    logical :: converged, accurate

    shortest = 0
    do
      call self%kind%try(self, model, event, step, converged, error)
      if (allocated(error)) return
      if (converged) then
        accurate = .true.
        if (self%is_error_controlled) call assess_error(self, model, step, shortest, accurate)
        if (accurate) return
      else
        call reject_step(self, model, step, error)
        if (allocated(error)) return
      end if
    end do
  end subroutine find_step

  !> Computes energies, reactions and stress of a step by central differences when output or a check is due. Collective.
  subroutine complete_state(self, model, error)
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error

    if (allocated(self%explicit)) call complete_step(self%explicit, model, self%now, error)
  end subroutine complete_state

  !> Saves or loads the evolving state.
  subroutine visit(self, archive, model, error)
    class(time_stepper_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Set if the operator cannot be factorized again
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    if (allocated(self%explicit)) then
      call self%explicit%visit(archive, model)
      call archive%item('operator/factorizations', self%operator%factorizations)
      call archive%item('operator/solves', self%operator%solves)
      if (archive%loading) call self%explicit%resume(model, self%now)
      return
    end if
    call self%controller%visit(archive)
    if (allocated(self%step_error%share)) call self%step_error%visit(archive, model)
    call archive%item('stepper/rejected', self%rejected)
    call self%operator%visit(archive, model, self%now%contact, error)
  end subroutine visit
end module time_stepping
