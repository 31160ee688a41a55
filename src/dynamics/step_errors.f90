!> Estimate of the error of motion of plate and impactor in a step in time, theory (T3). The phase error of a
!> second-order method for a harmonic of frequency w is c (w h)**3 in a step h, so the error is c h**3 times the third
!> derivative, computed from the last four states by divided differences. Unlike h**2 (beta - 1/6) times the change of
!> acceleration (Zienkiewicz and Xie 1991) it is finite for modes that the step does not resolve, whose acceleration
!> alternates.
module step_errors
  use archives, only: archive_t
  use field_mappings, only: area_field
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use newmark_integrators, only: plate_integrator_t
  use states, only: state_t
  use stepping_parameters, only: expected_response_t
  use tan_sun_indentation, only: indentation_stiffness
  implicit none
  private
  public :: step_error_t, error_weights

  !> Number of stored previous states.
  integer, parameter :: past = 2

  !> Previous states, and the largest values so far.
  type :: step_error_t
    !> Number of stored states
    integer :: known = 0
    !> Their times, indentations and deflections of the struck point, latest first
    real(wp) :: time(past) = 0, indentation(past) = 0, struck(past) = 0
    !> Their deflections of the plate, (owned points, past)
    real(wp), allocatable :: deflection(:, :)
    !> Fraction of the plate's area at each point, (owned points)
    real(wp), allocatable :: share(:)
    !> Largest force, contact stiffness and deflection of the struck point so far
    real(wp) :: force = 0, stiffness = 0, largest = 0
  contains
    procedure :: start
    procedure :: estimate
    procedure :: record
    procedure :: reset
    procedure :: impact_is_over
    procedure :: visit
  end type step_error_t

