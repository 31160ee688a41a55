!> Since when each mode of failure has been at work in the plies of every element, and the elastic constants left.
module ply_onsets
  use kinds, only: wp
  use archives, only: archive_t
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes
  use degradation, only: degraded
  use models, only: model_t
  use criterion_strains, only: mean_strains_of_elements
  use ply_criteria, only: failure_measures
  implicit none
  private
  public :: ply_onset_t, new_ply_onset

  !> Start of a mode that has not occurred.
  real(wp), parameter :: never = huge(never)

  !> Onset of failure in the plies of this rank's elements.
  type :: ply_onset_t
    !> Time, or load factor, at which the criterion of a mode was first met, (modes, plies, elements); unallocated:
    !> not modelled
    real(wp), allocatable, private :: start(:, :, :)
    !> Time over which a failure takes its stiffness away
    real(wp), private :: fade = 0
    !> Time whose stiffness the elements have: the end of the next step if that is as long as the last one
    real(wp), private :: time = 0
  contains
    !> Finds the modes whose criteria are met for the first time.
    procedure :: find
    !> Lets time go on.
    procedure :: go_on
    !> Elements with plies that have more stiffness to lose.
    procedure :: fading
    !> Elastic constants left in a ply of an element, and in all its plies.
    procedure :: elasticity
    procedure :: elasticities
    !> Modes that have occurred in a ply.
    procedure :: failed
    !> Saves or loads.
    procedure :: visit
  end type ply_onset_t

contains

  !> No failure.
  pure function new_ply_onset(model) result(self)
    type(model_t), intent(in) :: model
    !> The onsets
    type(ply_onset_t) :: self

    if (.not. model%scene%has_ply_damage) return
    allocate (self%start(failure_modes, size(model%plies), model%elements%elements), source=never)
    ! Load steps know no time.
    if (.not. model%scene%has_static) self%fade = model%scene%ply_damage%fade
  end function new_ply_onset

  !> Finds the modes whose criteria are met for the first time, and when within a step that was.
  subroutine find(self, model, stiffness, times, before, after, found)
    !> The onsets
    class(ply_onset_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Times before and after the step
    real(wp), intent(in) :: times(2)
    !> Displacements before and after it, (5, points)
    real(wp), intent(in) :: before(:, :), after(:, :)
    !> Set to true for elements with a new failure, (elements)
    logical, intent(inout) :: found(:)
    real(wp), allocatable :: strains_before(:, :), strains(:, :)
    logical, allocatable :: failing(:)
    integer :: element

    strains = mean_strains_of_elements(model, after)
    failing = [(any(failing_anew(self, model, stiffness, element, strains(:, element))), element=1, size(strains, 2))]
    if (.not. model%communicator%any(any(failing))) return
    found = found .or. failing
    strains_before = mean_strains_of_elements(model, before)
    do element = 1, size(failing)
      if (failing(element)) call note_start(self, model, stiffness, element, strains_before(:, element), &
                                            strains(:, element), times)
    end do
  end subroutine find

  !> Modes of an element's plies whose criteria are met for the first time.
  function failing_anew(self, model, stiffness, element, strains) result(failing)
    !> The onsets
    type(ply_onset_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Element of this rank
    integer, intent(in) :: element
    !> Its mean strains after the step
    real(wp), intent(in) :: strains(8)
    !> True where that is so, (modes, plies of the element)
    logical, allocatable :: failing(:, :)

    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      failing = failure_measures(model, stiffness, element, self%elasticities(model, element), strains) >= 1 .and. &
                self%start(:, range(1):range(2), element) >= never
    end associate
  end function failing_anew

  !> Notes when within a step modes were met. What a criterion measures is taken to go straight through the step, so
  !> that the time found hardly depends on the length of the step.
  subroutine note_start(self, model, stiffness, element, before, after, times)
    !> The onsets
    type(ply_onset_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Element of this rank
    integer, intent(in) :: element
    !> Its mean strains before and after the step
    real(wp), intent(in) :: before(8), after(8)
    !> The times of both
    real(wp), intent(in) :: times(2)
    type(elasticity_t), allocatable :: elasticity(:)
    real(wp), allocatable :: first(:, :), last(:, :)
    logical, allocatable :: failing(:, :)

    failing = failing_anew(self, model, stiffness, element, after)
    elasticity = self%elasticities(model, element)
    first = min(failure_measures(model, stiffness, element, elasticity, before), 1.0_wp)
    last = failure_measures(model, stiffness, element, elasticity, after)
    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      associate (start => self%start(:, range(1):range(2), element))
        where (failing) start = times(2) - (times(2) - times(1))*(last - 1)/max(last - first, tiny(1.0_wp))
      end associate
    end associate
  end subroutine note_start

  !> Lets time go on to the end of a step like the last one. It never goes back, also where steps become shorter.
  pure subroutine go_on(self, times)
    !> The onsets
    class(ply_onset_t), intent(inout) :: self
    !> Times before and after the last step
    real(wp), intent(in) :: times(2)

    self%time = max(self%time, times(2) + (times(2) - times(1)))
  end subroutine go_on

  !> Elements with plies that have failed and have more stiffness to lose.
  pure function fading(self)
    !> The onsets
    class(ply_onset_t), intent(in) :: self
    !> True where there are such, (elements)
    logical :: fading(size(self%start, 3))

    fading = any(any(self%start < never .and. taken(self, self%start) < 1, dim=1), dim=1)
  end function fading

  !> Part that a mode has taken of the stiffness that it takes.
  elemental real(wp) function taken(self, start)
    !> The onsets
    type(ply_onset_t), intent(in) :: self
    !> Time at which its criterion was met
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
    !> The onsets
    class(ply_onset_t), intent(in) :: self
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
    !> The onsets
    class(ply_onset_t), intent(in) :: self
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

  !> Modes that have occurred in a ply.
  pure function failed(self, ply)
    !> The onsets
    class(ply_onset_t), intent(in) :: self
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> True where a mode has occurred, (modes, elements)
    logical, allocatable :: failed(:, :)

    failed = self%start(:, ply, :) < never
  end function failed

  !> Saves or loads the onsets.
  subroutine visit(self, archive, model, path)
    !> The onsets
    class(ply_onset_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> First part of the items' names
    character(len=*), intent(in) :: path
    real(wp), allocatable :: start(:, :)
    integer :: element, ply

    if (.not. allocated(self%start)) return
    start = reshape(self%start, [size(self%start, 1)*size(self%start, 2), size(self%start, 3)])
    call archive%field(path//'start', model%distribution%elements, model%mesh%elements(), start)
    self%start = reshape(start, shape(self%start))
    ! What is loaded may come from an element that had more plies.
    do element = 1, size(self%start, 3)
      associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
        do ply = 1, size(self%start, 2)
          if (ply < range(1) .or. ply > range(2)) self%start(:, ply, element) = never
        end do
      end associate
    end do
    call archive%item(path//'time', self%time)
  end subroutine visit
end module ply_onsets
