!> How often what is around a step is looked at. Steps by central differences are many and cheap: what need not be done
!> in each of them is done after some.
module step_intervals
  use kinds, only: wp
  use stepping_parameters, only: is_explicit, stepping_t
  implicit none
  private
  public :: steps_between_checks, steps_between_stages

  !> Seconds that central differences take of one processor for an element of one layer in one step. Measured on panels
  !> with cohesive interfaces and crack bands, gfortran 12 with -O3 on one core of an AMD EPYC; the elastic Sun-Chen
  !> plate takes .2e-6.
  real(wp), parameter, public :: seconds_per_element = 0.55e-6_wp
  !> Seconds of one processor in which a run looks at its ledger, its limits, at signals and at elapsed time: SLURM
  !> gives 30 from the signal to the end (KillWait).
  real(wp), parameter :: seconds_between_checks = 1
  !> Most steps between two looks. With these their costs, those of about one step, do not count.
  integer, parameter :: max_between_checks = 64
  !> Steps of central differences between two checks of what of the interfaces is damaged. A look costs a twentieth of a
  !> step, and damage is found as late as a hundredth of the time in which the force of a blow rises.
  integer, parameter :: between_stages = 8

contains

  !> Steps between two looks. The same on any number of ranks and after a restart, as warnings are given then.
  pure integer function steps_between_checks(stepping, elements) result(steps)
    !> How steps are taken
    type(stepping_t), intent(in) :: stepping
    !> Number of elements of all layers
    integer, intent(in) :: elements

    steps = 1
    if (is_explicit(stepping)) steps = max(1, min(max_between_checks, int(seconds_between_checks/ &
      (seconds_per_element*elements))))
  end function steps_between_checks

  !> Steps between two checks of what of the interfaces is damaged.
  pure integer function steps_between_stages(stepping) result(steps)
    !> How steps are taken
    type(stepping_t), intent(in) :: stepping

    steps = merge(between_stages, 1, is_explicit(stepping))
  end function steps_between_stages
end module step_intervals
