!> What the results hold of the interfaces. What belongs to an interface stands in the layer below it.
module interface_results
  use kinds, only: wp
  use front_energy_release, only: front_energy_release_t, release_along_front
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: jumps, delaminated_above, release_ahead

contains

  !> Jumps of the faces above each point's layer.
  pure function jumps(model, now)
    !> The model
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    !> Jumps of u, v and w, zero in the first layer, (3, points)
    real(wp), allocatable :: jumps(:, :)

    jumps = merge(now%motion%displacement(1:3, :), 0.0_wp, spread(model%zone > 0, 1, 3))
  end function jumps

  !> 1 in elements whose interface above has come apart.
  pure function delaminated_above(model, now) result(delaminated)
    !> The model
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    !> 1 or 0, (1, elements)
    real(wp), allocatable :: delaminated(:, :)
    integer :: zone, i, place(2)

    allocate (delaminated(1, model%elements%elements), source=0.0_wp)
    do i = 1, model%elements%elements
      associate (mesh => model%mesh, element => model%distribution%elements(i))
        place = mesh%place_of(mesh%element_cell(element))
        do zone = 1, size(mesh%zones)
          if (mesh%zones(zone)%below_ply /= mesh%element_plies(1, element) - 1) cycle
          if (now%interfaces%faces%regions(zone)%is_delaminated(place(1), place(2))) delaminated(1, i) = 1
        end do
      end associate
    end do
  end function delaminated_above

  !> Energy release rate over its critical value in the intact cells ahead of the fronts, zero elsewhere. Where a
  !> front has reached the border of its zone there is no such cell, and the last delaminated one shows it.
  function release_ahead(model, now) result(ratio)
    !> The model
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    !> G/G_c of the interface above, (1, elements)
    real(wp), allocatable :: ratio(:, :)
    type(front_energy_release_t) :: front
    integer :: zone, s, element, place(2)

    allocate (ratio(1, model%elements%elements), source=0.0_wp)
    do zone = 1, size(model%mesh%zones)
      front = release_along_front(model, now%plies%stiffness, now%interfaces%faces, now%motion, zone, &
                                  model%scene%delaminations(zone)%energy_release)
      do s = 1, size(front%segments)
        place = merge(front%segments(s)%inside, front%segments(s)%outside, front%segments(s)%at_border)
        element = model%distribution%local_element(model%mesh%element_at( &
                  model%mesh%cell_at(place(1), place(2)), model%mesh%zones(zone)%below_ply + 1))
        if (element > 0) ratio(1, element) = max(ratio(1, element), front%ratio(s))
      end do
    end do
  end function release_ahead
end module interface_results
