!> Results for the summary that are computed at the end of a run, in addition to its record.
module run_figures
  use band_energies, only: strengthened_so_far
  use compressed_damage, only: compressed_damage_t, between_supports, damage_of
  use dent_depths, only: dent_depth
  use end_sections, only: skin_share
  use errors, only: error_t, exit_done, exit_stopped
  use failed_plies_areas, only: failed_areas, failed_counts
  use interface_figures, only: figures_of, interface_figures_t
  use kinds, only: wp
  use line_columns, only: pressed_axis
  use models, only: model_t
  use ply_damage_parameters, only: failure_modes
  use projected_areas, only: area_rules, projected_areas_of
  use rank_totals, only: totals_of
  use states, only: state_t
  use setup_scales, only: growth_thresholds
  use threshold_forces, only: patch_factor
  implicit none
  private
  public :: run_figures_t, ending_t, find_figures, ending_of

  !> End of a run.
  type :: ending_t
    !> Exit code of the program
    integer :: code = exit_done
    !> done, stopped or failed
    character(len=7) :: kind = 'done'
    !> Reason of a premature end; empty if complete
    character(len=:), allocatable :: message
  end type ending_t

  !> Results of the state reached, for the full plate.
  type :: run_figures_t
    !> Each interface
    type(interface_figures_t), allocatable :: interfaces(:)
    !> Projected delaminated areas, by what counts as delaminated
    real(wp) :: projected_areas(area_rules) = 0
    !> Depth of the dent, and the permanent indentation in it
    real(wp) :: dent(2) = 0
    !> Plies of elements failed in each mode
    integer :: failures(failure_modes) = 0
    !> Area in which each ply has failed in each mode, (modes, plies)
    real(wp), allocatable :: failed_area(:, :)
    !> Stressed volume of the fibres of each ply at their first failure in tension; 0: they have not failed
    real(wp), allocatable :: stressed_volume(:)
    !> Mean factor of the strengths of cracked matrix by the strain rate; 0: none
    real(wp) :: strengthening = 0
    !> Closed form of the delamination threshold force of each interface, for equal delaminations in all interfaces,
    !> (zones)
    real(wp), allocatable :: threshold(:)
    !> The same for a single interface with a starter under the loaded patch; 0: no or several interfaces
    real(wp) :: starter_threshold = 0
    !> Damage of a plate under compression by lines; unallocated components: none
    type(compressed_damage_t) :: compressed
    !> Length between the supports along that load, and thickness of the plate
    real(wp) :: length = 0, thickness = 0
    !> Width times thickness of the laminate across that load, and its share in the axial stiffness of the section
    real(wp) :: skin_area = 0, skin_share = 1
  end type run_figures_t

contains

  !> Results of the state reached. Collective.
  subroutine find_figures(model, now, figures)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> Its results
    type(run_figures_t), intent(out) :: figures
    real(wp) :: totals(2)
    integer :: zones, along, ply

    figures%interfaces = figures_of(model%plate, now%interfaces)
    figures%projected_areas = projected_areas_of(model%plate, now%interfaces)
    figures%dent = [dent_depth(model%plate, now%motion%displacement), 0.0_wp] + now%impact%indentation%dent
    figures%failures = failed_counts(model%plate, now%plies)
    figures%failed_area = failed_areas(model%plate, now%plies)
    figures%stressed_volume = [(now%plies%stressed_volume(ply), ply=1, model%plate%layup%plies)]
    if (model%plate%setup%has_rates()) then
      associate (bands => now%plies%bands)
        totals = totals_of(model%plate%communicator, strengthened_so_far(bands%states, bands%plies, bands%area))
      end associate
      if (totals(1) > 0) figures%strengthening = totals(2)/totals(1)
    end if
    along = pressed_axis(model)
    if (along > 0) then
      figures%compressed = damage_of(model%plate, now, along)
      figures%length = between_supports(model%plate, along)
      figures%thickness = model%plate%layup%thickness
      figures%skin_area = model%plate%setup%plate%length(3 - along)*model%plate%layup%thickness
      figures%skin_share = skin_share(model%plate%setup, along)
    end if
    zones = size(figures%interfaces)
    figures%threshold = growth_thresholds(model%plate%setup)
    if (zones /= 1) return
    associate (starter => model%plate%setup%delaminations(1)%starter, patch => model%plate%setup%mesh%patch)
      if (starter > 0) figures%starter_threshold = figures%threshold(1)*patch_factor(patch, starter**2)
    end associate
  end subroutine find_figures

  !> End of a run.
  pure function ending_of(error) result(ending)
    !> Reason of a premature end; not allocated: complete
    type(error_t), allocatable, intent(in) :: error
    type(ending_t) :: ending

    ending%message = ''
    if (.not. allocated(error)) return
    ending%code = error%code
    ending%kind = 'failed'
    if (error%code == exit_stopped) ending%kind = 'stopped'
    ending%message = error%message
  end function ending_of
end module run_figures
