!> Nodal sums of a model: pressure, patch and lumped mass.
module model_loads
  use contact_areas, only: contact_area_t, new_contact_area
  use inertia_forces, only: add_lumped_mass
  use kinds, only: wp
  use mathematical_constants, only: pi
  use composite_plates, only: composite_plate_t
  use load_vectors, only: add_pressure, gauss_coordinates
  use models, only: model_t
  use plate_options, only: mass_lumped
  use pressure_loads, only: distribution_sine
  use rank_totals, only: total_of
  use stiffened_elements, only: beam_mass
  implicit none
  private
  public :: build_loads

contains

  !> Nodal loads of pressure and patch, and the lumped mass.
  subroutine build_loads(self)
    type(model_t), intent(inout) :: self
    real(wp), allocatable :: weights(:), mass(:, :)
    real(wp) :: area

    associate (plate => self%plate)
      weights = struck_areas(plate, plate%setup%mesh%patch)
      area = total_of(plate%communicator, weights)
      if (area > 0) weights = weights/area
      call self%patch%spread(weights, 0.0_wp)
      self%patch%area = plate%setup%mesh%patch**2
      if (plate%setup%impactor%spreads) call build_nose(plate, self%nose)
      if (plate%setup%pressure%is_present) call build_pressure(plate, self%loads%pressure)
      if (plate%setup%mesh%mass == mass_lumped) then
        allocate (mass(3, plate%borders%columns), source=0.0_wp)
        call add_lumped_mass(plate%elements, plate%elements%mass, beam_mass(plate%elements), mass)
        call plate%borders%add(mass)
        self%lumped = mass(:, :plate%halo%points)
      end if
    end associate
  end subroutine build_loads

  !> Area of each point of the struck face. Collective.
  function struck_areas(plate, patch) result(areas)
    type(composite_plate_t), intent(in) :: plate
    !> Side of the patch; left out: the area is that of the face
    real(wp), intent(in), optional :: patch
    !> (local points); ghosts zero
    real(wp), allocatable :: areas(:)
    real(wp) :: field(1, plate%halo%points)
    integer, allocatable :: elements(:)
    integer :: i

    associate (mesh => plate%mesh, mine => plate%distribution%elements)
      elements = pack([(i, i=1, size(mine))], mesh%is_top(mine))
      if (present(patch)) elements = pack(elements, [(mesh%in_patch(mesh%element_cell(mine(elements(i))), patch), &
                                                      i=1, size(elements))])
    end associate
    field(1, :) = plate%nodal_areas(elements)
    call move_to_first_layer(plate, field)
    areas = field(1, :)
  end function struck_areas

  !> Moves what acts on the struck face to the first layer. On the edge of a doubler that may come off this face the
  !> laminate beside it is the second one; the step of the surface there is not modelled.
  pure subroutine move_to_first_layer(plate, field)
    type(composite_plate_t), intent(in) :: plate
    !> Values of the points of the struck face, (rows, local points)
    real(wp), intent(inout) :: field(:, :)
    integer :: i

    do i = 1, size(field, 2)
      if (plate%map%above(i) == 0) cycle
      field(:, plate%map%above(i)) = field(:, plate%map%above(i)) + field(:, i)
      field(:, i) = 0
    end do
  end subroutine move_to_first_layer

  !> Creates the nose over the struck face. Collective.
  subroutine build_nose(plate, nose)
    type(composite_plate_t), intent(in) :: plate
    !> Area over which the contact may spread
    type(contact_area_t), allocatable, intent(out) :: nose
    real(wp) :: local_area(plate%halo%points), area(plate%mesh%points())
    integer :: local(plate%mesh%points()), i

    local_area = struck_areas(plate)
    area = 0
    local = 0
    associate (mesh => plate%mesh, partition => plate%distribution, struck => plate%setup%mesh%struck)
      do i = 1, partition%owned
        area(partition%points(i)) = local_area(i)*mesh%multiplicity
        local(partition%points(i)) = i
      end do
      call plate%communicator%sum(area)
      nose = new_contact_area(plate%setup%contact_radius(), area, &
                              [(norm2(mesh%node_coordinates(:, mesh%point_node(i)) - struck), i=1, size(area))], local)
    end associate
  end subroutine build_nose

  !> Nodal forces of the pressure on the struck face.
  subroutine build_pressure(plate, loads)
    type(composite_plate_t), intent(in) :: plate
    !> (5, local points); ghosts zero
    real(wp), allocatable, intent(out) :: loads(:, :)
    real(wp), allocatable :: x(:, :, :), pressure(:, :), forces(:, :)
    integer :: element, point

    allocate (forces(5, plate%borders%columns), source=0.0_wp)
    allocate (x(2, 9, plate%elements%elements), pressure(9, plate%elements%elements))
    associate (mesh => plate%mesh, partition => plate%distribution, value => plate%setup%pressure%value)
      call gauss_coordinates(plate%elements, mesh%node_coordinates(:, mesh%point_node(partition%points)), x)
      pressure = value
      if (plate%setup%pressure%distribution == distribution_sine) then
        ! A vectorised cosine differs from the scalar one in the last digit, and which elements are vectorised depends
        ! on the rank.
        !GCC$ NOVECTOR
        do element = 1, size(pressure, 2)
          !GCC$ NOVECTOR
          do point = 1, size(pressure, 1)
            pressure(point, element) = value*cos(pi*x(1, point, element)/plate%setup%plate%length(1))* &
                                       cos(pi*x(2, point, element)/plate%setup%plate%length(2))
          end do
        end do
      end if
      do element = 1, size(partition%elements)
        if (.not. mesh%is_top(partition%elements(element))) pressure(:, element) = 0
      end do
    end associate
    call add_pressure(plate%elements, pressure, forces)
    call plate%borders%add(forces)
    loads = forces(:, :plate%halo%points)
    call move_to_first_layer(plate, loads)
  end subroutine build_pressure
end module model_loads
