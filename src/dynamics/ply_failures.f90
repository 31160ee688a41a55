!> Failure of plies, element by element: criteria from the stresses averaged over an element's nine
!> points (section 3.2 of the paper), permanent loss of stiffness, and the energy lost with it.
module ply_failures
  use kinds, only: wp
  use archives, only: archive_t
  use element_batches, only: lanes, first_element
  use strain_recovery, only: mean_strains
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes, stress_at_faces
  use ply_stresses, only: middle_stress, face_stresses, mean_shear_strain
  use failure_criteria, only: failure_indices, largest_failure_indices
  use degradation, only: degraded
  use stacking, only: section_stiffness
  use states, only: state_t
  use models, only: model_t
  implicit none
  private
  public :: ply_failure_t, new_ply_failure, strains_of_plies

  !> Failed modes of every ply of this rank's elements.
  type :: ply_failure_t
    !> True where a mode has occurred, (modes, plies, elements); unallocated: not modelled
    logical, allocatable :: failed(:, :, :)
    !> The same when the operator was last factored, which a restart must make again
    logical, allocatable :: failed_when_factored(:, :, :)
  contains
    !> Finds new failures in an accepted state and takes their stiffness away.
    procedure :: grow
    !> Gives all elements the stiffness that failures have left.
    procedure :: apply
    !> Elastic constants left in a ply of an element, and in all its plies.
    procedure :: elasticity
    procedure :: elasticities
    !> Number of ply elements failed in each mode, of the whole plate.
    procedure :: counts
    !> Saves or loads.
    procedure :: visit
  end type ply_failure_t

