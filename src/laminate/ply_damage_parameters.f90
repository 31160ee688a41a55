!> Parameters of ply damage in the deck.
module ply_damage_parameters
  use kinds, only: wp
  implicit none
  private
  public :: ply_damage_t, numbers_of

  !> Ways a ply fails (Table 1 of the paper), and their number.
  integer, parameter, public :: fibre_failure = 1, matrix_cracking = 2, matrix_crushing = 3, failure_modes = 3
  !> Sets of failure criteria: those of Hou et al. (Table 1), of Hashin (1980), of Puck (1998), of Davila et
  !> al. (2005).
  integer, parameter, public :: criteria_hou = 1
  integer, parameter, public :: criteria_hashin = 2, criteria_puck = 3, criteria_larc = 4

  !> Modes in which plies with fracture energies dissipate, the order of their toughnesses, and their number.
  integer, parameter, public :: fibre_tension = 1, fibre_compression = 2, matrix_tension = 3, matrix_compression = 4, &
                                energy_modes = 4

  !> Position in a ply at which the stresses are evaluated: its mid-plane, or both faces, of which the larger index
  !> applies.
  integer, parameter, public :: stress_at_middle = 1, stress_at_faces = 2

  !> Properties that must be equal in two runs for one to start with the damage of the other, by their names in the
  !> deck.
  character(len=*), parameter, public :: damage_names(*) = [character(len=17) :: 'd', 'e', 'criteria', 'stress', &
    'in_situ', 'permanent_shear', 'crack_closure', 'fibre_compression', 'weibull_modulus', 'reference_volume', &
    'strength_seed', 'strength_length']

  !> When plies fail, and how a failed ply loses its stiffness (Table 2 of the paper).
  type :: ply_damage_t
    !> True: plies can fail
    logical :: is_present = .false.
    !> Divisor of the elastic constants affected by a mode of failure
    real(wp) :: d = 100
    !> Smallest value of an elastic constant, as a fraction of the undamaged one
    real(wp) :: e = 1.0e-3_wp
    !> criteria_hou, criteria_hashin, criteria_puck or criteria_larc
    integer :: criteria = criteria_hou
    !> stress_at_middle or stress_at_faces
    integer :: stress = stress_at_middle
    !> True: in-situ strengths of the matrix
    logical :: in_situ = .false.
    !> True: shear strain beyond s12/G12 is permanent, otherwise shear unloads to the origin
    logical :: permanent_shear = .false.
    !> True: tensile cracks carry compression
    logical :: crack_closure = .false.
    !> True: compressed fibres fail by kinking, otherwise at XC
    logical :: kinking = .false.
    !> Weibull modulus of the tensile strength of fibres; 0: it does not depend on the stressed volume
    real(wp) :: weibull_modulus = 0
    !> Stressed volume for which XT holds
    real(wp) :: reference_volume = 0
    !> Seed of the strengths of fibres drawn by position; 0: strengths do not scatter
    integer :: strength_seed = 0
    !> Side of the squares of a ply within which its strength is uniform
    real(wp) :: strength_length = 0
  contains
    procedure :: scatters
  end type ply_damage_t

contains

  !> True: strengths of fibres are drawn by position, instead of that of the stressed volume of each block.
  pure logical function scatters(self)
    class(ply_damage_t), intent(in) :: self

    scatters = self%weibull_modulus > 0 .and. self%strength_seed > 0
  end function scatters

  !> Numbers of the damage in the order of their names; choices by their number in the list of the deck.
  pure function numbers_of(damage) result(numbers)
    type(ply_damage_t), intent(in) :: damage
    real(wp) :: numbers(size(damage_names))

    numbers = [damage%d, damage%e, real([damage%criteria, damage%stress, &
                                         merge(1, 0, [damage%in_situ, damage%permanent_shear, damage%crack_closure, &
                                                      damage%kinking])], wp), damage%weibull_modulus, &
               damage%reference_volume, real(damage%strength_seed, wp), damage%strength_length]
  end function numbers_of
end module ply_damage_parameters
