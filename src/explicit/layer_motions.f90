!> Motion of the layers of nodes: conversion between rates of the unknowns and velocities of the layers, accelerations
!> by forces. Nodes with several layers move in lanes, each lane a stack with the same number of layers.
module layer_motions
  use element_batches, only: lanes
  use kinds, only: wp
  implicit none
  private
  public :: accelerate, accelerate_layers, find_rates, find_resultants, find_velocities, move_points

contains

  !> Adds the change of velocity of a layer by a force during a time.
  pure subroutine accelerate(inverse, time, force, velocity)
    !> Inverse inertia, as in nodal_inertia_t
    real(wp), intent(in) :: inverse(7)
    real(wp), intent(in) :: time
    !> Forces and moments
    real(wp), intent(in) :: force(5)
    !> Velocity of the layer
    real(wp), intent(inout) :: velocity(5)

    velocity(1) = velocity(1) + time*(inverse(1)*force(1) + inverse(2)*force(4))
    velocity(4) = velocity(4) + time*(inverse(2)*force(1) + inverse(3)*force(4))
    velocity(2) = velocity(2) + time*(inverse(4)*force(2) + inverse(5)*force(5))
    velocity(5) = velocity(5) + time*(inverse(5)*force(2) + inverse(6)*force(5))
    velocity(3) = velocity(3) + time*inverse(7)*force(3)
  end subroutine accelerate

  !> Updates unconstrained points with one layer.
  pure subroutine move_points(total, points, inverse, mean, step, force, u, v)
    !> Number of points of this rank, and those to be updated
    integer, intent(in) :: total, points(:)
    !> Inverse inertia
    real(wp), intent(in) :: inverse(7, total)
    !> Time between the velocities before and after, and length of the step
    real(wp), intent(in) :: mean, step
    !> Forces on the layers
    real(wp), intent(in) :: force(5, total)
    !> Unknowns and their rates
    real(wp), intent(inout) :: u(5, total), v(5, total)
    integer :: i, p

    do i = 1, size(points)
      p = points(i)
      call accelerate(inverse(:, p), mean, force(:, p), v(:, p))
      u(:, p) = u(:, p) + step*v(:, p)
    end do
  end subroutine move_points

  !> Velocities of the layers from the rates of the unknowns.
  pure subroutine find_velocities(n, height, rates, velocity)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces
    real(wp), intent(in) :: height(lanes, n)
    !> Rates of the unknowns
    real(wp), intent(in) :: rates(lanes, 5, n + 1)
    !> Velocities of the layers
    real(wp), intent(out) :: velocity(lanes, 5, n + 1)
    integer :: l

    velocity(:, :, 1) = rates(:, :, 1)
    do l = 2, n + 1
      associate (above => velocity(:, :, l - 1), z => height(:, l - 1))
        velocity(:, 1, l) = rates(:, 1, l) + above(:, 1) + z*(above(:, 4) - rates(:, 4, l))
        velocity(:, 2, l) = rates(:, 2, l) + above(:, 2) + z*(above(:, 5) - rates(:, 5, l))
        velocity(:, 3, l) = rates(:, 3, l) + above(:, 3)
      end associate
      velocity(:, 4:5, l) = rates(:, 4:5, l)
    end do
  end subroutine find_velocities

  !> `accelerate` for all layers of stacks.
  pure subroutine accelerate_layers(layers, inverse, time, force, velocity)
    !> Number of layers
    integer, intent(in) :: layers
    !> Inverse inertia
    real(wp), intent(in) :: inverse(lanes, 7, layers)
    real(wp), intent(in) :: time
    !> Forces and moments
    real(wp), intent(in) :: force(lanes, 5, layers)
    !> Velocities of the layers
    real(wp), intent(inout) :: velocity(lanes, 5, layers)
    integer :: l

    do l = 1, layers
      associate (m => inverse(:, :, l), f => force(:, :, l), v => velocity(:, :, l))
        v(:, 1) = v(:, 1) + time*(m(:, 1)*f(:, 1) + m(:, 2)*f(:, 4))
        v(:, 4) = v(:, 4) + time*(m(:, 2)*f(:, 1) + m(:, 3)*f(:, 4))
        v(:, 2) = v(:, 2) + time*(m(:, 4)*f(:, 2) + m(:, 5)*f(:, 5))
        v(:, 5) = v(:, 5) + time*(m(:, 5)*f(:, 2) + m(:, 6)*f(:, 5))
        v(:, 3) = v(:, 3) + time*m(:, 7)*f(:, 3)
      end associate
    end do
  end subroutine accelerate_layers

  !> Rates of the unknowns from the velocities of the layers.
  pure subroutine find_rates(n, height, velocity, rates)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces
    real(wp), intent(in) :: height(lanes, n)
    !> Velocities of the layers
    real(wp), intent(in) :: velocity(lanes, 5, n + 1)
    !> Rates of the unknowns
    real(wp), intent(out) :: rates(lanes, 5, n + 1)
    integer :: j

    rates(:, :, 1) = velocity(:, :, 1)
    do j = 1, n
      associate (upper => velocity(:, :, j), lower => velocity(:, :, j + 1), rate => rates(:, :, j + 1))
        rate(:, 1) = lower(:, 1) - upper(:, 1) + height(:, j)*(lower(:, 4) - upper(:, 4))
        rate(:, 2) = lower(:, 2) - upper(:, 2) + height(:, j)*(lower(:, 5) - upper(:, 5))
        rate(:, 3) = lower(:, 3) - upper(:, 3)
        rate(:, 4:5) = lower(:, 4:5)
      end associate
    end do
  end subroutine find_rates

  !> Forces of the tractions on the layers.
  pure subroutine find_resultants(n, height, forces, resultants)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces, and forces on the jumps
    real(wp), intent(in) :: height(lanes, n), forces(lanes, 3, n)
    !> Forces and moments on the layers
    real(wp), intent(out) :: resultants(lanes, 5, n + 1)
    integer :: j

    resultants(:, :, 1) = 0
    do j = 1, n
      resultants(:, 1:3, j) = resultants(:, 1:3, j) + forces(:, :, j)
      resultants(:, 4, j) = resultants(:, 4, j) + height(:, j)*forces(:, 1, j)
      resultants(:, 5, j) = resultants(:, 5, j) + height(:, j)*forces(:, 2, j)
      resultants(:, 1:3, j + 1) = -forces(:, :, j)
      resultants(:, 4, j + 1) = -height(:, j)*forces(:, 1, j)
      resultants(:, 5, j + 1) = -height(:, j)*forces(:, 2, j)
    end do
  end subroutine find_resultants
end module layer_motions
