!> Elements in batches of `lanes`, so that every kernel runs over the elements of a batch in its innermost loop:
!> nodes, geometry at the integration points and section of each element, lane first.
module element_batches
  use kinds, only: wp
  use edge_beams, only: edge_beam_t
  use errors, only: error_t, fail, exit_deck
  use lagrange9, only: gauss2, gauss_weights, gauss_xi_slopes, gauss_eta_slopes, &
    gauss2_xi_slopes, gauss2_eta_slopes, shape_gradients
  use plate_options, only: shear_assumed, shear_full, shear_selective
  implicit none
  private
  public :: first_element, batch_of, lane_of

  !> Elements of a batch. Eight doubles fill a cache line and one or two vector registers.
  integer, parameter, public :: lanes = 8

  !> Shear samples of the assumed strains: six for gamma_xi, then six for gamma_eta.
  integer, parameter, public :: shear_samples = 12

  !> Size of the transverse shear of a batch (lane, point, component) at the 9 points that an element has at most, of
  !> which shear_selective uses 4. An array of constant size is not on the heap.
  integer, parameter, public :: shear_size = lanes*9*2

  !> A set of 9-node elements. Element e is in batch `batch_of(e)`, lane `lane_of(e)`; the unused lanes of the last
  !> batch repeat the last element with zero weights and zero section stiffness. It has many components because shear,
  !> shape and beams have theirs.
  type, public :: element_batches_t
    !> Number of elements
    integer :: elements = 0
    !> Number of batches
    integer :: batches = 0
    !> How transverse shear is treated: shear_assumed, shear_full or shear_selective
    integer :: shear = shear_assumed
    !> Number of points where transverse shear is integrated: 9, or 4 for shear_selective
    integer :: shear_points = 9
    !> Point of each node (lanes, 9, batches)
    integer, allocatable :: points(:, :, :)
    !> Column of a field to which the contribution of each node is added, (lanes, 9, batches): its point or, where other
    !> ranks contribute to this point too, a column of its own, from which contributions are added in the order of the
    !> mesh
    integer, allocatable :: targets(:, :, :)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points (lanes, 9, 4, batches)
    real(wp), allocatable :: inverse_jacobian(:, :, :, :)
    !> Area that belongs to each Gauss point (lanes, 9, batches); zero in unused lanes
    real(wp), allocatable :: weight(:, :, :)
    !> As inverse_jacobian and weight, at the points where shear is integrated without assumed strains
    real(wp), allocatable :: shear_inverse_jacobian(:, :, :, :), shear_weight(:, :, :)
    !> Tangent vector x, y of the coordinate line at each sample of the assumed strains (lanes, 12, 2, batches)
    real(wp), allocatable :: shear_tangents(:, :, :, :)
    !> Section stiffness before any damage: A, B, D (11, 12, 16, 22, 26, 66 each), S (xz-xz, xz-yz, yz-yz),
    !> (lanes, 21, batches)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Section mass I0, I1, I2 (lanes, 3, batches)
    real(wp), allocatable :: mass(:, :, :)
    !> Slopes w0,x and w0,y of the stress-free shape (lanes, 9, 2, batches); unallocated: the plate is flat
    real(wp), allocatable :: initial_slopes(:, :, :, :)
    !> Slopes along x and y at the nodes of a surface along which u and v are measured (lanes, 9, 2, batches);
    !> unallocated: they are measured along the plan
    real(wp), allocatable :: surface_slopes(:, :, :, :)
    !> Beams on edges of elements, those of a batch together in the order of its elements; unallocated: none
    type(edge_beam_t), allocatable :: beams(:)
    !> First beam of each batch, (batches + 1); allocated with the beams
    integer, allocatable :: first_beam(:)
  contains
    procedure :: create
    procedure :: set_section
    procedure :: set_targets
    procedure :: lanes_used
    procedure :: has_beams
  end type element_batches_t

