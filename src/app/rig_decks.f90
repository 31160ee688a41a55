!> The decks that `implam new --rig NAME` writes: a drop-weight test after ASTM D7136 on a panel with the thickness and
!> energy of the standard, and its compression after impact after ASTM D7137.
module rig_decks
  implicit none
  private

  public :: rig_lines, is_rig

  !> Names of rigs with a deck, which is also that of its file.
  character(len=*), parameter, public :: rig_names(*) = ['d7136', 'd7137']
  !> Lines of the deck.
  character(len=110), parameter :: d7136_lines(*) = [character(len=110) :: &
    '! Drop-weight test after ASTM D7136 on a quasi-isotropic panel: 100 x 150 mm over a window of 75 x 125 mm,', &
    '! [45/0/-45/90]4s of 4 to 6 mm, a hemisphere of 16 mm and 5.5 kg, 6.7 J per mm of thickness. AITM 1-0010 has', &
    '! the same panel, window and nose. `implam explain GROUP` lists all keys of a group, with their defaults,', &
    '! doc/manual/which_interfaces.md and which_cells.md how to choose values.', &
    '', &
    '&case         units=''SI'' /                   ! m, kg, s, N, Pa, J', &
    '&plate        length=150e-3, 100e-3  edges=''free''  in_plane=''free''', &
    '              symmetry=''point'' /             ! half is modelled; the other half is its image', &
    '&support      window=125e-3, 75e-3  unilateral=.true.  bearing=''edge'' /   ! frame, which it may lift off', &
    '&support      clamps=50e-3,44e-3, -50e-3,44e-3, 50e-3,-44e-3, -50e-3,-44e-3', &
    '              clamp_force=1100 /             ! each, the least that the standard allows', &
    '', &
    '&mesh         elements=20, 30                ! of the modelled half', &
    '              core=72e-3, 54e-3  cell=3e-3   ! equal cells at the damage, larger ones outside', &
    '              patch=2e-3                     ! least side of the loaded square', &
    '              lines_x=67e-3  lines_y=45e-3 / ! of the fixture of d7137.nml, which goes on from here', &
    '! 3 mm is for a first estimate. `implam check` reports which cells the interfaces and plies require;', &
    '! cell=1.5e-3 with elements=34, 50 takes some ten times as long.', &
    '', &
    '&material     name=''ply''  library=''im7_8552'' /   ! `implam explain materials` lists values and sources;', &
    '                                             ! keys given here replace them, such as E1=165e9', &
    '&laminate     materials=''ply''  stacking=''[45/0/-45/90]4s''  ply_thickness=0.131e-3 /   ! 4.19 mm', &
    '', &
    '&impactor     mass=5.5  energy=28.1          ! 6.7 J/mm times 4.19 mm', &
    '              radius=8e-3  contact_area=''sphere'' /', &
    '&indentation  law=''thornton''  face=''laminate'' /   ! stiffness and strength through its thickness', &
    '', &
    '&ply_damage   criteria=''hashin''  in_situ=.true. /', &
    '&delamination below_ply=''between_angles''     ! toughness is that of the library', &
    '              friction=0.3  shear_cracks=.true. /', &
    '', &
    '&time         integrator=''central_difference'' /   ! it ends after the impactor has left', &
    '&output       directory=''results''  fields_every=1e-3  checkpoint_every=1e-3 /', &
    '! Strength after impact: `implam new --rig d7137` writes the deck of the compression.']
  character(len=110), parameter :: d7137_lines(*) = [character(len=110) :: &
    '! Compression after impact after ASTM D7137 on the panel of d7136.nml (`implam new --rig d7136`), which has to', &
    '! run first. Ends are clamped on both faces, sides are on knife edges, and the ends approach by 1.2 mm: the', &
    '! panel fails. `implam explain GROUP` lists all keys of a group; doc/manual/compression_after_impact.md says', &
    '! how to choose cells, shortening and rate. Change both decks alike: plate, cells, material, laminate.', &
    '', &
    '&case         units=''SI'' /                   ! m, kg, s, N, Pa, J', &
    '&plate        length=150e-3, 100e-3  edges=''free''  in_plane=''free''', &
    '              symmetry=''point'' /             ! as in the impact', &
    '&support      window=134e-3, 90e-3  bearing=''face''  sides=''edge'' /   ! fixture, 8 mm of each end clamped', &
    '', &
    '&mesh         elements=20, 30  core=72e-3, 54e-3  cell=3e-3  patch=2e-3   ! those of the impact', &
    '              lines_x=62.5e-3  lines_y=37.5e-3 /      ! of the frame of the impact', &
    '! Crushed fibres localize: `implam check` says which cells G_fc requires at the middle of the panel.', &
    '', &
    '&material     name=''ply''  library=''im7_8552'' /', &
    '&laminate     materials=''ply''  stacking=''[45/0/-45/90]4s''  ply_thickness=0.131e-3 /', &
    '', &
    '&initial_state from=''results/d7136_restart.h5'' /   ! the undamaged panel has none, but &plate imperfection', &
    '                                             ! and &delamination zone', &
    '&line         at=75e-3  component=''u''  displacement=-0.6e-3  rise=1e-3 /   ! one end; the other is its image', &
    '', &
    '&ply_damage   criteria=''hashin''  in_situ=.true. /', &
    '&delamination below_ply=''between_angles''  friction=0.3  shear_cracks=.true. /', &
    '&gauge        at=50e-3, 25e-3  face=''front'' /   ! back to back: percent bending and buckling', &
    '&gauge        at=50e-3, 25e-3  face=''back'' /', &
    '', &
    '&time         integrator=''central_difference''  settle=0.8e-3  end=4.8e-3   ! at rest before the load begins', &
    '              mass_scaling=10 /', &
    '&output       directory=''results''  fields_every=0.2e-3 /']

contains

  !> True for the name of a rig.
  pure logical function is_rig(name)
    !> As given on the command line
    character(len=*), intent(in) :: name

    is_rig = any(rig_names == name)
  end function is_rig

  !> Lines of the deck of a rig.
  pure function rig_lines(name) result(lines)
    !> One of `rig_names`
    character(len=*), intent(in) :: name
    !> The deck
    character(len=110), allocatable :: lines(:)

    lines = d7136_lines
    if (name == rig_names(2)) lines = d7137_lines
  end function rig_lines
end module rig_decks
