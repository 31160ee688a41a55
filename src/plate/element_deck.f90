!> Kinematics, transverse shear and mass of the element in the deck: rows of its table and their filling.
module element_deck
  use deck_choices, only: code_of
  use deck_settings, only: settings_t
  use deck_vocabulary, only: key_row_length
  use plate_options, only: kinematics_linear, kinematics_von_karman, shear_assumed, shear_full, shear_selective, &
                           mass_consistent, mass_lumped
  implicit none
  private
  public :: fill_kinematics, fill_element

  !> Name that checks across groups use.
  character(len=*), parameter, public :: key_mass = 'mass'
  character(len=key_row_length), parameter, public :: kinematics_rows(*) = [character(len=key_row_length) :: &
    'case | kinematics | choice | 1 | - | ''von_karman'' | von_karman linear | &
      &Strains: with the squares of the slopes (large deflection), or linear.']
  character(len=key_row_length), parameter, public :: element_rows(*) = [character(len=key_row_length) :: &
    'mesh | shear | choice | 1 | - | ''assumed'' | assumed full selective | &
      &Transverse shear of the element: assumed strains, 3 x 3 or 2 x 2 integration.', &
    'mesh | mass | choice | 1 | - | ''consistent'' | consistent lumped | &
      &Mass matrix of the plate.']

contains

  !> Kinematics of the case.
  subroutine fill_kinematics(settings, kinematics)
    type(settings_t), intent(in) :: settings
    !> kinematics_von_karman or kinematics_linear
    integer, intent(out) :: kinematics

    kinematics = code_of(settings%text_of('case', 'kinematics'), 'von_karman linear', &
                         [kinematics_von_karman, kinematics_linear])
  end subroutine fill_kinematics

  !> Transverse shear and mass of the mesh's elements.
  subroutine fill_element(settings, shear, mass)
    type(settings_t), intent(in) :: settings
    !> shear_assumed, shear_full or shear_selective
    integer, intent(out) :: shear
    !> mass_consistent or mass_lumped
    integer, intent(out) :: mass

    shear = code_of(settings%text_of('mesh', 'shear'), 'assumed full selective', &
                    [shear_assumed, shear_full, shear_selective])
    mass = code_of(settings%text_of('mesh', key_mass), 'consistent lumped', [mass_consistent, mass_lumped])
  end subroutine fill_element
end module element_deck
