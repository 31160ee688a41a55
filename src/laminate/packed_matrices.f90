!> Small symmetric matrices stored as their upper triangle: (11, 12, 16, 22, 26, 66) of in-plane components, (xz-xz,
!> xz-yz, yz-yz) of transverse shear.
module packed_matrices
  use kinds, only: wp
  implicit none
  private
  public :: unpacked, inverse, inverse_of_two

contains

  !> Full matrix of a packed in-plane one.
  pure function unpacked(packed) result(full)
    !> 11, 12, 16, 22, 26, 66
    real(wp), intent(in) :: packed(6)
    !> The same, rows and columns in Voigt order xx, yy, xy
    real(wp) :: full(3, 3)

    full = reshape([packed(1), packed(2), packed(3), &
                    packed(2), packed(4), packed(5), &
                    packed(3), packed(5), packed(6)], [3, 3])
  end function unpacked

  !> Inverse of a symmetric positive definite matrix of order three, by cofactors.
  pure function inverse(matrix) result(inverted)
    !> Symmetric positive definite matrix
    real(wp), intent(in) :: matrix(3, 3)
    real(wp) :: inverted(3, 3)
    real(wp) :: cofactors(6)

    associate (m => matrix)
      cofactors = [m(2, 2)*m(3, 3) - m(2, 3)**2, m(1, 3)*m(2, 3) - m(1, 2)*m(3, 3), &
                   m(1, 2)*m(2, 3) - m(1, 3)*m(2, 2), m(1, 1)*m(3, 3) - m(1, 3)**2, &
                   m(1, 2)*m(1, 3) - m(1, 1)*m(2, 3), m(1, 1)*m(2, 2) - m(1, 2)**2]
      inverted = unpacked(cofactors)/dot_product(m(:, 1), cofactors(1:3))
    end associate
  end function inverse

  !> Inverse of a packed symmetric positive definite matrix of order two.
  pure function inverse_of_two(packed) result(inverted)
    !> xz-xz, xz-yz, yz-yz
    real(wp), intent(in) :: packed(3)
    !> Its inverse, packed in the same way
    real(wp) :: inverted(3)

    inverted = [packed(3), -packed(2), packed(1)]/(packed(1)*packed(3) - packed(2)**2)
  end function inverse_of_two
end module packed_matrices
