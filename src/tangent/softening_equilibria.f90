!> Equilibrium of softening points on a linear plate. The plate's answers to what is out of balance span a space, in
!> which Newton's method finds the equilibrium; what is then still out of balance asks for the next answer.
!>
!> For a law that does not soften these are conjugate gradients, preconditioned by the factored operator (see Y. Saad,
!> Iterative Methods for Sparse Linear Systems, 2003). The small system is exact about the law in every iteration, so it
!> does not matter how many points pass their onset at once, nor that their tangents are not positive definite. It
!> remembers earlier answers, so the iteration of equilibrium around it starts from what the last one found.
module softening_equilibria
  use errors, only: error_t
  use field_products, only: add_combination, products_of, products_with
  use kinds, only: wp
  use outside_forces, only: outside_force_t
  use plate_answers, only: linear_plate_t, plate_answers_t
  use softening_points, only: softening_points_t
  use softening_systems, only: softening_system_t
  implicit none
  private
  public :: find_equilibrium

  !> Part of the forces out of balance that may be left: the iteration of equilibrium around this one gains no more, as
  !> the operator lags behind von Karman's strains.
  real(wp), parameter :: settled = 0.03_wp
  !> The same of the small system, over what it was before the latest answer.
  real(wp), parameter :: settled_inside = 0.03_wp

  !> The small system. Its unknowns are the shares of the plate's answers.
  type, extends(softening_system_t) :: small_system_t
    !> The plate
    class(linear_plate_t), pointer :: plate => null()
    !> The points
    type(softening_points_t), pointer :: points => null()
    !> Jumps of the points in each answer, (3, points, unknowns)
    real(wp), allocatable :: jumps(:, :, :)
    !> Work of a unit force from outside on each answer, and that of the forces on the plate
    real(wp), allocatable :: unit_works(:), works(:)
    !> Forces of the points, (3, points)
    real(wp), allocatable :: forces(:, :)
    !> Force from outside and its slope
    real(wp) :: load = 0, slope = 0
  contains
    !> What Newton's method asks for.
    procedure :: find_force
    procedure :: find_tangent
    procedure :: is_settled
  end type small_system_t

