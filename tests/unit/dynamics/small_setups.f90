!> Small plates for the tests of dynamics: setups, vibration modes, and plates released from a shape.
module small_setups
  use kinds, only: wp
  use errors, only: error_t
  use communicators, only: communicator_t
  use plate_options, only: kinematics_linear
  use mesh_parameters, only: edge_simple, symmetry_none, symmetry_quarter
  use material_parameters, only: material_t
  use impact_parameters, only: law_hertz, integrator_conserving
  use pressure_loads, only: distribution_sine
  use stepped_setups, only: stepped_setup_t
  use models, only: model_t
  use interface_states, only: new_interface_state
  use linear_solver_parameters, only: factorization_mumps
  use tangent_operators, only: tangent_operator_t
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: isotropic, cross_ply_material, unit_plate, press, coupling, factor, find_mode, shaped_like, release_from

  real(wp), parameter, public :: pi = acos(-1.0_wp)

contains

  !> A material of unit stiffness and density.
  pure function isotropic(nu) result(material)
    !> Poisson's ratio
    real(wp), intent(in) :: nu
    !> The material
    type(material_t) :: material

    material%name = 'isotropic'
    material%density = 1
    material%e1 = 1
    material%e2 = 1
    material%g12 = 0.5_wp/(1 + nu)
    material%g13 = material%g12
    material%g23 = material%g12
    material%nu12 = nu
  end function isotropic

  !> The material of published frequencies of laminates: E1/E2 = 40.
  pure function cross_ply_material() result(material)
    !> The material
    type(material_t) :: material

    material%name = 'ply'
    material%density = 1
    material%e1 = 40
    material%e2 = 1
    material%g12 = 0.6_wp
    material%g13 = 0.6_wp
    material%g23 = 0.5_wp
    material%nu12 = 0.25_wp
  end function cross_ply_material

  !> A simply supported unit square with linear strains and no load.
  pure function unit_plate(material, angles, thickness, elements, quarter) result(setup)
    !> The material of all plies
    type(material_t), intent(in) :: material
    !> Angles of the plies, degrees, and thickness of them all
    real(wp), intent(in) :: angles(:), thickness
    !> Elements along each side of what is modelled
    integer, intent(in) :: elements
    !> True: a quarter is modelled
    logical, intent(in) :: quarter
    !> The setup
    type(stepped_setup_t) :: setup
    integer :: plies

    plies = size(angles)
    setup%kinematics = kinematics_linear
    setup%plate%length = 1
    setup%plate%edges = edge_simple
    setup%plate%symmetry = merge(symmetry_quarter, symmetry_none, quarter)
    setup%mesh%elements = elements
    setup%materials = [material]
    allocate (setup%laminate%material(plies), source=1)
    setup%laminate%angle = angles
    allocate (setup%laminate%thickness(plies), source=thickness/plies)
    setup%stepping%equilibrium%tolerance = 1.0e-12_wp
  end function unit_plate

  !> Adds a pressure of one half-sine along each side.
  pure subroutine press(setup, value)
    !> The setup
    type(stepped_setup_t), intent(inout) :: setup
    !> Largest pressure
    real(wp), intent(in) :: value

    setup%has_pressure = .true.
    setup%pressure%value = value
    setup%pressure%distribution = distribution_sine
  end subroutine press

  !> Adds an impactor that falls on a patch a fifth of the side wide.
  pure subroutine coupling(setup, mass, velocity, k)
    !> The setup
    type(stepped_setup_t), intent(inout) :: setup
    !> Mass and velocity of the impactor, contact stiffness
    real(wp), intent(in) :: mass, velocity, k

    setup%has_impactor = .true.
    setup%mesh%patch = 0.2_wp
    setup%impactor%mass = mass
    setup%impactor%velocity = velocity
    setup%impactor%integrator = integrator_conserving
    setup%indentation%law = law_hertz
    setup%indentation%k = k
  end subroutine coupling

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

    call operator%create(model, factorization_mumps, error)
    if (allocated(error)) return
    call operator%renew(model, model%elements%stiffness, new_interface_state(model), displacement, stiffness_factor, &
                        mass_factor, error)
  end subroutine factor

  !> Deflection of m half-waves along x and n along y of a simply supported plate.
  function shaped_like(model, m, n) result(shape)
    !> The model
    type(model_t), intent(in) :: model
    !> Half-waves
    integer, intent(in) :: m, n
    !> The field, (5, points); rotations are zero
    real(wp), allocatable :: shape(:, :)
    integer :: i

    allocate (shape(5, size(model%distribution%points)), source=0.0_wp)
    do i = 1, size(shape, 2)
      associate (x => model%mesh%node_coordinates(:, model%mesh%point_node(model%distribution%points(i))))
        shape(3, i) = sin(m*pi*(x(1) + 0.5_wp))*sin(n*pi*(x(2) + 0.5_wp))
      end associate
    end do
    where (model%held(:, model%distribution%points)) shape = 0
  end function shaped_like

  !> Vibration mode of lowest frequency among those of the symmetry of a starting shape, by inverse iteration.
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
    ! More would let rounding errors of other symmetries grow.
    integer, parameter :: iterations = 8

    allocate (force, rest, mold=mode)
    rest = 0
    call factor(model, rest, 1.0_wp, 0.0_wp, operator, error)
    if (allocated(error)) return
    do i = 1, iterations
      call model%inertia(mode, force)
      call operator%correct(model, force, mode, error)
      if (allocated(error)) return
      mode = mode/maxval(abs(mode(3, :)))
    end do
    call model%internal(model%elements%stiffness, mode, force, energy)
    products(1) = model%product(mode, force)
    call model%inertia(mode, force)
    products(2) = model%product(mode, force)
    call model%communicator%sum(products)
    frequency = sqrt(products(1)/products(2))
    call operator%release()
  end subroutine find_mode

  !> Puts a plate that has been started into a shape from which it is released.
  subroutine release_from(stepper, model, displacement, error)
    !> The time stepper, started
    type(time_stepper_t), intent(inout) :: stepper
    !> The model
    type(model_t), intent(in) :: model
    !> The shape, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Set if the mass cannot be factored
    type(error_t), allocatable, intent(out) :: error
    type(tangent_operator_t) :: mass
    real(wp) :: energy

    associate (motion => stepper%now%motion)
      motion%displacement = displacement
      call model%internal(model%elements%stiffness, displacement, motion%internal, energy)
      call factor(model, 0*displacement, 0.0_wp, 1.0_wp, mass, error)
      if (allocated(error)) return
      call mass%correct(model, -motion%internal, motion%acceleration, error)
      call mass%solver%release()
      call model%inertia(motion%acceleration, motion%inertia)
    end associate
    stepper%now%ledger%strain = energy*model%mesh%multiplicity
    stepper%now%ledger%initial = stepper%now%ledger%strain
  end subroutine release_from
end module small_setups
