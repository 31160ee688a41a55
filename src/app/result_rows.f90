!> The columns of the history and the row of an accepted step.
module result_rows
  use kinds, only: wp
  use marches, only: march_t
  implicit none
  private
  public :: row_of

  !> Number of columns.
  integer, parameter, public :: columns = 28
  !> Their names; the first seventeen and their order are the public interface.
  character(len=*), parameter, public :: column_names(columns) = [character(len=24) :: &
    'time', 'step', 'force', 'indentation', 'impactor_displacement', 'impactor_velocity', 'deflection', &
    'delaminated_area', 'energy_impactor', 'energy_kinetic', 'energy_strain', 'energy_indentation', &
    'energy_delamination', 'energy_ply_damage', 'energy_contact', 'energy_algorithmic', 'energy_error', &
    'patch_deflection', 'work_external', 'step_length', 'stress', 'iterations', 'force_iterations', &
    'total_iterations', 'total_force_iterations', 'rejected', 'refactorisations', 'solves']
  !> Which of them are whole numbers.
  logical, parameter, public :: column_whole(columns) = &
    [.false., .true., spread(.false., 1, 19), spread(.true., 1, 7)]

contains

  !> Row of the state reached.
  pure function row_of(march) result(row)
    !> The march
    type(march_t), intent(in) :: march
    !> Values in the order of the columns
    real(wp) :: row(columns)

    associate (now => march%now, ledger => march%now%ledger)
      row(1:7) = [now%time, real(now%step, wp), now%force, now%indentation%alpha, now%impactor%displacement, &
                  now%impactor%velocity, now%deflection]
      row(8) = 0
      row(9:12) = [ledger%impactor, ledger%kinetic, ledger%strain, ledger%indentation]
      row(13:15) = 0
      row(16:21) = [ledger%algorithmic, ledger%error(), now%patch_mean, ledger%external_work, &
                    march%controller%last, now%stress]
      row(22:28) = real([now%iterations, now%force_iterations, now%all_iterations, now%all_force_iterations, &
                         march%rejected, march%operator%factorizations, march%operator%solves], wp)
    end associate
  end function row_of
end module result_rows
