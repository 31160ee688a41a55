!> Nodes of an interface before and behind each of its points along the lines of nodes, for virtual crack closure.
module front_stencils
  use column_exchanges, only: column_exchange_t, new_column_exchange
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use composite_plates, only: composite_plate_t
  use nine_node_grids, only: cells_around, first_line, last_line
  implicit none
  private
  public :: front_stencils_t, create_front_stencils

  !> Directions of growth: along x, against x, along y, against y.
  integer, parameter :: steps(2, 4) = reshape([1, 0, -1, 0, 0, 1, 0, -1], [2, 4])
  !> Nodes of a stencil: the one ahead, and those one and two nodes behind.
  integer, parameter, public :: ahead = 1, behind = 2, far_behind = 3
  !> Signs of the jumps and tractions, two shears and opening, of a point itself, of its images mirrored in x and in y,
  !> and of its image under point symmetry.
  real(wp), parameter, public :: jump_signs(3, 0:3) = reshape(real([1, 1, 1, -1, 1, 1, 1, -1, 1, -1, -1, 1], wp), &
                                                               [3, 4])

  !> The stencils of this rank's points.
  type :: front_stencils_t
    !> Points of this rank with an interface, (n)
    integer, allocatable :: points(:)
    !> Points of the mesh ahead, behind and two behind; 0: none, (3, directions, n)
    integer, allocatable :: near(:, :, :)
    !> Which of them are images by symmetry, and of which kind: columns of `jump_signs`, (3, directions, n)
    integer, allocatable :: images(:, :, :)
    !> Lengths along the direction that belong to the point and to the node ahead, (2, directions, n)
    real(wp), allocatable :: widths(:, :, :)
    !> Exchange of values at points of the mesh between ranks
    type(column_exchange_t) :: exchange
  end type front_stencils_t

