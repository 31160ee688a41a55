!> Two faces at a point of a cohesive interface: the law while they part, the stiffness of the undamaged interface while
!> they are pressed together, and friction between the damaged parts of faces that press on each other. Faces without
!> contact pass through each other as far as they were damaged when the step began, so that tractions have a potential
!> within a step; what is intact holds them in both directions. What it stores as they close is released as damage
!> grows,
!> and is found again in what the integrators take.
module cohesive_faces
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, separation_of, cohesive_traction, grown_damage, stored_energy
  use cohesive_tangents, only: operator_stiffness, traction_slopes
  use face_friction, only: friction_energy, friction_slopes, friction_traction
  use kinds, only: wp
  implicit none
  private
  public :: cohesive_faces_t

  !> The faces at a point: how they are held together and apart.
  type :: cohesive_faces_t
    !> The law that holds them together
    type(cohesive_law_t) :: law
    !> True: they do not pass through each other where they are damaged
    logical :: closing = .true.
    !> Coulomb's coefficient of friction; 0: they slide freely
    real(wp) :: friction = 0
  contains
    !> Traction of trial jumps.
    procedure :: traction
    !> Energy per area that the jumps store.
    procedure :: stored
    !> Derivative of the traction.
    procedure :: slopes
    !> Diagonal for a factored operator.
    procedure :: diagonal
    !> Friction limit.
    procedure :: friction_limit
  end type cohesive_faces_t

contains

  !> Traction of trial jumps, and what the point will remember if they are accepted.
  pure subroutine traction(self, jumps, old, force, new)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Force per area that pulls the faces back, or pushes them apart
    real(wp), intent(out) :: force(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(out) :: new
    real(wp) :: friction(2)

    call cohesive_traction(self%law, jumps, 0.0_wp, old, force, new)
    if (jumps(3) < 0) force(3) = closing_stiffness(self, old)*jumps(3)
    if (.not. self%friction > 0) return
    call friction_traction(self%law%stiffness_shear, jumps(:2), old%sliding, friction, new%sliding)
    force(:2) = force(:2) + friction
  end subroutine traction

  !> Energy per area that the jumps store.
  pure real(wp) function stored(self, jumps, point)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(in) :: point

    stored = stored_energy(self%law, jumps, point)
    if (jumps(3) < 0) stored = stored + closing_stiffness(self, point)*jumps(3)**2/2
    if (self%friction > 0) stored = stored + friction_energy(self%law%stiffness_shear, jumps(:2), point%sliding)
  end function stored

  !> Derivative of the traction.
  pure function slopes(self, jumps, old)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Derivatives of each traction (row) by each jump (column)
    real(wp) :: slopes(3, 3)

    slopes = traction_slopes(self%law, jumps, separation_of(self%law, jumps, 0.0_wp), old)
    if (jumps(3) < 0) slopes(3, 3) = closing_stiffness(self, old)
    if (self%friction > 0) slopes(:2, :2) = slopes(:2, :2) + sticking(self, jumps, old)
  end function slopes

  !> Diagonal for a factored operator, one value a class of point.
  pure function diagonal(self, jumps, old)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: diagonal(3)
    real(wp) :: slopes(2, 2)

    diagonal = operator_stiffness(self%law, jumps, 0.0_wp, old)
    if (jumps(3) < 0) diagonal(3) = closing_stiffness(self, old)
    if (.not. self%friction > 0) return
    slopes = sticking(self, jumps, old)
    diagonal(:2) = diagonal(:2) + [slopes(1, 1), slopes(2, 2)]
  end function diagonal

  !> Friction limit once a step is accepted: Coulomb's part of the pressure, on the part of the point that is
  !> damaged (G. Alfano, E. Sacco 2006).
  pure real(wp) function friction_limit(self, jumps, point) result(limit)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(in) :: point

    limit = 0
    if (pressed(self, jumps)) limit = -self%friction*point%damage*self%law%stiffness_opening*jumps(3)
  end function friction_limit

  !> Slopes of friction.
  pure function sticking(self, jumps, old) result(slopes)
    !> The faces
    type(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump along the faces
    real(wp) :: slopes(2, 2)

    slopes = friction_slopes(self%law%stiffness_shear, jumps(:2), old%sliding)
  end function sticking

  !> Stiffness of faces that close: that of the interface, without contact that of what is left of it.
  pure real(wp) function closing_stiffness(self, point) result(stiffness)
    !> The faces
    type(cohesive_faces_t), intent(in) :: self
    !> The point with its jumps
    type(cohesive_point_t), intent(in) :: point

    stiffness = self%law%stiffness_opening
    if (.not. self%closing) stiffness = (1 - point%damage)*stiffness
  end function closing_stiffness

  !> True where the faces press on each other.
  pure logical function pressed(self, jumps)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)

    pressed = self%closing .and. jumps(3) < 0
  end function pressed
end module cohesive_faces
