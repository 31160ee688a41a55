!> Distinguishes an unstable motion by central differences from a stable one.
module unstable_motions
  use errors, only: error_t, exit_convergence, fail
  use kinds, only: wp
  use models, only: model_t
  use short_numbers, only: short_text
  use states, only: state_t
  use text, only: rounded_text, to_text
  implicit none
  private
  public :: check_stability

  !> Ratio of the energy error to the largest energy so far above which a run ends. The present energy is no reference:
  !> it returns to zero in free vibration. An unstable mode grows exponentially, so the exact value is not important.
  !> The check of the ledger warns from a tenth of it, 1 %.
  real(wp), parameter :: max_energy_error = 0.1_wp

contains

  !> Sets an error if the energy error shows unstable growth. Collective.
  subroutine check_stability(model, now, error)
    type(model_t), intent(in) :: model
    !> The state, with its ledger
    type(state_t), intent(in) :: now
    !> Set if the motion is unstable; the same on every rank
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: created, energy
    character(len=:), allocatable :: amount

    created = now%ledger%error()
    energy = now%ledger%largest + now%ledger%residual
    if (created <= max_energy_error*energy .and. abs(created) <= huge(created)) return
    amount = 'the energy has become infinite'
    if (abs(created) <= huge(created)) &
      amount = rounded_text(created)//' of energy have been created, of a total of '//rounded_text(energy)
    call fail(error, exit_convergence, 'Central differences have become unstable by time '//rounded_text(now%time)// &
              ': '//amount//'; the largest velocity is '//fastest_point(model, now%motion%velocity)// &
              '. Take a smaller &time step_factor.')
  end subroutine check_stability

  !> Point of the largest transverse velocity. Collective.
  function fastest_point(model, velocity) result(place)
    type(model_t), intent(in) :: model
    !> Rates of the unknowns, (5, points)
    real(wp), intent(in) :: velocity(:, :)
    !> Coordinates and layer
    character(len=:), allocatable :: place
    real(wp), allocatable :: rates(:)
    real(wp) :: largest
    integer :: i, point

    associate (partition => model%distribution)
      rates = abs(velocity(3, :partition%owned))
      where (.not. rates <= huge(rates)) rates = huge(rates)
      largest = maxval(rates)
      call model%communicator%maximum(largest)
      point = huge(point)
      do i = 1, partition%owned
        if (rates(i) >= largest) point = min(point, partition%points(i))
      end do
    end associate
    call model%communicator%minimum(point)
    associate (node => model%mesh%point_node(point))
      place = 'at x = '//short_text(model%mesh%node_coordinates(1, node))//', y = '// &
              short_text(model%mesh%node_coordinates(2, node))//', layer '// &
              to_text(point - model%mesh%first_point(node) + 1)
    end associate
  end function fastest_point
end module unstable_motions
