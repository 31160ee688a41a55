!> Plates with an interface partly delaminated, at rest under given forces, for the tests of energy release rates.
module cracked_plates
  use kinds, only: wp
  use errors, only: error_t
  use mpi_f08, only: MPI_COMM_SELF
  use communicators, only: communicator_from_handle
  use plate_options, only: kinematics_linear
  use element_batches, only: lanes
  use mesh_parameters, only: edge_free, edge_clamped, symmetry_none, symmetry_quarter
  use material_parameters, only: material_t
  use delamination_parameters, only: contact_none
  use front_energy_release, only: front_energy_release_t, release_along_front
  use stepped_setups, only: stepped_setup_t, build_model
  use models, only: model_t
  use states, only: state_t, new_state
  use tangent_operators, only: tangent_operator_t
  use static_steps, only: static_step_t, new_static_step
  use step_problems, only: solve_step
  use stepping_parameters, only: equilibrium_t
  use linear_solver_parameters, only: factorization_mumps
  implicit none
  private
  public :: cracked_plate_t, strip, disc, front_mean

  !> A plate and its state under the forces in model%pressure.
  type :: cracked_plate_t
    !> The model
    type(model_t) :: model
    !> Its state
    type(state_t) :: state
    !> The operator
    type(tangent_operator_t) :: operator
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Required convergence
    type(equilibrium_t) :: equilibrium
  contains
    !> Builds the model of a setup, without forces and delaminated cells.
    procedure :: create
    !> Delaminates cells.
    procedure :: release
    !> Adds a force along a line of nodes across the strip.
    procedure :: pull
    !> Adds a force on the patch, half of it on the lower layer.
    procedure :: coupling
    !> Softens the layers of all cells of some columns.
    procedure :: soften
    !> Finds equilibrium.
    procedure :: equilibrate
    !> Strain energy of the modelled part.
    procedure :: energy
    !> Energy release rates along the front.
    procedure :: rates
  end type cracked_plate_t

