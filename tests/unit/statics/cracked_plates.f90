!> Plates with an interface partly delaminated, at rest under given forces, for the tests of energy release rates.
module cracked_plates
  use kinds, only: wp
  use errors, only: error_t
  use mpi_f08, only: MPI_COMM_SELF
  use communicators, only: communicator_from_handle
  use element_batches, only: lanes
  use front_energy_release, only: front_energy_release_t, release_along_front
  use layered_plates, only: release_cells
  use model_building, only: create_model
  use models, only: model_t
  use setups, only: setup_t
  use states, only: state_t, new_state
  use tangent_operators, only: tangent_operator_t
  use static_steps, only: static_step_t, new_static_step
  use step_problems, only: solve_step
  use stepping_parameters, only: equilibrium_t
  use linear_solver_parameters, only: factorization_mumps
  implicit none
  private
  public :: cracked_plate_t, front_mean

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
    !> Required convergence tolerance
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
    !> Reduces the stiffness of the layers of all cells of some columns.
    procedure :: soften
    !> Finds equilibrium.
    procedure :: equilibrate
    !> Strain energy of the modelled part.
    procedure :: energy
    !> Energy release rates along the front.
    procedure :: rates
  end type cracked_plate_t

contains

  !> Builds the model of a setup, without forces and delaminated cells.
  subroutine create(self, setup)
    class(cracked_plate_t), intent(out) :: self
    type(setup_t), intent(in) :: setup
    type(error_t), allocatable :: error

    ! These tests run on one process also where there are more.
    call create_model(setup, communicator_from_handle(MPI_COMM_SELF%mpi_val), self%model, error)
    if (allocated(error)) error stop 'no model'
    self%model%loads%pressure = 0
    self%state = new_state(self%model)
    self%stiffness = self%model%plate%elements%stiffness
    self%equilibrium%tolerance = 1.0e-9_wp
    call self%operator%create(self%model, factorization_mumps, error)
    if (allocated(error)) error stop 'no operator'
  end subroutine create

  !> Delaminates the cells of a range of columns and rows whose centres are within a radius of the origin.
  subroutine release(self, columns, rows, radius)
    class(cracked_plate_t), intent(inout) :: self
    integer, intent(in) :: columns(2), rows(2)
    real(wp), intent(in) :: radius

    call release_cells(self%model%plate, self%state%interfaces%contact, columns, rows, radius)
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
    !> True: acts on the unknowns of the lower layer, for u, v, w on its jumps
    logical, intent(in) :: lower
    integer :: j, point

    associate (mesh => self%model%plate%mesh, share => self%model%plate%distribution)
      do j = 0, 2
        associate (node => mesh%node_at(line, j))
          point = mesh%first_point(node)
          if (lower) point = mesh%lower_point(node, 1)
        end associate
        associate (load => self%model%loads%pressure(component, share%local(point)))
          load = load + force*merge(4, 1, j == 1)/6
        end associate
      end do
    end associate
  end subroutine pull

  !> Adds a force on the patch, half of it on the lower layer so that the faces neither open nor close.
  subroutine coupling(self, force)
    class(cracked_plate_t), intent(inout) :: self
    real(wp), intent(in) :: force
    integer :: node, upper, lower

    associate (model => self%model)
      do node = 1, model%plate%mesh%nodes()
        upper = model%plate%distribution%local(model%plate%mesh%first_point(node))
        if (.not. abs(model%patch%weights(upper)) > 0) cycle
        lower = model%plate%distribution%local(model%plate%mesh%lower_point(node, 1))
        model%loads%pressure(3, upper) = force/model%plate%mesh%multiplicity*model%patch%weights(upper)
        model%loads%pressure(3, lower) = model%loads%pressure(3, upper)/2
      end do
    end associate
  end subroutine coupling

  !> Reduces the stiffness of the layers of all cells of some columns.
  subroutine soften(self, columns, factor)
    class(cracked_plate_t), intent(inout) :: self
    integer, intent(in) :: columns(2)
    !> New stiffness over that before
    real(wp), intent(in) :: factor
    integer :: e, column, row

    associate (model => self%model)
      do e = 1, size(model%plate%distribution%elements)
        do column = columns(1), columns(2)
          do row = 1, model%plate%mesh%cells(2)
            if (model%plate%mesh%element_cell(model%plate%distribution%elements(e)) &
                /= model%plate%mesh%cell_at(column, row)) cycle
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
    rest%interfaces%contact = self%state%interfaces%contact
    rest%plies%stiffness = self%stiffness
    ! Steps take over the plies' data if the deck has ply failure; here there is none.
    self%state%plies%stiffness = self%stiffness
    problem = new_static_step(self%model%plate, 1.0_wp, 1.0_wp)
    call solve_step(problem, self%model, self%equilibrium, self%operator, rest, self%state, converged, error)
    if (allocated(error) .or. .not. converged) error stop 'no equilibrium'
  end subroutine equilibrate

  !> Strain energy of the modelled part.
  real(wp) function energy(self)
    class(cracked_plate_t), intent(in) :: self

    energy = self%state%ledger%strain/self%model%plate%mesh%multiplicity
  end function energy

  !> Energy release rates along the front.
  function rates(self, method) result(front)
    class(cracked_plate_t), intent(in) :: self
    integer, intent(in) :: method
    type(front_energy_release_t) :: front

    front = release_along_front(self%model%plate, self%stiffness, self%state%interfaces%contact, self%state%motion, &
                                1, method)
  end function rates

  !> Mean rate over the length of the smooth line of a front.
  pure real(wp) function front_mean(front) result(mean)
    type(front_energy_release_t), intent(in) :: front

    mean = sum(sum(front%modes, dim=1)*front%line%length)/sum(front%line%length)
  end function front_mean
end module cracked_plates
