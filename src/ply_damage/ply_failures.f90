!> Failure of plies: reduction of the stiffness of elements, and energy dissipated.
module ply_failures
  use free_strains, only: free_resultants
  use internal_forces, only: add_internal_force
  use kinds, only: wp
  use archives, only: archive_t
  use band_energies, only: dissipated_in_trial, dissipated_so_far
  use bimodular_sections, only: bimodular_sections_t, new_bimodular_sections
  use crack_band_sections, only: crack_band_sections_t, new_crack_band_sections
  use element_batches, only: batch_of, lane_of
  use plies, only: elasticity_t, ply_t
  use ply_damage_parameters, only: energy_modes, failure_modes
  use stacking, only: in_plane_section
  use section_stiffnesses, only: visit_stiffness
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use rank_totals, only: totals_of
  use failed_modes, only: failed_modes_t, new_failed_modes
  use text, only: to_text
  implicit none
  private
  public :: ply_failure_t, new_ply_failure

  !> Tolerance of the energy error of softening plies in a step, relative to the energy they dissipate in it and to the
  !> total energy, theory (T4). The spurious energy of a step past a failure would cause further failures. With half or
  !> twice these values implicit steps have other lengths, and other plies fail (doc/studies/solution_controls.md).
  real(wp), parameter :: path_tolerance = 0.1_wp, energy_tolerance = 3.0e-4_wp

  !> Failures of the plies of this rank's elements.
  type :: ply_failure_t
    !> Failed modes, where failure is sudden
    type(failed_modes_t) :: modes
    !> Softening plies; unallocated: failure is sudden
    type(crack_band_sections_t), allocatable :: bands
    !> Sections of plies with E1c without softening; unallocated: there are none
    type(bimodular_sections_t), allocatable :: signs
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Resultants of stress-free strains with this stiffness, (lanes, 7, batches); unallocated: there are none
    real(wp), allocatable :: free(:, :, :)
    !> Changes of the sections against mean strains, (lanes, change_values, batches); unallocated: there are none
    real(wp), allocatable :: mean_change(:, :, :)
    !> True if failures have reduced the stiffness after the last step
    logical :: softened = .false.
    !> Energy dissipated in each mode by softening plies, of the full plate
    real(wp) :: dissipated(energy_modes) = 0
    !> Energy dissipated by their permanent shear strains
    real(wp) :: permanent_shear = 0
    !> Lag of damage: energy error of the last step relative to its limit, theory (T4)
    real(wp) :: damage_lag = 0
    !> True while softening plies keep their stiffness, during the transfer of a state to other layers
    logical :: keeps_stiffness = .false.
  contains
    procedure :: note_step
    procedure :: find_forces
    procedure :: add_layer_forces
    procedure :: record
    procedure :: measure_lag
    procedure :: total_dissipation
    procedure :: stressed_volume
    procedure :: carried_by_cracks
    procedure :: failed
    procedure :: failed_in_elements
    procedure :: elasticity
    procedure :: elasticities
    procedure :: grow
    procedure :: restack
    procedure :: visit
  end type ply_failure_t

