!> Map from the unknowns of stacked layers to their motion, theory (P9).
!>
!> The first layer of a node has u, v, w, theta_x, theta_y. A layer below has the jumps of the three displacements
!> across the interface above it, and its own rotations. Ties are then jumps constrained to zero, a gap is one unknown,
!> and with z measured from one mid-plane for all layers the border of a zone needs no constraint.
module layer_maps
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use distributions, only: distribution_t
  implicit none
  private
  public :: layer_map_t, create_layer_map

  !> The map of this rank's points.
  type :: layer_map_t
    !> True if some node has more than one layer
    logical :: layered = .false.
    !> Point of the same node in the layer above; 0: first layer, (points)
    integer, allocatable :: above(:)
    !> Height z of the interface between a point and the one above it, (points)
    real(wp), allocatable :: height(:)
  contains
    procedure :: to_motion
    procedure :: to_unknowns
    procedure :: expand
  end type layer_map_t

contains

  !> The map of a rank's points.
  pure function create_layer_map(mesh, distribution) result(self)
    type(layered_mesh_t), intent(in) :: mesh
    type(distribution_t), intent(in) :: distribution
    type(layer_map_t) :: self
    integer :: i, point

    self%layered = size(mesh%zones) > 0
    allocate (self%above(size(distribution%points)), source=0)
    allocate (self%height(size(distribution%points)), source=0.0_wp)
    do i = 1, size(distribution%points)
      point = distribution%points(i)
      if (mesh%point_zone(point) == 0) cycle
      self%above(i) = distribution%local(point - 1)
      self%height(i) = mesh%zones(mesh%point_zone(point))%height
    end do
  end function create_layer_map

  !> Motion of every layer from the unknowns, in place. Points of a node follow each other downwards.
  pure subroutine to_motion(self, field)
    class(layer_map_t), intent(in) :: self
    !> Unknowns on entry, motion on return
    real(wp), intent(inout) :: field(5, size(self%above))
    integer :: i

    do i = 1, size(self%above)
      if (self%above(i) == 0) cycle
      associate (upper => field(:, self%above(i)), z => self%height(i))
        field(1:2, i) = field(1:2, i) + upper(1:2) + z*(upper(4:5) - field(4:5, i))
        field(3, i) = field(3, i) + upper(3)
      end associate
    end do
  end subroutine to_motion

  !> Forces on the unknowns from forces on every layer, in place: the transpose of `to_motion`.
  pure subroutine to_unknowns(self, force)
    class(layer_map_t), intent(in) :: self
    !> Forces on the layers on entry, on the unknowns on return, (5, points)
    real(wp), intent(inout) :: force(:, :)
    integer :: i

    do i = size(self%above), 1, -1
      if (self%above(i) == 0) cycle
      associate (upper => force(:, self%above(i)), z => self%height(i))
        upper(1:3) = upper(1:3) + force(1:3, i)
        upper(4:5) = upper(4:5) + z*force(1:2, i)
        force(4:5, i) = force(4:5, i) - z*force(1:2, i)
      end associate
    end do
  end subroutine to_unknowns

  !> An element's matrix on the unknowns of its points and of all points above them.
  pure subroutine expand(self, points, matrix, unknown_points, expanded)
    class(layer_map_t), intent(in) :: self
    !> Points of the element
    integer, intent(in) :: points(:)
    !> Matrix of the element, (5*points, 5*points)
    real(wp), intent(in) :: matrix(:, :)
    !> Points whose unknowns the expanded matrix acts on, five each
    integer, allocatable, intent(out) :: unknown_points(:)
    !> Expanded matrix
    real(wp), allocatable, intent(out) :: expanded(:, :)
    integer :: a, p, columns

    columns = 0
    do a = 1, size(points)
      p = points(a)
      do while (p > 0)
        columns = columns + 1
        p = self%above(p)
      end do
    end do
    allocate (unknown_points(columns))
    columns = 0
    do a = 1, size(points)
      p = points(a)
      do while (p > 0)
        columns = columns + 1
        unknown_points(columns) = p
        p = self%above(p)
      end do
    end do
    expanded = times_map(self, points, transpose(times_map(self, points, matrix, columns)), columns)
  end subroutine expand

  !> Matrix times the map from unknowns to motion. The motion of a layer is that of the layer above plus its own
  !> unknowns, so that no product of matrices is needed.
  pure function times_map(self, points, matrix, count) result(product)
    class(layer_map_t), intent(in) :: self
    !> Points of the columns of the matrix
    integer, intent(in) :: points(:)
    !> Matrix, five columns per point
    real(wp), intent(in) :: matrix(:, :)
    !> Number of these points and of those above them
    integer, intent(in) :: count
    !> Product, five columns for every point and every one above it
    real(wp) :: product(size(matrix, 1), 5*count)
    real(wp) :: motion(size(matrix, 1), 5)
    integer :: a, p, last

    last = 0
    do a = 1, size(points)
      motion = matrix(:, 5*a - 4:5*a)
      p = points(a)
      do while (self%above(p) > 0)
        product(:, last + 1:last + 3) = motion(:, 1:3)
        product(:, last + 4:last + 5) = motion(:, 4:5) - self%height(p)*motion(:, 1:2)
        motion(:, 4:5) = self%height(p)*motion(:, 1:2)
        last = last + 5
        p = self%above(p)
      end do
      product(:, last + 1:last + 5) = motion
      last = last + 5
    end do
  end function times_map
end module layer_maps
