!> Controls the length of time steps and when the operator is factorized again.
module step_controllers
  use kinds, only: wp
  use archives, only: archive_t
  use gear_integrator, only: largest_growth_ratio
  use solution_controls, only: step_controls_t
  use stepping_parameters, only: stepping_t, is_error_controlled, refactor_deflection
  implicit none
  private
  public :: step_controller_t

  !> Ratio above which a step counts as longer than another one: above round-off, below any factor of a step.
  real(wp), parameter :: longer_than = 1 + 1.0e-9_wp

  !> State of the controller.
  type :: step_controller_t
    !> Next step length, and the last one taken
    real(wp) :: target = 0, last = 0
    !> Number of consecutive steps of that length
    integer :: equal_steps = 0
    !> Factor by which growing fronts reduce the step: powers of one half, so that the factored operator need not be
    !> renewed at every small change
    real(wp) :: part = 1
    !> Fewest iterations of a step with the present factorization, and the sum of those in excess of it
    integer :: fewest = huge(1), excess = 0
    !> Steps with the present step length
    integer :: steady_steps = 0
    !> Largest error among them, relative to the tolerance
    real(wp) :: error = 0
    !> Pending doublings of the step, which wait until the remaining time to the next event is a multiple
    integer :: doublings = 0
    !> First error-controlled step; after a failure no step is shortened below it
    real(wp) :: first = 0
  contains
    procedure :: begin
    procedure :: shortest
    procedure :: adapt_to_error
    !> Shortens the step after one with too large an error.
    procedure :: shorten
    !> Length of the next step, so that steps meet the next output time.
    procedure :: propose
    procedure :: accept
    procedure :: limit_by_fronts
    procedure :: limit_by_ply_damage
    procedure :: reject
    procedure :: renewal_due
    procedure :: renewed
    procedure :: visit
  end type step_controller_t

