!> Checks of the loaded patch and the core, and of the number of elements for them.
module deck_patches
  use cell_grids, only: fewest_elements, has_enough_elements, needs_even_elements
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use impactor_deck, only: impactor_group, key_at
  use kinds, only: wp
  use mesh_deck, only: mesh_group, key_elements, key_patch, key_core, key_cell, max_elements
  use plate_deck, only: plate_group, key_symmetry
  use roundings, only: rounding
  use short_numbers, only: text_at_least
  use text, only: to_text
  implicit none
  private
  public :: check_patch, check_core

  !> Smallest patch as a fraction of the plate's shorter side: the elements that it requires are then as slender as
  !> those of the thinnest plate.
  real(wp), parameter :: min_patch = 1.0e-5_wp

contains

  !> Loaded patch: not larger than the plate, and not too small.
  subroutine check_patch(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: shorter

    shorter = minval(deck%setup%plate%length)
    associate (s => deck%settings, patch => deck%setup%mesh%patch)
      if (patch <= 0) return
      if (any(abs(deck%setup%mesh%struck) > 0 .and. meets_border(deck, [patch, patch])) .and. patch <= shorter) then
        if (are_clear(s, problems, impactor_group, key_at)) call report(s, problems, impactor_group, key_at, 'the '// &
          'loaded patch reaches the border of the plate; strike further inside.')
      else if (patch > shorter) then
        call report(s, problems, mesh_group, key_patch, 'is larger than the plate; allowed: up to '// &
                  to_text(shorter)//'.')
      else if (patch < min_patch*shorter) then
        call report(s, problems, mesh_group, key_patch, 'is too small for the plate; allowed: from '// &
                  text_at_least(min_patch*shorter)//'.')
      else if (.not. deck%setup%mesh%cell > 0) then
        call check_elements(deck, problems)
      end if
    end associate
  end subroutine check_patch

  !> Core of equal elements: in the plate, and of elements that are not too small.
  subroutine check_core(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    associate (s => deck%settings, mesh => deck%setup%mesh)
      if (minval(mesh%core) <= 0 .or. mesh%cell <= 0) return
      if (any(meets_border(deck, mesh%core))) then
        call report(s, problems, mesh_group, key_core, &
                  'reaches the border of the plate; give it smaller or leave it out.')
      else if (any(mesh%core/mesh%cell > max_elements)) then
        call report(s, problems, mesh_group, key_cell, 'is too small for the core.')
      else
        call check_elements(deck, problems)
      end if
    end associate
  end subroutine check_core

  !> Elements for the loaded patch, the core and the plate around them. Without a core the number that is needed depends
  !> on that of the deck.
  subroutine check_elements(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: message
    integer :: direction

    associate (s => deck%settings, plate => deck%setup%plate, mesh => deck%setup%mesh)
      if (.not. are_clear(s, problems, mesh_group, key_elements//' '//key_patch)) return
      if (.not. are_clear(s, problems, plate_group, key_symmetry)) return
      do direction = 1, 2
        if (has_enough_elements(plate, mesh, direction)) cycle
        message = 'are too few for the loaded patch and the plate around it; give more'
        if (mesh%cell > 0) message = 'the core needs at least '//to_text(fewest_elements(plate, mesh, direction))// &
                                     ' along '//merge('x', 'y', direction == 1)
        if (needs_even_elements(plate, mesh, direction)) message = message//', and an even number'
        call report(s, problems, mesh_group, key_elements, message//'.')
        return
      end do
    end associate
  end subroutine check_elements

  !> Whether a rectangle around the struck point reaches or crosses the border, so that no elements fit on that side.
  pure function meets_border(deck, extents) result(meets)
    type(deck_t), intent(in) :: deck
    !> Extents of the rectangle along x and y
    real(wp), intent(in) :: extents(2)
    !> Along x and y
    logical :: meets(2)

    meets = extents/2 + abs(deck%setup%mesh%struck) >= deck%setup%plate%length/2*(1 - rounding)
  end function meets_border
end module deck_patches
