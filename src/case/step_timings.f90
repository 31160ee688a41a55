!> Processor time of steps by central differences on this machine, measured before a run.
module step_timings
  use central_differences, only: central_difference_t
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use element_steps, only: small_setup
  use errors, only: error_t
  use kinds, only: wp
  use model_building, only: create_model
  use models, only: model_t
  use setups, only: setup_t
  use states, only: new_state, state_t
  implicit none
  private
  public :: measured_element_time

  !> Elements of all layers of the plate. With 1000 to 4000 the time foreseen for input/peanut.nml without damage was 15
  !> to 21 s.
  integer, parameter :: elements = 2000
  !> Processor seconds of the measurement
  real(wp), parameter :: duration = 0.05_wp

contains

  !> Processor seconds for an element of one layer in a step of a plate with the laminate and the interfaces of a deck;
  !> 0: not found. Interfaces are damaged if the expected force exceeds their threshold: layers are there where they are
  !> damaged, or soon will be.
  real(wp) function measured_element_time(deck) result(seconds)
    !> The deck, its mesh checked
    type(deck_t), intent(in) :: deck
    type(setup_t) :: setup
    type(model_t) :: model
    type(state_t), allocatable :: now
    type(central_difference_t) :: method
    type(communicator_t) :: alone
    type(error_t), allocatable :: error

    seconds = 0
    setup = small_setup(deck, ceiling(sqrt(real(elements, wp)/(1 + size(deck%setup%delaminations)))), &
                        deck%setup%zones%at(deck%setup%mesh%struck))
    setup%ply_damage%is_present = deck%setup%ply_damage%is_present
    setup%ply_damage = deck%setup%ply_damage
    call create_model(setup, alone, model, error)
    if (allocated(error)) return
    allocate (now, source=new_state(model))
    ! The time does not depend on how much they are damaged.
    if (deck%expected%force > deck%expected%scales%threshold .and. allocated(now%interfaces%cohesive%points)) &
      now%interfaces%cohesive%points%damage = 0.5_wp
    call method%start(model, deck%stepping%central, now)
    seconds = step_time(method, model, now)/model%plate%elements%elements
  end function measured_element_time

  !> Processor seconds of a step.
  real(wp) function step_time(method, model, now) result(seconds)
    type(central_difference_t), intent(inout) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(inout) :: now
    real(wp) :: begin, end
    integer :: steps

    ! The first step prepares inertia and stacks.
    call method%advance(model, huge(begin), 1.0_wp, now)
    call cpu_time(begin)
    end = begin
    steps = 0
    do while (end - begin < duration)
      call method%advance(model, huge(begin), 1.0_wp, now)
      steps = steps + 1
      call cpu_time(end)
    end do
    seconds = (end - begin)/steps
  end function step_time
end module step_timings
