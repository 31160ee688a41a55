!> Setups together with the parameters of their steps, for the tests of dynamics.
module stepped_setups
  use kinds, only: wp
  use errors, only: error_t
  use communicators, only: communicator_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use material_parameters, only: material_t
  use stepping_parameters, only: stepping_t
  use setups, only: setup_t
  use models, only: model_t
  use model_building, only: create_model
  use small_operators, only: factor
  use small_setups, only: unit_plate
  use tangent_operators, only: tangent_operator_t
  use implicit_steppers, only: implicit_stepper_t
  implicit none
  private
  public :: stepped_setup_t, stepped_plate, build_model, start_stepping, release_from

  !> A setup and its steps.
  type, extends(setup_t) :: stepped_setup_t
    !> Parameters of the steps
    type(stepping_t) :: stepping
  end type stepped_setup_t

contains

  !> A simply supported unit square with linear strains and no load, and equilibrium to round-off.
  pure function stepped_plate(material, angles, thickness, elements, quarter) result(setup)
    !> The material of all plies
    type(material_t), intent(in) :: material
    !> Angles of the plies, degrees, and thickness of them all
    real(wp), intent(in) :: angles(:), thickness
    !> Elements along each side of the modelled part
    integer, intent(in) :: elements
    !> True: a quarter is modelled
    logical, intent(in) :: quarter
    !> The setup
    type(stepped_setup_t) :: setup

    setup%setup_t = unit_plate(material, angles, thickness, elements, quarter)
    setup%stepping%equilibrium%tolerance = 1.0e-12_wp
  end function stepped_plate

  !> Prepares a setup for computing.
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

  !> Starts the plate of a setup from rest.
  subroutine start_stepping(setup, model, stepper, error)
    !> The setup
    type(stepped_setup_t), intent(in) :: setup
    !> Its model
    type(model_t), intent(in) :: model
    !> The stepper
    type(implicit_stepper_t), intent(out) :: stepper
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error
    type(linear_solver_parameters_t) :: linear_solver

    call stepper%start(model, setup%stepping, linear_solver, .false., error)
  end subroutine start_stepping

  !> Gives a started plate a shape from which it is released.
  subroutine release_from(stepper, model, displacement, error)
    !> The time stepper, started
    type(implicit_stepper_t), intent(inout) :: stepper
    !> The model
    type(model_t), intent(in) :: model
    !> The shape, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Set if the mass cannot be factored
    type(error_t), allocatable, intent(out) :: error
    type(tangent_operator_t) :: mass
    real(wp) :: energy

    associate (motion => stepper%now%motion)
      motion%displacement = displacement
      call model%internal(model%plate%elements%stiffness, displacement, motion%internal, energy)
      call factor(model, 0*displacement, 0.0_wp, 1.0_wp, mass, error)
      if (allocated(error)) return
      call mass%correct(model%plate, -motion%internal, motion%acceleration, error)
      call mass%solver%release()
      call model%inertia(motion%acceleration, motion%inertia)
    end associate
    stepper%now%ledger%strain = energy*model%plate%mesh%multiplicity
    stepper%now%ledger%initial = stepper%now%ledger%strain
  end subroutine release_from
end module stepped_setups
