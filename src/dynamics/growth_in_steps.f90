!> Growth of delaminations within a time step.
module growth_in_steps
  use section_bounds, only: uniform_stiffness
  use kinds, only: wp
  use errors, only: error_t
  use delamination_parameters, only: growth_equilibrium
  use models, only: model_t
  use tie_release, only: tie_release_t
  use front_growth, only: grow_fronts
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use step_problems, only: solve_step
  use dynamic_steps, only: dynamic_step_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: grow_in_step, grows_by_steps

contains

  !> Growth of delaminations in a converged step: with equilibrium growth the step is repeated from its start until no
  !> front exceeds its critical value, otherwise the growth takes effect in the next step.
  subroutine grow_in_step(problem, model, equilibrium, operator, now, trial, converged, error)
    !> The step
    type(dynamic_step_t), intent(inout) :: problem
    type(model_t), intent(in) :: model
    type(equilibrium_t), intent(in) :: equilibrium
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start of the step
    type(state_t), intent(in) :: now
    !> State at its end
    type(state_t), intent(inout) :: trial
    !> False on return if equilibrium was lost
    logical, intent(inout) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(inout) :: error
    type(state_t) :: start
    type(tie_release_t) :: ties
    real(wp), allocatable :: opened(:)
    logical, allocatable :: free(:)
    real(wp) :: fracture
    logical :: grown

    call model%plate%profile%enter('fronts')
    ties = now%interfaces%ties
    do
      free = trial%interfaces%contact%free
      fracture = trial%ledger%delamination
      call grow_fronts(model%plate, uniform_stiffness(trial%plies), trial%motion, trial%interfaces, &
                       trial%ledger%delamination, grown)
      ! The integrators cannot distinguish the energy dissipated by fracture from their own dissipation.
      trial%ledger%algorithmic = trial%ledger%algorithmic - (trial%ledger%delamination - fracture)
      if (.not. grown .or. grows_by_steps(model)) exit
      call ties%release(model%plate, free, trial%interfaces%contact%free, &
                       trial%motion%internal(1:3, :) + trial%motion%inertia(1:3, :))
      problem%guess = trial%motion%displacement
      start = now
      start%interfaces%contact = trial%interfaces%contact
      start%interfaces%ties = ties
      fracture = trial%ledger%delamination - now%ledger%delamination
      start%ledger%delamination = start%ledger%delamination + fracture
      start%ledger%algorithmic = start%ledger%algorithmic - fracture
      call solve_step(problem, model, equilibrium, operator, start, trial, converged, error)
      if (.not. converged .or. allocated(error)) exit
      opened = trial%interfaces%ties%first_opening(model%plate, free, trial%interfaces%contact%free, &
                                                   trial%motion%displacement)
      trial%interfaces%ties%set_free = trial%interfaces%ties%set_free + opened
      ties%set_free = ties%set_free + opened
    end do
    call model%plate%profile%leave()
  end subroutine grow_in_step

  !> True if all delaminations grow in the next step, none while time is held constant.
  pure logical function grows_by_steps(model)
    type(model_t), intent(in) :: model

    grows_by_steps = model%plate%map%layered
    if (grows_by_steps) grows_by_steps = all(model%plate%setup%delaminations%growth /= growth_equilibrium)
  end function grows_by_steps
end module growth_in_steps