contains

  !> Sets the stored states to the plate at rest and the impactor in free flight before first contact.
  subroutine start(self, model, step)
    class(step_error_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> A step: the spacing of the states before the first contact
    real(wp), intent(in) :: step
    real(wp), allocatable :: unit(:, :), mass(:, :)
    real(wp) :: total

    associate (owned => model%plate%distribution%owned)
      allocate (self%deflection(owned, past), source=0.0_wp)
      allocate (unit, mass, source=spread(spread(0.0_wp, 1, 5), 2, size(model%plate%distribution%points)))
      where (model%plate%zone == 0) unit(3, :) = 1
      call model%inertia(unit, mass)
      self%share = mass(3, :owned)*unit(3, :owned)
    end associate
    total = sum(self%share)
    call model%plate%communicator%sum(total)
    self%share = self%share/total
    if (.not. model%plate%setup%impactor%is_present) return
    self%known = past
    self%time = -step*[1, 2]
    self%indentation = model%plate%setup%impactor%velocity*self%time
  end subroutine start

  !> Weights of the last four states, latest first, in the error of displacements over the last step. For
  !> generalised-alpha c = 1/12 + 3/8 ((1 - rho)/(1 + rho))**2, for Newmark's method beta/2 - 1/24 and, in the second
  !> difference, its damping (gamma - 1/2)/2; found from the roots of their amplification at small w h.
  pure function error_weights(integrator, times) result(weights)
    type(plate_integrator_t), intent(in) :: integrator
    !> Times of the states
    real(wp), intent(in) :: times(:)
    real(wp) :: weights(size(times))
    real(wp) :: step, third, second
    integer :: i

    step = times(1) - times(2)
    third = 1.0_wp/12 + 0.375_wp*(1 - 2*integrator%alpha_f)**2
    second = 0
    if (abs(integrator%alpha_m) + abs(integrator%alpha_f) <= 0) then
      third = abs(integrator%beta/2 - 1.0_wp/24)
      second = (integrator%gamma - 0.5_wp)/2
    end if
    do i = 1, size(times)
      weights(i) = third*6*step**3/product(times(i) - pack(times, [1, 2, 3, 4] /= i))
    end do
    do i = 1, 3
      weights(i) = weights(i) + second*2*step**2/product(times(i) - pack(times(:3), [1, 2, 3] /= i))
    end do
  end function error_weights

  !> Error of a trial step: the larger of the error of the contact force relative to the largest force and that of the
  !> deflection relative to the largest deflection. 0 for fewer than four states. Collective.
  subroutine estimate(self, plate, integrator, expected, now, trial, error)
    !> The estimate; updates the largest force and deflection
    class(step_error_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(plate_integrator_t), intent(in) :: integrator
    !> Expected response of the run
    type(expected_response_t), intent(in) :: expected
    !> State at the start of the step
    type(state_t), intent(in) :: now
    !> State at its end
    type(state_t), intent(in) :: trial
    real(wp), intent(out) :: error
    real(wp) :: weights(past + 2), square, struck, force, deflection

    error = 0
    if (self%known < past) return
    weights = error_weights(integrator, [trial%time, now%time, self%time])
    square = sum(self%share*(weights(1)*trial%motion%displacement(3, :size(self%share)) &
                             + weights(2)*now%motion%displacement(3, :size(self%share)) &
                             + weights(3)*self%deflection(:, 1) + weights(4)*self%deflection(:, 2))**2)
    call plate%communicator%sum(square)
    deflection = max(expected%deflection, self%largest, abs(trial%impact%deflection))
    struck = dot_product(weights, [trial%impact%deflection, now%impact%deflection, self%struck])
    if (deflection > 0) error = max(sqrt(square), abs(struck))/deflection
    if (.not. plate%setup%impactor%is_present .or. self%impact_is_over(expected, trial)) return
    force = max(expected%force, self%force, trial%impact%force)
    if (force > 0) error = max(error, max(self%stiffness, stiffness_of(plate, trial))/force* &
                               abs(dot_product(weights, [trial%impact%indentation%alpha, now%impact%indentation%alpha, &
                                                         self%indentation])))
  end subroutine estimate

  !> Stiffness of the contact at a state.
  pure real(wp) function stiffness_of(plate, state) result(stiffness)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: state

    stiffness = indentation_stiffness(plate%setup%impactor%indentation, state%impact%indentation, &
                                      state%impact%indentation%alpha)
  end function stiffness_of

  !> True: the impactor has left the plate and moves away from it, and no other contact is expected.
  pure logical function impact_is_over(self, expected, state) result(over)
    class(step_error_t), intent(in) :: self
    !> Expected response of the run
    type(expected_response_t), intent(in) :: expected
    type(state_t), intent(in) :: state

    over = self%force > 0 .and. .not. state%impact%force > 0 .and. state%impact%impactor%velocity < 0 .and. &
           state%time > expected%last_contact
  end function impact_is_over

  !> Stores a state before it is replaced, and updates the largest values by the next one.
  subroutine record(self, model, now, next)
    class(step_error_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The state to be replaced
    type(state_t), intent(in) :: now
    !> The next state
    type(state_t), intent(in) :: next

    self%known = min(self%known + 1, past)
    self%time = [now%time, self%time(1)]
    self%indentation = [now%impact%indentation%alpha, self%indentation(1)]
    self%struck = [now%impact%deflection, self%struck(1)]
    self%deflection(:, 2) = self%deflection(:, 1)
    self%deflection(:, 1) = now%motion%displacement(3, :size(self%share))
    self%largest = max(self%largest, abs(next%impact%deflection))
    if (.not. model%plate%setup%impactor%is_present) return
    self%force = max(self%force, next%impact%force)
    self%stiffness = max(self%stiffness, stiffness_of(model%plate, next))
  end subroutine record

  !> Discards the states before a sudden change: failed plies or grown fronts change the forces at the end of a step
  !> abruptly. Divided differences across it give a third derivative that grows as the step gets shorter, although the
  !> step itself has no such error.
  pure subroutine reset(self)
    class(step_error_t), intent(inout) :: self

    self%known = 0
  end subroutine reset

  !> Saves or loads the stored states.
  subroutine visit(self, archive, plate)
    class(step_error_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: field(:, :)

    call archive%item('step_error/known', self%known)
    call archive%item('step_error/time_1', self%time(1))
    call archive%item('step_error/time_2', self%time(2))
    call archive%item('step_error/indentation_1', self%indentation(1))
    call archive%item('step_error/indentation_2', self%indentation(2))
    call archive%item('step_error/struck_1', self%struck(1))
    call archive%item('step_error/struck_2', self%struck(2))
    call archive%item('step_error/force', self%force)
    call archive%item('step_error/stiffness', self%stiffness)
    call archive%item('step_error/largest', self%largest)
    field = transpose(self%deflection)
    call plate%visit_points(archive, 'step_error/deflection', field, area_field)
    self%deflection = transpose(field)
  end subroutine visit
end module step_errors
