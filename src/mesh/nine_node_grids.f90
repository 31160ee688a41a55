!> Numbers of the cells and nodes of a grid of nine-node cells.
!>
!> Cells count by columns, x fastest. Nodes lie where two lines of nodes cross; lines along x and y count from 0 at the
!> low border. Cell c lies between lines 2c - 2 and 2c, and line 2c - 1 halves it.
module nine_node_grids
  implicit none
  private
  public :: nine_node_grid_t, first_line, middle_line, last_line, cells_around, lines_around

  !> A grid, given by its number of cells.
  type :: nine_node_grid_t
    !> Cells along x and y
    integer :: cells(2) = 0
  contains
    procedure, non_overridable :: cell_at
    procedure, non_overridable :: place_of
    procedure, non_overridable :: node_at
    procedure, non_overridable :: lines_of
    procedure, non_overridable :: cell_nodes
  end type nine_node_grid_t

contains

  !> Line of nodes on the low border of a column or row of cells.
  elemental integer function first_line(cell) result(line)
    integer, intent(in) :: cell
    line = 2*cell - 2
  end function first_line

  !> Line of nodes through the middle of a column or row of cells.
  elemental integer function middle_line(cell) result(line)
    integer, intent(in) :: cell
    line = 2*cell - 1
  end function middle_line

  !> Line of nodes on the high border of a column or row of cells; of all cells: the grid's last line.
  elemental integer function last_line(cell) result(line)
    integer, intent(in) :: cell
    line = 2*cell
  end function last_line

  !> First and last of the cells that touch a line of nodes.
  pure function cells_around(line, cells) result(range)
    !> Line of nodes
    integer, intent(in) :: line
    !> Cells along this direction
    integer, intent(in) :: cells
    !> First and last cell
    integer :: range(2)
    range = [max(1, (line + 1)/2), min(cells, line/2 + 1)]
  end function cells_around

  !> First and last of the lines of nodes that share a cell with a line.
  pure function lines_around(line, cells) result(range)
    !> Line of nodes
    integer, intent(in) :: line
    !> Cells along this direction
    integer, intent(in) :: cells
    !> First and last line
    integer :: range(2)

    range = cells_around(line, cells)
    range = [first_line(range(1)), last_line(range(2))]
  end function lines_around

  !> Cell of a column and a row.
  pure integer function cell_at(self, column, row) result(cell)
    class(nine_node_grid_t), intent(in) :: self
    !> Column and row, from 1
    integer, intent(in) :: column, row
    cell = column + self%cells(1)*(row - 1)
  end function cell_at

  !> Column and row of a cell.
  pure function place_of(self, cell) result(place)
    class(nine_node_grid_t), intent(in) :: self
    integer, intent(in) :: cell
    !> Column and row, from 1
    integer :: place(2)
    place = [1 + modulo(cell - 1, self%cells(1)), 1 + (cell - 1)/self%cells(1)]
  end function place_of

  !> Node on two lines of nodes.
  pure integer function node_at(self, i, j) result(node)
    class(nine_node_grid_t), intent(in) :: self
    !> Lines of nodes of one x and of one y, 0 to twice the cells
    integer, intent(in) :: i, j
    node = 1 + i + (2*self%cells(1) + 1)*j
  end function node_at

  !> The two lines of nodes that cross at a node.
  pure function lines_of(self, node) result(lines)
    class(nine_node_grid_t), intent(in) :: self
    integer, intent(in) :: node
    !> Lines of nodes of one x and of one y, 0 to twice the cells
    integer :: lines(2)
    lines = [modulo(node - 1, 2*self%cells(1) + 1), (node - 1)/(2*self%cells(1) + 1)]
  end function lines_of

  !> The nine nodes of a cell, tensor order.
  pure function cell_nodes(self, cell) result(nodes)
    class(nine_node_grid_t), intent(in) :: self
    integer, intent(in) :: cell
    !> Nodes
    integer :: nodes(9)
    integer :: place(2), corner, i, j

    place = first_line(self%place_of(cell))
    corner = self%node_at(place(1), place(2))
    nodes = [((corner + i + (2*self%cells(1) + 1)*j, i=0, 2), j=0, 2)]
  end function cell_nodes
end module nine_node_grids
