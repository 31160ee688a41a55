!> What the fields file holds of the interfaces. What belongs to an interface stands in the layer below it.
module interface_results
  use kinds, only: wp
  use errors, only: error_t
  use front_releases, only: front_release_t, release_along_front
  use models, only: model_t
  use marches, only: march_t
  use output_parameters, only: output_t
  use fields_file, only: fields_file_t
  implicit none
  private
  public :: write_interfaces

contains

  !> Writes jumps, contact pressure, delaminated cells and energy release rates, as far as they are wanted.
  subroutine write_interfaces(model, march, output, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> Which of them
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: jumps(:, :), pressure(:, :)
    integer :: i

    associate (owned => model%distribution%owned)
      allocate (jumps(3, owned), pressure(1, owned), source=0.0_wp)
      do i = 1, owned
        if (model%zone(i) == 0) cycle
        jumps(:, i) = march%now%motion%displacement(1:3, i)
        pressure(1, i) = march%now%separation%pressure(i)
      end do
    end associate
    if (output%wants('gap')) call fields%write_point_field('jump', jumps, error)
    if (output%wants('contact_pressure')) call fields%write_point_field('contact_pressure', pressure, error)
    if (output%wants('delamination')) &
      call fields%write_cell_field('delaminated_above', delaminated_above(model, march), error)
    if (output%wants('energy_release')) &
      call fields%write_cell_field('energy_release_above', release_ahead(model, march), error)
  end subroutine write_interfaces

  !> 1 in elements whose interface above has come apart.
  pure function delaminated_above(model, march) result(delaminated)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> 1 or 0, (1, elements)
    real(wp), allocatable :: delaminated(:, :)
    integer :: zone, i, cell

    allocate (delaminated(1, model%elements%elements), source=0.0_wp)
    do i = 1, model%elements%elements
      associate (mesh => model%mesh, element => model%distribution%elements(i))
        cell = mesh%element_cell(element) - 1
        do zone = 1, size(mesh%zones)
          if (mesh%zones(zone)%below_ply /= mesh%element_plies(1, element) - 1) cycle
          if (march%now%separation%regions(zone)%is_delaminated(1 + modulo(cell, mesh%cells(1)), &
                                                                1 + cell/mesh%cells(1))) delaminated(1, i) = 1
        end do
      end associate
    end do
  end function delaminated_above

  !> Energy release rate over its critical value in the intact cells ahead of the fronts, zero elsewhere. Where a
  !> front has reached the border of its zone there is no such cell, and the last delaminated one shows it.
  function release_ahead(model, march) result(ratio)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> G/G_c of the interface above, (1, elements)
    real(wp), allocatable :: ratio(:, :)
    type(front_release_t) :: front
    integer :: zone, s, element, place(2)

    allocate (ratio(1, model%elements%elements), source=0.0_wp)
    do zone = 1, size(model%mesh%zones)
      front = release_along_front(model, march%now%separation, march%now%motion, zone, &
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
