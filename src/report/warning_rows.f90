!> Warnings of a run that exceeds limits of the model: one row each, with its limit and its sentence. A new warning is a
!> row here, and its condition in `run_warnings`.
module warning_rows
  use deck_contents, only: deck_t
  use energy_checks, only: energy_tolerance
  use initial_state_parameters, only: motion_rest
  use kinds, only: wp
  use plate_options, only: max_slope
  use short_numbers, only: short_text
  use steppers, only: stepper_t
  use text, only: to_text
  implicit none
  private
  public :: kind_of, limit_of, warning_text

  !> One warning.
  type :: warning_row_t
    !> By this name its condition gives it
    character(len=12) :: name
    !> Limit beyond which it is given; 0: its condition has none
    real(wp) :: limit
    !> The sentence with {limit}, {percent} for a hundred times the limit, {at} for the time of the first occurrence,
    !> {ply} for the ply above the interface, {method} for the method of steps, and {remedy}
    character(len=250) :: sentence
  end type warning_row_t

  !> The warnings. Checkpoints have the number of a row, so that new ones follow the last.
  !>
  !> Limits: in a clamped circular plate membrane forces carry 0.47 (w/h)**2 times the load that bending carries, four
  !> times at 3 (S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 1959, art. 100). Kinetic energy in
  !> slow motion 5 % of the work (Getting Started with Abaqus, chapter on quasi-static analysis: 5 to 10 %). Forces
  !> and velocities are proportional to the root of energies: 2 % of the energy in motions with scaled inertia, or
  !> dissipated by contact, is 1 % of force, the error permitted for the default factor; the first is .02 to 1 % on
  !> decks of input/ (input/peanut.nml to input/small/breaking_bursts.nml), the second at most .8 %
  !> (input/experiments/im7_8552_d7136_30J.nml). A plate that is pressed ahead of the nose by more than 5 % of its
  !> thickness has lost its stiffness there, or is too coarse to follow the nose.
  type(warning_row_t), parameter :: rows(*) = [ &
    warning_row_t('border', 0.0_wp, 'The delamination below ply {ply} has reached the border of its zone at {at} and &
      &cannot grow further: make the zone larger.'), &
    warning_row_t('created', energy_tolerance, '{method} have created more than {percent} % of the energy by {at} &
      &(energy_algorithmic): {remedy}'), &
    warning_row_t('dissipated', energy_tolerance, '{method} have dissipated more than {percent} % of the energy by &
      &{at} (energy_algorithmic): {remedy}'), &
    warning_row_t('indentation', 0.0_wp, 'The indentation has exceeded the thickness of the laminate or the radius of &
      &the impactor since {at}: no contact law is valid there; use less energy or a larger radius.'), &
    warning_row_t('slopes', max_slope, 'The slope of the plate has exceeded {limit} since {at}: the strains assume &
      &moderate rotations; their error is 2 % at that slope and larger at steeper ones.'), &
    warning_row_t('membrane', 3.0_wp, 'The deflection of the clamped plate has exceeded {limit} thicknesses with &
      &failed fibres since {at}: membrane forces carry the load, and tearing of plies is not modelled; later results &
      &are not valid.'), &
    warning_row_t('perforation', 0.0_wp, 'The fibres of every ply have failed over an area as large as the contact &
      &since {at}: the impactor perforates the plate, which is not modelled; later results are not valid.'), &
    warning_row_t('core', 0.0_wp, 'Layers have extended with the damage beyond the core of the mesh since {at}, where &
      &cells are larger: make the core larger.'), &
    warning_row_t('steps', 0.0_wp, 'The error of steps has exceeded the tolerance of &adapt since {at} at the smallest &
      &step, which is too long for waves emitted by failures: compare with a run at an eighth of the tolerance, which &
      &halves the steps.'), &
    warning_row_t('ledger', energy_tolerance, 'The energy error (energy_error) has exceeded {percent} % of the energy &
      &since {at}: {remedy}'), &
    warning_row_t('kinetic', 0.05_wp, 'The kinetic energy of the plate has exceeded {percent} % of the work of the &
      &load since {at}: the motion is too fast for a quasi-static test; give a longer end or rise.'), &
    warning_row_t('scaled', 0.02_wp, 'The kinetic energy of motions with scaled inertia has exceeded {percent} % of &
      &the energy since {at}: use a smaller mass_scaling, or compare with 1.'), &
    warning_row_t('contact', 0.02_wp, 'Contact of surfaces or with the frame has dissipated more than {percent} % of &
      &the energy by {at} (energy_contact), as nodes that meet come to rest against each other: compare with a run on &
      &finer cells.'), &
    warning_row_t('below_nose', 0.05_wp, 'The struck point has been deeper than the impactor, during contact, by more &
      &than {percent} % of the thickness since {at}: {remedy}'), &
    warning_row_t('mapping', 0.0_wp, 'The mapping to this mesh has raised the strain energy by more than 1 % of what &
      &was stored (energy_strain of `mapping` in the summary): {remedy}'), &
    warning_row_t('stringer', 0.0_wp, 'The free edge of a stringer has exceeded its strength (XT, XC of &stringer) &
      &since {at}: stringers do not fail in this model; later results are not valid where it would.'), &
    warning_row_t('plies_lost', 0.0_wp, 'Damage of plies was lost in the mapping to this mesh (fibre_damage_area and &
      &matrix_damage_area of `mapping` in the summary): use the mesh of the other run.')]

contains

  !> Number of the row of a warning.
  pure integer function kind_of(name) result(kind)
    character(len=*), intent(in) :: name

    do kind = size(rows), 1, -1
      if (rows(kind)%name == name) return
    end do
  end function kind_of

  !> Limit of a warning.
  pure real(wp) function limit_of(name) result(limit)
    character(len=*), intent(in) :: name

    limit = rows(kind_of(name))%limit
  end function limit_of

  !> Sentence of a warning.
  pure function warning_text(kind, zone, at, deck, stepper) result(text)
    !> Number of its row
    integer, intent(in) :: kind
    !> Its zone; 0: none
    integer, intent(in) :: zone
    !> Its time, such as time 0.001
    character(len=*), intent(in) :: at
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    character(len=:), allocatable :: text
    type(warning_row_t) :: row

    row = rows(kind)
    text = trim(row%sentence)
    call insert('{at}', at)
    call insert('{limit}', to_text(row%limit))
    call insert('{percent}', short_text(100*row%limit))
    if (zone > 0) call insert('{ply}', to_text(deck%setup%delaminations(zone)%below_ply))
    call insert('{method}', stepper%method_name())
    call insert('{remedy}', remedy_of(row%name, deck, stepper))

  contains

    !> Writes words in place of a mark of the sentence.
    pure subroutine insert(mark, words)
      !> The mark, and the words
      character(len=*), intent(in) :: mark, words
      integer :: place

      place = index(text, mark)
      if (place > 0) text = text(:place - 1)//words//text(place + len(mark):)
    end subroutine insert
  end function warning_text

  !> What to do about a warning whose remedy depends on the deck or on the method of steps.
  pure function remedy_of(name, deck, stepper) result(remedy)
    !> Name of the warning
    character(len=*), intent(in) :: name
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> End of its sentence; empty: none
    character(len=:), allocatable :: remedy

    remedy = ''
    select case (name)
    case ('created', 'dissipated')
      remedy = stepper%energy_remedy(deck%setup, name == 'created')
    case ('ledger')
      remedy = stepper%ledger_remedy()
    case ('mapping')
      remedy = 'damage may grow by it; give settle of &time and motion=''rest'', with which damage is held until '// &
               'the plate is at rest, or the mesh of the other run.'
      if (deck%setup%loading%start > 0 .and. deck%setup%initial%motion == motion_rest) &
        remedy = 'damage is held until the end of settle, which must bring the plate to rest.'
    case ('below_nose')
      remedy = 'the force on the patch presses its middle ahead of the nose; use &impactor '// &
               'contact_area=''sphere'', or a smaller patch.'
      if (deck%setup%impactor%spreads) &
        remedy = 'the plate bends away from the nose, on failed fibres or on cells too '// &
        'large to follow it; use shorter cells. The largest deflection includes this.'
    end select
  end function remedy_of
end module warning_rows
