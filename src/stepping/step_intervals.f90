!> Intervals, in steps, of checks of a run: steps by central differences are many and short in computing time, so that
!> checks are made at intervals.
module step_intervals
  use kinds, only: wp
  use stepping_parameters, only: is_explicit, stepping_t
  implicit none
  private
  public :: steps_between_checks, steps_between_stages

  !> Processor time of central differences, in seconds per element of one layer and step. Measured on panels with
  !> cohesive interfaces and crack bands, gfortran 12 with -O3 on one core of an AMD EPYC; the elastic Sun-Chen plate
  !> takes .2e-6.
  real(wp), parameter, public :: seconds_per_element = 0.55e-6_wp
  !> Interval in seconds of one processor at which a run checks its ledger, its limits, signals and elapsed time: SLURM
  !> allows 30 from the signal to the end (KillWait).
  real(wp), parameter :: seconds_between_checks = 1
  !> Largest number of steps between two checks: a check costs about one step.
  integer, parameter :: max_between_checks = 64
  !> Steps of central differences between two updates of the damaged state of interfaces. An update costs a twentieth of
  !> a step, and the delay is a hundredth of the rise time of the contact force.
  integer, parameter :: between_stages = 8

contains

  !> Steps between two checks. It is the same on any number of ranks and after a restart, as warnings are given at
  !> checks.
  pure integer function steps_between_checks(stepping, elements) result(steps)
    !> Parameters of steps
    type(stepping_t), intent(in) :: stepping
    !> Number of elements of all layers
    integer, intent(in) :: elements

    steps = 1
    if (is_explicit(stepping)) steps = max(1, min(max_between_checks, int(seconds_between_checks/ &
      (seconds_per_element*elements))))
  end function steps_between_checks

  !> Steps between two updates of the damaged state of interfaces.
  pure integer function steps_between_stages(stepping) result(steps)
    !> Parameters of steps
    type(stepping_t), intent(in) :: stepping

    steps = merge(between_stages, 1, is_explicit(stepping))
  end function steps_between_stages
end module step_intervals
