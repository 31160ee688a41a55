!> A ball on a rigid base with the elastic-plastic law: the curve, its work, and a complete contact whose loss of
!> kinetic energy is the area between loading and unloading curve.
program strike_rigid_base
  use example_checks, only: require
  use impact_parameters, only: impactor_parameters_t, integrator_conserving
  use impactor_integrators, only: predict, advance
  use impactors, only: impactor_t, new_impactor, impactor_energy
  use kinds, only: wp
  use yigit_christoforou, only: plastic_law_t, plastic_contact_t, zero_force_indentation, contact_force, &
                                contact_stiffness, mean_force, commit
  implicit none
  type(plastic_law_t), parameter :: law = plastic_law_t(k=8e8_wp, yield=20e-6_wp)
  type(plastic_contact_t) :: contact
  type(impactor_parameters_t) :: ball
  type(impactor_t) :: impactor
  real(wp) :: lost, before

  call commit(law, contact, 60e-6_wp)
  call require('dent is where the force is zero', contact_force(law, contact, zero_force_indentation(law, contact)), &
               0.0_wp, &
               1e-10_wp)
  call require('unloading starts at the end of loading', contact_force(law, contact, 60e-6_wp*(1 - 1e-12_wp)), &
               contact_force(law, contact, 60e-6_wp), 1e-8_wp)
  call require('stiffness against a difference of forces', contact_stiffness(law, contact, 45e-6_wp), &
               (contact_force(law, contact, 45.01e-6_wp) - contact_force(law, contact, 44.99e-6_wp))/0.02e-6_wp, 1e2_wp)
  call require('mean force against Simpson''s rule', mean_force(law, contact, 30e-6_wp, 75e-6_wp), &
               (simpson(30e-6_wp, 60e-6_wp) + simpson(60e-6_wp, 75e-6_wp))/45e-6_wp, 1e-6_wp)
  call commit(law, contact, 0.0_wp)
  call require('energy lost in a closed path', contact%work, closed_path(60e-6_wp), 1e-15_wp)

  contact = plastic_contact_t()
  ball%mass = 8.537e-3_wp
  ball%velocity = 1
  ball%integrator = integrator_conserving
  impactor = new_impactor(ball)
  before = impactor_energy(ball, impactor)
  do while (impactor%velocity > 0 .or. impactor%displacement > zero_force_indentation(law, contact))
    call step(5e-6_wp)
  end do
  lost = before - impactor_energy(ball, impactor)
  call require('kinetic energy lost is the work dissipated by the contact', lost, contact%work, 1e-15_wp)
  call require('and the area between the curves', lost, closed_path(contact%alpha_max), 1e-15_wp)
  print '(a,f6.1,a,f7.4)', 'largest indentation', 1e6_wp*contact%alpha_max, ' um, rebound over impact speed', &
    -impactor%velocity/ball%velocity

contains

  !> One step of ball and contact by bisection: the mean force that gives the indentation to which it leads.
  subroutine step(dt)
    !> Time step
    real(wp), intent(in) :: dt
    real(wp) :: free, compliance, lower, upper, alpha, force
    integer :: i

    call predict(ball, impactor, dt, free, compliance)
    lower = -abs(free) - 1
    upper = free
    do i = 1, 200
      alpha = (lower + upper)/2
      force = mean_force(law, contact, contact%alpha, alpha)
      if (alpha + compliance*force < free) then
        lower = alpha
      else
        upper = alpha
      end if
    end do
    impactor = advance(ball, impactor, dt, force, contact_force(law, contact, alpha))
    call commit(law, contact, impactor%displacement)
  end subroutine step

  !> Integral of the force by Simpson's rule.
  real(wp) function simpson(from, to)
    !> Ends
    real(wp), intent(in) :: from, to
    integer, parameter :: parts = 2000
    integer :: i

    simpson = contact_force(law, contact, from) + contact_force(law, contact, to)
    do i = 1, parts - 1
      simpson = simpson + merge(4, 2, mod(i, 2) == 1)*contact_force(law, contact, from + (to - from)*i/parts)
    end do
    simpson = simpson*(to - from)/(3*parts)
  end function simpson

  !> Energy dissipated by loading and full unloading in closed form: work of loading less work of unloading.
  pure real(wp) function closed_path(max_indentation) result(lost)
    !> Largest indentation
    real(wp), intent(in) :: max_indentation
    real(wp) :: way_in, dent, force, plastic

    plastic = max_indentation - law%yield
    way_in = law%k*(0.4_wp*law%yield**2.5_wp + law%yield**1.5_wp*plastic + 0.75_wp*sqrt(law%yield)*plastic**2)
    force = law%k*(law%yield**1.5_wp + 1.5_wp*sqrt(law%yield)*plastic)
    dent = (max_indentation**1.5_wp - force/law%k)**(2/3.0_wp)
    lost = way_in - (force - law%k*max_indentation**1.5_wp)*(max_indentation - dent) - &
           0.4_wp*law%k*(max_indentation**2.5_wp - dent**2.5_wp)
  end function closed_path
end program strike_rigid_base
