!> Cohesive interfaces in the transfer to another mesh, by weighted means of old points, theory (D14): the dissipated
!> fraction of the toughness is transferred instead of the damage variable, since its mean conserves dissipated area and
!> energy.
module mapped_interfaces
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_laws, only: stiffness_of
  use cohesive_points, only: damage_at_fraction
  use surface_friction, only: friction_traction, sliding_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: put_fractions, set_damage, set_slips

contains

  !> Replaces the damage by the dissipated fraction of the toughness.
  pure subroutine put_fractions(interfaces, plate)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate

    if (allocated(interfaces%cohesive)) interfaces%points%damage = interfaces%dissipated_fractions(plate)
  end subroutine put_fractions

  !> Replaces the dissipated fraction of the toughness by the damage.
  pure subroutine set_damage(interfaces, plate)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate
    integer :: i

    if (.not. allocated(interfaces%cohesive)) return
    do i = 1, size(interfaces%points)
      if (.not. interfaces%cohesive(i)) cycle
      associate (point => interfaces%points(i))
        point%damage = damage_at_fraction(interfaces%law_at(plate, i), point%damage)
        interfaces%stiffness(:, i) = (1 - point%damage)*plate%interfaces%contact_area(i)* &
                                     stiffness_of(plate%interfaces%cohesive_laws(plate%zone(i)))
      end associate
    end do
  end subroutine set_damage

  !> Corrects slips so that friction is within its limit: means of slips are not consistent with the interpolated jumps,
  !> and the elastic energy of forces above the limit would be spurious.
  pure subroutine set_slips(interfaces, plate, displacement)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    type(sliding_t) :: new
    real(wp) :: traction(2)
    integer :: i

    if (.not. allocated(interfaces%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. interfaces%cohesive(i)) cycle
      if (.not. plate%setup%delaminations(plate%zone(i))%friction > 0) cycle
      associate (sliding => interfaces%points(i)%sliding, law => plate%interfaces%cohesive_laws(plate%zone(i)))
        call friction_traction(law%stiffness_shear, displacement(1:2, i), sliding, traction, new)
        sliding%slip = new%slip
      end associate
    end do
  end subroutine set_slips
end module mapped_interfaces
