!> Builds the model of a setup: mesh, elements, loads and interfaces on this rank.
module model_building
  use kinds, only: wp
  use errors, only: error_t
  use communicators, only: communicator_t
  use element_batches, only: lanes, lane_of, batch_of
  use batch_strains, only: set_initial_shape, set_surface
  use free_strains, only: free_resultants
  use idle_membranes, only: is_membrane_idle
  use plate_options, only: mass_lumped
  use mean_stiffnesses, only: in_bending
  use ply_stacks, only: ply_stack_t
  use stacking, only: section_t, section_of
  use mesh_parameters, only: edge_free, in_plane_fixed, in_plane_free, in_plane_tangential, curvatures, &
                             initial_deflection, is_flat, plate_t, symmetry_quarter
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use layered_meshes, only: zone_t, layered_mesh_t, create_mesh
  use layer_maps, only: create_layer_map
  use surface_contact, only: create_contact_law
  use cohesive_laws, only: create_cohesive_law
  use delamination_parameters, only: contact_augmented_lagrangian, law_cohesive, toughnesses
  use distributions, only: distribute
  use supports, only: fixed_unknowns
  use rig_models, only: new_rig_model, fix_by_rigs
  use line_loads, only: along_y
  use placed_lines, only: place_line
  use placed_stringers, only: place_stringers, stiffness_on_line
  use model_loads, only: build_borders, build_loads, nodal_areas
  use models, only: model_t
  use setups, only: setup_t
  use symmetry_images, only: find_images
  use layered_zones, only: find_heights, zones_of
  implicit none
  private
  public :: create_model, unrestrained

  !> Stiffness of a rigid frame where its edge crosses a cell, relative to that of the laminate through its thickness:
  !> its effect on the deflection is far below round-off and tolerance, and the conditioning of the matrix is that of
  !> tied jumps.
  real(wp), parameter :: rigid = 1.0e3_wp

