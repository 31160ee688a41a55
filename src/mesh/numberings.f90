!> Equations: one for every free unknown, numbered rank by rank, and the pattern of the matrix. Numbered again when
!> unknowns are released.
!>
!> Constrained points have the equations of their masters, except for signs: points on the cut line of point symmetry,
!> and all points of a full plate whose symmetry is enforced. A vector thus contains every free motion once, a field
!> contains the motion of all points.
module numberings
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use dependent_points, only: find_masters
  use distributions, only: distribution_t
  use matrix_patterns, only: find_pattern
  use symmetry_images, only: symmetry_images_t
  implicit none
  private
  public :: numbering_t, number_equations

  !> Equation numbers and the rows of this rank.
  type :: numbering_t
    !> Equation (from 0) of each unknown of this rank's points, with ghosts; -1: fixed, (5, local points)
    integer, allocatable :: equation(:, :)
    !> First row of this rank, its rows, and all rows
    integer :: first_row = 0, rows = 0, total = 0
    !> Points that this rank owns
    integer :: owned = 0
    !> True: some point of the mesh has the motion of a master
    logical :: has_dependent_points = .false.
    !> Master of each point on this rank, or the point itself if its master is on another rank; 0: none, (local points)
    integer, allocatable :: master(:)
    !> Signs of its motion, (5, local points)
    real(wp), allocatable :: signs(:, :)
    !> Points that have the same equations, including the point itself, (local points)
    integer, allocatable :: shared_by(:)
    !> True: the pattern leaves out the coupling of in-plane displacements with bending
    logical :: is_separate = .false.
    !> Pattern of this rank's rows: start of each row (from 1) and columns (from 0, ascending)
    integer, allocatable :: row_start(:), columns(:)
    !> Point and component of each row of this rank, (2, rows)
    integer, allocatable, private :: places(:, :)
  contains
    procedure :: owns
    procedure :: place_of
    procedure :: gather
    procedure :: scatter
    procedure :: fold
    procedure :: spread
  end type numbering_t

