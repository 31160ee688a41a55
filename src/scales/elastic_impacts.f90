!> A preliminary elastic impact: the impactor coupled to the modes of the plate, with the steps of the run. It gives
!> force, duration and number of contacts, and the errors by step and mesh, in milliseconds of computing time.
module elastic_impacts
  use impact_parameters, only: impactor_parameters_t, indentation_law_t
  use kinds, only: wp
  use modal_plates, only: modal_plate_t
  use patch_responses, only: patch_response_t, start_response, predicted_deflection, predict_deflections, block_steps
  use tan_sun_indentation, only: indentation_t, indentation_force, indentation_stiffness, zero_force_indentation, &
                                 commit_indentation
  implicit none
  private
  public :: elastic_impact_t, run_elastic_impact, difference, bound_of_difference, difference_at_peak, figures_of

  !> Results of a preliminary elastic impact.
  type :: elastic_impact_t
    !> Step
    real(wp) :: step = 0
    !> Force at the end of each step
    real(wp), allocatable :: force(:)
    !> Largest force and its time
    real(wp) :: peak = 0, peak_time = 0
    !> Largest indentation and deflection of the patch
    real(wp) :: indentation = 0, deflection = 0
    !> Time after which the force no longer exceeds a hundredth of its peak
    real(wp) :: last_contact = 0
    !> Time after which there is no force at all: the force may be small for a long time before the bodies separate
    real(wp) :: last_touch = 0
    !> Total time of contact, and velocity of the impactor at the end
    real(wp) :: duration = 0, velocity = 0
    !> Number of contacts
    integer :: contacts = 0
    !> True: the contact ended before the last step
    logical :: complete = .false.
    !> True: there was contact in the last step, so that `last_contact` is only the end of the calculation
    logical :: is_cut = .false.
  end type elastic_impact_t

  !> Fraction of the largest force above which the force counts as contact: 1 %, its permitted error.
  real(wp), parameter :: contact_part = 0.01_wp
  !> A contact that ended is taken to be the last if none follows for as long as it took up to then: at its velocity
  !> the impactor is then farther away than the plate has moved. An impactor that still moves on meets the plate again,
  !> unless that is free to move ahead of it.
  real(wp), parameter :: waiting = 2
  !> Fraction of the largest force above which the peak of a contact is compared, too: with the errors permitted, at
  !> most 5 %, a smaller peak cannot become the largest.
  real(wp), parameter :: min_peak_ratio = 0.9_wp
  !> Largest number of bisections and Newton steps for the force; Newton's method needs five.
  integer, parameter :: max_iterations = 60

