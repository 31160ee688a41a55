!> The current tangent of a time step, for which the factored operator is the preconditioner.
module dynamic_tangents
  use errors, only: error_t
  use impact_coupling, only: impact_coupling_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use newton_iterations, only: newton_iteration_t
  use plate_options, only: kinematics_linear, kinematics_von_karman
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_tangent, add_force_slope, is_exact

  !> Relative change of the factor of mass up to which an operator counts as exact: the last digits of the step, as
  !> after 1e6 steps the time is known to 1e-10 of a step.
  real(wp), parameter :: mass_precision = 1.0e-9_wp

contains

  !> The tangent without the impactor's force. The operator is factorized again if required, or if ties and contacts
  !> differ too much from it.
  subroutine find_tangent(at, factors, required, max_changes, uses_element_tangents, tangent, error)
    !> The iteration; its operator may be factorized
    type(newton_iteration_t), intent(in) :: at
    !> Factors of stiffness and mass
    real(wp), intent(in) :: factors(2)
    !> True: factorized again in any case
    logical, intent(in) :: required
    !> Changes of ties and contacts that the iteration may account for
    integer, intent(in) :: max_changes
    !> True: element tangents are used, as the factored operator reduces the residual too little
    logical, intent(in) :: uses_element_tangents
    type(tangent_product_t), intent(out) :: tangent
    !> Set if the operator is singular
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: current_stiffness(:, :)
    logical :: due

    associate (model => at%model, operator => at%operator, new => at%new)
      due = required
      if (model%has_point_stiffness) then
        allocate (current_stiffness, mold=operator%added)
        call new%interfaces%added_stiffness(model, operator%diagonal, factors(1), current_stiffness)
        if (.not. due) due = operator%has_outdated_constraints(model%plate, current_stiffness, max_changes)
      end if
      if (due) call operator%renew(model, new, factors(1), factors(2), error)
      if (allocated(error)) return
      call set_state(tangent, at, factors)
      tangent%elements = model%plate%setup%mesh%kinematics == kinematics_von_karman .and. (uses_element_tangents &
                                                                                .or. model%has_point_stiffness)
      tangent%elements = .not. due .and. (model%plate%setup%ply_damage%is_present .or. tangent%elements)
      ! The operator has the compressive modulus for all strains of a compressed ply, the tangent for their mean.
      tangent%elements = tangent%elements .or. model%plate%setup%is_bimodular()
      if (model%has_point_stiffness) &
        call tangent%set_jump_stiffness(operator%added, current_stiffness, new%interfaces%cohesive%cohesive, &
                                        factors(1)*new%interfaces%cohesive%tangents_at( &
                                        model%plate, at%old%interfaces%cohesive, new%motion%displacement))
      if (tangent%is_factored()) return
      tangent%diagonal = operator%diagonal
      if (model%has_point_stiffness) tangent%diagonal(:3, :) = tangent%diagonal(:3, :) + current_stiffness
    end associate
  end subroutine find_tangent

  !> The tangent's model, operator, factors, and the state at which it is taken.
  subroutine set_state(tangent, at, factors)
    type(tangent_product_t), intent(inout) :: tangent
    type(newton_iteration_t), intent(in) :: at
    !> Factors of stiffness and mass
    real(wp), intent(in) :: factors(2)

    tangent%model => at%model
    tangent%operator => at%operator
    tangent%displacement => at%new%motion%displacement
    tangent%stiffness => at%new%plies%stiffness
    if (allocated(at%new%plies%free)) tangent%free => at%new%plies%free
    if (allocated(at%new%plies%mean_change)) tangent%mean_change => at%new%plies%mean_change
    tangent%stiffness_factor = factors(1)
    tangent%mass_factor = factors(2)
    if (abs(factors(2)/at%operator%mass_factor - 1) > mass_precision) &
      tangent%mass_change = factors(2) - at%operator%mass_factor
  end subroutine set_state

  !> True: all forces but the impactor's are linear, and the operator is their tangent, so one correction finds
  !> equilibrium.
  pure logical function is_exact(plate, operator, mass_factor) result(exact)
    type(composite_plate_t), intent(in) :: plate
    type(tangent_operator_t), intent(in) :: operator
    !> Factor of mass in the tangent
    real(wp), intent(in) :: mass_factor

    exact = plate%setup%mesh%kinematics == kinematics_linear .and. .not. plate%setup%has_variable_sections()
    if (exact) exact = abs(operator%mass_factor/mass_factor - 1) <= mass_precision
  end function is_exact

  !> Adds the slope of the impactor's force to a tangent.
  subroutine add_force_slope(at, coupling, tangent)
    type(newton_iteration_t), intent(in) :: at
    !> The impactor's side of the step
    type(impact_coupling_t), intent(in) :: coupling
    type(tangent_product_t), intent(inout) :: tangent
    real(wp), allocatable :: push(:, :)

    associate (model => at%model, numbering => at%operator%numbering, contact => at%new%impact%patch)
      allocate (push(5, size(contact%weights)), source=0.0_wp)
      push(3, :) = contact%weights/model%plate%mesh%multiplicity
      allocate (tangent%pattern(numbering%rows))
      call numbering%gather(push, tangent%pattern)
      tangent%force_slope = coupling%slope(model%plate%setup%impactor%indentation, at%old%impact%indentation, &
                                           at%new%contact_deflection(model%plate))
    end associate
  end subroutine add_force_slope
end module dynamic_tangents
