!> Small meshes, sections and dense solves for the tests of the plate element.
module small_plates
  use kinds, only: wp
  use errors, only: error_t
  use plate_options, only: kinematics_linear
  use element_batches, only: element_batches_t, lanes
  use element_tangents, only: tangent
  implicit none
  private
  public :: rectangle, distort, curve, elements_of, matrix_of, solve, coupled_section, isotropic_section, noise
  public :: eigenvalues, times

  !> Mass of the test sections, with I1 as in an eccentric layer.
  real(wp), parameter, public :: test_mass(3) = [2.0_wp, 0.3_wp, 0.1_wp]

  interface
    !> LAPACK: eigenvalues of a symmetric matrix.
    subroutine dsyev(jobz, uplo, n, a, lda, w, work, lwork, info)
      import :: wp
      character(len=1), intent(in) :: jobz, uplo
      integer, intent(in) :: n, lda, lwork
      real(wp), intent(inout) :: a(lda, *)
      real(wp), intent(out) :: w(*), work(*)
      integer, intent(out) :: info
    end subroutine dsyev

    !> LAPACK: solution with a symmetric positive definite matrix.
    subroutine dposv(uplo, n, nrhs, a, lda, b, ldb, info)
      import :: wp
      character(len=1), intent(in) :: uplo
      integer, intent(in) :: n, nrhs, lda, ldb
      real(wp), intent(inout) :: a(lda, *), b(ldb, *)
      integer, intent(out) :: info
    end subroutine dposv
  end interface

