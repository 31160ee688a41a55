!> Setups together with how their steps are taken, for the tests of dynamics.
module stepped_setups
  use errors, only: error_t
  use communicators, only: communicator_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use stepping_parameters, only: stepping_t
  use setups, only: setup_t
  use models, only: model_t
  use model_building, only: create_model
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: stepped_setup_t, build_model, start_stepping

  !> A setup and its steps.
  type, extends(setup_t) :: stepped_setup_t
    !> How steps are taken
    type(stepping_t) :: stepping
  end type stepped_setup_t

contains

  !> Makes a setup ready for computing.
  subroutine build_model(setup, communicator, model, error)
    !> The setup
    type(stepped_setup_t), intent(in) :: setup
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The model
    type(model_t), intent(out) :: model
    !> Set if it cannot be built
    type(error_t), allocatable, intent(out) :: error

    call create_model(setup%setup_t, communicator, model, error)
  end subroutine build_model

  !> Puts the plate of a setup at rest.
  subroutine start_stepping(setup, model, stepper, error)
    !> The setup
    type(stepped_setup_t), intent(in) :: setup
    !> Its model
    type(model_t), intent(in) :: model
    !> The stepper
    type(time_stepper_t), intent(out) :: stepper
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error
    type(linear_solver_parameters_t) :: linear_solver

    call stepper%start(model, setup%stepping, linear_solver, .false., error)
  end subroutine start_stepping
end module stepped_setups
