!> Plates without motion in their plane, whose unknowns u and v are left out.
module idle_membranes
  use kinds, only: wp
  use mesh_parameters, only: is_flat
  use plate_options, only: kinematics_linear
  use setups, only: setup_t
  use stacking, only: section_t
  implicit none
  private
  public :: is_membrane_idle, uncoupled

  !> Largest coupling of membrane and bending that is round-off, relative to the stiffnesses it couples
  real(wp), parameter :: round_off = 1.0e-12_wp

contains

  !> True if no in-plane motion occurs, so that u and v are zero.
  pure logical function is_membrane_idle(setup, zones, section) result(idle)
    type(setup_t), intent(in) :: setup
    !> Number of zones of layers
    integer, intent(in) :: zones
    !> The laminate's section
    type(section_t), intent(in) :: section

    idle = setup%mesh%kinematics == kinematics_linear .and. zones == 0 .and. .not. (setup%has_variable_sections() &
             .or. setup%thermal%is_present)
    idle = idle .and. is_flat(setup%plate) .and. setup%zones%is_empty()
    if (allocated(setup%stringers)) idle = idle .and. size(setup%stringers) == 0
    if (allocated(setup%lines)) idle = idle .and. all(setup%lines%component > 2)
    idle = idle .and. uncoupled(reshape(section%stiffness, [1, 21, 1]), reshape(section%mass, [1, 3, 1]))
  end function is_membrane_idle

  !> True if membrane and bending are not coupled except by round-off.
  pure logical function uncoupled(stiffness, mass)
    !> Stiffness of sections, (any, 21, any)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Their I0, I1, I2, (any, 3, any)
    real(wp), intent(in) :: mass(:, :, :)

    uncoupled = largest(stiffness(:, 7:12, :)) <= round_off*sqrt(largest(stiffness(:, 1:6, :)) &
                                                                 *largest(stiffness(:, 13:18, :))) &
                .and. largest(mass(:, 2:2, :)) <= round_off*sqrt(largest(mass(:, 1:1, :))*largest(mass(:, 3:3, :)))
  end function uncoupled

  !> Largest magnitude; 0 if there are no values.
  pure real(wp) function largest(values)
    !> The values
    real(wp), intent(in) :: values(:, :, :)

    largest = maxval([0.0_wp, abs(values)])
  end function largest
end module idle_membranes
