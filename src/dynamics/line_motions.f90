!> Prescribed motion of lines in a run in time.
!>
!> Springs enforce the displacement at the end of each step by a force that is constant over the step, for any
!> integrator, as in contact. Velocity and acceleration are prescribed, too: Newmark's formulas applied to the
!> displacements would give values that alternate about the prescribed ones from step to step, undamped for a spectral
!> radius of 1.
module line_motions
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use models, only: model_t
  use motions, only: motion_t
  implicit none
  private
  public :: prescribe_lines, has_moved_lines, move_lines

  !> Derivatives of the displacement.
  integer, parameter, public :: line_displacement = 1, line_velocity = 2, line_acceleration = 3

contains

  !> True: the deck prescribes lines.
  pure logical function has_moved_lines(model)
    type(model_t), intent(in) :: model
    integer :: i

    has_moved_lines = any([(model%loads%lines(i)%load%prescribed, i=1, size(model%loads%lines))])
  end function has_moved_lines

  !> Sets displacement, velocity or acceleration of the lines at a time. Jumps and constrained unknowns are unchanged.
  subroutine prescribe_lines(model, interfaces, time, derivative, field)
    type(model_t), intent(in) :: model
    !> State of the interfaces, with the tied jumps
    type(interface_state_t), intent(in) :: interfaces
    real(wp), intent(in) :: time
    !> line_displacement, line_velocity or line_acceleration
    integer, intent(in) :: derivative
    !> The field, (5, points), ghosts up to date
    real(wp), contiguous, intent(inout) :: field(:, :)
    real(wp), allocatable :: change(:, :)
    real(wp) :: values(3)
    integer :: i, place

    allocate (change, source=field)
    ! Rotations and upper layers first, as displacements of lower layers contain them.
    do place = 0, 1 + maxval([0, model%loads%lines%load%layer])
      do i = 1, size(model%loads%lines)
        associate (line => model%loads%lines(i))
          if (.not. line%load%prescribed) cycle
          if (place /= merge(1 + line%load%layer, 0, line%load%component <= 3)) cycle
          values = line%load%motion_at(time, model%plate%setup%loading%ramp_time)
          call line%move_to(values(derivative), change)
        end associate
      end do
    end do
    change = change - field
    where (model%plate%constraints%fixed(:, model%plate%distribution%points)) change = 0
    call interfaces%contact%constrain_correction(model%plate, change)
    call model%plate%halo%update(change)
    field = field + change
  end subroutine prescribe_lines

  !> Sets velocity and acceleration of the lines at a time, and returns the change of kinetic energy, which is work of
  !> their reactions.
  subroutine move_lines(model, interfaces, time, motion, work)
    type(model_t), intent(in) :: model
    !> State of the interfaces, with the tied jumps
    type(interface_state_t), intent(in) :: interfaces
    real(wp), intent(in) :: time
    !> The motion at that time, with its momentum
    type(motion_t), intent(inout) :: motion
    !> Change of the kinetic energy of the full plate
    real(wp), intent(out) :: work
    real(wp), allocatable :: change(:, :), momentum(:, :)

    allocate (change, source=motion%velocity)
    allocate (momentum, mold=motion%velocity)
    call prescribe_lines(model, interfaces, time, line_velocity, motion%velocity)
    change = motion%velocity - change
    call model%inertia(change, momentum)
    work = model%plate%product(change, motion%momentum) + model%plate%product(change, momentum)/2
    call model%plate%communicator%sum(work)
    work = work*model%plate%mesh%multiplicity
    motion%momentum = motion%momentum + momentum
    call prescribe_lines(model, interfaces, time, line_acceleration, motion%acceleration)
    call model%inertia(motion%acceleration, motion%inertia)
  end subroutine move_lines
end module line_motions
