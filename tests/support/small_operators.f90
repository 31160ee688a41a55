!> Factored operators of small plates for tests, and vibration modes.
module small_operators
  use kinds, only: wp
  use errors, only: error_t
  use models, only: model_t
  use linear_solver_parameters, only: factorization_mumps
  use states, only: new_state, state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: factor, find_mode

contains

  !> Factors an operator of a model without separated layers.
  subroutine factor(model, displacement, stiffness_factor, mass_factor, operator, error)
    !> The model
    type(model_t), intent(in) :: model
    !> Displacement at which the tangent is taken, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> The operator
    type(tangent_operator_t), intent(out) :: operator
    !> Set if there is no factor
    type(error_t), allocatable, intent(out) :: error
    type(state_t) :: state

    call operator%create(model, factorization_mumps, error)
    if (allocated(error)) return
    state = new_state(model)
    state%motion%displacement = displacement
    call operator%renew(model, state, stiffness_factor, mass_factor, error)
  end subroutine factor

  !> Vibration mode of lowest frequency with the symmetry of a starting shape, by inverse iteration.
  subroutine find_mode(model, mode, frequency, error)
    !> The model
    type(model_t), intent(in) :: model
    !> Starting shape on entry, mode of unit deflection on return, (5, points)
    real(wp), intent(inout) :: mode(:, :)
    !> Frequency, radians a unit of time
    real(wp), intent(out) :: frequency
    !> Set if there is no factor
    type(error_t), allocatable, intent(out) :: error
    type(tangent_operator_t) :: operator
    real(wp), allocatable :: force(:, :), rest(:, :)
    real(wp) :: products(2), energy
    integer :: i
    ! More iterations would let round-off of other symmetries grow.
    integer, parameter :: iterations = 8

    allocate (force, rest, mold=mode)
    rest = 0
    call factor(model, rest, 1.0_wp, 0.0_wp, operator, error)
    if (allocated(error)) return
    do i = 1, iterations
      call model%inertia(mode, force)
      call operator%correct(model%plate, force, mode, error)
      if (allocated(error)) return
      mode = mode/maxval(abs(mode(3, :)))
    end do
    call model%internal(model%plate%elements%stiffness, mode, force, energy)
    products(1) = model%plate%product(mode, force)
    call model%inertia(mode, force)
    products(2) = model%plate%product(mode, force)
    call model%plate%communicator%sum(products)
    frequency = sqrt(products(1)/products(2))
    call operator%release()
  end subroutine find_mode
end module small_operators
