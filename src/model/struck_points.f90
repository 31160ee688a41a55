!> The struck point of the plate and the elements around it.
module struck_points
  use communicators, only: communicator_t
  use distributions, only: distribution_t
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: struck_point_t, new_struck_point

  !> The struck node's first point.
  type :: struck_point_t
    !> Its position on the rank that owns it; 0 elsewhere
    integer :: point = 0
    !> This rank's elements around it
    integer, allocatable :: elements(:)
    !> Elements around it on all ranks
    integer :: count = 0
  end type struck_point_t

contains

  !> Finds the point and its elements. Collective.
  type(struck_point_t) function new_struck_point(mesh, distribution, communicator) result(self)
    type(layered_mesh_t), intent(in) :: mesh
    type(distribution_t), intent(in) :: distribution
    type(communicator_t), intent(in) :: communicator
    integer :: i, first

    first = mesh%first_point(mesh%struck_node)
    associate (mine => distribution%elements)
      self%elements = pack([(i, i=1, size(mine))], &
                           [(any(mesh%connectivity(:, mine(i)) == first), i=1, size(mine))])
    end associate
    self%count = size(self%elements)
    call communicator%sum(self%count)
    self%point = distribution%local(first)
    if (self%point > distribution%owned) self%point = 0
  end function new_struck_point
end module struck_points