contains

  !> No failure.
  pure function new_ply_failure(model) result(self)
    !> The model
    type(model_t), intent(in) :: model
    !> The failures
    type(ply_failure_t) :: self

    if (.not. model%scene%has_ply_damage) return
    allocate (self%failed(failure_modes, size(model%plies), model%elements%elements), source=.false.)
    self%failed_when_factored = self%failed
  end function new_ply_failure

  !> Finds new failures in an accepted state, takes their stiffness away and books the energy lost.
  subroutine grow(self, model, state)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    !> The model, whose failed elements lose stiffness
    type(model_t), intent(inout) :: model
    !> The state
    type(state_t), intent(inout) :: state
    real(wp) :: strains(lanes, 8), energy
    real(wp), allocatable :: motion(:, :)
    logical :: any_new, new
    integer :: b, lane

    if (.not. allocated(self%failed)) return
    any_new = .false.
    motion = model%motion_of(state%motion%displacement)
    do b = 1, model%elements%batches
      call mean_strains(model%elements, b, model%scene%kinematics, motion, strains)
      do lane = 1, model%elements%lanes_used(b)
        call fail_element(self, model, first_element(b) + lane - 1, strains(lane, :), new)
        any_new = any_new .or. new
      end do
    end do
    if (.not. model%communicator%any(any_new)) return
    call model%internal(state%motion%displacement, state%motion%internal, energy)
    call model%communicator%sum(energy)
    energy = energy*model%mesh%multiplicity
    state%ledger%ply_damage = state%ledger%ply_damage + state%ledger%strain - energy
    state%ledger%strain = energy
  end subroutine grow

  !> Fails the plies of one element whose criteria are met.
  subroutine fail_element(self, model, element, strains, new)
    !> The failures
    type(ply_failure_t), intent(inout) :: self
    !> The model
    type(model_t), intent(inout) :: model
    !> Element of this rank
    integer, intent(in) :: element
    !> Mean strains of the element
    real(wp), intent(in) :: strains(8)
    !> True if a ply failed anew
    logical, intent(out) :: new
    type(elasticity_t), allocatable :: elasticity(:)
    real(wp) :: local(8)
    logical :: modes(failure_modes)
    integer :: ply, first

    first = model%mesh%element_plies(1, model%distribution%elements(element))
    elasticity = self%elasticities(model, element)
    local = strains_of_plies(model, element, elasticity, strains)
    new = .false.
    associate (plies => model%plies(first:first + size(elasticity) - 1))
      do ply = 1, size(elasticity)
        if (all(self%failed(:, first + ply - 1, element))) cycle
        modes = failing(model, plies(ply)%material, ply, elasticity(ply), local)
        if (.not. any(modes .and. .not. self%failed(:, first + ply - 1, element))) cycle
        self%failed(:, first + ply - 1, element) = self%failed(:, first + ply - 1, element) .or. modes
        new = .true.
      end do
    end associate
    if (new) call soften(self, model, element)

  contains

    !> Modes whose criterion a ply meets.
    function failing(model, material, ply, constants, strains) result(modes)
      !> The model
      type(model_t), intent(in) :: model
      !> Index of the ply's material
      integer, intent(in) :: material
      !> Ply of the element
      integer, intent(in) :: ply
      !> Its present constants
      type(elasticity_t), intent(in) :: constants
      !> Strains
      real(wp), intent(in) :: strains(8)
      !> True where the criterion is met
      logical :: modes(failure_modes)

      associate (strength => model%scene%materials(material), place => model%plies(first + ply - 1))
        if (model%scene%ply_damage%stress == stress_at_faces) then
          modes = largest_failure_indices(strength, face_stresses(place, constants, strains)) >= 1
        else
          modes = failure_indices(strength, middle_stress(place, constants, strains)) >= 1
        end if
      end associate
    end function failing
  end subroutine fail_element

  !> Strains of an element that the stresses of its plies follow from: its own, but for one transverse shear strain
  !> whose stresses add up to the shear force.
  pure function strains_of_plies(model, element, elasticity, strains) result(local)
    !> The model
    type(model_t), intent(in) :: model
    !> Element of this rank
    integer, intent(in) :: element
    !> Present elastic constants of its plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Mean strains of the element
    real(wp), intent(in) :: strains(8)
    !> Strains for ply_stress
    real(wp) :: local(8)

    local = strains
    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)), &
               b => 1 + (element - 1)/lanes, lane => 1 + modulo(element - 1, lanes))
      local(7:8) = mean_shear_strain(model%plies(range(1):range(2)), elasticity, &
                                     model%elements%stiffness(lane, :, b), strains(7:8))
    end associate
  end function strains_of_plies

  !> Elastic constants left in a ply of an element.
  pure function elasticity(self, model, ply, element)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> Element of this rank
    integer, intent(in) :: element
    !> Constants of the ply
    type(elasticity_t) :: elasticity

    elasticity = model%plies(ply)%elasticity
    if (allocated(self%failed)) elasticity = degraded(elasticity, self%failed(:, ply, element), model%scene%ply_damage)
  end function elasticity

  !> Elastic constants left in the plies of an element.
  pure function elasticities(self, model, element) result(elasticity)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Element of this rank
    integer, intent(in) :: element
    !> Constants of the element's plies
    type(elasticity_t), allocatable :: elasticity(:)
    integer :: ply

    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      allocate (elasticity(range(2) - range(1) + 1))
      do ply = range(1), range(2)
        elasticity(ply - range(1) + 1) = self%elasticity(model, ply, element)
      end do
    end associate
  end function elasticities

  !> Gives one element the stiffness that failures have left.
  subroutine soften(self, model, element)
    !> The failures
    type(ply_failure_t), intent(in) :: self
    !> The model
    type(model_t), intent(inout) :: model
    !> Element of this rank
    integer, intent(in) :: element

    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)), &
               b => 1 + (element - 1)/lanes, lane => 1 + modulo(element - 1, lanes))
      model%elements%stiffness(lane, :, b) = section_stiffness(model%plies(range(1):range(2)), &
        self%elasticities(model, element), model%scene%laminate%shear_correction)
    end associate
  end subroutine soften

  !> Gives all elements the stiffness that failures have left.
  subroutine apply(self, model)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    !> The model
    type(model_t), intent(inout) :: model
    integer :: element

    if (.not. allocated(self%failed)) return
    do element = 1, model%elements%elements
      call soften(self, model, element)
    end do
  end subroutine apply

  !> Number of ply elements failed in each mode, of the whole plate.
  function counts(self, model)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Fibre failure, matrix cracking, matrix crushing
    integer :: counts(failure_modes)
    integer :: mode

    counts = 0
    if (.not. allocated(self%failed)) return
    do mode = 1, failure_modes
      counts(mode) = count(self%failed(mode, :, :))*model%mesh%multiplicity
      call model%communicator%sum(counts(mode))
    end do
  end function counts

  !> Saves or loads the failures.
  subroutine visit(self, archive, model)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    !> The model
    type(model_t), intent(in) :: model

    if (.not. allocated(self%failed)) return
    call visit_flags('ply_failure/failed', self%failed)
    call visit_flags('ply_failure/failed_when_factored', self%failed_when_factored)

  contains

    !> Saves or loads flags as a field over the elements.
    subroutine visit_flags(name, flags)
      !> Name of the item
      character(len=*), intent(in) :: name
      !> The flags
      logical, intent(inout) :: flags(:, :, :)
      real(wp), allocatable :: values(:, :)

      values = reshape(merge(1.0_wp, 0.0_wp, flags), [size(flags, 1)*size(flags, 2), size(flags, 3)])
      call archive%field(name, model%distribution%elements, model%mesh%elements(), values)
      flags = reshape(values > 0.5_wp, shape(flags))
    end subroutine visit_flags
  end subroutine visit
end module ply_failures
