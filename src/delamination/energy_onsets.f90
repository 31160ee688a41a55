!> Onset of damage at a point beside a delaminated one by the energy release rate, theory (D15) to (D17), for cells
!> longer than the process zone.
!>
!> Virtual crack closure over two nodes, the point and the one ahead, is exact for nine-node elements with nodal ties:
!> the force on the front acts on the jump two nodes behind, the force ahead on the jump one node behind (E. F. Rybicki,
!> M. F. Kanninen, Engineering Fracture Mechanics 9 (1977) 931-938). From the onset on the law softens from the present
!> traction and dissipates the toughness, as all cohesive laws do.
module energy_onsets
  use benzeggagh_kenane, only: toughness_gain
  use cohesive_laws, only: cohesive_law_t, min_failure_ratio, weakened
  use cohesive_points, only: opened, separation_of, separation_t
  use kinds, only: wp
  implicit none
  private
  public :: onset_share, release_over_toughness, reduce_law

  !> Energy release rate at the onset over the toughness. With equal nodes in shear the softening zone is about
  !> pi/(2 sqrt(share)) nodes long, and the load at which the front passes from node to node differs from the closed
  !> form by at most 2 % for each share up to 2/9, three nodes, by 4 % up to .45 and 9 % above
  !> (tests/studies/onset_share.py). Smaller shares lengthen the zone, which lowers loads of round fronts. In opening a
  !> corner node of long elements releases r = 1.65 times the energy of its area: below 1/r**2 = .37 it does not fail
  !> before the toughness is reached. From .15 to .3 measured loads change by 1.5 % (doc/studies/interfaces.md).
  real(wp), parameter :: onset_share = 0.2_wp
  !> Smallest factor of the strengths: where a point carries less, softening waits for more traction. It makes the ratio
  !> of jumps at failure and at the onset 1e6 times that of the undamaged law.
  real(wp), parameter :: min_strength = 1.0e-3_wp

contains

  !> Energy release rate of a front that advances over two nodes, divided by the toughness of its mixture of modes.
  pure real(wp) function release_over_toughness(law, tractions, jumps, widths) result(ratio)
    !> The law of the undamaged interface
    type(cohesive_law_t), intent(in) :: law
    !> Tractions at the point and at the node ahead, two shears and opening, (3, 2)
    real(wp), intent(in) :: tractions(3, 2)
    !> Jumps at the nodes one and two nodes behind, (3, 2)
    real(wp), intent(in) :: jumps(3, 2)
    !> Lengths along the direction of growth that belong to the point and to the node ahead
    real(wp), intent(in) :: widths(2)
    real(wp) :: works(3), shear, opening, toughness

    ! Closed surfaces behind the front release nothing, although the pressure on it does work on their overlap.
    works = (widths(1)*tractions(:, 1)*opened(jumps(:, 2)) + widths(2)*tractions(:, 2)*opened(jumps(:, 1))) &
            /(2*sum(widths))
    shear = max(0.0_wp, works(1) + works(2))
    opening = max(0.0_wp, works(3))
    ratio = 0
    if (.not. shear + opening > 0) return
    toughness = law%toughness_opening
    ! The power is the most expensive operation.
    if (shear > 0 .and. abs(law%toughness_shear - law%toughness_opening) > 0) &
      toughness = toughness*(1 + toughness_gain(1.0_wp, law%toughness_shear/law%toughness_opening, &
                                                law%mixing_exponent, shear/(shear + opening)))
    ratio = (shear + opening)/toughness
  end function release_over_toughness

  !> Factors of the law with which a point softens from its present traction.
  !>
  !> The tractions of one law are in the ratio of the jumps times the stiffnesses. In thin layers on long cells a small
  !> traction opens the front much farther than the same traction shears it, and a law of equal stiffnesses would resist
  !> the opening with a traction that the layers cannot exert. The stiffness of opening is therefore reduced until
  !> tractions in the ratio of those at the front cause jumps in the ratio of those behind it.
  pure subroutine reduce_law(law, jump, traction, behind, strength, opening)
    !> The law of the undamaged interface
    type(cohesive_law_t), intent(in) :: law
    !> Jump and traction of the point, and jump at the node behind it: two shears and opening
    real(wp), intent(in) :: jump(3), traction(3), behind(3)
    !> Factors of the strengths and of the stiffness of opening
    real(wp), intent(out) :: strength, opening
    type(separation_t) :: onset
    real(wp) :: shear, slid, compliance

    opening = 1
    shear = norm2(traction(:2))
    if (shear > 0 .and. traction(3) > 0 .and. behind(3) > 0) then
      slid = dot_product(traction(:2), behind(:2))/shear
      compliance = traction(3)/(law%stiffness_opening*behind(3))
      if (slid > 0) opening = min(1.0_wp, compliance*max(min_failure_ratio, law%stiffness_shear*slid/shear))
    end if
    onset = separation_of(weakened(law, 1.0_wp, opening), opened(jump)/[1.0_wp, 1.0_wp, opening])
    strength = max(min_strength, onset%ratio)
  end subroutine reduce_law
end module energy_onsets
