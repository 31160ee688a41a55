!> A pilot calculation: the impactor against the modes of the plate, step by step as the run will take them. In
!> milliseconds it tells force, duration and contacts to expect, and what a step or mesh is worth.
module pilot_impacts
  use impact_parameters, only: impactor_parameters_t, indentation_law_t
  use kinds, only: wp
  use modal_plates, only: modal_plate_t
  use tan_sun_indentation, only: indentation_t, indentation_force, indentation_stiffness, touch_indentation, &
                                 commit_indentation
  implicit none
  private
  public :: pilot_t, run_pilot, difference, figures_of

  !> Modes side by side, and steps that they are moved at once: both stay next to the processor while they are.
  integer, parameter :: lanes = 64, ahead = 64

  !> What a pilot calculation found.
  type :: pilot_t
    !> Step
    real(wp) :: step = 0
    !> Force at the end of each step
    real(wp), allocatable :: force(:)
    !> Largest force and its time
    real(wp) :: peak = 0, peak_time = 0
    !> Largest indentation and deflection of the patch
    real(wp) :: indentation = 0, deflection = 0
    !> Time after which the force never passes a hundredth of its peak again
    real(wp) :: last_contact = 0
    !> Time that the bodies touched in all, and velocity of the impactor at the end
    real(wp) :: duration = 0, velocity = 0
    !> Times that the bodies touched
    integer :: contacts = 0
    !> The contact was over before the steps were
    logical :: complete = .false.
  end type pilot_t

  !> Modes as steps of the average acceleration move them, side by side so that the compiler takes several at once. The
  !> velocity is kept as the way of half a step: a step then turns position p and velocity v into t (p + v) + v and
  !> t (p + v) - p, and a force at either end of it adds the same to both.
  type :: moving_modes_t
    !> Deflection of the patch by each mode, and its rate times half a step, (lanes, blocks)
    real(wp), allocatable :: position(:, :), velocity(:, :)
    !> Both as they are after the steps looked ahead, if no force comes
    real(wp), allocatable :: next_position(:, :), next_velocity(:, :)
    !> The factor t of a step
    real(wp), allocatable :: turn(:, :)
    !> Deflection per force at either end of the step
    real(wp), allocatable :: give(:, :)
    !> Deflection so many steps after a force of one at the end of a step
    real(wp) :: answer(ahead) = 0
  end type moving_modes_t

  !> Part of the largest force that counts as contact.
  real(wp), parameter :: contact_part = 0.01_wp
  !> A contact that ended is taken to be the last if none follows for as long as it took up to then.
  real(wp), parameter :: waiting = 2
  !> Halvings and Newton steps for the force; Newton needs five.
  integer, parameter :: most_iterations = 60

