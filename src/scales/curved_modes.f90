!> Stiffness of the deflection modes of a curved plate by its membrane forces, for estimates before a run.
!>
!> With edges whose displacement across is free, the in-plane displacements of a mode are sines and cosines and are
!> condensed out (Navier's solution of Donnell's equations, W. Soedel, Vibrations of Shells and Plates, 2004, section
!> 6.4). Edges that hold it leave the mean strain of the lines between them. The larger of both stiffnesses is taken:
!> with all edges held the first mode of isotropic and orthotropic squares and rectangles of sides 1 to 2, with one or
!> two curvatures, was 7 % off at most (Ritz's method with 200 terms). Beyond a rise of two thicknesses modes change
!> their shape, and the estimate of the frequency is too high: doc/manual/curved_panels.md.
module curved_modes
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: shallow_shape_t, membrane_mode

  !> Curvature of a plate and what its edges hold.
  type :: shallow_shape_t
    !> Curvatures of the lines along x and along y
    real(wp) :: curvature(2) = 0
    !> True: both ends of these lines are held along them
    logical :: is_held(2) = .false.
    !> Factor of in-plane inertia
    real(wp) :: scaling = 1
  contains
    procedure :: is_flat
  end type shallow_shape_t

contains

  !> True: there is no curvature.
  pure logical function is_flat(self)
    class(shallow_shape_t), intent(in) :: self

    is_flat = .not. any(abs(self%curvature) > 0)
  end function is_flat

  !> Membrane stiffness of a mode per area, and the inertia of its in-plane displacements over that of its deflection.
  pure function membrane_mode(shape, extension, waves, lengths, symmetric) result(mode)
    type(shallow_shape_t), intent(in) :: shape
    !> A11, A12, A16, A22, A26, A66
    real(wp), intent(in) :: extension(6)
    !> Wave numbers along x and y
    real(wp), intent(in) :: waves(2)
    !> Lengths over which the waves extend
    real(wp), intent(in) :: lengths(2)
    !> True: the mode is symmetric about the middle of its lines, which therefore have a mean strain
    logical, intent(in) :: symmetric(2)
    !> Stiffness; inertia, as if edges were free across
    real(wp) :: mode(2)

    mode = 0
    if (shape%is_flat()) return
    mode = with_free_edges(shape%curvature, extension, waves)
    mode(1) = max(mode(1), with_held_edges(shape, extension, waves*lengths/pi, symmetric))
    mode(2) = shape%scaling*mode(2)
  end function membrane_mode

  !> Stiffness and inertia with edges that are free across.
  pure function with_free_edges(curvature, a, waves) result(mode)
    !> Curvatures along x and y
    real(wp), intent(in) :: curvature(2)
    !> Membrane stiffness A11, A12, A16, A22, A26, A66
    real(wp), intent(in) :: a(6)
    !> Wave numbers along x and y
    real(wp), intent(in) :: waves(2)
    !> Membrane stiffness; square of the in-plane displacements
    real(wp) :: mode(2)
    real(wp) :: forces(2), load(2), motion(2), k11, k12, k22

    mode = 0
    if (all(waves <= 0)) return
    forces = [a(1)*curvature(1) + a(2)*curvature(2), a(2)*curvature(1) + a(4)*curvature(2)]
    load = forces*waves
    k11 = a(1)*waves(1)**2 + a(6)*waves(2)**2
    k12 = (a(2) + a(6))*product(waves)
    k22 = a(6)*waves(1)**2 + a(4)*waves(2)**2
    motion = [load(1)*k22 - load(2)*k12, load(2)*k11 - load(1)*k12]/(k11*k22 - k12**2)
    mode = [dot_product(forces, curvature) - dot_product(load, motion), dot_product(motion, motion)]
  end function with_free_edges

  !> Stiffness by the mean strains of lines that are held at both ends: the square of the mean of an odd number n of
  !> half waves over its mean square is 8/(pi n)**2; that of an even number is zero.
  pure real(wp) function with_held_edges(shape, a, number, symmetric) result(stiffness)
    type(shallow_shape_t), intent(in) :: shape
    !> Membrane stiffness A11, A12, A16, A22, A26, A66
    real(wp), intent(in) :: a(6)
    !> Number of half waves along x and y
    real(wp), intent(in) :: number(2)
    !> As in `membrane_mode`
    logical, intent(in) :: symmetric(2)
    real(wp) :: mean(2)

    mean = 0
    where (shape%is_held .and. symmetric) mean = shape%curvature*sqrt(8.0_wp)/(pi*max(1.0_wp, number))
    stiffness = a(1)*mean(1)**2 + 2*a(2)*product(mean) + a(4)*mean(2)**2
    ! Without a force across, the lines contract.
    if (.not. shape%is_held(1)) stiffness = stiffness - (a(2)*mean(2))**2/a(1)
    if (.not. shape%is_held(2)) stiffness = stiffness - (a(2)*mean(1))**2/a(4)
  end function with_held_edges
end module curved_modes
