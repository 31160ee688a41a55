!> The pattern of the matrix: an unknown is coupled to all unknowns at the nodes that share a cell with its node, or
!> with a node constrained to it on the cut line of point symmetry.
module matrix_patterns
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: lines_around
  implicit none
  private
  public :: find_pattern

contains

  !> Columns of some rows.
  pure subroutine find_pattern(mesh, equation, nodes, row_start, columns, folded)
    type(layered_mesh_t), intent(in) :: mesh
    !> Equation (from 0) of every unknown of the mesh; -1: fixed, (5, points)
    integer, intent(in) :: equation(:, :)
    !> Node of each row; consecutive rows of one node have the same columns
    integer, intent(in) :: nodes(:)
    !> Start of each row, from 1, (rows + 1)
    integer, allocatable, intent(out) :: row_start(:)
    !> Columns, from 0, ascending in each row
    integer, allocatable, intent(out) :: columns(:)
    !> True: points may have the equations of their images, everywhere in the plate
    logical, intent(in) :: folded
    integer, allocatable :: around(:)
    integer :: row, node, width

    allocate (row_start(size(nodes) + 1))
    row_start(1) = 1
    node = 0
    do row = 1, size(nodes)
      if (nodes(row) /= node) width = columns_around(mesh, equation, nodes(row), folded)
      node = nodes(row)
      row_start(row + 1) = row_start(row) + width
    end do
    allocate (columns(row_start(size(row_start)) - 1))
    node = 0
    do row = 1, size(nodes)
      if (nodes(row) /= node) call list_columns(mesh, equation, nodes(row), folded, around)
      columns(row_start(row):row_start(row + 1) - 1) = around
      node = nodes(row)
    end do
  end subroutine find_pattern

  !> Number of equations that a node is coupled to.
  pure integer function columns_around(mesh, equation, node, folded) result(columns)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: equation(:, :)
    integer, intent(in) :: node
    !> True: points may have the equations of their images, everywhere in the plate
    logical, intent(in) :: folded
    integer, allocatable :: list(:)
    integer :: lines, first(5), last(5), line

    if (folded .or. near_cut(mesh, node)) then
      call list_columns(mesh, equation, node, folded, list)
      columns = size(list)
      return
    end if
    call find_points_around(mesh, node, lines, first, last)
    columns = 0
    do line = 1, lines
      columns = columns + count(equation(:, first(line):last(line)) >= 0)
    end do
  end function columns_around

  !> True for a node that shares a cell with the cut of a plate with point symmetry: equations may occur twice around
  !> this node, and the equations around its image are coupled, too.
  pure logical function near_cut(mesh, node)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: node
    integer :: lines(2)

    lines = mesh%lines_of(node)
    near_cut = mesh%halved(1) .and. .not. mesh%mirrored(1) .and. lines(1) <= 2
  end function near_cut

  !> The equations that a node is coupled to, ascending.
  pure subroutine list_columns(mesh, equation, node, folded, columns)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: equation(:, :)
    integer, intent(in) :: node
    !> True: points may have the equations of their images, everywhere in the plate
    logical, intent(in) :: folded
    !> Equations, from 0, (`columns_around` of them)
    integer, allocatable, intent(out) :: columns(:)
    integer :: image

    columns = equations_around(mesh, equation, node)
    image = mesh%turned_node(node)
    if (image > 0 .and. image /= node) columns = [columns, equations_around(mesh, equation, image)]
    call sort(columns)
    if (folded .or. near_cut(mesh, node)) columns = pack(columns, [.true., columns(2:) > columns(:size(columns) - 1)])
  end subroutine list_columns

  !> Equations of all points at the nodes that share a cell with a node.
  pure function equations_around(mesh, equation, node) result(list)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: equation(:, :)
    integer, intent(in) :: node
    !> Equations, from 0
    integer, allocatable :: list(:)
    integer :: lines, first(5), last(5), line, point, component, found

    call find_points_around(mesh, node, lines, first, last)
    found = 0
    do line = 1, lines
      found = found + count(equation(:, first(line):last(line)) >= 0)
    end do
    allocate (list(found))
    found = 0
    do line = 1, lines
      do point = first(line), last(line)
        do component = 1, 5
          if (equation(component, point) < 0) cycle
          found = found + 1
          list(found) = equation(component, point)
        end do
      end do
    end do
  end function equations_around

  !> First and last point on each line of nodes, of those that share a cell with a node.
  pure subroutine find_points_around(mesh, node, lines, first, last)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: node
    !> Number of lines
    integer, intent(out) :: lines
    !> Points of each
    integer, intent(out) :: first(5), last(5)
    integer :: i(2), j(2), here(2), line

    here = mesh%lines_of(node)
    i = lines_around(here(1), mesh%cells(1))
    j = lines_around(here(2), mesh%cells(2))
    lines = j(2) - j(1) + 1
    do line = 1, lines
      first(line) = mesh%first_point(mesh%node_at(i(1), j(1) + line - 1))
      last(line) = mesh%first_point(mesh%node_at(i(2), j(1) + line - 1) + 1) - 1
    end do
  end subroutine find_points_around

  !> Sorts a short list that consists of few ascending runs by insertion, which is linear for such lists.
  pure subroutine sort(list)
    !> The list
    integer, intent(inout) :: list(:)
    integer :: i, j, value

    do i = 2, size(list)
      value = list(i)
      j = i - 1
      do while (j >= 1)
        if (list(j) <= value) exit
        list(j + 1) = list(j)
        j = j - 1
      end do
      list(j + 1) = value
    end do
  end subroutine sort
end module matrix_patterns
