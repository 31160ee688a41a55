!> Parameters of impactor and indentation law in the deck.
module impact_parameters
  use kinds, only: wp
  implicit none
  private
  public :: impactor_parameters_t, indentation_law_t

  !> Time integrators of the impactor.
  integer, parameter, public :: integrator_gear4 = 1, integrator_trapezoidal = 2, &
                                integrator_central = 3, integrator_conserving = 4
  !> Indentation laws: Tan and Sun's (Eq. 3), elastic Hertz, or Thornton's elastic-plastic one.
  integer, parameter, public :: law_tan_sun = 1, law_hertz = 2, law_thornton = 3
  !> Permanent dent: Tan and Sun's linear one, or Yang and Sun's.
  integer, parameter, public :: dent_tan_sun = 1, dent_yang_sun = 2

  !> Force against indentation (Eq. 3 of the paper with a reloading branch).
  type :: indentation_law_t
    !> True: the deck has the group
    logical :: is_given = .false.
    !> law_tan_sun, law_hertz or law_thornton
    integer :: law = law_tan_sun
    !> Contact stiffness, F = k alpha**1.5
    real(wp) :: k = 0
    !> Exponent of unloading
    real(wp) :: q = 2.5_wp
    !> Exponent of reloading after separation
    real(wp) :: reload = 1.5_wp
    !> Slope of Tan and Sun's dent
    real(wp) :: beta = 0.094_wp
    !> Indentation above which a dent remains; with Thornton's law that at which the struck face yields
    real(wp) :: alpha_critical = 0
    !> dent_tan_sun or dent_yang_sun
    integer :: dent = dent_tan_sun
  end type indentation_law_t

  !> The rigid impactor.
  type :: impactor_parameters_t
    !> True: the deck has an impactor
    logical :: is_present = .false.
    !> Mass
    real(wp) :: mass = 0
    !> Velocity at first contact, positive towards the plate
    real(wp) :: velocity = 0
    !> Prescribed travel from first contact, in load steps or in time by central differences; 0: free motion
    real(wp) :: travel = 0
    !> Rise time of the velocity of a travel in time
    real(wp) :: rise = 0
    !> Radius of the nose, for Sun's formula for k and the area of contact
    real(wp) :: radius = 0
    !> Acceleration of gravity along the impact direction; 0: none
    real(wp) :: gravity = 0
    !> True: its force acts where the nose touches the face; false: on the patch
    logical :: spreads = .false.
    !> The struck point, from the plate's centre
    real(wp) :: at(2) = 0
    !> One of the integrators above
    integer :: integrator = integrator_gear4
    !> Force against indentation of the face under it
    type(indentation_law_t) :: indentation
  end type impactor_parameters_t
end module impact_parameters
