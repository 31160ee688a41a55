!> Elements, points and unknowns of the plate, and their distribution over ranks. All are constant in a run; new layers
!> require new ones.
module discretizations
  use border_sums, only: border_sum_t
  use communicators, only: communicator_t
  use distributions, only: distribution_t
  use element_batches, only: element_batches_t
  use halos, only: halo_t
  use kinds, only: wp
  use layer_maps, only: layer_map_t
  use layered_meshes, only: layered_mesh_t
  use profiles, only: profile_t
  use symmetry_images, only: symmetry_images_t
  implicit none
  private
  public :: discretization_t

  !> Mesh, elements and points of this rank. It has many components because ranks, layers and symmetry each have theirs.
  type :: discretization_t
    !> The ranks
    type(communicator_t) :: communicator
    !> Complete mesh of the modelled part, on every rank
    type(layered_mesh_t) :: mesh
    !> Profile of time and memory, if requested
    type(profile_t) :: profile
    !> Distribution over ranks
    type(distribution_t) :: distribution
    !> Exchange of ghost points
    type(halo_t) :: halo
    !> Sums of elements' contributions to points on the borders between ranks: a field assembled by `elements` has
    !> `borders%columns` columns and is summed by `borders%add`, before forces are transformed to unknowns
    type(border_sum_t) :: borders
    !> This rank's elements
    type(element_batches_t) :: elements
    !> True for constrained unknowns of every point of the mesh, (5, points of the mesh)
    logical, allocatable :: fixed(:, :)
    !> Images of the points of a full plate whose symmetry is enforced during failure
    type(symmetry_images_t) :: images
    !> Motion of stacked layers from their unknowns
    type(layer_map_t) :: map
    !> Zone of each of this rank's points; 0: first layer
    integer, allocatable :: zone(:)
    !> True for points next to the border of their zone, where growth ends, (local points)
    logical, allocatable :: beside_border(:)
    !> Position of the struck node's first point on the rank that owns it; 0 elsewhere
    integer :: struck = 0
    !> This rank's elements around the struck node
    integer, allocatable :: struck_elements(:)
    !> Elements around the struck node on all ranks
    integer :: struck_count = 0
    !> True: u and v are zero (linear, no coupling) and have no equations
    logical :: membrane_idle = .false.
  contains
    procedure :: motion_of
    procedure :: deflection
    procedure :: product => field_product
  end type discretization_t

contains

  !> Motion of every layer from the unknowns.
  pure function motion_of(self, unknowns) result(motion)
    class(discretization_t), intent(in) :: self
    !> Unknowns, (5, points)
    real(wp), contiguous, intent(in) :: unknowns(:, :)
    !> Motion of each point's layer, (5, points)
    real(wp), allocatable :: motion(:, :)

    motion = unknowns
    if (self%map%layered) call self%map%to_motion(motion)
  end function motion_of

  !> Deflection at the struck point, the same on every rank.
  real(wp) function deflection(self, displacement) result(w)
    class(discretization_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)

    w = 0
    if (self%struck > 0) w = displacement(3, self%struck)
    call self%communicator%sum(w)
  end function deflection

  !> Product of two fields summed over the owned points of this rank only.
  pure real(wp) function field_product(self, left, right) result(total)
    class(discretization_t), intent(in) :: self
    !> The fields, (5, points)
    real(wp), intent(in) :: left(:, :), right(:, :)

    total = sum(left(:, :self%distribution%owned)*right(:, :self%distribution%owned))
  end function field_product
end module discretizations
