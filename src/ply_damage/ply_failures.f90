!> Failure of plies: the stiffness it takes from the elements, and the energy lost with it.
module ply_failures
  use kinds, only: wp
  use archives, only: archive_t
  use element_batches, only: batch_of, lane_of
  use ply_damage_parameters, only: failure_modes
  use stacking, only: section_stiffness
  use section_stiffnesses, only: visit_stiffness
  use models, only: model_t
  use ply_onsets, only: ply_onset_t, new_ply_onset
  implicit none
  private
  public :: ply_failure_t, new_ply_failure

  !> Failures of the plies of this rank's elements.
  type :: ply_failure_t
    !> When they began
    type(ply_onset_t) :: onset
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> True if plies took stiffness away after the last step
    logical :: softened = .false.
  contains
    !> Finds new failures in an accepted state and takes stiffness away.
    procedure :: grow
    !> Number of ply elements failed in each mode, and area failed in each ply, of the whole plate.
    procedure :: counts
    procedure :: areas
    !> Saves or loads.
    procedure :: visit
  end type ply_failure_t

contains

  !> No failure.
  pure function new_ply_failure(model) result(self)
    type(model_t), intent(in) :: model
    !> The failures
    type(ply_failure_t) :: self

    self%onset = new_ply_onset(model)
    self%stiffness = model%elements%stiffness
  end function new_ply_failure

  !> Finds new failures in an accepted state and takes away what stiffness goes until the end of the next step.
  subroutine grow(self, model, times, before, after)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Times before and after the step
    real(wp), intent(in) :: times(2)
    !> Displacements before and after the step, (5, points)
    real(wp), intent(in) :: before(:, :), after(:, :)
    logical, allocatable :: changing(:)
    integer :: element

    if (.not. model%scene%has_ply_damage) return
    changing = self%onset%fading()
    call self%onset%find(model, self%stiffness, times, before, after, changing)
    call self%onset%go_on(times)
    self%softened = model%communicator%any(any(changing))
    if (.not. self%softened) return
    do element = 1, size(changing)
      if (changing(element)) call soften(self, model, element)
    end do
  end subroutine grow

  !> Gives one element the stiffness that failures have left.
  subroutine soften(self, model, element)
    !> The failures
    type(ply_failure_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Element of this rank
    integer, intent(in) :: element

    associate (range => model%mesh%element_plies(:, model%distribution%elements(element)))
      self%stiffness(lane_of(element), :, batch_of(element)) = &
        section_stiffness(model%plies(range(1):range(2)), self%onset%elasticities(model, element), &
                          model%scene%laminate%shear_correction)
    end associate
  end subroutine soften

  !> Number of ply elements failed in each mode, of the whole plate.
  function counts(self, model)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Fibre failure, matrix cracking, matrix crushing
    integer :: counts(failure_modes)
    integer :: ply, mode

    counts = 0
    if (.not. model%scene%has_ply_damage) return
    do ply = 1, size(model%plies)
      counts = counts + count(self%onset%failed(ply), dim=2)*model%mesh%multiplicity
    end do
    do mode = 1, failure_modes
      call model%communicator%sum(counts(mode))
    end do
  end function counts

  !> Area in which each ply has failed in each mode, of the whole plate. Collective.
  function areas(self, model)
    !> The failures
    class(ply_failure_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> (modes, plies)
    real(wp) :: areas(failure_modes, size(model%plies))
    real(wp) :: cells(model%elements%elements)
    integer :: ply, mode, i

    areas = 0
    if (.not. model%scene%has_ply_damage) return
    do i = 1, size(cells)
      cells(i) = model%mesh%cell_area(model%mesh%place_of(model%mesh%element_cell(model%distribution%elements(i))))
    end do
    do ply = 1, size(model%plies)
      associate (failed => self%onset%failed(ply))
        areas(:, ply) = [(sum(cells, mask=failed(mode, :)), mode=1, failure_modes)]*model%mesh%multiplicity
      end associate
      call model%communicator%sum(areas(:, ply))
    end do
  end function areas

  !> Saves or loads the failures.
  subroutine visit(self, archive, model)
    !> The failures
    class(ply_failure_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model

    call self%onset%visit(archive, model, 'ply_failure/onset/')
    if (model%scene%has_ply_damage) call visit_stiffness(archive, 'ply_failure/stiffness', model, self%stiffness)
  end subroutine visit
end module ply_failures
