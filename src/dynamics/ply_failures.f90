!> Failed plies, element by element: since when each mode has been taking stiffness away, the stiffness that is left,
!> and the energy lost with it.
module ply_failures
  use kinds, only: wp
  use archives, only: archive_t
  use element_batches, only: lanes, first_element
  use strain_recovery, only: mean_strains
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes
  use degradation, only: degraded
  use stacking, only: section_stiffness
  use states, only: state_t
  use models, only: model_t
  use ply_criteria, only: criteria_met
  implicit none
  private
  public :: ply_failure_t, new_ply_failure

  !> Start of a mode that has not occurred.
  real(wp), parameter :: never = huge(never)

  !> Failed modes of every ply of this rank's elements.
  type :: ply_failure_t
    !> Time, or load factor, from which on a mode takes stiffness away: the start of the step at whose end its criterion
    !> was found met, (modes, plies, elements); unallocated: not modelled
    real(wp), allocatable, private :: start(:, :, :)
    !> Time over which it does so
    real(wp), private :: fade = 0
    !> Time whose stiffness the elements have
    real(wp) :: time = 0
    !> The same when the operator was last factored, which a restart must make again
    real(wp) :: time_when_factored = 0
  contains
    !> Finds new failures in an accepted state and takes stiffness away.
    procedure :: grow
    !> Gives all elements the stiffness of a time.
    procedure :: apply
    !> Elastic constants left in a ply of an element, and in all its plies.
    procedure :: elasticity
    procedure :: elasticities
    !> Modes that have occurred in a ply.
    procedure :: failed
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
    allocate (self%start(failure_modes, size(model%plies), model%elements%elements), source=never)
    ! Load steps know no time.
    if (.not. model%scene%has_static) self%fade = model%scene%ply_damage%fade
  end function new_ply_failure

  !> Finds new failures in an accepted state, takes away what stiffness is due until then and books the energy lost.
  subroutine grow(self, model, state)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    !> The model, whose failed elements lose stiffness
    type(model_t), intent(inout) :: model
    !> The state
    type(state_t), intent(inout) :: state
    real(wp) :: energy
    logical, allocatable :: changing(:)
    integer :: element

    if (.not. allocated(self%start)) return
    call find_failures(self, model, state)
    changing = [(any(self%start(:, :, element) < never .and. taken(self, self%start(:, :, element)) < 1), &
                 element=1, model%elements%elements)]
    self%time = state%time
    if (.not. model%communicator%any(any(changing))) return
    do element = 1, size(changing)
      if (changing(element)) call soften(self, model, element)
    end do
    call model%internal(state%motion%displacement, state%motion%internal, energy)
    call model%communicator%sum(energy)
    energy = energy*model%mesh%multiplicity
    state%ledger%ply_damage = state%ledger%ply_damage + state%ledger%strain - energy
    state%ledger%strain = energy
  end subroutine grow

  !> Finds the modes whose criteria are met for the first time. They count from the start of the step.
  subroutine find_failures(self, model, state)
    !> The failures
    type(ply_failure_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> The state at the end of the step
    type(state_t), intent(in) :: state
    real(wp) :: strains(lanes, 8)
    real(wp), allocatable :: motion(:, :)
    integer :: b, lane, element

    motion = model%motion_of(state%motion%displacement)
    do b = 1, model%elements%batches
      call mean_strains(model%elements, b, model%scene%kinematics, motion, strains)
      do lane = 1, model%elements%lanes_used(b)
        element = first_element(b) + lane - 1
        associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
          associate (start => self%start(:, range(1):range(2), element))
            where (criteria_met(model, element, self%elasticities(model, element), strains(lane, :))) &
              start = min(start, self%time)
          end associate
        end associate
      end do
    end do
  end subroutine find_failures

  !> Part that a mode has taken, by the present time, of the stiffness that it takes.
  elemental real(wp) function taken(self, start)
    !> The failures
    type(ply_failure_t), intent(in) :: self
    !> Time from which on the mode acts
    real(wp), intent(in) :: start

    if (start >= self%time) then
      taken = 0
    else if (self%time - start >= self%fade) then
      taken = 1
    else
      taken = (self%time - start)/self%fade
    end if
  end function taken

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
    if (allocated(self%start)) &
      elasticity = degraded(elasticity, taken(self, self%start(:, ply, element)), model%scene%ply_damage)
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

  !> Gives one element the stiffness of the present time.
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

  !> Gives all elements the stiffness that failures have left at a time.
  subroutine apply(self, model, time)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    !> The model
    type(model_t), intent(inout) :: model
    !> The time, from now on that of the failures
    real(wp), intent(in) :: time
    integer :: element

    if (.not. allocated(self%start)) return
    self%time = time
    do element = 1, model%elements%elements
      call soften(self, model, element)
    end do
  end subroutine apply

  !> Modes that have occurred in a ply.
  pure function failed(self, ply)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> True where a mode has occurred, (modes, elements)
    logical, allocatable :: failed(:, :)

    failed = self%start(:, ply, :) < never
  end function failed

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
    if (.not. allocated(self%start)) return
    do mode = 1, failure_modes
      counts(mode) = count(self%start(mode, :, :) < never)*model%mesh%multiplicity
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
    real(wp), allocatable :: start(:, :)

    if (.not. allocated(self%start)) return
    start = reshape(self%start, [size(self%start, 1)*size(self%start, 2), size(self%start, 3)])
    call archive%field('ply_failure/start', model%distribution%elements, model%mesh%elements(), start)
    self%start = reshape(start, shape(self%start))
    call archive%item('ply_failure/time', self%time)
    call archive%item('ply_failure/time_when_factored', self%time_when_factored)
  end subroutine visit
end module ply_failures
