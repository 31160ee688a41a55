!> Equilibrium of a step: one nonlinear iteration for every kind of step, be it a step in time or a load step.
!>
!> A kind of step says what its first guess, residual, operator and books are; the iteration around them is the
!> paper's Fig. 7: residual, ties and contact, correction by a factored operator that may lag, and once equilibrium
!> holds the contact pressures found become the next multipliers, until they settle.
module step_problems
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use models, only: model_t
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: step_problem_t, solve_step

  !> Rise of the residual by which an iteration has gone astray: near its tolerance rounding makes it rise a little.
  real(wp), parameter :: astray = 2
  !> Iterations that should bring the residual down to a part, or the iteration stalls.
  integer, parameter :: watched = 4
  real(wp), parameter :: most_left = 0.5_wp
  !> Stalls in a row with which a step is too long: the last of them with an operator made where the iteration stood.
  integer, parameter :: most_stalls = 2

  !> One kind of step.
  type, abstract :: step_problem_t
    !> Distance of pressures and gaps from contact (complementarity) at which they have settled
    real(wp) :: contact_tolerance = 0
    !> True: a solver that fails may be cured by a shorter step
    logical :: curable = .true.
    !> True: the operator with which the step begins is that of its start, so its end hangs on nothing before that
    logical :: begins_fresh = .true.
    !> True: there was a burst in the step, of which another operator may find another end
    logical :: bursts = .false.
    !> Iterations taken when plies followed last
    integer :: begun = 0
    !> True: the last iterations have not come nearer to equilibrium, so another operator is wanted
    logical :: stalls = .false.
    !> How often in a row they have not
    integer :: stalled = 0
    !> True: a shorter step may follow; one of the smallest length is taken as it is, as the energy watch tells what it
    !> creates
    logical :: shortens = .false.
    !> True: a shorter step is wanted, whatever this one would find
    logical :: gives_up = .false.
  contains
    !> First guess of the state at the end of the step.
    procedure(begin_step), deferred :: begin
    !> Residual of equilibrium without ties and contact.
    procedure(find_residual), deferred :: find_residual
    !> Size of a residual relative to the forces in play.
    procedure(residual_norm), deferred :: residual_norm
    !> Lets plies that soften follow, where a kind of step has them wait.
    procedure :: soften
    !> True if a residual within the tolerance is the end.
    procedure(may_stop), deferred :: may_stop
    !> Makes the operator fit the state, by changes or by a factorization.
    procedure(prepare_operator), deferred :: prepare_operator
    !> Betters a correction: the impact force that goes with it, what earlier iterations showed.
    procedure(improve), deferred :: improve
    !> Completes the motion after a correction.
    procedure(complete), deferred :: complete
    !> Completes the state of a step that has converged, and its ledger.
    procedure(finish), deferred :: finish
  end type step_problem_t

  abstract interface
    !> First guess of the state at the end of the step.
    subroutine begin_step(self, model, operator, old, new)
      import :: step_problem_t, model_t, tangent_operator_t, state_t
      !> The problem
      class(step_problem_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      !> The factored operator, with its memory of iterations
      type(tangent_operator_t), intent(inout) :: operator
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine begin_step

    !> Residual of equilibrium without ties and contact.
    subroutine find_residual(self, model, old, new, residual, energy)
      import :: step_problem_t, model_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end; receives its forces
      type(state_t), intent(inout) :: new
      !> Residual at the owned points, (5, points)
      real(wp), intent(inout) :: residual(:, :)
      !> Strain energy of this rank's elements
      real(wp), intent(out) :: energy
    end subroutine find_residual

    !> Size of a residual relative to the forces in play; infinite if a number is not finite.
    real(wp) function residual_norm(self, model, equilibrium, operator, residual, new)
      import :: step_problem_t, model_t, equilibrium_t, tangent_operator_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> Convergence asked for
      type(equilibrium_t), intent(in) :: equilibrium
      !> The factored operator
      type(tangent_operator_t), intent(in) :: operator
      !> Residual at the owned points, (5, points)
      real(wp), intent(in) :: residual(:, :)
      !> State at the end; remembers its largest forces
      type(state_t), intent(inout) :: new
    end function residual_norm

    !> True if a residual within the tolerance is the end.
    pure logical function may_stop(self, model, new, pressures_new)
      import :: step_problem_t, model_t, state_t
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the end
      type(state_t), intent(in) :: new
      !> True: contact has taken new pressures since the last correction
      logical, intent(in) :: pressures_new
    end function may_stop

    !> Makes the operator fit the state, by changes or by a factorization.
    subroutine prepare_operator(self, model, operator, new, error)
      import :: step_problem_t, model_t, tangent_operator_t, state_t, error_t
      !> The problem
      class(step_problem_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      !> The factored operator
      type(tangent_operator_t), intent(inout) :: operator
      !> State at the end
      type(state_t), intent(in) :: new
      !> Set if the solver fails
      type(error_t), allocatable, intent(inout) :: error
    end subroutine prepare_operator

    !> Betters a correction: the impact force that goes with it, what earlier iterations showed.
    subroutine improve(self, model, operator, old, new, residual, correction, error)
      import :: step_problem_t, model_t, tangent_operator_t, state_t, error_t, wp
      !> The problem
      class(step_problem_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      !> The factored operator, with its memory of iterations
      type(tangent_operator_t), intent(inout) :: operator
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end, before the correction
      type(state_t), intent(inout) :: new
      !> The residual at the owned points, (5, points)
      real(wp), intent(in) :: residual(:, :)
      !> Correction of the displacement, (5, points)
      real(wp), intent(inout) :: correction(:, :)
      !> Set if numbers are not finite
      type(error_t), allocatable, intent(inout) :: error
    end subroutine improve

    !> Completes the motion after a correction.
    subroutine complete(self, old, new)
      import :: step_problem_t, state_t
      !> The problem
      class(step_problem_t), intent(in) :: self
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine complete

    !> Completes the state of a step that has converged, and its ledger.
    subroutine finish(self, model, old, energy, new)
      import :: step_problem_t, model_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the start
      type(state_t), intent(in) :: old
      !> Strain energy of this rank's elements
      real(wp), intent(in) :: energy
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine finish
  end interface

contains

  !> Plies have followed within the residual.
  subroutine soften(self, model, equilibrium, norm, energy, old, new, softened)
    !> The problem
    class(step_problem_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Convergence asked for
    type(equilibrium_t), intent(in) :: equilibrium
    !> Size of the residual
    real(wp), intent(in) :: norm
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), intent(inout) :: new
    !> True: plies have changed
    logical, intent(out) :: softened

    softened = .false.
  end subroutine soften

  !> Tries a step. On return either `converged` and `new` is the state at its end, or nothing of it counts. A burst that
  !> did not begin with the operator of its start does not converge: of several ends, the way there decides.
  subroutine solve_step(problem, model, equilibrium, operator, old, new, converged, error)
    !> The kind of step
    class(step_problem_t), intent(inout) :: problem
    type(model_t), intent(in) :: model
    !> Convergence asked for
    type(equilibrium_t), intent(in) :: equilibrium
    !> The factored operator; renewed on the way if convergence asks for it
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), intent(inout) :: new
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: residual(:, :), correction(:, :)
    real(wp) :: norm, before, earlier, energy
    logical :: pressures_new, softened, in_plane

    converged = .false.
    call new%start_from(model, old)
    allocate (residual, correction, mold=old%motion%displacement)
    pressures_new = .false.
    in_plane = .false.
    problem%begun = 0
    before = huge(before)
    earlier = before
    call problem%begin(model, operator, old, new)
    do
      call operator%timers%start('element forces')
      call problem%find_residual(model, old, new, residual, energy)
      call model%profile%enter('contact and ties')
      call new%interfaces%act(model, new%motion%displacement, residual)
      call model%profile%leave()
      call operator%timers%stop('element forces')
      norm = problem%residual_norm(model, equilibrium, operator, residual, new)
      call problem%soften(model, equilibrium, norm, energy, old, new, softened)
      if (problem%gives_up) return
      if (softened) then
        if (problem%bursts .and. .not. problem%begins_fresh) return
        problem%begun = new%iterations
        before = huge(before)
        call operator%anderson%forget()
        cycle
      end if
      ! What it has seen of points on one side of a kink leads astray beyond it.
      if (operator%condenses .and. norm/astray > before) call operator%anderson%forget()
      before = norm
      converged = norm <= equilibrium%tolerance
      if (converged) converged = problem%may_stop(model, new, pressures_new)
      pressures_new = .false.
      if (converged) then
        call model%profile%enter('contact and ties')
        call new%interfaces%settle(model, new%motion%displacement, problem%contact_tolerance, &
                                   new%contact_iterations, converged)
        call model%profile%leave()
        if (converged) exit
        pressures_new = .true.
        call operator%anderson%pause()
        if (new%contact_iterations < equilibrium%max_iterations) cycle
      end if
      if (.not. norm <= huge(norm) .or. new%iterations - problem%begun >= equilibrium%max_iterations) exit
      call watch(problem, new%iterations - problem%begun, norm, earlier)
      if (operator%condenses .and. problem%shortens .and. problem%stalled >= most_stalls) exit
      ! The impact force is found by the whole operator, and so is what a correction in the plane leaves.
      if (allocated(operator%membrane) .and. new%iterations > 0) then
        operator%membrane%fails = operator%membrane%fails .or. in_plane
        in_plane = operator%membrane%suffices(model, operator%numbering, residual, norm, equilibrium%tolerance)
      end if
      if (in_plane) then
        call operator%membrane%correct(model, operator%timers, residual, correction, error)
        ! A correction by another operator is not to be compared with.
        call operator%anderson%pause()
      else
        call problem%prepare_operator(model, operator, new, error)
        ! Only a further iteration asks what the last one showed.
        call operator%anderson%note(correction)
        if (.not. allocated(error)) call operator%correct(model, residual, correction, error)
      end if
      if (allocated(error)) then
        if (problem%curable .and. error%code == exit_convergence) deallocate (error)
        return
      end if
      if (.not. in_plane) call problem%improve(model, operator, old, new, residual, correction, error)
      if (allocated(error)) then
        ! Numbers have run away, or the operator is not positive: a shorter step may cure it.
        deallocate (error)
        return
      end if
      if (problem%bursts .and. .not. problem%begins_fresh) return
      new%motion%displacement = new%motion%displacement + correction
      call problem%complete(old, new)
      new%iterations = new%iterations + 1
    end do
    if (converged) call problem%finish(model, old, energy, new)
  end subroutine solve_step

  !> Notes before a correction whether the iteration stalls.
  pure subroutine watch(problem, iterations, norm, earlier)
    !> The problem
    class(step_problem_t), intent(inout) :: problem
    !> Iterations since plies followed last
    integer, intent(in) :: iterations
    !> Size of the residual
    real(wp), intent(in) :: norm
    !> The same when it was looked at last
    real(wp), intent(inout) :: earlier

    problem%stalls = .false.
    if (modulo(iterations, watched) > 0) return
    problem%stalls = iterations > 0 .and. norm > most_left*earlier
    problem%stalled = merge(problem%stalled + 1, 0, problem%stalls)
    earlier = norm
  end subroutine watch
end module step_problems
