!> Nodal forces of pressures on the plate, and integrals of the deflection over a patch of elements.
module load_vectors
  use kinds, only: wp
  use lagrange9, only: gauss_shapes
  use element_batches, only: element_batches_t, lanes, first_element, batch_of, lane_of
  implicit none
  private
  public :: add_pressure, gauss_coordinates, add_patch_weights

contains

  !> Adds the consistent forces of a pressure that varies over the elements.
  pure subroutine add_pressure(batches, pressure, f)
    type(element_batches_t), intent(in) :: batches
    !> Pressure at the Gauss points (9, elements), positive downward
    real(wp), intent(in) :: pressure(:, :)
    real(wp), intent(inout) :: f(:, :)
    integer :: element

    do element = 1, batches%elements
      call add_nodal_shares(batches, element, pressure(:, element), f(3, :))
    end do
  end subroutine add_pressure

  !> Adds the weights of the nodal deflections in the integral of the deflection over a patch of elements. Divided by
  !> the area of the patch, they give its mean deflection, and a force on the patch is distributed over the nodes by the
  !> same weights, so that force and mean deflection are work-conjugate.
  pure subroutine add_patch_weights(batches, elements, weights)
    type(element_batches_t), intent(in) :: batches
    !> Numbers of the elements of the patch
    integer, intent(in) :: elements(:)
    !> Weight of each point, (columns that the batches add to)
    real(wp), intent(inout) :: weights(:)
    integer :: i

    do i = 1, size(elements)
      call add_nodal_shares(batches, elements(i), spread(1.0_wp, 1, 9), weights)
    end do
  end subroutine add_patch_weights

  !> Adds the integrals of the shape functions of one element times a function given at its Gauss points.
  pure subroutine add_nodal_shares(batches, element, values, shares)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: element
    !> Function at the Gauss points
    real(wp), intent(in) :: values(9)
    !> Integral of each point, (columns)
    real(wp), intent(inout) :: shares(:)
    real(wp) :: loads(9)
    integer :: b, lane, a, target

    b = batch_of(element)
    lane = lane_of(element)
    loads = values*batches%weight(lane, :, b)
    do a = 1, 9
      target = batches%targets(lane, a, b)
      shares(target) = shares(target) + dot_product(gauss_shapes(a, :), loads)
    end do
  end subroutine add_nodal_shares

  !> Position of the Gauss points of all elements.
  pure subroutine gauss_coordinates(batches, coordinates, x)
    type(element_batches_t), intent(in) :: batches
    !> Position of the points (2, points)
    real(wp), intent(in) :: coordinates(:, :)
    !> Position of the Gauss points (2, 9, elements)
    real(wp), intent(out) :: x(:, :, :)
    integer :: b, lane

    do b = 1, batches%batches
      do lane = 1, batches%lanes_used(b)
        x(:, :, first_element(b) + lane - 1) = matmul(coordinates(:, batches%points(lane, :, b)), gauss_shapes)
      end do
    end do
  end subroutine gauss_coordinates
end module load_vectors
