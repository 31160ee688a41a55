!> The failure criteria that the deck chooses, and the strengths that they need.
module failure_criteria
  use kinds, only: wp
  use hashin_criteria, only: hashin_indices
  use hou_criteria, only: failure_indices
  use material_parameters, only: material_t
  use larc_criteria, only: kinking_exposure, larc_of
  use matrix_exposures, only: matrix_strengths, matrix_exposure
  use ply_damage_parameters, only: failure_modes, criteria_hashin, criteria_puck, criteria_larc, fibre_failure, &
                                   matrix_cracking, matrix_crushing
  implicit none
  private
  public :: chosen_indices, needed_strengths

contains

  !> Largest value of each criterion over several points of a ply, such as its two faces; a ply fails where it
  !> reaches 1.
  pure function chosen_indices(criteria, material, stresses, kinking) result(indices)
    !> criteria_hou, criteria_hashin, criteria_puck or criteria_larc
    integer, intent(in) :: criteria
    type(material_t), intent(in) :: material
    !> Stresses s11, s22, s12, s13, s23 of the points, shape (5, points)
    real(wp), intent(in) :: stresses(:, :)
    !> True: compressed fibres fail by kinking; absent: at XC
    logical, intent(in), optional :: kinking
    !> Values in the order of the modes
    real(wp) :: indices(failure_modes)
    integer :: point

    indices = -huge(1.0_wp)
    do point = 1, size(stresses, 2)
      select case (criteria)
      case (criteria_hashin)
        indices = max(indices, hashin_indices(material, stresses(:, point)))
      case (criteria_puck, criteria_larc)
        indices = max(indices, squared_exposures(criteria, material, stresses(:, point)))
      case default
        indices = max(indices, failure_indices(material, stresses(:, point)))
      end select
    end do
    if (.not. present(kinking)) return
    if (.not. kinking) return
    indices(fibre_failure) = 0
    do point = 1, size(stresses, 2)
      associate (s => stresses(:, point))
        indices(fibre_failure) = max(indices(fibre_failure), (max(0.0_wp, s(1))/material%xt)**2, &
                                     kinking_exposure(larc_of(material), s(1), s(2), s(3))**2)
      end associate
    end do
  end function chosen_indices

  !> Squares of exposures: of the fibres by the stress along them, of the matrix by the in-plane stresses.
  pure function squared_exposures(criteria, material, stress) result(indices)
    !> criteria_puck or criteria_larc
    integer, intent(in) :: criteria
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: stress(5)
    !> Values in the order of the modes
    real(wp) :: indices(failure_modes)

    indices = 0
    indices(fibre_failure) = (stress(1)/merge(material%xc, material%xt, stress(1) < 0 .and. material%xc > 0))**2
    indices(merge(matrix_cracking, matrix_crushing, stress(2) >= 0)) = &
      matrix_exposure(matrix_strengths(material, criteria), stress(2), stress(3))**2
  end function squared_exposures

  !> Names of the strengths that the criteria require and a material lacks, separated by commas; empty: none.
  pure function needed_strengths(criteria, bands, material) result(names)
    !> criteria_hou, criteria_hashin, criteria_puck or criteria_larc
    integer, intent(in) :: criteria
    !> True: plies soften by their fracture energies, with criteria of the in-plane stresses
    logical, intent(in) :: bands
    type(material_t), intent(in) :: material
    !> For example `XT, Sf`
    character(len=:), allocatable :: names
    character(len=4), parameter :: labels(6) = [character(len=4) :: 'XT', 'YT', 'YC', 'S12', 'Sf', 'Sm23']
    real(wp) :: strengths(6)
    integer :: i, needed

    strengths = [material%xt, material%yt, material%yc, material%s12, material%sf, material%sm23]
    needed = 6
    if (criteria == criteria_hashin) strengths(5) = 1
    if (any(criteria == [criteria_puck, criteria_larc]) .or. bands) needed = 4
    names = ''
    do i = 1, needed
      if (strengths(i) > 0) cycle
      if (len(names) > 0) names = names//', '
      names = names//trim(labels(i))
    end do
  end function needed_strengths
end module failure_criteria
