!> Warns of elements outside of the core that grow too fast: a smaller cell in an unchanged number of elements refines
!> the core only, and lengthens all others.
module deck_cell_growth
  use cell_grids, only: cells_from_struck
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use gradings, only: core_elements
  use kinds, only: wp
  use mesh_deck, only: key_elements, mesh_group
  use mesh_parameters, only: is_halved
  use short_numbers, only: short_text
  use text, only: to_text
  implicit none
  private
  public :: check_cell_growth

  !> Ratio of the lengths of adjacent elements above which a warning is given, and that of the elements recommended.
  !> Twice is the usual limit of graded meshes. It affects a warning only.
  real(wp), parameter :: fastest = 3, recommended = 1.5_wp

contains

  !> Warns of fast growth along either direction.
  subroutine check_cell_growth(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: growth(2), longest(2)
    integer :: enough(2), direction

    if (.not. deck%setup%mesh%cell > 0) return
    do direction = 1, 2
      call measure(deck, direction, growth(direction), longest(direction), enough(direction))
    end do
    if (.not. any(growth > fastest)) return
    call remark(deck%settings, problems, mesh_group, key_elements, 'outside of the core each element is up to '// &
                short_text(maxval(growth))//' times as long as the one before, the longest '// &
                short_text(maxval(longest))//', with cell = '//short_text(deck%setup%mesh%cell)//'; elements = '// &
                to_text(enough(1))//', '//to_text(enough(2))//' refine the rest as the core.')
  end subroutine check_cell_growth

  !> Growth from the core to the border, the longest element, and the number of elements for the growth recommended.
  subroutine measure(deck, direction, growth, longest, enough)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: direction
    !> Ratio of adjacent elements, the larger of both sides
    real(wp), intent(out) :: growth
    !> Length of the longest element
    real(wp), intent(out) :: longest
    !> Number of elements
    integer, intent(out) :: enough
    type(cell_line_t) :: line
    real(wp) :: half_core, reach(2)
    logical :: halved(2)
    integer :: side, outside, rest

    associate (mesh => deck%setup%mesh)
      line = cells_from_struck(deck%setup%plate, mesh, direction)
      half_core = max(mesh%core(direction), mesh%patch)/2
      halved = is_halved(deck%setup%plate%symmetry)
      growth = 1
      enough = 0
      longest = maxval(line%sides())
      do side = merge(2, 1, halved(direction)), 2
        if (side == 1) line = line%turned()
        outside = max(1, line%cells_beyond(half_core + mesh%cell/2))
        growth = max(growth, (line%side(line%cells())/mesh%cell)**(1.0_wp/outside))
        reach = line%span()
        ! Elements that grow as recommended from the core to the border.
        rest = max(1, ceiling(log(1 + (reach(2) - half_core)/mesh%cell*(recommended - 1)/recommended)/log(recommended)))
        enough = enough + sum(core_elements(mesh%patch/2, mesh%core(direction)/2, mesh%cell)) + rest
        if (side == 1) line = line%turned()
      end do
      enough = max(enough, mesh%elements(direction))
    end associate
  end subroutine measure
end module deck_cell_growth
