!> Interfaces of a group of the deck: those below the listed plies, or those selected by a word.
module interface_places
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use kinds, only: wp
  use text, only: lower_case, to_text
  implicit none
  private
  public :: interfaces_between, plies_above, remark_left_out

  !> Names of the group and its key.
  character(len=*), parameter, public :: delamination_group = 'delamination', key_below_ply = 'below_ply'
  character(len=*), parameter :: group = delamination_group

contains

  !> Plies below which there are interfaces: those followed by a ply of another angle or material. Plies of one angle
  !> and material do not separate.
  pure function interfaces_between(angles, materials) result(below)
    !> Fibre angle of each ply, degrees
    real(wp), intent(in) :: angles(:)
    !> Material of each ply
    integer, intent(in) :: materials(:)
    !> Plies, ascending
    integer, allocatable :: below(:)
    ! Degrees: decks have at most three decimals, and round-off is about 1e-13.
    real(wp), parameter :: same_angle = 1.0e-6_wp
    integer :: ply

    associate (n => size(angles))
      below = pack([(ply, ply=1, n - 1)], abs(modulo(angles(2:) - angles(:n - 1) + 90, 180.0_wp) - 90) > same_angle &
                   .or. materials(2:) /= materials(:n - 1))
    end associate
  end function interfaces_between

  !> Plies above the interfaces of a group; without any, one invalid entry, which the checks refuse.
  pure function plies_above(settings, place, between) result(below)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: place
    !> Plies below which the angle changes
    integer, intent(in) :: between(:)
    !> Plies in the order of the deck
    integer, allocatable :: below(:)

    below = settings%integers_of(group, key_below_ply, place)
    if (any(lower_case(settings%text_of(group, key_below_ply, place)) == &
            [character(len=14) :: 'all', 'between_angles'])) below = between
    if (size(below) == 0) below = [0]
  end function plies_above

  !> Reports the interfaces that `all` leaves out, between plies of one angle.
  subroutine remark_left_out(settings, plies, between, problems)
    type(settings_t), intent(in) :: settings
    !> Number of plies
    integer, intent(in) :: plies
    !> Plies below which the angle changes
    integer, intent(in) :: between(:)
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: left_out
    integer :: place, ply

    do place = 1, settings%groups_named(group)
      if (lower_case(settings%text_of(group, key_below_ply, place)) /= 'all') cycle
      left_out = ''
      do ply = 1, plies - 1
        if (.not. any(between == ply)) left_out = left_out//', '//to_text(ply)
      end do
      if (left_out /= '') call remark(settings, problems, group, key_below_ply, 'interfaces between plies of the '// &
        'same angle and material are left out, below ply '//left_out(3:)//'; list plies to have them.', place)
    end do
  end subroutine remark_left_out
end module interface_places
