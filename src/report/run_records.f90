!> Record of a run for its summary: extremes, contacts, onsets and warnings.
module run_records
  use archives, only: archive_t
  use compressed_damage, only: compressed_damage_t, damage_of
  use compression_records, only: compression_record_t
  use deck_contents, only: deck_t
  use force_filters, only: force_filter_t
  use interface_figures, only: stage_damaged, stage_grown, stage_intact, stages_of
  use kinds, only: wp
  use mapped_figures, only: mapped_figures_t
  use line_columns, only: end_values, line_values, pressed_axis
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use output_clocks, only: shown_time
  use placed_gauges, only: back_to_back, gauge_strains, percent_bending
  use projected_areas, only: area_dissipated, area_rules, projected_areas_of
  use slow_motions, only: slow_motion_t
  use states, only: state_t
  implicit none
  private
  public :: run_record_t, new_run_record

  !> Time of an event before the run.
  real(wp), parameter :: before_run = -1

  !> Record of a run. It has many components because each item of the summary is one.
  type :: run_record_t
    !> Largest contact force and its time
    real(wp) :: peak_force = 0, peak_time = 0
    !> Low-pass filter of the force
    type(force_filter_t) :: filter
    !> Largest filtered force, and its time
    real(wp) :: peak_filtered = 0, peak_filtered_time = 0
    !> Largest deflection of the struck point in magnitude, with its sign, and its time
    real(wp) :: deflection = 0, deflection_time = 0
    !> Number of contacts
    integer :: contacts = 0
    !> Total duration of contacts, and end of the last one so far
    real(wp) :: contact_duration = 0, contact_end = 0
    !> Velocity of the impactor at the end of the last contact, positive away from the plate
    real(wp) :: rebound = 0
    !> Time and force of the last observed step
    real(wp) :: time = 0, force = 0
    !> Stage of failure of each interface, (zones)
    integer, allocatable :: stage(:)
    !> Time, contact force and deflection at the onset and at the first growth of each interface, (3, zones); time 0: it
    !> has not occurred, negative: before the run
    real(wp), allocatable :: onset(:, :), growth(:, :)
    !> Record of a compression by lines
    type(compression_record_t) :: compression
    !> Damage before the compression
    type(compressed_damage_t) :: before
    !> Delaminated area of all interfaces, and projected, before a run that starts from another one
    real(wp) :: area_before(2) = 0
    !> Quantities before and after mapping to this mesh
    type(mapped_figures_t) :: mapping
    !> Largest kinetic energy of motions with scaled inertia, and largest energy of the run
    real(wp) :: scaled_energy = 0, energy = 0
    !> Kinetic energy over the work of a slow motion
    type(slow_motion_t) :: slow_motion
    !> Warnings given: kinds, and zones or 0
    integer, allocatable :: warning_kinds(:), warning_zones(:)
    !> Their times
    real(wp), allocatable :: warning_times(:)
  contains
    procedure :: inherit
    procedure :: observe
    procedure :: has_rebounded
    procedure, nopass :: earliest
    procedure :: observe_reactions
    !> Updates kinetic energies.
    procedure :: note_motion
    procedure :: scaled_share
    procedure :: note_warning
    procedure :: has_warned
    procedure :: visit
  end type run_record_t

