!> The results of a run: the one table of their names, types, kinds of unit, labels and meanings. The summary, the log,
!> the verification, `implam explain summary` and the manual read it.
module summary_rows
  use result_tables, only: cell, field_row, result_row_length
  implicit none
  private
  public :: type_of_result, unit_of_result, label_of_result

  !> Heading, and numbers of the cells.
  character(len=*), parameter, public :: summary_heading = 'name | type | unit | label | meaning'
  integer, parameter :: of_type = 2, of_unit = 3, of_label = 4
  integer, parameter, public :: summary_meaning = 5

  !> The results, in the order of the summary.
  character(len=result_row_length), parameter, public :: summary_table(*) = [character(len=result_row_length) :: &
    'time_reached | real | time | time | Time at the end of the run; load_factor_reached in load steps.', &
    'load_factor_reached | real | - | load factor | Load at the end of load steps, relative to the full load.', &
    'accepted_steps | integer | - | steps | Accepted steps.', &
    'peak_force | real | force | peak force | Largest contact force of all steps.', &
    'peak_force_at | real | time | time of peak force | Its time; in load steps the fraction of the run, as for all &
      &times below.', &
    'contacts | integer | - | contacts | Number of contacts.', &
    'contact_duration | real | time | time in contact | Total time of contacts, which begin and end at mid-step.', &
    'contact_until | real | time | end of contact | End of the last contact.', &
    'in_contact | logical | - | contact at the end | Whether the last contact continues.', &
    'dent_depth | real | length | dent | Depth of the dent below the surface around it, with the remaining vibration &
      &of the plate.', &
    'dent_indentation | real | length | permanent indentation | Part of dent_depth by the indentation law.', &
    'impactor_displacement | real | length | displacement | Displacement of the impactor at the end, towards the &
      &plate.', &
    'impactor_velocity | real | length/time | velocity at the end | Velocity of the impactor at the end, positive &
      &towards the plate.', &
    'rebound_velocity | real | length/time | rebound velocity | Velocity of the impactor at the end of the last &
      &contact, positive away from the plate; null in contact, or if it does not leave.', &
    'largest_deflection | real | length | largest deflection | Deflection of the struck point, largest in magnitude.', &
    'largest_deflection_at | real | time | time of deflection | Its time.', &
    'kinetic_share | real | - | slow motion | In slow motion: largest kinetic energy over the work of the load since &
      &the end of `settle`, after a quarter of the loading; in a compression up to the strength.', &
    'scaled_kinetic_share | real | - | scaled inertia | With mass_scaling: largest kinetic energy of motions with &
      &scaled inertia, as a fraction of the largest energy.', &
    'energy_impact | real | energy | impact energy | Energy of the impactor at first contact.', &
    'energy_absorbed | real | energy | absorbed energy | Energy that the impactor has lost; null in contact.', &
    'energy_impactor | real | energy | impactor | Kinetic energy of the impactor and its potential in gravity.', &
    'work_external | real | energy | work of the load | Work of pressure and lines, and of the force that moves an &
      &impactor with a travel.', &
    'energy_kinetic | real | energy | kinetic | Energies as in the history, at the end.', &
    'energy_strain | real | energy | strain | Strain energy.', &
    'energy_indentation | real | energy | indentation | Work of the contact force on the indentation.', &
    'energy_delamination | real | energy | delamination | Fracture energy of delaminations.', &
    'energy_ply_damage | real | energy | ply damage | Energy dissipated by the failure of plies.', &
    'energy_contact | real | energy | contact | Energy lost in contact of surfaces.', &
    'energy_friction | real | energy | friction | Heat of sliding.', &
    'energy_layers | real | energy | layers | Energy lost where elements are split into layers.', &
    'energy_damping | real | energy | damping | Kinetic energy removed by settle of &time.', &
    'energy_algorithmic | real | energy | algorithmic dissipation | Algorithmic (numerical) dissipation.', &
    'energy_error | real | energy | energy error | Energy imbalance.', &
    'delaminated_area | real | area | delaminated area | Delaminated area of all interfaces, as in the history.', &
    'projected_area | real | area | projected | Projected delaminated area, by dissipated fractions, as in a C-scan.', &
    'projected_area_failed | real | area | failed | The same of points that have lost 99 % of the stiffness of the &
      &cohesive law.', &
    'projected_area_softened | real | area | softened | The same of points that have lost half of it, with process &
      &zones.', &
    'delaminated_area_before | real | area | before this run | With &initial_state: delaminated area of all interfaces &
      &at the start.', &
    'projected_area_before | real | area | projected before | With &initial_state: projected area at the start, by &
      &dissipated fractions.', &
    'onset_at | real | time | time of onset | Time of the first onset of all interfaces; null if there is none.', &
    'onset_force | real | force | force at onset | Contact force then.', &
    'first_growth_at | real | time | time of first growth | Time of the first growth of all interfaces.', &
    'first_growth_force | real | force | force at first growth | Contact force then.', &
    'threshold_force_at_starter | real | force | threshold force | Closed form with the starter; for a single &
      &interface with a starter.', &
    'fibre_failures | integer | - | fibres | Failed plies, counted in each element: fibres.', &
    'matrix_cracks | integer | - | matrix cracked | Plies with matrix cracks, counted in each element.', &
    'matrix_crushings | integer | - | crushed | Plies crushed, counted in each element.', &
    'matrix_strengthening | real | - | matrix strengthening | With rate_strengthening: factor of YT, YC and S12 at the &
      &onset of matrix cracks, mean over the volume of cracked plies.', &
    'residual_strength | real | pressure | residual strength | Under compression by lines: largest far_field_stress.', &
    'residual_strength_at | real | time | time of strength | Its time.', &
    'shortening_at_strength | real | length | shortening | Shortening then.', &
    'failure_load | real | force | failure load | Load of laminate, doublers and stringers then; only with these or &
      &ply drops.', &
    'skin_stress_at_strength | real | pressure | stress of the laminate | residual_strength times the share of the &
      &laminate in the axial stiffness of the section at the loaded ends, with doublers, ply drops and stringers.', &
    'has_failed | logical | - | failed | Whether the stress has then dropped below 0.7 of the strength; if not, the &
      &strength is a lower bound.', &
    'effective_modulus | real | pressure | effective modulus | Slope between nominal strains of 0.001 and 0.003 (ASTM &
      &D7137); null if these were not reached before the strength.', &
    'percent_bending | real | - | percent bending | 100 times difference over sum of the strains of the first two &
      &gauges at one point, on both faces, at the strength.', &
    'buckling_strain | real | - | buckling strain | Nominal strain at strain reversal of one of these gauges; null if &
      &there is none.']

contains

  !> Its type: real, integer or logical.
  pure function type_of_result(name) result(word)
    character(len=*), intent(in) :: name
    !> The type
    character(len=:), allocatable :: word

    word = cell(summary_table(field_row(summary_table, name)), of_type)
  end function type_of_result

  !> Kind of its unit.
  pure function unit_of_result(name) result(word)
    character(len=*), intent(in) :: name
    !> Such as force
    character(len=:), allocatable :: word

    word = cell(summary_table(field_row(summary_table, name)), of_unit)
  end function unit_of_result

  !> Its label in the log.
  pure function label_of_result(name) result(word)
    character(len=*), intent(in) :: name
    !> Such as peak force
    character(len=:), allocatable :: word

    word = cell(summary_table(field_row(summary_table, name)), of_label)
  end function label_of_result
end module summary_rows
