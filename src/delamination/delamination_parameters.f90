!> Parameters of the delamination of one interface in the deck.
module delamination_parameters
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: delamination_t, interface_objection, toughness_objection, default_starter, default_smoothing, toughnesses, &
            law_of

  !> Models of delamination: cohesive law of tractions against jumps, or ties released at a front by the energy release
  !> rate.
  integer, parameter, public :: law_front = 1, law_cohesive = 2
  !> Methods for the energy release rate: strain states on both sides of the front (Eq. 11 with corrected sign), or
  !> virtual crack closure.
  integer, parameter, public :: release_two_state = 1, release_vcct = 2
  !> Growth: cells are released while time is held constant until no front exceeds its toughness, or one cell per step
  !> (section 3.3.3 of the paper).
  integer, parameter, public :: growth_equilibrium = 1, growth_one_per_step = 2
  !> Ties of intact surfaces: jumps are eliminated, or penalised as in the paper.
  integer, parameter, public :: tie_eliminate = 1, tie_penalty = 2
  !> Contact of delaminated surfaces.
  integer, parameter, public :: contact_augmented_lagrangian = 1, contact_continuous_penalty = 2, contact_none = 3
  !> Surfaces while the impactor rebounds: contact, or glued (Eq. 13b).
  integer, parameter, public :: unloading_contact = 1, unloading_glued = 2

  !> Growth of cohesive damage beside delaminated points: by the strengths alone, or from the energy release rate.
  integer, parameter, public :: growth_by_strength = 1, growth_by_energy = 2

  !> One interface that may delaminate. It has many components because two laws share
  !> one group of the deck.
  type :: delamination_t
    !> The interface lies below this ply; 0 with doublers: it is their bond to the struck face
    integer :: below_ply = 0
    !> The bond of doublers: their indices, 0 for an unknown name; unallocated: an interface between plies of the
    !> laminate
    integer, allocatable :: doublers(:)
    !> Numbers of the plies of these doublers that adjoin the laminate
    integer, allocatable :: beside(:)
    !> Index of its group in the deck
    integer :: group = 1
    !> Critical energy release rate of every mode, G_c; 0: the mixed-mode values below hold
    real(wp) :: toughness = 0
    !> Critical energy release rate of pure opening, G_Ic, and of pure shear, G_IIc
    real(wp) :: toughness_opening = 0, toughness_shear = 0
    !> Exponent eta of Benzeggagh and Kenane
    real(wp) :: mixing_exponent = 1.75_wp
    !> Full extents of the layered rectangle along x and y; if it is adaptive, the present extents
    real(wp) :: zone(2) = 0
    !> Its centre, from the struck point: elsewhere only where the rectangle is adaptive and the damage is that of
    !> another run
    real(wp) :: zone_at(2) = 0
    !> True: the layered rectangle is adaptive
    logical :: is_adaptive = .false.
    !> Side of the square starter, or diameter of the round one
    real(wp) :: starter = 0
    !> True: the starter is round
    logical :: starter_round = .false.
    !> Its centre, from the struck point
    real(wp) :: starter_at(2) = 0
    !> First and last x of a starter across the full width of the zone, if the first is smaller
    real(wp) :: starter_strip(2) = 0
    !> law_front or law_cohesive
    integer :: law = law_front
    !> Strengths of the cohesive law in opening and shear
    real(wp) :: strength_opening = 0, strength_shear = 0
    !> Stiffness K_n of the cohesive law, pressure per jump; 0: from E2 of the plies
    real(wp) :: stiffness = 0
    !> Coulomb's coefficient of friction between separated surfaces
    real(wp) :: friction = 0
    !> growth_by_strength or growth_by_energy
    integer :: growth_control = growth_by_energy
    !> True: reduced strengths beside cracks of the adjacent plies
    logical :: cracks_as_flaws = .false.
    !> True: beside cracks by transverse shear in an adjacent ply, damage of the interface starts at the shear stress at
    !> which the ply cracks
    logical :: shear_cracks = .false.
    !> Strength factor of cracks_as_flaws: the fraction of the strengths for which the cells resolve the process zone
    real(wp) :: flaw_strength = 1
    !> release_two_state or release_vcct
    integer :: energy_release = release_vcct
    !> growth_equilibrium or growth_one_per_step
    integer :: growth = growth_equilibrium
    !> tie_eliminate or tie_penalty
    integer :: tie = tie_eliminate
    !> Stiffness of penalty ties, force per volume (pressure per jump); 0: chosen from the layers' stiffness
    real(wp) :: penalty_stiffness = 0
    !> One of the contact methods above
    integer :: contact = contact_augmented_lagrangian
    !> Exponent q of Eq. 12
    real(wp) :: contact_exponent = 1
    !> unloading_contact or unloading_glued
    integer :: unloading = unloading_contact
    !> Distance along a front over which forces and openings are averaged; 0: from cells and thickness
    real(wp) :: smoothing = 0
  contains
    procedure :: bonds_doublers
    procedure :: has_strip
    procedure :: is_on_front
  end type delamination_t

  !> Smallest number of cells over which a front is smoothed. On stepped discs rates then scatter by 2 to 7 % about
  !> their mean, with 3 cells by 4 to 13 %. In a cross-ply with cells of 1 mm fronts release .97 of the energy recorded
  !> as fracture energy, with a distance of 2.6 cells .84 of it.
  integer, parameter, public :: min_smoothed_cells = 5

  !> Keys whose values must be equal in two runs for one to start with the damage of the other.
  character(len=*), parameter, public :: law_names(*) = [character(len=16) :: 'law', 'G_c', 'G_Ic', 'G_IIc', 'eta', &
    'strength_opening', 'strength_shear', 'stiffness', 'friction', 'cracks_as_flaws', 'shear_cracks']

