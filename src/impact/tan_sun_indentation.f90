!> Contact force between impactor and struck face as a function of the indentation, theory (F5) to (F7): Tan and Sun's
!> law (Eq. 3 of the paper) with a reloading branch, Hertz's and Thornton's, with all energies in closed form.
!>
!> For a given committed state the force is one continuous, non-decreasing function of the indentation: zero up to the
!> dent, a power law from the dent to the largest indentation so far, and that of `contact_loading` beyond. In the law
!> of Tan and Sun the exponent is `q` until the bodies separate, so that a reversal during contact follows the unloading
!> curve, and `reload` after a separation. The reloading curve is reversible: a second contact that does not reach the
!> largest indentation is elastic. Energy is never created if 1.5 <= reload <= q, see `check_indentation` of the deck.
!> In Thornton's law the exponent is 1.5 in unloading and reloading.
module tan_sun_indentation
  use archives, only: archive_t
  use contact_loading, only: loading_force, loading_stiffness, loading_indentation, mean_loading_force
  use hertz_contact, only: hertz_exponent, hertz_force, mean_power
  use impact_parameters, only: indentation_law_t, law_hertz, law_thornton, dent_yang_sun
  use kinds, only: wp
  implicit none
  private
  public :: indentation_t, zero_force_indentation, indentation_of, indentation_force, indentation_stiffness, &
            mean_indentation_force, indentation_work, stiffening, commit_indentation

  !> History variables of the contact; changed only when a step is accepted.
  type :: indentation_t
    !> Indentation of the last accepted step (impactor displacement minus patch-mean deflection;
    !> negative: a gap)
    real(wp) :: alpha = 0
    !> Largest indentation so far
    real(wp) :: alpha_max = 0
    !> Force at the largest indentation
    real(wp) :: force_max = 0
    !> Permanent dent: the indentation at which the force vanishes
    real(wp) :: dent = 0
    !> True once the bodies have separated after the largest indentation: reloading applies
    logical :: separated = .false.
    !> Work of the contact force on the indentation so far, stored and dissipated
    real(wp) :: work = 0
  contains
    procedure :: begin_again
    procedure :: visit => visit_indentation
  end type indentation_t

  !> The power law between dent and largest indentation: force_max * s**exponent, s from 0 to 1.
  type :: branch_t
    !> Indentation at which the force vanishes
    real(wp) :: start = 0
    !> Indentation from which the loading curve applies
    real(wp) :: finish = 0
    !> Force at `finish`
    real(wp) :: force = 0
    !> Exponent
    real(wp) :: exponent = hertz_exponent
  end type branch_t

