!> Nodal sums of a model: areas, pressure, patch and lumped mass.
module model_loads
  use contact_areas, only: new_contact_area
  use inertia_forces, only: add_lumped_mass
  use kinds, only: wp
  use mathematical_constants, only: pi
  use load_vectors, only: add_pressure, gauss_coordinates, add_patch_weights
  use models, only: model_t
  use pressure_loads, only: distribution_sine
  use rank_totals, only: total_of
  use stiffened_elements, only: beam_mass
  implicit none
  private
  public :: build_borders, build_loads, nodal_areas

contains

  !> Prepares the sums of elements' contributions at points on the borders between ranks.
  subroutine build_borders(self)
    !> The model, with its elements and halo
    type(model_t), intent(inout) :: self
    integer :: targets(size(self%distribution%connectivity))

    associate (partition => self%distribution)
      call self%borders%define(self%communicator, self%halo, reshape(partition%connectivity, shape(targets)), &
                               reshape(spread(partition%elements, 1, 9), shape(targets)), targets)
      call self%elements%set_targets(reshape(targets, shape(partition%connectivity)))
    end associate
  end subroutine build_borders

  !> Nodal areas of some of this rank's elements. Collective.
  function nodal_areas(self, elements) result(areas)
    !> The model, with its elements and borders
    type(model_t), intent(in) :: self
    !> Positions among this rank's elements
    integer, intent(in) :: elements(:)
    !> (local points); ghosts zero
    real(wp), allocatable :: areas(:)
    real(wp) :: field(1, self%borders%columns)

    field = 0
    call add_patch_weights(self%elements, elements, field(1, :))
    call self%borders%add(field)
    areas = field(1, :self%halo%points)
  end function nodal_areas

  !> Nodal loads of pressure and patch, and the lumped mass.
  subroutine build_loads(self)
    !> The model, with its elements and halo
    type(model_t), intent(inout) :: self
    real(wp), allocatable :: weights(:), mass(:, :)
    real(wp) :: area

    weights = struck_areas(self, self%setup%mesh%patch)
    area = total_of(self%communicator, weights)
    if (area > 0) weights = weights/area
    call self%patch%spread(weights, 0.0_wp)
    self%patch%area = self%setup%mesh%patch**2
    if (self%setup%impactor%spreads) call build_nose(self)
    if (self%setup%pressure%is_present) call build_pressure(self)
    if (allocated(self%lumped)) then
      allocate (mass(3, self%borders%columns), source=0.0_wp)
      call add_lumped_mass(self%elements, self%elements%mass, beam_mass(self%elements), mass)
      call self%borders%add(mass)
      self%lumped = mass(:, :self%halo%points)
    end if
  end subroutine build_loads

  !> Area of each point of the struck face, without ghosts. On the edge of a doubler that may come off the struck face it
  !> is that of the doubler: the step of the surface there is not modelled, and a load acts on w of the first layer.
  function struck_areas(self, patch) result(areas)
    !> The model, with its elements, borders and layers
    type(model_t), intent(in) :: self
    !> Side of the patch; left out: the area is that of the face
    real(wp), intent(in), optional :: patch
    !> (local points); ghosts zero
    real(wp), allocatable :: areas(:)
    integer :: i

    areas = nodal_areas(self, struck_elements(self, patch))
    do i = 1, size(areas)
      if (self%map%above(i) == 0 .or. .not. areas(i) > 0) cycle
      areas(self%map%above(i)) = areas(self%map%above(i)) + areas(i)
      areas(i) = 0
    end do
  end function struck_areas

  !> This rank's elements of the struck layer, ascending: those under the patch, or all.
  pure function struck_elements(self, patch) result(elements)
    type(model_t), intent(in) :: self
    !> Side of the patch; left out: all elements
    real(wp), intent(in), optional :: patch
    !> Positions among this rank's elements
    integer, allocatable :: elements(:)
    integer :: i

    associate (mesh => self%mesh, mine => self%distribution%elements)
      elements = pack([(i, i=1, size(mine))], mesh%is_top(mine))
      if (present(patch)) elements = pack(elements, [(mesh%in_patch(mesh%element_cell(mine(elements(i))), patch), &
                                                      i=1, size(elements))])
    end associate
  end function struck_elements

  !> Creates the nose over the struck face. Collective.
  subroutine build_nose(self)
    type(model_t), intent(inout) :: self
    real(wp) :: local_area(self%halo%points), area(self%mesh%points())
    integer :: local(self%mesh%points()), i

    local_area = struck_areas(self)
    area = 0
    local = 0
    associate (mesh => self%mesh, partition => self%distribution, struck => self%setup%mesh%struck)
      do i = 1, partition%owned
        area(partition%points(i)) = local_area(i)*mesh%multiplicity
        local(partition%points(i)) = i
      end do
      call self%communicator%sum(area)
      self%nose = new_contact_area(self%setup%contact_radius(), area, &
                                   [(norm2(mesh%node_coordinates(:, mesh%point_node(i)) - struck), i=1, size(area))], &
                                   local)
    end associate
  end subroutine build_nose

  !> Nodal forces of the pressure on the struck face.
  subroutine build_pressure(self)
    type(model_t), intent(inout) :: self
    real(wp), allocatable :: x(:, :, :), pressure(:, :), forces(:, :)
    integer :: element, point

    allocate (forces(5, self%borders%columns), source=0.0_wp)
    allocate (x(2, 9, self%elements%elements), pressure(9, self%elements%elements))
    associate (mesh => self%mesh, partition => self%distribution, value => self%setup%pressure%value)
      call gauss_coordinates(self%elements, mesh%node_coordinates(:, mesh%point_node(partition%points)), x)
      pressure = value
      if (self%setup%pressure%distribution == distribution_sine) then
        ! A vectorised cosine differs from the scalar one in the last digit, and which elements are vectorised depends
        ! on the rank.
        !GCC$ NOVECTOR
        do element = 1, size(pressure, 2)
          !GCC$ NOVECTOR
          do point = 1, size(pressure, 1)
            pressure(point, element) = value*cos(pi*x(1, point, element)/self%setup%plate%length(1))* &
                                       cos(pi*x(2, point, element)/self%setup%plate%length(2))
          end do
        end do
      end if
      do element = 1, size(partition%elements)
        if (.not. mesh%is_top(partition%elements(element))) pressure(:, element) = 0
      end do
    end associate
    call add_pressure(self%elements, pressure, forces)
    call self%borders%add(forces)
    self%pressure = forces(:, :self%halo%points)
    ! Where a doubler on the struck face ends, the laminate beside it is not the first layer.
    if (self%map%layered) call self%map%to_unknowns(self%pressure)
  end subroutine build_pressure
end module model_loads
