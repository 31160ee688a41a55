!> Plate, supports and mesh, as the deck gives them.
module mesh_parameters
  use kinds, only: wp
  use plate_options, only: shear_assumed, mass_consistent
  implicit none
  private
  public :: plate_t, mesh_t

  !> Supports of an edge.
  integer, parameter, public :: edge_free = 0, edge_simple = 1, edge_clamped = 2
  !> Parts of the plate that are modelled.
  integer, parameter, public :: symmetry_none = 1, symmetry_quarter = 2

  !> The plate; lengths are of the whole plate, also under symmetry.
  type :: plate_t
    !> Lengths along x and y
    real(wp) :: length(2) = 0
    !> Supports at x-min, x-max, y-min, y-max
    integer :: edges(4) = edge_clamped
    !> True: supported edges hold the plate in its plane too
    logical :: in_plane_fixed = .true.
    !> symmetry_none or symmetry_quarter (the part x >= 0, y >= 0)
    integer :: symmetry = symmetry_none
  end type plate_t

  !> The rectangle of elements.
  type :: mesh_t
    !> Elements along x and y, of the modelled part
    integer :: elements(2) = 0
    !> Largest over smallest element edge outside the patch; 0: chosen so that sizes change smoothly
    real(wp) :: grading = 0
    !> Side of the loaded square, centred on the struck point; 0: none
    real(wp) :: patch = 0
    !> Full extents along x and y of the rectangle of equal elements around the patch, and their side; 0: none
    real(wp) :: core(2) = 0, cell = 0
    !> Transverse shear of the element, one of `plate_options`
    integer :: shear = shear_assumed
    !> Mass matrix, one of `plate_options`
    integer :: mass = mass_consistent
  end type mesh_t
end module mesh_parameters