contains

  !> The record at the start of a run.
  pure function new_run_record(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(run_record_t) :: self
    integer :: zones

    zones = size(plate%mesh%zones)
    allocate (self%stage(zones), source=stage_intact)
    allocate (self%onset(3, zones), self%growth(3, zones), source=0.0_wp)
    allocate (self%warning_kinds(0), self%warning_zones(0), self%warning_times(0))
  end function new_run_record

  !> Stores the delaminated area before the run, and which interfaces had failed: their onset and first growth are not
  !> those of this run.
  !> Collective.
  subroutine inherit(self, plate, now)
    class(run_record_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The state inherited from another run
    type(state_t), intent(in) :: now
    real(wp) :: projected(area_rules)

    self%stage = stages_of(plate, now%interfaces)
    where (self%stage >= stage_damaged) self%onset(1, :) = before_run
    where (self%stage >= stage_grown) self%growth(1, :) = before_run
    if (size(self%stage) == 0) return
    projected = projected_areas_of(plate, now%interfaces)
    self%area_before = [sum(now%interfaces%cohesive%area(plate)), projected(area_dissipated)]
  end subroutine inherit

  !> Updates the record with an accepted step. Collective.
  subroutine observe(self, plate, now, between_stages)
    class(run_record_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Steps between two checks of the interfaces
    integer, intent(in) :: between_stages
    integer :: stages(size(self%stage)), zone

    if (now%impact%force > self%peak_force) then
      self%peak_force = now%impact%force
      self%peak_time = now%time
    end if
    call self%filter%advance(now%time - self%time, now%impact%force)
    if (self%filter%force > self%peak_filtered) then
      self%peak_filtered = self%filter%force
      self%peak_filtered_time = now%time
    end if
    if (abs(now%impact%deflection) > abs(self%deflection)) then
      self%deflection = now%impact%deflection
      self%deflection_time = now%time
    end if
    call count_contacts(self, now%time, now%impact%force)
    ! Since then the impactor flies freely under gravity; a multistep integrator needs some steps for it.
    if (self%contacts > 0 .and. .not. now%impact%force > 0) self%rebound = &
      plate%setup%impactor%gravity*(now%time - self%contact_end) - now%impact%impactor%velocity
    self%time = now%time
    self%force = now%impact%force
    if (all(self%stage == stage_grown) .or. modulo(now%step, between_stages) > 0) return
    stages = stages_of(plate, now%interfaces)
    do zone = 1, size(stages)
      if (self%stage(zone) < stage_damaged .and. stages(zone) >= stage_damaged) self%onset(:, zone) = figures_at(now)
      if (self%stage(zone) < stage_grown .and. stages(zone) >= stage_grown) self%growth(:, zone) = figures_at(now)
    end do
    self%stage = max(self%stage, stages)
  end subroutine observe

  !> Updates the record with a complete state: with reactions, which central differences compute at intervals.
  !> Collective.
  subroutine observe_reactions(self, model, now)
    class(run_record_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    real(wp), allocatable :: ends(:), strains(:)
    real(wp) :: bending

    if (size(model%loads%lines) == 0) return
    ends = end_values(model, line_values(model, now))
    if (size(ends) == 0) return
    if (.not. allocated(self%before%plies)) self%before = damage_of(model%plate, now, pressed_axis(model))
    strains = gauge_strains(model%plate, now%motion%displacement)
    bending = 0
    if (all(back_to_back(model%plate%setup%plate%gauges) > 0)) &
      bending = percent_bending(strains(back_to_back(model%plate%setup%plate%gauges)))
    call self%compression%observe(now%time, ends(1), ends(2), ends(3), bending)
    if (all(back_to_back(model%plate%setup%plate%gauges) > 0)) &
      call self%compression%observe_gauges(strains(back_to_back(model%plate%setup%plate%gauges)))
  end subroutine observe_reactions

  !> Time, contact force and deflection of a state.
  pure function figures_at(now)
    type(state_t), intent(in) :: now
    !> The three values
    real(wp) :: figures_at(3)

    figures_at = [shown_time(now%time), now%impact%force, now%impact%deflection]
  end function figures_at

  !> True once the impactor has left the plate, away from it.
  pure logical function has_rebounded(self)
    class(run_record_t), intent(in) :: self

    has_rebounded = self%contacts > 0 .and. .not. self%force > 0 .and. self%rebound > 0
  end function has_rebounded

  !> The earliest of the events of all interfaces.
  pure function earliest(events) result(event)
    !> Time, contact force and deflection, (3, zones); time 0: never, negative: before the run
    real(wp), intent(in) :: events(:, :)
    !> The same of the first one in the run; 0: none
    real(wp) :: event(3)

    event = 0
    if (any(events(1, :) > 0)) event = events(:, minloc(events(1, :), dim=1, mask=events(1, :) > 0))
  end function earliest

  !> Counts contacts and their duration. A contact starts or ends at mid-step; one at the start of the run starts with
  !> it.
  pure subroutine count_contacts(self, time, force)
    !> The record of the previous step
    type(run_record_t), intent(inout) :: self
    !> Time and contact force at the end of the step
    real(wp), intent(in) :: time, force
    real(wp) :: from, to

    if (.not. (self%force > 0 .or. force > 0)) return
    from = self%time
    to = time
    if (.not. self%force > 0) then
      self%contacts = self%contacts + 1
      if (self%time > 0) from = (self%time + time)/2
    end if
    if (.not. force > 0) to = (self%time + time)/2
    self%contact_duration = self%contact_duration + (to - from)
    self%contact_end = to
  end subroutine count_contacts

  !> Updates the energy of motions with scaled inertia, and that of a slow motion. In a compression they count up to the
  !> strength: the collapse of the plate is dynamic in a test, too.
  pure subroutine note_motion(self, deck, now)
    class(run_record_t), intent(inout) :: self
    type(deck_t), intent(in) :: deck
    !> A complete state, the last observed
    type(state_t), intent(in) :: now
    logical :: counts

    counts = .not. self%compression%strength > 0 .or. self%compression%at >= shown_time(now%time)
    call self%slow_motion%observe(deck, now%time, now%ledger, counts)
    if (counts) self%scaled_energy = max(self%scaled_energy, now%ledger%scaled)
    self%energy = now%ledger%largest
  end subroutine note_motion

  !> Largest fraction of the energy in motions with scaled inertia.
  pure real(wp) function scaled_share(self) result(share)
    class(run_record_t), intent(in) :: self

    share = 0
    if (self%energy > 0) share = self%scaled_energy/self%energy
  end function scaled_share

  !> Stores a warning.
  pure subroutine note_warning(self, kind, zone, time)
    class(run_record_t), intent(inout) :: self
    !> Number of its row
    integer, intent(in) :: kind
    !> Its zone; 0: none
    integer, intent(in) :: zone
    !> Its time
    real(wp), intent(in) :: time

    self%warning_kinds = [self%warning_kinds, kind]
    self%warning_zones = [self%warning_zones, zone]
    self%warning_times = [self%warning_times, shown_time(time)]
  end subroutine note_warning

  !> True if a warning was given before.
  pure logical function has_warned(self, kind, zone)
    class(run_record_t), intent(in) :: self
    !> Number of its row
    integer, intent(in) :: kind
    !> Its zone; 0: none
    integer, intent(in) :: zone

    has_warned = any(self%warning_kinds == kind .and. self%warning_zones == zone)
  end function has_warned

  !> Saves or loads the record.
  subroutine visit(self, archive)
    class(run_record_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('record/peak_force', self%peak_force)
    call archive%item('record/peak_time', self%peak_time)
    call self%filter%visit(archive)
    call archive%item('record/peak_filtered', self%peak_filtered)
    call archive%item('record/peak_filtered_time', self%peak_filtered_time)
    call archive%item('record/deflection', self%deflection)
    call archive%item('record/deflection_time', self%deflection_time)
    call archive%item('record/contacts', self%contacts)
    call archive%item('record/contact_duration', self%contact_duration)
    call archive%item('record/contact_end', self%contact_end)
    call archive%item('record/rebound', self%rebound)
    call archive%item('record/time', self%time)
    call archive%item('record/force', self%force)
    call archive%item('record/stage', self%stage)
    call self%compression%visit(archive)
    call self%before%visit('record/before', archive)
    call archive%item('record/delaminated_area_before', self%area_before(1))
    call archive%item('record/projected_area_before', self%area_before(2))
    call self%mapping%visit(archive)
    call archive%item('record/onset', self%onset)
    call archive%item('record/growth', self%growth)
    call archive%item('record/scaled_energy', self%scaled_energy)
    call archive%item('record/energy', self%energy)
    call self%slow_motion%visit(archive)
    call archive%item('record/warning_kinds', self%warning_kinds)
    call archive%item('record/warning_zones', self%warning_zones)
    call archive%item('record/warning_times', self%warning_times)
  end subroutine visit
end module run_records
