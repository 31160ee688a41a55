!> Section forces and moments of stress-free strains, which are thermal strains from the curing temperature and
!> permanent shear strains: sums of stiffness times stress-free strain, theory (M21).
module free_strains
  use kinds, only: wp
  use plies, only: ply_t, elasticity_t, reduced_stiffness
  implicit none
  private
  public :: free_resultants

contains

  !> Forces and moments of the stress-free strains, and the energy of suppressing these strains.
  pure function free_resultants(plies, elasticity) result(resultants)
    !> Neighbouring plies: all of the laminate or those of one layer
    type(ply_t), intent(in) :: plies(:)
    !> Present elastic constants of these plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Nxx, Nyy, Nxy, Mxx, Myy, Mxy of classical laminate theory, and energy per area
    real(wp) :: resultants(7)
    real(wp) :: q(4), stress(3), force(3), thickness
    integer :: i

    resultants = 0
    do i = 1, size(plies)
      q = reduced_stiffness(elasticity(i))
      thickness = plies(i)%z_bottom - plies(i)%z_top
      associate (c => plies(i)%cosine, s => plies(i)%sine, free => plies(i)%free_strain)
        stress = [q(1)*free(1) + q(2)*free(2), q(2)*free(1) + q(3)*free(2), q(4)*free(3)]
        force = thickness*[c*c*stress(1) + s*s*stress(2), s*s*stress(1) + c*c*stress(2), c*s*(stress(1) - stress(2))]
        force = force + thickness*stress(3)*[-2*c*s, 2*c*s, c*c - s*s]
        resultants(7) = resultants(7) + thickness*dot_product(stress, free)/2
      end associate
      resultants(1:3) = resultants(1:3) + force
      resultants(4:6) = resultants(4:6) + force*(plies(i)%z_top + plies(i)%z_bottom)/2
    end do
  end function free_resultants
end module free_strains
