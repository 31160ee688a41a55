!> Means of a field over the surroundings of each element, within one layer of plies and never across the border of a
!> layer.
!>
!> Weights fall off in proportion to the distance of the elements' centres and go with their areas. Lines of symmetry
!> reflect, and the line that a turned plate is cut at turns: what lies beyond them counts with the sign that the
!> component has there.
module neighbourhoods
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: neighbourhood_t, neighbourhood_of

  !> How a component changes its sign on reflection: not at all, where x does, where y does, where one of both does.
  integer, parameter, public :: even = 1, odd_in_x = 2, odd_in_y = 3, odd_in_both = 4

  !> The elements around each of this rank's elements.
  type :: neighbourhood_t
    !> First entry of each element, (elements + 1)
    integer, allocatable, private :: start(:)
    !> Elements of the mesh, itself among them, (entries)
    integer, allocatable, private :: member(:)
    !> Their weights for components of each sign, those of `even` adding up to 1, (4, entries)
    real(wp), allocatable, private :: weight(:, :)
  contains
    !> Means of a field around each element.
    procedure :: means
  end type neighbourhood_t

contains

  !> Surroundings of some elements.
  pure function neighbourhood_of(mesh, elements, length) result(self)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Elements of the mesh whose surroundings are wanted
    integer, intent(in) :: elements(:)
    !> Distance at which an element no longer counts
    real(wp), intent(in) :: length
    !> Their surroundings
    type(neighbourhood_t) :: self
    integer, allocatable :: member(:)
    real(wp), allocatable :: weight(:, :)
    integer :: element

    allocate (self%start(size(elements) + 1))
    self%start(1) = 1
    do element = 1, size(elements)
      call find_members(mesh, elements(element), length, member, weight)
      self%start(element + 1) = self%start(element) + size(member)
    end do
    ! Found twice, since lists that grew with each element would be copied as often.
    allocate (self%member(self%start(size(elements) + 1) - 1), self%weight(4, self%start(size(elements) + 1) - 1))
    do element = 1, size(elements)
      call find_members(mesh, elements(element), length, member, weight)
      self%member(self%start(element):self%start(element + 1) - 1) = member
      self%weight(:, self%start(element):self%start(element + 1) - 1) = weight
    end do
  end function neighbourhood_of

  !> Elements around one element.
  pure subroutine find_members(mesh, element, length, member, weight)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Element of the mesh
    integer, intent(in) :: element
    !> Distance at which an element no longer counts
    real(wp), intent(in) :: length
    !> Elements of the mesh
    integer, allocatable, intent(out) :: member(:)
    !> Their weights, (4, members)
    real(wp), allocatable, intent(out) :: weight(:, :)
    integer, allocatable :: columns(:), rows(:)
    real(wp), allocatable :: x(:), y(:)
    integer :: place(2), j

    place = mesh%place_of(mesh%element_cell(element))
    call find_lines(mesh%x_edges, place(1), length, mesh%mirrored(1), columns, x)
    call find_lines(mesh%y_edges, place(2), length, mesh%mirrored(2), rows, y)
    allocate (member(0), weight(4, 0))
    call add_cells(mesh, element, length, columns, rows, x, y, member, weight)
    if (mesh%halved(1) .and. .not. mesh%mirrored(1)) then
      ! What lies beyond the line that a turned plate is cut at is the plate itself, turned.
      call find_lines(mesh%x_edges, place(1), length, .true., columns, x)
      x = pack(x, columns < 0)
      columns = pack(columns, columns < 0)
      rows = [(-j, j=1, mesh%cells(2))]
      y = [(-mesh%y_edges(j) - mesh%y_edges(j + 1) - mesh%y_edges(place(2)) - mesh%y_edges(place(2) + 1), &
            j=1, mesh%cells(2))]/2
      call add_cells(mesh, element, length, columns, rows, x, y, member, weight)
    end if
    weight = weight/sum(weight(even, :))
  end subroutine find_members

  !> Adds the elements on some columns and rows that are near enough.
  pure subroutine add_cells(mesh, element, length, columns, rows, x, y, member, weight)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Element of the mesh
    integer, intent(in) :: element
    !> Distance at which an element no longer counts
    real(wp), intent(in) :: length
    !> Columns and rows, negative: reflected
    integer, intent(in) :: columns(:), rows(:)
    !> Their distances from the element
    real(wp), intent(in) :: x(:), y(:)
    !> Elements of the mesh
    integer, allocatable, intent(inout) :: member(:)
    !> Their weights, (4, members)
    real(wp), allocatable, intent(inout) :: weight(:, :)
    real(wp) :: share
    integer :: i, j, other

    do j = 1, size(rows)
      do i = 1, size(columns)
        if (norm2([x(i), y(j)]) >= length) cycle
        other = element_of_layer(mesh, mesh%cell_at(abs(columns(i)), abs(rows(j))), mesh%element_plies(:, element))
        if (other == 0) cycle
        share = (1 - norm2([x(i), y(j)])/length)*mesh%cell_area(abs([columns(i), rows(j)]))
        member = [member, other]
        weight = reshape([weight, share*[1, sign(1, columns(i)), sign(1, rows(j)), &
                                         sign(1, columns(i))*sign(1, rows(j))]], [4, size(member)])
      end do
    end do
  end subroutine add_cells

  !> Columns, or rows, whose centres are nearer than a length to that of one of them, with their distances.
  pure subroutine find_lines(edges, here, length, mirrored, lines, distances)
    !> Edges of the columns, (columns + 1)
    real(wp), intent(in) :: edges(:)
    !> The column
    integer, intent(in) :: here
    !> The length
    real(wp), intent(in) :: length
    !> True: the first edge is a line of symmetry
    logical, intent(in) :: mirrored
    !> The columns found, itself among them, negative: reflected
    integer, allocatable, intent(out) :: lines(:)
    !> Distances from the column
    real(wp), allocatable, intent(out) :: distances(:)
    real(wp) :: centres(size(edges) - 1)
    integer :: i

    centres = (edges(:size(centres)) + edges(2:))/2
    lines = [(i, i=1, size(centres))]
    distances = centres - centres(here)
    if (mirrored) then
      lines = [lines, -lines]
      distances = [distances, 2*edges(1) - centres - centres(here)]
    end if
    lines = pack(lines, abs(distances) < length)
    distances = pack(distances, abs(distances) < length)
  end subroutine find_lines

  !> Element of a cell with the same plies; 0: the cell has none.
  pure integer function element_of_layer(mesh, cell, plies) result(element)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Cell
    integer, intent(in) :: cell
    !> First and last ply
    integer, intent(in) :: plies(2)

    element = mesh%element_at(cell, plies(1))
    if (any(mesh%element_plies(:, element) /= plies)) element = 0
  end function element_of_layer

  !> Means of a field around each element.
  pure function means(self, field, signs)
    !> The surroundings
    class(neighbourhood_t), intent(in) :: self
    !> Field of all elements of the mesh, (components, elements of the mesh)
    real(wp), intent(in) :: field(:, :)
    !> How each component changes its sign on reflection, (components)
    integer, intent(in) :: signs(:)
    !> The means, (components, elements)
    real(wp) :: means(size(field, 1), size(self%start) - 1)
    integer :: element, entry

    means = 0
    do element = 1, size(means, 2)
      do entry = self%start(element), self%start(element + 1) - 1
        means(:, element) = means(:, element) + self%weight(signs, entry)*field(:, self%member(entry))
      end do
    end do
  end function means
end module neighbourhoods
