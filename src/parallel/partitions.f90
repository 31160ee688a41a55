!> Who computes what: elements are shared out among the ranks so that few neighbours are separated,
!> by METIS (Karypis and Kumar, SIAM J. Sci. Comput. 20, 1998), which is deterministic.
module partitions
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_ptr, c_null_ptr, c_loc, c_f_pointer
  use errors, only: error_t, fail, exit_usage, exit_internal
  implicit none
  private
  public :: element_graph, partition_graph

  !> METIS' code for success
  integer(c_int32_t), parameter :: metis_ok = 1
  !> Two elements are neighbours when they share an edge, which has three nodes
  integer(c_int32_t), parameter :: nodes_of_edge = 3

  interface
    !> Graph of the elements of a mesh; `row_start` and `neighbours` are allocated by METIS.
    integer(c_int32_t) function metis_mesh_to_dual(elements, nodes, element_start, element_nodes, common, numbering, &
                                                   row_start, neighbours) bind(c, name='METIS_MeshToDual')
      import :: c_int32_t, c_ptr
      !> Numbers of elements and of nodes
      integer(c_int32_t), intent(in) :: elements, nodes
      !> Where each element's nodes begin, and the nodes
      integer(c_int32_t), intent(inout) :: element_start(*), element_nodes(*)
      !> Nodes that neighbours have in common; first index of all lists
      integer(c_int32_t), intent(in) :: common, numbering
      !> Where each element's neighbours begin, and the neighbours
      type(c_ptr), intent(out) :: row_start, neighbours
    end function metis_mesh_to_dual

    !> Frees what METIS allocated.
    integer(c_int32_t) function metis_free(memory) bind(c, name='METIS_Free')
      import :: c_int32_t, c_ptr
      !> Memory of METIS
      type(c_ptr), value :: memory
    end function metis_free

    !> Partition of a graph into parts of equal weight, few edges being cut.
    integer(c_int32_t) function metis_partition(vertices, constraints, row_start, neighbours, vertex_weights, &
                                                vertex_sizes, edge_weights, parts, target_weights, imbalance, &
                                                options, edge_cut, part_of) bind(c, name='METIS_PartGraphKway')
      import :: c_int32_t, c_ptr
      !> Number of vertices, and of weights a vertex
      integer(c_int32_t), intent(in) :: vertices, constraints
      !> Where each vertex' neighbours begin, and the neighbours, from 0
      integer(c_int32_t), intent(in) :: row_start(*), neighbours(*)
      !> Optional lists, which may be null
      type(c_ptr), value :: vertex_weights, vertex_sizes, edge_weights
      !> Number of parts
      integer(c_int32_t), intent(in) :: parts
      !> Optional lists, which may be null
      type(c_ptr), value :: target_weights, imbalance, options
      !> Number of edges cut
      integer(c_int32_t), intent(out) :: edge_cut
      !> Part of each vertex, from 0
      integer(c_int32_t), intent(out) :: part_of(*)
    end function metis_partition
  end interface

contains

  !> Which elements share an edge.
  subroutine element_graph(connectivity, nodes, row_start, neighbours, error)
    !> Nodes of each element, shape (9, elements), from 1
    integer, intent(in) :: connectivity(:, :)
    !> Number of nodes
    integer, intent(in) :: nodes
    !> Where each element's neighbours begin, shape (elements + 1)
    integer, allocatable, intent(out) :: row_start(:)
    !> Neighbours of all elements, one after the other, from 1
    integer, allocatable, intent(out) :: neighbours(:)
    !> Raised when METIS fails
    type(error_t), allocatable, intent(inout) :: error
    integer(c_int32_t) :: element_start(size(connectivity, 2) + 1), status
    integer(c_int32_t), allocatable :: element_nodes(:)
    integer(c_int32_t), pointer :: starts(:), list(:)
    type(c_ptr) :: starts_memory, list_memory
    integer :: e, elements

    elements = size(connectivity, 2)
    element_start = [(size(connectivity, 1)*(e - 1), e=1, elements + 1)]
    element_nodes = reshape(connectivity, [size(connectivity)]) - 1
    status = metis_mesh_to_dual(elements, nodes, element_start, element_nodes, nodes_of_edge, 0_c_int32_t, &
                                starts_memory, list_memory)
    if (status /= metis_ok) then
      call fail(error, exit_internal, 'METIS could not build the graph of the elements.')
      return
    end if
    call c_f_pointer(starts_memory, starts, [elements + 1])
    row_start = starts + 1
    call c_f_pointer(list_memory, list, [starts(elements + 1)])
    neighbours = list + 1
    status = metis_free(starts_memory)
    status = metis_free(list_memory)
  end subroutine element_graph

  !> Shares the vertices of a graph out among parts of about equal weight, none of them empty.
  subroutine partition_graph(row_start, neighbours, parts, part_of, error, weights)
    !> Where each vertex' neighbours begin, shape (vertices + 1), from 1
    integer, intent(in) :: row_start(:)
    !> Neighbours of all vertices, one after the other, from 1
    integer, intent(in) :: neighbours(:)
    !> Number of parts
    integer, intent(in) :: parts
    !> Part of each vertex, from 0, shape (vertices)
    integer, allocatable, intent(out) :: part_of(:)
    !> Raised when there are more parts than vertices or METIS fails
    type(error_t), allocatable, intent(inout) :: error
    !> Work of each vertex, 1 if absent, shape (vertices)
    integer, intent(in), optional :: weights(:)
    integer(c_int32_t), target :: work(size(row_start) - 1)
    integer(c_int32_t) :: cut, status
    integer :: vertices, i

    vertices = size(row_start) - 1
    allocate (part_of(vertices), source=0)
    if (parts == 1) return
    if (parts > vertices) then
      call fail(error, exit_usage, 'There are more ranks than elements: start fewer ranks or refine the mesh.')
      return
    end if
    work = 1
    if (present(weights)) work = weights
    status = metis_partition(vertices, 1, row_start - 1, neighbours - 1, c_loc(work), c_null_ptr, c_null_ptr, &
                             parts, c_null_ptr, c_null_ptr, c_null_ptr, cut, part_of)
    if (status /= metis_ok) then
      call fail(error, exit_internal, 'METIS could not share the elements out among the ranks.')
      return
    end if
    ! METIS may leave a part of a very small graph empty; blocks of consecutive vertices never do.
    if (any([(count(part_of == i) == 0, i=0, parts - 1)])) part_of = [((i - 1)*parts/vertices, i=1, vertices)]
  end subroutine partition_graph
end module partitions