contains

  !> Numbers the unconstrained unknowns and finds the pattern of this rank's rows.
  subroutine number_equations(mesh, distribution, fixed, self, images, is_separate)
    type(layered_mesh_t), intent(in) :: mesh
    !> Owners of the points
    type(distribution_t), intent(in) :: distribution
    !> Fixed unknowns of every point of the mesh, (5, points)
    logical, intent(in) :: fixed(:, :)
    type(numbering_t), intent(out) :: self
    !> Images of the points, all images of a point on one rank; left out: none
    type(symmetry_images_t), intent(in), optional :: images
    !> True: in-plane displacements are not coupled with bending; left out: they are
    logical, intent(in), optional :: is_separate
    real(wp) :: signs(5, mesh%points())
    integer :: equation(5, mesh%points()), master(mesh%points()), point, i
    logical :: free(5, mesh%points()), folded

    folded = .false.
    if (present(images)) folded = allocated(images%points)
    free = fixed
    call find_masters(mesh, master, signs, free, images)
    free = .not. free
    self%has_dependent_points = any(master > 0)
    do point = 1, size(master)
      if (master(point) > 0) free(:, point) = .false.
    end do
    call number_all(distribution, free, equation)
    self%total = count(free)
    self%owned = distribution%owned
    self%rows = count(free(:, distribution%points(:distribution%owned)))
    self%first_row = first_row_of(equation, distribution)
    do point = 1, size(master)
      if (master(point) > 0) equation(:, point) = equation(:, master(point))
    end do
    self%equation = equation(:, distribution%points)
    self%master = master(distribution%points)
    self%signs = signs(:, distribution%points)
    do i = 1, size(self%master)
      if (self%master(i) > 0) self%master(i) = merge(distribution%local(self%master(i)), i, &
                                                     distribution%local(self%master(i)) > 0)
    end do
    allocate (self%shared_by(size(self%master)), source=1)
    do i = 1, distribution%owned
      if (self%master(i) > 0) self%shared_by(self%master(i)) = self%shared_by(self%master(i)) + 1
    end do
    do i = 1, distribution%owned
      if (self%master(i) > 0) self%shared_by(i) = self%shared_by(self%master(i))
    end do
    call find_places(self)
    call find_pattern(mesh, equation, mesh%point_node(distribution%points(self%places(1, :))), &
                      self%row_start, self%columns, folded)
    if (present(is_separate)) self%is_separate = is_separate
    if (self%is_separate) call drop_coupling(self, equation)
  end subroutine number_equations

  !> Removes the columns of bending from the rows of in-plane displacements, and the reverse.
  pure subroutine drop_coupling(self, equation)
    type(numbering_t), intent(inout) :: self
    integer, intent(in) :: equation(:, :)
    logical :: in_plane(-1:self%total - 1), kept(size(self%columns))
    integer :: row, i, row_start(size(self%row_start))

    in_plane = .false.
    do i = 1, size(equation, 2)
      in_plane(equation(1:2, i)) = .true.
    end do
    row_start(1) = 1
    do row = 1, self%rows
      associate (first => self%row_start(row), last => self%row_start(row + 1) - 1)
        kept(first:last) = in_plane(self%columns(first:last)) .eqv. in_plane(self%first_row + row - 1)
        row_start(row + 1) = row_start(row) + count(kept(first:last))
      end associate
    end do
    self%columns = pack(self%columns, kept)
    self%row_start = row_start
  end subroutine drop_coupling

  !> Point and component of each row.
  pure subroutine find_places(self)
    type(numbering_t), intent(inout) :: self
    integer :: point, component

    allocate (self%places(2, self%rows))
    do point = 1, self%owned
      if (self%master(point) > 0) cycle
      do component = 1, 5
        if (self%equation(component, point) < 0) cycle
        self%places(:, self%equation(component, point) - self%first_row + 1) = [point, component]
      end do
    end do
  end subroutine find_places

  !> True if this rank has an equation.
  pure logical function owns(self, equation)
    class(numbering_t), intent(in) :: self
    !> Equation, from 0
    integer, intent(in) :: equation

    owns = equation >= self%first_row .and. equation < self%first_row + self%rows
  end function owns

  !> Point and component of an equation of this rank.
  pure subroutine place_of(self, equation, point, component)
    class(numbering_t), intent(in) :: self
    !> Equation, from 0
    integer, intent(in) :: equation
    !> Position of the point among this rank's, and component, 1 to 5
    integer, intent(out) :: point, component

    point = self%places(1, equation - self%first_row + 1)
    component = self%places(2, equation - self%first_row + 1)
  end subroutine place_of

  !> Equation numbers of every point of the mesh, in rank order.
  subroutine number_all(distribution, free, equation)
    !> Rank order of the points
    type(distribution_t), intent(in) :: distribution
    !> Unknowns that get one
    logical, intent(in) :: free(:, :)
    !> Equations, from 0; -1: fixed
    integer, intent(out) :: equation(:, :)
    integer :: in_order(size(free, 2)), place, component, next

    in_order(distribution%number + 1) = [(place, place=1, size(in_order))]
    next = 0
    equation = -1
    do place = 1, size(in_order)
      do component = 1, 5
        if (.not. free(component, in_order(place))) cycle
        equation(component, in_order(place)) = next
        next = next + 1
      end do
    end do
  end subroutine number_all

  !> Number of rows before this rank's.
  pure integer function first_row_of(equation, distribution) result(first)
    integer, intent(in) :: equation(:, :)
    !> Owners
    type(distribution_t), intent(in) :: distribution
    integer :: point, start

    start = huge(1)
    if (size(distribution%points) > 0) start = distribution%number(distribution%points(1))
    first = 0
    do point = 1, size(equation, 2)
      if (distribution%number(point) < start) first = first + count(equation(:, point) >= 0)
    end do
  end function first_row_of

  !> Rows of this rank from a field of forces over its points.
  pure subroutine gather(self, field, vector)
    class(numbering_t), intent(in) :: self
    !> (5, local points)
    real(wp), intent(in) :: field(:, :)
    !> (rows)
    real(wp), intent(out) :: vector(:)
    integer :: point, component, row

    row = 0
    do point = 1, self%owned
      if (self%master(point) > 0) cycle
      do component = 1, 5
        if (self%equation(component, point) < 0) cycle
        row = row + 1
        vector(row) = field(component, point)
      end do
    end do
    do point = 1, self%owned
      if (self%master(point) == 0) cycle
      do component = 1, 5
        if (self%equation(component, point) < 0) cycle
        row = self%equation(component, point) - self%first_row + 1
        vector(row) = vector(row) + self%signs(component, point)*field(component, point)
      end do
    end do
  end subroutine gather

  !> Field of motion over the owned points from the rows of this rank; constrained unknowns become zero, ghosts are not
  !> changed.
  pure subroutine scatter(self, vector, field)
    class(numbering_t), intent(in) :: self
    !> (rows)
    real(wp), intent(in) :: vector(:)
    !> (5, local points)
    real(wp), intent(inout) :: field(:, :)
    integer :: point, component, row

    row = 0
    do point = 1, self%owned
      if (self%master(point) > 0) cycle
      do component = 1, 5
        if (self%equation(component, point) < 0) then
          field(component, point) = 0
        else
          row = row + 1
          field(component, point) = vector(row)
        end if
      end do
    end do
    call self%spread(field)
  end subroutine scatter

  !> Adds forces on this rank's dependent points to those on their masters, and sets them to zero.
  pure subroutine fold(self, field)
    class(numbering_t), intent(in) :: self
    !> The first components of forces or of stiffness, (up to 5, local points)
    real(wp), intent(inout) :: field(:, :)
    integer :: point

    do point = 1, self%owned
      if (self%master(point) == 0) cycle
      field(:, self%master(point)) = field(:, self%master(point)) + self%signs(:size(field, 1), point)*field(:, point)
      field(:, point) = 0
    end do
  end subroutine fold

  !> Sets the motion of this rank's dependent points to that of their masters.
  pure subroutine spread(self, field)
    class(numbering_t), intent(in) :: self
    !> (5, local points)
    real(wp), intent(inout) :: field(:, :)
    integer :: point

    do point = 1, self%owned
      if (self%master(point) > 0) field(:, point) = self%signs(:, point)*field(:, self%master(point))
    end do
  end subroutine spread
end module numberings
