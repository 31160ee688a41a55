!> The factored operator in a checkpoint: what made it, by which a restart makes the very same one.
module operator_restarts
  use archives, only: archive_t
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use operator_assembly, only: assemble_elements
  use section_stiffnesses, only: visit_stiffness
  use tangent_operators, only: tangent_operator_t
  use woodbury_updates, only: gather_changes
  implicit none
  private
  public :: visit_operator

contains

  !> Saves what is needed to make the very same factor again, as it shapes the iterations, or loads it and makes it.
  subroutine visit_operator(self, archive, model, error)
    !> The operator
    type(tangent_operator_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Set if the factor cannot be made again
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: changed(:, :)
    integer, allocatable :: columns(:)
    integer :: ranks

    call archive%item('operator/ready', self%ready)
    call archive%item('operator/stiffness_factor', self%stiffness_factor)
    call archive%item('operator/mass_factor', self%mass_factor)
    allocate (changed, mold=self%added)
    call self%changes%spread_out(self%numbering, changed)
    associate (share => model%distribution)
      call archive%field('operator/displacement', share%points(:share%owned), model%mesh%points(), self%displacement)
      if (model%has_bonds) then
        call archive%field('operator/added', share%points(:share%owned), model%mesh%points(), self%added)
        call archive%field('operator/changed', share%points(:share%owned), model%mesh%points(), changed)
      end if
    end associate
    if (model%scene%has_ply_damage) call visit_stiffness(archive, 'operator/stiffness', model, self%stiffness)
    ranks = model%communicator%size
    columns = self%changes%list()
    call archive%item('operator/ranks', ranks)
    call archive%item('operator/columns', columns)
    ! On another number of ranks the equations have other numbers: only the columns in use are found again.
    if (ranks /= model%communicator%size) columns = [integer ::]
    if (archive%loading .and. self%ready) call remake(self, model, columns, changed, error)
    if (allocated(self%membrane)) call archive%item('operator/membrane_fails', self%membrane%fails)
    call archive%item('operator/factorizations', self%factorizations)
    call archive%item('operator/solves', self%solves)
  end subroutine visit_operator

  !> Makes the factor again from what was loaded.
  subroutine remake(self, model, columns, changed, error)
    !> The operator
    type(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Equation and company of each column found since, (2 columns)
    integer, intent(in) :: columns(:)
    !> Changes in force, zero where there is none, (3, points)
    real(wp), intent(in) :: changed(:, :)
    !> Set if it cannot be made
    type(error_t), allocatable, intent(inout) :: error
    integer, allocatable :: equations(:)
    real(wp), allocatable :: stiffness(:)
    integer :: k

    self%present = self%added
    call model%halo%update(self%displacement)
    self%deflection = model%deflection(self%displacement)
    call self%solver%clear()
    call assemble_elements(model, self%stiffness, self%numbering, self%displacement, self%stiffness_factor, &
                           self%mass_factor, self%solver, self%diagonal)
    call self%factorize(model, error)
    k = 1
    do while (k < size(columns) .and. .not. allocated(error))
      call self%find_columns(model, columns(k:k + 2*columns(k + 1) - 2:2), error)
      k = k + 2*columns(k + 1)
    end do
    if (.not. allocated(error) .and. model%has_bonds) then
      call gather_changes(model%communicator, self%numbering, changed(:, :self%numbering%owned), equations, stiffness)
      if (size(equations) > 0) call self%put_in_force(model, equations, stiffness, error)
    end if
  end subroutine remake
end module operator_restarts