contains

  !> Builds the model of a setup.
  subroutine create_model(setup, communicator, self, error)
    !> The setup; it has passed the deck's checks
    type(setup_t), intent(in) :: setup
    type(communicator_t), intent(in) :: communicator
    type(model_t), intent(out) :: self
    !> Set if the mesh cannot be distributed or an element is ill-shaped; the same on every rank
    type(error_t), allocatable, intent(out) :: error
    type(zone_t), allocatable :: zones(:)
    integer, allocatable :: laminate_of(:)
    integer :: ply

    self%setup = setup
    self%communicator = communicator
    call find_laminates(setup, self%laminates, laminate_of)
    self%plies = setup%plies()
    self%thickness = sum(setup%laminate%thickness)
    associate (skin => self%laminates(1)%plies)
      self%section = section_of(skin, setup%laminate%shear_correction)
      self%bending_section = section_of(in_bending(skin), setup%laminate%shear_correction)
      zones = zones_of(setup)
      call find_heights(skin, zones)
      self%mesh = create_mesh(setup%plate, setup%mesh, size(skin), zones, laminate_of, &
                              [[(ply, ply=1, size(skin))], setup%zones%stations(size(skin))])
    end associate
    self%stacks = stacks_of(self%mesh, self%laminates)
    self%membrane_idle = is_membrane_idle(setup, size(zones), self%section)
    self%fixed = fixed_unknowns(self%mesh, setup%plate, self%membrane_idle, unrestrained(setup))
    if (allocated(setup%supports)) call fix_by_rigs(self%mesh, setup%plate, setup%supports, self%fixed)
    self%images = find_images(self%mesh, setup%plate%kept, self%fixed)
    call distribute(self%mesh, communicator, self%distribution, error, self%images%first_cells(self%mesh))
    if (.not. allocated(error)) call build_elements(self, error)
    call communicator%agree(error)
    if (allocated(error)) return
    call self%halo%define(communicator, self%distribution%owned, 1 + self%distribution%number( &
                          self%distribution%points(self%distribution%owned + 1:)), error)
    if (allocated(error)) return
    call build_borders(self)
    call build_interfaces(self)
    call build_loads(self)
    call build_lines(self)
    if (allocated(setup%supports)) call build_rigs(self)
    self%has_point_stiffness = self%map%layered .or. self%rig%unilateral .or. self%rig%elastic
    call find_struck_point(self)
  end subroutine create_model

  !> In-plane rigid-body motions of a static plate without support: along x, along y, rotation.
  pure function unrestrained(setup)
    type(setup_t), intent(in) :: setup
    !> True: it must be constrained unless symmetry does
    logical :: unrestrained(3)
    integer :: i

    unrestrained = .not. setup%has_inertia() .and. setup%plate%symmetry /= symmetry_quarter .and. &
                   .not. held_by_edges(setup%plate)
    if (allocated(setup%supports)) then
      do i = 1, size(setup%supports)
        if (allocated(setup%supports(i)%clamps) .and. .not. setup%supports(i)%clamp_force > 0) &
          unrestrained = unrestrained .and. setup%plate%in_plane == in_plane_free
      end do
    end if
    if (.not. allocated(setup%lines)) return
    associate (in_plane => lines_in_plane(setup), lines => setup%lines)
      unrestrained(1) = unrestrained(1) .and. .not. any(in_plane .and. lines%component == 1)
      unrestrained(2) = unrestrained(2) .and. .not. any(in_plane .and. lines%component == 2)
      ! A line fixed along its normal cannot rotate.
      unrestrained(3) = unrestrained(3) .and. .not. any(in_plane &
                                                        .and. (lines%component == 1 .eqv. lines%direction == along_y))
    end associate
  end function unrestrained

  !> In-plane rigid-body motions that supported edges prevent: along x, along y, rotation. An edge that holds the
  !> displacement along itself only does not prevent a rotation about one of its points, nor do two that meet about
  !> their common corner.
  pure function held_by_edges(plate) result(held)
    type(plate_t), intent(in) :: plate
    logical :: held(3)
    logical :: supported(4)

    supported = plate%edges /= edge_free
    held = plate%in_plane == in_plane_fixed .and. any(supported)
    if (plate%in_plane == in_plane_tangential) &
      held = [any(supported(3:4)), any(supported(1:2)), all(supported(1:2)) .or. all(supported(3:4))]
  end function held_by_edges

  !> Lines that constrain or displace the plate in its plane.
  pure function lines_in_plane(setup) result(in_plane)
    type(setup_t), intent(in) :: setup
    !> True for each such line
    logical, allocatable :: in_plane(:)

    allocate (in_plane(0))
    if (allocated(setup%lines)) in_plane = setup%lines%prescribed .and. setup%lines%component <= 2
  end function lines_in_plane

  !> Batches of this rank's elements, with their sections.
  subroutine build_elements(self, error)
    !> The model, with its mesh distributed
    type(model_t), intent(inout) :: self
    !> Set if an element is ill-shaped
    type(error_t), allocatable, intent(inout) :: error
    type(section_t), allocatable :: sections(:)
    integer :: element, i

    associate (mesh => self%mesh, partition => self%distribution)
      self%stack = mesh%element_layer(partition%elements)
      sections = [(self%stacks(i)%section(), i=1, size(self%stacks))]
      call self%elements%create(mesh%node_coordinates(:, mesh%point_node(partition%points)), partition%connectivity, &
                                self%setup%mesh%shear, error)
      if (allocated(error)) return
      if (.not. is_flat(self%setup%plate)) call build_shape(self, mesh%node_coordinates(:, mesh%point_node( &
                                                                                         partition%points)))
      if (self%setup%thermal%is_present) allocate (self%free(lanes, 7, self%elements%batches), source=0.0_wp)
      do element = 1, size(partition%elements)
        associate (stack => self%stacks(self%stack(element)), section => sections(self%stack(element)))
          call self%elements%set_section(element, section%stiffness, section%mass)
          if (self%setup%thermal%is_present) self%free(lane_of(element), :, batch_of(element)) = &
            free_resultants(stack%plies, stack%plies%elasticity)
        end associate
      end do
    end associate
    call place_stringers(self)
    if (self%setup%mesh%mass == mass_lumped) allocate (self%lumped(3, size(self%distribution%points)), source=0.0_wp)
  end subroutine build_elements

  !> The different laminates of the plate, the skin's first, and that of each cell.
  pure subroutine find_laminates(setup, laminates, laminate_of)
    type(setup_t), intent(in) :: setup
    !> The laminates
    type(ply_stack_t), allocatable, intent(out) :: laminates(:)
    !> Number of that of each cell, columns first
    integer, allocatable, intent(out) :: laminate_of(:)
    type(cell_line_t) :: columns, rows
    integer :: i, j

    columns = cells_along(setup%plate, setup%mesh, 1)
    rows = cells_along(setup%plate, setup%mesh, 2)
    associate (x => columns%middles(), y => rows%middles())
      call setup%zones%find_stacks(setup%laminate, setup%materials, &
                                   reshape([(([x(i), y(j)], i=1, size(x)), j=1, size(y))], [2, size(x)*size(y)]), &
                                   laminates, laminate_of)
    end associate
    if (.not. setup%thermal%is_present) return
    do i = 1, size(laminates)
      call laminates(i)%set_thermal_strains(setup%materials, setup%thermal%temperature_change)
    end do
  end subroutine find_laminates

  !> The stack of each layer of the mesh.
  pure function stacks_of(mesh, laminates) result(stacks)
    type(layered_mesh_t), intent(in) :: mesh
    !> The different laminates of the plate
    type(ply_stack_t), intent(in) :: laminates(:)
    type(ply_stack_t) :: stacks(size(mesh%layers))
    integer :: i

    do i = 1, size(stacks)
      associate (layer => mesh%layers(i))
        stacks(i) = laminates(layer%laminate)%layer(layer%plies(1), layer%plies(2))
      end associate
    end do
  end function stacks_of

  !> Shape of a plate that is not flat. Displacements are measured along its curved surface; an imperfection is too
  !> small for a difference.
  subroutine build_shape(self, places)
    !> The model, with its elements
    type(model_t), intent(inout) :: self
    !> Coordinates of this rank's points from the plate's centre, (2, points)
    real(wp), intent(in) :: places(:, :)
    integer :: point

    associate (plate => self%setup%plate)
      call set_initial_shape(self%elements, [(initial_deflection(plate, places(:, point)), point=1, size(places, 2))])
      if (any(abs(plate%curvature_radius) > 0)) &
        call set_surface(self%elements, spread(curvatures(plate), 2, size(places, 2))*places)
    end associate
  end subroutine build_shape

  !> Lines on this rank's points.
  subroutine build_lines(self)
    !> The model, with its map of layers
    type(model_t), intent(inout) :: self
    integer :: i

    allocate (self%lines(0))
    if (.not. allocated(self%setup%lines)) return
    self%lines = [(place_line(self%setup%lines(i), self%mesh, self%distribution, self%map, &
                              self%fixed(:, self%distribution%points), self%laminates(1)%plies, &
                              self%section, self%setup%plate%symmetry), i=1, size(self%setup%lines))]
    do i = 1, size(self%lines)
      self%lines(i)%stiffness = self%lines(i)%stiffness + stiffness_on_line(self, self%setup%lines(i))
    end do
  end subroutine build_lines

  !> Finds the struck node's first point if this rank owns it, and the elements around it.
  subroutine find_struck_point(self)
    type(model_t), intent(inout) :: self
    integer :: i, first

    first = self%mesh%first_point(self%mesh%struck_node)
    associate (mesh => self%mesh, mine => self%distribution%elements)
      self%struck_elements = pack([(i, i=1, size(mine))], &
                                  [(any(mesh%connectivity(:, mine(i)) == first), i=1, size(mine))])
    end associate
    self%struck_count = size(self%struck_elements)
    call self%communicator%sum(self%struck_count)
    self%struck = self%distribution%local(self%mesh%first_point(self%mesh%struck_node))
    if (self%struck > self%distribution%owned) self%struck = 0
  end subroutine find_struck_point

  !> Supports of this rank's points by rigs, and the contact with unilateral frames: that of the laminate's face with a
  !> rigid one.
  subroutine build_rigs(self)
    !> The model, with its elements and halo
    type(model_t), intent(inout) :: self
    integer :: i

    ! Stiffness of a rigid frame: the contact multiple of the laminate's through-thickness stiffness over the area of a
    ! cell.
    self%rig = new_rig_model(self%mesh, self%setup%plate, self%setup%supports, self%distribution, &
                             rigid*self%laminates(1)%plies(1)%elasticity%e2/self%thickness &
                             *product(self%setup%plate%length/self%setup%mesh%elements)/self%mesh%multiplicity)
    if (allocated(self%rig%line_rig)) call self%rig%join_ranks(self%communicator, self%halo)
    if (.not. self%rig%unilateral) return
    associate (partition => self%distribution, last => self%laminates(1)%plies(self%mesh%plies))
      self%rig_area = nodal_areas(self, pack([(i, i=1, self%elements%elements)], &
                                             self%mesh%is_top(partition%elements)))
      self%rig_law = create_contact_law(contact_augmented_lagrangian, 1.0_wp, last%elasticity%e2/self%thickness, &
                                        self%thickness, moving=self%setup%has_inertia())
    end associate
  end subroutine build_rigs

  !> Heights, areas and contact laws of the interfaces.
  subroutine build_interfaces(self)
    !> The model, with its elements and halo
    type(model_t), intent(inout) :: self
    real(wp), allocatable :: areas(:, :), below(:)
    real(wp) :: thickness
    integer :: zone, i

    associate (mesh => self%mesh, partition => self%distribution, plies => self%laminates(1)%plies)
      self%map = create_layer_map(mesh, partition)
      self%zone = mesh%point_zone(partition%points)
      allocate (areas(1, size(partition%points)), source=0.0_wp)
      do zone = 1, size(mesh%zones)
        below = nodal_areas(self, pack([(i, i=1, self%elements%elements)], mesh%is_below(partition%elements, zone)))
        where (self%zone == zone) areas(1, :) = below
      end do
      if (self%map%layered) call self%halo%update(areas)
      self%contact_area = areas(1, :)
      self%beside_border = [(beside_border(mesh, partition%points(i)), i=1, size(partition%points))]
      allocate (self%contact_laws(size(mesh%zones)), self%cohesive_laws(size(mesh%zones)))
      do zone = 1, size(mesh%zones)
        associate (height => mesh%zones(zone)%height, interface => self%setup%delaminations(zone), &
                   above => plies(max(1, mesh%zones(zone)%below_ply)))
          thickness = min(height - plies(1)%z_top, plies(size(plies))%z_bottom - height)
          if (interface%bonds_doublers()) thickness = min(self%thickness, mesh%zones(zone)%thickness)
          self%contact_laws(zone) = create_contact_law(interface%contact, interface%contact_exponent, &
                                                       above%elasticity%e2/thickness, thickness, &
                                                       moving=self%setup%has_inertia())
          if (interface%law == law_cohesive) &
            self%cohesive_laws(zone) = create_cohesive_law(toughnesses(interface), interface%mixing_exponent, &
                                                           [interface%strength_opening, interface%strength_shear], &
                                                           interface%stiffness, above%elasticity%e2, &
                                                           thickness)
        end associate
      end do
    end associate
  end subroutine build_interfaces

  !> True if a point lies next to the border of its zone, except where this is the border of the model or the free edge
  !> of a doubler.
  pure logical function beside_border(mesh, point)
    type(layered_mesh_t), intent(in) :: mesh
    !> The point
    integer, intent(in) :: point
    integer :: line(2)

    beside_border = .false.
    if (mesh%point_zone(point) == 0 .or. mesh%is_bond(point)) return
    line = [modulo(mesh%point_node(point) - 1, 2*mesh%cells(1) + 1), (mesh%point_node(point) - 1)/(2*mesh%cells(1) + 1)]
    associate (zone => mesh%zones(mesh%point_zone(point)))
      beside_border = near(line(1), zone%columns, mesh%cells(1)) .or. near(line(2), zone%rows, mesh%cells(2))
    end associate

  contains

    !> True if a line of nodes shares a cell with the first or last of a range of cells that ends within the model.
    pure logical function near(line, range, cells)
      !> Line of nodes, from 0
      integer, intent(in) :: line
      !> First and last cell of the range
      integer, intent(in) :: range(2)
      !> Cells along this direction
      integer, intent(in) :: cells

      near = range(1) > 1 .and. line <= 2*range(1) .or. range(2) < cells .and. line >= 2*range(2) - 2
    end function near
  end function beside_border
end module model_building
