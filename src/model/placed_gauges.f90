!> Strains at gauges on the surface of the outermost layer, interpolated bilinearly from the superconvergent points of
!> the element.
module placed_gauges
  use element_batches, only: batch_of, lane_of, lanes
  use exact_sums, only: exact_sum_t
  use gauges, only: face_back, face_front, gauge_t
  use kinds, only: wp
  use mathematical_constants, only: degree
  use mesh_parameters, only: image_signs
  use composite_plates, only: composite_plate_t
  use rank_totals, only: totals_of
  use result_tables, only: result_row_length
  use roundings, only: rounding
  use strain_recovery, only: nodal_strains
  implicit none
  private
  public :: back_to_back, gauge_strains, percent_bending

  !> Column of the history, once per gauge: N is its number in the deck.
  character(len=result_row_length), parameter, public :: gauge_column_rows(*) = [character(len=result_row_length) :: &
    'gauge_strain_N | real | - | Strain of the surface under the N-th &gauge along its angle, positive in tension.']
  !> Corners of an element among its nodes, in the order of their shape functions.
  integer, parameter :: corners(4) = [1, 3, 7, 9]

contains

  !> Strains of all gauges, the same on every rank. Collective.
  function gauge_strains(plate, displacement) result(strains)
    type(composite_plate_t), intent(in) :: plate
    !> Unknowns, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> One per gauge
    real(wp), allocatable :: strains(:)
    type(exact_sum_t), allocatable :: sums(:)
    real(wp), allocatable :: motion(:, :)
    integer :: i

    allocate (strains(0))
    if (.not. allocated(plate%setup%plate%gauges)) return
    if (size(plate%setup%plate%gauges) == 0) return
    allocate (sums(size(plate%setup%plate%gauges)))
    motion = plate%motion_of(displacement)
    do i = 1, size(sums)
      call add_strain(plate, plate%setup%plate%gauges(i), motion, sums(i))
    end do
    strains = totals_of(plate%communicator, sums)
  end function gauge_strains

  !> The first two gauges back to back: at one point and angle on the front and on the back; 0: there are none.
  pure function back_to_back(gauges) result(pair)
    type(gauge_t), intent(in) :: gauges(:)
    !> That on the front, and that on the back
    integer :: pair(2)
    integer :: i, j

    do i = 1, size(gauges)
      do j = 1, size(gauges)
        if (gauges(i)%face /= face_front .or. gauges(j)%face /= face_back) cycle
        if (any(abs(gauges(i)%at - gauges(j)%at) > 0) .or. abs(gauges(i)%angle - gauges(j)%angle) > 0) cycle
        pair = [i, j]
        return
      end do
    end do
    pair = 0
  end function back_to_back

  !> Percent bending of two strains back to back: half their difference over their mean (ASTM D7137).
  pure real(wp) function percent_bending(strains) result(bending)
    !> On the front and on the back
    real(wp), intent(in) :: strains(2)

    bending = 0
    if (abs(sum(strains)) > 0) bending = 100*(strains(1) - strains(2))/sum(strains)
  end function percent_bending

  !> Adds the strain of a gauge: the mean over its images in the modelled part, of which there are several on a line of
  !> symmetry.
  subroutine add_strain(plate, gauge, motion, total)
    type(composite_plate_t), intent(in) :: plate
    type(gauge_t), intent(in) :: gauge
    real(wp), intent(in) :: motion(:, :)
    !> Receives the strain
    type(exact_sum_t), intent(inout) :: total
    integer, allocatable :: signs(:, :)
    integer :: k

    signs = modelled_images(plate, gauge)
    do k = 1, size(signs, 2)
      call add_image(plate, gauge, motion, signs(:, k), size(signs, 2), total)
    end do
  end subroutine add_strain

  !> Adds the part of an image: that of its cell, or the mean over the cells that meet there. Only cells of this rank
  !> contribute.
  subroutine add_image(plate, gauge, motion, signs, images, total)
    type(composite_plate_t), intent(in) :: plate
    type(gauge_t), intent(in) :: gauge
    real(wp), intent(in) :: motion(:, :)
    integer, intent(in) :: signs(2)
    !> Number of images
    integer, intent(in) :: images
    !> Receives the strain
    type(exact_sum_t), intent(inout) :: total
    real(wp) :: at(2), angle, direction(3)
    integer, allocatable :: columns(:), rows(:)
    integer :: element, cell, i, j

    at = signs*gauge%at
    angle = product(signs)*gauge%angle*degree
    direction = [cos(angle)**2, sin(angle)**2, sin(angle)*cos(angle)]
    columns = plate%mesh%along(1)%touching(at(1))
    rows = plate%mesh%along(2)%touching(at(2))
    do j = 1, size(rows)
      do i = 1, size(columns)
        cell = columns(i) + (rows(j) - 1)*plate%mesh%cells(1)
        element = plate%mesh%first_element(cell)
        if (gauge%face == face_back) element = plate%mesh%first_element(cell + 1) - 1
        element = findloc(plate%distribution%elements, element, dim=1)
        if (element == 0) cycle
        call total%add(dot_product(direction, surface_strain(plate, gauge, motion, element, &
          [part_of(plate%mesh%along(1)%ends(columns(i)), at(1)), part_of(plate%mesh%along(2)%ends(rows(j)), at(2))]))/ &
          (size(columns)*size(rows)*images))
      end do
    end do
  end subroutine add_image

  !> Strain of a surface in an element.
  function surface_strain(plate, gauge, motion, element, place) result(strain)
    type(composite_plate_t), intent(in) :: plate
    !> The gauge, on one of the surfaces
    type(gauge_t), intent(in) :: gauge
    real(wp), intent(in) :: motion(:, :)
    !> Index of the element among those of this rank
    integer, intent(in) :: element
    !> Position of the point in the element along x and y, from 0 to 1
    real(wp), intent(in) :: place(2)
    !> Along x and y, and shear
    real(wp) :: strain(3)
    real(wp) :: all(lanes, 9, 8), shape(4), mean(6), z

    call nodal_strains(plate%elements, batch_of(element), plate%setup%mesh%kinematics, motion, all)
    shape = [(1 - place(1))*(1 - place(2)), place(1)*(1 - place(2)), (1 - place(1))*place(2), product(place)]
    mean = matmul(shape, all(lane_of(element), corners, :6))
    associate (plies => plate%layup%stacks(plate%layup%stack(element))%plies)
      z = merge(plies(size(plies))%z_bottom, plies(1)%z_top, gauge%face == face_back)
    end associate
    strain = mean(1:3) + z*mean(4:6)
  end function surface_strain

  !> Signs of x and y of the images of a gauge, itself included, that lie in the modelled part, (2, images).
  pure function modelled_images(plate, gauge) result(signs)
    type(composite_plate_t), intent(in) :: plate
    type(gauge_t), intent(in) :: gauge
    integer, allocatable :: signs(:, :)
    integer, allocatable :: others(:, :)
    real(wp) :: least(2)
    integer :: k

    others = image_signs(plate%setup%plate%symmetry)
    signs = reshape([1, 1, others], [2, 1 + size(others, 2)])
    least = merge(-rounding*plate%setup%plate%length, -huge(least), plate%mesh%halved)
    signs = signs(:, pack([(k, k=1, size(signs, 2))], [(all(signs(:, k)*gauge%at >= least), k=1, size(signs, 2))]))
  end function modelled_images

  !> Position of a coordinate in a cell, from 0 to 1.
  pure real(wp) function part_of(ends, at) result(part)
    !> Ends of the cell
    real(wp), intent(in) :: ends(2)
    real(wp), intent(in) :: at

    part = (at - ends(1))/(ends(2) - ends(1))
  end function part_of
end module placed_gauges
