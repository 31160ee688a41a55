!> Coulomb friction between surfaces under pressure: tangential traction against sliding.
!>
!> Surfaces stick elastically up to a limit, as in Alfano and Sacco, International Journal for Numerical Methods in
!> Engineering 68 (2006) 542-582: the traction is K (s - slip), and jumps s beyond the limit become slip. The limit is
!> constant in a step, so that the traction has a potential, its derivative is symmetric, and the frictional heat is not
!> negative, however the pressure changes.
module surface_friction
  use kinds, only: wp
  implicit none
  private
  public :: sliding_t, friction_traction, friction_slopes, friction_energy

  !> History variables of friction at a point.
  type :: sliding_t
    !> Tangential jumps without friction traction
    real(wp) :: slip(2) = 0
    !> Friction limit, force per area
    real(wp) :: limit = 0
    !> Frictional heat per area
    real(wp) :: heat = 0
  end type sliding_t

contains

  !> Friction traction, and the history variables of the trial state.
  pure subroutine friction_traction(stiffness, jumps, old, traction, new)
    !> Stiffness of sticking surfaces, pressure per jump
    real(wp), intent(in) :: stiffness
    !> Tangential jumps
    real(wp), intent(in) :: jumps(2)
    !> The surfaces in the last accepted state, with the limit of this step
    type(sliding_t), intent(in) :: old
    !> Force per area against the jumps
    real(wp), intent(out) :: traction(2)
    !> The surfaces with these jumps
    type(sliding_t), intent(out) :: new
    real(wp) :: size

    new = old
    traction = stiffness*(jumps - old%slip)
    size = hypot(traction(1), traction(2))
    if (.not. size > old%limit) return
    traction = old%limit*(traction/size)
    new%slip = jumps - traction/stiffness
    new%heat = old%heat + old%limit*((size - old%limit)/stiffness)
  end subroutine friction_traction

  !> Derivative of the friction traction; during slip only its direction changes.
  pure function friction_slopes(stiffness, jumps, old) result(slopes)
    !> Stiffness of sticking surfaces, pressure per jump
    real(wp), intent(in) :: stiffness
    !> Tangential jumps
    real(wp), intent(in) :: jumps(2)
    !> The surfaces in the last accepted state, with the limit of this step
    type(sliding_t), intent(in) :: old
    !> Derivatives of each traction (row) with respect to each jump (column)
    real(wp) :: slopes(2, 2)
    real(wp) :: trial(2), size, part

    slopes = reshape([stiffness, 0.0_wp, 0.0_wp, stiffness], [2, 2])
    trial = stiffness*(jumps - old%slip)
    size = hypot(trial(1), trial(2))
    if (.not. size > old%limit) return
    part = stiffness*(old%limit/size)
    trial = trial/size
    slopes(:, 1) = part*([1.0_wp, 0.0_wp] - trial*trial(1))
    slopes(:, 2) = part*([0.0_wp, 1.0_wp] - trial*trial(2))
  end function friction_slopes

  !> Elastic energy per area of sticking surfaces.
  pure real(wp) function friction_energy(stiffness, jumps, point) result(energy)
    !> Stiffness of sticking surfaces, pressure per jump
    real(wp), intent(in) :: stiffness
    !> Tangential jumps
    real(wp), intent(in) :: jumps(2)
    !> The surfaces with these jumps
    type(sliding_t), intent(in) :: point

    energy = stiffness*sum((jumps - point%slip)**2)/2
  end function friction_energy
end module surface_friction