contains

  !> No failure. Collective.
  function new_ply_failure(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(ply_failure_t) :: self

    self%stiffness = plate%elements%stiffness
    if (allocated(plate%layup%free)) self%free = plate%layup%free
    if (plate%setup%has_crack_bands()) then
      self%bands = new_crack_band_sections(plate)
      if (allocated(self%bands%free)) self%free = self%bands%free
      if (allocated(self%bands%signs)) self%mean_change = self%bands%signs%change
    else
      self%modes = new_failed_modes(plate)
      if (.not. plate%setup%is_bimodular()) return
      self%signs = new_bimodular_sections(plate)
      self%free = self%signs%free
      self%mean_change = self%signs%signs%change
    end if
  end function new_ply_failure

  !> Notes the length of a step, by which strain rates are found.
  pure subroutine note_step(self, step)
    class(ply_failure_t), intent(inout) :: self
    !> Its length; 0: not in time
    real(wp), intent(in) :: step

    if (.not. allocated(self%bands)) return
    if (allocated(self%bands%rates)) self%bands%rates%step = step
  end subroutine note_step

  !> Internal forces of the plate, with the stiffness reduced by softening under this displacement.
  subroutine find_forces(self, model, displacement, force, energy)
    !> The failures; store the trial state
    class(ply_failure_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Displacement, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: displacement(:, :)
    !> Internal forces, (5, points); ghosts zero
    real(wp), contiguous, intent(inout) :: force(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy

    if (allocated(self%bands) .and. (allocated(self%mean_change) .or. .not. self%keeps_stiffness)) then
      self%bands%keeps_damage = self%keeps_stiffness
      ! Unallocated resultants are passed on as an absent argument.
      call model%internal(self%stiffness, displacement, force, energy, self%bands, free=self%free)
      self%bands%keeps_damage = .false.
      self%stiffness = self%bands%stiffness
      if (allocated(self%free)) self%free = self%bands%free
      if (allocated(self%mean_change)) self%mean_change = self%bands%signs%change
    else if (allocated(self%signs)) then
      call model%internal(self%stiffness, displacement, force, energy, self%signs, free=self%free)
      self%free = self%signs%free
      self%mean_change = self%signs%signs%change
    else
      call model%internal(self%stiffness, displacement, force, energy, free=self%free)
    end if
  end subroutine find_forces

  !> Adds the forces of the elements on the layers; history variables of softening plies are accepted. Collective.
  subroutine add_layer_forces(self, plate, motion, force, energies)
    class(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Motion of the layers, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: motion(:, :)
    !> Internal forces on the layers, (5, columns of the borders), added to
    real(wp), contiguous, intent(inout) :: force(:, :)
    !> Strain energy of each element, (lanes, batches)
    real(wp), contiguous, intent(out) :: energies(:, :)
    real(wp) :: energy

    if (allocated(self%bands) .and. (allocated(self%mean_change) .or. .not. self%keeps_stiffness)) then
      self%bands%keeps_damage = self%keeps_stiffness
      ! Before the forces: a restart computes the last forces again, with the strengths that they had.
      if (.not. self%keeps_stiffness) call self%bands%update_strengths(plate)
      call add_internal_force(plate%elements, self%stiffness, plate%setup%mesh%kinematics, motion, force, energy, &
                              self%bands, self%free, energies)
      if (.not. self%keeps_stiffness) call self%bands%commit_sections(self%stiffness, self%free)
      self%bands%keeps_damage = .false.
    else if (allocated(self%signs)) then
      call add_internal_force(plate%elements, self%stiffness, plate%setup%mesh%kinematics, motion, force, energy, &
                              self%signs, self%free, energies)
    else
      call add_internal_force(plate%elements, self%stiffness, plate%setup%mesh%kinematics, motion, force, energy, &
                              free=self%free, energies=energies)
    end if
  end subroutine add_layer_forces

  !> Records the energy dissipated by softening in a step. Collective.
  subroutine record(self, plate, energy)
    !> The failures with the trial of the step
    class(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Energy of all modes, of the full plate, the same on every rank
    real(wp), intent(out) :: energy
    real(wp) :: energies(energy_modes)

    energy = 0
    if (.not. allocated(self%bands)) return
    associate (b => self%bands)
      energies = totals_of(plate%communicator, dissipated_in_trial(b%states, b%plies, b%area, b%touched))
    end associate
    energies = energies*plate%mesh%multiplicity
    self%dissipated = self%dissipated + energies
    energy = sum(energies)
  end subroutine record

  !> Computes the energy dissipated by softening plies so far in each mode. Collective.
  subroutine total_dissipation(self, plate)
    class(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp) :: energies(energy_modes + 1)

    associate (b => self%bands)
      energies = totals_of(plate%communicator, dissipated_so_far(b%states, b%plies, b%bands, b%area, b%touched))
    end associate
    energies = energies*plate%mesh%multiplicity
    self%dissipated = energies(:energy_modes)
    self%permanent_shear = energies(energy_modes + 1)
  end subroutine total_dissipation

  !> Measures the lag of damage: the difference of the work on softening plies and the energy they store and dissipate,
  !> theory (T4). A step past an instability reaches a state without the work along the path.
  pure subroutine measure_lag(self, dissipated, stored, energy)
    class(ply_failure_t), intent(inout) :: self
    !> Energy dissipated by plies in the step
    real(wp), intent(in) :: dissipated
    !> Change of their stored energy minus the work on them
    real(wp), intent(in) :: stored
    !> Total energy of the run so far
    real(wp), intent(in) :: energy

    self%damage_lag = 0
    if (allocated(self%bands)) &
      self%damage_lag = abs(stored + dissipated)/max(path_tolerance*dissipated, energy_tolerance*energy, &
                                                     tiny(energy)**0.5_wp)
  end subroutine measure_lag

  !> Failed modes of a ply of an element.
  pure function failed(self, ply, element)
    class(ply_failure_t), intent(in) :: self
    !> Ply of the laminate, and element of this rank that has it
    integer, intent(in) :: ply, element
    !> True for failed modes
    logical :: failed(failure_modes)

    if (allocated(self%bands)) then
      failed = self%bands%touched(element)
      if (failed(1)) failed = self%bands%states%failed_modes(ply, element)
    else
      failed = self%modes%failed(ply, element)
    end if
  end function failed

  !> Failed modes of a ply in all elements.
  pure function failed_in_elements(self, plate, ply) result(failed)
    class(ply_failure_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: ply
    !> True for failed modes, (modes, elements); false in elements without this ply
    logical :: failed(failure_modes, plate%elements%elements)
    integer :: element

    failed = .false.
    do element = 1, size(failed, 2)
      if (plate%layup%stacks(plate%layup%stack(element))%has(ply)) failed(:, element) = self%failed(ply, element)
    end do
  end function failed_in_elements

  !> Reduced elastic constants of a ply of an element.
  pure function elasticity(self, plate, ply, element)
    class(ply_failure_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Ply of the laminate, and element of this rank
    integer, intent(in) :: ply, element
    type(elasticity_t) :: elasticity

    if (allocated(self%bands)) then
      elasticity = self%bands%elasticity(ply, element)
    else
      elasticity = self%modes%elasticity(plate, ply, element)
    end if
  end function elasticity

  !> Stressed volume of the fibres of a ply at their first failure in tension; 0: they have not failed, or their
  !> strength does not depend on it.
  pure real(wp) function stressed_volume(self, ply) result(volume)
    class(ply_failure_t), intent(in) :: self
    integer, intent(in) :: ply

    volume = 0
    if (.not. allocated(self%bands)) return
    if (allocated(self%bands%volumes)) volume = self%bands%volumes%volume_at_failure(ply)
  end function stressed_volume

  !> Stresses along and across the fibres that closed cracks of a ply of an element carry, uniform over its volume.
  pure function carried_by_cracks(self, ply, element) result(stresses)
    class(ply_failure_t), intent(in) :: self
    !> Ply of the laminate, and element of this rank
    integer, intent(in) :: ply, element
    !> Negative in compression
    real(wp) :: stresses(2)

    stresses = 0
    if (allocated(self%bands)) stresses = self%bands%states%trial(self%bands%states%at(ply, element))%recovered(:2)
  end function carried_by_cracks

  !> Reduced elastic constants of the plies of an element.
  pure function elasticities(self, plate, element)
    class(ply_failure_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: element
    !> Those of the element's plies
    type(elasticity_t), allocatable :: elasticities(:)
    integer :: i

    associate (plies => plate%layup%stacks(plate%layup%stack(element))%number)
      elasticities = [(self%elasticity(plate, plies(i), element), i=1, size(plies))]
    end associate
  end function elasticities

  !> Finds new failures in an accepted state and reduces the stiffness. Collective.
  subroutine grow(self, plate, displacement)
    class(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    logical, allocatable :: failing(:)
    integer :: element

    if (allocated(self%bands)) then
      call self%bands%commit()
      call self%bands%update_strengths(plate)
      return
    end if
    if (.not. plate%setup%ply_damage%is_present) return
    call self%modes%find(plate, self%stiffness, displacement, failing)
    self%softened = plate%communicator%any(any(failing))
    if (.not. self%softened) return
    do element = 1, size(failing)
      if (failing(element)) call soften(self, plate, element)
    end do
  end subroutine grow

  !> Computes the reduced stiffness of an element.
  subroutine soften(self, plate, element)
    type(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: element

    associate (stack => plate%layup%stacks(plate%layup%stack(element)))
      self%stiffness(lane_of(element), :, batch_of(element)) = stack%stiffness(self%modes%elasticities(plate, element))
      if (allocated(self%free)) self%free(lane_of(element), :, batch_of(element)) = &
        free_resultants(stack%plies, self%elasticities(plate, element))
      if (allocated(self%signs)) call self%signs%reduce(element, self%elasticities(plate, element), &
                                                        self%free(lane_of(element), :, batch_of(element)))
    end associate
  end subroutine soften

  !> Computes the reduced stiffness of elements that were split into layers, from their plies.
  subroutine restack(self, plate, is_split)
    !> The failures, loaded from elements with more plies
    class(ply_failure_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> True for these elements, (elements)
    logical, intent(in) :: is_split(:)
    integer :: element

    if (.not. plate%setup%ply_damage%is_present) return
    do element = 1, size(is_split)
      if (.not. is_split(element)) cycle
      associate (stack => plate%layup%stacks(plate%layup%stack(element)), &
                 left => self%stiffness(lane_of(element), :, batch_of(element)))
        left = plate%elements%stiffness(lane_of(element), :, batch_of(element))
        if (allocated(self%bands)) then
          ! Softening does not reduce the transverse shear stiffness.
          left(:18) = in_plane_section(stack%plies, self%elasticities(plate, element))
        else
          call soften(self, plate, element)
        end if
      end associate
    end do
  end subroutine restack

  !> Saves or loads the failures.
  subroutine visit(self, archive, plate)
    class(ply_failure_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    type(ply_t), allocatable :: plies(:)
    integer :: mode, element, i

    call self%modes%visit(archive, plate)
    if (allocated(self%bands)) then
      call self%bands%visit(archive, plate)
      do mode = 1, energy_modes
        call archive%item('ply_failure/dissipated_'//to_text(mode), self%dissipated(mode))
      end do
      if (plate%setup%ply_damage%permanent_shear) &
        call archive%item('ply_failure/dissipated_by_shear', self%permanent_shear)
    end if
    if (plate%setup%ply_damage%is_present) call visit_stiffness(archive, 'ply_failure/stiffness', plate, self%stiffness)
    if (.not. (archive%loading .and. allocated(self%free) .and. plate%setup%ply_damage%is_present)) return
    do element = 1, plate%elements%elements
      associate (stack => plate%layup%stacks(plate%layup%stack(element)))
        plies = stack%plies
        if (allocated(self%bands)) plies%free_strain(3) = &
          [(self%bands%states%trial(self%bands%states%at(stack%number(i), element))%permanent, i=1, size(plies))]
        self%free(lane_of(element), :, batch_of(element)) = free_resultants(plies, self%elasticities(plate, element))
        if (.not. allocated(self%signs)) cycle
        if (any([(self%modes%failed(stack%number(i), element), i=1, size(plies))])) &
          call self%signs%reduce(element, self%elasticities(plate, element), &
                                 self%free(lane_of(element), :, batch_of(element)))
      end associate
    end do
  end subroutine visit
end module ply_failures
