!> Elastic edges of the plate: springs against deflection and rotation about the edge, both per length, at three Gauss
!> points on each side of a cell.
module elastic_edges
  use cell_grids, only: cell_grid_t
  use kinds, only: wp
  use mesh_parameters, only: plate_t, edge_elastic
  implicit none
  private
  public :: edge_spring_t, edge_springs

  !> A spring on the side of a cell.
  type :: edge_spring_t
    !> The three of the cell's nine nodes on that side
    integer :: nodes(3) = 0
    !> Weights of their unknowns
    real(wp) :: weights(3) = 0
    !> The unknown: 3 for w, 4 for theta_x, 5 for theta_y
    integer :: component = 0
    !> Its stiffness, force per length or moment
    real(wp) :: stiffness = 0
  end type edge_spring_t

  !> Nodes of a cell on its sides at x-min, x-max, y-min, y-max.
  integer, parameter :: sides(3, 4) = reshape([1, 4, 7, 3, 6, 9, 1, 2, 3, 7, 8, 9], [3, 4])
  !> Abscissas and weights of the rule.
  real(wp), parameter :: outer = sqrt(0.6_wp), abscissa(3) = [-outer, 0.0_wp, outer], &
                         weight(3) = [5, 8, 5]/9.0_wp

contains

  !> Springs on the sides of a cell.
  pure function edge_springs(grid, plate, cell) result(springs)
    class(cell_grid_t), intent(in) :: grid
    type(plate_t), intent(in) :: plate
    integer, intent(in) :: cell
    type(edge_spring_t), allocatable :: springs(:)
    integer :: place(2), edge, normal
    logical :: borders(4)

    allocate (springs(0))
    if (all(plate%edges /= edge_elastic)) return
    place = grid%place_of(cell)
    borders = [place(1) == 1 .and. .not. grid%halved(1), place(1) == grid%cells(1), &
               place(2) == 1 .and. .not. grid%halved(2), place(2) == grid%cells(2)]
    do edge = 1, 4
      if (.not. borders(edge) .or. plate%edges(edge) /= edge_elastic) cycle
      normal = (edge + 1)/2
      call add_springs(grid, grid%cell_nodes(cell), sides(:, edge), 3, plate%edge_stiffness(1), springs)
      call add_springs(grid, grid%cell_nodes(cell), sides(:, edge), 3 + normal, plate%edge_stiffness(2), springs)
    end do
  end function edge_springs

  !> Adds the springs of one unknown on one side.
  pure subroutine add_springs(grid, nodes, side, component, stiffness, springs)
    class(cell_grid_t), intent(in) :: grid
    !> Nodes of the cell, and those on the side
    integer, intent(in) :: nodes(9), side(3)
    !> The unknown
    integer, intent(in) :: component
    !> Stiffness per length of the edge; 0: none
    real(wp), intent(in) :: stiffness
    type(edge_spring_t), allocatable, intent(inout) :: springs(:)
    real(wp) :: length
    integer :: i

    if (.not. stiffness > 0) return
    length = norm2(grid%node_coordinates(:, nodes(side(3))) - grid%node_coordinates(:, nodes(side(1))))
    do i = 1, 3
      associate (xi => abscissa(i))
        springs = [springs, edge_spring_t(side, [xi*(xi - 1)/2, 1 - xi**2, xi*(xi + 1)/2], component, &
                                          stiffness*weight(i)*length/2)]
      end associate
    end do
  end subroutine add_springs
end module elastic_edges
