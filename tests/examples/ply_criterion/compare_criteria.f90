!> Maximum stress criteria: 1 at each strength, and compared with the program's criteria under transverse tension with
!> shear.
program compare_criteria
  use example_checks, only: require
  use failure_criteria, only: chosen_indices
  use kinds, only: wp
  use largest_stress_criteria, only: largest_stress_indices
  use material_parameters, only: material_t
  use ply_damage_parameters, only: criteria_hou, criteria_hashin, criteria_puck, failure_modes, fibre_failure, &
                                   matrix_cracking, matrix_crushing
  implicit none
  type(material_t) :: ply
  real(wp) :: shear(4), stress(5, 1)
  integer :: i, set

  ! T300/976 as in input/peanut.nml, but with another strength of the 2-3 plane.
  ply%xt = 2070e6_wp
  ply%xc = 1590e6_wp
  ply%yt = 46e6_wp
  ply%yc = 253e6_wp
  ply%s12 = 105e6_wp
  ply%sf = 500e6_wp
  ply%sm23 = 65e6_wp
  call require('fibres pulled', index_of(fibre_failure, 1, ply%xt), 1.0_wp, 1e-14_wp)
  call require('fibres pressed', index_of(fibre_failure, 1, -ply%xc), 1.0_wp, 1e-14_wp)
  call require('matrix pulled', index_of(matrix_cracking, 2, ply%yt), 1.0_wp, 1e-14_wp)
  call require('matrix pressed', index_of(matrix_crushing, 2, -ply%yc), 1.0_wp, 1e-14_wp)
  call require('in-plane shear', index_of(matrix_cracking, 3, ply%s12), 1.0_wp, 1e-14_wp)
  call require('sheared across', index_of(matrix_cracking, 5, ply%sm23), 1.0_wp, 1e-14_wp)
  print '(/a)', 's12 at failure over S12, transverse tension s22/YT:   largest      Hou   Hashin     Puck'
  do i = 0, 4
    do set = 0, 3
      shear(set + 1) = shear_at_failure(set, 0.2_wp*i*ply%yt)
    end do
    print '(49x,f5.1,f16.3,3f9.3)', 0.2_wp*i, shear
  end do
  ! The values of the criteria at s22 = 0.8 YT, solved by hand for s12.
  call require('largest stress at 0.8', shear(1), 1.0_wp, 1e-12_wp)
  call require('Hou at 0.8', shear(2), 0.6_wp, 1e-12_wp)
  call require('Hashin at 0.8', shear(3), 0.6_wp, 1e-12_wp)

contains

  !> Index of one mode of the new set under one stress.
  real(wp) function index_of(mode, component, value)
    !> Mode
    integer, intent(in) :: mode
    !> Which of s11, s22, s12, s13, s23
    integer, intent(in) :: component
    !> The stress
    real(wp), intent(in) :: value
    real(wp) :: indices(failure_modes)

    stress = 0
    stress(component, 1) = value
    indices = largest_stress_indices(ply, stress(:, 1))
    index_of = indices(mode)
  end function index_of

  !> Shear stress over S12 at which the matrix fails, by bisection.
  real(wp) function shear_at_failure(criteria, across) result(factor)
    !> 0: the new set; else the set of that number
    integer, intent(in) :: criteria
    !> Transverse stress
    real(wp), intent(in) :: across
    real(wp) :: lower, upper, indices(failure_modes)
    integer :: step

    lower = 0
    upper = 3
    do step = 1, 60
      factor = (lower + upper)/2
      stress(:, 1) = [0.0_wp, across, factor*ply%s12, 0.0_wp, 0.0_wp]
      select case (criteria)
      case (criteria_hou, criteria_hashin, criteria_puck)
        indices = chosen_indices(criteria, ply, stress)
      case default
        indices = largest_stress_indices(ply, stress(:, 1))
      end select
      if (maxval(indices(2:3)) < 1) then
        lower = factor
      else
        upper = factor
      end if
    end do
  end function shear_at_failure
end program compare_criteria