contains

  !> Length of the next step, such that an integer number of steps reaches the next event.
  pure real(wp) function propose(self, remaining, limit, growth) result(step)
    class(step_controller_t), intent(in) :: self
    !> Time to the next event
    real(wp), intent(in) :: remaining
    !> Longest stable step of the impactor's integrator
    real(wp), intent(in) :: limit
    !> Largest ratio to the previous step; left out: that of consecutive growth
    real(wp), intent(in), optional :: growth
    real(wp) :: ratio, longer

    ratio = largest_growth_ratio
    if (present(growth)) ratio = growth
    step = self%part*self%target
    longer = step*2.0_wp**self%doublings
    ! A longer step is taken once the remaining time is a multiple of it, so that few lengths occur.
    if (abs(remaining/longer - anint(remaining/longer)) < 1.0e-6_wp .and. remaining > longer/2) step = longer
    step = min(step, limit)
    if (self%last > 0) step = min(step, ratio*self%last)
    step = remaining/max(1.0_wp, ceiling_as_real(remaining/step*(1 - 1.0e-9_wp)))
  end function propose

  !> Smallest integer not below x, as a real: the number of steps may exceed the largest default integer.
  pure real(wp) function ceiling_as_real(x) result(whole)
    !> A number
    real(wp), intent(in) :: x

    whole = aint(x)
    if (whole < x) whole = whole + 1
  end function ceiling_as_real

  !> Updates the step length after an accepted step.
  pure subroutine accept(self, stepping, step, iterations, lag_iterations, stress_change)
    class(step_controller_t), intent(inout) :: self
    type(stepping_t), intent(in) :: stepping
    !> Step taken
    real(wp), intent(in) :: step
    !> Its iterations, and those that a new factorization would have saved
    integer, intent(in) :: iterations, lag_iterations
    !> Change of the stress at the struck point over its largest value so far
    real(wp), intent(in) :: stress_change
    real(wp) :: room

    self%equal_steps = merge(self%equal_steps + 1, 1, abs(step - self%last) <= 1.0e-9_wp*step)
    self%last = step
    self%fewest = min(self%fewest, lag_iterations)
    self%excess = self%excess + lag_iterations - self%fewest
    room = 2
    if (is_error_controlled(stepping%adapt)) then
      return
    else if (stepping%adapt%on) then
      room = stepping%adapt%stress_change/max(stress_change, tiny(room)**0.5_wp)
      if (4*iterations > 3*stepping%equilibrium%max_iterations) room = min(room, 0.7_wp)
    end if
    if (room < 0.8_wp) then
      self%target = self%target*max(room, 0.5_wp)
    else if (room > 1.5_wp) then
      self%target = self%target*largest_growth_ratio
    end if
    self%target = min(max(self%target, stepping%time%step_min), stepping%time%step_max)
  end subroutine accept

  !> First error-controlled step: that of the deck, or that chosen from the tolerance and the rise time of first
  !> contact. All later steps are this one times a power of two, and an integer number of them reaches the first event.
  pure subroutine begin(self, stepping, remaining)
    class(step_controller_t), intent(inout) :: self
    type(stepping_t), intent(in) :: stepping
    !> Time to the first event
    real(wp), intent(in) :: remaining
    real(wp) :: parts, step

    step = stepping%time%step
    if (stepping%expected%rise > 0) &
      step = min(step, stepping%expected%rise*(stepping%controls%first_error*stepping%adapt%tolerance)**(1.0_wp/3))
    step = min(max(step, stepping%time%step_min), stepping%time%step_max)
    parts = remaining/step
    self%target = 1
    do while (parts > stepping%controls%first_parts)
      parts = parts/2
      self%target = self%target/2
    end do
    self%target = self%target*remaining/max(1.0_wp, ceiling_as_real(parts*(1 - 1.0e-9_wp)))
    self%first = self%target
  end subroutine begin

  !> Shortest step under error control: the smallest step of the deck, or after a failure the first step of the run. A
  !> sudden failure emits waves as short as the mesh resolves; only steps that resolve all of these would meet the
  !> tolerance.
  pure real(wp) function shortest(self, stepping, damaged)
    class(step_controller_t), intent(in) :: self
    type(stepping_t), intent(in) :: stepping
    !> True once plies have failed or delaminations have grown
    logical, intent(in) :: damaged

    shortest = stepping%time%step_min
    if (damaged) shortest = max(shortest, self%first)
  end function shortest

  !> Halves the step by the error of an accepted one, or doubles it if this saves more than the new factorization costs.
  pure subroutine adapt_to_error(self, stepping, step, error, remaining, is_over, gear, damaged)
    class(step_controller_t), intent(inout) :: self
    type(stepping_t), intent(in) :: stepping
    !> Step taken, and its error relative to the tolerance
    real(wp), intent(in) :: step, error
    !> Time to the end of the run
    real(wp), intent(in) :: remaining
    !> True: there is no impact, or it is over
    logical, intent(in) :: is_over
    !> True: Gear's method integrates the impactor's motion
    logical, intent(in) :: gear
    !> True once plies have failed or delaminations have grown
    logical, intent(in) :: damaged
    integer :: doublings
    real(wp) :: allowed_error, shortest

    associate (controls => stepping%controls)
      if (step > 1.5_wp*self%part*self%target) then
        self%target = step/self%part
        call reset_errors(self)
      end if
      self%steady_steps = self%steady_steps + 1
      self%error = max(self%error, error)
      shortest = self%shortest(stepping, damaged)
      if (error > controls%shortening_error .and. self%part*self%target > shortest*longer_than) then
        call self%shorten(controls, step, error, shortest)
      else if (self%doublings == 0 .and. &
               self%steady_steps >= merge(controls%steady_after, controls%steady_in_impact, is_over)) then
        allowed_error = merge(controls%allowed_after, controls%allowed_in_impact, is_over)
        do doublings = merge(controls%doublings_of_gear, controls%max_doublings, gear), 1, -1
          if (self%target*2.0_wp**doublings > stepping%time%step_max) cycle
          if (self%error*8.0_wp**doublings > allowed_error &
              .and. self%target*2.0_wp**doublings > shortest*longer_than) cycle
          if (remaining*(1 - 0.5_wp**doublings) > stepping%adapt%iterations*step) exit
        end do
        call reset_errors(self)
        self%doublings = doublings
      end if
    end associate
  end subroutine adapt_to_error

  !> Resets the record of errors.
  pure subroutine reset_errors(self)
    class(step_controller_t), intent(inout) :: self

    self%steady_steps = 0
    self%error = 0
    self%doublings = 0
  end subroutine reset_errors

  !> Halves the step until the predicted error is within the tolerance.
  pure subroutine shorten(self, controls, step, error, shortest)
    class(step_controller_t), intent(inout) :: self
    !> Constants of the control of steps
    type(step_controls_t), intent(in) :: controls
    !> Step accepted or rejected, and its error over the tolerance
    real(wp), intent(in) :: step, error
    !> Shortest step under error control
    real(wp), intent(in) :: shortest

    self%target = max(shortest, step/self%part*0.5_wp**max(1, nint(log(error/controls%shortening_error)/log(8.0_wp) &
                                                                                 + 0.2_wp)))
    call reset_errors(self)
  end subroutine shorten

  !> Shortens the step where delaminations that grow one cell per step are about to grow or have grown (section 3.3.3 of
  !> the paper, step 5). As the energy release rate approaches the critical one, the step is halved at 0.9 of it, at
  !> 0.95 and so on, down to twice the smallest factor; after growth the smallest factor is taken. It then doubles in
  !> each step within the limit of growth.
  pure subroutine limit_by_fronts(self, stepping, ratio, extended)
    class(step_controller_t), intent(inout) :: self
    type(stepping_t), intent(in) :: stepping
    !> Largest ratio of energy release rate to its critical value in the step
    real(wp), intent(in) :: ratio
    !> True if a front grew in it
    logical, intent(in) :: extended
    real(wp) :: smallest, allowed

    smallest = min(1.0_wp, max(stepping%adapt%growth_step, stepping%time%step_min/self%target))
    allowed = 1
    do while (allowed/2 >= max(2*smallest, (1 - ratio)/(1 - stepping%controls%ratio_near_growth)))
      allowed = allowed/2
    end do
    if (extended) then
      self%part = smallest
    else
      self%part = min(allowed, max(smallest, 2*self%part))
    end if
  end subroutine limit_by_fronts

  !> Doubles a step that was shortened because plies fail, once the lag of damage is small.
  pure subroutine limit_by_ply_damage(self, stepping, damage_lag)
    class(step_controller_t), intent(inout) :: self
    type(stepping_t), intent(in) :: stepping
    !> Lag of damage in the last step, relative to its limit
    real(wp), intent(in) :: damage_lag

    if (stepping%adapt%on) return
    self%target = self%last/self%part
    if (damage_lag < stepping%controls%allowed_damage_lag) self%target = min(2*self%target, stepping%time%step_max)
  end subroutine limit_by_ply_damage

  !> Halves the step after a rejected one. Pending doublings are cancelled: with them the next trial would have the
  !> length that was rejected.
  pure subroutine reject(self, step)
    class(step_controller_t), intent(inout) :: self
    !> Rejected step
    real(wp), intent(in) :: step

    self%target = step/(2*self%part)
    call reset_errors(self)
  end subroutine reject

  !> True if the operator should be factorized again before a step: by the paper's rule, or once the additional
  !> iterations have cost about as much as a factorization.
  pure logical function renewal_due(self, stepping, nonlinear, mass_ratio, deflection_change, thickness) result(due)
    class(step_controller_t), intent(in) :: self
    type(stepping_t), intent(in) :: stepping
    !> True: the stiffness depends on the deflection
    logical, intent(in) :: nonlinear
    !> Mass factor of the step over that of the operator
    real(wp), intent(in) :: mass_ratio
    !> Change of the struck point's deflection since the factorization
    real(wp), intent(in) :: deflection_change
    !> Thickness of the laminate
    real(wp), intent(in) :: thickness

    if (stepping%adapt%refactor == refactor_deflection) then
      due = abs(mass_ratio - 1) > 0.01_wp
      if (nonlinear) &
        due = due .or. abs(deflection_change) > stepping%adapt%stiffness_update*thickness
    else
      due = min(mass_ratio, 1/mass_ratio) < stepping%controls%min_mass_ratio .or. &
            self%excess >= stepping%adapt%iterations
    end if
  end function renewal_due

  !> Resets the count of iterations after a factorization.
  pure subroutine renewed(self)
    class(step_controller_t), intent(inout) :: self

    self%fewest = huge(1)
    self%excess = 0
  end subroutine renewed

  !> Saves or loads the controller.
  subroutine visit(self, archive)
    class(step_controller_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('controller/wanted', self%target)
    call archive%item('controller/last', self%last)
    call archive%item('controller/equal', self%equal_steps)
    call archive%item('controller/part', self%part)
    call archive%item('controller/fewest', self%fewest)
    call archive%item('controller/excess', self%excess)
    call archive%item('controller/quiet', self%steady_steps)
    call archive%item('controller/error', self%error)
    call archive%item('controller/levels', self%doublings)
    call archive%item('controller/first', self%first)
  end subroutine visit
end module step_controllers
