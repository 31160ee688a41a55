!> Hashin's criteria: 1 at each strength, and beside Hou's under compression across the fibres with shear.
program compare_criteria
  use example_checks, only: require
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: criteria_hou, fibre_failure, matrix_cracking, matrix_crushing
  use failure_criteria, only: chosen_indices, criteria_hashin
  implicit none
  type(material_t) :: ply
  real(wp) :: unit(5), shear(2)
  integer :: i

  ! T300/976 as in input/peanut.nml, but with another strength of the 2-3 plane.
  ply%xt = 2070e6_wp
  ply%xc = 1590e6_wp
  ply%yt = 46e6_wp
  ply%yc = 253e6_wp
  ply%s12 = 105e6_wp
  ply%sf = 500e6_wp
  ply%sm23 = 65e6_wp
  call require('fibres pulled', index_of(criteria_hashin, fibre_failure, 1, ply%xt), 1.0_wp, 1e-14_wp)
  call require('fibres pressed', index_of(criteria_hashin, fibre_failure, 1, -ply%xc), 1.0_wp, 1e-14_wp)
  call require('matrix pulled', index_of(criteria_hashin, matrix_cracking, 2, ply%yt), 1.0_wp, 1e-14_wp)
  call require('matrix pressed', index_of(criteria_hashin, matrix_crushing, 2, -ply%yc), 1.0_wp, 1e-14_wp)
  call require('sheared in its plane', index_of(criteria_hashin, matrix_cracking, 3, ply%s12), 1.0_wp, 1e-14_wp)
  call require('sheared across', index_of(criteria_hashin, matrix_cracking, 5, ply%sm23), 1.0_wp, 1e-14_wp)
  print '(/a)', 's12 at failure over S12, pressed across the fibres by s22/YC:   Hou   Hashin'
  do i = 1, 5
    unit = [0.0_wp, -0.2_wp*(i - 1)*ply%yc, ply%s12, 0.0_wp, 0.0_wp]
    shear = [shear_at_failure(criteria_hou, unit), shear_at_failure(criteria_hashin, unit)]
    print '(50x,f5.1,f10.3,f9.3)', 0.2_wp*(i - 1), shear
  end do
  ! What both say of p = 0.8 YC, solved by hand for s12.
  call require('Hou at 0.8', shear(1), sqrt(0.2_wp + 0.25_wp*0.8_wp*0.2_wp*(253/105.0_wp)**2), 1e-12_wp)
  call require('Hashin at 0.8', shear(2), sqrt(0.2_wp*(1 + 0.8_wp*(253/130.0_wp)**2)), 1e-12_wp)

contains

  !> Index of one mode under one stress.
  real(wp) function index_of(criteria, mode, component, value)
    !> Set of criteria, and mode
    integer, intent(in) :: criteria, mode
    !> Which of s11, s22, s12, s13, s23
    integer, intent(in) :: component
    !> The stress
    real(wp), intent(in) :: value
    real(wp) :: stress(5), indices(3)

    stress = 0
    stress(component) = value
    indices = chosen_indices(criteria, ply, reshape(stress, [5, 1]))
    index_of = indices(mode)
  end function index_of

  !> Factor of the shear stress at which crushing reaches 1, by halving.
  real(wp) function shear_at_failure(criteria, stress) result(factor)
    !> Set of criteria
    integer, intent(in) :: criteria
    !> Stress with the shear of factor 1
    real(wp), intent(in) :: stress(5)
    real(wp) :: lower, upper, trial(5), indices(3)
    integer :: step

    lower = 0
    upper = 3
    do step = 1, 60
      factor = (lower + upper)/2
      trial = stress
      trial(3) = factor*stress(3)
      indices = chosen_indices(criteria, ply, reshape(trial, [5, 1]))
      if (maxval(indices(2:3)) < 1) then
        lower = factor
      else
        upper = factor
      end if
    end do
  end function shear_at_failure
end program compare_criteria
