!> Supports of this rank's points by rigs: w fixed by a frame or a rigid clamp, contact with unilateral frames, springs
!> of clamps, and those of the plate's elastic edges.
module rig_models
  use border_sums, only: border_sum_t
  use communicators, only: communicator_t
  use halos, only: halo_t
  use kinds, only: wp
  use distributions, only: distribution_t
  use elastic_edges, only: edge_spring_t, edge_springs
  use layered_meshes, only: layered_mesh_t
  use mesh_parameters, only: plate_t, edge_elastic, in_plane_free
  use rigs, only: crossing_t, nodes_on_frame, circle_crossings, clamp_nodes
  use support_parameters, only: support_t
  implicit none
  private
  public :: rig_model_t, new_rig_model, fix_by_rigs, hold_openings

  !> The rigs at the first points of this rank's nodes.
  type :: rig_model_t
    !> True with a unilateral frame, or with clamps with a force
    logical :: unilateral = .false.
    !> True if clamps have springs or a force
    logical :: elastic = .false.
    !> The rig that fixes w, or whose frame supports w by pressure; 0: none, (local points); unallocated: no rigs
    integer, allocatable :: constrained_by(:), frame(:)
    !> Stiffness of clamps along u, v and w, (3, local points)
    real(wp), allocatable :: springs(:, :)
    !> Force of clamps on the plate, (local points)
    real(wp), allocatable :: clamp_preload(:)
    !> The rig that they belong to; 0: none, (local points)
    integer, allocatable :: clamps(:)
    !> Points of three nodes each with a spring on their weighted unknown, (3, lines), and the rig; 0: an elastic edge
    integer, allocatable :: line_points(:, :), line_rig(:)
    !> Element of the mesh with the line on its side, (lines), and columns to which its forces are added, (3, lines)
    integer, allocatable :: line_element(:), line_targets(:, :)
    !> Sums of the forces of lines at points on the borders between ranks
    type(border_sum_t) :: line_borders
    !> Component of the unknown, (lines)
    integer, allocatable :: line_component(:)
    !> Weights, (3, lines), and stiffness, (lines)
    real(wp), allocatable :: line_weights(:, :), line_stiffness(:)
  contains
    procedure :: join_ranks
    procedure :: add_line_forces
  end type rig_model_t

