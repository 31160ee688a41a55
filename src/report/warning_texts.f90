!> Sentences of the warnings of a run, with the limits they name.
module warning_texts
  use deck_contents, only: deck_t
  use energy_checks, only: energy_tolerance
  use initial_state_parameters, only: motion_rest
  use kinds, only: wp
  use run_records, only: warning_border, warning_contact, warning_core, warning_energy, warning_perforation, &
                         warning_indentation, warning_kinetic, warning_ledger, warning_loss, warning_scaled, &
                         warning_slopes, warning_steps, warning_membrane, warning_below_nose, &
                         warning_mapping, warning_stringer
  use plate_options, only: max_slope
  use short_numbers, only: short_text
  use steppers, only: stepper_t
  use text, only: to_text
  implicit none
  private
  public :: warning_text

  !> Deflection over thickness beyond which membrane forces carry a clamped plate: in a circular one they carry 0.47
  !> (w/h)**2 times the load that bending carries, four times at 3 (S. Timoshenko, S. Woinowsky-Krieger, Theory of
  !> Plates and Shells, 1959, art. 100).
  real(wp), parameter, public :: max_deflection_ratio = 3
  !> Permitted ratio of kinetic energy to work in slow motion, 5 % (Getting Started with Abaqus, chapter on quasi-static
  !> analysis: 5 to 10 %).
  real(wp), parameter, public :: max_kinetic = 0.05_wp
  !> Permitted fraction of kinetic energy of motions with scaled inertia. Forces and velocities are proportional to the
  !> root of energies: 2 % of energy is 1 % of force, the error permitted for the default factor. On decks of input/ it
  !> is .02 to 1 % (input/peanut.nml to input/small/breaking_bursts.nml).
  real(wp), parameter, public :: max_scaled = 0.02_wp
  !> Permitted fraction of energy that contact dissipates by central differences: 1 % of force, as above. In the impacts
  !> of input/ it is at most .8 % (input/experiments/im7_8552_d7136_30J.nml).
  real(wp), parameter, public :: max_contact = 0.02_wp
  !> Permitted depth of the struck point below the impactor during contact, relative to the thickness: a plate that is
  !> pressed ahead of the nose by more has lost its stiffness there, or is too coarse to follow the nose.
  real(wp), parameter, public :: max_hollow = 0.05_wp

contains

  !> Sentence of a warning.
  pure function warning_text(kind, zone, at, deck, stepper) result(text)
    !> One of the kinds of warnings
    integer, intent(in) :: kind
    !> Its zone; 0: none
    integer, intent(in) :: zone
    !> Its time, such as time 0.001
    character(len=*), intent(in) :: at
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> One sentence
    character(len=:), allocatable :: text

    text = ''
    select case (kind)
    case (warning_border)
      text = 'The delamination below ply '//to_text(deck%delaminations(zone)%below_ply)// &
             ' has reached the border of its zone at '//at// &
             ' and cannot grow further: make the zone larger.'
    case (warning_core)
      text = 'Layers have extended with the damage beyond the core of the mesh since '//at// &
             ', where cells are larger: make the core larger.'
    case (warning_energy)
      text = energy_text('created', stepper%energy_remedy(deck%setup_t, .true.))
    case (warning_loss)
      text = energy_text('dissipated', stepper%energy_remedy(deck%setup_t, .false.))
    case (warning_ledger)
      text = 'The energy error (energy_error) has exceeded '//short_text(100*energy_tolerance)// &
             ' % of the energy since '//at//': '//stepper%ledger_remedy()
    case (warning_kinetic)
      text = 'The kinetic energy of the plate has exceeded '//short_text(100*max_kinetic)//' % of the work of the '// &
             'load since '//at//': the motion is too fast for a quasi-static test; give a longer end or rise.'
    case (warning_scaled)
      text = 'The kinetic energy of motions with scaled inertia has exceeded '//short_text(100*max_scaled)// &
             ' % of the energy since '//at//': use a smaller mass_scaling, or compare with 1.'
    case (warning_contact)
      text = 'Contact of surfaces or with the frame has dissipated more than '//short_text(100*max_contact)// &
             ' % of the energy by '//at//' (energy_contact), as nodes that meet come to rest against each other: '// &
             'compare with a run on finer cells.'
    case (warning_indentation)
      text = 'The indentation has exceeded the thickness of the laminate or the radius of the impactor since '//at// &
             ': no contact law is valid there; use less energy or a larger radius.'
    case (warning_slopes)
      text = 'The slope of the plate has exceeded '//to_text(max_slope)//' since '//at// &
             ': the strains assume moderate rotations; their error is 2 % at that slope and larger at steeper ones.'
    case (warning_steps)
      text = 'The error of steps has exceeded the tolerance of &adapt since '//at// &
             ' at the smallest step, which is too long for waves emitted by failures: compare with a run at an &
               &eighth of the tolerance, which halves the steps.'
    case (warning_membrane)
      text = 'The deflection of the clamped plate has exceeded '//to_text(max_deflection_ratio)// &
             ' thicknesses with failed fibres since '//at// &
             ': membrane forces carry the load, and tearing of plies is not modelled; later results are not valid.'
    case (warning_mapping)
      text = 'The mapping to this mesh has raised the strain energy by more than 1 % of what was stored '// &
             '(energy_strain of `mapping` in the summary): '//mapping_remedy(deck)
    case (warning_stringer)
      text = 'The free edge of a stringer has exceeded its strength (XT, XC of &stringer) since '//at// &
             ': stringers do not fail in this model; later results are not valid where it would.'
    case (warning_perforation)
      text = 'The fibres of every ply have failed over an area as large as the contact since '//at// &
             ': the impactor perforates the plate, which is not modelled; later results are not valid.'
    case (warning_below_nose)
      text = 'The struck point has been deeper than the impactor, during contact, by more than '// &
             to_text(100*max_hollow)//' % of the thickness since '//at// &
             ': '//hollow_remedy(deck)
    end select

  contains

    !> Sentence on an energy above its limit, with a remedy.
    pure function energy_text(what, remedy) result(words)
      !> created or dissipated
      character(len=*), intent(in) :: what
      !> End of the sentence
      character(len=*), intent(in) :: remedy
      !> The sentence
      character(len=:), allocatable :: words

      words = stepper%method_name()//' have '//what//' more than '//short_text(100*energy_tolerance)// &
              ' % of the energy by '//at//' (energy_algorithmic): '//remedy
    end function energy_text
  end function warning_text

  !> Remedy for strain energy raised by a mapping.
  pure function mapping_remedy(deck) result(cure)
    type(deck_t), intent(in) :: deck
    !> End of a sentence
    character(len=:), allocatable :: cure

    if (deck%load_start > 0 .and. deck%initial%motion == motion_rest) then
      cure = 'damage is held until the end of settle, which must bring the plate to rest.'
    else
      cure = 'damage may grow by it; give settle of &time and motion=''rest'', with which damage is held until the '// &
             'plate is at rest, or the mesh of the other run.'
    end if
  end function mapping_remedy

  !> Cause and remedy of a struck point deeper than the impactor.
  pure function hollow_remedy(deck) result(cure)
    type(deck_t), intent(in) :: deck
    !> End of a sentence
    character(len=:), allocatable :: cure

    cure = 'the force on the patch presses its middle ahead of the nose; use &impactor contact_area=''sphere'', or '// &
           'a smaller patch.'
    if (deck%impactor%spreads) cure = 'the plate bends away from the nose, on failed fibres or on cells too large '// &
                                      'to follow it; use shorter cells. The largest deflection includes this.'
  end function hollow_remedy
end module warning_texts
