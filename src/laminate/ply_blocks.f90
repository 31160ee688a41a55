!> Blocks of a laminate: neighbouring plies of one material and angle, which bend and crack together.
module ply_blocks
  use kinds, only: wp
  use plies, only: ply_t
  implicit none
  private
  public :: are_alike, block_of, block_thickness, blocks_of

contains

  !> First and last ply of the block that a ply belongs to.
  pure function block_of(plies, ply) result(range)
    type(ply_t), intent(in) :: plies(:)
    !> One of the block
    integer, intent(in) :: ply
    !> First and last
    integer :: range(2)

    range = ply
    do while (range(1) > 1)
      if (.not. are_alike(plies(range(1) - 1), plies(ply))) exit
      range(1) = range(1) - 1
    end do
    do while (range(2) < size(plies))
      if (.not. are_alike(plies(range(2) + 1), plies(ply))) exit
      range(2) = range(2) + 1
    end do
  end function block_of

  !> Thickness of the block that a ply belongs to.
  pure real(wp) function block_thickness(plies, ply) result(thickness)
    type(ply_t), intent(in) :: plies(:)
    !> One of the block
    integer, intent(in) :: ply
    integer :: range(2)

    range = block_of(plies, ply)
    thickness = plies(range(2))%z_bottom - plies(range(1))%z_top
  end function block_thickness

  !> Thickness of the block of each ply of a material.
  pure function blocks_of(plies, material) result(thicknesses)
    type(ply_t), intent(in) :: plies(:)
    !> Its index
    integer, intent(in) :: material
    real(wp), allocatable :: thicknesses(:)
    integer :: ply

    thicknesses = pack([(block_thickness(plies, ply), ply=1, size(plies))], plies%material == material)
  end function blocks_of

  !> True: one material at one angle, modulo 180 degrees.
  pure logical function are_alike(a, b)
    !> The plies
    type(ply_t), intent(in) :: a, b

    are_alike = a%material == b%material .and. abs(a%cosine*b%sine - a%sine*b%cosine) < 1.0e-12_wp
  end function are_alike
end module ply_blocks
