!> Points constrained to the motion of others: points on the cut line of point symmetry, and all points of a full plate
!> whose symmetry is enforced.
module dependent_points
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use symmetry_images, only: symmetry_images_t
  implicit none
  private
  public :: find_masters

  !> Signs of u, v, w, theta_x, theta_y of a dependent point on the cut of a plate with point symmetry.
  real(wp), parameter :: turned(5) = [-1.0_wp, -1.0_wp, 1.0_wp, -1.0_wp, -1.0_wp]

contains

  !> Finds the master of each point. Components that symmetry would reverse at a point on the centre are fixed.
  pure subroutine find_masters(mesh, master, signs, fixed, images)
    type(layered_mesh_t), intent(in) :: mesh
    !> Master of each point; 0: none, (points)
    integer, intent(out) :: master(:)
    !> Signs by which its motion is multiplied, (5, points)
    real(wp), intent(out) :: signs(:, :)
    !> Fixed unknowns; receives those fixed by symmetry, (5, points)
    logical, intent(inout) :: fixed(:, :)
    !> Images of the points; left out or empty: none
    type(symmetry_images_t), intent(in), optional :: images
    integer :: point

    do point = 1, size(master)
      master(point) = mesh%master(point)
      signs(:, point) = turned
    end do
    if (.not. present(images)) return
    if (allocated(images%points)) call link_images(images, master, signs, fixed)
  end subroutine find_masters

  !> Makes each point dependent on the first of its images, if that has a lower number.
  pure subroutine link_images(images, master, signs, fixed)
    type(symmetry_images_t), intent(in) :: images
    !> Receives the masters, (points)
    integer, intent(inout) :: master(:)
    !> Receives the signs of the points' motion, (5, points)
    real(wp), intent(inout) :: signs(:, :)
    !> Receives the fixed unknowns, (5, points)
    logical, intent(inout) :: fixed(:, :)
    integer :: point, k

    do point = 1, size(master)
      do k = 1, size(images%signs, 2)
        if (images%points(point, k) == point) fixed(:, point) = fixed(:, point) .or. images%signs(:, k) < 0
      end do
      k = minloc(images%points(point, :), dim=1)
      if (images%points(point, k) >= point) cycle
      master(point) = images%points(point, k)
      signs(:, point) = images%signs(:, k)
    end do
  end subroutine link_images
end module dependent_points
