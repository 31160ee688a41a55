!> Bending stress at the struck point, for the paper's control of the time step by its rate (section 3.4).
module struck_stresses
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use element_batches, only: lanes, batch_of, lane_of
  use strain_recovery, only: mean_strains
  use composite_plates, only: composite_plate_t
  use rank_totals, only: totals_of
  implicit none
  private
  public :: struck_stress

contains

  !> Magnitude of the surface stress 6 M / h**2 around the struck point, the same on every rank.
  real(wp) function struck_stress(plate, motion) result(stress)
    type(composite_plate_t), intent(in) :: plate
    !> Motion of the layers, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: motion(:, :)
    real(wp) :: curvature(3), moment(3), strains(lanes, 8)
    type(exact_sum_t) :: sums(3)
    integer :: i, k

    do i = 1, size(plate%struck%elements)
      associate (element => plate%struck%elements(i))
        call mean_strains(plate%elements, batch_of(element), plate%setup%mesh%kinematics, motion, strains)
        do k = 1, 3
          call sums(k)%add(strains(lane_of(element), 3 + k))
        end do
      end associate
    end do
    curvature = totals_of(plate%communicator, sums)/plate%struck%count
    ! The twist of a plate with mirror symmetry vanishes at the struck point, but not in the mean over the elements of
    ! the modelled part.
    if (any(plate%mesh%mirrored)) curvature(3) = 0
    associate (d => plate%layup%bending_section%stiffness(13:18))
      moment = [d(1)*curvature(1) + d(2)*curvature(2) + d(3)*curvature(3), &
                d(2)*curvature(1) + d(4)*curvature(2) + d(5)*curvature(3), &
                d(3)*curvature(1) + d(5)*curvature(2) + d(6)*curvature(3)]
    end associate
    stress = 6*norm2(moment)/plate%layup%struck_thickness**2
  end function struck_stress
end module struck_stresses
