!> Content of a deck, as plain parameters with its text.
module deck_contents
  use case_deck, only: case_t
  use deck_settings, only: settings_t
  use stepping_parameters, only: stepping_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use output_parameters, only: output_t
  use setup_elastic_impacts, only: expected_scales_t
  use setups, only: setup_t
  use text, only: line_t
  implicit none
  private
  public :: deck_t


  !> A deck: the setup to model, and output and stepping parameters.
  type :: deck_t
    !> Path or name it was read from
    character(len=:), allocatable :: source
    !> Text of the deck, for the results and a restart
    character(len=:), allocatable :: text
    type(case_t) :: case
    !> The setup to model
    type(setup_t) :: setup
    !> Values chosen for the accuracy, with reasons
    type(line_t), allocatable :: reasons(:)
    !> Scales of the setup, and expected results
    type(expected_scales_t) :: expected
    !> True for groups of the deck on steps
    logical :: has_time = .false., has_adapt = .false.
    !> Parameters of steps
    type(stepping_t) :: stepping
    type(linear_solver_parameters_t) :: linear_solver
    !> Parts that are written
    type(output_t) :: output
    !> Warnings on the deck, repeated at the end of its run
    type(line_t), allocatable :: remarks(:)
    !> All keys in effect
    type(settings_t) :: settings
  end type deck_t
end module deck_contents
