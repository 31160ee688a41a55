!> Duration of a contact with a heavy impactor, corrected for what the preliminary elastic impact neglects: the
!> stiffness of clamped edges and of membrane forces. It affects the number of steps that is foreseen only.
module contact_durations
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mesh_parameters, only: edge_clamped, edge_free, in_plane_fixed
  use modal_plates, only: shortened_clamped
  use plate_options, only: kinematics_von_karman
  use setup_scales, only: setup_scales_t, bending_section, free_edges, free_span
  use setups, only: setup_t
  use stacking, only: section_t
  implicit none
  private
  public :: stiffened_duration

  !> Membrane stiffness A of circular plates under a central force, P = k w (1 + A (w/h)**2): clamped and simply
  !> supported edges (columns), fixed and free in-plane (rows). S. Timoshenko, S. Woinowsky-Krieger, Theory of
  !> Plates and Shells, 1959, art. 100, table 82.
  real(wp), parameter :: membrane(2, 2) = reshape([0.443_wp, 0.200_wp, 1.430_wp, 0.272_wp], [2, 2])
  !> Central compliance of a clamped isotropic square, 0.00560 a**2/D (ibid., art. 44), over that by one term of Ritz's
  !> method, 0.00513 a**2/D.
  real(wp), parameter :: ritz = 0.00560_wp/0.00513_wp
  !> Fraction of the half period of the impactor on the plate from which on the plate responds quasi-statically. A
  !> shorter contact ends before waves return from the border.
  real(wp), parameter :: quasi_static = 0.8_wp
  !> Modes along each direction of the plate of the elastic impact.
  integer, parameter :: modes = 80

contains

  !> Duration of contact: the half period of the impactor on the plate is proportional to the root of its compliance,
  !> and a spring that stiffens by A (w/h)**2 has the frequency of a linear one that is stiffer by 3/4 of that at the
  !> largest deflection (harmonic balance). That deflection follows from the energy.
  pure real(wp) function stiffened_duration(setup, scales, duration, deflection) result(stiffened)
    type(setup_t), intent(in) :: setup
    !> Its scales
    type(setup_scales_t), intent(in) :: scales
    !> Duration and largest deflection by the elastic impact
    real(wp), intent(in) :: duration, deflection
    real(wp) :: share, square, a

    stiffened = duration
    if (duration < quasi_static*pi*sqrt(setup%impactor%mass*scales%compliance)) return
    ! The compliance of a curved plate includes its membrane forces, and its stiffness decreases at first.
    if (any(abs(setup%plate%curvature_radius) > 0)) return
    share = clamped_share(setup, scales)
    a = 0
    if (setup%kinematics == kinematics_von_karman) &
      a = membrane(merge(1, 2, setup%plate%in_plane == in_plane_fixed .and. any(setup%plate%edges /= edge_free)), &
                   merge(1, 2, all(free_edges(setup) == edge_clamped)))
    ! w**2 (1 + A/2 (w/h)**2) is the square of the deflection without membrane forces.
    square = share*(deflection/scales%thickness)**2
    square = 2*square/(1 + sqrt(1 + 2*a*square))
    stiffened = duration*sqrt(share/(1 + 0.75_wp*a*square))
  end function stiffened_duration

  !> Compliance of a plate clamped at all edges over that of the shorter, simply supported plate of the elastic impact;
  !> 1 for other edges. Both are those of thin plates; shear adds the same to both.
  pure real(wp) function clamped_share(setup, scales) result(share)
    type(setup_t), intent(in) :: setup
    !> Its scales
    type(setup_scales_t), intent(in) :: scales
    type(section_t) :: section
    real(wp) :: length(2), waves(2), stiffness(3), shortened
    integer :: i, j

    share = 1
    if (.not. all(free_edges(setup) == edge_clamped)) return
    section = bending_section(setup)
    length = free_span(setup)
    stiffness = [section%stiffness(13), 2*(section%stiffness(14) + 2*section%stiffness(18)), section%stiffness(16)]
    shortened = 0
    do j = 1, modes
      do i = 1, modes
        waves = [2*i - 1, 2*j - 1]*pi/(shortened_clamped*length)
        shortened = shortened + 4/(product(shortened_clamped*length)* &
                                   dot_product(stiffness, [waves(1)**4, product(waves)**2, waves(2)**4]))
      end do
    end do
    ! One term w (1 - cos(2 pi x/a)) (1 - cos(2 pi y/b))/4.
    waves = 2*pi/length
    share = 1 - (shortened - ritz*64/(product(length)*dot_product(stiffness, [3*waves(1)**4, product(waves)**2, &
                                                                            3*waves(2)**4])))/scales%compliance
  end function clamped_share
end module contact_durations
