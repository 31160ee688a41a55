!> Fixed unknowns of the points: by supports, by symmetry, by ties between layers, or because they are always zero.
module supports
  use kinds, only: wp
  use mesh_parameters, only: plate_t, edge_free, edge_clamped, edge_elastic, in_plane_fixed, in_plane_tangential
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: last_line
  implicit none
  private
  public :: fixed_unknowns, fixed_by_edge

contains

  !> Table of the unknowns fixed by supports and symmetry, and of all in-plane displacements if they are zero.
  pure function fixed_unknowns(mesh, plate, membrane_idle, pin_plane) result(fixed)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    !> True: u and v are zero and need no equations
    logical, intent(in) :: membrane_idle
    !> In-plane rigid-body motions without support: along x, along y, rotation
    logical, intent(in) :: pin_plane(3)
    !> (5, points): u, v, w, theta_x, theta_y
    logical, allocatable :: fixed(:, :)
    integer :: point

    allocate (fixed(5, mesh%points()), source=.false.)
    do point = 1, mesh%points()
      fixed(:, point) = fixed_on_borders(mesh, plate, mesh%lines_of(mesh%point_node(point)))
      if (mesh%turned_node(mesh%point_node(point)) == mesh%point_node(point)) fixed([1, 2, 4, 5], point) = .true.
      if (membrane_idle) fixed(1:2, point) = .true.
    end do
    call pin(mesh, pin_plane, fixed)
  end function fixed_unknowns

  !> Unknowns fixed at a node by the borders it is on.
  pure function fixed_on_borders(mesh, plate, line) result(fixed)
    type(layered_mesh_t), intent(in) :: mesh
    type(plate_t), intent(in) :: plate
    !> Lines of nodes along x and y that the node lies on, from 0
    integer, intent(in) :: line(2)
    !> u, v, w, theta_x, theta_y
    logical :: fixed(5)
    integer :: direction

    fixed = .false.
    do direction = 1, 2
      if (line(direction) == 0) then
        if (mesh%mirrored(direction)) then
          fixed([direction, 3 + direction]) = .true.
        else if (.not. mesh%halved(direction)) then
          fixed = fixed .or. fixed_by_edge(plate%edges(2*direction - 1), direction, plate)
        end if
      else if (line(direction) == last_line(mesh%cells(direction))) then
        fixed = fixed .or. fixed_by_edge(plate%edges(2*direction), direction, plate)
      end if
    end do
  end function fixed_on_borders

  !> Unknowns fixed by one edge. A simple support is a hard one: it also fixes the rotation along the edge. An elastic
  !> edge leaves this rotation free.
  pure function fixed_by_edge(edge, normal, plate) result(fixed)
    !> Kind of support
    integer, intent(in) :: edge
    !> Direction of the edge's normal: 1 for x, 2 for y
    integer, intent(in) :: normal
    type(plate_t), intent(in) :: plate
    !> u, v, w, theta_x, theta_y
    logical :: fixed(5)

    fixed = .false.
    if (edge == edge_free) return
    fixed(3) = edge /= edge_elastic .or. .not. plate%edge_stiffness(1) > 0
    fixed(3 + 3 - normal) = fixed(3)
    if (edge == edge_clamped) fixed(4:5) = .true.
    if (plate%in_plane == in_plane_fixed) fixed(1:2) = .true.
    if (plate%in_plane == in_plane_tangential) fixed(3 - normal) = .true.
  end function fixed_by_edge

  !> Fixes the in-plane rigid-body motions that symmetry does not exclude: displacements at the struck node, and the
  !> rotation at the node beside it along x.
  pure subroutine pin(mesh, motions, fixed)
    type(layered_mesh_t), intent(in) :: mesh
    !> Those to be fixed: along x, along y, rotation
    logical, intent(in) :: motions(3)
    !> Table of constrained unknowns
    logical, intent(inout) :: fixed(:, :)
    integer :: node
    logical :: left(3)

    left = motions .and. .not. [mesh%mirrored, any(mesh%mirrored)]
    node = mesh%struck_node
    associate (here => mesh%first_point(node), beside => mesh%first_point(node + 1))
      fixed(1:2, here) = fixed(1:2, here) .or. left(1:2)
      fixed(2, beside) = fixed(2, beside) .or. left(3)
    end associate
  end subroutine pin
end module supports