contains

  !> Regular mesh of the rectangle from the origin.
  subroutine rectangle(nx, ny, lx, ly, x, connectivity)
    !> Elements along x and y
    integer, intent(in) :: nx, ny
    !> Side lengths
    real(wp), intent(in) :: lx, ly
    !> Positions (2, points)
    real(wp), allocatable, intent(out) :: x(:, :)
    !> Nodes (9, elements)
    integer, allocatable, intent(out) :: connectivity(:, :)
    integer :: i, j, k, l, row

    row = 2*nx + 1
    allocate (x(2, row*(2*ny + 1)), connectivity(9, nx*ny))
    do j = 0, 2*ny
      do i = 0, 2*nx
        x(:, 1 + i + row*j) = [lx*i/(2*nx), ly*j/(2*ny)]
      end do
    end do
    do j = 0, ny - 1
      do i = 0, nx - 1
        do l = 0, 2
          do k = 0, 2
            connectivity(1 + k + 3*l, 1 + i + nx*j) = 1 + 2*i + k + row*(2*j + l)
          end do
        end do
      end do
    end do
  end subroutine rectangle

  !> Moves every corner of every element, keeping the sides straight.
  subroutine distort(amount, x, connectivity)
    !> Largest move
    real(wp), intent(in) :: amount
    !> Positions (2, points)
    real(wp), intent(inout) :: x(:, :)
    !> Nodes (9, elements)
    integer, intent(in) :: connectivity(:, :)
    real(wp) :: corners(2, size(x, 2))
    integer :: e, p

    do p = 1, size(x, 2)
      corners(:, p) = x(:, p) + amount*[sin(2.3_wp*p), cos(1.7_wp*p*p)]
    end do
    do e = 1, size(connectivity, 2)
      associate (n => connectivity(:, e))
        x(:, n([1, 3, 7, 9])) = corners(:, n([1, 3, 7, 9]))
        x(:, n(2)) = (corners(:, n(1)) + corners(:, n(3)))/2
        x(:, n(4)) = (corners(:, n(1)) + corners(:, n(7)))/2
        x(:, n(6)) = (corners(:, n(3)) + corners(:, n(9)))/2
        x(:, n(8)) = (corners(:, n(7)) + corners(:, n(9)))/2
        x(:, n(5)) = (corners(:, n(1)) + corners(:, n(3)) + corners(:, n(7)) + corners(:, n(9)))/4
      end associate
    end do
  end subroutine distort

  !> Distorts the lines of a mesh of the unit-scaled square smoothly, its border unchanged: curved sides.
  subroutine curve(amount, side, x)
    !> Largest move over the side
    real(wp), intent(in) :: amount
    !> Side of the square
    real(wp), intent(in) :: side
    !> Positions (2, points)
    real(wp), intent(inout) :: x(:, :)
    real(wp), parameter :: pi = acos(-1.0_wp)
    real(wp) :: bump(size(x, 2))

    bump = amount*side*sin(pi*x(1, :)/side)*sin(pi*x(2, :)/side)
    x(1, :) = x(1, :) + bump
    x(2, :) = x(2, :) + bump
  end subroutine curve

  !> Batches with one section everywhere.
  subroutine elements_of(x, connectivity, shear, section, batches)
    !> Positions (2, points)
    real(wp), intent(in) :: x(:, :)
    !> Nodes (9, elements)
    integer, intent(in) :: connectivity(:, :)
    !> One of the shear_* choices
    integer, intent(in) :: shear
    !> Section stiffness
    real(wp), intent(in) :: section(21)
    !> The elements
    type(element_batches_t), intent(out) :: batches
    type(error_t), allocatable :: error
    integer :: e

    call batches%create(x, connectivity, shear, error)
    if (allocated(error)) error stop 'a mesh of the tests is wrong'
    do e = 1, batches%elements
      call batches%set_section(e, section, test_mass)
    end do
  end subroutine elements_of

  !> Positive definite section with all couplings.
  function coupled_section() result(section)
    !> The 21 numbers
    real(wp) :: section(21)

    section(1:6) = [10.0_wp, 3.0_wp, 0.7_wp, 8.0_wp, -0.4_wp, 4.0_wp]
    section(7:12) = [0.6_wp, 0.1_wp, 0.2_wp, -0.5_wp, 0.15_wp, 0.1_wp]
    section(13:18) = [1.0_wp, 0.3_wp, 0.1_wp, 0.9_wp, -0.05_wp, 0.4_wp]
    section(19:21) = [3.0_wp, 0.2_wp, 2.5_wp]
  end function coupled_section

  !> Isotropic plate of unit bending stiffness.
  function isotropic_section(nu, thickness) result(section)
    !> Poisson's ratio and thickness
    real(wp), intent(in) :: nu, thickness
    !> The 21 numbers
    real(wp) :: section(21)

    section = 0.0_wp
    section(13:18) = [1.0_wp, nu, 0.0_wp, 1.0_wp, 0.0_wp, (1.0_wp - nu)/2]
    section(1:6) = 12.0_wp/thickness**2*section(13:18)
    section([19, 21]) = 5.0_wp/6.0_wp*section(6)
  end function isotropic_section

  !> Pseudo-random numbers between -1 and 1 that are the same in every run.
  function noise(points, seed) result(u)
    !> Number of points and number of the sequence
    integer, intent(in) :: points, seed
    !> Values (5, points)
    real(wp) :: u(5, points)
    integer :: i, p

    do p = 1, points
      do i = 1, 5
        u(i, p) = sin(12.9898_wp*(i + 5*p) + 78.233_wp*seed*i)
      end do
    end do
  end function noise

  !> Matrix of the mesh, assembled from those of its elements.
  function matrix_of(batches, kinematics, u, stiffness_factor, mass_factor) result(matrix)
    !> The elements
    type(element_batches_t), intent(in) :: batches
    !> One of the kinematics_* choices
    integer, intent(in) :: kinematics
    !> Unknowns
    real(wp), contiguous, intent(in) :: u(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> The matrix, unknown = 5 (point - 1) + component
    real(wp), allocatable :: matrix(:, :)
    real(wp), allocatable :: k(:, :, :)
    integer :: b, lane, row, column, dofs(45)

    allocate (matrix(size(u), size(u)), source=0.0_wp)
    allocate (k(lanes, 45, 45))
    do b = 1, batches%batches
      call tangent(batches, b, batches%stiffness(:, :, b), kinematics, u, stiffness_factor, mass_factor, k)
      do lane = 1, batches%lanes_used(b)
        dofs = [((5*(batches%points(lane, row, b) - 1) + column, column=1, 5), row=1, 9)]
        matrix(dofs, dofs) = matrix(dofs, dofs) + k(lane, :, :)
      end do
    end do
  end function matrix_of

  !> A matrix times unknowns.
  function times(matrix, u) result(f)
    !> The matrix, unknown = 5 (point - 1) + component
    real(wp), intent(in) :: matrix(:, :)
    !> Unknowns (5, points)
    real(wp), intent(in) :: u(:, :)
    !> Forces (5, points)
    real(wp) :: f(5, size(u, 2))
    real(wp) :: column(size(u))

    column = reshape(u, [size(u)])
    f = reshape(matmul(matrix, column), shape(u))
  end function times

  !> Linear solution with some unknowns constrained to given values.
  subroutine solve(batches, load, held, u)
    !> The elements
    type(element_batches_t), intent(in) :: batches
    !> Forces (5, points)
    real(wp), intent(in) :: load(:, :)
    !> Unknowns that are constrained (5, points)
    logical, intent(in) :: held(:, :)
    !> Values of the constrained unknowns on entry, solution on return (5, points)
    real(wp), contiguous, intent(inout) :: u(:, :)
    real(wp), allocatable :: matrix(:, :), reduced(:, :), right(:)
    real(wp) :: full(size(u)), forces(5, size(u, 2))
    integer, allocatable :: free(:)
    integer :: i, info

    free = pack([(i, i=1, size(u))], .not. reshape(held, [size(u)]))
    allocate (matrix, source=matrix_of(batches, kinematics_linear, u, 1.0_wp, 0.0_wp))
    forces = load - times(matrix, merge(u, 0.0_wp, held))
    right = pack(forces, .not. held)
    allocate (reduced, source=matrix(free, free))
    call dposv('U', size(free), 1, reduced, size(free), right, size(free), info)
    if (info /= 0) error stop 'a matrix of the tests is not positive definite'
    full = reshape(u, [size(u)])
    full(free) = right
    u = reshape(full, shape(u))
  end subroutine solve

  !> Eigenvalues of a symmetric matrix, ascending.
  function eigenvalues(matrix) result(values)
    !> The matrix
    real(wp), intent(in) :: matrix(:, :)
    !> Its eigenvalues
    real(wp) :: values(size(matrix, 1))
    real(wp) :: copy(size(matrix, 1), size(matrix, 1)), work(10*size(matrix, 1))
    integer :: info

    copy = matrix
    call dsyev('N', 'U', size(copy, 1), copy, size(copy, 1), values, work, size(work), info)
  end function eigenvalues
end module small_plates
