!> A struck plate, represented by its modes, for estimates before a run.
!>
!> The modes are Navier's modes of a simply supported orthotropic Mindlin plate with rotary inertia, with the rotations
!> condensed out. With other supports they are products of modes of beams (Rayleigh's method). Where an edge is free,
!> the lowest products are coupled (Ritz's method). A curved plate has the additional stiffness of its membrane forces.
module modal_plates
  use coupled_products, only: coupled_modes_t, coupled_modes_of, no_modes
  use curved_modes, only: membrane_mode, shallow_shape_t
  use kinds, only: wp
  use mesh_parameters, only: edge_free
  use span_modes, only: is_counted, modes_along, span_modes_t
  implicit none
  private
  public :: modal_plate_t, modal_plate_of, reduced

  !> Modes that a force distributed over a patch excites.
  type :: modal_plate_t
    !> Circular frequency of each mode
    real(wp), allocatable :: frequency(:)
    !> Square of the mean of the mode over the patch divided by its modal mass, 1/mass
    real(wp), allocatable :: weight(:)
    !> Wave numbers along x and y, (2, modes)
    real(wp), allocatable :: wave_number(:, :)
    !> Deflection of the patch per force by all modes that are not listed, quasi-static
    real(wp) :: rest = 0
  end type modal_plate_t

contains

  !> Modes of a plate up to a frequency, and the static compliance of all higher modes.
  pure function modal_plate_of(length, edges, stiffness, mass, patch, cutoff, shape, place) result(plate)
    real(wp), intent(in) :: length(2)
    !> Supports at x-min, x-max, y-min, y-max
    integer, intent(in) :: edges(4)
    !> Section stiffness, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> Integrals of density, density z and density z**2
    real(wp), intent(in) :: mass(3)
    !> Side of the loaded square
    real(wp), intent(in) :: patch
    !> Circular frequency up to which modes are listed
    real(wp), intent(in) :: cutoff
    !> Shape without stress; flat if absent
    type(shallow_shape_t), intent(in), optional :: shape
    !> Coordinates of the middle of the square from that of the plate; in the middle if absent
    real(wp), intent(in), optional :: place(2)
    type(modal_plate_t) :: plate
    type(span_modes_t) :: x, y
    type(coupled_modes_t) :: coupled
    real(wp), allocatable :: condensed(:, :, :)
    real(wp) :: at(2)
    logical :: is_held

    at = 0
    if (present(place)) at = max(-0.5_wp, min(0.5_wp, place/length))
    is_held = all(edges /= edge_free)
    x = modes_along(length(1), edges(1:2), patch, at(1), is_held)
    y = modes_along(length(2), edges(3:4), patch, at(2), is_held)
    condensed = condensed_products(x, y, stiffness, mass, shape)
    if (is_held) then
      coupled = no_modes()
    else
      coupled = coupled_modes_of(x, y, stiffness, condensed)
    end if
    plate = listed_modes(x, y, condensed, coupled, cutoff)
  end function modal_plate_of

  !> Stiffness and mass per area of all products of two modes.
  pure function condensed_products(x, y, stiffness, mass, shape) result(condensed)
    !> Modes along x and y
    type(span_modes_t), intent(in) :: x, y
    !> Section stiffness, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> Integrals of density, density z and density z**2
    real(wp), intent(in) :: mass(3)
    !> Shape without stress; flat if absent
    type(shallow_shape_t), intent(in), optional :: shape
    !> Stiffness and mass, (2, modes along x, along y)
    real(wp), allocatable :: condensed(:, :, :)
    integer :: i, j

    allocate (condensed(2, size(x%number), size(y%number)))
    do j = 1, size(y%number)
      do i = 1, size(x%number)
        condensed(:, i, j) = condensed_mode([x%slope(i), y%slope(j)], [x%bending(i), y%bending(j)], &
                                            x%poisson(i)*y%poisson(j), stiffness, mass)
        if (.not. present(shape)) cycle
        condensed(:, i, j) = condensed(:, i, j) + [1.0_wp, mass(1)]* &
                             membrane_mode(shape, stiffness(1:6), [x%wave_number(i), y%wave_number(j)], &
                                           [x%half_wave, y%half_wave], &
                                           [is_counted(x, i), is_counted(y, j)])
      end do
    end do
  end function condensed_products

  !> The modes up to a frequency, and the compliance of the others.
  pure function listed_modes(x, y, condensed, coupled, cutoff) result(plate)
    !> Modes along x and y
    type(span_modes_t), intent(in) :: x, y
    !> Stiffness and mass of their products
    real(wp), intent(in) :: condensed(:, :, :)
    !> Modes that the lowest products are replaced by
    type(coupled_modes_t), intent(in) :: coupled
    !> Circular frequency up to which modes are listed
    real(wp), intent(in) :: cutoff
    type(modal_plate_t) :: plate
    real(wp), allocatable :: square(:), weight(:), wave_number(:, :)
    logical, allocatable :: is_listed(:)
    integer :: i, j

    associate (single => [((.not. (i <= coupled%products(1) .and. j <= coupled%products(2)), i=1, size(x%number)), &
                           j=1, size(y%number))], &
               mass => [condensed(2, :, :)])
      square = [coupled%square, pack([condensed(1, :, :)]/mass, single)]
      weight = [coupled%weight, pack([((x%mean(i)*y%mean(j), i=1, size(x%number)), j=1, size(y%number))]**2/ &
                                     (x%length*y%length*mass), single)]
      wave_number = reshape([coupled%wave_number, &
                             pack([((x%wave_number(i), y%wave_number(j), i=1, size(x%number)), j=1, size(y%number))], &
                                  [((single(i), j=1, 2), i=1, size(single))])], [2, size(square)])
    end associate
    is_listed = square <= cutoff**2
    plate%frequency = sqrt(pack(square, is_listed))
    plate%weight = pack(weight, is_listed)
    plate%wave_number = wave_number(:, pack([(i, i=1, size(square))], is_listed))
    plate%rest = sum(pack(weight, .not. is_listed)/pack(square, .not. is_listed))
  end function listed_modes

  !> Stiffness and mass of a product of two modes per area, for its deflection. The rotations are its slopes times two
  !> factors, which are condensed statically; their inertia is that of the slope.
  pure function condensed_mode(slope, bending, poisson, stiffness, mass) result(condensed)
    !> Root mean square slopes, and curvatures over slopes, of the modes along x and y
    real(wp), intent(in) :: slope(2), bending(2)
    !> Product of those of Poisson's effect
    real(wp), intent(in) :: poisson
    !> Section stiffness, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> Integrals of density, density z and density z**2
    real(wp), intent(in) :: mass(3)
    !> Stiffness and mass
    real(wp) :: condensed(2)
    real(wp) :: k22, k23, k33, turn(2), shear(2)

    shear = stiffness([19, 21])*slope
    k22 = stiffness(13)*bending(1) + stiffness(18)*slope(2)**2 + stiffness(19)
    k23 = stiffness(14)*poisson + stiffness(18)*product(slope)
    k33 = stiffness(18)*slope(1)**2 + stiffness(16)*bending(2) + stiffness(21)
    turn = [k33*shear(1) - k23*shear(2), k22*shear(2) - k23*shear(1)]/(k22*k33 - k23**2)
    condensed(1) = max(0.0_wp, dot_product(shear, slope - turn))
    condensed(2) = mass(1) + mass(3)*dot_product(turn, turn)
  end function condensed_mode

  !> The plate with its modes up to a lower frequency; the other modes contribute their static compliance.
  pure function reduced(plate, cutoff) result(fewer)
    type(modal_plate_t), intent(in) :: plate
    !> Circular frequency, > 0
    real(wp), intent(in) :: cutoff
    !> The same with fewer modes
    type(modal_plate_t) :: fewer
    logical :: kept(size(plate%frequency))
    integer :: i

    kept = plate%frequency <= cutoff
    fewer%frequency = pack(plate%frequency, kept)
    fewer%weight = pack(plate%weight, kept)
    fewer%wave_number = plate%wave_number(:, pack([(i, i=1, size(kept))], kept))
    fewer%rest = plate%rest + sum(pack(plate%weight, .not. kept)/pack(plate%frequency, .not. kept)**2)
  end function reduced
end module modal_plates
