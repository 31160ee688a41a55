!> Contact area of the impactor in central differences: the patch of the deck, or the contact area of a nose.
!>
!> The points are listed in the order of the mesh on every rank, so that mean deflection and force distribution are
!> identical on any number of ranks. The force of a nose is distributed by the deflection at the end of each step
!> (`contact_areas`): a lagged distribution would add energy to the motion.
module struck_patches
  use archives, only: archive_t
  use contact_areas, only: edge_gap
  use kinds, only: wp
  use models, only: model_t
  implicit none
  private
  public :: struck_patch_t, create_struck_patch

  !> The points within reach.
  type :: struck_patch_t
    !> Index of each point among those of this rank; 0: on another rank, (reached)
    integer, allocatable :: local(:)
    !> Weights of the deck's patch, area of the point outside the patch, and height of the nose's surface above its tip,
    !> (reached)
    real(wp), allocatable, private :: under(:), beside(:), rise(:)
    !> Weights of the force distribution, and inverse inertia of w, (reached)
    real(wp), allocatable :: weights(:), inverse(:)
    !> Offset of the mean deflection due to earlier changes of the weights
    real(wp) :: offset = 0
    !> True: the distribution follows the shape of the nose
    logical, private :: depends_on_deflection = .false.
    !> Area of the modelled part of the deck's patch
    real(wp), private :: area = 0
  contains
    !> Deflections of the points.
    procedure :: find_deflections
    !> Gathers the inverse inertia of the points.
    procedure :: gather
    !> Deflection under the impactor.
    procedure :: mean
    !> Updates the force distribution.
    procedure :: update_weights
    !> Adds the nodal forces of a force.
    procedure :: add_force
    !> Weights at this rank's points.
    procedure :: local_weights
    !> Saves or loads.
    procedure :: visit
  end type struck_patch_t

contains

  !> The points within reach of the impactor. Collective.
  function create_struck_patch(model) result(self)
    type(model_t), intent(in) :: model
    !> The points
    type(struck_patch_t) :: self
    real(wp) :: fields(4, model%mesh%points()), list(4*model%mesh%points())
    integer, allocatable :: reached(:)
    integer :: i

    fields = 0
    associate (partition => model%distribution)
      do i = 1, partition%owned
        if (allocated(model%nose)) then
          associate (nose => model%nose)
            fields(1:3, partition%points(i)) = [nose%under(i), nose%beside(i), nose%rise(i)]
          end associate
        else
          fields(1, partition%points(i)) = model%patch%weights(i)
        end if
        fields(4, partition%points(i)) = i
      end do
      list = reshape(fields, [size(list)])
      where (.not. abs(list) > 0) list = 0
      if (model%communicator%size > 1) then
        list(4::4) = 0
        call model%communicator%sum(list)
      end if
      fields = reshape(list, shape(fields))
      reached = pack([(i, i=1, size(fields, 2))], abs(fields(1, :)) + abs(fields(2, :)) > 0)
      self%local = partition%local(reached)
      where (self%local > partition%owned) self%local = 0
    end associate
    self%under = fields(1, reached)
    self%beside = fields(2, reached)
    self%rise = fields(3, reached)
    self%weights = self%under
    self%depends_on_deflection = allocated(model%nose)
    if (self%depends_on_deflection) self%area = model%nose%area
  end function create_struck_patch

  !> Deflections of the points and that of the struck point, the same on every rank: one message. Collective.
  subroutine find_deflections(self, model, displacement, w, struck)
    !> The points
    class(struck_patch_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> (reached)
    real(wp), intent(out) :: w(:)
    !> At the struck point
    real(wp), intent(out) :: struck
    real(wp) :: list(size(w) + 1)
    integer :: i

    list = 0
    do i = 1, size(w)
      if (self%local(i) > 0) list(i) = displacement(3, self%local(i))
    end do
    if (model%struck > 0) list(size(list)) = displacement(3, model%struck)
    call model%communicator%sum(list)
    w = list(:size(w))
    struck = list(size(list))
  end subroutine find_deflections

  !> Gathers the inverse inertia of the points from their ranks. Collective.
  subroutine gather(self, model, inverse)
    !> The points
    class(struck_patch_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Inverse inertia of w, (points)
    real(wp), intent(in) :: inverse(:)
    integer :: i

    if (.not. allocated(self%inverse)) allocate (self%inverse(size(self%local)))
    self%inverse = 0
    do i = 1, size(self%local)
      if (self%local(i) > 0) self%inverse(i) = inverse(self%local(i))
    end do
    call model%communicator%sum(self%inverse)
  end subroutine gather

  !> Deflection under the impactor.
  pure real(wp) function mean(self, w)
    !> The points
    class(struck_patch_t), intent(in) :: self
    !> Their deflections, (reached)
    real(wp), intent(in) :: w(:)

    mean = dot_product(self%weights, w) + self%offset
  end function mean

  !> Updates the force distribution by the contact of the nose with the deflected plate. The indentation remains
  !> continuous.
  pure subroutine update_weights(self, w, indentation)
    !> The points
    class(struck_patch_t), intent(inout) :: self
    !> Their deflections, (reached)
    real(wp), intent(in) :: w(:)
    !> The indentation; without it the patch is loaded
    real(wp), intent(in) :: indentation
    real(wp) :: pressure(size(w)), weights(size(w)), sums(2)

    if (.not. self%depends_on_deflection) return
    weights = self%under
    if (indentation > 0) then
      pressure = max(0.0_wp, edge_gap*indentation + minval(w + self%rise) - (w + self%rise))
      sums = [self%area*dot_product(self%under, pressure), dot_product(self%beside, pressure)]
      if (sum(sums) > 0) weights = (sums(1)*self%under + self%beside*pressure)/sum(sums)
    end if
    self%offset = self%offset - dot_product(weights - self%weights, w)
    self%weights = weights
  end subroutine update_weights

  !> Adds the nodal forces of a force on the full plate.
  pure subroutine add_force(self, multiplicity, force, forces)
    !> The points
    class(struck_patch_t), intent(in) :: self
    !> Models that make up the full plate
    integer, intent(in) :: multiplicity
    !> The force
    real(wp), intent(in) :: force
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%local)
      if (self%local(i) > 0) forces(3, self%local(i)) = forces(3, self%local(i)) + force/multiplicity*self%weights(i)
    end do
  end subroutine add_force

  !> Weights at this rank's points.
  pure function local_weights(self, points) result(weights)
    !> The points
    class(struck_patch_t), intent(in) :: self
    !> Number of points of this rank
    integer, intent(in) :: points
    !> (points)
    real(wp) :: weights(points)
    integer :: i

    weights = 0
    do i = 1, size(self%local)
      if (self%local(i) > 0) weights(self%local(i)) = self%weights(i)
    end do
  end function local_weights

  !> Saves or loads.
  subroutine visit(self, archive)
    !> The points
    class(struck_patch_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call archive%item('explicit/patch_weights', self%weights)
    call archive%item('explicit/patch_offset', self%offset)
  end subroutine visit
end module struck_patches
