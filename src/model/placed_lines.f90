!> Lines of the deck on the mesh: weights of the unknowns in the motion of a line, and its nodal forces.
!>
!> A line consists of the nodes on one line of the mesh, each with its fraction of the length (Simpson's weights, exact
!> for the element's parabolas). A displacement is prescribed by stiff springs: the motion of a line on a lower layer
!> contains the jumps of all interfaces above it, so that no single unknown could be prescribed instead.
module placed_lines
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use mesh_parameters, only: is_mirrored
  use plies, only: ply_t
  use stacking, only: section_t
  use layered_meshes, only: layered_mesh_t
  use layer_maps, only: layer_map_t
  use distributions, only: distribution_t
  use line_loads, only: line_load_t, along_x, all_layers
  implicit none
  private
  public :: placed_line_t, place_line

  !> Total stiffness of a line's springs over that of the stiffest section. The plate is mostly more compliant,
  !> so that the relative error of the displacement is 1e-5 at most; round-off of the force decreases with the
  !> stiffness.
  real(wp), parameter, public :: relative_stiffness = 1.0e5_wp

  !> A line on this rank's points.
  type :: placed_line_t
    !> The line of the deck
    type(line_load_t) :: load
    !> Fraction of the full plate's line in the model
    real(wp) :: share = 1
    !> Total stiffness of its springs
    real(wp) :: stiffness = 0
    !> Fraction of each node in the modelled line, with the sum 1 over all ranks, (nodes of this rank)
    real(wp), allocatable :: weight(:)
    !> Height z of the middle of the layer acted on, (nodes of this rank)
    real(wp), allocatable :: height(:)
    !> Index of the first entry of each node in the next two lists, (nodes of this rank + 1)
    integer, allocatable :: first(:)
    !> Points of the unknowns that determine the motion of a node
    integer, allocatable :: point(:)
    !> Weights of their unknowns in the motion of the node, (5, points)
    real(wp), allocatable :: coefficient(:, :)
    !> Fractions of this rank's nodes whose prescribed component is constrained by supports: the line does not act on
    !> these nodes
    real(wp), allocatable :: left_out(:)
  contains
    procedure :: motion_at
    procedure :: force_at
    procedure :: add_forces
    procedure :: move_to
    procedure :: add_holding_forces
    procedure :: add_slopes
    procedure :: totals
  end type placed_line_t

contains

  !> Finds nodes and weights of a line on the mesh.
  pure function place_line(load, mesh, distribution, map, fixed, plies, sections, symmetry) result(self)
    type(line_load_t), intent(in) :: load
    type(layered_mesh_t), intent(in) :: mesh
    type(distribution_t), intent(in) :: distribution
    type(layer_map_t), intent(in) :: map
    !> True for unknowns constrained by supports, (5, points of this rank)
    logical, intent(in) :: fixed(:, :)
    type(ply_t), intent(in) :: plies(:)
    !> Of the different laminates of the plate
    type(section_t), intent(in) :: sections(:)
    integer, intent(in) :: symmetry
    !> The line on this rank
    type(placed_line_t) :: self
    integer :: across, along, crossing, i
    logical :: mirrored(2)

    along = merge(1, 2, load%direction == along_x)
    across = 3 - along
    self%load = load
    ! The stiffest of the laminates may lie on the line.
    self%stiffness = relative_stiffness*maxval([(section_scale(sections(i), load%component), i=1, size(sections))])
    crossing = mesh%along(across)%nearest_node(load%at)
    mirrored = is_mirrored(symmetry)
    if (mirrored(along)) self%share = self%share/2
    if (mirrored(across) .and. crossing == 0) self%share = self%share/2
    allocate (self%weight(0), self%height(0), self%first(1), self%point(0), self%coefficient(5, 0))
    self%first(1) = 1
    do i = 1, distribution%owned
      if (mesh%point_zone(distribution%points(i)) /= 0) cycle
      associate (lines => mesh%lines_of(mesh%point_node(distribution%points(i))))
        if (lines(across) /= crossing) cycle
        call add_layers(self, mesh, map, plies, distribution%points(i), i, &
                        mesh%along(along)%share_of_node(lines(along)))
      end associate
    end do
    call leave_out_fixed(self, fixed)
  end function place_line

  !> Excludes nodes constrained by supports in a prescribed component: its springs would act on the supports.
  pure subroutine leave_out_fixed(self, fixed)
    type(placed_line_t), intent(inout) :: self
    !> True for unknowns constrained by supports, (5, points of this rank)
    logical, intent(in) :: fixed(:, :)
    logical :: acts(size(self%weight)), kept(size(self%point))
    integer :: node, k

    acts = .true.
    kept = .true.
    do node = 1, size(acts)
      if (.not. self%load%prescribed) exit
      acts(node) = any([(any(abs(self%coefficient(:, k)) > 0 .and. .not. fixed(:, self%point(k))), &
                         k=self%first(node), self%first(node + 1) - 1)])
      kept(self%first(node):self%first(node + 1) - 1) = acts(node)
    end do
    self%left_out = pack(self%weight, .not. acts)
    if (all(acts)) return
    self%first = [1, (1 + count(kept(:self%first(node + 1) - 1)), node=1, size(acts))]
    self%first = [self%first(1), pack(self%first(2:), acts)]
    self%weight = pack(self%weight, acts)
    self%height = pack(self%height, acts)
    self%coefficient = self%coefficient(:, pack([(k, k=1, size(kept))], kept))
    self%point = pack(self%point, kept)
  end subroutine leave_out_fixed

  !> Stiffness of the section that scales the springs of a component.
  pure real(wp) function section_scale(section, component) result(scale)
    type(section_t), intent(in) :: section
    !> 1 to 5
    integer, intent(in) :: component

    select case (component)
    case (1, 2)
      scale = maxval(abs(section%stiffness(1:6)))
    case (3)
      scale = maxval(abs(section%stiffness(19:21)))
    case default
      scale = maxval(abs(section%stiffness(13:18)))
    end select
  end function section_scale

  !> Adds a node with the layers on which the line acts, each with its fraction of the thickness.
  pure subroutine add_layers(self, mesh, map, plies, first_point, local, weight)
    type(placed_line_t), intent(inout) :: self
    type(layered_mesh_t), intent(in) :: mesh
    type(layer_map_t), intent(in) :: map
    type(ply_t), intent(in) :: plies(:)
    !> First point of the node, and its index on this rank
    integer, intent(in) :: first_point, local
    !> The node's fraction of the line
    real(wp), intent(in) :: weight
    real(wp) :: top, bottom, total
    integer :: point, last, chosen

    total = plies(size(plies))%z_bottom - plies(1)%z_top
    last = mesh%first_point(mesh%point_node(first_point) + 1) - 1
    chosen = first_point
    do point = first_point, last
      if (mesh%point_zone(point) < self%load%layer) chosen = point
    end do
    do point = first_point, last
      if (self%load%layer /= all_layers .and. point /= chosen) cycle
      ! Lines act on the laminate; doublers only where the line names their layer.
      if (self%load%layer == all_layers .and. mesh%is_doubler(point)) cycle
      top = plies(1)%z_top
      if (point > first_point) then
        top = mesh%zones(mesh%point_zone(point))%height
      else if (mesh%is_doubler(point)) then
        top = top - mesh%zones(mesh%point_zone(point + 1))%thickness
      end if
      bottom = plies(size(plies))%z_bottom
      if (point < last) then
        bottom = mesh%zones(mesh%point_zone(point + 1))%height
      else if (mesh%is_doubler(point)) then
        bottom = bottom + mesh%zones(mesh%point_zone(point))%thickness
      end if
      self%weight = [self%weight, weight*merge((bottom - top)/total, 1.0_wp, self%load%layer == all_layers)]
      self%height = [self%height, (top + bottom)/2]
      call add_unknowns(self, map, local + point - first_point, (top + bottom)/2)
      self%first = [self%first, size(self%point) + 1]
    end do
  end subroutine add_layers

  !> Adds the unknowns that determine the motion of a layer at a node: its own and those of the points above it.
  pure subroutine add_unknowns(self, map, lowest, height)
    type(placed_line_t), intent(inout) :: self
    type(layer_map_t), intent(in) :: map
    !> Point of the layer on this rank
    integer, intent(in) :: lowest
    !> Height z of the layer's middle
    real(wp), intent(in) :: height
    real(wp) :: of_motion(5), own(5)
    integer :: p

    of_motion = 0
    of_motion(self%load%component) = 1
    if (self%load%component <= 2) of_motion(3 + self%load%component) = height
    p = lowest
    do
      own = of_motion
      if (map%above(p) > 0) own(4:5) = own(4:5) - map%height(p)*own(1:2)
      self%point = [self%point, p]
      self%coefficient = reshape([self%coefficient, own], [5, size(self%point)])
      if (map%above(p) == 0) exit
      of_motion(4:5) = map%height(p)*of_motion(1:2)
      p = map%above(p)
    end do
  end subroutine add_unknowns

  !> Motion of a node of the line.
  pure real(wp) function motion_at(self, node, displacement) result(motion)
    class(placed_line_t), intent(in) :: self
    integer, intent(in) :: node
    real(wp), intent(in) :: displacement(:, :)
    integer :: k

    motion = 0
    do k = self%first(node), self%first(node + 1) - 1
      motion = motion + dot_product(self%coefficient(:, k), displacement(:, self%point(k)))
    end do
  end function motion_at

  !> Total force of the line, for a node with weight 1.
  pure real(wp) function force_at(self, node, displacement, load_factor) result(force)
    class(placed_line_t), intent(in) :: self
    integer, intent(in) :: node
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(in) :: load_factor

    force = self%load%at_factor(load_factor)
    if (self%load%prescribed) force = self%stiffness*(force - self%motion_at(node, displacement))
  end function force_at

  !> Adds the nodal forces of the line.
  pure subroutine add_forces(self, displacement, load_factor, forces)
    class(placed_line_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(in) :: load_factor
    !> Forces on the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: node

    do node = 1, size(self%weight)
      call spread(self, node, self%force_at(node, displacement, load_factor), forces)
    end do
  end subroutine add_forces

  !> Sets the motion of the nodes of the line in a field, by the unknowns of their own layers.
  pure subroutine move_to(self, value, field)
    class(placed_line_t), intent(in) :: self
    !> Its displacement, velocity or acceleration
    real(wp), intent(in) :: value
    !> The field, (5, points)
    real(wp), intent(inout) :: field(:, :)
    integer :: node

    ! Upper layers first, as they contribute to the motion of lower ones.
    do node = 1, size(self%weight)
      associate (own => field(self%load%component, self%point(self%first(node))))
        own = own + (value - self%motion_at(node, field))
      end associate
    end do
  end subroutine move_to

  !> Adds the nodal forces that hold a line at zero displacement; none if it is not prescribed.
  pure subroutine add_holding_forces(self, displacement, forces)
    class(placed_line_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    !> Forces on the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: node

    if (.not. self%load%prescribed) return
    do node = 1, size(self%weight)
      call spread(self, node, -self%stiffness*self%motion_at(node, displacement), forces)
    end do
  end subroutine add_holding_forces

  !> Adds the change of the nodal forces with the load factor.
  pure subroutine add_slopes(self, forces)
    class(placed_line_t), intent(in) :: self
    !> Forces on the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: node

    do node = 1, size(self%weight)
      call spread(self, node, self%load%slope()*merge(self%stiffness, 1.0_wp, self%load%prescribed), forces)
    end do
  end subroutine add_slopes

  !> Adds a node's fraction of the total force of the line.
  pure subroutine spread(self, node, force, forces)
    type(placed_line_t), intent(in) :: self
    integer, intent(in) :: node
    !> Force of the full line
    real(wp), intent(in) :: force
    real(wp), intent(inout) :: forces(:, :)
    integer :: k

    do k = self%first(node), self%first(node + 1) - 1
      forces(:, self%point(k)) = forces(:, self%point(k)) + self%share*self%weight(node)*force*self%coefficient(:, k)
    end do
  end subroutine spread

  !> Force and mean motion of the line, of this rank's nodes, as exact sums, so that totals do not depend on the number
  !> of ranks.
  pure function totals(self, displacement, load_factor)
    class(placed_line_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(in) :: load_factor
    !> Force of the full plate's line, sum of the motion of its nodes times their fraction, and fraction of excluded
    !> nodes
    type(exact_sum_t) :: totals(3)
    integer :: node

    do node = 1, size(self%weight)
      call totals(1)%add(self%weight(node)*self%force_at(node, displacement, load_factor))
      call totals(2)%add(self%weight(node)*self%motion_at(node, displacement))
    end do
    do node = 1, size(self%left_out)
      call totals(3)%add(self%left_out(node))
    end do
  end function totals
end module placed_lines
