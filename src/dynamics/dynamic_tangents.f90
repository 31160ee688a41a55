!> The current tangent of a time step, for which the factored operator is the preconditioner.
module dynamic_tangents
  use errors, only: error_t
  use impact_coupling, only: impact_coupling_t
  use kinds, only: wp
  use models, only: model_t
  use plate_options, only: kinematics_linear, kinematics_von_karman
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_tangent, add_force_slope, is_exact

  !> Relative change of the factor of mass by which an operator counts as exact: the last digits of the step, as times
  !> of 1e6 steps are known to 1e-10 of a step.
  real(wp), parameter :: mass_precision = 1.0e-9_wp

contains

  !> The tangent without the impactor's force. The operator is factorized again if required, or if ties and contacts
  !> differ too much from it.
  subroutine find_tangent(model, operator, old, new, factors, required, max_changes, uses_element_tangents, tangent, &
                          diagonal, &
                          error)
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), target, intent(in) :: new
    !> Factors of stiffness and mass
    real(wp), intent(in) :: factors(2)
    !> True: factorized again in any case
    logical, intent(in) :: required
    !> Changes of ties and contacts that the iteration may account for
    integer, intent(in) :: max_changes
    !> True: element tangents are used, as the factored operator reduces the residual too little
    logical, intent(in) :: uses_element_tangents
    !> The tangent
    type(tangent_product_t), intent(out) :: tangent
    !> Its diagonal, (5, points); unallocated: the tangent is the factored operator
    real(wp), allocatable, intent(out) :: diagonal(:, :)
    !> Set if the operator is singular
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: current_stiffness(:, :)
    logical :: due

    due = required
    if (model%has_bonds) then
      allocate (current_stiffness, mold=operator%added)
      call new%interfaces%added_stiffness(model, operator%diagonal, factors(1), current_stiffness)
      if (.not. due) due = operator%has_outdated_constraints(model, current_stiffness, max_changes)
    end if
    if (due) call operator%renew(model, new%plies%stiffness, new%interfaces, new%motion%displacement, factors(1), &
                                 factors(2), error)
    if (allocated(error)) return
    tangent%model => model
    tangent%operator => operator
    tangent%displacement => new%motion%displacement
    tangent%stiffness => new%plies%stiffness
    if (allocated(new%plies%free)) tangent%free => new%plies%free
    tangent%stiffness_factor = factors(1)
    tangent%mass_factor = factors(2)
    if (abs(factors(2)/operator%mass_factor - 1) > mass_precision) &
      tangent%mass_change = factors(2) - operator%mass_factor
    tangent%elements = model%setup%kinematics == kinematics_von_karman .and. (uses_element_tangents &
                                                                              .or. model%has_bonds)
    tangent%elements = .not. due .and. (model%setup%has_ply_damage .or. tangent%elements)
    if (model%has_bonds) &
      call tangent%set_jump_stiffness(operator%added, current_stiffness, new%interfaces%cohesive%cohesive, factors(1)* &
        new%interfaces%cohesive%tangents_at(model, old%interfaces%cohesive, new%motion%displacement))
    if (tangent%is_factored()) return
    diagonal = operator%diagonal
    if (model%has_bonds) diagonal(:3, :) = diagonal(:3, :) + current_stiffness
  end subroutine find_tangent

  !> True: all forces but the impactor's are linear, and the operator is their tangent, so one correction finds
  !> equilibrium.
  pure logical function is_exact(model, operator, mass_factor) result(exact)
    type(model_t), intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    !> Factor of mass in the tangent
    real(wp), intent(in) :: mass_factor

    exact = model%setup%kinematics == kinematics_linear .and. .not. model%setup%has_ply_damage
    if (exact) exact = abs(operator%mass_factor/mass_factor - 1) <= mass_precision
  end function is_exact

  !> Adds the slope of the impactor's force to a tangent.
  subroutine add_force_slope(model, operator, coupling, old, new, tangent)
    type(model_t), intent(in) :: model
    !> Knows the equations
    type(tangent_operator_t), intent(in) :: operator
    !> The impactor's side of the step
    type(impact_coupling_t), intent(in) :: coupling
    !> State at the start, and at the end
    type(state_t), intent(in) :: old, new
    !> The tangent
    type(tangent_product_t), intent(inout) :: tangent
    real(wp), allocatable :: push(:, :)

    allocate (push(5, size(model%contact%weights)), source=0.0_wp)
    push(3, :) = model%contact%weights/model%mesh%multiplicity
    allocate (tangent%pattern(operator%numbering%rows))
    call operator%numbering%gather(push, tangent%pattern)
    tangent%force_slope = coupling%slope(model%setup%indentation, old%indentation, &
                                         model%contact_deflection(new%motion%displacement))
  end subroutine add_force_slope
end module dynamic_tangents
