!> Stacking sequence in the deck.
module laminate_parameters
  use kinds, only: wp
  implicit none
  private
  public :: laminate_t

  !> How the transverse shear stiffness of a stack of plies is reduced.
  integer, parameter, public :: shear_five_sixths = 1, shear_energy = 2

  !> Plies from the struck face (ply 1) to the back.
  type :: laminate_t
    !> Index of each ply's material in the list of materials
    integer, allocatable :: material(:)
    !> Fibre angle of each ply from x, degrees
    real(wp), allocatable :: angle(:)
    !> Thickness of each ply
    real(wp), allocatable :: thickness(:)
    !> shear_five_sixths or shear_energy
    integer :: shear_correction = shear_five_sixths
    !> Relative error of the bending stiffness by plies of which a part is in tension, a part in compression
    real(wp) :: bending_error = 0.005_wp
  end type laminate_t
end module laminate_parameters
