!> Cohesive law of an interface, theory (D1) to (D3): parameters of the traction against the jumps between two surfaces.
!>
!> The curve is bilinear: linear up to the onset, then linear softening to zero at N times the jump at the onset. The
!> area under it is the toughness of the present mixture of modes (M. L. Benzeggagh and M. Kenane, Composites Science
!> and Technology 56 (1996) 439-449). N is the same for every mixture if stiffnesses and strengths satisfy K_s/K_n =
!> (G_Ic/G_IIc) (tau/sigma)**2 (A. Turon et al., Composite Structures 92 (2010) 1857-1864); the damage is then the only
!> history variable of a point.
module cohesive_laws
  use kinds, only: wp
  use short_numbers, only: text_at_least
  implicit none
  private
  public :: cohesive_law_t, create_cohesive_law, cohesive_objection, stiffness_of, weakened

  !> Stiffness of the law over that of the laminate on its thinner side and the number n of interfaces, K_n h/(n E3).
  !> All interfaces together add at most a tenth to the flexibility through the thickness, as one alone. A factor of ten
  !> up or down changes the radius of a grown delamination by 0.3 to 1.4 %; 5 instead of 50 saves a third of the
  !> iterations of a step.
  real(wp), parameter :: usual_stiffness = 5
  !> Smallest ratio of the jump at failure to the jump at the onset. Its inverse is the part of the toughness that is
  !> stored at the onset: 5 %.
  real(wp), parameter, public :: min_failure_ratio = 20

  !> The law of one interface.
  type :: cohesive_law_t
    !> Stiffness K_n of opening and K_s of shear, and that of closed surfaces, pressure per jump
    real(wp) :: stiffness_opening = 0, stiffness_shear = 0, stiffness_closing = 0
    !> Toughness of pure opening G_Ic and of pure shear G_IIc, energy per area
    real(wp) :: toughness_opening = 0, toughness_shear = 0
    !> Exponent eta of Benzeggagh and Kenane
    real(wp) :: mixing_exponent = 1.75_wp
    !> Strength sigma of pure opening and tau of pure shear
    real(wp) :: strength_opening = 0, strength_shear = 0
    !> Jump at failure over jump at onset, N
    real(wp) :: failure_ratio = 0
  end type cohesive_law_t

contains

  !> The law of an interface. Values that `cohesive_objection` refuses give a law without stiffness.
  pure function create_cohesive_law(toughness, mixing_exponent, strength, stiffness, modulus, thickness) result(law)
    !> G_Ic and G_IIc
    real(wp), intent(in) :: toughness(2)
    !> Exponent eta of Benzeggagh and Kenane
    real(wp), intent(in) :: mixing_exponent
    !> Strengths of opening sigma and of shear tau
    real(wp), intent(in) :: strength(2)
    !> K_n, pressure per jump; 0: derived from the next two
    real(wp), intent(in) :: stiffness
    !> Through-thickness modulus of the adjacent plies, E3
    real(wp), intent(in) :: modulus
    !> Thickness of the laminate on the thinner side of the interface, over the number of interfaces
    real(wp), intent(in) :: thickness
    type(cohesive_law_t) :: law

    law%toughness_opening = toughness(1)
    law%toughness_shear = toughness(2)
    law%mixing_exponent = mixing_exponent
    law%strength_opening = strength(1)
    law%strength_shear = strength(2)
    if (.not. (all(toughness > 0) .and. all(strength > 0))) return
    law%stiffness_opening = stiffness
    if (.not. abs(stiffness) > 0) then
      if (.not. thickness > 0) return
      law%stiffness_opening = max(usual_stiffness*modulus/thickness, min_stiffness(law))
    end if
    law%stiffness_closing = law%stiffness_opening
    law%stiffness_shear = law%stiffness_opening*(toughness(1)/toughness(2))*(strength(2)/strength(1))**2
    law%failure_ratio = min_failure_ratio*law%stiffness_opening/min_stiffness(law)
  end function create_cohesive_law

  !> Smallest stiffness of opening with a softening branch of the ratio `min_failure_ratio`, 10 sigma**2/G_Ic.
  pure real(wp) function min_stiffness(law)
    !> The law, with toughness and strength of opening
    type(cohesive_law_t), intent(in) :: law

    min_stiffness = min_failure_ratio*law%strength_opening**2/(2*law%toughness_opening)
  end function min_stiffness

  !> Objection to the parameters of a law; empty: none.
  pure function cohesive_objection(law) result(objection)
    type(cohesive_law_t), intent(in) :: law
    !> A clause of a message; empty: no objection
    character(len=:), allocatable :: objection

    objection = ''
    if (.not. (positive(law%toughness_opening) .and. positive(law%toughness_shear))) then
      objection = 'the toughnesses G_Ic and G_IIc must be positive'
    else if (.not. positive(law%mixing_exponent)) then
      objection = 'the exponent eta must be positive'
    else if (.not. (positive(law%strength_opening) .and. positive(law%strength_shear))) then
      objection = 'strength_opening and strength_shear must be positive'
    else if (.not. (positive(law%stiffness_opening) .and. positive(law%stiffness_shear))) then
      objection = 'stiffness must be positive'
    else if (law%failure_ratio < min_failure_ratio*(1 - sqrt(epsilon(1.0_wp)))) then
      objection = 'stiffness must be at least '//text_at_least(min_stiffness(law))// &
                  ' (10 strength_opening**2/G_Ic)'
    end if
  end function cohesive_objection

  !> A law with strengths reduced by a factor, of the same stiffness and toughness: its jump at failure is larger. A
  !> reduced stiffness of opening reduces the strength of opening by the root of its factor: the ratio of jumps at
  !> failure and at the onset remains that of all mixtures of modes.
  pure function weakened(law, part, opening) result(weak)
    type(cohesive_law_t), intent(in) :: law
    !> Factor of the strengths, and factor of the stiffness of opening; above 0 and up to 1
    real(wp), intent(in) :: part, opening
    type(cohesive_law_t) :: weak

    weak = law
    if (.not. min(part, opening) < 1) return
    weak%stiffness_opening = opening*law%stiffness_opening
    weak%strength_opening = part*sqrt(opening)*law%strength_opening
    weak%strength_shear = part*law%strength_shear
    weak%failure_ratio = law%failure_ratio/part**2
  end function weakened

  !> True for a positive finite number.
  elemental logical function positive(value)
    real(wp), intent(in) :: value
    positive = value > 0 .and. value <= huge(value)
  end function positive

  !> Stiffnesses of the undamaged interface against two shears and opening.
  pure function stiffness_of(law) result(stiffness)
    type(cohesive_law_t), intent(in) :: law
    !> Pressure per jump
    real(wp) :: stiffness(3)

    stiffness = [law%stiffness_shear, law%stiffness_shear, law%stiffness_opening]
  end function stiffness_of
end module cohesive_laws