contains

  !> The rigs at a rank's points.
  pure function new_rig_model(mesh, plate, supports, distribution, rigid) result(self)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: supports(:)
    type(distribution_t), intent(in) :: distribution
    !> Penalty stiffness of a rigid frame where its edge crosses a cell
    real(wp), intent(in) :: rigid
    !> The rigs at its points
    type(rig_model_t) :: self
    integer, allocatable :: nodes(:)
    integer :: i, k, point, first

    if (size(supports) == 0 .and. all(plate%edges /= edge_elastic)) return
    allocate (self%constrained_by(size(distribution%points)), self%frame(size(distribution%points)), &
              self%clamps(size(distribution%points)), source=0)
    allocate (self%springs(3, size(distribution%points)), self%clamp_preload(size(distribution%points)), source=0.0_wp)
    do i = 1, size(supports)
      ! The same on every rank, also on those without a point of the rig.
      self%unilateral = self%unilateral .or. supports(i)%shape > 0 .and. supports(i)%unilateral .or. &
                        supports(i)%clamp_force > 0
      nodes = pack([(k, k=1, mesh%nodes())], nodes_on_frame(mesh, supports(i)))
      do k = 1, size(nodes)
        point = distribution%local(mesh%first_point(nodes(k)))
        if (point == 0) cycle
        if (supports(i)%unilateral) then
          self%frame(point) = i
        else
          self%constrained_by(point) = i
        end if
      end do
      nodes = clamp_nodes(mesh, plate, supports(i))
      do k = 1, size(nodes)
        point = distribution%local(mesh%first_point(nodes(k)))
        if (point == 0) cycle
        ! The deck lists each clamp of the plate, and each has an image in every part of the plate.
        if (supports(i)%clamp_force > 0) then
          self%clamps(point) = i
          self%clamp_preload(point) = self%clamp_preload(point) + supports(i)%clamp_force/mesh%multiplicity
        else if (supports(i)%clamp_stiffness > 0) then
          self%clamps(point) = i
          first = merge(3, 1, plate%in_plane == in_plane_free)
          self%springs(first:, point) = self%springs(first:, point) + supports(i)%clamp_stiffness/mesh%multiplicity
        else
          self%constrained_by(point) = i
        end if
      end do
    end do
    call find_lines(mesh, plate, supports, distribution, rigid, self)
    ! A frame supports the points below a clamp with a force; constrained points need neither frame nor clamp.
    where (self%clamp_preload > 0 .and. self%frame == 0) self%frame = self%clamps
    where (self%constrained_by > 0) self%frame = 0
    where (self%constrained_by > 0) self%clamp_preload = 0
    self%elastic = any(supports%clamp_stiffness > 0 .or. supports%clamp_force > 0)
  end function new_rig_model

  !> Finds the supports on the sides of this rank's cells: w on the edges of circular windows, and elastic edges.
  pure subroutine find_lines(mesh, plate, supports, distribution, rigid, self)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: supports(:)
    !> This rank's elements
    type(distribution_t), intent(in) :: distribution
    !> Penalty stiffness of a rigid frame
    real(wp), intent(in) :: rigid
    type(rig_model_t), intent(inout) :: self
    type(crossing_t), allocatable :: crossings(:)
    type(edge_spring_t), allocatable :: springs(:)
    integer :: i, k, element, cell

    allocate (self%line_points(3, 0), self%line_rig(0), self%line_component(0), self%line_weights(3, 0), &
              self%line_stiffness(0), self%line_element(0))
    do element = 1, size(distribution%elements)
      if (.not. mesh%is_top(distribution%elements(element))) cycle
      cell = mesh%element_cell(distribution%elements(element))
      do i = 1, size(supports)
        if (supports(i)%unilateral) cycle
        crossings = circle_crossings(mesh, supports(i), cell)
        do k = 1, size(crossings)
          call add_line(self, i, distribution%connectivity(crossings(k)%nodes, element), 3, crossings(k)%weights, rigid)
          self%line_element = [self%line_element, distribution%elements(element)]
        end do
      end do
      springs = edge_springs(mesh, plate, cell)
      do k = 1, size(springs)
        call add_line(self, 0, distribution%connectivity(springs(k)%nodes, element), springs(k)%component, &
                      springs(k)%weights, springs(k)%stiffness)
        self%line_element = [self%line_element, distribution%elements(element)]
      end do
    end do
    self%line_targets = self%line_points
  end subroutine find_lines

  !> Adds a point on a line.
  pure subroutine add_line(self, rig, points, component, weights, stiffness)
    type(rig_model_t), intent(inout) :: self
    !> The rig that it belongs to; 0: an elastic edge
    integer, intent(in) :: rig
    !> Points of three nodes, and which of their unknowns
    integer, intent(in) :: points(3), component
    !> Weights of the nodes, and stiffness
    real(wp), intent(in) :: weights(3), stiffness

    self%line_rig = [self%line_rig, rig]
    self%line_points = reshape([self%line_points, points], [3, size(self%line_rig)])
    self%line_component = [self%line_component, component]
    self%line_weights = reshape([self%line_weights, weights], [3, size(self%line_rig)])
    self%line_stiffness = [self%line_stiffness, stiffness]
  end subroutine add_line

  !> Prepares the sums of forces of lines at points on the borders between ranks, in the order of the mesh. Collective.
  subroutine join_ranks(self, communicator, halo)
    class(rig_model_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    !> Their points
    type(halo_t), intent(in) :: halo
    integer :: targets(size(self%line_points))

    call self%line_borders%define(communicator, halo, reshape(self%line_points, shape(targets)), &
                                  reshape(spread(self%line_element, 1, 3), shape(targets)), targets)
    self%line_targets = reshape(targets, shape(self%line_points))
  end subroutine join_ranks

  !> Adds the forces of supported lines to the internal forces, and their stored energy. Collective.
  subroutine add_line_forces(self, displacement, force, energy)
    class(rig_model_t), intent(in) :: self
    !> Unknowns, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Internal forces, ghosts zero, (5, points)
    real(wp), contiguous, intent(inout) :: force(:, :)
    !> Energy of this rank
    real(wp), intent(inout) :: energy
    real(wp), allocatable :: field(:, :)

    if (.not. allocated(self%line_rig)) return
    if (self%line_borders%columns > size(force, 2)) then
      allocate (field(5, self%line_borders%columns), source=0.0_wp)
      field(:, :size(force, 2)) = force
      call add_to_columns(self, displacement, field, energy)
      call self%line_borders%add(field)
      force = field(:, :size(force, 2))
    else
      call add_to_columns(self, displacement, force, energy)
      call self%line_borders%add(force)
    end if
  end subroutine add_line_forces

  !> Adds the forces of supported lines to their columns.
  pure subroutine add_to_columns(self, displacement, field, energy)
    class(rig_model_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    !> Forces, (5, columns)
    real(wp), intent(inout) :: field(:, :)
    !> Energy of this rank
    real(wp), intent(inout) :: energy
    real(wp) :: motion
    integer :: k

    do k = 1, size(self%line_rig)
      associate (points => self%line_points(:, k), targets => self%line_targets(:, k), &
                 weights => self%line_weights(:, k), i => self%line_component(k))
        motion = dot_product(weights, displacement(i, points))
        field(i, targets) = field(i, targets) + self%line_stiffness(k)*motion*weights
        energy = energy + self%line_stiffness(k)*motion**2/2
      end associate
    end do
  end subroutine add_to_columns

  !> Adds the unknowns fixed by rigs to a table. Frames and clamps that fix w fix it at both faces, so that all layers
  !> are held.
  pure subroutine fix_by_rigs(mesh, plate, supports, fixed)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: supports(:)
    logical, intent(inout) :: fixed(:, :)
    logical, allocatable :: on_frame(:)
    integer, allocatable :: nodes(:)
    integer :: i, k

    do i = 1, size(supports)
      if (.not. supports(i)%unilateral) then
        on_frame = nodes_on_frame(mesh, supports(i))
        do k = 1, size(on_frame)
          if (on_frame(k)) fixed(3, mesh%first_point(k):mesh%first_point(k + 1) - 1) = .true.
        end do
      end if
      if (supports(i)%clamp_stiffness > 0 .or. supports(i)%clamp_force > 0) cycle
      nodes = clamp_nodes(mesh, plate, supports(i))
      do k = 1, size(nodes)
        associate (first => mesh%first_point(nodes(k)), last => mesh%first_point(nodes(k) + 1) - 1)
          fixed(3, first:last) = .true.
          if (plate%in_plane /= in_plane_free) fixed(1:2, first:last) = .true.
        end associate
      end do
    end do
  end subroutine fix_by_rigs

  !> Adds the openings over frames from which the plate may lift off, and over circular ones. Implicit steps hold the
  !> layers together there: these frames act on w of the first layer, and would otherwise pull it off the layers below.
  pure subroutine hold_openings(mesh, plate, supports, fixed)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: supports(:)
    logical, intent(inout) :: fixed(:, :)
    type(crossing_t), allocatable :: crossings(:)
    logical :: held(mesh%nodes())
    integer :: i, k, n, nodes(9)

    held = .false.
    do i = 1, size(supports)
      if (supports(i)%unilateral) held = held .or. nodes_on_frame(mesh, supports(i))
      if (supports(i)%clamp_force > 0) held(clamp_nodes(mesh, plate, supports(i))) = .true.
      do k = 1, product(mesh%cells)
        crossings = circle_crossings(mesh, supports(i), k)
        nodes = mesh%cell_nodes(k)
        do n = 1, size(crossings)
          held(nodes(crossings(n)%nodes)) = .true.
        end do
      end do
    end do
    do k = 1, size(held)
      if (held(k)) fixed(3, mesh%first_point(k) + 1:mesh%first_point(k + 1) - 1) = .true.
    end do
  end subroutine hold_openings
end module rig_models
