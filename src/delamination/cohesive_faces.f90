!> Two faces at a point of a cohesive interface: the law while they part, the stiffness of the undamaged interface while
!> they are pressed together.
module cohesive_faces
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, cohesive_reach, cohesive_traction, grown_damage, stored_energy
  use cohesive_tangents, only: cohesive_tangent, operator_stiffness, traction_slopes
  use kinds, only: wp
  implicit none
  private
  public :: cohesive_faces_t

  !> The faces at a point: how they are held together and apart.
  type :: cohesive_faces_t
    !> The law that holds them together
    type(cohesive_law_t) :: law
    !> True: they do not pass through each other
    logical :: closing = .true.
  contains
    !> Traction of trial jumps.
    procedure :: traction
    !> Energy per area that the jumps store.
    procedure :: stored
    !> Derivative of the traction, whole and made symmetric.
    procedure :: slopes
    procedure :: tangent
    !> Slopes of a line through the origin and the traction: never below those of the tangent.
    procedure :: secant
    !> Diagonal for a factored operator.
    procedure :: diagonal
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

    call cohesive_traction(self%law, jumps, 0.0_wp, old, force, new)
    if (pressed(self, jumps)) force(3) = self%law%stiffness_opening*jumps(3)
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
    if (pressed(self, jumps)) stored = stored + self%law%stiffness_opening*jumps(3)**2/2
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

    slopes = traction_slopes(self%law, jumps, cohesive_reach(self%law, jumps, 0.0_wp), old)
    if (pressed(self, jumps)) slopes(3, 3) = self%law%stiffness_opening
  end function slopes

  !> Derivative of the traction, its symmetric part.
  pure function tangent(self, jumps, old)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: tangent(3, 3)

    tangent = cohesive_tangent(self%law, jumps, 0.0_wp, old)
    if (pressed(self, jumps)) tangent(3, 3) = self%law%stiffness_opening
  end function tangent

  !> Slopes of a line through the origin and the traction. As the law softens its energy lies below that of these
  !> slopes, so steps made with them always descend.
  pure function secant(self, jumps, old)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: secant(3)

    secant = (1 - grown_damage(self%law, cohesive_reach(self%law, jumps, 0.0_wp), old))*stiffness_of(self%law)
    if (pressed(self, jumps)) secant(3) = self%law%stiffness_opening
  end function secant

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

    diagonal = operator_stiffness(self%law, jumps, 0.0_wp, old)
    if (pressed(self, jumps)) diagonal(3) = self%law%stiffness_opening
  end function diagonal

  !> True where the faces press on each other.
  pure logical function pressed(self, jumps)
    !> The faces
    class(cohesive_faces_t), intent(in) :: self
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)

    pressed = self%closing .and. jumps(3) < 0
  end function pressed
end module cohesive_faces
