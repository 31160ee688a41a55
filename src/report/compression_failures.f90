!> Failure of a plate in compression: interfaces and plies that have failed across the width, and the three-place
!> failure code of ASTM D7137 as far as these determine it. Its letters have not been compared with the text of the
!> standard.
module compression_failures
  use compressed_damage, only: compressed_damage_t, figure_area, figure_mean, figure_reach, figure_width
  use kinds, only: wp
  implicit none
  private
  public :: compression_failure_t, failure_of

  !> Letters of the code.
  character(len=*), parameter :: letters = 'DLAGMV'
  !> Delamination that has grown to the edges, lateral failure of fibres, and both.
  character(len=*), parameter :: delamination = letters(1:1), lateral = letters(2:2), both = 'M(DL)'
  !> At an end, through the damage, elsewhere in the gauge length; in the middle, various places.
  character(len=*), parameter :: at_end = letters(3:3), through_damage = letters(1:1), in_gauge = letters(4:4), &
                                 middle = letters(5:5), various = letters(6:6)

  !> The failure.
  type :: compression_failure_t
    !> Interfaces that have delaminated and plies with fibre failure across the full width between the supports since
    !> the start
    logical, allocatable :: interfaces(:), plies(:)
    !> Code; empty: no failure across the width
    character(len=:), allocatable :: code
  end type compression_failure_t

contains

  !> The failure between two states.
  pure function failure_of(before, after, length, thickness) result(failure)
    !> Damage at the start and at the end
    type(compressed_damage_t), intent(in) :: before, after
    !> Length between the supports along the load, and thickness of the plate
    real(wp), intent(in) :: length, thickness
    type(compression_failure_t) :: failure

    failure%interfaces = failed_across(before%interfaces, after%interfaces)
    failure%plies = failed_across(before%plies, after%plies)
    failure%code = ''
    associate (grown => any(failure%interfaces), torn => any(failure%plies))
      if (grown .and. torn) then
        failure%code = both
      else if (grown) then
        failure%code = delamination
      else if (torn) then
        failure%code = lateral
      end if
      if (torn) failure%code = failure%code//place_of(before, length, thickness, &
                                                     mean_place(before%plies, after%plies, failure%plies))
      if (grown .and. .not. torn) failure%code = failure%code//place_of(before, length, thickness, &
        mean_place(before%interfaces, after%interfaces, failure%interfaces))
    end associate
  end function failure_of

  !> True for interfaces or plies that failed across the full width since the start.
  pure function failed_across(before, after) result(across)
    !> Quantities at the start and at the end
    real(wp), intent(in) :: before(:, :), after(:, :)
    !> One per interface or ply
    logical :: across(size(after, 2))

    across = before(figure_width, :) < 1 .and. .not. after(figure_width, :) < 1
  end function failed_across

  !> Mean distance from the middle of failure since the start in some interfaces or plies.
  pure real(wp) function mean_place(before, after, chosen) result(place)
    !> Quantities at the start and at the end
    real(wp), intent(in) :: before(:, :), after(:, :)
    !> True for those
    logical, intent(in) :: chosen(:)

    place = sum(after(figure_area, :)*after(figure_mean, :) - before(figure_area, :)*before(figure_mean, :), chosen) &
            /sum(after(figure_area, :) - before(figure_area, :), chosen)
  end function mean_place

  !> Second and third letter of the code. An end reaches one thickness into the length between the supports, the middle
  !> is its middle third.
  pure function place_of(before, length, thickness, place) result(place_code)
    !> Damage at the start
    type(compressed_damage_t), intent(in) :: before
    !> Length between the supports, thickness, and mean distance of the failure from the middle
    real(wp), intent(in) :: length, thickness, place
    !> Area and location
    character(len=2) :: place_code

    if (place > length/2 - thickness) then
      place_code(1:1) = at_end
    else if (place <= max(0.0_wp, maxval(before%interfaces(figure_reach, :)), &
                          maxval(before%plies(figure_reach, :)))) then
      place_code(1:1) = through_damage
    else
      place_code(1:1) = in_gauge
    end if
    place_code(2:2) = merge(middle, various, place <= length/6)
  end function place_of
end module compression_failures
