!> Motion of the layers of a node: conversion between rates of the unknowns and velocities of the layers, and
!> accelerations by forces.
module layer_motions
  use kinds, only: wp
  implicit none
  private
  public :: accelerate, accelerate_by_tractions, accelerate_layers, find_rates, move_points, to_layers, &
            traction_resultant

contains

  !> Velocities of the layers from the rates of the unknowns.
  pure subroutine to_layers(n, height, v, layer)
    !> Interfaces
    integer, intent(in) :: n
    !> Height of the interface above each layer, (n + 1)
    real(wp), intent(in) :: height(n + 1)
    !> Rates of the unknowns, (5, n + 1)
    real(wp), intent(in) :: v(5, n + 1)
    !> Velocities of the layers, (5, n + 1)
    real(wp), intent(out) :: layer(5, n + 1)
    integer :: l

    layer(:, 1) = v(:, 1)
    do l = 2, n + 1
      layer(1, l) = v(1, l) + layer(1, l - 1) + height(l)*(layer(4, l - 1) - v(4, l))
      layer(2, l) = v(2, l) + layer(2, l - 1) + height(l)*(layer(5, l - 1) - v(5, l))
      layer(3, l) = v(3, l) + layer(3, l - 1)
      layer(4, l) = v(4, l)
      layer(5, l) = v(5, l)
    end do
  end subroutine to_layers

  !> Adds the change of velocity of a layer by a force during a time.
  pure subroutine accelerate(inverse, time, force, velocity)
    !> Inverse inertia, as in nodal_inertia_t
    real(wp), intent(in) :: inverse(7)
    !> The time
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

  !> The same for all layers of a node.
  pure subroutine accelerate_layers(layers, inverse, time, force, velocity)
    !> Number of layers
    integer, intent(in) :: layers
    !> Inverse inertia, (7, layers)
    real(wp), intent(in) :: inverse(7, layers)
    !> The time
    real(wp), intent(in) :: time
    !> Forces and moments, (5, layers)
    real(wp), intent(in) :: force(5, layers)
    !> Velocities of the layers, (5, layers)
    real(wp), intent(inout) :: velocity(5, layers)
    integer :: l

    do l = 1, layers
      call accelerate(inverse(:, l), time, force(:, l), velocity(:, l))
    end do
  end subroutine accelerate_layers

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

  !> Rates of the jumps across the interfaces.
  pure subroutine find_rates(n, height, layer, rates)
    !> Interfaces
    integer, intent(in) :: n
    !> Height of the interface above each layer, (n + 1)
    real(wp), intent(in) :: height(n + 1)
    !> Velocities of the layers, (5, n + 1)
    real(wp), intent(in) :: layer(5, n + 1)
    !> Rates of the jumps, (3, n)
    real(wp), intent(out) :: rates(3, n)
    integer :: j

    do j = 1, n
      rates(1, j) = layer(1, j + 1) - layer(1, j) + height(j + 1)*(layer(4, j + 1) - layer(4, j))
      rates(2, j) = layer(2, j + 1) - layer(2, j) + height(j + 1)*(layer(5, j + 1) - layer(5, j))
      rates(3, j) = layer(3, j + 1) - layer(3, j)
    end do
  end subroutine find_rates

  !> Adds the change of velocity of the layers by the tractions between them during a time.
  pure subroutine accelerate_by_tractions(n, height, inverse, time, forces, layer)
    !> Interfaces
    integer, intent(in) :: n
    !> Height of the interface above each layer, (n + 1)
    real(wp), intent(in) :: height(n + 1)
    !> Inverse inertia of the layers, (7, n + 1)
    real(wp), intent(in) :: inverse(7, n + 1)
    !> The time
    real(wp), intent(in) :: time
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(3, n)
    !> Velocities of the layers, (5, n + 1)
    real(wp), intent(inout) :: layer(5, n + 1)
    real(wp) :: resultant(5)
    integer :: l

    resultant = 0
    do l = 1, n
      resultant(1:3) = resultant(1:3) + forces(:, l)
      resultant(4) = resultant(4) + height(l + 1)*forces(1, l)
      resultant(5) = resultant(5) + height(l + 1)*forces(2, l)
      call accelerate(inverse(:, l), time, resultant, layer(:, l))
      resultant(1:3) = -forces(:, l)
      resultant(4) = -height(l + 1)*forces(1, l)
      resultant(5) = -height(l + 1)*forces(2, l)
    end do
    call accelerate(inverse(:, n + 1), time, resultant, layer(:, n + 1))
  end subroutine accelerate_by_tractions

  !> Force of the tractions on a layer.
  pure function traction_resultant(n, height, forces, l) result(resultant)
    !> Interfaces
    integer, intent(in) :: n
    !> Height of the interface above each layer, (n + 1)
    real(wp), intent(in) :: height(n + 1)
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(3, n)
    !> The layer
    integer, intent(in) :: l
    !> Forces and moments
    real(wp) :: resultant(5)

    resultant = 0
    if (l > 1) resultant = [-forces(:, l - 1), -height(l)*forces(1:2, l - 1)]
    if (l <= n) resultant = resultant + [forces(:, l), height(l + 1)*forces(1:2, l)]
  end function traction_resultant
end module layer_motions
