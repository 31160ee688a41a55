!> Element edges along one side of the plate: the loaded patch consists of entire elements, and sizes outside increase
!> geometrically. With a core of equal elements around the patch a front grows there in equal steps.
module gradings
  use kinds, only: wp
  use roundings, only: rounding
  implicit none
  private
  public :: graded_half_line, graded_line, cored_half_line, off_centre_line, core_elements, move_to_lines

  !> Fraction of an element within which the larger of two numbers of elements is chosen if both fit equally well, in
  !> all units: above round-off, at most 1e-10 with 1e6 elements.
  real(wp), parameter :: tie = 1.0e-9_wp

contains

  !> Element edges from the struck point (0) to the border, for a model cut at the struck point.
  pure function graded_half_line(half_length, elements, half_patch, grading) result(edges)
    !> Distance from the struck point to the border
    real(wp), intent(in) :: half_length
    !> Number of elements
    integer, intent(in) :: elements
    real(wp), intent(in) :: half_patch
    !> Largest over smallest element edge outside the patch; 0: smooth from the patch's elements
    real(wp), intent(in) :: grading
    !> Ascending coordinates of the element edges, (0:elements)
    real(wp) :: edges(0:elements)
    integer :: inside, i

    inside = patch_elements(half_patch, half_length, elements, 1)
    do i = 0, inside
      edges(i) = half_patch*i/max(inside, 1)
    end do
    if (inside < elements) edges(inside:) = outer_edges(edges(inside), half_length, elements - inside, &
                                                        half_patch/max(inside, 1), grading)
  end function graded_half_line

  !> Element edges from the struck point (0) to the border, equal in a core around the patch.
  pure function cored_half_line(half_length, elements, half_patch, grading, half_core, cell) result(edges)
    !> Distance from the struck point to the border
    real(wp), intent(in) :: half_length
    !> Number of elements, more than core_elements gives
    integer, intent(in) :: elements
    real(wp), intent(in) :: half_patch
    !> Largest over smallest element edge outside the core; 0: smooth from the core's elements
    real(wp), intent(in) :: grading
    !> Half the extent of the core, less than half_length
    real(wp), intent(in) :: half_core
    !> Side of its elements; patch and core are divided into entire elements of about this size
    real(wp), intent(in) :: cell
    !> Ascending coordinates of the element edges, (0:elements)
    real(wp) :: edges(0:elements)
    real(wp) :: border
    integer :: counts(2), i

    counts = core_elements(half_patch, half_core, cell)
    border = core_border(half_patch, half_core, cell)
    do i = 0, counts(1)
      edges(i) = half_patch*i/max(counts(1), 1)
    end do
    do i = 1, counts(2)
      edges(counts(1) + i) = half_patch + (border - half_patch)*i/counts(2)
    end do
    edges(sum(counts):) = outer_edges(edges(sum(counts)), half_length, elements - sum(counts), cell, grading)
  end function cored_half_line

  !> Numbers of elements on half the patch, at least one, and from there to the border of the core.
  pure function core_elements(half_patch, half_core, cell) result(counts)
    real(wp), intent(in) :: half_patch
    !> Half the extent of the core
    real(wp), intent(in) :: half_core
    !> Side of the core's elements
    real(wp), intent(in) :: cell
    !> On the patch, and on the rest of the core
    integer :: counts(2)

    counts = nint([half_patch, max(0.0_wp, half_core - half_patch)]/cell + tie)
    if (half_patch > rounding*half_core) counts(1) = max(1, counts(1))
  end function core_elements

  !> Distance of the border of the core from the struck point: that of the patch where less than half an element fits
  !> between them.
  pure real(wp) function core_border(half_patch, half_core, cell) result(border)
    real(wp), intent(in) :: half_patch
    !> Half the extent of the core
    real(wp), intent(in) :: half_core
    !> Side of the core's elements
    real(wp), intent(in) :: cell
    integer :: counts(2)

    counts = core_elements(half_patch, half_core, cell)
    border = merge(half_core, half_patch, counts(2) > 0)
  end function core_border

  !> Element edges from border to border, symmetric about the struck point in the middle.
  pure function graded_line(length, elements, patch, grading) result(edges)
    !> Length of the plate
    real(wp), intent(in) :: length
    !> Number of elements
    integer, intent(in) :: elements
    !> Side of the loaded patch; 0: none
    real(wp), intent(in) :: patch
    !> Largest over smallest element edge outside the patch; 0: smooth from the patch's elements
    real(wp), intent(in) :: grading
    !> Ascending coordinates of the element edges, (0:elements)
    real(wp) :: edges(0:elements)
    real(wp) :: border
    integer :: inside, outside, i

    inside = patch_elements(patch, length, elements, 2)
    outside = (elements - inside)/2
    border = patch/2
    if (patch <= 0) border = length*inside/elements/2
    do i = 0, inside
      edges(outside + i) = border*real(2*i - inside, wp)/max(inside, 1)
    end do
    if (inside == 0) edges(outside) = 0
    if (outside == 0) return
    edges(outside + inside:) = outer_edges(border, length/2, outside, 2*border/max(inside, 1), grading)
    edges(:outside) = -edges(elements:elements - outside:-1)
  end function graded_line

  !> Element edges from border to border around a struck point anywhere between them. The elements are divided between
  !> both sides for similar sizes.
  pure function off_centre_line(length, elements, patch, grading, core, cell, struck) result(edges)
    !> Length of the plate
    real(wp), intent(in) :: length
    !> Number of elements
    integer, intent(in) :: elements
    !> Side of the loaded patch; 0: none
    real(wp), intent(in) :: patch
    !> Largest over smallest element edge outside the core; 0: smooth from the core's elements
    real(wp), intent(in) :: grading
    !> Extent of the core; 0: the patch alone
    real(wp), intent(in) :: core
    !> Side of its elements; 0: the patch has the fraction of the elements that it has of the length
    real(wp), intent(in) :: cell
    !> The struck point, from the middle
    real(wp), intent(in) :: struck
    !> Ascending coordinates of the element edges from the middle, (0:elements)
    real(wp) :: edges(0:elements)
    real(wp) :: side, outside(2), ratios(2), best
    integer :: inside, low, chosen

    side = cell
    if (side <= 0) side = length/elements
    inside = sum(core_elements(patch/2, core/2, side))
    outside = length/2 + [struck, -struck] - core_border(patch/2, core/2, side)
    chosen = 1
    best = huge(best)
    do low = 1, elements - 2*inside - 1
      ratios = log([smooth_ratio(outside(1)/side, low), smooth_ratio(outside(2)/side, elements - 2*inside - low)])
      if (maxval(abs(ratios)) >= best) cycle
      best = maxval(abs(ratios))
      chosen = low
    end do
    low = inside + chosen
    edges(low:) = struck + cored_half_line(length/2 - struck, elements - low, patch/2, grading, core/2, side)
    edges(low:0:-1) = struck - cored_half_line(length/2 + struck, low, patch/2, grading, core/2, side)
  end function off_centre_line

  !> Moves edges to required coordinates. The nearest edge is moved; among equally near ones that closest to the centre
  !> of the plate, so that the mesh is the same on both sides of it. Edges up to the next fixed edge on either side are
  !> scaled uniformly. A coordinate without a free edge is ignored.
  pure subroutine move_to_lines(edges, kept, lines)
    !> Ascending coordinates of the element edges
    real(wp), intent(inout) :: edges(0:)
    !> Coordinates of edges that are not moved, besides the first and last one
    real(wp), intent(in) :: kept(:)
    !> Required coordinates; those beyond the edges are ignored
    real(wp), intent(in) :: lines(:)
    logical :: fixed(0:ubound(edges, 1))
    real(wp) :: distance, gaps(0:ubound(edges, 1))
    integer :: i, line, nearest, low, high

    distance = rounding*(edges(ubound(edges, 1)) - edges(0))
    fixed = [(any(abs(edges(line) - kept) <= distance), line=0, ubound(edges, 1))]
    fixed([0, ubound(edges, 1)]) = .true.
    do i = 1, size(lines)
      if (lines(i) <= edges(0) .or. lines(i) >= edges(ubound(edges, 1)) .or. all(fixed)) cycle
      if (any(fixed .and. abs(edges - lines(i)) <= distance)) cycle
      gaps = merge(huge(distance), abs(edges - lines(i)), fixed)
      nearest = minloc(abs(edges), dim=1, mask=gaps <= minval(gaps) + distance) - 1
      low = findloc(fixed(:nearest), .true., dim=1, back=.true.) - 1
      high = nearest + findloc(fixed(nearest:), .true., dim=1) - 1
      if (lines(i) <= edges(low) .or. lines(i) >= edges(high)) cycle
      edges(low + 1:nearest - 1) = between(edges(low), edges(nearest), edges(low + 1:nearest - 1))
      edges(nearest + 1:high - 1) = between(edges(high), edges(nearest), edges(nearest + 1:high - 1))
      edges(nearest) = lines(i)
      fixed(nearest) = .true.
    end do

  contains

    !> Edges moved in proportion to their distance from a fixed one.
    pure function between(stays, moves, old) result(new)
      !> The fixed edge, and the one that is moved to the line
      real(wp), intent(in) :: stays, moves
      !> Edges between them
      real(wp), intent(in) :: old(:)
      real(wp) :: new(size(old))

      new = stays + (old - stays)*((lines(i) - stays)/(moves - stays))
    end function between
  end subroutine move_to_lines

  !> Number of elements across the patch, at least one: their size is as close as possible to the mean element size.
  pure integer function patch_elements(patch, length, elements, stride) result(inside)
    !> Extent of the patch; 0: none
    real(wp), intent(in) :: patch
    !> Extent of the line
    real(wp), intent(in) :: length
    !> Elements along the line
    integer, intent(in) :: elements
    !> 1: any number; 2: even if `elements` is even, odd if it is odd
    integer, intent(in) :: stride
    integer :: offset, most

    offset = modulo(elements, stride)
    inside = offset
    if (patch <= 0) return
    most = elements
    if (patch < length*(1 - rounding)) most = elements - stride
    inside = offset + stride*nint((patch*elements/length - offset)/stride + tie)
    inside = max(merge(offset, stride, offset > 0), min(inside, most))
  end function patch_elements

  !> Edges of `count` elements from `start` to `finish` whose sizes form a geometric series.
  pure function outer_edges(start, finish, count, neighbour, grading) result(edges)
    !> First and last edge
    real(wp), intent(in) :: start, finish
    !> Number of elements
    integer, intent(in) :: count
    !> Size of the element before `start`; 0: none
    real(wp), intent(in) :: neighbour
    !> Largest over smallest size; 0: continue smoothly from `neighbour`
    real(wp), intent(in) :: grading
    !> Ascending coordinates of the edges
    real(wp) :: edges(0:count)
    real(wp) :: ratio, sizes(count)
    integer :: i

    ratio = 1
    if (grading > 0 .and. count > 1) then
      ratio = grading**(1.0_wp/(count - 1))
    else if (neighbour > 0) then
      ratio = smooth_ratio((finish - start)/neighbour, count)
    end if
    sizes = [(ratio**(i - 1), i=1, count)]
    sizes = sizes*(finish - start)/sum(sizes)
    edges(0) = start
    do i = 1, count
      edges(i) = start + sum(sizes(:i))
    end do
    edges(count) = finish
  end function outer_edges

  !> Ratio r of a series r + r**2 + ... + r**count that sums to `total`, by bisection of its logarithm.
  pure real(wp) function smooth_ratio(total, count) result(ratio)
    !> Required sum, in sizes of the element before the series
    real(wp), intent(in) :: total
    !> Number of terms
    integer, intent(in) :: count
    real(wp) :: low, high
    integer :: i, k

    low = log(min(1.0_wp, total/count))
    high = log(max(1.0_wp, total/count))
    do i = 1, 60
      ratio = exp((low + high)/2)
      if (sum([(ratio**k, k=1, count)]) > total) then
        high = log(ratio)
      else
        low = log(ratio)
      end if
    end do
    if (abs(ratio - 1) < 1.0e-12_wp) ratio = 1
  end function smooth_ratio
end module gradings
