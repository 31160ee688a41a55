!> Smooth line through a stepped front of cells, and means along it.
!>
!> A stepped front concentrates tie forces at its corners: their products with the openings, cell by cell, scatter by
!> half of their mean on any mesh. Forces and openings are therefore averaged along the smooth front before they are
!> multiplied (doc/theory/interfaces.md, virtual crack closure). The line is a parabola fitted to the midpoints of the
!> edges around each edge; the length of an edge is its projection on the line.
module front_smoothing
  use delamination_fronts, only: front_segment_t
  use dense_systems, only: solve_dense
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: smooth_front_t, near_front_t, create_smooth_front

  !> Cells within which edges contribute to the parabola of an edge. With 4 in place of 3 the rates of stepped discs
  !> change by at most 1.5 %.
  integer, parameter :: cells_of_line = 3
  !> Lines of nodes on each side of an edge's midpoint in the search for nodes near the edge: two and a half cells.
  integer, parameter :: lines_beside = 5
  !> Relative tolerance of equal distances: far above round-off, 1e-16, and far below the differences of distances,
  !> which are parts of a cell.
  real(wp), parameter :: distance_tolerance = 1.0e-6_wp
  !> Stiffness added to the fit of the parabola against slope and curvature, relative to the weight of one edge, so that
  !> a front of one or two edges has a solution: a fit of three edges changes by 1e-6.
  real(wp), parameter :: regularisation = 1.0e-6_wp
  !> Magnitude of the sum of normals, relative to one edge, below which they cancel: far above round-off, 1e-16, while
  !> the sum on a curved front is of the order of one.
  real(wp), parameter :: cancellation = 1.0e-6_wp

  !> The edges of a front.
  type :: edges_t
    !> Midpoints and outward normals, (2, segments)
    real(wp), allocatable :: middle(:, :), normal(:, :)
    !> Lengths, (segments)
    real(wp), allocatable :: width(:)
    !> Directions of symmetry
    logical :: mirrored(2) = .false.
  end type edges_t

  !> Edges within a distance of one edge.
  type :: neighbours_t
    !> Their number
    integer :: number = 0
    !> Midpoints relative to that of the edge, and outward normals, (2, places)
    real(wp), allocatable :: from(:, :), normal(:, :)
    !> Lengths, multiplied by a factor that decreases from one to zero within the distance, (places)
    real(wp), allocatable :: weight(:)
  end type neighbours_t

  !> A front with its smooth line.
  type :: smooth_front_t
    !> Point of the line next to the midpoint of each edge, and outward normal there, (2, segments)
    real(wp), allocatable :: place(:, :), normal(:, :)
    !> Length of the line for each edge; zero at the border of the zone
    real(wp), allocatable :: length(:)
    !> Length of the cells ahead and behind
    real(wp), allocatable :: ahead(:), behind(:)
    !> Distance of the centre of the cell ahead from the line
    real(wp), allocatable :: offset(:)
    !> Directions in which the front continues beyond a line of symmetry through the origin
    logical :: mirrored(2) = .false.
  contains
    procedure :: means
    procedure :: weight
    procedure :: nodes_near
  end type smooth_front_t

  !> Nodes near a front, each with its closest edge; a node with several closest edges is repeated.
  type :: near_front_t
    !> Node, and segment, (places)
    integer, allocatable :: node(:), segment(:)
    !> Distance of the node ahead of the line, (places)
    real(wp), allocatable :: distance(:)
    !> Weight of the node in the segment, (places)
    real(wp), allocatable :: share(:)
  end type near_front_t

