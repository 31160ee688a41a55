!> Dent depth of an impact as measured by a depth gauge on the struck face: from the plane of the surrounding surface to
!> the deepest point (ASTM D7136).
module dent_depths
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use rank_totals, only: totals_of
  use result_tables, only: result_row_length
  use roundings, only: rounding
  implicit none
  private
  public :: dent_depth

  !> Columns of the history.
  character(len=result_row_length), parameter, public :: dent_rows(*) = [character(len=result_row_length) :: &
    'dent_depth | real | length | Largest depth of the struck face below the plane of the surface 3 to 4 nose radii &
      &away, dent_indentation included; for a plate at rest.', &
    'dent_indentation | real | length | Permanent indentation by the indentation law, a part of dent_depth.']

  !> Distances from the struck point, in radii of the nose, between which the plane is fitted: 24 and 32 mm for a nose
  !> of 16 mm in diameter, the position of a gauge, within the window of the frame.
  real(wp), parameter, public :: nearest = 3, farthest = 4

contains

  !> Depth of the struck face below the plane of the surface around it; 0 without a nose, or without cells of the mesh
  !> there. The permanent indentation of the law is added separately. Collective.
  real(wp) function dent_depth(plate, displacement) result(depth)
    type(composite_plate_t), intent(in) :: plate
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    real(wp) :: plane(3), place(2)
    logical :: is_known
    integer :: i, point

    depth = 0
    if (.not. (plate%setup%impactor%is_present .and. plate%setup%impactor%radius > 0)) return
    call find_plane(plate, displacement, plane, is_known)
    if (.not. is_known) return
    associate (mesh => plate%mesh, owned => plate%distribution%points(:plate%distribution%owned))
      do i = 1, size(owned)
        point = owned(i)
        if (mesh%first_point(mesh%point_node(point)) /= point) cycle
        place = mesh%node_coordinates(:, mesh%point_node(point)) - mesh%struck
        if (norm2(place) >= nearest*plate%setup%impactor%radius) cycle
        depth = max(depth, displacement(3, i) - plane(1) - dot_product(plane(2:3), place))
      end do
    end associate
    call plate%communicator%maximum(depth)
  end function dent_depth

  !> Least-squares plane of the surface around the dent, through the centres of cells weighted by area. Slopes are zero
  !> along directions of symmetry. Collective.
  subroutine find_plane(plate, displacement, plane, is_known)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> Height at the struck point and slopes along x and y
    real(wp), intent(out) :: plane(3)
    !> False: there are no cells around the dent, or they lie on one line, so that the plane is not determined
    logical, intent(out) :: is_known
    type(exact_sum_t) :: sums(9)
    real(wp) :: totals(9), terms(9), place(2), centred(5), area
    integer :: element, point, i
    logical :: is_free(2)

    associate (mesh => plate%mesh)
      do element = 1, size(plate%distribution%elements)
        associate (global => plate%distribution%elements(element))
          if (.not. mesh%is_top(global)) cycle
          point = mesh%connectivity(5, global)
          place = mesh%node_coordinates(:, mesh%point_node(point)) - mesh%struck
          if (norm2(place) < nearest*plate%setup%impactor%radius .or. &
              norm2(place) > farthest*plate%setup%impactor%radius) cycle
          area = mesh%cell_area(mesh%place_of(mesh%element_cell(global)))
        end associate
        associate (x => place(1), y => place(2), w => displacement(3, plate%distribution%local(point)))
          terms = area*[1.0_wp, x, y, x*x, x*y, y*y, w, x*w, y*w]
        end associate
        do i = 1, size(sums)
          call sums(i)%add(terms(i))
        end do
      end do
      totals = totals_of(plate%communicator, sums)
      is_known = totals(1) > 0
      plane = 0
      if (.not. is_known) return
      totals(2:) = totals(2:)/totals(1)
      ! Moments about the centroid of the cells.
      centred = [totals(4) - totals(2)**2, totals(5) - totals(2)*totals(3), totals(6) - totals(3)**2, &
                 totals(8) - totals(2)*totals(7), totals(9) - totals(3)*totals(7)]
      is_free = .not. (mesh%mirrored .or. any(mesh%halved .and. .not. mesh%mirrored))
      call fit_slopes(centred, totals(4) + totals(6), is_free, plane(2:3), is_known)
      plane(1) = totals(7) - dot_product(plane(2:3), totals(2:3))
    end associate
  end subroutine find_plane

  !> Slopes of the plane.
  pure subroutine fit_slopes(moments, square, is_free, slopes, is_known)
    !> Moments about the centroid over the area: xx, xy, yy, xw, yw
    real(wp), intent(in) :: moments(5)
    !> Mean square of the distance of the cells from the struck point
    real(wp), intent(in) :: square
    !> True: the surface may be tilted along x, along y; false: symmetry prevents it
    logical, intent(in) :: is_free(2)
    !> Along x and y
    real(wp), intent(out) :: slopes(2)
    !> False: the moments do not determine them
    logical, intent(out) :: is_known
    real(wp) :: determinant

    slopes = 0
    is_known = .true.
    associate (xx => moments(1), xy => moments(2), yy => moments(3), xw => moments(4), yw => moments(5))
      if (all(is_free)) then
        determinant = xx*yy - xy**2
        is_known = determinant > rounding*square**2
        if (is_known) slopes = [yy*xw - xy*yw, xx*yw - xy*xw]/determinant
      else if (is_free(1)) then
        is_known = xx > rounding*square
        if (is_known) slopes(1) = xw/xx
      else if (is_free(2)) then
        is_known = yy > rounding*square
        if (is_known) slopes(2) = yw/yy
      end if
    end associate
  end subroutine fit_slopes
end module dent_depths
