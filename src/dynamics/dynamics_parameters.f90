!> Loads, time integration, adaptivity and solver settings, as the deck gives them.
module dynamics_parameters
  use kinds, only: wp
  implicit none
  private
  public :: pressure_t, time_t, adapt_t, solver_t

  !> Histories of the pressure: there from the start, or growing in proportion to time up to `value` at the end.
  integer, parameter, public :: history_step = 1, history_ramp = 2
  !> Distributions of the pressure over the plate: uniform, or one half-sine along each side.
  integer, parameter, public :: distribution_uniform = 1, distribution_sine = 2
  !> Time integrators of the plate.
  integer, parameter, public :: integrator_newmark = 1, integrator_generalized_alpha = 2
  !> Rules for renewing the factored operator.
  integer, parameter, public :: refactor_deflection = 1, refactor_iterations = 2
  !> Factorisations.
  integer, parameter, public :: factorization_mumps = 1, factorization_cholmod = 2

  !> Pressure on the struck face.
  type :: pressure_t
    !> Force per area, positive downwards
    real(wp) :: value = 0
    !> history_step or history_ramp
    integer :: history = history_step
    !> distribution_uniform or distribution_sine
    integer :: distribution = distribution_uniform
  end type pressure_t

  !> Time integration of the plate.
  type :: time_t
    !> End of the run
    real(wp) :: end = 0
    !> First time step
    real(wp) :: step = 0
    !> Smallest step tried before giving up, and largest step taken
    real(wp) :: step_min = 0, step_max = 0
    !> integrator_newmark or integrator_generalized_alpha
    integer :: integrator = integrator_generalized_alpha
    !> Newmark's parameters
    real(wp) :: beta = 0.25_wp, gamma = 0.5_wp
    !> Spectral radius at infinite frequency of generalised-alpha, 0 (most damping) to 1 (none)
    real(wp) :: rho_infinity = 1
  end type time_t

  !> Adaptive rules of the paper's section 3.4.
  type :: adapt_t
    !> True: the time step follows the stress rate at the struck point
    logical :: on = .false.
    !> refactor_deflection (the paper's) or refactor_iterations
    integer :: refactor = refactor_iterations
    !> Growth of the struck point's deflection that renews the operator, fraction of the thickness
    real(wp) :: stiffness_update = 0.003_wp
    !> Change of the stress at the struck point wanted in one step, fraction of its largest value so far
    real(wp) :: stress_change = 0.05_wp
    !> Iterations of a step above which the operator is renewed (refactor_iterations)
    integer :: iterations = 16
    !> Smallest part of the step left to a delamination that grows one cell a step; 1: it takes whole steps
    real(wp) :: growth_step = 0.25_wp
  end type adapt_t

  !> Convergence and linear algebra.
  type :: solver_t
    !> Residual of equilibrium accepted, relative to the forces in play
    real(wp) :: tolerance = 1.0e-6_wp
    !> Iterations of equilibrium before a step is tried again with half its length
    integer :: max_iterations = 30
    !> factorization_mumps or factorization_cholmod (one rank only)
    integer :: factorization = factorization_mumps
    !> Handed to PETSc as they are
    character(len=:), allocatable :: petsc_options
  end type solver_t
end module dynamics_parameters
