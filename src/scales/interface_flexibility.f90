!> Deflection that the initial stiffness of cohesive interfaces adds to a plate under a force on a patch.
!>
!> An intact interface slides by tau/K_s and closes by p/K_n. Under the shear force Q it has the complementary energy
!> (f Q)**2/(2 K_s) per area, with the shear stress f between the plies for Q = 1. Around a force P on a circle of
!> radius r0 the shear force is P/(2 pi r), within it P r/(2 pi r0**2): the integral of (Q/P)**2 over a circle of radius
!> R is (1/4 + log(R/r0))/(2 pi). The pressure below the patch is that on it times the share of Q that the plies below
!> carry.
module interface_flexibility
  use cohesive_laws, only: cohesive_law_t
  use delamination_parameters, only: delamination_t, law_cohesive
  use interface_laws, only: law_between_plies
  use interlaminar_stresses, only: unit_stresses_t, unit_stresses_of
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mean_stiffnesses, only: in_bending
  use plies, only: ply_t
  use ply_stacks, only: ply_stack_t
  use setup_scales, only: free_span, loaded_side
  use setups, only: setup_t
  use stacking, only: stacked_plies
  implicit none
  private
  public :: added_share

contains

  !> Deflection of the struck point by the interfaces over that of the plate, static; 0 without an impactor.
  pure real(wp) function added_share(setup, compliance) result(share)
    type(setup_t), intent(in) :: setup
    !> Deflection of the plate per force
    real(wp), intent(in) :: compliance

    share = 0
    if (setup%impactor%is_present .and. compliance > 0) share = added_compliance(setup)/compliance
  end function added_share

  !> Deflection of the struck point per force by the interfaces between the plies there, in the zones in which they have
  !> layers. Bonds of doublers are not counted.
  pure real(wp) function added_compliance(setup) result(added)
    type(setup_t), intent(in) :: setup
    type(ply_t), allocatable :: skin(:)
    type(ply_stack_t) :: stack
    type(unit_stresses_t) :: unit
    type(cohesive_law_t) :: law
    real(wp) :: below
    integer :: i, at

    added = 0
    if (.not. allocated(setup%delaminations)) return
    skin = stacked_plies(setup%laminate, setup%materials)
    stack = setup%struck_stack()
    unit = unit_stresses_of(in_bending(stacked_plies(setup%struck_laminate(), setup%materials)))
    do i = 1, size(setup%delaminations)
      associate (interface => setup%delaminations(i))
        if (interface%law /= law_cohesive .or. interface%bonds_doublers()) cycle
        at = findloc(stack%number, interface%below_ply, 1)
        if (at < 1 .or. at > size(unit%shear, 3)) cycle
        law = law_between_plies(interface, skin, size(setup%delaminations))
        if (.not. law%stiffness_shear > 0) cycle
        below = 1 - (unit%carried(1, 1, at) + unit%carried(2, 2, at))/2
        added = added + sum(unit%shear(:, :, at)**2)/(2*law%stiffness_shear)*spread_over(setup, interface) + &
                (below/loaded_side(setup))**2/law%stiffness_closing
      end associate
    end do
  end function added_compliance

  !> Integral of (Q/P)**2 over the layers of an interface. Their rectangle is replaced by the circle of the same area, a
  !> long one by the circle that has the same integral as a strip clamped or simply supported at both sides.
  pure real(wp) function spread_over(setup, interface) result(integral)
    type(setup_t), intent(in) :: setup
    !> The interface
    type(delamination_t), intent(in) :: interface
    real(wp) :: sides(2), outer, inner

    sides = min(interface%zone, free_span(setup))
    outer = min(sqrt(product(sides)/pi), 2*minval(sides)/pi)
    inner = loaded_side(setup)/sqrt(pi)
    if (outer < inner) then
      integral = (outer/inner)**4/(8*pi)
    else
      integral = (0.25_wp + log(outer/inner))/(2*pi)
    end if
  end function spread_over
end module interface_flexibility
