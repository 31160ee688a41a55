!> The factored operator in a checkpoint: the data it was computed from, so that a restart computes the same factor.
module operator_restarts
  use archives, only: archive_t
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use operator_assembly, only: assemble_elements
  use section_stiffnesses, only: visit_stiffness
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: visit_operator

contains

  !> Saves the data that the factor was computed from, or loads them and factorizes: the factor affects the iterations.
  subroutine visit_operator(self, archive, model, error)
    !> The operator
    type(tangent_operator_t), intent(inout) :: self
    !> The checkpoint
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Set if the factorization fails
    type(error_t), allocatable, intent(out) :: error

    call archive%item('operator/ready', self%ready)
    call archive%item('operator/stiffness_factor', self%stiffness_factor)
    call archive%item('operator/mass_factor', self%mass_factor)
    associate (share => model%distribution)
      call archive%field('operator/displacement', share%points(:share%owned), model%mesh%points(), self%displacement)
      if (model%has_bonds) &
        call archive%field('operator/added', share%points(:share%owned), model%mesh%points(), self%added)
    end associate
    if (model%setup%has_ply_damage) call visit_stiffness(archive, 'operator/stiffness', model, self%stiffness)
    if (archive%loading .and. self%ready) call refactorize(self, model, error)
    call archive%item('operator/factorizations', self%factorizations)
    call archive%item('operator/solves', self%solves)
  end subroutine visit_operator

  !> Factorizes from the data loaded.
  subroutine refactorize(self, model, error)
    !> The operator
    type(tangent_operator_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the factorization fails
    type(error_t), allocatable, intent(inout) :: error

    call model%halo%update(self%displacement)
    self%deflection = model%deflection(self%displacement)
    call self%solver%clear()
    call assemble_elements(model, self%stiffness, self%numbering, self%displacement, self%stiffness_factor, &
                           self%mass_factor, self%solver, self%diagonal)
    call self%factorize(model, error)
  end subroutine refactorize
end module operator_restarts
