!> Small plates moved by central differences, for their tests.
module explicit_setups
  use central_difference_energies, only: record_energies
  use central_difference_parameters, only: central_difference_parameters_t
  use central_differences, only: central_difference_t
  use kinds, only: wp
  use laminated_plates, only: build, scattered
  use models, only: model_t
  use setups, only: setup_t
  use states, only: new_state, state_t
  implicit none
  private
  public :: explicit_run_t

  !> A plate, its state and its integrator.
  type :: explicit_run_t
    !> The plate
    type(model_t) :: model
    !> Its state
    type(state_t) :: now
    !> Data of the integrator
    type(central_difference_t) :: method
  contains
    !> Sets the plate at rest.
    procedure :: begin
    !> Sets velocities that vary from point to point.
    procedure :: shake
    !> Takes the first step, from which the ledger is counted.
    procedure :: count_from
    !> Takes steps.
    procedure :: go
    !> Error of the ledger.
    procedure :: ledger_error
  end type explicit_run_t

contains

  !> Sets the plate at rest.
  subroutine begin(self, setup, parameters, softness)
    !> The run
    class(explicit_run_t), intent(out) :: self
    !> The setup
    type(setup_t), intent(in) :: setup
    !> Parameters of the steps
    type(central_difference_parameters_t), intent(in) :: parameters
    !> Fraction of the elements' stiffness retained
    real(wp), intent(in), optional :: softness

    call build(setup, self%model)
    self%now = new_state(self%model)
    if (present(softness)) self%now%plies%stiffness = softness*self%now%plies%stiffness
    call self%method%start(self%model, parameters, self%now)
  end subroutine begin

  !> Sets velocities that vary from point to point.
  subroutine shake(self, largest)
    !> The run
    class(explicit_run_t), intent(inout) :: self
    !> Largest velocity of layers and of jumps between them, and largest rate of rotations
    real(wp), intent(in) :: largest(2)
    integer :: i, k

    associate (points => self%model%plate%distribution%points)
      do i = 1, size(points)
        do k = 1, 5
          if (.not. self%model%plate%constraints%fixed(k, points(i))) &
            self%now%motion%velocity(k, i) = largest(merge(1, 2, k <= 3))*scattered(5*points(i) + k)
        end do
      end do
    end associate
    call self%count_from()
  end subroutine shake

  !> Takes the first step and sets the initial energy to that after it: plates start from rest, and the ledger counts
  !> work in the first half step for that state.
  subroutine count_from(self)
    !> The run
    class(explicit_run_t), intent(inout) :: self

    call self%go(1)
    self%now%ledger%initial = 0
    self%now%ledger%initial = self%ledger_error()
  end subroutine count_from

  !> Takes steps of the length that the method chooses.
  subroutine go(self, steps, end, kept)
    !> The run
    class(explicit_run_t), intent(inout) :: self
    !> Number of steps
    integer, intent(in) :: steps
    !> Time at which steps end; absent: far away
    real(wp), intent(in), optional :: end
    !> Fraction of the velocities that damping leaves before each step; absent: 1
    real(wp), intent(in), optional :: kept
    real(wp) :: event, left
    integer :: i

    left = 1
    if (present(kept)) left = kept
    do i = 1, steps
      event = self%now%time + 1.0e6_wp*self%method%longest_step(self%model%plate, self%now)
      if (present(end)) event = end
      call self%method%advance(self%model, event, left, self%now)
    end do
  end subroutine go

  !> Error of the ledger in the present state.
  real(wp) function ledger_error(self) result(error)
    !> The run
    class(explicit_run_t), intent(inout) :: self

    call record_energies(self%method, self%model, self%now)
    error = self%now%ledger%error()
  end function ledger_error
end module explicit_setups
