!> The front as polylines, for plots and output.
module front_outlines
  use delamination_fronts, only: front_segment_t
  implicit none
  private
  public :: outline_t, find_outlines

  !> A chain of front segments, run through with the delaminated cells on the left (x to the right, y up).
  !> Regions that only touch at a corner have outlines of their own, as they hold together there.
  type :: outline_t
    !> The segments in their order
    integer, allocatable :: segments(:)
    !> Corners of the polyline, node numbers of the mesh; one more than segments, and the first again
    !> at the end of a closed one
    integer, allocatable :: nodes(:)
    !> True for a closed outline; an open one ends at the model's border or symmetry lines
    logical :: closed = .false.
  end type outline_t

contains

  !> All outlines, open ones first.
  pure function find_outlines(segments) result(outlines)
    !> All segments of a front
    type(front_segment_t), intent(in) :: segments(:)
    !> The outlines
    type(outline_t), allocatable :: outlines(:)
    integer :: following(size(segments))
    logical :: preceded(size(segments)), taken(size(segments))
    integer :: s

    call link_segments(segments, following, preceded)
    allocate (outlines(0))
    taken = .false.
    do s = 1, size(segments)
      if (preceded(s)) cycle
      outlines = [outlines, chain_from(segments, following, s)]
      taken(outlines(size(outlines))%segments) = .true.
    end do
    do s = 1, size(segments)
      if (taken(s)) cycle
      outlines = [outlines, chain_from(segments, following, s)]
      taken(outlines(size(outlines))%segments) = .true.
    end do
  end function find_outlines

  !> Which segment follows each of them.
  pure subroutine link_segments(segments, following, preceded)
    !> All segments
    type(front_segment_t), intent(in) :: segments(:)
    !> The next segment, 0 at the end of an open outline
    integer, intent(out) :: following(:)
    !> True if another segment leads to this one
    logical, intent(out) :: preceded(:)
    integer :: s, next

    following = 0
    preceded = .false.
    do s = 1, size(segments)
      do next = 1, size(segments)
        if (start_node(segments(next)) /= end_node(segments(s))) cycle
        ! Where two cells touch at a corner the outline stays with its own cell.
        if (following(s) /= 0 .and. any(segments(next)%inside /= segments(s)%inside)) cycle
        following(s) = next
      end do
      if (following(s) /= 0) preceded(following(s)) = .true.
    end do
  end subroutine link_segments

  !> The outline that begins with a segment.
  pure function chain_from(segments, following, first) result(outline)
    !> All segments
    type(front_segment_t), intent(in) :: segments(:)
    !> The next segment of each
    integer, intent(in) :: following(:)
    !> Where to begin
    integer, intent(in) :: first
    !> The outline
    type(outline_t) :: outline
    integer :: members(size(segments)), length, s

    length = 0
    s = first
    do
      length = length + 1
      members(length) = s
      s = following(s)
      if (s == 0 .or. s == first) exit
    end do
    outline%closed = s == first
    allocate (outline%segments, source=members(:length))
    allocate (outline%nodes(length + 1))
    do s = 1, length
      outline%nodes(s) = start_node(segments(members(s)))
    end do
    outline%nodes(length + 1) = end_node(segments(members(length)))
  end function chain_from

  !> Corner where a segment begins, with the delaminated cell on the left.
  pure integer function start_node(segment) result(node)
    !> The segment
    type(front_segment_t), intent(in) :: segment
    node = merge(segment%edge(1), segment%edge(3), ascending(segment))
  end function start_node

  !> Corner where a segment ends.
  pure integer function end_node(segment) result(node)
    !> The segment
    type(front_segment_t), intent(in) :: segment
    node = merge(segment%edge(3), segment%edge(1), ascending(segment))
  end function end_node

  !> True if the delaminated cell is on the left of someone who walks towards larger coordinates.
  pure logical function ascending(segment)
    !> The segment
    type(front_segment_t), intent(in) :: segment
    ascending = (segment%direction == 1) .eqv. (segment%sign == 1)
  end function ascending
end module front_outlines