contains

  !> Runs a preliminary elastic impact by the average acceleration, which is generalised-alpha without damping.
  pure function run_elastic_impact(plate, impactor, law, step, max_steps, to_the_end) result(elastic)
    type(modal_plate_t), intent(in) :: plate
    type(impactor_parameters_t), intent(in) :: impactor
    type(indentation_law_t), intent(in) :: law
    real(wp), intent(in) :: step
    !> Largest number of steps
    integer, intent(in) :: max_steps
    !> True: all steps are taken; false: the calculation ends once the contact is over
    logical, intent(in) :: to_the_end
    type(elastic_impact_t) :: elastic
    type(indentation_t) :: contact
    type(patch_response_t) :: patch
    real(wp), allocatable :: force(:)
    real(wp) :: ball(3), rigid, free(2), now, before, deflection
    integer :: i, active

    patch = start_response(plate, step, max_steps, to_the_end)
    allocate (force(max_steps), source=0.0_wp)
    rigid = step**2/(4*impactor%mass)
    ball = [0.0_wp, impactor%velocity, impactor%gravity]
    elastic%step = step
    now = 0
    active = 0
    do i = 1, max_steps
      before = now
      free(1) = ball(1) + step*ball(2) + step**2/4*(ball(3) + impactor%gravity)
      if (mod(i - 1, block_steps) == 0 .and. i > 1) call predict_deflections(patch, i - 1, force)
      free(2) = predicted_deflection(patch, i, force)
      call find_force(law, contact, free(1) - free(2), patch%immediate + rigid, now)
      ball(1) = free(1) - rigid*now
      ball(2) = ball(2) + step/2*(ball(3) + impactor%gravity - now/impactor%mass)
      ball(3) = impactor%gravity - now/impactor%mass
      deflection = free(2) + patch%immediate*now
      call commit_indentation(law, contact, ball(1) - deflection)
      force(i) = now
      elastic%deflection = max(elastic%deflection, abs(deflection))
      if (now > elastic%peak) elastic%peak_time = i*step
      elastic%peak = max(elastic%peak, now)
      if (now > 0 .and. .not. before > 0) elastic%contacts = elastic%contacts + 1
      if (now > 0) elastic%duration = elastic%duration + step
      if (now > contact_part*elastic%peak) active = i
      if (now > 0) elastic%last_touch = i*step
      if (to_the_end .or. active == 0 .or. i <= waiting*active) cycle
      if (ball(2) <= impactor%gravity*(i - active)*step .or. any(plate%frequency <= 0)) exit
    end do
    elastic%complete = i <= max_steps
    elastic%force = force(:min(i, max_steps))
    elastic%indentation = contact%alpha_max
    elastic%last_contact = active*step
    elastic%is_cut = active > 0 .and. active == size(elastic%force)
    elastic%velocity = ball(2)
  end function run_elastic_impact

  !> The root of F = F(alpha_free - compliance F), by Newton's method within an interval.
  pure subroutine find_force(law, contact, free, compliance, force)
    type(indentation_law_t), intent(in) :: law
    !> The contact so far
    type(indentation_t), intent(in) :: contact
    !> Indentation without force
    real(wp), intent(in) :: free
    !> Decrease of the indentation per unit of force
    real(wp), intent(in) :: compliance
    !> The force of the step before as first guess; receives the new one
    real(wp), intent(inout) :: force
    real(wp) :: low, high, rest, next, touch
    integer :: i

    touch = zero_force_indentation(law, contact)
    if (free <= touch) then
      force = 0
      return
    end if
    low = 0
    high = (free - touch)/compliance
    if (.not. (force > low .and. force < high)) force = high/2
    do i = 1, max_iterations
      rest = indentation_force(law, contact, free - compliance*force) - force
      if (rest > 0) then
        low = force
      else
        high = force
      end if
      next = force + rest/(1 + compliance*indentation_stiffness(law, contact, free - compliance*force))
      if (.not. (next > low .and. next < high)) next = (low + high)/2
      if (abs(next - force) <= 1.0e-10_wp*next) exit
      force = next
    end do
    force = next
  end subroutine find_force

  !> Results in the order of the summary: largest force, its time, time in contact, largest deflection, velocity of the
  !> impactor at the end.
  pure function figures_of(elastic) result(figures)
    type(elastic_impact_t), intent(in) :: elastic
    real(wp) :: figures(5)

    figures = [elastic%peak, elastic%peak_time, elastic%duration, elastic%deflection, elastic%velocity]
  end function figures_of

  !> Difference of two elastic impacts: largest force, and root mean square of the history, relative to the finer one.
  pure function difference(coarse, fine, ratio) result(relative)
    !> The elastic impact with the longer steps
    type(elastic_impact_t), intent(in) :: coarse
    !> The other one
    type(elastic_impact_t), intent(in) :: fine
    !> Steps of the finer one in one of the coarser
    integer, intent(in) :: ratio
    !> Of the peak, of the history
    real(wp) :: relative(2)
    integer :: number

    relative = 0
    number = min(size(coarse%force), size(fine%force)/ratio)
    associate (wanted => fine%force(ratio:ratio*number:ratio))
      if (.not. (fine%peak > 0 .and. sum(wanted**2) > 0)) return
      relative(1) = abs(coarse%peak/fine%peak - 1)
      relative(2) = sqrt(sum((coarse%force(:number) - wanted)**2)/sum(wanted**2))
    end associate
  end function difference

  !> The same, but with the largest error among the peaks of all contacts whose force is close to the largest. In
  !> repeated contacts the error of a single peak may be small by coincidence, so that it is no bound. In a single
  !> contact only the largest force counts.
  pure function bound_of_difference(coarse, fine, ratio) result(relative)
    !> The elastic impact with the longer steps
    type(elastic_impact_t), intent(in) :: coarse
    !> The other one
    type(elastic_impact_t), intent(in) :: fine
    !> Steps of the finer one in one of the coarser
    integer, intent(in) :: ratio
    !> Of the peaks, of the history
    real(wp) :: relative(2)
    real(wp) :: largest, now
    integer :: number, i, first

    relative = difference(coarse, fine, ratio)
    number = min(size(coarse%force), size(fine%force)/ratio)
    largest = 0
    first = 1
    do i = 1, number
      now = maxval(fine%force(ratio*(i - 1) + 1:ratio*i))
      largest = max(largest, now)
      if (now > 0 .and. i < number) cycle
      if (largest >= min_peak_ratio*fine%peak) &
        relative(1) = max(relative(1), abs(maxval(coarse%force(first:i)) - largest)/fine%peak)
      largest = 0
      first = i
    end do
  end function bound_of_difference

  !> Root mean square difference of two elastic impacts around the largest force of the finer one, as a force. In a long
  !> contact the error at the instant of the peak may vanish by coincidence; therefore the forces around it are
  !> included.
  pure real(wp) function difference_at_peak(coarse, fine, ratio, beside) result(force)
    !> The elastic impact with the longer steps
    type(elastic_impact_t), intent(in) :: coarse
    !> The other one
    type(elastic_impact_t), intent(in) :: fine
    !> Steps of the finer one in one of the coarser
    integer, intent(in) :: ratio
    !> Number of steps of the coarser one that are compared before and after the largest force
    integer, intent(in) :: beside
    integer :: number, at, first, last

    number = min(size(coarse%force), size(fine%force)/ratio)
    at = maxloc(fine%force(ratio:ratio*number:ratio), 1)
    first = max(1, at - beside)
    last = min(number, at + beside)
    force = norm2(coarse%force(first:last) - fine%force(ratio*first:ratio*last:ratio))/sqrt(real(last - first + 1, wp))
  end function difference_at_peak
end module elastic_impacts