contains

  !> Stencils of a plate. Collective.
  function create_front_stencils(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(front_stencils_t) :: self
    integer, allocatable :: groups(:, :)
    logical, allocatable :: mine(:)
    integer :: i, near(3, 4), images(3, 4)
    real(wp) :: widths(2, 4)

    associate (mesh => plate%mesh, parts => plate%distribution)
      self%points = pack([(i, i=1, parts%owned)], plate%zone(:parts%owned) > 0)
      allocate (self%near(3, 4, size(self%points)), self%images(3, 4, size(self%points)), &
                self%widths(2, 4, size(self%points)))
      do i = 1, size(self%points)
        call find_stencil(mesh, parts%points(self%points(i)), self%near(:, :, i), self%images(:, :, i), &
                          self%widths(:, :, i))
      end do
      if (plate%communicator%size == 1) return
      allocate (groups(13, mesh%points()))
      allocate (mine(mesh%points()), source=.false.)
      mine(parts%points(:parts%owned)) = .true.
      ! A point and those of its stencil, each of which has the point in its own stencil.
      do i = 1, mesh%points()
        near = 0
        if (mesh%point_zone(i) > 0) call find_stencil(mesh, i, near, images, widths)
        groups(:, i) = [i, reshape(near, [12])]
      end do
      self%exchange = new_column_exchange(plate%communicator, mine, groups)
    end associate
  end function create_front_stencils

  !> Stencil of a point in all directions of growth.
  pure subroutine find_stencil(mesh, point, near, images, widths)
    type(layered_mesh_t), intent(in) :: mesh
    !> Point of the mesh, with an interface
    integer, intent(in) :: point
    !> Points ahead and behind, (3, directions)
    integer, intent(out) :: near(3, 4)
    !> Columns of `jump_signs`, (3, directions)
    integer, intent(out) :: images(3, 4)
    !> Lengths, (2, directions)
    real(wp), intent(out) :: widths(2, 4)
    !> From the point to the nodes of the stencil, in steps of the direction
    integer, parameter :: away(3) = [1, -1, -2]
    integer :: lines(2), d, k, along

    lines = mesh%lines_of(mesh%point_node(point))
    do d = 1, size(steps, 2)
      associate (zone => mesh%point_zone(point), step => steps(:, d))
        do k = 1, size(away)
          call find_point(mesh, zone, lines + away(k)*step, near(k, d), images(k, d))
        end do
        along = merge(1, 2, abs(step(1)) > 0)
        widths(:, d) = [width_of(mesh, zone, along, lines), width_of(mesh, zone, along, lines + step)]
      end associate
    end do
  end subroutine find_stencil

  !> Point of an interface at the crossing of two lines of nodes.
  pure subroutine find_point(mesh, zone, lines, point, image)
    type(layered_mesh_t), intent(in) :: mesh
    !> Zone of the interface
    integer, intent(in) :: zone
    !> Lines of nodes of one x and of one y, which may lie beyond the model
    integer, intent(in) :: lines(2)
    !> The point, or that whose image is there; 0: none
    integer, intent(out) :: point
    !> Column of `jump_signs`
    integer, intent(out) :: image
    integer :: at(2)

    point = 0
    call fold(mesh, lines, at, image)
    if (any(at < 0 .or. at > last_line(mesh%cells))) return
    point = mesh%lower_point(mesh%node_at(at(1), at(2)), zone)
    if (point == 0) return
    if (mesh%master(point) == 0) return
    point = mesh%master(point)
    image = ieor(image, 3)
  end subroutine find_point

  !> Lines of the model whose image by symmetry two lines beyond it are.
  pure subroutine fold(mesh, lines, at, image)
    type(layered_mesh_t), intent(in) :: mesh
    !> Lines of nodes of one x and of one y, which may lie beyond the model
    integer, intent(in) :: lines(2)
    !> The lines of the model; themselves if they are
    integer, intent(out) :: at(2)
    !> Column of `jump_signs`, whose bits are the mirrored directions
    integer, intent(out) :: image
    integer :: k

    at = lines
    image = 0
    if (lines(1) < 0 .and. mesh%halved(1) .and. .not. mesh%mirrored(1)) then
      at = [-lines(1), last_line(mesh%cells(2)) - lines(2)]
      image = 3
    end if
    do k = 1, 2
      if (.not. (at(k) < 0 .and. mesh%halved(k) .and. mesh%mirrored(k))) cycle
      at(k) = -at(k)
      image = ieor(image, k)
    end do
  end subroutine fold

  !> Length that belongs to a line of nodes, by the integrals of the shape functions; 0 beyond the plate or the
  !> doublers.
  pure real(wp) function width_of(mesh, zone, along, lines) result(width)
    type(layered_mesh_t), intent(in) :: mesh
    !> Zone of the interface, and direction, 1 or 2
    integer, intent(in) :: zone, along
    !> Lines of nodes of one x and of one y
    integer, intent(in) :: lines(2)
    integer :: at(2), cell, line, image

    width = 0
    call fold(mesh, lines, at, image)
    line = at(along)
    if (line < 0 .or. line > last_line(mesh%cells(along))) return
    cell = line/2 + 1
    if (modulo(line, 2) == 1) then
      width = 2*side(cell)/3
    else
      if (cell <= mesh%cells(along)) width = side(cell)/6
      if (line > first_line(1)) then
        width = width + side(cell - 1)/6
      else if (mesh%halved(along)) then
        width = 2*width
      end if
    end if

  contains

    !> Side of a column or row of cells; 0 where there is no doubler beside the line across them.
    pure real(wp) function side(cell)
      !> Its number
      integer, intent(in) :: cell
      integer :: beside(2), place(2), k
      logical :: covered

      side = mesh%along(along)%side(cell)
      if (.not. allocated(mesh%zones(zone)%bonded)) return
      beside = cells_around(at(3 - along), mesh%cells(3 - along))
      place(along) = cell
      covered = .false.
      do k = beside(1), beside(2)
        place(3 - along) = k
        covered = covered .or. mesh%in_zone(zone, mesh%cell_at(place(1), place(2)))
      end do
      if (.not. covered) side = 0
    end function side
  end function width_of
end module front_stencils
