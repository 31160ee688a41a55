!> Intervals, in steps, of checks of a run: steps by central differences are many and short in computing time, so that
!> checks are made at intervals.
module step_intervals
  use kinds, only: wp
  implicit none
  private
  public :: interval_of_checks

  !> Processor time of central differences, in seconds per element of one layer and step. Measured on panels with
  !> cohesive interfaces and crack bands, gfortran 12, on the machine of doc/performance.md; the elastic Sun-Chen plate
  !> takes .2e-6.
  real(wp), parameter, public :: seconds_per_element = 0.55e-6_wp
  !> Interval in seconds of one processor at which a run checks its ledger, its limits, signals and elapsed time: SLURM
  !> allows 30 from the signal to the end (KillWait).
  real(wp), parameter :: seconds_between_checks = 1
  !> Largest number of steps between two checks: a check costs about one step.
  integer, parameter :: max_between_checks = 64
  !> Steps of central differences between two updates of the damaged state of interfaces. An update costs a twentieth of
  !> a step, and the delay is a hundredth of the rise time of the contact force.
  integer, parameter, public :: interval_of_stages = 8

contains

  !> Steps between two checks.
  pure integer function interval_of_checks(elements) result(steps)
    !> Number of elements of all layers
    integer, intent(in) :: elements

    steps = max(1, min(max_between_checks, int(seconds_between_checks/(seconds_per_element*elements))))
  end function interval_of_checks
end module step_intervals