contains

  !> True for the bond between the laminate and doublers.
  pure logical function bonds_doublers(self)
    class(delamination_t), intent(in) :: self

    bonds_doublers = allocated(self%doublers)
  end function bonds_doublers

  !> True for a starter across the full width. Its front runs along y and advances along x.
  pure logical function has_strip(self)
    class(delamination_t), intent(in) :: self

    has_strip = self%starter_strip(1) < self%starter_strip(2)
  end function has_strip

  !> True for the bond of doublers on the struck face.
  pure logical function is_on_front(self)
    class(delamination_t), intent(in) :: self

    is_on_front = self%bonds_doublers() .and. self%below_ply == 0
  end function is_on_front

  !> Values of these keys.
  pure function law_of(delamination) result(numbers)
    type(delamination_t), intent(in) :: delamination
    !> In the order of their names; the law by its number in the list of the deck
    real(wp) :: numbers(size(law_names))

    associate (d => delamination)
      numbers = [real(d%law, wp), d%toughness, d%toughness_opening, d%toughness_shear, d%mixing_exponent, &
                 d%strength_opening, d%strength_shear, d%stiffness, d%friction, &
                 real([merge(1, 0, d%cracks_as_flaws), merge(1, 0, d%shear_cracks)], wp)]
    end associate
  end function law_of

  !> Default distance over which a front is smoothed: stresses near a front vary over a thickness, so that a smaller
  !> distance resolves nothing more.
  pure real(wp) function default_smoothing(thickness, cell) result(distance)
    !> Thickness of the laminate, and length of the mean cell
    real(wp), intent(in) :: thickness, cell

    distance = max(thickness, min_smoothed_cells*cell)
  end function default_smoothing

  !> Side of a starter that covers 0.05 % of the plate, as in section 3.3.2 of the paper.
  pure real(wp) function default_starter(length) result(side)
    real(wp), intent(in) :: length(2)

    side = sqrt(5.0e-4_wp*product(length))
  end function default_starter

  !> Objection to the position of an interface; empty: none.
  pure function interface_objection(delamination, plies) result(objection)
    type(delamination_t), intent(in) :: delamination
    !> Number of plies of the laminate
    integer, intent(in) :: plies
    !> A clause of a message on below_ply; empty: no objection
    character(len=:), allocatable :: objection

    objection = ''
    if (delamination%bonds_doublers()) return
    if (delamination%below_ply < 1) then
      objection = 'there is none, as all plies have one angle and material; leave &delamination out, or list plies'
    else if (delamination%below_ply >= plies) then
      objection = 'below ply '//to_text(delamination%below_ply)//' of '//to_text(plies)//' there is no other ply'
    end if
  end function interface_objection

  !> Objection to the combination of toughnesses; empty: none.
  pure function toughness_objection(delamination) result(objection)
    type(delamination_t), intent(in) :: delamination
    !> A clause of a message; empty: no objection
    character(len=:), allocatable :: objection

    objection = ''
    associate (d => delamination)
      if (d%toughness > 0) then
        if (d%toughness_opening > 0 .or. d%toughness_shear > 0) &
          objection = 'give either G_c or G_Ic and G_IIc, not both'
      else if (d%toughness_opening <= 0 .or. d%toughness_shear <= 0) then
        objection = 'give a positive G_c, or positive G_Ic and G_IIc'
      end if
    end associate
  end function toughness_objection

  !> Toughnesses of opening and shear.
  pure function toughnesses(delamination) result(toughness)
    type(delamination_t), intent(in) :: delamination
    !> G_Ic and G_IIc
    real(wp) :: toughness(2)

    toughness = [delamination%toughness_opening, delamination%toughness_shear]
    if (delamination%toughness > 0) toughness = delamination%toughness
  end function toughnesses
end module delamination_parameters
