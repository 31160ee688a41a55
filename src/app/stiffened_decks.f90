!> Decks that `implam new --rig` writes for a stiffened panel: a curved skin with three blades on bonded flanges that is
!> struck in a bay, and the compression of the struck panel.
module stiffened_decks
  implicit none
  private

  !> Characters of the longest line of all decks of rigs; blanks after shorter ones are not written.
  integer, parameter, public :: width = 110

  !> Material, skin and stiffeners, in both decks.
  character(len=*), parameter :: panel(*) = [character(len=width) :: &
    '', &
    '&material     name=''ply''  library=''t700gc_m21'' /   ! `implam explain materials` lists values and sources;', &
    '                                              ! keys given here replace them, such as E1=125e9', &
    '&laminate     materials=''ply''  stacking=''[0_2/45_2/90_2/-45_2]s''  ply_thickness=0.26e-3 /   ! 4.16 mm', &
    '! Flanges: further plies on the back, bonded rigidly. The mesh has lines at their edges.', &
    '&doubler      name=''left flange''    at=0, -102e-3  size=400e-3, 36e-3', &
    '              materials=''ply''  stacking=''[45/0/-45/90]s''  ply_thickness=0.26e-3 /', &
    '&doubler      name=''middle flange''  at=0, 0        size=400e-3, 36e-3', &
    '              materials=''ply''  stacking=''[45/0/-45/90]s''  ply_thickness=0.26e-3 /', &
    '&doubler      name=''right flange''   at=0, 102e-3   size=400e-3, 36e-3', &
    '              materials=''ply''  stacking=''[45/0/-45/90]s''  ply_thickness=0.26e-3 /', &
    '! Webs: two flange laminates back to back, with their modulus along x. XT and XC: a run warns where the free', &
    '! edge exceeds them.', &
    '&stringer     name=''left''    at=-102e-3  height=36e-3  thickness=4.16e-3', &
    '              E=45e9  G=17e9  density=1600  XT=720e6  XC=560e6 /', &
    '&stringer     name=''middle''  at=0        height=36e-3  thickness=4.16e-3', &
    '              E=45e9  G=17e9  density=1600  XT=720e6  XC=560e6 /', &
    '&stringer     name=''right''   at=102e-3   height=36e-3  thickness=4.16e-3', &
    '              E=45e9  G=17e9  density=1600  XT=720e6  XC=560e6 /', &
    '']
  !> Damage, in both decks.
  character(len=*), parameter :: damage(*) = [character(len=width) :: &
    '&ply_damage   criteria=''hashin''  in_situ=.true. /', &
    '&delamination below_ply=''between_angles''      ! toughness is that of the library', &
    '              friction=0.3  shear_cracks=.true. /', &
    '']

  !> The impact.
  character(len=*), parameter, public :: stiffened(*) = [character(len=width) :: &
    '! Impact of 25 J on a curved skin with three blades on bonded flanges, in the middle of a bay.', &
    '! `implam explain GROUP` lists all keys of a group, doc/manual/which_model.md the models of other parts.', &
    '! `implam new --rig stiffened_compression` writes the compression of this panel after the impact.', &
    '', &
    '&case         units=''SI'' /                    ! m, kg, s, N, Pa, J', &
    '&plate        length=400e-3, 306e-3  edges=''clamped''', &
    '              curvature_radius=0, 2 /         ! straight along x, convex towards the impactor along y', &
    '&mesh         elements=44, 54', &
    '              core=78e-3, 78e-3  cell=3e-3    ! equal cells at the damage, larger ones outside', &
    '              patch=6e-3 /                    ! two cells', &
    panel, &
    '&impactor     mass=1  energy=25               ! a tool of 1 kg dropped from 2.5 m', &
    '              radius=12.7e-3  contact_area=''sphere''', &
    '              at=0, 51e-3 /                   ! 0, 18e-3: edge of a flange; 0, 0: over a web', &
    '&indentation  law=''thornton''  face=''laminate'' /   ! stiffness and strength through its thickness', &
    '', damage, &
    '&time         integrator=''central_difference'' /   ! it ends after the impactor has left', &
    '&output       directory=''results''  fields_every=0.5e-3  checkpoint_every=1e-3 /']

  !> The compression.
  character(len=*), parameter, public :: stiffened_compression(*) = [character(len=width) :: &
    '! Compression along the webs of the panel struck by stiffened.nml, the deck of `implam new --rig stiffened`,', &
    '! whose final state is in results/stiffened_restart.h5. Groups &material, &laminate, &doubler, &stringer,', &
    '! &ply_damage and &delamination and the radii of &plate are those of that deck; the check compares them.', &
    '! doc/manual/compression_after_impact.md explains how to choose values and how to read the results.', &
    '', &
    '&case         units=''SI'' /                    ! m, kg, s, N, Pa, J', &
    '&plate        length=400e-3, 306e-3  curvature_radius=0, 2', &
    '              edges=''clamped'', ''clamped'', ''simple'', ''simple''   ! ends in blocks, sides on knife edges', &
    '              in_plane=''free'' /', &
    '&mesh         elements=38, 102                ! cells of the length that G_fc requires or less', &
    '              core=66e-3, 300e-3  cell=3e-3   ! from side to side, as fibres are crushed; damage is mapped', &
    '              patch=6e-3 /                    ! two cells', &
    panel, &
    '&initial_state from=''results/stiffened_restart.h5'' /   ! of the impact; relative to the working directory', &
    '&line         at=-200e-3  component=''u''  displacement=2.7e-3   rise=1.5e-3 /   ! of skin and webs', &
    '&line         at=200e-3   component=''u''  displacement=-2.7e-3  rise=1.5e-3 /', &
    '', damage, &
    '! The panel comes to rest during settle: at least 1.3 periods of its first bending mode, which `implam check`', &
    '! prints. The undamaged panel, for comparison: leave out &initial_state, settle and &delamination.', &
    '&time         integrator=''central_difference''  settle=1.5e-3  end=7.5e-3', &
    '              until=''failure''                 ! or at end, if it has not failed by then', &
    '              mass_scaling=10 /', &
    '&output       directory=''results''  fields_every=0.5e-3 /']
end module stiffened_decks
