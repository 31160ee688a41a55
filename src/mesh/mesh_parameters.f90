!> Parameters of plate, supports and mesh in the deck.
module mesh_parameters
  use gauges, only: gauge_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use plate_options, only: kinematics_von_karman, mass_consistent, shear_assumed
  use roundings, only: rounding
  implicit none
  private
  public :: plate_t, mesh_t, parts_of, is_halved, is_mirrored, image_signs, has_symmetric_imperfection, is_flat, &
            curvatures, initial_deflection, add_lines

  !> Supports of an edge.
  integer, parameter, public :: edge_free = 0, edge_simple = 1, edge_clamped = 2, edge_elastic = 3
  !> In-plane displacements of supported edges: free; fixed; along the edge fixed and across it free.
  integer, parameter, public :: in_plane_free = 1, in_plane_fixed = 2, in_plane_tangential = 3
  !> Modelled parts of the plate: the full plate; x >= 0 and y >= 0; x >= 0; y >= 0; x >= 0 with point symmetry.
  integer, parameter, public :: symmetry_none = 1, symmetry_quarter = 2, symmetry_half_x = 3, symmetry_half_y = 4, &
                                symmetry_point = 5
  !> Tolerance of the distance of a stringer, clamp or end of a strip from the image of another one, relative to the
  !> plate: .1 um in 100 mm, below the digits of a deck and above round-off.
  real(wp), parameter, public :: same_place = 1.0e-6_wp

  !> The plate; lengths are of the full plate, also under symmetry.
  type :: plate_t
    !> Lengths along x and y
    real(wp) :: length(2) = 0
    !> Supports at x-min, x-max, y-min, y-max
    integer :: edges(4) = edge_clamped
    !> Stiffness of elastic edges per length, against deflection, 0: rigid, and against rotation about the edge
    real(wp) :: edge_stiffness(2) = 0
    !> In-plane displacements of supported edges, one of the constants above
    integer :: in_plane = in_plane_fixed
    !> Radii of the lines along x and along y, positive with the centre on the far side of the impactor; 0: straight
    real(wp) :: curvature_radius(2) = 0
    !> Amplitude of the stress-free initial deflection, added to the curvature; 0: none
    real(wp) :: imperfection = 0
    !> Number of half waves of this deflection along x and y
    integer :: half_waves(2) = 1
    !> Part that is modelled, one of the constants above
    integer :: symmetry = symmetry_none
    !> Symmetry of the case if the full plate is modelled and may fail; symmetry_none: none
    integer :: kept = symmetry_none
    !> Strain gauges; unallocated: none
    type(gauge_t), allocatable :: gauges(:)
  end type plate_t

  !> The rectangle of elements.
  type :: mesh_t
    !> Elements along x and y, of the modelled part
    integer :: elements(2) = 0
    !> Largest over smallest element edge outside the patch; 0: chosen so that sizes change smoothly
    real(wp) :: grading = 0
    !> Side of the loaded square, centred on the struck point; 0: none
    real(wp) :: patch = 0
    !> The struck point, from the plate's centre; 0 along directions that symmetry halves
    real(wp) :: struck(2) = 0
    !> Further coordinates that must be lines of the mesh, such as the edges of windows, those closest to the centre
    !> first; unallocated: none
    real(wp), allocatable :: x_lines(:), y_lines(:)
    !> Full extents along x and y of the rectangle of equal elements around the patch, and their side; 0: none
    real(wp) :: core(2) = 0, cell = 0
    !> Transverse shear of the element, one of `plate_options`
    integer :: shear = shear_assumed
    !> Mass matrix, one of `plate_options`
    integer :: mass = mass_consistent
    !> Strains of the element, kinematics_von_karman or kinematics_linear
    integer :: kinematics = kinematics_von_karman
  end type mesh_t