contains

  !> Runs a pilot calculation by the average acceleration, which is generalised-alpha without damping.
  pure function run_pilot(plate, impactor, law, step, most_steps, to_the_end) result(pilot)
    !> Modes of the plate
    type(modal_plate_t), intent(in) :: plate
    !> The impactor
    type(impactor_parameters_t), intent(in) :: impactor
    !> Indentation law
    type(indentation_law_t), intent(in) :: law
    !> Step
    real(wp), intent(in) :: step
    !> Steps taken at most
    integer, intent(in) :: most_steps
    !> True: all steps are taken; false: the calculation ends once the contact is over
    logical, intent(in) :: to_the_end
    !> What was found
    type(pilot_t) :: pilot
    type(indentation_t) :: contact
    type(moving_modes_t) :: modes
    real(wp), allocatable :: force(:)
    real(wp) :: ball(3), compliance, rigid, free(2), now, before, deflection, alone(ahead)
    integer :: i, active, first

    call start_modes(plate, step, modes)
    allocate (force(-ahead:most_steps), source=0.0_wp)
    compliance = plate%rest + sum(modes%give)
    rigid = step**2/(4*impactor%mass)
    ball = [0.0_wp, impactor%velocity, impactor%gravity]
    pilot%step = step
    now = 0
    active = 0
    do i = 1, most_steps
      before = now
      free(1) = ball(1) + step*ball(2) + step**2/4*(ball(3) + impactor%gravity)
      if (mod(i - 1, ahead) == 0) then
        first = i - 1
        call move_modes(modes, force(first - ahead:first), alone)
      end if
      free(2) = alone(i - first) + dot_product(modes%answer(:i - first - 1), force(i - 1:first + 1:-1))
      call find_force(law, contact, free(1) - free(2), compliance + rigid, now)
      ball(1) = free(1) - rigid*now
      ball(2) = ball(2) + step/2*(ball(3) + impactor%gravity - now/impactor%mass)
      ball(3) = impactor%gravity - now/impactor%mass
      deflection = free(2) + compliance*now
      call commit_indentation(law, contact, ball(1) - deflection)
      force(i) = now
      pilot%deflection = max(pilot%deflection, abs(deflection))
      if (now > pilot%peak) pilot%peak_time = i*step
      pilot%peak = max(pilot%peak, now)
      if (now > 0 .and. .not. before > 0) pilot%contacts = pilot%contacts + 1
      if (now > 0) pilot%duration = pilot%duration + step
      if (now > contact_part*pilot%peak) active = i
      if (i > waiting*active .and. active > 0 .and. .not. to_the_end) exit
    end do
    pilot%complete = i <= most_steps
    pilot%force = force(1:min(i, most_steps))
    pilot%indentation = contact%alpha_max
    pilot%last_contact = active*step
    pilot%velocity = ball(2)
  end function run_pilot

  !> Modes at rest, and what a step makes of them.
  pure subroutine start_modes(plate, step, modes)
    !> Modes of the plate
    type(modal_plate_t), intent(in) :: plate
    !> Step
    real(wp), intent(in) :: step
    !> The modes in lanes; those that fill the last lanes do nothing
    type(moving_modes_t), intent(out) :: modes
    real(wp), allocatable :: square(:), weight(:)
    real(wp) :: pulse(-ahead:0)
    integer :: blocks

    blocks = (size(plate%frequency) + lanes - 1)/lanes
    square = [plate%frequency**2, spread(0.0_wp, 1, blocks*lanes - size(plate%frequency))]
    weight = [plate%weight, spread(0.0_wp, 1, blocks*lanes - size(plate%frequency))]
    allocate (modes%position(lanes, blocks), modes%velocity(lanes, blocks), source=0.0_wp)
    allocate (modes%next_position(lanes, blocks), modes%next_velocity(lanes, blocks), source=0.0_wp)
    modes%turn = reshape((1 - square*step**2/4)/(1 + square*step**2/4), [lanes, blocks])
    modes%give = reshape(weight*step**2/4/(1 + square*step**2/4), [lanes, blocks])
    pulse = 0
    pulse(0) = 1
    call move_modes(modes, pulse, modes%answer)
    modes%next_position = 0
    modes%next_velocity = 0
  end subroutine start_modes

  !> Takes the modes over the steps whose forces have been found, and looks as many steps ahead.
  pure subroutine move_modes(modes, force, alone)
    !> The modes, `ahead` steps back; receives them at the end of the last step
    type(moving_modes_t), intent(inout) :: modes
    !> Forces at the ends of these steps, that at the start of the first before them
    real(wp), intent(in) :: force(0:ahead)
    !> Deflection of the patch at the ends of the steps to come without forces there
    real(wp), intent(out) :: alone(ahead)
    real(wp) :: position(lanes), velocity(lanes), turn(lanes), give(lanes), total(lanes, ahead), turned, before, pushed
    integer :: block, i, lane, pushes

    pushes = merge(ahead, 0, any(force(1:) > 0))
    if (pushes == 0) modes%position = modes%next_position
    if (pushes == 0) modes%velocity = modes%next_velocity
    total = 0
    do block = 1, size(modes%position, 2)
      position = modes%position(:, block)
      velocity = modes%velocity(:, block)
      turn = modes%turn(:, block)
      give = modes%give(:, block)
      do i = 1, pushes
        pushed = force(i - 1) + force(i)
        do lane = 1, lanes
          before = position(lane)
          turned = turn(lane)*(before + velocity(lane)) + give(lane)*pushed
          position(lane) = turned + velocity(lane)
          velocity(lane) = turned - before
        end do
      end do
      modes%position(:, block) = position
      modes%velocity(:, block) = velocity
      do i = 1, ahead
        pushed = merge(force(ahead), 0.0_wp, i == 1)
        do lane = 1, lanes
          before = position(lane)
          turned = turn(lane)*(before + velocity(lane)) + give(lane)*pushed
          position(lane) = turned + velocity(lane)
          velocity(lane) = turned - before
          total(lane, i) = total(lane, i) + position(lane)
        end do
      end do
      modes%next_position(:, block) = position
      modes%next_velocity(:, block) = velocity
    end do
    alone = sum(total, 1)
  end subroutine move_modes

  !> The one root of F = F(alpha_free - compliance F), by Newton's method within an interval.
  pure subroutine find_force(law, contact, free, compliance, force)
    !> The law
    type(indentation_law_t), intent(in) :: law
    !> The contact so far
    type(indentation_t), intent(in) :: contact
    !> Indentation without force
    real(wp), intent(in) :: free
    !> Indentation lost per unit of force
    real(wp), intent(in) :: compliance
    !> The force of the step before, to begin with; receives the new one
    real(wp), intent(inout) :: force
    real(wp) :: low, high, rest, next, touch
    integer :: i

    touch = touch_indentation(law, contact)
    if (free <= touch) then
      force = 0
      return
    end if
    low = 0
    high = (free - touch)/compliance
    if (.not. (force > low .and. force < high)) force = high/2
    do i = 1, most_iterations
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

  !> What a summary of a run tells, in its order: largest force, its time, time in contact, largest deflection, velocity
  !> of the impactor at the end.
  pure function figures_of(pilot) result(figures)
    !> The pilot
    type(pilot_t), intent(in) :: pilot
    !> The figures
    real(wp) :: figures(5)

    figures = [pilot%peak, pilot%peak_time, pilot%duration, pilot%deflection, pilot%velocity]
  end function figures_of

  !> What two pilots differ by: largest force, and the whole history in the mean of squares, relative to the finer one.
  pure function difference(coarse, fine, ratio) result(relative)
    !> The pilot with the longer steps
    type(pilot_t), intent(in) :: coarse
    !> The other one
    type(pilot_t), intent(in) :: fine
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
end module pilot_impacts
