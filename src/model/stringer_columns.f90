!> Forces, moments and strains of stringers, as columns of the history.
module stringer_columns
  use edge_beams, only: axial_row, beam_strains, bending_row, twist_row
  use element_batches, only: lanes
  use kinds, only: wp
  use mesh_parameters, only: image_signs, same_place
  use roundings, only: rounding
  use stringers, only: are_images
  use composite_plates, only: composite_plate_t
  use reference_fields, only: gather
  use result_tables, only: result_row_length
  use stiffened_elements, only: strains_of_beam
  implicit none
  private
  public :: stringer_values, weakest_stringer, resultants

  !> Columns of the history, once per stringer: N is its number in the deck.
  character(len=*), parameter, public :: stringer_column_rows(*) = [character(len=result_row_length) :: &
    'stringer_force_N | real | force | Axial force of the N-th &stringer, the largest in magnitude along it, positive &
      &in tension.', &
    'stringer_moment_N | real | energy | Bending moment about its centroid, the largest in magnitude.', &
    'stringer_torque_N | real | energy | Torsional moment, the largest in magnitude.', &
    'stringer_strain_N | real | - | Strain along it at its free edge, at the centroid where the section is given, the &
      &largest in magnitude, positive in tension.']
  !> Number of these columns.
  integer, parameter, public :: columns = size(stringer_column_rows)
  !> The one whose sign a mirror image changes.
  integer, parameter :: torque_column = 3

contains

  !> Values of all stringers, the same on every rank. Collective.
  function stringer_values(plate, displacement) result(values)
    type(composite_plate_t), intent(in) :: plate
    !> Unknowns, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Those of the first, then those of the next
    real(wp), allocatable :: values(:)
    real(wp), allocatable :: ranges(:, :)
    integer :: i

    allocate (values(0))
    if (.not. allocated(plate%setup%stringers)) return
    if (size(plate%setup%stringers) == 0) return
    ranges = ranges_of(plate, displacement)
    ! Of opposite values that differ by round-off the positive one.
    values = [(merge(ranges(1, i), -ranges(2, i), ranges(1, i) >= (1 - rounding)*ranges(2, i)), i=1, size(ranges, 2))]
  end function stringer_values

  !> First stringer whose strain at the free edge exceeds its strength; 0: none. Collective.
  integer function weakest_stringer(plate, displacement) result(weakest)
    type(composite_plate_t), intent(in) :: plate
    !> Unknowns, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    real(wp), allocatable :: ranges(:, :)

    ranges = ranges_of(plate, displacement)
    do weakest = 1, size(plate%setup%stringers)
      associate (allowed => plate%setup%stringers(weakest)%failure_strains)
        if (any(allowed > 0 .and. ranges(:, columns*weakest) > allowed)) return
      end associate
    end do
    weakest = 0
  end function weakest_stringer

  !> Largest value of each column, and largest value with the other sign; at least 0. Collective.
  function ranges_of(plate, displacement) result(ranges)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> (sign, column)
    real(wp), allocatable :: ranges(:, :)
    real(wp), allocatable :: motion(:, :), flat(:)
    real(wp) :: r(lanes, 9, 5), values(columns, 3)
    integer :: b, k, i

    allocate (ranges(2, columns*size(plate%setup%stringers)), source=0.0_wp)
    motion = plate%motion_of(displacement)
    if (allocated(plate%elements%beams)) then
      do b = 1, plate%elements%batches
        if (.not. plate%elements%has_beams(b)) cycle
        call gather(plate%elements%points(:, :, b), motion, r)
        do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
          i = columns*(plate%elements%beams(k)%stringer - 1)
          values = resultants(plate, k, strains_of_beam(plate%elements, k, plate%setup%mesh%kinematics, r))
          ranges(1, i + 1:i + columns) = max(ranges(1, i + 1:i + columns), maxval(values, 2))
          ranges(2, i + 1:i + columns) = max(ranges(2, i + 1:i + columns), -minval(values, 2))
        end do
      end do
    end if
    flat = reshape(ranges, [size(ranges)])
    call plate%communicator%maximum(flat)
    ranges = reshape(flat, shape(ranges))
    call add_images(plate, ranges)
  end function ranges_of

  !> Widens the ranges of stringers by those of their images, as only one of them may lie in the modelled part.
  pure subroutine add_images(plate, ranges)
    type(composite_plate_t), intent(in) :: plate
    !> (sign, column)
    real(wp), intent(inout) :: ranges(:, :)
    real(wp) :: modelled(2, columns, size(plate%setup%stringers)), image(2, columns)
    logical :: are(size(plate%setup%stringers))
    integer :: i, k, part

    modelled = reshape(ranges, shape(modelled))
    associate (stringers => plate%setup%stringers, signs => image_signs(plate%setup%plate%symmetry))
      do part = 1, size(signs, 2)
        do i = 1, size(stringers)
          are = are_images(stringers, stringers(i), signs(:, part), same_place*maxval(plate%setup%plate%length))
          do k = 1, size(stringers)
            if (.not. are(k)) cycle
            image = modelled(:, :, i)
            if (product(signs(:, part)) < 0) image([1, 2], torque_column) = image([2, 1], torque_column)
            associate (own => ranges(:, columns*(k - 1) + 1:columns*k))
              own = max(own, image)
            end associate
          end do
        end do
      end do
    end associate
  end subroutine add_images

  !> Columns of a beam at its three points.
  pure function resultants(plate, k, strains) result(values)
    type(composite_plate_t), intent(in) :: plate
    !> Number of the beam
    integer, intent(in) :: k
    !> Its strains
    real(wp), intent(in) :: strains(beam_strains)
    !> (column, point)
    real(wp) :: values(columns, 3)

    associate (section => plate%setup%stringers(plate%elements%beams(k)%stringer)%section, &
               outwards => plate%elements%beams(k)%outwards)
      values(1, :) = section%axial*strains(axial_row:axial_row + 2)
      values(2, :) = section%bending*strains(bending_row:bending_row + 2)
      values(3, :) = section%torsion*strains(twist_row:twist_row + 2)
      values(4, :) = strains(axial_row:axial_row + 2) &
                     + outwards*max(0.0_wp, section%depth - section%eccentricity)*strains(bending_row:bending_row + 2)
      if (.not. section%depth > 0) values(4, :) = strains(axial_row:axial_row + 2)
    end associate
  end function resultants
end module stringer_columns
