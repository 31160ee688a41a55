!> A plate that is cut from the larger one of another run: its place, and what forbids it.
module deck_plate_cuts
  use deck_comparisons, only: both, short_list
  use deck_contents, only: deck_t
  use initial_state_deck, only: key_cut_at
  use kinds, only: wp
  use mesh_parameters, only: is_halved, symmetry_point
  use plate_cuts, only: plate_cut_t
  use plate_deck, only: key_symmetry
  implicit none
  private
  public :: cut_objection, cut_of, has_same_length, moved_centre

contains

  !> True if nothing is cut from the other run's plate.
  pure logical function has_same_length(deck, old) result(same)
    type(deck_t), intent(in) :: deck, old
    type(plate_cut_t) :: cut

    cut = cut_of(deck)
    same = cut%is_whole(old%setup%plate%length)
  end function has_same_length

  !> Objection to a plate of another length: it has to be cut from that of the other run.
  function cut_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: none
    character(len=:), allocatable :: objection
    type(plate_cut_t) :: cut

    objection = ''
    cut = cut_of(deck)
    if (.not. cut%lies_within(old%setup%plate%length)) then
      objection = both('the plate''s length', short_list(deck%setup%plate%length), short_list(old%setup%plate%length))
      if (any(abs(cut%centre) > 0)) objection = objection//', cut at '//short_list(cut%centre)
      objection = objection//'; allowed: the same, or a plate within that one'
    else if (abs(deck%setup%plate%imperfection) > 0 .or. abs(old%setup%plate%imperfection) > 0) then
      objection = both('the plate''s length', short_list(deck%setup%plate%length), &
                       short_list(old%setup%plate%length))// &
                  '; allowed: the same, as an imperfection is that of the full plate'
    else if (any(abs(cut%centre) > 0 .and. is_halved(deck%setup%plate%symmetry)) .or. &
             (any(abs(cut%centre) > 0) .and. deck%setup%plate%symmetry == symmetry_point)) then
      objection = key_cut_at//' = '//short_list(cut%centre)//' is not on the lines of symmetry; allowed with '// &
                  key_symmetry//' = ''none'''
    end if
  end function cut_objection

  !> The part of the other run's plate that is modelled.
  pure function cut_of(deck) result(cut)
    type(deck_t), intent(in) :: deck
    type(plate_cut_t) :: cut

    cut = plate_cut_t(deck%setup%initial%cut_at, deck%setup%plate%length)
  end function cut_of

  !> Distance along x and y of the centres of zones in both runs: zones are centred on the struck points.
  pure function moved_centre(deck, old) result(distance)
    type(deck_t), intent(in) :: deck, old
    !> Along x and y
    real(wp) :: distance(2)

    distance = abs(deck%setup%initial%cut_at + deck%setup%mesh%struck - old%setup%mesh%struck)
  end function moved_centre
end module deck_plate_cuts
