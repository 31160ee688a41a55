!> The deck that `implam new --rig d7136` writes: a drop-weight test after ASTM D7136 on a panel with the thickness and
!> energy of the standard.
module rig_decks
  implicit none
  private

  !> Names of rigs with a deck, separated by blanks, and the default name of its file.
  character(len=*), parameter, public :: rig_names = 'd7136', rig_deck_name = 'd7136.nml'
  !> Lines of the deck.
  character(len=110), parameter, public :: d7136_lines(*) = [character(len=110) :: &
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
    '              patch=2e-3 /                   ! least side of the loaded square', &
    '! On 3 mm delaminations of single plies grow by energy: `implam check` prints the errors measured with such', &
    '! cells (doc/manual/which_cells.md); cell=1.5e-3 with elements=34, 50 takes some ten times as long.', &
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
    '&output       directory=''results''  fields_every=1e-3  checkpoint_every=1e-3 /']
end module rig_decks
