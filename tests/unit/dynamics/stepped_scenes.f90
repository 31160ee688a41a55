!> Scenes together with how their steps are taken, for the tests of dynamics.
module stepped_scenes
  use errors, only: error_t
  use communicators, only: communicator_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use stepping_parameters, only: stepping_t
  use scenes, only: scene_t
  use models, only: model_t
  use model_building, only: create_model
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: stepped_scene_t, build_model, start_stepping

  !> A scene and its steps.
  type, extends(scene_t) :: stepped_scene_t
    !> How steps are taken
    type(stepping_t) :: stepping
  end type stepped_scene_t

contains

  !> Makes a scene ready for computing.
  subroutine build_model(scene, communicator, model, error)
    !> The scene
    type(stepped_scene_t), intent(in) :: scene
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The model
    type(model_t), intent(out) :: model
    !> Set if it cannot be built
    type(error_t), allocatable, intent(out) :: error

    call create_model(scene%scene_t, communicator, model, error)
  end subroutine build_model

  !> Puts the plate of a scene at rest.
  subroutine start_stepping(scene, model, stepper, error)
    !> The scene
    type(stepped_scene_t), intent(in) :: scene
    !> Its model
    type(model_t), intent(in) :: model
    !> The stepper
    type(time_stepper_t), intent(out) :: stepper
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error
    type(linear_solver_parameters_t) :: linear_solver

    call stepper%start(model, scene%stepping, linear_solver, .false., error)
  end subroutine start_stepping
end module stepped_scenes