contains

  !> A strip along x, clamped at its far end, with linear strains; its first ply is the upper arm.
  pure function strip(materials, angles, thickness, below_ply, length, width, elements) result(setup)
    !> Materials, of which all plies have the first
    type(material_t), intent(in) :: materials(:)
    !> Angle and thickness of each ply
    real(wp), intent(in) :: angles(:), thickness(:)
    !> Plies of the upper arm
    integer, intent(in) :: below_ply
    !> Length and width
    real(wp), intent(in) :: length, width
    !> Cells along the strip, an even number
    integer, intent(in) :: elements
    !> The setup
    type(stepped_setup_t) :: setup

    setup = layered(materials, angles, thickness, below_ply)
    setup%plate%length = [length, width]
    setup%plate%edges = [edge_free, edge_clamped, edge_free, edge_free]
    setup%plate%symmetry = symmetry_none
    setup%mesh%elements = [elements, 1]
    setup%delaminations%zone(1) = 2*length
    setup%delaminations%zone(2) = 2*width
  end function strip

  !> A quarter of a clamped square of two equal plies, loaded on a square patch in its middle.
  pure function disc(material, thickness, side, patch, elements) result(setup)
    !> The material
    type(material_t), intent(in) :: material
    !> Thickness, side, and side of the patch
    real(wp), intent(in) :: thickness, side, patch
    !> Cells along half a side
    integer, intent(in) :: elements
    !> The setup
    type(stepped_setup_t) :: setup

    setup = layered([material], [0.0_wp, 0.0_wp], [thickness, thickness]/2, 1)
    setup%plate%length = side
    setup%plate%edges = edge_clamped
    setup%plate%symmetry = symmetry_quarter
    setup%mesh%elements = elements
    setup%mesh%patch = patch
    setup%mesh%grading = 1
    setup%delaminations%zone(1) = 0.9_wp*side
    setup%delaminations%zone(2) = 0.9_wp*side
  end function disc

  !> A laminate with one interface, all intact.
  pure function layered(materials, angles, thickness, below_ply) result(setup)
    !> Materials, of which all plies have the first
    type(material_t), intent(in) :: materials(:)
    !> Angle and thickness of each ply
    real(wp), intent(in) :: angles(:), thickness(:)
    !> Plies above the interface
    integer, intent(in) :: below_ply
    !> The setup, without plate and mesh
    type(stepped_setup_t) :: setup

    setup%kinematics = kinematics_linear
    allocate (setup%materials, source=materials)
    allocate (setup%laminate%material(size(angles)), source=1)
    allocate (setup%laminate%angle, source=angles)
    allocate (setup%laminate%thickness, source=thickness)
    setup%has_static = .true.
    setup%has_pressure = .true.
    setup%stepping%equilibrium%tolerance = 1.0e-9_wp
    allocate (setup%delaminations(1))
    setup%delaminations%below_ply = below_ply
    setup%delaminations%toughness = 1
    setup%delaminations%contact = contact_none
  end function layered

  !> Builds the model of a setup, without forces and delaminated cells.
  subroutine create(self, setup)
    class(cracked_plate_t), intent(out) :: self
    type(stepped_setup_t), intent(in) :: setup
    type(error_t), allocatable :: error

    ! These tests run on one process also where there are more.
    call build_model(setup, communicator_from_handle(MPI_COMM_SELF%mpi_val), self%model, error)
    if (allocated(error)) error stop 'no model'
    self%model%pressure = 0
    self%state = new_state(self%model)
    self%stiffness = self%model%elements%stiffness
    self%equilibrium = setup%stepping%equilibrium
    call self%operator%create(self%model, factorization_mumps, error)
    if (allocated(error)) error stop 'no operator'
  end subroutine create

  !> Delaminates all cells of a range of columns and rows whose middle is within a radius of the origin.
  subroutine release(self, columns, rows, radius)
    class(cracked_plate_t), intent(inout) :: self
    integer, intent(in) :: columns(2), rows(2)
    real(wp), intent(in) :: radius
    integer, allocatable :: nodes(:)
    integer :: i, j

    associate (mesh => self%model%mesh, region => self%state%interfaces%faces%regions(1))
      do j = rows(1), rows(2)
        do i = columns(1), columns(2)
          nodes = mesh%cell_nodes(mesh%cell_at(i, j))
          if (norm2(mesh%node_coordinates(:, nodes(5))) < radius) call region%release([i, j])
        end do
      end do
    end associate
    call self%state%interfaces%faces%free_jumps(self%model)
  end subroutine release

  !> Adds a force along a line of nodes across the strip.
  subroutine pull(self, line, component, force, lower)
    class(cracked_plate_t), intent(inout) :: self
    !> Line of nodes, from 0
    integer, intent(in) :: line
    !> Unknown it acts on
    integer, intent(in) :: component
    !> Force
    real(wp), intent(in) :: force
    !> True: acts on the unknowns of the lower layer, for u, v, w its jumps
    logical, intent(in) :: lower
    integer :: j, point

    associate (mesh => self%model%mesh, share => self%model%distribution)
      do j = 0, 2
        associate (node => mesh%node_at(line, j))
          point = mesh%first_point(node)
          if (lower) point = mesh%lower_point(node, 1)
        end associate
        associate (load => self%model%pressure(component, share%local(point)))
          load = load + force*merge(4, 1, j == 1)/6
        end associate
      end do
    end associate
  end subroutine pull

  !> Adds a force on the patch, half of it on the lower layer so that the faces neither part nor meet.
  subroutine coupling(self, force)
    class(cracked_plate_t), intent(inout) :: self
    real(wp), intent(in) :: force
    integer :: node, upper, lower

    associate (model => self%model)
      do node = 1, model%mesh%nodes()
        upper = model%distribution%local(model%mesh%first_point(node))
        if (.not. abs(model%patch(upper)) > 0) cycle
        lower = model%distribution%local(model%mesh%lower_point(node, 1))
        model%pressure(3, upper) = force/model%mesh%multiplicity*model%patch(upper)
        model%pressure(3, lower) = model%pressure(3, upper)/2
      end do
    end associate
  end subroutine coupling

  !> Softens the layers of all cells of some columns.
  subroutine soften(self, columns, factor)
    class(cracked_plate_t), intent(inout) :: self
    integer, intent(in) :: columns(2)
    !> New stiffness over that before
    real(wp), intent(in) :: factor
    integer :: e, column, row

    associate (model => self%model)
      do e = 1, size(model%distribution%elements)
        do column = columns(1), columns(2)
          do row = 1, model%mesh%cells(2)
            if (model%mesh%element_cell(model%distribution%elements(e)) /= model%mesh%cell_at(column, row)) cycle
            associate (values => self%stiffness(1 + modulo(e - 1, lanes), :, 1 + (e - 1)/lanes))
              values = factor*values
            end associate
          end do
        end do
      end do
    end associate
  end subroutine soften

  !> Finds equilibrium from rest.
  subroutine equilibrate(self)
    class(cracked_plate_t), intent(inout) :: self
    type(state_t) :: rest
    type(static_step_t) :: problem
    type(error_t), allocatable :: error
    logical :: converged

    rest = new_state(self%model)
    rest%interfaces%faces = self%state%interfaces%faces
    rest%plies%stiffness = self%stiffness
    ! Steps take plies over where the deck has them fail, and here none does.
    self%state%plies%stiffness = self%stiffness
    problem = new_static_step(self%model, 1.0_wp, 1.0_wp)
    call solve_step(problem, self%model, self%equilibrium, self%operator, rest, self%state, converged, error)
    if (allocated(error) .or. .not. converged) error stop 'no equilibrium'
  end subroutine equilibrate

  !> Strain energy of the modelled part.
  real(wp) function energy(self)
    class(cracked_plate_t), intent(in) :: self

    energy = self%state%ledger%strain/self%model%mesh%multiplicity
  end function energy

  !> Energy release rates along the front.
  function rates(self, method) result(front)
    class(cracked_plate_t), intent(in) :: self
    integer, intent(in) :: method
    type(front_energy_release_t) :: front

    front = release_along_front(self%model, self%stiffness, self%state%interfaces%faces, self%state%motion, 1, method)
  end function rates

  !> Mean rate over the length of the smooth line of a front.
  pure real(wp) function front_mean(front) result(mean)
    type(front_energy_release_t), intent(in) :: front

    mean = sum(sum(front%modes, dim=1)*front%line%length)/sum(front%line%length)
  end function front_mean
end module cracked_plates
