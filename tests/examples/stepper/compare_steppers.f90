!> Half a vibration of a plate under a sudden pressure by the example's stepper and by the implicit one, each called as
!> a run calls its stepper.
program compare_steppers
  use communicators, only: communicator_t, finish_mpi, start_mpi
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck_text
  use errors, only: error_t
  use example_checks, only: require
  use kinds, only: wp
  use model_building, only: create_model
  use models, only: model_t
  use petsc_session, only: finish_petsc, start_petsc
  use stepper_choice, only: choose_stepper
  use steppers, only: stepper_t
  use verlet_steppers, only: verlet_stepper_t
  implicit none
  character(len=1), parameter :: nl = achar(10)
  character(len=*), parameter :: plate = '&plate length=.06, .04 edges=''simple'' symmetry=''quarter'' /'//nl// &
    '&case kinematics=''linear'' /'//nl//'&mesh elements=4, 4 mass=''lumped'' /'//nl// &
    '&material name=''al'' density=2700 E=70e9 nu=.3 /'//nl// &
    '&laminate materials=''al'' angles=0 thicknesses=2e-3 /'//nl// &
    '&pressure value=1e3 /'//nl//'&time end=115e-6 '
  type(communicator_t) :: communicator
  class(stepper_t), allocatable :: stepper
  type(error_t), allocatable :: failure
  real(wp) :: deflections(3), errors(3)

  call start_mpi(communicator)
  call start_petsc(communicator, '', failure)
  if (allocated(failure)) stop 1
  call follow('step=1e-6 /', .false., deflections(1), errors(1))
  call follow('step=1e-7 /', .true., deflections(2), errors(2))
  call follow('step=5e-8 /', .true., deflections(3), errors(3))
  call require('Verlet over implicit deflection', deflections(2)/deflections(1), 1.0_wp, 2e-4_wp)
  call require('energy error over work, steps of 0.1 us', errors(2), 0.0_wp, 2e-6_wp)
  call require('its ratio with half the step', errors(3)/errors(2), 0.25_wp, 0.005_wp)
  call finish_petsc()
  call finish_mpi()

contains

  !> Follows the vibration with one of the steppers.
  subroutine follow(steps, by_verlet, deflection, largest_error)
    !> End of the group &time
    character(len=*), intent(in) :: steps
    !> True: by the example's stepper
    logical, intent(in) :: by_verlet
    !> Deflection at the end, and largest energy error over the work of the pressure
    real(wp), intent(out) :: deflection, largest_error
    type(deck_t) :: deck
    type(problems_t) :: problems
    type(model_t) :: model
    type(error_t), allocatable :: error

    call read_deck_text(plate//steps//nl, 'deck', deck, problems)
    if (problems%errors() > 0) stop 2
    call create_model(deck%setup, communicator, model, error)
    if (allocated(error)) stop 3
    if (by_verlet) then
      if (allocated(stepper)) deallocate (stepper)
      allocate (verlet_stepper_t :: stepper)
    else
      call choose_stepper(deck%stepping, stepper)
    end if
    call stepper%start(model, deck%stepping, deck%linear_solver, .false., error)
    if (allocated(error)) stop 4
    largest_error = 0
    do while (stepper%now%time < deck%stepping%time%end*(1 - 1e-9_wp))
      call stepper%advance(model, deck%stepping%time%end, error)
      if (allocated(error)) stop 5
      largest_error = max(largest_error, abs(stepper%now%ledger%error()))
    end do
    deflection = stepper%now%impact%deflection
    largest_error = largest_error/stepper%now%ledger%external_work
    call stepper%operator%release()
  end subroutine follow
end program compare_steppers
