!> The columns of the history and the row of an accepted step.
module result_rows
  use kinds, only: wp
  use models, only: model_t
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: row_of

  !> Number of columns.
  integer, parameter, public :: columns = 38
  !> Their names; the first seventeen and their order are the public interface.
  character(len=*), parameter, public :: column_names(columns) = [character(len=24) :: &
    'time', 'step', 'force', 'indentation', 'impactor_displacement', 'impactor_velocity', 'deflection', &
    'delaminated_area', 'energy_impactor', 'energy_kinetic', 'energy_strain', 'energy_indentation', &
    'energy_delamination', 'energy_ply_damage', 'energy_contact', 'energy_algorithmic', 'energy_error', &
    'patch_deflection', 'work_external', 'step_length', 'stress', 'release_ratio', &
    'energy_released', 'penetration', 'complementarity', 'iterations', 'force_iterations', &
    'contact_iterations', 'total_iterations', 'total_force_iterations', 'total_contact_iterations', 'rejected', &
    'refactorisations', 'solves', 'fibre_failures', 'matrix_cracks', 'matrix_crushings', &
    'border_reached']
  !> Which of them are whole numbers.
  logical, parameter, public :: column_whole(columns) = &
    [.false., .true., spread(.false., 1, 23), spread(.true., 1, 13)]

contains

  !> Row of the state reached.
  function row_of(model, stepper) result(row)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(time_stepper_t), intent(in) :: stepper
    !> Values in the order of the columns
    real(wp) :: row(columns)

    associate (now => stepper%now, ledger => stepper%now%ledger)
      row(1:7) = [now%time, real(now%step, wp), now%force, now%indentation%alpha, now%impactor%displacement, &
                  now%impactor%velocity, now%deflection]
      row(8) = now%interfaces%faces%area(model)
      row(9:12) = [ledger%impactor, ledger%kinetic, ledger%strain, ledger%indentation]
      row(13:15) = [ledger%delamination, ledger%ply_damage, ledger%contact]
      row(16:25) = [ledger%algorithmic, ledger%error(), now%patch_mean, ledger%external_work, &
                    stepper%controller%last, now%stress, now%interfaces%release_ratio, &
                    sum(now%interfaces%ties%set_free), &
                    now%interfaces%faces%penetration(model, now%motion%displacement), &
                    now%interfaces%faces%complementarity(model, now%motion%displacement)]
      row(26:37) = real([now%iterations, now%force_iterations, now%contact_iterations, now%all_iterations, &
                         now%all_force_iterations, now%all_contact_iterations, stepper%rejected, &
                         stepper%operator%factorizations, stepper%operator%solves, stepper%failures%counts(model)], wp)
      row(38) = merge(1.0_wp, 0.0_wp, now%interfaces%border_reached)
    end associate
  end function row_of
end module result_rows