contains

  !> Adds coordinates to the required lines of the mesh, in the order of their distance from the centre, so that the
  !> mesh does not depend on their source.
  pure subroutine add_lines(lines, further)
    real(wp), allocatable, intent(inout) :: lines(:)
    !> More of them
    real(wp), intent(in) :: further(:)
    integer :: i, place

    if (.not. allocated(lines)) allocate (lines(0))
    do i = 1, size(further)
      if (any(abs(lines - further(i)) <= rounding*abs(further(i)))) cycle
      place = count(abs(lines) < abs(further(i)) .or. &
                    .not. abs(lines) > abs(further(i)) .and. lines < further(i))
      lines = [lines(:place), further(i), lines(place + 1:)]
    end do
  end subroutine add_lines

  !> True if the stress-free plate is flat.
  pure logical function is_flat(plate)
    type(plate_t), intent(in) :: plate

    is_flat = .not. (abs(plate%imperfection) > 0 .or. any(abs(plate%curvature_radius) > 0))
  end function is_flat

  !> Curvatures of the lines along x and along y of the stress-free shape; an imperfection is not counted.
  pure function curvatures(plate) result(curvature)
    type(plate_t), intent(in) :: plate
    !> 1/radius, 0: straight
    real(wp) :: curvature(2)

    curvature = 0
    where (abs(plate%curvature_radius) > 0) curvature = 1/plate%curvature_radius
  end function curvatures

  !> Height of the stress-free mid-plane along z, 0 at the centre without imperfection: paraboloid of the shallow shell,
  !> and half waves over the plate's lengths.
  pure real(wp) function initial_deflection(plate, at) result(deflection)
    type(plate_t), intent(in) :: plate
    !> The point, from the centre of the plate
    real(wp), intent(in) :: at(2)

    deflection = plate%imperfection*product(sin(plate%half_waves*pi*(at/plate%length + 0.5_wp))) &
                 + dot_product(curvatures(plate), at**2)/2
  end function initial_deflection

  !> True if the initial deflection has the symmetry of the modelled part, so that it is that of the full plate.
  pure logical function has_symmetric_imperfection(plate, symmetry) result(alike)
    type(plate_t), intent(in) :: plate
    integer, intent(in) :: symmetry

    alike = .not. any(is_mirrored(symmetry) .and. mod(plate%half_waves, 2) == 0)
    if (symmetry == symmetry_point) alike = mod(sum(plate%half_waves), 2) == 0
    alike = alike .or. .not. abs(plate%imperfection) > 0
  end function has_symmetric_imperfection

  !> Number of models that make up the full plate.
  pure integer function parts_of(symmetry) result(parts)
    integer, intent(in) :: symmetry

    parts = product(merge(2, 1, is_halved(symmetry)))
  end function parts_of

  !> Directions along which the model begins at the plate's centre.
  pure function is_halved(symmetry) result(halved)
    integer, intent(in) :: symmetry
    !> Along x and y
    logical :: halved(2)

    halved = is_mirrored(symmetry)
    if (symmetry == symmetry_point) halved(1) = .true.
  end function is_halved

  !> Directions in which the plate is its own mirror image.
  pure function is_mirrored(symmetry) result(mirrored)
    integer, intent(in) :: symmetry
    !> Along x and y
    logical :: mirrored(2)

    mirrored = [symmetry == symmetry_quarter .or. symmetry == symmetry_half_x, &
                symmetry == symmetry_quarter .or. symmetry == symmetry_half_y]
  end function is_mirrored

  !> Signs of x and y of the images of a plate, (2, images). With three images, the third is the first image of the
  !> second.
  pure function image_signs(symmetry) result(signs)
    integer, intent(in) :: symmetry
    integer, allocatable :: signs(:, :)

    if (symmetry == symmetry_none) then
      allocate (signs(2, 0))
    else if (all(is_mirrored(symmetry))) then
      signs = reshape([-1, 1, 1, -1, -1, -1], [2, 3])
    else if (symmetry == symmetry_point) then
      signs = reshape([-1, -1], [2, 1])
    else
      signs = reshape(merge(-1, 1, is_mirrored(symmetry)), [2, 1])
    end if
  end function image_signs
end module mesh_parameters
