!> Mean rule of a cohesive interface: a traction whose work over a step is what the law stores and dissipates in it.
!>
!> Steps converge with it where the law's own traction snaps back. It acts like a viscosity (16 % less area with steps
!> of 20 us), so it is the last resort of a step.
module cohesive_means
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, cohesive_reach_t, cohesive_reach, cohesive_traction, grown_damage, &
                             opened, share_growth, undamaged_energy
  use cohesive_tangents, only: toughness_slopes, traction_slopes
  use kinds, only: wp
  implicit none
  private
  public :: mean_traction, mean_tangent

  !> The way from the accepted to the trial jumps.
  type :: way_t
    !> Largest change of a jump
    real(wp) :: size = 0
    !> Changes of the jumps over it, and the same as the law sees them, closing as none
    real(wp) :: change(3) = 0, seen(3) = 0
    !> Their product; 0: no way
    real(wp) :: product = 0
    !> Energy per area and size that the law's own traction leaves out
    real(wp) :: missing = 0
  end type way_t

contains

  !> Traction of trial jumps: the law's, and along the way whatever its work lacks of the energy stored and dissipated,
  !> t + max(0, (1 - d) Y - (1 - d_o) Y_o + de - t.dv) dv/|dv|**2. Work in excess, as of unloading, is left as it is.
  !> The direction leaves out the part of the way on which faces are closed: contact alone acts there.
  pure subroutine mean_traction(law, old_jumps, jumps, pressure, old, traction, new)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Jumps of the last accepted state and of the trial state
    real(wp), intent(in) :: old_jumps(3), jumps(3)
    !> Contact pressure of the last accepted state
    real(wp), intent(in) :: pressure
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Force per area that pulls the faces back
    real(wp), intent(out) :: traction(3)
    !> The point with the trial jumps
    type(cohesive_point_t), intent(out) :: new
    type(way_t) :: way

    call cohesive_traction(law, jumps, pressure, old, traction, new)
    way = way_between(law, old_jumps, jumps, cohesive_reach(law, jumps, pressure), old, new)
    if (way%missing > 0) traction = traction + way%missing*(way%seen/way%product)
  end subroutine mean_traction

  !> Derivative of that traction by the trial jumps, its symmetric part. Along the way it is minus the energy left out
  !> over |dv|**2, less than nothing, if the toughness stays.
  pure function mean_tangent(law, old_jumps, jumps, pressure, old) result(tangent)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Jumps of the last accepted state and of the trial state
    real(wp), intent(in) :: old_jumps(3), jumps(3)
    !> Contact pressure of the last accepted state
    real(wp), intent(in) :: pressure
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: tangent(3, 3)
    type(cohesive_reach_t) :: reach
    type(cohesive_point_t) :: new
    type(way_t) :: way
    real(wp) :: moving(3), gain(3)
    integer :: i

    reach = cohesive_reach(law, jumps, pressure)
    new%damage = grown_damage(law, reach, old)
    tangent = traction_slopes(law, jumps, reach, old)
    way = way_between(law, old_jumps, jumps, reach, old, new)
    if (way%missing > 0) then
      moving = 1
      if (jumps(3) < 0) moving(3) = 0
      gain = share_growth(law, old%damage, new%damage)*(toughness_slopes(law, reach)/reach%size)/way%size &
             - matmul(way%change, tangent) &
             - (way%missing/way%size)*(moving*way%change + way%seen)/way%product
      do i = 1, 3
        tangent(:, i) = tangent(:, i) + way%seen*(gain(i)/way%product)
        tangent(i, i) = tangent(i, i) + (way%missing/way%size)*moving(i)/way%product
      end do
    end if
    tangent = (tangent + transpose(tangent))/2
  end function mean_tangent

  !> The way between two states and the energy that the law's traction leaves out on it. The difference is written
  !> without the large energies that cancel: (d - d_o) (G_c N/(D D_o) - Y_o) - (1 - d) Y(dv), D = N (1 - d) + d, where
  !> the first bracket is what growth dissipates above what unloading by it sets free.
  pure function way_between(law, old_jumps, jumps, reach, old, new) result(way)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Jumps of the last accepted state and of the trial state
    real(wp), intent(in) :: old_jumps(3), jumps(3)
    !> Place of the trial jumps on the curve
    type(cohesive_reach_t), intent(in) :: reach
    !> The point in the last accepted and in the trial state
    type(cohesive_point_t), intent(in) :: old, new
    !> The way
    type(way_t) :: way
    real(wp) :: stiffness(3), carried(3)

    if (.not. new%damage > old%damage) return
    way%size = maxval(abs(jumps - old_jumps))
    if (.not. way%size > 0) return
    way%change = (jumps - old_jumps)/way%size
    way%seen = (opened(jumps) - opened(old_jumps))/way%size
    way%product = dot_product(way%change, way%seen)
    if (.not. way%product > 0) return
    stiffness = stiffness_of(law)
    way%missing = reach%toughness*(share_growth(law, old%damage, new%damage)/way%size) &
                  - (new%damage - old%damage)*(undamaged_energy(law, old_jumps)/way%size)
    carried = (1 - new%damage)*stiffness*(way%seen*way%size/2)*way%seen
    ! Faces that delaminate from contact do the law's work on the whole way, not on its open part alone.
    carried(3) = carried(3) + (1 - new%damage)*stiffness(3)*max(jumps(3), 0.0_wp)*(way%change(3) - way%seen(3))
    way%missing = way%missing - sum(carried)
  end function way_between
end module cohesive_means
