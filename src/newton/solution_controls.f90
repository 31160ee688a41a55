!> Constants of Newton's method and of the step control. They affect the cost of a run, and its results within the error
!> of the steps; doc/studies/solution_controls.md gives the effect of each. The group &controls of a deck sets them for
!> studies.
module solution_controls
  use kinds, only: wp
  implicit none
  private
  public :: newton_controls_t, step_controls_t

  !> Constants of Newton's method, each of which is used by one decision of the iteration.
  type :: newton_controls_t
    !> Largest forcing term, and the factor of the squared ratio of the last residuals that gives the next one
    !> (S. C. Eisenstat, H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, choice 2). Used in `forcing_terms`
    real(wp) :: max_forcing_term = 1.0e-3_wp, forcing_factor = 0.9_wp
    !> Part of the tolerance to which the last linear system is solved (`forcing_terms`)
    real(wp) :: forcing_margin = 0.3_wp
    !> Reduction of the residual by the factored operator below which element tangents are used, whose product costs a
    !> fifth of a solve (`step_problems`)
    real(wp) :: element_reduction = 1.0e-2_wp
    !> Complementarity of pressures and gaps, relative to the largest pressure, over the tolerance of the residual: both
    !> are errors of forces, and their sum should be near the tolerance (`step_problems`)
    real(wp) :: contact_share = 0.5_wp
    !> Directional derivative over its initial value at which a line search ends (H. Matthies, G. Strang, Int. J. Numer.
    !> Methods Eng. 14 (1979) 1613-1626). Used in `line_searches`
    real(wp) :: search_slope = 0.5_wp
    !> Bounds of the next trial within a bracket (`line_searches`)
    real(wp) :: search_min_part = 0.1_wp, search_max_part = 0.9_wp
    !> Largest number of trials: the eighth is within 1e-3 of the bracket by bisection (`line_searches`)
    integer :: search_trials = 8
    !> Reference of a residual over the largest forces so far, where forces have become small (`residual_norms`)
    real(wp) :: force_floor = 1.0e-6_wp
    !> Last digits of the elements' forces, in units of the machine's precision, below which no residual is reduced
    !> (`residual_norms`)
    real(wp) :: last_digits = 32
    !> Iterations within which a load step with the consistent tangent converges, unless it alternates between two
    !> states (`static_steps`)
    integer :: alternating_iterations = 8
    !> Relative tolerance of the energy that a step is to dissipate: it changes the length of a step, not its
    !> equilibrium (`dissipation_steps`)
    real(wp) :: dissipation_tolerance = 1.0e-2_wp
  end type newton_controls_t

  !> Constants of the control of steps: their length, and the age of the factored operator. Load steps, steps in time
  !> and both rules of adaptivity have their own.
  type :: step_controls_t
    !> Largest number of parts of a load step, ten halvings, at which a run ends without equilibrium (`load_steps`)
    integer :: load_step_parts = 1024
    !> Ratio of the energy release rate to its critical value above which fronts that grow by one cell per step shorten
    !> it (`step_controllers`, as all below)
    real(wp) :: ratio_near_growth = 0.8_wp
    !> Ratio of the smaller to the larger mass factor of step and lagged operator below which the operator is renewed.
    !> With half or twice the step length it is .25; with a limit of .1, with which the operator is kept at twice the
    !> step length, runs take 23 % longer
    real(wp) :: min_mass_ratio = 0.3_wp
    !> Errors, relative to the tolerance, above which the next step is halved, and above which a step is rejected. The
    !> error is of third order in the step length: halving reduces the first to a quarter
    real(wp) :: shortening_error = 2, rejection_error = 8
    !> Error of a step relative to the third power of its ratio to the rise time of first contact
    real(wp) :: first_error = 4
    !> Largest predicted error of a longer step, relative to the tolerance, during an impact and after it
    real(wp) :: allowed_in_impact = 0.125_wp, allowed_after = 0.5_wp
    !> Largest number of doublings at once under error control. Gear's method is stable with one after some equal steps:
    !> the product of its companion matrices then has the norm 23; 1100 after two steps, 128 with two at once, 6 without
    integer :: max_doublings = 3, doublings_of_gear = 1, equal_of_gear = 4
    !> Steps without a change before a step is lengthened: during an impact, where waves may return, and after it
    integer :: steady_in_impact = 24, steady_after = 8
    !> Lag of damage in a step, relative to its limit, above which the next step is not doubled. It is of second order:
    !> an onset within a step costs half the decrease of the force times the displacement beyond it
    real(wp) :: allowed_damage_lag = 0.25_wp
    !> Largest number of parts of the time to the first event; error-controlled steps are these parts, halved repeatedly
    integer :: first_parts = 8
  end type step_controls_t
end module solution_controls
