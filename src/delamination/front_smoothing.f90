!> Energy release rates smoothed along a front, never across it nor around its corners.
!>
!> Plates know nothing shorter than their thickness: over less than that the rate of a front goes up and down with the
!> row of elements that happens to have cracked behind it, more so the finer the mesh. Cells longer than the
!> laminate is thick are left as they are.
module front_smoothing
  use delamination_fronts, only: front_segment_t
  use kinds, only: wp
  implicit none
  private
  public :: smoothed_along_front

contains

  !> Means of the rates along the straight runs of a front, with weights that fall off to zero within a length.
  pure function smoothed_along_front(segments, length, mirrored, rates) result(smooth)
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> Distance along the front at which a rate no longer counts
    real(wp), intent(in) :: length
    !> True: the first column, and the first row, lies at a line of symmetry
    logical, intent(in) :: mirrored(2)
    !> Rates of each segment, (modes, segments)
    real(wp), intent(in) :: rates(:, :)
    !> The means, (modes, segments)
    real(wp) :: smooth(size(rates, 1), size(segments))
    real(wp) :: weight, distance, total
    integer :: s, here, next, cell, side

    do s = 1, size(segments)
      total = segments(s)%width
      smooth(:, s) = total*rates(:, s)
      do side = -1, 1, 2
        here = s
        cell = along_run(segments(s))
        distance = 0
        do
          cell = cell + side
          next = segment_of_run(segments, segments(s), merge(1 - cell, cell, cell < 1 .and. &
                                                                    mirrored(3 - segments(s)%direction)))
          if (next == 0) exit
          distance = distance + (segments(here)%width + segments(next)%width)/2
          if (distance >= length) exit
          weight = (1 - distance/length)*segments(next)%width
          smooth(:, s) = smooth(:, s) + weight*rates(:, next)
          total = total + weight
          here = next
        end do
      end do
      smooth(:, s) = smooth(:, s)/total
    end do
  end function smoothed_along_front

  !> Column or row of a segment along its straight run.
  pure integer function along_run(segment) result(cell)
    !> The segment
    type(front_segment_t), intent(in) :: segment

    cell = segment%outside(3 - segment%direction)
  end function along_run

  !> Index of the segment on the line of another one, with the same normal, at a column or row; 0: the run ends.
  pure integer function segment_of_run(segments, other, cell) result(found)
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> A segment of the run
    type(front_segment_t), intent(in) :: other
    !> Column or row along the run
    integer, intent(in) :: cell

    do found = 1, size(segments)
      associate (segment => segments(found))
        if (segment%direction /= other%direction .or. segment%sign /= other%sign) cycle
        if (segment%outside(segment%direction) /= other%outside(other%direction)) cycle
        if (along_run(segment) == cell) return
      end associate
    end do
    found = 0
  end function segment_of_run
end module front_smoothing
