!> Points of the mesh in a list that is the same on every rank.
module listed_points
  use communicators, only: communicator_t
  use kinds, only: wp
  implicit none
  private
  public :: listed_points_t

  !> The list.
  type :: listed_points_t
    !> Index of each point among those that this rank owns; 0: on another rank
    integer, allocatable :: local(:)
  contains
    procedure :: gathered
    procedure :: to_local
  end type listed_points_t

contains

  !> Values at the points of the list, the same on every rank. Collective.
  function gathered(self, communicator, field) result(values)
    class(listed_points_t), intent(in) :: self
    type(communicator_t), intent(in) :: communicator
    !> (local points)
    real(wp), intent(in) :: field(:)
    real(wp) :: values(size(self%local))
    integer :: i

    values = 0
    do i = 1, size(values)
      if (self%local(i) > 0) values(i) = field(self%local(i))
    end do
    call communicator%sum(values)
  end function gathered

  !> Values of the list at this rank's points, those of points listed more than once added.
  pure function to_local(self, values, points) result(field)
    class(listed_points_t), intent(in) :: self
    real(wp), intent(in) :: values(:)
    !> Number of points of this rank
    integer, intent(in) :: points
    !> (local points); ghosts zero
    real(wp) :: field(points)
    integer :: i

    field = 0
    do i = 1, size(self%local)
      if (self%local(i) > 0) field(self%local(i)) = field(self%local(i)) + values(i)
    end do
  end function to_local
end module listed_points