contains

  !> Builds the batches from a mesh; sections are zero until set.
  subroutine create(self, coordinates, connectivity, shear, error)
    class(element_batches_t), intent(out) :: self
    !> Position x, y of each point (2, points)
    real(wp), intent(in) :: coordinates(:, :)
    !> Points of the nodes of each element (9, elements)
    integer, intent(in) :: connectivity(:, :)
    !> One of the shear_* choices
    integer, intent(in) :: shear
    !> Raised when an element is inverted or its Jacobian is not positive somewhere
    type(error_t), allocatable, intent(inout) :: error
    integer :: b, lane, element

    self%elements = size(connectivity, 2)
    self%batches = (self%elements + lanes - 1)/lanes
    self%shear = shear
    if (shear == shear_selective) self%shear_points = 4
    call allocate_batches(self)
    do b = 1, self%batches
      do lane = 1, lanes
        element = min(first_element(b) + lane - 1, self%elements)
        self%points(lane, :, b) = connectivity(:, element)
        call set_geometry(self, b, lane, coordinates(:, connectivity(:, element)), element, error)
        if (allocated(error)) return
      end do
      self%weight(self%lanes_used(b) + 1:, :, b) = 0.0_wp
      if (shear /= shear_assumed) self%shear_weight(self%lanes_used(b) + 1:, :, b) = 0.0_wp
    end do
    self%targets = self%points
  end subroutine create

  !> Gives one element its section.
  pure subroutine set_section(self, element, stiffness, mass)
    class(element_batches_t), intent(inout) :: self
    integer, intent(in) :: element
    !> Section stiffness and mass, as in the components of the type
    real(wp), intent(in) :: stiffness(21), mass(3)

    self%stiffness(lane_of(element), :, batch_of(element)) = stiffness
    self%mass(lane_of(element), :, batch_of(element)) = mass
  end subroutine set_section

  !> Sets the columns that contributions are added to; without it these are the points.
  pure subroutine set_targets(self, targets)
    class(element_batches_t), intent(inout) :: self
    !> Column of each node, (9, elements)
    integer, intent(in) :: targets(:, :)
    integer :: b, lane

    do b = 1, self%batches
      do lane = 1, lanes
        self%targets(lane, :, b) = targets(:, min(first_element(b) + lane - 1, self%elements))
      end do
    end do
  end subroutine set_targets

  !> Lanes of a batch that hold elements: all but in the last batch.
  pure integer function lanes_used(self, b)
    class(element_batches_t), intent(in) :: self
    integer, intent(in) :: b

    lanes_used = min(lanes, self%elements - (b - 1)*lanes)
  end function lanes_used

  !> True if there are beams on edges of a batch.
  pure logical function has_beams(self, b)
    class(element_batches_t), intent(in) :: self
    integer, intent(in) :: b

    has_beams = .false.
    if (allocated(self%beams)) has_beams = self%first_beam(b + 1) > self%first_beam(b)
  end function has_beams

  !> Batch that holds an element.
  elemental integer function batch_of(element)
    integer, intent(in) :: element

    batch_of = 1 + (element - 1)/lanes
  end function batch_of

  !> Lane of its batch that holds an element.
  elemental integer function lane_of(element)
    integer, intent(in) :: element

    lane_of = 1 + mod(element - 1, lanes)
  end function lane_of

  !> Element in the first lane of a batch; those in the other lanes follow it.
  pure integer function first_element(b)
    integer, intent(in) :: b

    first_element = (b - 1)*lanes + 1
  end function first_element

  !> Allocates the arrays for this treatment of shear, with zero section stiffness.
  subroutine allocate_batches(self)
    !> The batches, with their counts and their shear set
    type(element_batches_t), intent(inout) :: self

    allocate (self%points(lanes, 9, self%batches))
    allocate (self%inverse_jacobian(lanes, 9, 4, self%batches), self%weight(lanes, 9, self%batches))
    if (self%shear == shear_assumed) then
      allocate (self%shear_tangents(lanes, shear_samples, 2, self%batches))
    else
      allocate (self%shear_inverse_jacobian(lanes, self%shear_points, 4, self%batches))
      allocate (self%shear_weight(lanes, self%shear_points, self%batches))
    end if
    allocate (self%stiffness(lanes, 21, self%batches), self%mass(lanes, 3, self%batches), source=0.0_wp)
  end subroutine allocate_batches

  !> Geometry of one element.
  subroutine set_geometry(self, b, lane, x, element, error)
    type(element_batches_t), intent(inout) :: self
    !> Batch and lane of the element, and its number
    integer, intent(in) :: b, lane, element
    !> Position of its nodes
    real(wp), intent(in) :: x(2, 9)
    !> Raised when the Jacobian is not positive
    type(error_t), allocatable, intent(inout) :: error
    integer :: g
    real(wp) :: determinant

    do g = 1, 9
      call invert_jacobian(x, gauss_xi_slopes(:, g), gauss_eta_slopes(:, g), element, &
                           self%inverse_jacobian(lane, g, :, b), determinant, error)
      if (allocated(error)) return
      self%weight(lane, g, b) = determinant*gauss_weights(g)
    end do
    select case (self%shear)
    case (shear_assumed)
      self%shear_tangents(lane, :, :, b) = sample_tangents(x)
    case (shear_full)
      self%shear_inverse_jacobian(lane, :, :, b) = self%inverse_jacobian(lane, :, :, b)
      self%shear_weight(lane, :, b) = self%weight(lane, :, b)
    case (shear_selective)
      do g = 1, 4
        call invert_jacobian(x, gauss2_xi_slopes(:, g), gauss2_eta_slopes(:, g), element, &
                             self%shear_inverse_jacobian(lane, g, :, b), self%shear_weight(lane, g, b), error)
      end do
    end select
  end subroutine set_geometry

  !> Derivatives of the element's coordinates with respect to x and y at one point.
  subroutine invert_jacobian(x, xi_slopes, eta_slopes, element, inverse, determinant, error)
    !> Position of the nodes
    real(wp), intent(in) :: x(2, 9)
    !> Derivatives of the shape functions at the point
    real(wp), intent(in) :: xi_slopes(9), eta_slopes(9)
    !> Number of the element, for the message
    integer, intent(in) :: element
    !> xi,x eta,x xi,y eta,y
    real(wp), intent(out) :: inverse(4)
    !> Area ratio
    real(wp), intent(out) :: determinant
    !> Raised when the ratio is not positive
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: along_xi(2), along_eta(2)
    character(len=12) :: number

    along_xi = matmul(x, xi_slopes)
    along_eta = matmul(x, eta_slopes)
    determinant = along_xi(1)*along_eta(2) - along_xi(2)*along_eta(1)
    if (.not. determinant > 0.0_wp) then
      write (number, '(i0)') element
      call fail(error, exit_deck, &
                'Element '//trim(number)//' is inverted or too distorted: its Jacobian is not positive.')
      return
    end if
    inverse = [along_eta(2), -along_xi(2), -along_eta(1), along_xi(1)]/determinant
  end subroutine invert_jacobian

  !> Tangent vectors at the samples of the assumed shear strains (Huang and Hinton, 1986): gamma_xi at
  !> xi = -+1/sqrt(3), eta = -1, 0, 1 (sample p + 2 j) and gamma_eta at xi = -1, 0, 1, eta = -+1/sqrt(3)
  !> (sample 6 + p + 2 i).
  pure function sample_tangents(x) result(tangents)
    !> Position of the nodes
    real(wp), intent(in) :: x(2, 9)
    !> Derivative of the position along the sampled coordinate (sample, x or y)
    real(wp) :: tangents(shear_samples, 2)
    integer :: p, row
    real(wp) :: along, across, gradients(9, 2)

    do row = 0, 2
      across = real(row - 1, wp)
      do p = 1, 2
        along = merge(-gauss2, gauss2, p == 1)
        gradients = shape_gradients(along, across)
        tangents(p + 2*row, :) = matmul(x, gradients(:, 1))
        gradients = shape_gradients(across, along)
        tangents(6 + p + 2*row, :) = matmul(x, gradients(:, 2))
      end do
    end do
  end function sample_tangents
end module element_batches
