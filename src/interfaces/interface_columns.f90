!> Columns of the history for the interfaces. A new column is added to the end of the border's rows, with its value in
!> the function next to them: the columns before it keep their positions. Columns per interface are in the last rows.
module interface_columns
  use kinds, only: wp
  use interface_figures, only: figures_of, interface_figures_t
  use interface_states, only: interface_state_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use motions, only: motion_t
  use projected_areas, only: projected_areas_of
  use result_tables, only: result_row_length
  implicit none
  private
  public :: area_values, release_values, border_values, rig_values, interface_values

  !> Delaminated area: a column of the public interface.
  character(len=result_row_length), parameter, public :: area_rows(*) = [character(len=result_row_length) :: &
    'delaminated_area | real | area | Delaminated area of all interfaces together, their starters included; &
      &with a cohesive law the area dissipated.']

  !> Ratio of energy release rate to its critical value, released energy, penetration and complementarity of surfaces.
  character(len=result_row_length), parameter, public :: release_rows(*) = [character(len=result_row_length) :: &
    'release_ratio | real | - | Largest energy release rate on all fronts over its critical value; in a static &
      &analysis fronts do not grow.', &
    'energy_released | real | energy | Work done against the decreasing forces of released ties so far; 0 if all &
      &interfaces have growth = ''one_per_step''.', &
    'penetration | real | length | Largest penetration of separated surfaces, with a cohesive law also of &
      &intact ones.', &
    'complementarity | real | - | Largest contact pressure at an open gap, or of a penetration, over the largest &
      &pressure so far.']

  !> Fronts at the border of their zone.
  character(len=result_row_length), parameter, public :: border_rows(*) = [character(len=result_row_length) :: &
    'border_reached | logical | - | 1 once a front or damage has reached the border of its zone, beyond which it &
      &cannot grow; else 0.', &
    'projected_area | real | area | Delaminated area in projection, as in a C-scan: interfaces above each other &
      &count once, with the largest delaminated fraction.', &
    'projected_area_failed | real | area | The same of points whose cohesive law has lost 99 % of its stiffness.', &
    'projected_area_softened | real | area | The same of points that have lost half of it, with the process zones.']

  !> Columns per interface: N is its ply.
  character(len=result_row_length), parameter, public :: interface_rows(*) = [character(len=result_row_length) :: &
    'stage_below_N | integer | - | The interface below ply N, starter left out: 0 intact, 1 a cohesive law has begun &
      &to soften, 2 grown.', &
    'area_below_N | real | area | Delaminated area of the interface below ply N, its starter included; with a cohesive &
      &law the area dissipated.', &
    'energy_below_N | real | energy | Fracture energy of the interface below ply N.', &
    'extent_x_below_N | real | length | Extent along x of the delamination below ply N, starter included: cells, &
      &or nodes where a cohesive law has failed.', &
    'extent_y_below_N | real | length | The same along y.', &
    'layered_below_N | real | area | Area of the zone of layers at the interface below ply N.']
  !> Forces of the rigs.
  character(len=result_row_length), parameter, public :: rig_rows(*) = [character(len=result_row_length) :: &
    'reaction_1 | real | force | Force of the first &support on the plate, frame and clamps together, positive against &
      &the impact; 0 if there is none.', &
    'reaction_2 | real | force | Force of the second &support, likewise.', &
    'reaction_3 | real | force | Force of the third &support, likewise.']

contains

  !> Delaminated area. Collective.
  function area_values(plate, interfaces) result(values)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> One value per column, of the full plate
    real(wp) :: values(size(area_rows))

    values = [sum(interfaces%contact%area(plate)) + sum(interfaces%cohesive%area(plate))]
  end function area_values

  !> Ratio of energy release rate to its critical value, released energy, penetration and complementarity of surfaces.
  !> Collective.
  function release_values(plate, interfaces, displacement) result(values)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    real(wp), intent(in) :: displacement(:, :)
    !> One value per column, the same on every rank
    real(wp) :: values(size(release_rows))

    values = [interfaces%release_ratio, sum(interfaces%ties%set_free), &
              interfaces%contact%penetration(plate, displacement), &
              interfaces%contact%complementarity(plate, displacement)]
  end function release_values

  !> Zones whose border is reached, and projected areas. Collective.
  function border_values(plate, interfaces) result(values)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> One value per column
    real(wp) :: values(size(border_rows))

    values = [merge(1.0_wp, 0.0_wp, any(interfaces%border_reached)), projected_areas_of(plate, interfaces)]
  end function border_values

  !> Forces of the rigs. Collective.
  function rig_values(model, interfaces, motion, loads) result(values)
    type(model_t), intent(in) :: model
    type(interface_state_t), intent(in) :: interfaces
    type(motion_t), intent(in) :: motion
    !> Forces of pressure and lines at the owned points, (5, points)
    real(wp), intent(in) :: loads(:, :)
    !> One value per column
    real(wp) :: values(size(rig_rows))

    values = interfaces%rig%reactions(model, motion%displacement, motion%internal, motion%inertia, loads)
  end function rig_values

  !> Quantities of each interface, one interface after the other. Collective.
  function interface_values(plate, interfaces) result(values)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> One value per column and interface
    real(wp) :: values(size(interface_rows)*size(plate%mesh%zones))
    type(interface_figures_t) :: figures(size(plate%mesh%zones))
    integer :: zone

    figures = figures_of(plate, interfaces)
    do zone = 1, size(figures)
      associate (of => figures(zone), first => (zone - 1)*size(interface_rows))
        values(first + 1:first + size(interface_rows)) = &
          [real(of%stage, wp), of%area, of%energy, of%bounds(2, :) - of%bounds(1, :), &
           plate%mesh%zone_area(zone)*plate%mesh%multiplicity]
      end associate
    end do
  end function interface_values
end module interface_columns
