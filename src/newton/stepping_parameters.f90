!> Parameters of steps as given in the deck: time integration, adaptivity, convergence of equilibrium.
module stepping_parameters
  use central_difference_parameters, only: central_difference_parameters_t
  use kinds, only: wp
  use solution_controls, only: newton_controls_t, step_controls_t
  implicit none
  private
  public :: time_t, adapt_t, equilibrium_t, expected_response_t, stepping_t, is_error_controlled, is_explicit, &
            end_of_run

  !> Time integrators of the plate.
  integer, parameter, public :: integrator_newmark = 1, integrator_generalized_alpha = 2, &
                                integrator_central_difference = 3
  !> Rules for renewing the factored operator.
  integer, parameter, public :: refactor_deflection = 1, refactor_iterations = 2
  !> Control of the step length: by the stress rate at the struck point (the paper's rule), or by the error of each
  !> step.
  integer, parameter, public :: rule_stress_rate = 1, rule_local_error = 2

  !> Ratio of the end of a run to the end of the contact, both from first contact: a quarter more shows that the
  !> impactor has left, and includes the start of a second contact.
  real(wp), parameter, public :: past_contact = 1.25_wp
  !> Largest ratio of the end of a run extended by its contact to the end chosen first: an impactor still in contact by
  !> then perforates the plate or rests on it.
  real(wp), parameter :: max_extension = 4

  !> Time integration of the plate.
  type :: time_t
    !> End of the run
    real(wp) :: end = 0
    !> True: the run is extended until the impactor has left
    logical :: extends_to_contact_end = .false.
    !> True: a compression ends once the plate has failed
    logical :: ends_at_failure = .false.
    !> First time step
    real(wp) :: step = 0
    !> Smallest step tried before giving up, and largest step taken
    real(wp) :: step_min = 0, step_max = 0
    !> One of the integrators above
    integer :: integrator = integrator_generalized_alpha
    !> Newmark's parameters
    real(wp) :: beta = 0.25_wp, gamma = 0.5_wp
    !> Wall-clock seconds after which the run ends with a checkpoint; 0: none
    real(wp) :: wall_limit = 0
    !> Spectral radius at infinite frequency of generalised-alpha, 0 (most damping) to 1 (none)
    real(wp) :: rho_infinity = 1
  end type time_t

  !> Adaptive rules: those of the paper's section 3.4, and control by the error of each step.
  type :: adapt_t
    !> True: the time step adapts
    logical :: on = .false.
    !> rule_stress_rate or rule_local_error
    integer :: rule = rule_local_error
    !> Tolerance of the error of a step, as a fraction of the largest force and deflection (rule_local_error)
    real(wp) :: tolerance = 1.0e-3_wp
    !> refactor_deflection (the paper's) or refactor_iterations
    integer :: refactor = refactor_iterations
    !> Increase of the struck point's deflection after which the operator is factorized again, as a fraction of the
    !> thickness
    real(wp) :: stiffness_update = 0.003_wp
    !> Required change of the stress at the struck point per step, as a fraction of its largest value so far
    real(wp) :: stress_change = 0.05_wp
    !> Iterations of a step above which the operator is factorized again (refactor_iterations)
    integer :: iterations = 16
    !> Smallest factor by which fronts that grow one cell per step shorten it; 1: not at all
    real(wp) :: growth_step = 0.25_wp
  end type adapt_t

  !> Convergence of equilibrium.
  type :: equilibrium_t
    !> Residual of equilibrium accepted, relative to the reference force
    real(wp) :: tolerance = 1.0e-6_wp
    !> Iterations of equilibrium before a step is tried again with half its length
    integer :: max_iterations = 30
    !> Constants of Newton's method
    type(newton_controls_t) :: controls
  end type equilibrium_t

  !> Expected response of a run, from a preliminary calculation; 0: not known.
  type :: expected_response_t
    !> Time in which the force of first contact rises
    real(wp) :: rise = 0
    !> Largest force and deflection
    real(wp) :: force = 0, deflection = 0
    !> End of the last contact
    real(wp) :: last_contact = 0
  end type expected_response_t

  !> All parameters of steps.
  type :: stepping_t
    !> Time integration
    type(time_t) :: time
    type(central_difference_parameters_t) :: central
    !> Adaptivity
    type(adapt_t) :: adapt
    !> Expected response of the run
    type(expected_response_t) :: expected
    !> Convergence of equilibrium
    type(equilibrium_t) :: equilibrium
    !> Constants of the control of steps
    type(step_controls_t) :: controls
  end type stepping_t

contains

  !> True: the plate is integrated by central differences.
  elemental logical function is_explicit(stepping)
    type(stepping_t), intent(in) :: stepping

    is_explicit = stepping%time%integrator == integrator_central_difference
  end function is_explicit

  !> End of a run, from the time of last contact so far.
  elemental real(wp) function end_of_run(stepping, contact_end)
    type(stepping_t), intent(in) :: stepping
    !> Time of last contact
    real(wp), intent(in) :: contact_end

    associate (time => stepping%time, central => stepping%central)
      end_of_run = time%end
      if (time%extends_to_contact_end) end_of_run = min(max_extension*time%end, max(time%end, past_contact*contact_end))
      ! Damping brings the plate to rest from the end of the contact on.
      if (contact_end > 0 .and. central%settle > 0) &
        end_of_run = max(end_of_run, min(contact_end, max_extension*time%end) + central%settle)
    end associate
  end function end_of_run

  !> True: the step length is controlled by the error of each step.
  elemental logical function is_error_controlled(adapt)
    !> Adaptive rules
    type(adapt_t), intent(in) :: adapt

    is_error_controlled = adapt%on .and. adapt%rule == rule_local_error
  end function is_error_controlled
end module stepping_parameters
