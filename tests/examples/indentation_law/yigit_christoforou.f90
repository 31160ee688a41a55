!> Elastic-plastic indentation after A. S. Yigit and A. P. Christoforou, Composites Engineering 4 (1994) 1143-1152:
!> Hertz up to a yield indentation, linear from there on with the same slope, and Hertz's curve shifted for unloading.
!> Reloading follows the unloading curve up to the largest indentation.
module yigit_christoforou
  use archives, only: archive_t
  use kinds, only: wp
  implicit none
  private
  public :: plastic_law_t, plastic_contact_t, zero_force_indentation, contact_force, contact_stiffness, mean_force, &
    commit

  !> Constants of the law.
  type :: plastic_law_t
    !> Contact stiffness, F = k alpha**1.5 up to the yield indentation
    real(wp) :: k = 0
    !> Indentation at which the matrix yields
    real(wp) :: yield = 0
  end type plastic_law_t

  !> History variables of the contact; changed only when a step is accepted.
  type :: plastic_contact_t
    !> Indentation of the last accepted step, and the largest so far
    real(wp) :: alpha = 0, alpha_max = 0
    !> Work done on the indentation so far, stored and dissipated
    real(wp) :: work = 0
  contains
    !> Saves or loads the state
    procedure :: visit
  end type plastic_contact_t

contains

  !> Indentation below which the force is zero: the dent.
  pure real(wp) function zero_force_indentation(law, state) result(touch)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> Committed state
    type(plastic_contact_t), intent(in) :: state

    touch = max(0.0_wp, state%alpha_max**1.5_wp - loading_force(law, state%alpha_max)/law%k)**(2/3.0_wp)
  end function zero_force_indentation

  !> Force at an indentation reached monotonically from the committed one.
  pure real(wp) function contact_force(law, state, alpha) result(force)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> Committed state
    type(plastic_contact_t), intent(in) :: state
    !> The indentation
    real(wp), intent(in) :: alpha

    if (alpha >= state%alpha_max) then
      force = loading_force(law, alpha)
    else
      force = max(0.0_wp, loading_force(law, state%alpha_max) &
                          - law%k*(state%alpha_max**1.5_wp - max(alpha, 0.0_wp)**1.5_wp))
    end if
  end function contact_force

  !> Derivative of the force; at the largest indentation that of unloading.
  pure real(wp) function contact_stiffness(law, state, alpha) result(stiffness)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> Committed state
    type(plastic_contact_t), intent(in) :: state
    !> The indentation
    real(wp), intent(in) :: alpha

    stiffness = 0
    if (alpha <= zero_force_indentation(law, state)) return
    stiffness = 1.5_wp*law%k*sqrt(alpha)
    if (alpha > state%alpha_max) stiffness = min(stiffness, 1.5_wp*law%k*sqrt(law%yield))
  end function contact_stiffness

  !> Mean force over a monotonic path: work over its length, for the integrator that conserves energy.
  pure real(wp) function mean_force(law, state, alpha_from, alpha_to) result(mean)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> Committed state
    type(plastic_contact_t), intent(in) :: state
    !> Indentations at both ends
    real(wp), intent(in) :: alpha_from, alpha_to
    !> Fraction of the indentation below which a path is short enough for the force at its middle
    real(wp), parameter :: short_way = 1e-6_wp

    if (abs(alpha_to - alpha_from) <= short_way*max(abs(alpha_to), abs(alpha_from))) then
      mean = contact_force(law, state, (alpha_from + alpha_to)/2)
    else
      mean = (work_to(law, state, alpha_to) - work_to(law, state, alpha_from))/(alpha_to - alpha_from)
    end if
  end function mean_force

  !> Accepts a new indentation.
  pure subroutine commit(law, state, alpha)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> State to be updated
    type(plastic_contact_t), intent(inout) :: state
    !> New indentation
    real(wp), intent(in) :: alpha

    state%work = state%work + work_to(law, state, alpha) - work_to(law, state, state%alpha)
    state%alpha_max = max(state%alpha_max, alpha)
    state%alpha = alpha
  end subroutine commit

  !> Saves or loads the state.
  subroutine visit(self, archive)
    !> The state
    class(plastic_contact_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call archive%item('indentation/alpha', self%alpha)
    call archive%item('indentation/alpha_max', self%alpha_max)
    call archive%item('indentation/work', self%work)
  end subroutine visit

  !> Force of first loading.
  pure real(wp) function loading_force(law, alpha) result(force)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> The indentation
    real(wp), intent(in) :: alpha

    force = law%k*min(max(alpha, 0.0_wp), law%yield)**1.5_wp &
            + 1.5_wp*law%k*sqrt(law%yield)*max(0.0_wp, alpha - law%yield)
  end function loading_force

  !> Work of the force beyond the dent, in closed form.
  pure real(wp) function work_to(law, state, alpha) result(work)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> Committed state
    type(plastic_contact_t), intent(in) :: state
    !> The indentation
    real(wp), intent(in) :: alpha
    real(wp) :: touch, back

    touch = zero_force_indentation(law, state)
    back = max(touch, min(alpha, state%alpha_max))
    work = (loading_force(law, state%alpha_max) - law%k*state%alpha_max**1.5_wp)*(back - touch) &
           + 0.4_wp*law%k*(back**2.5_wp - touch**2.5_wp)
    if (alpha > state%alpha_max) work = work + loading_work(law, alpha) - loading_work(law, state%alpha_max)
  end function work_to

  !> Work of first loading.
  pure real(wp) function loading_work(law, alpha) result(work)
    !> The law
    type(plastic_law_t), intent(in) :: law
    !> The indentation, not negative
    real(wp), intent(in) :: alpha
    real(wp) :: beyond

    beyond = max(0.0_wp, alpha - law%yield)
    work = 0.4_wp*law%k*min(alpha, law%yield)**2.5_wp + law%k*law%yield**1.5_wp*beyond &
           + 0.75_wp*law%k*sqrt(law%yield)*beyond**2
  end function loading_work
end module yigit_christoforou
