!> Checks of a new integrator: free flight, its order within a contact, and for the plate the algorithmic dissipation by
!> the ledger's formula.
program measure_integrators
  use bdf2_impactors, only: bdf2_impactor_t, new_bdf2_impactor, bdf2_predict, bdf2_advance
  use errors, only: error_t
  use example_checks, only: require
  use hht_integrators, only: hht_integrator
  use impact_force, only: contact_step_t, solve_impact_force
  use impact_parameters, only: impactor_parameters_t, indentation_law_t, law_hertz
  use kinds, only: wp
  use motions, only: motion_t
  use newmark_integrators, only: plate_integrator_t
  use tan_sun_indentation, only: indentation_t
  implicit none
  type(impactor_parameters_t) :: ball
  type(bdf2_impactor_t) :: impactor
  real(wp) :: time, speeds(3), ends(2), gain
  integer :: i

  ball%mass = 8.537e-3_wp
  ball%velocity = 1
  ball%gravity = 9.81_wp
  impactor = new_bdf2_impactor(ball)
  time = 0
  do i = 1, 20
    impactor = bdf2_advance(ball, impactor, 1e-3_wp*(1 + 0.2_wp*sin(2.0_wp*i)), 0.0_wp)
    time = time + impactor%last_step
  end do
  call require('velocity of a free flight', impactor%velocity, 1 + 9.81_wp*time, 1e-13_wp)
  call require('its displacement', impactor%displacement, time + 0.5_wp*9.81_wp*time**2, 1e-14_wp)

  ball%gravity = 0
  speeds = [(velocity_in_contact(40*2**i), i=0, 2)]
  call require('order within a contact', log((speeds(1) - speeds(2))/(speeds(2) - speeds(3)))/log(2.0_wp), 2.0_wp, &
               0.1_wp)
  call swing(hht_integrator(0.1_wp), 200, ends(1), gain)
  call swing(hht_integrator(0.1_wp), 400, ends(2), gain)
  call require('order of the plate''s', log(abs((ends(1) - cos(1.0_wp))/(ends(2) - cos(1.0_wp))))/log(2.0_wp), 2.0_wp, &
               0.1_wp)
  call require('spectral radius at the highest frequencies', left_at_high_frequency(hht_integrator(0.1_wp)), &
               0.9_wp/1.1_wp, 1e-3_wp)

contains

  !> Velocity of the ball at the middle of a contact with a rigid base.
  real(wp) function velocity_in_contact(steps) result(velocity)
    !> Number of steps until then
    integer, intent(in) :: steps
    type(indentation_law_t) :: law
    type(indentation_t) :: contact
    type(error_t), allocatable :: error
    real(wp) :: dt, free, compliance, force, alpha, force_end
    integer :: step, iterations

    law%law = law_hertz
    law%k = 8e8_wp
    impactor = new_bdf2_impactor(ball)
    dt = 60e-6_wp/steps
    do step = 1, steps
      call bdf2_predict(ball, impactor, dt, free, compliance)
      call solve_impact_force(contact_step_t(law, contact, contact%alpha, free, compliance, .false.), force, alpha, &
                              force_end, iterations, error)
      impactor = bdf2_advance(ball, impactor, dt, force)
      contact%alpha = impactor%displacement
    end do
    velocity = impactor%velocity
  end function velocity_in_contact

  !> Integrates an oscillator of unit mass and stiffness for a unit of time, and compares its gain of energy with the
  !> formula of the ledger in every step.
  subroutine swing(integrator, steps, displacement, gain)
    !> The integrator
    type(plate_integrator_t), intent(in) :: integrator
    !> Steps
    integer, intent(in) :: steps
    !> Displacement at the end
    real(wp), intent(out) :: displacement
    !> Energy gained by then
    real(wp), intent(out) :: gain
    type(motion_t) :: old, new
    real(wp) :: h, worst, formula
    integer :: step

    allocate (old%displacement(5, 1), old%velocity(5, 1), old%acceleration(5, 1), source=0.0_wp)
    old%displacement(3, 1) = 1
    old%acceleration = -old%displacement
    new = old
    h = 1.0_wp/steps
    gain = 0
    worst = 0
    do step = 1, steps
      call solve(integrator, h, old, new)
      associate (u => old%displacement(3, 1), a => old%acceleration(3, 1), du => new%displacement(3, 1) &
                 - old%displacement(3, 1), da => new%acceleration(3, 1) - old%acceleration(3, 1))
        formula = -(0.5_wp - integrator%alpha_f)*du**2 + (integrator%gamma - 1 + integrator%alpha_m)*da*du &
                  - h**2*(integrator%beta - integrator%gamma/2)*(((a + da)**2 - a**2)/2 &
                                                                 + (integrator%gamma - 0.5_wp)*da**2)
        worst = max(worst, abs(formula - (energy(new) - energy(old))))
      end associate
      gain = gain + energy(new) - energy(old)
      old = new
    end do
    call require('the ledger''s formula in a step', worst, 0.0_wp, 1e-12_wp)
    displacement = new%displacement(3, 1)
  end subroutine swing

  !> Amplitude ratio per step of an oscillation far faster than the step, over a thousand steps.
  real(wp) function left_at_high_frequency(integrator) result(left)
    !> The integrator
    type(plate_integrator_t), intent(in) :: integrator
    type(motion_t) :: old, new
    integer :: step

    allocate (old%displacement(5, 1), old%velocity(5, 1), old%acceleration(5, 1), source=0.0_wp)
    old%displacement(3, 1) = 1
    old%acceleration = -old%displacement
    new = old
    do step = 1, 1000
      call solve(integrator, 1e6_wp, old, new)
      left = abs(new%displacement(3, 1)/old%displacement(3, 1))
      old = new
    end do
  end function left_at_high_frequency

  !> One step of the oscillator: the displacement that satisfies the weighted equation of motion.
  subroutine solve(integrator, h, old, new)
    !> The integrator
    type(plate_integrator_t), intent(in) :: integrator
    !> Time step
    real(wp), intent(in) :: h
    !> Motion at the start
    type(motion_t), intent(in) :: old
    !> Motion at the end
    type(motion_t), intent(inout) :: new
    real(wp) :: residual
    integer :: iteration

    new%displacement = old%displacement
    do iteration = 1, 2
      call integrator%complete(h, old, new%displacement, new%velocity, new%acceleration)
      residual = -(1 - integrator%alpha_m)*new%acceleration(3, 1) - integrator%alpha_m*old%acceleration(3, 1) &
                 - (1 - integrator%alpha_f)*new%displacement(3, 1) - integrator%alpha_f*old%displacement(3, 1)
      new%displacement(3, 1) = new%displacement(3, 1) &
                               + residual/(integrator%stiffness_factor() + integrator%mass_factor(h))
    end do
    call integrator%complete(h, old, new%displacement, new%velocity, new%acceleration)
  end subroutine solve

  !> Energy of the oscillator.
  pure real(wp) function energy(motion)
    !> Its motion
    type(motion_t), intent(in) :: motion

    energy = (motion%velocity(3, 1)**2 + motion%displacement(3, 1)**2)/2
  end function energy
end program measure_integrators
