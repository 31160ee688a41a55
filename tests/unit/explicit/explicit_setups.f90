!> Small plates moved by central differences, for the tests of these.
module explicit_setups
  use central_difference_energies, only: book_energies
  use central_difference_parameters, only: central_difference_parameters_t
  use central_differences, only: central_difference_t
  use communicators, only: communicator_t
  use delamination_parameters, only: law_cohesive
  use errors, only: error_t
  use kinds, only: wp
  use material_parameters, only: material_t
  use mesh_parameters, only: edge_free
  use model_building, only: create_model
  use models, only: model_t
  use plate_options, only: kinematics_linear, mass_lumped
  use setups, only: setup_t
  use states, only: new_state, state_t
  implicit none
  private
  public :: explicit_run_t, laminated_plate, add_interfaces, scattered, build

  !> A plate, its state and how it is moved.
  type :: explicit_run_t
    !> The plate
    type(model_t) :: model
    !> Its state
    type(state_t) :: now
    !> What central differences know
    type(central_difference_t) :: method
  contains
    !> Puts the plate at rest.
    procedure :: begin
    !> Gives it velocities that differ from point to point.
    procedure :: shake
    !> Takes the first step, after which the ledger counts.
    procedure :: count_from
    !> Takes steps.
    procedure :: go
    !> Error of the ledger.
    procedure :: ledger_error
  end type explicit_run_t

contains

  !> A free plate of 40 mm by 30 mm of carbon and epoxy with linear strains.
  pure function laminated_plate(angles, thickness, elements) result(setup)
    !> Angles of the plies, degrees, and thickness of them all
    real(wp), intent(in) :: angles(:), thickness
    !> Elements along both sides
    integer, intent(in) :: elements(2)
    !> The setup
    type(setup_t) :: setup
    type(material_t) :: material

    material%name = 'ply'
    material%density = 1580
    material%e1 = 139.0e9_wp
    material%e2 = 9.4e9_wp
    material%g12 = 4.5e9_wp
    material%g13 = 4.5e9_wp
    material%g23 = 2.98e9_wp
    material%nu12 = 0.309_wp
    setup%kinematics = kinematics_linear
    setup%plate%length = [0.04_wp, 0.03_wp]
    setup%plate%edges = edge_free
    setup%plate%in_plane_fixed = .false.
    setup%mesh%elements = elements
    setup%mesh%mass = mass_lumped
    setup%materials = [material]
    allocate (setup%laminate%material(size(angles)), source=1)
    allocate (setup%laminate%thickness(size(angles)), source=thickness/size(angles))
    setup%laminate%angle = angles
  end function laminated_plate

  !> Holds all plies together by cohesive laws all over the plate.
  pure subroutine add_interfaces(setup, strength, toughness)
    !> The setup
    type(setup_t), intent(inout) :: setup
    !> Strength, and toughness of opening and of shear
    real(wp), intent(in) :: strength, toughness(2)
    integer :: i

    allocate (setup%delaminations(size(setup%laminate%angle) - 1))
    do i = 1, size(setup%delaminations)
      setup%delaminations(i)%below_ply = i
      setup%delaminations(i)%law = law_cohesive
      setup%delaminations(i)%strength_opening = strength
      setup%delaminations(i)%strength_shear = strength
      setup%delaminations(i)%toughness_opening = toughness(1)
      setup%delaminations(i)%toughness_shear = toughness(2)
      setup%delaminations(i)%zone = 2*setup%plate%length
    end do
  end subroutine add_interfaces

  !> A number between -1 and 1 that goes with another one.
  elemental real(wp) function scattered(number)
    !> The other number
    integer, intent(in) :: number

    scattered = sin(real(37*number, wp))
  end function scattered

  !> Builds the model of a setup.
  subroutine build(setup, model)
    !> The setup
    type(setup_t), intent(in) :: setup
    !> Its model on this rank alone
    type(model_t), intent(out) :: model
    type(communicator_t) :: alone
    type(error_t), allocatable :: error

    call create_model(setup, alone, model, error)
    if (allocated(error)) error stop 'There is no such plate.'
  end subroutine build

  !> Puts the plate at rest.
  subroutine begin(self, setup, parameters, softness)
    !> The run
    class(explicit_run_t), intent(out) :: self
    !> The setup
    type(setup_t), intent(in) :: setup
    !> How steps are taken
    type(central_difference_parameters_t), intent(in) :: parameters
    !> Part of the elements' stiffness that is left
    real(wp), intent(in), optional :: softness

    call build(setup, self%model)
    self%now = new_state(self%model)
    if (present(softness)) self%now%plies%stiffness = softness*self%now%plies%stiffness
    call self%method%start(self%model, parameters, self%now)
  end subroutine begin

  !> Gives the plate velocities that differ from point to point.
  subroutine shake(self, largest)
    !> The run
    class(explicit_run_t), intent(inout) :: self
    !> Largest velocity of layers and of jumps between them, and largest rate of rotations
    real(wp), intent(in) :: largest(2)
    integer :: i, k

    associate (points => self%model%distribution%points)
      do i = 1, size(points)
        do k = 1, 5
          if (.not. self%model%held(k, points(i))) &
            self%now%motion%velocity(k, i) = largest(merge(1, 2, k <= 3))*scattered(5*points(i) + k)
        end do
      end do
    end associate
    call self%count_from()
  end subroutine shake

  !> Takes the first step, and the energy after it for that of the start: plates begin at rest, and work in the first
  !> half step is counted for that.
  subroutine count_from(self)
    !> The run
    class(explicit_run_t), intent(inout) :: self

    call self%go(1)
    self%now%ledger%initial = 0
    self%now%ledger%initial = self%ledger_error()
  end subroutine count_from

  !> Takes steps of the length that the method chooses.
  subroutine go(self, steps, end)
    !> The run
    class(explicit_run_t), intent(inout) :: self
    !> Number of steps
    integer, intent(in) :: steps
    !> Time that no step passes; left out: far away
    real(wp), intent(in), optional :: end
    real(wp) :: event
    integer :: i

    do i = 1, steps
      event = self%now%time + 1.0e6_wp*self%method%longest_step(self%model, self%now)
      if (present(end)) event = end
      call self%method%advance(self%model, event, self%now)
    end do
  end subroutine go

  !> Error of the ledger in the present state.
  real(wp) function ledger_error(self) result(error)
    !> The run
    class(explicit_run_t), intent(inout) :: self

    call book_energies(self%method, self%model, self%now)
    error = self%now%ledger%error()
  end function ledger_error
end module explicit_setups
