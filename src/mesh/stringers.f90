!> Stringers of the deck: beams bonded to a face of the plate along a line of the mesh.
module stringers
  use kinds, only: wp
  use mesh_parameters, only: image_signs, plate_t
  use roundings, only: rounding
  use stringer_sections, only: stringer_section_t
  implicit none
  private
  public :: stringer_t, lines_of_stringers, move_line, is_covered, have_images, are_images, differ_at, mass_of

  !> Faces: the struck one and the one opposite to it.
  integer, parameter, public :: face_front = 1, face_back = 2

  !> One stringer.
  type :: stringer_t
    !> Name in messages
    character(len=:), allocatable :: name
    !> Direction: 1 for x, 2 for y
    integer :: along = 1
    !> Coordinate across this direction, and coordinates along it of its ends, from the plate's centre
    real(wp) :: at = 0, ends(2) = 0
    !> face_front or face_back
    integer :: face = face_back
    !> Its section
    type(stringer_section_t) :: section
    !> Strains along it at which it fails in tension and in compression; 0: not known
    real(wp) :: failure_strains(2) = 0
  end type stringer_t

contains

  !> Coordinates along a direction that stringers require as lines of the mesh: those of stringers across it, and the
  !> ends of those along it that end on the plate.
  pure function lines_of_stringers(stringers, length, direction) result(lines)
    type(stringer_t), intent(in) :: stringers(:)
    !> Length of the plate along the direction
    real(wp), intent(in) :: length
    integer, intent(in) :: direction
    real(wp), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(stringers)
      if (stringers(i)%along /= direction) then
        lines = [lines, stringers(i)%at]
      else
        lines = [lines, pack(stringers(i)%ends, abs(stringers(i)%ends) < length/2*(1 - rounding))]
      end if
    end do
  end function lines_of_stringers

  !> Moves the stringers on a line, or that end there, to another one.
  pure subroutine move_line(stringers, direction, from, to)
    type(stringer_t), intent(inout) :: stringers(:)
    !> Direction of the coordinate: 1 for x, 2 for y
    integer, intent(in) :: direction
    !> Coordinate of the line, and the new one
    real(wp), intent(in) :: from, to
    integer :: i

    do i = 1, size(stringers)
      if (stringers(i)%along /= direction) then
        if (abs(stringers(i)%at - from) <= 0) stringers(i)%at = to
      else
        where (abs(stringers(i)%ends - from) <= 0) stringers(i)%ends = to
      end if
    end do
  end subroutine move_line

  !> True if a part of a line lies on a stringer.
  pure logical function is_covered(stringer, at, ends, tolerance)
    type(stringer_t), intent(in) :: stringer
    !> Coordinate of the line, and of the ends of the part
    real(wp), intent(in) :: at, ends(2)
    !> Distance that is round-off
    real(wp), intent(in) :: tolerance

    is_covered = abs(at - stringer%at) <= tolerance .and. sum(ends)/2 > stringer%ends(1) .and. &
                 sum(ends)/2 < stringer%ends(2)
  end function is_covered

  !> True if the image of each stringer is a stringer.
  pure logical function have_images(stringers, plate, symmetry, tolerance) result(alike)
    type(stringer_t), intent(in) :: stringers(:)
    type(plate_t), intent(in) :: plate
    integer, intent(in) :: symmetry
    !> Largest distance from the image, relative to the plate
    real(wp), intent(in) :: tolerance
    integer :: i, image

    associate (signs => image_signs(symmetry))
      alike = all([((any(are_images(stringers, stringers(i), signs(:, image), tolerance*maxval(plate%length))), &
                     i=1, size(stringers)), image=1, size(signs, 2))])
    end associate
  end function have_images

  !> True for stringers that are an image of one.
  pure function are_images(stringers, one, signs, distance) result(are)
    type(stringer_t), intent(in) :: stringers(:), one
    integer, intent(in) :: signs(2)
    !> Largest distance from the image
    real(wp), intent(in) :: distance
    logical :: are(size(stringers))
    real(wp) :: ends(2)
    integer :: i

    ends = signs(one%along)*one%ends
    if (signs(one%along) < 0) ends = ends([2, 1])
    do i = 1, size(stringers)
      associate (other => stringers(i))
        are(i) = one%along == other%along .and. one%face == other%face .and. have_equal_sections(one, other) .and. &
                 maxval(abs([signs(3 - one%along)*one%at - other%at, ends - other%ends])) <= distance
      end associate
    end do
  end function are_images

  !> First of two lists of stringers that differ; 0: they are equal.
  pure integer function differ_at(these, others) result(first)
    !> The lists
    type(stringer_t), intent(in) :: these(:), others(:)

    do first = 1, min(size(these), size(others))
      associate (one => these(first), other => others(first))
        if (one%along /= other%along .or. one%face /= other%face .or. .not. have_equal_sections(one, other)) return
        if (any(abs([one%at - other%at, one%ends - other%ends]) > &
                rounding*maxval(abs([one%at, one%ends])))) return
      end associate
    end do
    if (size(these) == size(others)) first = 0
  end function differ_at

  !> Mass of stringers.
  pure real(wp) function mass_of(stringers) result(mass)
    type(stringer_t), intent(in) :: stringers(:)
    integer :: i

    mass = sum([(stringers(i)%section%mass*(stringers(i)%ends(2) - stringers(i)%ends(1)), i=1, size(stringers))])
  end function mass_of

  !> True if two stringers have the same section.
  pure logical function have_equal_sections(one, other) result(alike)
    !> The stringers
    type(stringer_t), intent(in) :: one, other

    alike = all(abs(values_of(one%section) - values_of(other%section)) <= rounding*abs(values_of(one%section)))
  end function have_equal_sections

  !> The values of a section.
  pure function values_of(section) result(values)
    type(stringer_section_t), intent(in) :: section
    real(wp) :: values(8)

    values = [section%axial, section%bending, section%torsion, section%shear, section%mass, section%eccentricity, &
              section%rotary, section%lateral_rotary]
  end function values_of
end module stringers
