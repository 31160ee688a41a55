!> Required lines of the mesh that nearly coincide. A row of cells between two such lines resolves nothing, but limits
!> the stable step of central differences and makes the tangent ill-conditioned.
module coincident_lines
  use kinds, only: wp
  implicit none
  private
  public :: merged_lines

  !> Distance of lines below which they are one, relative to the plate's length. A frame whose edges move by d changes
  !> its span L by 2 d and the deflection of the plate by at most 6 d/L: 0.6 %, below the 1 % that accuracy='reference'
  !> permits. Fixtures are no more accurate: ASTM D7136 permits 1 mm on 125 mm.
  real(wp), parameter, public :: merging_distance = 1.0e-3_wp

contains

  !> Distances from the centre to which required lines are moved: each is moved to a fixed line, or to a required line
  !> closer to the centre, that is within a distance. The result depends on the set of lines only, not on their order,
  !> so that a later deck that lists the same lines has the same mesh.
  pure function merged_lines(lines, fixed, distance) result(merged)
    !> Distances of the required lines from the centre
    real(wp), intent(in) :: lines(:)
    !> Distances at which the mesh has lines in any case
    real(wp), intent(in) :: fixed(:)
    !> Largest distance between lines that are merged
    real(wp), intent(in) :: distance
    !> One for each required line
    real(wp) :: merged(size(lines))
    real(wp), allocatable :: taken(:)
    logical :: is_left(size(lines))
    integer :: i, k, nearest

    taken = fixed
    merged = lines
    is_left = .true.
    do k = 1, size(lines)
      i = minloc(lines, dim=1, mask=is_left)
      is_left(i) = .false.
      if (size(taken) > 0) then
        nearest = minloc(abs(taken - lines(i)), dim=1)
        if (abs(taken(nearest) - lines(i)) <= distance) merged(i) = taken(nearest)
      end if
      if (.not. any(abs(taken - merged(i)) <= 0)) taken = [taken, merged(i)]
    end do
  end function merged_lines
end module coincident_lines
