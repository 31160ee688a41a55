!> Partition of the elements over the ranks with a short border, by METIS (Karypis and Kumar, SIAM J. Sci. Comput. 20,
!> 1998), which is deterministic.
module partitions
  use, intrinsic :: iso_c_binding, only: c_int32_t, c_ptr, c_null_ptr, c_loc
  use errors, only: error_t, fail, exit_usage, exit_internal
  implicit none
  private
  public :: partition_graph

  !> METIS' code for success
  integer(c_int32_t), parameter :: metis_ok = 1

  interface
    !> Partition of a graph into parts of equal weight, few edges being cut.
    integer(c_int32_t) function metis_partition(vertices, constraints, row_start, neighbours, vertex_weights, &
                                                vertex_sizes, edge_weights, parts, target_weights, imbalance, &
                                                options, edge_cut, part_of) bind(c, name='METIS_PartGraphRecursive')
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

  !> Distributes the vertices of a graph over parts of about equal weight, none of them empty.
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
      call fail(error, exit_internal, 'METIS could not distribute the elements over the ranks.')
      return
    end if
    ! METIS may leave a part of a very small graph empty; blocks of consecutive vertices never do.
    if (any([(count(part_of == i) == 0, i=0, parts - 1)])) part_of = [((i - 1)*parts/vertices, i=1, vertices)]
  end subroutine partition_graph
end module partitions
