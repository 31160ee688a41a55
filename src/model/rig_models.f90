!> How rigs hold this rank's points: which w a frame or a rigid clamp holds, where the plate rests on a frame that it
!> may lift off, and the springs of clamps.
module rig_models
  use kinds, only: wp
  use distributions, only: distribution_t
  use layered_meshes, only: layered_mesh_t
  use mesh_parameters, only: plate_t
  use rigs, only: nodes_on_frame, clamp_nodes, clamp_share
  use support_parameters, only: support_t
  implicit none
  private
  public :: rig_model_t, new_rig_model, hold_by_rigs

  !> The rigs at this rank's points. Only the first point of a node has any part in them.
  type :: rig_model_t
    !> True if the plate rests on a frame that it may lift off
    logical :: unilateral = .false.
    !> True if clamps have springs
    logical :: elastic = .false.
    !> The rig that holds w, or whose frame bears it by pressure; 0: none, (local points); unallocated: no rigs
    integer, allocatable :: holds(:), bears(:)
    !> Stiffness of clamps along u, v and w, (3, local points)
    real(wp), allocatable :: springs(:, :)
    !> The rig that they belong to; 0: none, (local points)
    integer, allocatable :: clamps(:)
  end type rig_model_t

contains

  !> The rigs at a rank's points.
  pure function new_rig_model(mesh, plate, supports, distribution) result(self)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Plate and symmetry
    type(plate_t), intent(in) :: plate
    !> The rigs
    type(support_t), intent(in) :: supports(:)
    !> This rank's points
    type(distribution_t), intent(in) :: distribution
    !> The rigs at its points
    type(rig_model_t) :: self
    integer, allocatable :: nodes(:)
    integer :: i, k, point

    if (size(supports) == 0) return
    allocate (self%holds(size(distribution%points)), self%bears(size(distribution%points)), &
              self%clamps(size(distribution%points)), source=0)
    allocate (self%springs(3, size(distribution%points)), source=0.0_wp)
    do i = 1, size(supports)
      self%unilateral = self%unilateral .or. supports(i)%shape > 0 .and. supports(i)%unilateral
      nodes = pack([(k, k=1, mesh%nodes())], nodes_on_frame(mesh, supports(i)))
      do k = 1, size(nodes)
        point = distribution%local(mesh%first_point(nodes(k)))
        if (point == 0) cycle
        if (supports(i)%unilateral) then
          self%bears(point) = i
        else
          self%holds(point) = i
        end if
      end do
      nodes = clamp_nodes(mesh, plate, supports(i))
      do k = 1, size(nodes)
        point = distribution%local(mesh%first_point(nodes(k)))
        if (point == 0) cycle
        if (supports(i)%clamp_stiffness > 0) then
          self%clamps(point) = i
          self%springs(:, point) = self%springs(:, point) + springs_of(mesh, plate, supports(i))
        else
          self%holds(point) = i
        end if
      end do
    end do
    ! What is held needs no frame to bear it.
    where (self%holds > 0) self%bears = 0
    self%elastic = any(supports%clamp_stiffness > 0)
  end function new_rig_model

  !> Stiffness that one clamp of the deck adds to the model.
  pure function springs_of(mesh, plate, support) result(springs)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Plate and symmetry
    type(plate_t), intent(in) :: plate
    !> The rig
    type(support_t), intent(in) :: support
    !> Along u, v and w
    real(wp) :: springs(3)

    springs = support%clamp_stiffness*clamp_share(mesh)
    if (.not. plate%in_plane_fixed) springs(1:2) = 0
  end function springs_of

  !> Adds the unknowns that rigs hold to a table.
  pure subroutine hold_by_rigs(mesh, plate, supports, held)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Plate and symmetry
    type(plate_t), intent(in) :: plate
    !> The rigs
    type(support_t), intent(in) :: supports(:)
    !> u, v, w, theta_x, theta_y of every point, (5, points)
    logical, intent(inout) :: held(:, :)
    logical, allocatable :: borne(:)
    integer, allocatable :: nodes(:)
    integer :: i, k

    do i = 1, size(supports)
      if (.not. supports(i)%unilateral) then
        borne = nodes_on_frame(mesh, supports(i))
        do k = 1, size(borne)
          if (borne(k)) held(3, mesh%first_point(k)) = .true.
        end do
      end if
      if (supports(i)%clamp_stiffness > 0) cycle
      nodes = clamp_nodes(mesh, plate, supports(i))
      held(3, mesh%first_point(nodes)) = .true.
      if (plate%in_plane_fixed) held(1:2, mesh%first_point(nodes)) = .true.
    end do
  end subroutine hold_by_rigs
end module rig_models
