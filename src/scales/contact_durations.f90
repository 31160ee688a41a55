!> Duration of a contact with a heavy impactor, corrected for what the preliminary elastic impact neglects: the
!> stiffness of membrane forces, and delaminations. It affects the number of steps that is
!> foreseen only.
module contact_durations
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mesh_parameters, only: edge_clamped, edge_free, in_plane_fixed
  use plate_options, only: kinematics_von_karman
  use setup_scales, only: setup_scales_t, free_edges
  use setups, only: setup_t
  implicit none
  private
  public :: stiffened_duration

  !> Membrane stiffness A of circular plates under a central force, P = k w (1 + A (w/h)**2): clamped and simply
  !> supported edges (columns), fixed and free in-plane (rows). S. Timoshenko, S. Woinowsky-Krieger, Theory of
  !> Plates and Shells, 1959, art. 100, table 82.
  real(wp), parameter :: membrane(2, 2) = reshape([0.443_wp, 0.200_wp, 1.430_wp, 0.272_wp], [2, 2])
  !> Fraction of the half period of the impactor on the plate from which on the plate responds quasi-statically. A
  !> shorter contact ends before waves return from the border.
  real(wp), parameter :: quasi_static = 0.8_wp
  !> Points of the quadrature over a quarter period: to 1e-3 with the bend at the limit.
  integer, parameter :: points = 128

  !> Restoring force of a plate over its deflection, in units of thickness and initial stiffness.
  type :: plate_spring_t
    !> Membrane stiffness A
    real(wp) :: membrane = 0
    !> Deflection from which on the force by bending is constant
    real(wp) :: limit = huge(1.0_wp)
  contains
    procedure :: energy_at
    procedure :: recovered
    procedure :: deflection_of
  end type plate_spring_t

contains

  !> Duration of contact of the impactor with a spring: the bending stiffness of the plate beside its membrane
  !> stiffness, P = k w + k A w (w/h)**2. Where interfaces may delaminate, the force by bending remains at the
  !> delamination threshold force, under which n equal delaminations grow at any radius, and unloading follows the
  !> reduced stiffness then, towards the origin. Membrane forces are not reduced by delaminations.
  pure real(wp) function stiffened_duration(setup, scales, duration, deflection) result(stiffened)
    type(setup_t), intent(in) :: setup
    type(setup_scales_t), intent(in) :: scales
    !> Duration and largest deflection by the elastic impact
    real(wp), intent(in) :: duration, deflection
    type(plate_spring_t) :: spring
    real(wp) :: linear, largest, energy, rebound, loading, unloading, u, angle
    integer :: i

    stiffened = duration
    if (duration < quasi_static*pi*sqrt(setup%impactor%mass*scales%compliance)) return
    ! The compliance of a curved plate includes its membrane forces, and its stiffness decreases at first.
    if (setup%mesh%kinematics == kinematics_von_karman .and. all(abs(setup%plate%curvature_radius) <= 0)) &
      spring%membrane = membrane(merge(1, 2, setup%plate%in_plane == in_plane_fixed .and. &
                                       any(setup%plate%edges /= edge_free)), &
                                 merge(1, 2, all(free_edges(setup) == edge_clamped)))
    if (scales%threshold > 0) spring%limit = scales%threshold*scales%compliance/scales%thickness
    linear = deflection/scales%thickness
    energy = linear**2/2
    largest = spring%deflection_of(energy)
    rebound = spring%recovered(largest, largest)
    loading = 0
    unloading = 0
    do i = 1, points
      angle = (i - 0.5_wp)*pi/(2*points)
      u = largest*sin(angle)
      loading = loading + cos(angle)/sqrt(1 - spring%energy_at(u)/energy)
      unloading = unloading + cos(angle)/sqrt((rebound - spring%recovered(u, largest))/energy)
    end do
    stiffened = duration*scales%thickness/deflection*largest*(loading + unloading)/(2*points)
  end function stiffened_duration

  !> Energy of the spring while it is loaded up to a deflection.
  elemental real(wp) function energy_at(self, deflection) result(energy)
    class(plate_spring_t), intent(in) :: self
    !> Over the thickness
    real(wp), intent(in) :: deflection

    associate (bent => min(deflection, self%limit))
      energy = bent*(deflection - bent/2) + self%membrane*deflection**4/4
    end associate
  end function energy_at

  !> Energy that it returns from a deflection back to zero.
  elemental real(wp) function recovered(self, deflection, largest) result(energy)
    class(plate_spring_t), intent(in) :: self
    !> The deflection and the largest one before
    real(wp), intent(in) :: deflection, largest

    energy = min(self%limit, largest)/largest*deflection**2/2 + self%membrane*deflection**4/4
  end function recovered

  !> Deflection at an energy, by bisection: the linear plate deflects by no less, the one at its limit by no more
  !> without membrane forces.
  elemental real(wp) function deflection_of(self, energy) result(deflection)
    class(plate_spring_t), intent(in) :: self
    real(wp), intent(in) :: energy
    real(wp) :: low, high
    integer :: i

    low = 0
    high = sqrt(2*energy)
    if (high > self%limit) high = energy/self%limit + self%limit/2
    do i = 1, digits(1.0_wp)
      deflection = (low + high)/2
      if (self%energy_at(deflection) < energy) then
        low = deflection
      else
        high = deflection
      end if
    end do
    deflection = high
  end function deflection_of
end module contact_durations