contains

  !> Change of the plate's motion that brings forces, points and the force from outside into balance, or nearer to it.
  subroutine find_equilibrium(plate, kept, points, outside, pattern, residual, most_answers, change, error, &
                              snaps)
    !> The plate
    class(linear_plate_t), target, intent(inout) :: plate
    !> Its answers so far
    type(plate_answers_t), intent(inout) :: kept
    !> The points
    type(softening_points_t), target, intent(in) :: points
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, target, intent(inout) :: outside
    !> Forces on the plate of a unit force from outside, (5, local points)
    real(wp), intent(in) :: pattern(:, :)
    !> Forces out of balance, (5, local points)
    real(wp), intent(in) :: residual(:, :)
    !> Answers asked for at most
    integer, intent(in) :: most_answers
    !> The plate's own answer to them on entry, the change on return, (5, local points)
    real(wp), intent(inout) :: change(:, :)
    !> Set if the plate does not answer
    type(error_t), allocatable, intent(inout) :: error
    !> Set to true where a tangent is not positive definite, so that there may be other equilibria
    logical, intent(inout), optional :: snaps
    type(small_system_t) :: small
    real(wp), allocatable :: answer(:, :), carried(:, :), imbalance(:, :), shares(:)
    real(wp) :: first
    logical :: added
    integer :: i, k

    answer = change
    allocate (carried, mold=residual)
    imbalance = residual
    first = plate%size(residual)
    allocate (shares(kept%kept), source=0.0_wp)
    small%plate => plate
    small%points => points
    if (allocated(outside)) small%outside => outside
    do i = 0, most_answers
      call kept%add(plate, answer, imbalance, added)
      if (.not. added .and. i > 0) exit
      if (added) shares = [shares, 0.0_wp]
      call renew(small, kept, pattern, residual)
      call small%bring_into_balance(shares)
      call kept%forces_of(shares, carried)
      imbalance = residual - carried + small%load*pattern
      do k = 1, size(points%places)
        associate (place => points%places(k))
          imbalance(1:3, place) = imbalance(1:3, place) - small%forces(:, k)
        end associate
      end do
      if (.not. plate%size(imbalance) > settled*first .or. i == most_answers) exit
      call plate%answer(imbalance, answer, error)
      if (allocated(error)) return
    end do
    call kept%motion_of(shares, change)
    if (present(snaps)) snaps = snaps .or. small%snaps
  end subroutine find_equilibrium

  !> Renews the small system after answers have come.
  subroutine renew(self, kept, pattern, residual)
    !> The system
    type(small_system_t), intent(inout) :: self
    !> The plate's answers
    type(plate_answers_t), intent(in) :: kept
    !> Forces on the plate of a unit force from outside, and those out of balance, (5, local points)
    real(wp), intent(in) :: pattern(:, :), residual(:, :)
    real(wp), allocatable :: jumps(:, :, :)
    integer :: had

    if (.not. allocated(self%jumps)) then
      allocate (self%jumps(3, size(self%points%list), 0), self%forces(3, size(self%points%list)))
      allocate (self%unit_works(0), self%works(0))
    end if
    had = size(self%jumps, 3)
    allocate (jumps(3, size(self%points%list), kept%kept))
    jumps(:, :, :had) = self%jumps
    jumps(:, :, had + 1:) = kept%motions(1:3, self%points%places, had + 1:kept%kept)
    call move_alloc(jumps, self%jumps)
    self%unit_works = [self%unit_works, kept%works(self%plate, pattern, had + 1)]
    self%works = [self%works, kept%works(self%plate, residual, had + 1)]
  end subroutine renew

  !> Force out of balance at some shares.
  subroutine find_force(self, x, force)
    !> The system; receives the forces of the points and that from outside
    class(small_system_t), intent(inout) :: self
    !> The shares, (unknowns)
    real(wp), intent(in) :: x(:)
    !> The force, (unknowns)
    real(wp), intent(out) :: force(:)

    call self%points%find_forces(jumps_of(self, x), self%forces)
    call products_with(self%forces, size(self%forces), size(self%forces), self%jumps, force)
    call self%plate%sum(force)
    self%load = 0
    self%slope = 0
    if (associated(self%outside)) call self%outside%at(dot_product(self%unit_works, x), self%load, self%slope)
    force = force + x - self%works - self%load*self%unit_works
  end subroutine find_force

  !> True once a part of it is left only.
  pure logical function is_settled(self, force)
    !> The system
    class(small_system_t), intent(in) :: self
    !> The force, (unknowns)
    real(wp), intent(in) :: force(:)

    is_settled = .not. norm2(force) > settled_inside*self%first
  end function is_settled

  !> Jumps at some shares.
  function jumps_of(self, shares) result(jumps)
    !> The system
    type(small_system_t), intent(in) :: self
    !> The shares, (unknowns)
    real(wp), intent(in) :: shares(:)
    !> The jumps, (3, points)
    real(wp) :: jumps(3, size(self%jumps, 2))

    jumps = 0
    call add_combination(shares, size(jumps), self%jumps, jumps)
  end function jumps_of

  !> Tangent at the shares.
  subroutine find_tangent(self, x, kind, matrix)
    !> The system
    class(small_system_t), intent(in) :: self
    !> The shares, (unknowns)
    real(wp), intent(in) :: x(:)
    !> Which of the points' derivatives
    integer, intent(in) :: kind
    !> The tangent, (unknowns, unknowns)
    real(wp), allocatable, intent(out) :: matrix(:, :)
    real(wp), allocatable :: slopes(:, :, :), jumps(:, :, :), forces(:, :, :), sums(:)
    integer, allocatable :: found(:)
    integer :: i, k

    call self%points%find_slopes(jumps_of(self, x), kind, found, slopes)
    jumps = self%jumps(:, found, :)
    allocate (forces, mold=jumps)
    do k = 1, size(x)
      do i = 1, size(found)
        forces(:, i, k) = jumps(1, i, k)*slopes(:, 1, i) + jumps(2, i, k)*slopes(:, 2, i) + &
                          jumps(3, i, k)*slopes(:, 3, i)
      end do
    end do
    allocate (sums(size(x)**2))
    call products_of(size(x), 3*size(found), jumps, forces, sums)
    call self%plate%sum(sums)
    matrix = reshape(sums, [size(x), size(x)])
    do k = 1, size(x)
      matrix(:, k) = matrix(:, k) - self%slope*self%unit_works(k)*self%unit_works
      matrix(k, k) = matrix(k, k) + 1
    end do
  end subroutine find_tangent
end module softening_equilibria
