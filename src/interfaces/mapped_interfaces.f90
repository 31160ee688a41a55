!> Cohesive interfaces in the transfer to another mesh, by weighted means of old points: the dissipated fraction of the
!> toughness is transferred instead of the damage variable, since its mean conserves dissipated area and energy.
module mapped_interfaces
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: damage_at_fraction, separation_of
  use face_friction, only: friction_traction, sliding_t
  use kinds, only: wp
  use models, only: model_t
  implicit none
  private
  public :: limit_jumps, put_fractions, set_damage, set_slips

contains

  !> Replaces the damage by the dissipated fraction of the toughness.
  pure subroutine put_fractions(interfaces, model)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model

    if (allocated(interfaces%cohesive)) interfaces%points%damage = interfaces%dissipated_fractions(model)
  end subroutine put_fractions

  !> Replaces the dissipated fraction of the toughness by the damage.
  pure subroutine set_damage(interfaces, model)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model
    integer :: i

    if (.not. allocated(interfaces%cohesive)) return
    do i = 1, size(interfaces%points)
      if (.not. interfaces%cohesive(i)) cycle
      associate (point => interfaces%points(i))
        point%damage = damage_at_fraction(interfaces%law_at(model, i), point%damage)
        interfaces%stiffness(:, i) = (1 - point%damage)*model%contact_area(i)* &
                                     stiffness_of(model%cohesive_laws(model%zone(i)))
      end associate
    end do
  end subroutine set_damage

  !> Reduces jumps that exceed those of the damage: between the old nodes interpolated jumps do, since both vary along
  !> different curves, and would extend the damage in the first step.
  pure subroutine limit_jumps(interfaces, model, displacement)
    !> The interfaces, with their damage
    type(cohesive_interfaces_t), intent(in) :: interfaces
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points); jumps are reduced in direction
    real(wp), intent(inout) :: displacement(:, :)
    type(cohesive_law_t) :: law
    real(wp) :: ratio, damage
    integer :: i

    if (.not. allocated(interfaces%cohesive)) return
    do i = 1, size(interfaces%points)
      if (.not. interfaces%cohesive(i)) cycle
      damage = interfaces%points(i)%damage
      if (.not. damage < 1) cycle
      law = interfaces%law_at(model, i)
      associate (separation => separation_of(law, displacement(1:3, i), 0.0_wp))
        if (.not. separation%size > 0) cycle
        ! Its ratio ends at failure; that of these jumps does not.
        ratio = separation%size*sqrt(law%failure_ratio*separation%unit_energy/separation%toughness)
      end associate
      ratio = ratio*(law%failure_ratio - damage*(law%failure_ratio - 1))/law%failure_ratio
      if (.not. ratio > 1) cycle
      displacement(1:2, i) = displacement(1:2, i)/ratio
      displacement(3, i) = displacement(3, i)/merge(ratio, 1.0_wp, displacement(3, i) > 0)
    end do
  end subroutine limit_jumps

  !> Corrects slips so that friction is within its limit: means of slips are not consistent with the interpolated jumps,
  !> and elastic energy beyond the limit would be spurious.
  pure subroutine set_slips(interfaces, model, displacement)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    type(sliding_t) :: new
    real(wp) :: traction(2)
    integer :: i

    if (.not. allocated(interfaces%cohesive)) return
    do i = 1, model%distribution%owned
      if (.not. interfaces%cohesive(i)) cycle
      if (.not. model%setup%delaminations(model%zone(i))%friction > 0) cycle
      associate (sliding => interfaces%points(i)%sliding, law => model%cohesive_laws(model%zone(i)))
        call friction_traction(law%stiffness_shear, displacement(1:2, i), sliding, traction, new)
        sliding%slip = new%slip
      end associate
    end do
  end subroutine set_slips
end module mapped_interfaces
