!> Surfaces at a point of a cohesive interface: cohesive law in opening, penalty stiffness of the undamaged interface in
!> closing, and friction on the damaged part of the area under pressure. Without contact the part of the area that was
!> damaged at the start of the step has no stiffness in closing, so that tractions have a potential within a step. The
!> undamaged part acts in opening and closing, and growing damage releases the energy stored in closing.
module cohesive_surfaces
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, separation_of, cohesive_traction, grown_damage, separation_t, &
                             stored_energy, undamaged_energy
  use cohesive_tangents, only: operator_stiffness, traction_slopes
  use surface_friction, only: friction_energy, friction_slopes, friction_traction
  use kinds, only: wp
  use linear_softening, only: fraction_growth
  implicit none
  private
  public :: cohesive_surfaces_t

  !> Law, contact and friction of the surfaces at a point.
  type :: cohesive_surfaces_t
    type(cohesive_law_t) :: law
    !> True: contact prevents penetration of damaged surfaces
    logical :: closing = .true.
    !> Coulomb's coefficient of friction; 0: none
    real(wp) :: friction = 0
  contains
    procedure :: traction
    procedure :: stored
    procedure :: work
    procedure :: closing_loss
    procedure :: slopes
    procedure :: diagonal
    procedure :: friction_limit
  end type cohesive_surfaces_t

contains

  !> Traction of trial jumps, and the history variables of the trial state.
  pure subroutine traction(self, jumps, old, force, new)
    class(cohesive_surfaces_t), intent(in) :: self
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Force per area against the jumps
    real(wp), intent(out) :: force(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(out) :: new
    real(wp) :: friction(2)

    call cohesive_traction(self%law, jumps, old, force, new)
    if (jumps(3) < 0) force(3) = closing_stiffness(self, old)*jumps(3)
    if (.not. self%friction > 0) return
    call friction_traction(self%law%stiffness_shear, jumps(:2), old%sliding, friction, new%sliding)
    force(:2) = force(:2) + friction
  end subroutine traction

  !> Energy per area stored by the jumps.
  pure real(wp) function stored(self, jumps, point)
    class(cohesive_surfaces_t), intent(in) :: self
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(in) :: point

    stored = stored_energy(self%law, jumps, point)
    if (jumps(3) < 0) stored = stored + closing_stiffness(self, point)*jumps(3)**2/2
    if (self%friction > 0) stored = stored + friction_energy(self%law%stiffness_shear, jumps(:2), point%sliding)
  end function stored

  !> Work per area on the cohesive law in a step: change of the stored energy without that of friction and contact,
  !> energy dissipated, and loss in closing. It starts from the energy of the law at the first jumps: where flaws or a
  !> mapping have weakened the point, damage at constant jumps requires no work.
  pure real(wp) function work(self, from, to, old, damage)
    class(cohesive_surfaces_t), intent(in) :: self
    !> Two shears and opening at the start and at the end
    real(wp), intent(in) :: from(3), to(3)
    !> The point at the start
    type(cohesive_point_t), intent(in) :: old
    !> Damage at the end
    real(wp), intent(in) :: damage
    type(separation_t) :: separation
    real(wp) :: first

    first = old%damage
    work = 0
    if (damage > first) then
      first = min(damage, grown_damage(self%law, separation_of(self%law, from), old))
      separation = separation_of(self%law, to)
      work = separation%toughness*fraction_growth(self%law%failure_ratio, first, damage)
    end if
    work = work + (1 - damage)*undamaged_energy(self%law, to) - (1 - first)*undamaged_energy(self%law, from)
    if (self%closing) return
    work = work + self%law%stiffness_closing/2*((1 - damage)*min(to(3), 0.0_wp)**2 &
                                                - (1 - first)*min(from(3), 0.0_wp)**2) &
           + self%closing_loss(from(3), to(3), damage - first)
  end function work

  !> Energy per area that closed surfaces without contact lose by growing damage, by the trapezoidal rule.
  pure real(wp) function closing_loss(self, from, to, growth)
    class(cohesive_surfaces_t), intent(in) :: self
    !> Opening at the start and at the end
    real(wp), intent(in) :: from, to
    !> Growth of damage
    real(wp), intent(in) :: growth

    closing_loss = 0
    if (.not. self%closing) closing_loss = self%law%stiffness_closing*growth*min(from, 0.0_wp)*min(to, 0.0_wp)/2
  end function closing_loss

  !> Derivative of the traction.
  pure function slopes(self, jumps, old)
    class(cohesive_surfaces_t), intent(in) :: self
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Derivatives of each traction (row) with respect to each jump (column)
    real(wp) :: slopes(3, 3)

    slopes = traction_slopes(self%law, jumps, separation_of(self%law, jumps), old)
    if (jumps(3) < 0) slopes(3, 3) = closing_stiffness(self, old)
    if (self%friction > 0) &
      slopes(:2, :2) = slopes(:2, :2) + friction_slopes(self%law%stiffness_shear, jumps(:2), old%sliding)
  end function slopes

  !> Diagonal for a factored operator, constant within a class of points.
  pure function diagonal(self, jumps, old)
    class(cohesive_surfaces_t), intent(in) :: self
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: diagonal(3)
    real(wp) :: slopes(2, 2)

    diagonal = operator_stiffness(self%law, jumps, old)
    if (jumps(3) < 0) diagonal(3) = closing_stiffness(self, old)
    if (.not. self%friction > 0) return
    slopes = friction_slopes(self%law%stiffness_shear, jumps(:2), old%sliding)
    diagonal(:2) = diagonal(:2) + [slopes(1, 1), slopes(2, 2)]
  end function diagonal

  !> Friction limit of an accepted state: coefficient of friction times pressure times damaged fraction of the area (G.
  !> Alfano, E. Sacco, Int. J. Numer. Meth. Eng. 68 (2006) 542-582; theory (D4)).
  pure real(wp) function friction_limit(self, jumps, point) result(limit)
    class(cohesive_surfaces_t), intent(in) :: self
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(in) :: point

    limit = 0
    if (self%closing .and. jumps(3) < 0) &
      limit = -self%friction*point%damage*self%law%stiffness_closing*jumps(3)
  end function friction_limit

  !> Stiffness of closing surfaces: that of the undamaged interface with contact, that of its undamaged part without.
  pure real(wp) function closing_stiffness(self, point) result(stiffness)
    type(cohesive_surfaces_t), intent(in) :: self
    !> The point with its jumps
    type(cohesive_point_t), intent(in) :: point

    stiffness = self%law%stiffness_closing
    if (.not. self%closing) stiffness = (1 - point%damage)*stiffness
  end function closing_stiffness
end module cohesive_surfaces
