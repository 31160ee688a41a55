!> Columns of the history for an accepted step: motion, energies, length and iterations of the step. The energies are
!> defined in doc/manual/energy_ledger.md.
module step_columns
  use kinds, only: wp
  use energy_ledgers, only: ledger_t
  use output_clocks, only: shown_time
  use result_tables, only: result_row_length
  use states, only: state_t
  implicit none
  private
  public :: motion_values, ledger_values, step_values, iteration_values

  !> Motion of impactor and plate. These columns and their order are the public interface.
  character(len=result_row_length), parameter, public :: motion_rows(*) = [character(len=result_row_length) :: &
    'time | real | time | Time at the end of the step; in a static analysis the load relative to the full load.', &
    'step | integer | - | Accepted steps so far.', &
    'force | real | force | Contact force between impactor and plate, positive where they press on each other.', &
    'indentation | real | length | Displacement of the impactor less the mean deflection of the patch; &
      &negative: a gap.', &
    'impactor_displacement | real | length | Displacement of the impactor towards the plate since first contact.', &
    'impactor_velocity | real | length/time | Velocity of the impactor, positive towards the plate.', &
    'deflection | real | length | Deflection of the struck point on the struck side, positive along the impact.']

  !> The energy ledger. These columns and their order are the public interface.
  character(len=result_row_length), parameter, public :: ledger_rows(*) = [character(len=result_row_length) :: &
    'energy_impactor | real | energy | Kinetic energy of the impactor and its potential in gravity; the latter is 0 &
      &at first contact.', &
    'energy_kinetic | real | energy | Kinetic energy of the plate.', &
    'energy_strain | real | energy | Strain energy of the plate with its damaged stiffness.', &
    'energy_indentation | real | energy | Work of the contact force on the indentation, stored and dissipated.', &
    'energy_delamination | real | energy | Fracture energy of delaminations: dissipated by cohesive laws, &
      &or critical energy release rate times area of the cells released by fronts.', &
    'energy_ply_damage | real | energy | Energy dissipated by the failure of plies.', &
    'energy_contact | real | energy | Energy lost in contact of surfaces, and of plate and frame: minus the &
      &work of contact forces; with penalty ties also their energy.', &
    'energy_algorithmic | real | energy | Algorithmic (numerical) dissipation by time integrators, implicit &
      &interface forces and released ties, without the energy_delamination of fronts.', &
    'energy_error | real | energy | Energy imbalance: the sum of the eight energies before, &
      &energy_friction, energy_layers and energy_damping, minus work_external and the energy at the start.']

  !> Other quantities of the state, and the length of the step.
  character(len=result_row_length), parameter, public :: step_rows(*) = [character(len=result_row_length) :: &
    'patch_deflection | real | length | Mean deflection of the patch since first contact, along the impact.', &
    'work_external | real | energy | Work so far of pressure and lines, and of the force that moves an impactor &
      &with a prescribed travel.', &
    'step_length | real | time | Length of the step; 0 in a static analysis.', &
    'stress | real | pressure | Bending stress 6 M/h^2 of the undamaged plies around the struck point, with those of &
      &doublers, used by rule = ''stress_rate'' of &adapt.']

  !> Iterations.
  character(len=result_row_length), parameter, public :: iteration_rows(*) = [character(len=result_row_length) :: &
    'iterations | integer | - | Corrections of the displacement in the step; after growth of fronts those &
      &of its last solution.', &
    'force_iterations | integer | - | Newton and bisection steps for the contact force in the step, &
      &counted as `iterations`.', &
    'contact_iterations | integer | - | Updates of contact pressures in the step before they converged, &
      &counted as `iterations`.', &
    'total_iterations | integer | - | Sum of iterations over the accepted steps.', &
    'total_force_iterations | integer | - | Sum of force_iterations over the accepted steps.', &
    'total_contact_iterations | integer | - | Sum of contact_iterations over the accepted steps.', &
    'rejected | integer | - | Rejected steps so far; each was repeated with a shorter length or more layers.']

  !> Further entries of the ledger.
  character(len=result_row_length), parameter, public :: heat_rows(*) = [character(len=result_row_length) :: &
    'energy_friction | real | energy | Heat of sliding by friction between surfaces.', &
    'energy_layers | real | energy | Strain and kinetic energy lost where elements are split into layers as a zone &
      &grows: round-off.']

  !> Damping.
  character(len=result_row_length), parameter, public :: damping_rows(*) = [character(len=result_row_length) :: &
    'energy_damping | real | energy | Kinetic energy removed by settle of &time.']

  !> Contact with the impactor.
  character(len=result_row_length), parameter, public :: contact_rows(*) = [character(len=result_row_length) :: &
    'contact_area | real | area | Contact area of the impactor: the patch, or the area in contact with its nose.']

contains

  !> Motion of impactor and plate.
  pure function motion_values(now) result(values)
    type(state_t), intent(in) :: now
    !> One value per column
    real(wp) :: values(size(motion_rows))

    values = [now%time, real(now%step, wp), now%impact%force, now%impact%indentation%alpha, &
              now%impact%impactor%displacement, now%impact%impactor%velocity, now%impact%deflection]
  end function motion_values

  !> The energy ledger.
  pure function ledger_values(ledger) result(values)
    type(ledger_t), intent(in) :: ledger
    !> One value per column
    real(wp) :: values(size(ledger_rows))

    values = [ledger%impactor, ledger%kinetic, ledger%strain, ledger%indentation, ledger%delamination, &
              ledger%ply_damage, ledger%contact, ledger%algorithmic, ledger%error()]
  end function ledger_values

  !> Other quantities of the state, and the length of the step.
  pure function step_values(now, length) result(values)
    type(state_t), intent(in) :: now
    !> Length of the last step
    real(wp), intent(in) :: length
    !> One value per column
    real(wp) :: values(size(step_rows))

    values = [now%impact%patch_mean, now%ledger%external_work, shown_time(length), now%impact%stress]
  end function step_values

  !> Iterations.
  pure function iteration_values(now, rejected) result(values)
    type(state_t), intent(in) :: now
    !> Rejected steps
    integer, intent(in) :: rejected
    !> One value per column
    real(wp) :: values(size(iteration_rows))

    values = real([now%iterations%equilibrium, now%iterations%force, now%iterations%contact, &
                   now%all_iterations%equilibrium, now%all_iterations%force, now%all_iterations%contact, rejected], wp)
  end function iteration_values
end module step_columns