contains

  !> The smooth line of a front.
  function create_smooth_front(segments, mesh) result(self)
    type(front_segment_t), intent(in) :: segments(:)
    type(layered_mesh_t), intent(in) :: mesh
    type(smooth_front_t) :: self
    type(edges_t) :: edges
    real(wp) :: reach
    integer :: s

    self%mirrored = mesh%mirrored
    edges%mirrored = mesh%mirrored
    edges%middle = mesh%node_coordinates(:, segments%edge(2))
    edges%width = segments%width
    allocate (edges%normal, mold=edges%middle)
    edges%normal = 0
    do s = 1, size(segments)
      edges%normal(segments(s)%direction, s) = segments(s)%sign
    end do
    allocate (self%place, self%normal, mold=edges%middle)
    do s = 1, size(segments)
      reach = cells_of_line*max(segments(s)%width, segments(s)%ahead_length, segments(s)%behind_length)
      call fit_line(edges, s, reach, self%place(:, s), self%normal(:, s))
    end do
    self%length = merge(0.0_wp, edges%width*max(0.0_wp, sum(edges%normal*self%normal, dim=1)), segments%at_border)
    self%ahead = segments%ahead_length
    self%behind = segments%behind_length
    self%offset = [(dot_product(edges%middle(:, s) + edges%normal(:, s)*self%ahead(s)/2 - self%place(:, s), &
                                self%normal(:, s)), s=1, size(segments))]
  end function create_smooth_front

  !> Point and normal of the line next to an edge: a parabola fitted to the midpoints of the surrounding edges, with
  !> weights by their projections that decrease to zero within a distance.
  subroutine fit_line(edges, s, reach, place, normal)
    type(edges_t), intent(in) :: edges
    !> The edge
    integer, intent(in) :: s
    !> The distance
    real(wp), intent(in) :: reach
    !> Receive point and normal
    real(wp), intent(out) :: place(2), normal(2)
    type(neighbours_t) :: near
    real(wp) :: matrix(3, 3), fit(3), powers(3), weight
    integer :: t
    logical :: singular

    near = neighbours_of(edges, s, reach)
    normal = mean_normal(near, edges%normal(:, s), edges%width(s))
    matrix = 0
    fit = 0
    do t = 1, near%number
      weight = near%weight(t)*max(0.0_wp, dot_product(near%normal(:, t), normal))
      powers = [1.0_wp, dot_product(near%from(:, t), turned(normal))/reach, &
                (dot_product(near%from(:, t), turned(normal))/reach)**2]
      matrix = matrix + weight*spread(powers, 1, 3)*spread(powers, 2, 3)
      fit = fit + weight*powers*dot_product(near%from(:, t), normal)
    end do
    matrix(2, 2) = matrix(2, 2) + regularisation*matrix(1, 1)
    matrix(3, 3) = matrix(3, 3) + regularisation*matrix(1, 1)
    call solve_dense(matrix, fit, singular)
    if (singular) fit = 0
    place = edges%middle(:, s) + fit(1)*normal
    normal = normal - fit(2)/reach*turned(normal)
    normal = normal/norm2(normal)
  end subroutine fit_line

  !> Edges within a distance of an edge, with the images of a symmetric plate.
  pure function neighbours_of(edges, s, reach) result(near)
    type(edges_t), intent(in) :: edges
    !> The edge
    integer, intent(in) :: s
    !> The distance
    real(wp), intent(in) :: reach
    !> The edges near it
    type(neighbours_t) :: near
    real(wp) :: from(2), closeness
    integer :: t, image, n

    n = 4*size(edges%width)
    allocate (near%from(2, n), near%normal(2, n), near%weight(n))
    do image = 0, 3
      if (.not. is_image(image, edges%mirrored)) cycle
      do t = 1, size(edges%width)
        from = signs(image)*edges%middle(:, t) - edges%middle(:, s)
        closeness = 1 - norm2(from)/reach
        if (.not. closeness > 0) cycle
        near%number = near%number + 1
        near%from(:, near%number) = from
        near%normal(:, near%number) = signs(image)*edges%normal(:, t)
        near%weight(near%number) = closeness*edges%width(t)
      end do
    end do
  end function neighbours_of

  !> Mean normal of the edges around an edge. It is the normal of the edge itself where the others cancel, as on a front
  !> that faces another part of itself across one cell.
  pure function mean_normal(near, own, width) result(normal)
    !> The edges around it
    type(neighbours_t), intent(in) :: near
    !> Its own normal, and its length
    real(wp), intent(in) :: own(2), width
    real(wp) :: normal(2)
    real(wp) :: mean(2)
    integer :: t

    mean = 0
    do t = 1, near%number
      mean = mean + near%weight(t)*near%normal(:, t)
    end do
    normal = merge(mean/max(norm2(mean), tiny(mean)), own, norm2(mean) > cancellation*width)
  end function mean_normal

  !> Weighted sums along the line about a segment, with weights that decrease to zero within a distance.
  pure function means(self, s, reach, figures, odd) result(smooth)
    class(smooth_front_t), intent(in) :: self
    !> The segment
    integer, intent(in) :: s
    !> Distance of zero weight
    real(wp), intent(in) :: reach
    !> Quantities of each segment, integrated over its length, (quantities, segments)
    real(wp), intent(in) :: figures(:, :)
    !> True for quantities that change sign under reflection: those along the line
    logical, intent(in) :: odd(:)
    !> Their sums, weighted
    real(wp) :: smooth(size(figures, 1))
    real(wp) :: weight
    integer :: t, image

    smooth = 0
    do image = 0, 3
      if (.not. is_image(image, self%mirrored)) cycle
      do t = 1, size(self%length)
        weight = self%weight(s, t, image, reach)
        if (weight > 0) smooth = smooth + weight*merge(product(signs(image)), 1.0_wp, odd)*figures(:, t)
      end do
    end do
  end function means

  !> Weight of a segment, or of its image, in the mean of another: it decreases with the distance and with the cosine
  !> between the normals.
  pure real(wp) function weight(self, s, t, image, reach)
    class(smooth_front_t), intent(in) :: self
    !> The segment of the mean, and the other one
    integer, intent(in) :: s, t
    !> Image of the other one, 0 to 3; images that do not exist have weight 0
    integer, intent(in) :: image
    !> Distance of zero weight
    real(wp), intent(in) :: reach

    weight = 0
    if (.not. is_image(image, self%mirrored)) return
    weight = max(0.0_wp, 1 - norm2(signs(image)*self%place(:, t) - self%place(:, s))/reach)
    if (weight > 0) weight = weight*max(0.0_wp, dot_product(signs(image)*self%normal(:, t), self%normal(:, s)))
  end function weight

  !> Nodes within a few cells of the front.
  pure function nodes_near(self, segments, mesh) result(nodes)
    class(smooth_front_t), intent(in) :: self
    !> Its segments
    type(front_segment_t), intent(in) :: segments(:)
    type(layered_mesh_t), intent(in) :: mesh
    type(near_front_t) :: nodes
    integer, dimension((2*lines_beside + 1)**2*size(segments)) :: node, segment
    real(wp) :: away((2*lines_beside + 1)**2*size(segments))
    real(wp), allocatable :: least(:)
    integer, allocatable :: repeated(:)
    logical, allocatable :: is_closest(:)
    integer :: s, i, j, found, line(2)

    found = 0
    do s = 1, size(segments)
      if (segments(s)%at_border) cycle
      line = mesh%lines_of(segments(s)%edge(2))
      do j = max(0, line(2) - lines_beside), min(2*mesh%cells(2), line(2) + lines_beside)
        do i = max(0, line(1) - lines_beside), min(2*mesh%cells(1), line(1) + lines_beside)
          found = found + 1
          node(found) = mesh%node_at(i, j)
          segment(found) = s
          away(found) = norm2(mesh%node_coordinates(:, node(found)) - self%place(:, s))
        end do
      end do
    end do
    allocate (least(minval(node(:found)):maxval(node(:found))), source=huge(away))
    do i = 1, found
      least(node(i)) = min(least(node(i)), away(i))
    end do
    is_closest = away(:found) <= (1 + distance_tolerance)*least(node(:found)) &
                                 + distance_tolerance*self%ahead(segment(:found))
    nodes%node = pack(node(:found), is_closest)
    nodes%segment = pack(segment(:found), is_closest)
    allocate (repeated(lbound(least, 1):ubound(least, 1)), source=0)
    do i = 1, size(nodes%node)
      repeated(nodes%node(i)) = repeated(nodes%node(i)) + 1
    end do
    nodes%share = 1.0_wp/repeated(nodes%node)
    nodes%distance = [(dot_product(mesh%node_coordinates(:, nodes%node(i)) - self%place(:, nodes%segment(i)), &
                                   self%normal(:, nodes%segment(i))), i=1, size(nodes%node))]
  end function nodes_near

  !> True for the model, image 0, and for its existing images: 1 across x, 2 across y, 3 both.
  pure logical function is_image(image, mirrored)
    !> The image
    integer, intent(in) :: image
    !> Directions of symmetry
    logical, intent(in) :: mirrored(2)

    is_image = all(mirrored .or. signs(image) > 0)
  end function is_image

  !> Signs of x and y in an image.
  pure function signs(image)
    !> The image
    integer, intent(in) :: image
    real(wp) :: signs(2)

    signs = 1 - 2*[modulo(image, 2), image/2]
  end function signs

  !> Direction along the line: its normal rotated by 90 degrees.
  pure function turned(normal) result(along)
    !> The normal
    real(wp), intent(in) :: normal(2)
    real(wp) :: along(2)

    along = [-normal(2), normal(1)]
  end function turned
end module front_smoothing
