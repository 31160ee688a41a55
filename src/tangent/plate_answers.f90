!> Motions of a linear plate under forces, found one by one by a solve and kept: they span the space in which softening
!> points are brought into equilibrium. Each does work on the forces of no other, and unit work on its own.
module plate_answers
  use errors, only: error_t
  use field_products, only: add_combination, products_with
  use kinds, only: wp
  implicit none
  private
  public :: linear_plate_t, plate_answers_t

  !> Work of a new motion over what it was before the kept ones were taken out of it below which it is one of them.
  real(wp), parameter :: dependent = 1.0e-10_wp
  !> The same above which they need not be taken out again (Daniel et al., Math. Comp. 30, 1976).
  real(wp), parameter :: free_enough = 0.5_wp

  !> A plate that answers to forces in proportion.
  type, abstract :: linear_plate_t
  contains
    !> Motion under forces.
    procedure(answer_to), deferred :: answer
    !> Sums over the ranks.
    procedure(sum_over), deferred :: sum
    !> Size of forces by which they are held against each other, the same on every rank.
    procedure(size_of), deferred :: size
  end type linear_plate_t

  abstract interface
    !> Motion under forces, ghosts included.
    subroutine answer_to(self, forces, motion, error)
      import :: linear_plate_t, error_t, wp
      !> The plate
      class(linear_plate_t), intent(inout) :: self
      !> Forces at the owned points, (5, local points)
      real(wp), intent(in) :: forces(:, :)
      !> Motion, (5, local points)
      real(wp), intent(inout) :: motion(:, :)
      !> Set if there is none
      type(error_t), allocatable, intent(inout) :: error
    end subroutine answer_to

    !> Sums over the ranks.
    subroutine sum_over(self, sums)
      import :: linear_plate_t, wp
      !> The plate
      class(linear_plate_t), intent(in) :: self
      !> Sums of this rank's owned points on entry, of all on return
      real(wp), intent(inout) :: sums(:)
    end subroutine sum_over

    !> Size of forces, the same on every rank.
    real(wp) function size_of(self, forces)
      import :: linear_plate_t, wp
      !> The plate
      class(linear_plate_t), intent(in) :: self
      !> Forces, (5, local points)
      real(wp), intent(in) :: forces(:, :)
    end function size_of
  end interface

  !> The motions kept.
  type :: plate_answers_t
    !> How many there are
    integer :: kept = 0
    !> Points of this rank, which come first
    integer :: owned = 0
    !> Motions, and the forces that cause them, (5, local points, room)
    real(wp), allocatable :: motions(:, :, :), forces(:, :, :)
  contains
    !> Forgets all.
    procedure :: clear
    !> Adds a motion and its forces.
    procedure :: add
    !> Work of forces on each motion.
    procedure :: works
    !> Work of forces on one motion.
    procedure, private :: work_on
    !> A combination of motions.
    procedure :: motion_of
    !> The same of their forces.
    procedure :: forces_of
  end type plate_answers_t

contains

  !> Forgets all.
  pure subroutine clear(self, points, owned, room)
    !> The motions
    class(plate_answers_t), intent(inout) :: self
    !> Points of this rank, ghosts included and not, and motions at most
    integer, intent(in) :: points, owned, room

    self%kept = 0
    self%owned = owned
    if (.not. allocated(self%motions)) allocate (self%motions(5, points, room), self%forces(5, points, room))
  end subroutine clear

  !> Adds a motion and its forces, freed from those kept, twice where digits are lost.
  subroutine add(self, plate, motion, forces, added)
    !> The motions
    class(plate_answers_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The motion and its forces, (5, local points)
    real(wp), intent(in) :: motion(:, :), forces(:, :)
    !> False: there is no room, or it is a combination of those kept
    logical, intent(out) :: added
    real(wp), allocatable :: new_motion(:, :), new_forces(:, :), shares(:)
    real(wp) :: work, first
    integer :: pass

    added = self%kept < size(self%motions, 3)
    if (.not. added) return
    new_motion = motion
    new_forces = forces
    first = self%work_on(plate, new_motion, new_forces)
    do pass = 1, 2
      shares = -self%works(plate, new_forces, 1)
      call add_combination(shares, size(new_motion), self%motions, new_motion)
      call add_combination(shares, size(new_forces), self%forces, new_forces)
      work = self%work_on(plate, new_motion, new_forces)
      if (work > free_enough*first) exit
    end do
    added = work > dependent*first
    if (.not. added) return
    self%kept = self%kept + 1
    self%motions(:, :, self%kept) = new_motion/sqrt(work)
    self%forces(:, :, self%kept) = new_forces/sqrt(work)
  end subroutine add

  !> Work of forces on a motion, the same on every rank.
  real(wp) function work_on(self, plate, motion, forces) result(work)
    !> The motions
    class(plate_answers_t), intent(in) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> Motion and forces, (5, local points)
    real(wp), intent(in) :: motion(:, :), forces(:, :)
    real(wp) :: works(1)

    call products_with(forces, 5*self%owned, size(motion), motion, works)
    call plate%sum(works)
    work = works(1)
  end function work_on

  !> Work of forces on motions, the same on every rank.
  function works(self, plate, forces, first)
    !> The motions
    class(plate_answers_t), intent(in) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> Forces, (5, local points)
    real(wp), intent(in) :: forces(:, :)
    !> The motion to begin with
    integer, intent(in) :: first
    !> Work, (motions from that on)
    real(wp), allocatable :: works(:)

    allocate (works(self%kept - first + 1))
    if (size(works) == 0) return
    call products_with(forces, 5*self%owned, size(self%motions(:, :, 1)), self%motions(:, :, first:), works)
    call plate%sum(works)
  end function works

  !> A combination of the motions.
  subroutine motion_of(self, shares, motion)
    !> The motions
    class(plate_answers_t), intent(in) :: self
    !> Share of each, (kept)
    real(wp), intent(in) :: shares(:)
    !> The combination, (5, local points)
    real(wp), intent(out) :: motion(:, :)

    motion = 0
    call add_combination(shares, size(motion), self%motions, motion)
  end subroutine motion_of

  !> A combination of the forces.
  subroutine forces_of(self, shares, forces)
    !> The motions
    class(plate_answers_t), intent(in) :: self
    !> Share of each, (kept)
    real(wp), intent(in) :: shares(:)
    !> The combination, (5, local points)
    real(wp), intent(out) :: forces(:, :)

    forces = 0
    call add_combination(shares, size(forces), self%forces, forces)
  end subroutine forces_of
end module plate_answers
