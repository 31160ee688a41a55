!> Images of the points of a full plate with mirror or point symmetry.
!>
!> With failure, the equations of such a plate have solutions besides the symmetric one, and round-off would choose
!> among them: the result would depend on the number of ranks, on units and on the orientation, and differ from that of
!> the modelled part. Images therefore share their equations (`numberings`), and every solution is bitwise symmetric.
module symmetry_images
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use mesh_parameters, only: image_signs, symmetry_none
  use nine_node_grids, only: last_line, middle_line
  implicit none
  private
  public :: symmetry_images_t, find_images

  !> Sign that a mirror image in x or in y gives to u, v, w, theta_x, theta_y, (5, 2).
  real(wp), parameter :: signs_of(5, 2) = reshape([-1.0_wp, 1.0_wp, 1.0_wp, -1.0_wp, 1.0_wp, &
                                                   1.0_wp, -1.0_wp, 1.0_wp, 1.0_wp, -1.0_wp], [5, 2])

  !> Images of all points.
  type :: symmetry_images_t
    !> Points of the mesh that are images of a point, (points of the mesh, images); unallocated: none. With three
    !> images, the third is the first image of the second.
    integer, allocatable :: points(:, :)
    !> Signs of their motion, (5, images)
    real(wp), allocatable :: signs(:, :)
  contains
    procedure :: first_cells
  end type symmetry_images_t

contains

  !> The images of a full plate's points. There are none if mesh or supports differ from their own image in the last
  !> digit.
  pure function find_images(mesh, symmetry, fixed) result(self)
    !> The mesh of the full plate
    type(layered_mesh_t), intent(in) :: mesh
    !> Symmetry of the plate, one of `mesh_parameters`
    integer, intent(in) :: symmetry
    !> Unknowns fixed by supports, (5, points of the mesh)
    logical, intent(in) :: fixed(:, :)
    type(symmetry_images_t) :: self
    logical, allocatable :: flips(:, :)
    integer, allocatable :: points(:, :)
    integer :: k

    if (symmetry == symmetry_none) return
    flips = image_signs(symmetry) < 0
    allocate (points(mesh%points(), size(flips, 2)))
    do k = 1, size(points, 2)
      points(:, k) = image_of_points(mesh, flips(:, k))
      if (any(points(:, k) == 0)) return
      if (any(fixed(:, points(:, k)) .neqv. fixed)) return
    end do
    self%points = points
    self%signs = reshape([(merge(signs_of(:, 1), 1.0_wp, flips(1, k))*merge(signs_of(:, 2), 1.0_wp, flips(2, k)), &
                           k=1, size(points, 2))], [5, size(points, 2)])
  end function find_images

  !> Image of each point; 0: there is none.
  pure function image_of_points(mesh, flips) result(images)
    type(layered_mesh_t), intent(in) :: mesh
    !> True for coordinates that change their sign
    logical, intent(in) :: flips(2)
    !> Points of the mesh, (points of the mesh)
    integer :: images(mesh%points())
    integer :: node, image, points, point

    images = 0
    do node = 1, mesh%nodes()
      associate (lines => mesh%lines_of(node))
        image = mesh%node_at(merge(last_line(mesh%cells(1)) - lines(1), lines(1), flips(1)), &
                             merge(last_line(mesh%cells(2)) - lines(2), lines(2), flips(2)))
      end associate
      associate (here => mesh%node_coordinates(:, node), there => mesh%node_coordinates(:, image), &
                 first => mesh%first_point(node), first_there => mesh%first_point(image))
        points = mesh%first_point(node + 1) - first
        if (any(abs(here - merge(-there, there, flips)) > 0)) cycle
        if (mesh%first_point(image + 1) - first_there /= points) cycle
        if (any(mesh%point_zone(first:first + points - 1) /= mesh%point_zone(first_there:first_there + points - 1))) &
          cycle
        images(first:first + points - 1) = [(point, point=first_there, first_there + points - 1)]
      end associate
    end do
  end function image_of_points

  !> First of the images of each cell, including the cell itself.
  pure function first_cells(self, mesh) result(first)
    class(symmetry_images_t), intent(in) :: self
    type(layered_mesh_t), intent(in) :: mesh
    !> Cells, (cells)
    integer :: first(product(mesh%cells))
    integer :: cell, k, point, lines(2)

    first = [(cell, cell=1, size(first))]
    if (.not. allocated(self%points)) return
    do cell = 1, size(first)
      lines = middle_line(mesh%place_of(cell))
      point = mesh%first_point(mesh%node_at(lines(1), lines(2)))
      do k = 1, size(self%points, 2)
        ! The middle of a cell lies between two lines of nodes each way.
        lines = mesh%lines_of(mesh%point_node(self%points(point, k)))/2 + 1
        first(cell) = min(first(cell), mesh%cell_at(lines(1), lines(2)))
      end do
    end do
  end function first_cells
end module symmetry_images
