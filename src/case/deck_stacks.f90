!> The different laminates of the plate of a deck: with doublers, without the plies of ply drops.
module deck_stacks
  use kinds, only: wp
  use ply_stacks, only: ply_stack_t
  use setups, only: setup_t
  use text, only: line_t, append, joined, to_text
  implicit none
  private
  public :: stacks_of, place_of_stack

contains

  !> The laminates, that of the plate alone first unless doublers and ply drops cover it.
  pure function stacks_of(setup) result(stacks)
    type(setup_t), intent(in) :: setup
    type(ply_stack_t), allocatable :: stacks(:)
    logical, allocatable :: known(:, :)
    real(wp), allocatable :: shares(:)
    integer, allocatable :: present(:)
    integer :: i

    call setup%zones%find_shares(setup%plate%length, known, shares)
    present = pack([(i, i=1, size(shares))], shares > 0)
    allocate (stacks(size(present)))
    do i = 1, size(stacks)
      stacks(i) = setup%zones%stack(setup%laminate, setup%materials, known(:, present(i)))
    end do
  end function stacks_of

  !> Where a laminate lies: the names of its doublers and the plies that it lacks; empty for the plate's own.
  pure function place_of_stack(setup, stack) result(place)
    type(setup_t), intent(in) :: setup
    type(ply_stack_t), intent(in) :: stack
    character(len=:), allocatable :: place
    type(line_t), allocatable :: missing(:)
    integer :: i, ply

    place = ''
    if (allocated(setup%zones%doublers)) then
      do i = 1, size(setup%zones%doublers)
        if (any([(setup%zones%doubler_of(stack%number(ply) - size(setup%laminate%material)) == i, &
                  ply=1, size(stack%number))])) place = place//' with '//setup%zones%doublers(i)%name
      end do
    end if
    allocate (missing(0))
    do ply = 1, size(setup%laminate%material)
      if (.not. any(stack%number == ply)) call append(missing, to_text(ply))
    end do
    if (size(missing) == 1) place = place//' without ply '//missing(1)%text
    if (size(missing) > 1) place = place//' without plies '//joined(missing, ', ')
  end function place_of_stack
end module deck_stacks
