!> Checks of a traction-separation law: the work to failure is the toughness in any mode, the work of a closed path is
!> the dissipated energy, and the tangent is the derivative.
program pull_interface
  use example_checks, only: require
  use exponential_interfaces, only: exponential_law_t, interface_point_t, traction_of, secant_stiffness, &
                                    stored_energy, dissipated_energy
  use kinds, only: wp
  implicit none
  type(exponential_law_t), parameter :: law = exponential_law_t(toughness=600, strength=30e6_wp, shear_weight=0.5_wp)
  type(interface_point_t) :: point, ignored
  real(wp) :: direction(3), traction(3), tangent(3, 3), other(3), ends(3, 2), matrix(3, 3), work, angle
  integer :: i

  do i = 0, 3
    angle = i*acos(-1.0_wp)/6
    direction = [0.6_wp*sin(angle), 0.8_wp*sin(angle), cos(angle)]
    point = interface_point_t()
    call require('work to failure', pulled([0.0_wp, 0.0_wp, 0.0_wp], 500e-6_wp*direction, point), law%toughness, &
                 1e-3_wp)
    call require('energy dissipated at failure', dissipated_energy(law, point), law%toughness, 1e-6_wp)
  end do

  point = interface_point_t()
  work = pulled([0.0_wp, 0.0_wp, 0.0_wp], 9e-6_wp*direction, point)
  call require('work is stored and dissipated', work, stored_energy(law, 9e-6_wp*direction, point) &
               + dissipated_energy(law, point), 1e-6_wp)
  work = work + pulled(9e-6_wp*direction, [0.0_wp, 0.0_wp, 0.0_wp], point)
  call require('a closed path loses the dissipated part', work, dissipated_energy(law, point), 1e-6_wp)

  other = [4e-6_wp, -3e-6_wp, 9e-6_wp]
  call traction_of(law, other, point, traction, ignored, tangent)
  do i = 1, 3
    ends(:, 1) = other
    ends(:, 2) = other
    ends(i, :) = ends(i, :) + [-1e-11_wp, 1e-11_wp]
    matrix(:, i) = (traction_at(ends(:, 2)) - traction_at(ends(:, 1)))/2e-11_wp
  end do
  call require('tangent against differences', maxval(abs(matrix - tangent))/maxval(abs(tangent)), 0.0_wp, 1e-5_wp)
  call require('secant for the operator', secant_stiffness(law, point), &
               sqrt(sum(traction_at([0.0_wp, 0.0_wp, 2e-6_wp])**2))/2e-6_wp, 1e-3_wp)

contains

  !> Traction at some jumps.
  function traction_at(jumps) result(found)
    !> The jumps
    real(wp), intent(in) :: jumps(3)
    !> The traction
    real(wp) :: found(3)
    real(wp) :: slope(3, 3)

    call traction_of(law, jumps, point, found, ignored, slope)
  end function traction_at

  !> Work of the traction along a straight path of jumps, accepted in small steps.
  real(wp) function pulled(from, to, state) result(total)
    !> Jumps at both ends
    real(wp), intent(in) :: from(3), to(3)
    !> The point; updated
    type(interface_point_t), intent(inout) :: state
    integer, parameter :: steps = 400000
    type(interface_point_t) :: next
    real(wp) :: slope(3, 3), force(3)
    integer :: step

    total = 0
    do step = 1, steps
      ! The traction at the middle of a step.
      call traction_of(law, from + (to - from)*((step - 0.5_wp)/steps), state, force, next, slope)
      total = total + dot_product(force, to - from)/steps
      state = next
    end do
    call traction_of(law, to, state, force, next, slope)
    state = next
  end function pulled
end program pull_interface
