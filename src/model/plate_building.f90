!> Builds the plate of a setup: mesh, elements and interfaces on this rank.
module plate_building
  use batch_strains, only: set_initial_shape, set_surface
  use communicators, only: communicator_t
  use composite_plates, only: composite_plate_t
  use distributions, only: distribute
  use errors, only: error_t
  use interface_laws, only: new_interface_laws
  use kinds, only: wp
  use layer_maps, only: create_layer_map
  use layered_meshes, only: create_mesh
  use layered_zones, only: zones_of
  use mesh_parameters, only: curvatures, initial_deflection, is_flat
  use placed_stringers, only: place_stringers
  use plate_constraints, only: new_constraints
  use setups, only: setup_t
  use stacking, only: section_t
  use struck_points, only: new_struck_point
  implicit none
  private
  public :: create_plate

contains

  !> Builds the plate of a setup. Collective.
  subroutine create_plate(setup, communicator, self, error)
    !> The setup; it has passed the deck's checks
    type(setup_t), intent(in) :: setup
    type(communicator_t), intent(in) :: communicator
    type(composite_plate_t), intent(out) :: self
    !> Set if the mesh cannot be distributed or an element is ill-shaped; the same on every rank
    type(error_t), allocatable, intent(out) :: error
    integer, allocatable :: laminate_of(:)
    integer :: ply

    self%setup = setup
    self%communicator = communicator
    call self%layup%find_laminates(setup, laminate_of)
    associate (plies => size(self%layup%laminates(1)%plies))
      self%mesh = create_mesh(setup%plate, setup%mesh, plies, zones_of(setup), laminate_of, &
                              [[(ply, ply=1, plies)], setup%zones%stations(plies)])
    end associate
    self%constraints = new_constraints(setup, self%mesh, self%layup%section)
    call distribute(self%mesh, communicator, self%distribution, error, &
                    self%constraints%images%first_cells(self%mesh))
    if (.not. allocated(error)) call build_elements(self, error)
    call communicator%agree(error)
    if (allocated(error)) return
    associate (partition => self%distribution)
      call self%halo%define(communicator, partition%owned, &
                            1 + partition%number(partition%points(partition%owned + 1:)), error)
    end associate
    if (allocated(error)) return
    call build_borders(self)
    call build_interfaces(self)
    self%struck = new_struck_point(self%mesh, self%distribution, communicator)
  end subroutine create_plate

  !> Batches of this rank's elements, with their sections.
  subroutine build_elements(self, error)
    !> The plate, with its mesh distributed
    type(composite_plate_t), intent(inout) :: self
    !> Set if an element is ill-shaped
    type(error_t), allocatable, intent(inout) :: error
    type(section_t), allocatable :: sections(:)
    real(wp), allocatable :: places(:, :)
    integer :: element, i

    associate (mesh => self%mesh, partition => self%distribution, layup => self%layup)
      call layup%assign_stacks(mesh, partition%elements, self%setup%thermal%is_present)
      sections = [(layup%stacks(i)%section(), i=1, size(layup%stacks))]
      places = mesh%node_coordinates(:, mesh%point_node(partition%points))
      call self%elements%create(places, partition%connectivity, self%setup%mesh%shear, error)
      if (allocated(error)) return
      if (.not. is_flat(self%setup%plate)) call build_shape(self, places)
      do element = 1, size(partition%elements)
        associate (section => sections(layup%stack(element)))
          call self%elements%set_section(element, section%stiffness, section%mass)
        end associate
      end do
    end associate
    call place_stringers(self)
  end subroutine build_elements

  !> Shape of a plate that is not flat. Displacements are measured along its curved surface; an imperfection is too
  !> small for a difference.
  subroutine build_shape(self, places)
    !> The plate, with its elements
    type(composite_plate_t), intent(inout) :: self
    !> Coordinates of this rank's points from the plate's centre, (2, points)
    real(wp), intent(in) :: places(:, :)
    integer :: point

    associate (plate => self%setup%plate)
      call set_initial_shape(self%elements, [(initial_deflection(plate, places(:, point)), point=1, size(places, 2))])
      if (any(abs(plate%curvature_radius) > 0)) &
        call set_surface(self%elements, spread(curvatures(plate), 2, size(places, 2))*places)
    end associate
  end subroutine build_shape

  !> Prepares the sums of elements' contributions at points on the borders between ranks.
  subroutine build_borders(self)
    !> The plate, with its elements and halo
    type(composite_plate_t), intent(inout) :: self
    integer :: targets(size(self%distribution%connectivity))

    associate (partition => self%distribution)
      call self%borders%define(self%communicator, self%halo, reshape(partition%connectivity, shape(targets)), &
                               reshape(spread(partition%elements, 1, 9), shape(targets)), targets)
      call self%elements%set_targets(reshape(targets, shape(partition%connectivity)))
    end associate
  end subroutine build_borders

  !> Layers and the interfaces between them.
  subroutine build_interfaces(self)
    !> The plate, with its elements and borders
    type(composite_plate_t), intent(inout) :: self
    real(wp) :: areas(1, size(self%distribution%points))
    integer :: i

    associate (mesh => self%mesh, partition => self%distribution, plies => self%layup%laminates(1)%plies)
      self%map = create_layer_map(mesh, partition, plies(mesh%zones%below_ply)%z_bottom)
      self%zone = mesh%point_zone(partition%points)
      areas = 0
      if (self%map%layered) then
        areas(1, :) = self%nodal_areas(pack([(i, i=1, self%elements%elements)], .not. mesh%is_top(partition%elements)))
        call self%halo%update(areas)
        where (self%zone == 0) areas(1, :) = 0
      end if
      self%interfaces = new_interface_laws(self%setup, mesh, plies, partition%points, areas(1, :))
    end associate
  end subroutine build_interfaces
end module plate_building
