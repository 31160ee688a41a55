!> Small plates for tests: setups, and fields like vibration modes.
module small_setups
  use kinds, only: wp
  use plate_options, only: kinematics_linear
  use mesh_parameters, only: edge_simple, symmetry_none, symmetry_quarter
  use material_parameters, only: material_t
  use impact_parameters, only: law_hertz, integrator_conserving
  use pressure_loads, only: distribution_sine
  use setups, only: setup_t
  use models, only: model_t
  implicit none
  private
  public :: isotropic, cross_ply_material, unit_plate, press, coupling, shaped_like

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
    !> Elements along each side of the modelled part
    integer, intent(in) :: elements
    !> True: a quarter is modelled
    logical, intent(in) :: quarter
    !> The setup
    type(setup_t) :: setup
    integer :: plies

    plies = size(angles)
    setup%mesh%kinematics = kinematics_linear
    setup%plate%length = 1
    setup%plate%edges = edge_simple
    setup%plate%symmetry = merge(symmetry_quarter, symmetry_none, quarter)
    setup%mesh%elements = elements
    setup%materials = [material]
    allocate (setup%laminate%material(plies), source=1)
    setup%laminate%angle = angles
    allocate (setup%laminate%thickness(plies), source=thickness/plies)
  end function unit_plate

  !> Adds a pressure of one half-sine along each side.
  pure subroutine press(setup, value)
    !> The setup
    class(setup_t), intent(inout) :: setup
    !> Largest pressure
    real(wp), intent(in) :: value

    setup%pressure%is_present = .true.
    setup%pressure%value = value
    setup%pressure%distribution = distribution_sine
  end subroutine press

  !> Adds an impactor on a patch of a fifth of the side.
  pure subroutine coupling(setup, mass, velocity, k)
    !> The setup
    class(setup_t), intent(inout) :: setup
    !> Mass and velocity of the impactor, contact stiffness
    real(wp), intent(in) :: mass, velocity, k

    setup%impactor%is_present = .true.
    setup%mesh%patch = 0.2_wp
    setup%impactor%mass = mass
    setup%impactor%velocity = velocity
    setup%impactor%integrator = integrator_conserving
    setup%impactor%indentation%law = law_hertz
    setup%impactor%indentation%k = k
  end subroutine coupling

  !> Deflection of m half-waves along x and n along y of a simply supported plate.
  function shaped_like(model, m, n) result(shape)
    !> The model
    type(model_t), intent(in) :: model
    !> Half-waves
    integer, intent(in) :: m, n
    !> The field, (5, points); rotations are zero
    real(wp), allocatable :: shape(:, :)
    integer :: i

    allocate (shape(5, size(model%plate%distribution%points)), source=0.0_wp)
    do i = 1, size(shape, 2)
      associate (x => model%plate%place_of(i))
        shape(3, i) = sin(m*pi*(x(1) + 0.5_wp))*sin(n*pi*(x(2) + 0.5_wp))
      end associate
    end do
    where (model%plate%constraints%fixed(:, model%plate%distribution%points)) shape = 0
  end function shaped_like
end module small_setups