contains

  !> Indentation below which the contact force is zero: the dent, or 0.
  pure real(wp) function zero_force_indentation(law, state) result(zero_force)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    type(branch_t) :: branch

    branch = current_branch(law, state)
    zero_force = branch%start
  end function zero_force_indentation

  !> Contact force, zero or positive.
  pure real(wp) function indentation_force(law, state, alpha) result(force)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    !> Indentation, reached monotonically from the committed one
    real(wp), intent(in) :: alpha
    type(branch_t) :: branch

    branch = current_branch(law, state)
    if (alpha <= branch%start) then
      force = 0
    else if (alpha <= branch%finish) then
      force = branch%force*position(branch, alpha)**branch%exponent
    else
      force = loading_force(law, alpha)
    end if
  end function indentation_force

  !> Indentation at which the contact force has a value.
  pure real(wp) function indentation_of(law, state, force) result(alpha)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    !> The force; for 0 the indentation of first contact
    real(wp), intent(in) :: force
    type(branch_t) :: branch

    branch = current_branch(law, state)
    alpha = branch%start
    if (.not. force > 0) return
    if (force < branch%force) then
      alpha = branch%start + (branch%finish - branch%start)*(force/branch%force)**(1/branch%exponent)
    else
      alpha = loading_indentation(law, force)
    end if
  end function indentation_of

  !> Derivative of the contact force; at the largest indentation that of the branch below it.
  pure real(wp) function indentation_stiffness(law, state, alpha) result(stiffness)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    real(wp), intent(in) :: alpha
    type(branch_t) :: branch

    branch = current_branch(law, state)
    if (alpha <= branch%start) then
      stiffness = 0
    else if (alpha <= branch%finish) then
      stiffness = branch%exponent*branch%force/(branch%finish - branch%start) &
                  *position(branch, alpha)**(branch%exponent - 1)
    else
      stiffness = loading_stiffness(law, alpha)
    end if
  end function indentation_stiffness

  !> Mean of the contact force between two indentations, without cancellation; the force if they are equal.
  pure real(wp) function mean_indentation_force(law, state, alpha_from, alpha_to) result(mean)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    !> Indentation at one end of the path
    real(wp), intent(in) :: alpha_from
    !> Indentation at the other end
    real(wp), intent(in) :: alpha_to
    type(branch_t) :: branch
    real(wp) :: least, most, lower, upper

    least = min(alpha_from, alpha_to)
    most = max(alpha_from, alpha_to)
    mean = 0
    if (.not. most > least) then
      mean = indentation_force(law, state, most)
      return
    end if
    branch = current_branch(law, state)
    lower = max(least, branch%start)
    upper = min(most, branch%finish)
    if (upper > lower) mean = branch%force*(upper - lower)/(most - least) &
                              *mean_power(position(branch, lower), position(branch, upper), branch%exponent)
    lower = max(least, branch%finish)
    if (most > lower) mean = mean + mean_loading_force(law, lower, most)*(most - lower)/(most - least)
  end function mean_indentation_force

  !> Work of the contact force along a monotonic path: the exact integral of the force over the indentation.
  pure real(wp) function indentation_work(law, state, alpha_from, alpha_to) result(work)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    !> Indentation at the start of the path
    real(wp), intent(in) :: alpha_from
    !> Indentation at its end
    real(wp), intent(in) :: alpha_to

    work = mean_indentation_force(law, state, alpha_from, alpha_to)*(alpha_to - alpha_from)
  end function indentation_work

  !> Upper bound of the ratio of the present contact stiffness to that of Hertz at the same indentation, at least 1. The
  !> steepest point is the upper end of the unloading or reloading curve.
  pure real(wp) function stiffening(law, state) result(ratio)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    type(branch_t) :: branch

    branch = current_branch(law, state)
    ratio = 1
    if (branch%finish > branch%start) &
      ratio = max(ratio, branch%exponent/hertz_exponent*branch%finish/(branch%finish - branch%start) &
                  *branch%force/hertz_force(law%k, branch%finish))
  end function stiffening

  !> Accepts a new indentation, reached monotonically from the committed one.
  pure subroutine commit_indentation(law, state, alpha)
    type(indentation_law_t), intent(in) :: law
    !> State, advanced by the step
    type(indentation_t), intent(inout) :: state
    !> New indentation
    real(wp), intent(in) :: alpha

    state%work = state%work + indentation_work(law, state, state%alpha, alpha)
    if (alpha > state%alpha_max) then
      state%alpha_max = alpha
      state%force_max = loading_force(law, alpha)
      state%dent = permanent_dent(law, alpha)
      state%separated = .false.
    else if (alpha <= state%dent) then
      state%separated = .true.
    end if
    state%alpha = alpha
  end subroutine commit_indentation

  !> Begins another impact on the dent of earlier ones, which the impactor touches without a force.
  pure subroutine begin_again(self)
    class(indentation_t), intent(inout) :: self

    self%alpha = self%dent
    self%separated = .true.
    self%work = 0
  end subroutine begin_again

  !> Saves or loads the state.
  subroutine visit_indentation(self, archive)
    class(indentation_t), intent(inout) :: self
    !> Where the state is saved to or loaded from
    class(archive_t), intent(inout) :: archive

    call archive%item('indentation/alpha', self%alpha)
    call archive%item('indentation/alpha_max', self%alpha_max)
    call archive%item('indentation/force_max', self%force_max)
    call archive%item('indentation/dent', self%dent)
    call archive%item('indentation/separated', self%separated)
    call archive%item('indentation/work', self%work)
  end subroutine visit_indentation

  !> Unloading or reloading curve, whichever applies; empty for Hertz and before the first contact.
  pure function current_branch(law, state) result(branch)
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    type(branch_t) :: branch

    if (law%law == law_hertz) return
    branch%start = state%dent
    branch%finish = state%alpha_max
    branch%force = state%force_max
    if (law%law /= law_thornton) branch%exponent = merge(law%reload, law%q, state%separated)
  end function current_branch

  !> Position on a curve, 0 at its start and 1 at its end.
  pure real(wp) function position(branch, alpha) result(s)
    !> The curve
    type(branch_t), intent(in) :: branch
    !> Indentation on it
    real(wp), intent(in) :: alpha

    s = (alpha - branch%start)/(branch%finish - branch%start)
  end function position

  !> Permanent dent after unloading from an indentation, theory (F6) and (F7) (Tan and Sun 1985; Yang and Sun 1982;
  !> Thornton 1997, with the larger radius of the deformed face in unloading).
  pure real(wp) function permanent_dent(law, alpha_max) result(dent)
    type(indentation_law_t), intent(in) :: law
    !> Largest indentation
    real(wp), intent(in) :: alpha_max

    dent = 0
    if (law%law == law_hertz .or. alpha_max <= law%alpha_critical) return
    if (law%law == law_thornton) then
      dent = alpha_max*(1 - loading_force(law, alpha_max)/hertz_force(law%k, alpha_max))
    else if (law%dent == dent_yang_sun) then
      dent = alpha_max*(1 - (law%alpha_critical/alpha_max)**0.4_wp)
    else
      dent = law%beta*(alpha_max - law%alpha_critical)
    end if
  end function permanent_dent
end module tan_sun_indentation
