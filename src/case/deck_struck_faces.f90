!> The struck face of a deck: stiffness and strength of its laminate through the thickness.
module deck_struck_faces
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use held_plies, only: held_modulus, held_strength
  use laminate_parameters, only: laminate_t
  use impact_parameters, only: law_thornton
  use indentation_deck, only: indentation_group, key_face, key_k, key_yield, key_alpha_critical, struck_face_t, &
                              takes_laminate
  use material_deck, only: normal_compliance
  use roundings, only: rounding
  implicit none
  private
  public :: struck_face_of, check_struck_face

contains

  !> Stiffness and strength of the struck face; 0: not known.
  function struck_face_of(deck) result(face)
    !> The deck, with its laminate
    type(deck_t), intent(in) :: deck
    type(struck_face_t) :: face
    type(laminate_t) :: local
    integer :: ply

    if (.not. allocated(deck%setup%laminate%material)) return
    if (size(deck%setup%laminate%material) == 0) return
    local = deck%setup%struck_laminate()
    associate (materials => deck%setup%materials, used => local%material)
      face%compliance = normal_compliance(deck%settings, used(1), materials(used(1)))
      if (.not. takes_laminate(deck%settings)) return
      if (is_complete(deck)) face%modulus = held_modulus(local, materials)
      if (is_complete(deck) .and. all(materials(used)%yc > 0)) &
        face%strength = minval([(held_strength(materials(used(ply))), ply=1, size(used))])
    end associate
  end function struck_face_of

  !> True: all plies have the constants of a fibre-reinforced ply in three dimensions. The compliance of an isotropic
  !> one is not that of its modulus alone.
  logical function is_complete(deck)
    !> The deck, with its laminate
    type(deck_t), intent(in) :: deck
    type(laminate_t) :: local
    integer :: ply

    local = deck%setup%struck_laminate()
    associate (materials => deck%setup%materials, used => local%material)
      is_complete = all(materials(used)%e1 > 0 .and. materials(used)%e2 > 0 .and. materials(used)%nu23 > 0)
      do ply = 1, size(used)
        is_complete = is_complete .and. &
          .not. normal_compliance(deck%settings, used(ply), materials(used(ply)))*materials(used(ply))%e2 < 1 - rounding
      end do
    end associate
  end function is_complete

  !> Reports constants that the face of the laminate needs.
  subroutine check_struck_face(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (.not. (deck%setup%impactor%is_present .and. allocated(deck%setup%laminate%material) .and. &
               takes_laminate(deck%settings))) return
    if (.not. are_clear(deck%settings, problems, indentation_group, key_face)) return
    associate (s => deck%settings, used => deck%setup%laminate%material)
      if (.not. (is_complete(deck) .or. s%is_given(indentation_group, key_k))) then
        call report(s, problems, indentation_group, key_face, 'needs nu23 of every fibre-reinforced ply; give it '// &
                    'in &material, or E3 and face = ''ply''.')
      else if (deck%setup%impactor%indentation%law == law_thornton .and. &
               .not. all(deck%setup%materials(used)%yc > 0) .and. .not. &
               (s%is_given(indentation_group, key_yield) .or. s%is_given(indentation_group, key_alpha_critical))) then
        call report(s, problems, indentation_group, key_face, 'needs YC of every ply for the yield pressure; give '// &
                    'it in &material, or yield_pressure.')
      end if
    end associate
  end subroutine check_struck_face
end module deck_struck_faces
