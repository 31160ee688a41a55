!> The failure criteria that the deck chooses, and the strengths that they need.
module failure_criteria
  use kinds, only: wp
  use hashin_criteria, only: hashin_indices
  use hou_criteria, only: failure_indices
  use material_parameters, only: material_t
  use matrix_exposures, only: matrix_strengths, puck_exposure
  use ply_damage_parameters, only: failure_modes, criteria_hashin, criteria_puck, fibre_failure, matrix_cracking, &
                                   matrix_crushing
  implicit none
  private
  public :: chosen_indices, needed_strengths

contains

  !> Largest value of each criterion over several points of a ply, such as its two faces; a ply fails where it
  !> reaches 1.
  pure function chosen_indices(criteria, material, stresses) result(indices)
    !> criteria_hou, criteria_hashin or criteria_puck
    integer, intent(in) :: criteria
    !> Material of the ply
    type(material_t), intent(in) :: material
    !> Stresses s11, s22, s12, s13, s23 of the points, shape (5, points)
    real(wp), intent(in) :: stresses(:, :)
    !> Values in the order of the modes
    real(wp) :: indices(failure_modes)
    integer :: point

    indices = -huge(1.0_wp)
    do point = 1, size(stresses, 2)
      select case (criteria)
      case (criteria_hashin)
        indices = max(indices, hashin_indices(material, stresses(:, point)))
      case (criteria_puck)
        indices = max(indices, puck_indices(material, stresses(:, point)))
      case default
        indices = max(indices, failure_indices(material, stresses(:, point)))
      end select
    end do
  end function chosen_indices

  !> Squares of Puck's exposures: of the fibres by the stress along them, of the matrix by the in-plane stresses.
  pure function puck_indices(material, stress) result(indices)
    !> Material of the ply
    type(material_t), intent(in) :: material
    !> s11, s22, s12, s13, s23
    real(wp), intent(in) :: stress(5)
    !> Values in the order of the modes
    real(wp) :: indices(failure_modes)

    indices = 0
    indices(fibre_failure) = (stress(1)/merge(material%xc, material%xt, stress(1) < 0 .and. material%xc > 0))**2
    indices(merge(matrix_cracking, matrix_crushing, stress(2) >= 0)) = &
      puck_exposure(matrix_strengths(material, criteria_puck), stress(2), stress(3))**2
  end function puck_indices

  !> Names of the strengths that the criteria require and a material lacks, separated by commas; empty: none.
  pure function needed_strengths(criteria, bands, material) result(names)
    !> criteria_hou, criteria_hashin or criteria_puck
    integer, intent(in) :: criteria
    !> True: plies soften by their fracture energies, with criteria of the in-plane stresses
    logical, intent(in) :: bands
    !> The material
    type(material_t), intent(in) :: material
    !> For example `XT, Sf`
    character(len=:), allocatable :: names
    character(len=4), parameter :: labels(6) = [character(len=4) :: 'XT', 'YT', 'YC', 'S12', 'Sf', 'Sm23']
    real(wp) :: strengths(6)
    integer :: i, needed

    strengths = [material%xt, material%yt, material%yc, material%s12, material%sf, material%sm23]
    needed = 6
    if (criteria == criteria_hashin) strengths(5) = 1
    if (criteria == criteria_puck .or. bands) needed = 4
    names = ''
    do i = 1, needed
      if (strengths(i) > 0) cycle
      if (len(names) > 0) names = names//', '
      names = names//trim(labels(i))
    end do
  end function needed_strengths
end module failure_criteria
