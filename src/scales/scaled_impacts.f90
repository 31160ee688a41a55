!> Permitted scaling of inertia (doc/theory/time_integration.md, explicit steps), by the effect of scaled rotary inertia
!> on a preliminary elastic impact.
module scaled_impacts
  use elastic_impacts, only: difference, elastic_impact_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use setup_elastic_impacts, only: contact_end, run_of, setup_elastic_impact_t, start_elastic_impact, &
                                   with_scaled_inertia
  use setup_scales, only: setup_scales_t
  use setups, only: setup_t
  implicit none
  private
  public :: scaled_impact_t, largest_scaling

  !> A factor of rotary inertia and its effects.
  type :: scaled_impact_t
    !> The factor
    real(wp) :: scaling = 1
    !> Fraction by which it slows the bending waves of first contact
    real(wp) :: slowed = 0
    !> Change of the force history, relative L2 norm
    real(wp) :: change = 0
  end type scaled_impact_t

  !> Steps of the elastic impacts in the rise time of first contact, and largest number of steps: those of
  !> `deck_scales`, and a quarter of the largest number in other elastic impacts. Half and twice these steps change the
  !> factors of twenty random setups by less than 2 %.
  real(wp), parameter :: fine_steps = 64
  integer, parameter :: max_steps = 65536
  !> Largest number of trials; two suffice where the change is proportional to the scaled inertia.
  integer, parameter :: max_trials = 8
  !> Fraction of the bound at which a reduced factor aims, as changes decrease less than in proportion to the factor. It
  !> changes the factor by 5 % and the step by 2.5 %.
  real(wp), parameter :: safety_factor = 0.95_wp

contains

  !> Largest factor up to a limit that slows the waves of first contact and changes the force history by no more than a
  !> given fraction. With s times the rotary inertia a wave of number k in a plate of thickness h is slower by (s - 1)
  !> (k h)**2/24: the added inertia rho h**3/12 (s - 1) k**2 relative to rho h, halved by the root. The change of the
  !> history depends on the time in which waves affect the force, and on their return from the edges: it is found by
  !> elastic impacts with and without the scaled inertia.
  pure function largest_scaling(setup, scales, limit, bound) result(found)
    !> The setup, with an impactor that has a velocity
    type(setup_t), intent(in) :: setup
    type(setup_scales_t), intent(in) :: scales
    !> Largest factor
    real(wp), intent(in) :: limit
    !> Largest fraction permitted for both
    real(wp), intent(in) :: bound
    type(scaled_impact_t) :: found
    type(setup_elastic_impact_t) :: elastic
    type(elastic_impact_t) :: exact
    real(wp) :: slowed, step, end, changes(2)
    integer :: trial

    slowed = (2*pi*scales%thickness/scales%wave_length)**2/24
    elastic = start_elastic_impact(setup, scales)
    exact = contact_end(elastic, 0.0_wp)
    end = exact%last_contact
    step = max(scales%contact_time/fine_steps, end/max_steps)
    exact = run_of(elastic, step, end, 0.0_wp)
    found%scaling = min(limit, 1 + bound/slowed)
    do trial = 1, max_trials
      ! Of the peak, and of the history
      changes = difference(with_scaled_inertia(elastic, found%scaling, step, end), exact, 1)
      found%change = changes(2)
      if (found%change <= bound) exit
      found%scaling = 1 + (found%scaling - 1)*safety_factor*bound/found%change
    end do
    if (found%change > bound) found = scaled_impact_t()
    found%slowed = (found%scaling - 1)*slowed
  end function largest_scaling
end module scaled_impacts
