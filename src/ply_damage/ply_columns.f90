!> Columns of the history for failed plies.
module ply_columns
  use failed_plies_areas, only: failed_counts
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use ply_failures, only: ply_failure_t
  use result_tables, only: result_row_length
  implicit none
  private
  public :: ply_values, permanent_values

  !> Failures in each mode, counted per ply and element, and energies of softening plies.
  character(len=result_row_length), parameter, public :: ply_rows(*) = [character(len=result_row_length) :: &
    'fibre_failures | integer | - | Plies of elements whose fibres have failed, counted over the full plate.', &
    'matrix_cracks | integer | - | Plies of elements whose matrix has cracked, counted over the full plate.', &
    'matrix_crushings | integer | - | Plies of elements whose matrix was crushed, counted over the full plate.', &
    'energy_fibre_tension | real | energy | Part of energy_ply_damage by fibre failure in tension.', &
    'energy_fibre_compression | real | energy | Part of energy_ply_damage by fibre failure in compression.', &
    'energy_matrix_cracking | real | energy | Part of energy_ply_damage by matrix cracking in transverse tension &
      &and shear.', &
    'energy_matrix_crushing | real | energy | Part of energy_ply_damage by matrix failure in transverse compression &
      &and shear.']

  !> Permanent strains of softening plies.
  character(len=result_row_length), parameter, public :: permanent_rows(*) = [character(len=result_row_length) :: &
    'energy_permanent_shear | real | energy | Part of energy_ply_damage by permanent shear strains of plies.']

contains

  !> Failures in each mode. Collective.
  function ply_values(plate, plies) result(values)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> One value per column, the same on every rank
    real(wp) :: values(size(ply_rows))

    values = [real(failed_counts(plate, plies), wp), plies%dissipated]
  end function ply_values

  !> Energies of permanent strains.
  pure function permanent_values(plies) result(values)
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> One value per column
    real(wp) :: values(size(permanent_rows))

    values = [plies%permanent_shear]
  end function permanent_values
end module ply_columns
