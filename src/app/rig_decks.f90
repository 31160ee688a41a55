!> Decks that `implam new --rig` writes: a drop-weight test after ASTM D7136 on a panel with the thickness and energy of
!> the standard, the compression of the struck panel after ASTM D7137, and those of a stiffened panel.
module rig_decks
  use stiffened_decks, only: stiffened, stiffened_compression, width
  use text, only: line_t, append
  implicit none
  private
  public :: lines_of, rig_lines

  !> Names of rigs with a deck, and the names as printed.
  character(len=*), parameter, public :: rigs(*) = [character(len=21) :: 'd7136', 'd7137', 'stiffened', &
    'stiffened_compression'], rig_names = 'd7136, d7137, stiffened, stiffened_compression'
  !> Plate and symmetry, in both decks.
  character(len=*), parameter :: panel(*) = [character(len=width) :: &
    '&case         units=''SI'' /                   ! m, kg, s, N, Pa, J', &
    '&plate        length=150e-3, 100e-3  edges=''free''  in_plane=''free''', &
    '              symmetry=''point'' /             ! half is modelled; the other half is its image']
  !> Laminate, in both decks.
  character(len=*), parameter :: laminate(*) = [character(len=width) :: &
    '&material     name=''ply''  library=''im7_8552'' /   ! `implam explain materials` lists values and sources;', &
    '                                             ! keys given here replace them, such as E1=165e9', &
    '&laminate     materials=''ply''  stacking=''[45/0/-45/90]4s''  ply_thickness=0.131e-3 /   ! 4.19 mm']
  !> Damage, in both decks.
  character(len=*), parameter :: damage(*) = [character(len=width) :: &
    '&ply_damage   criteria=''hashin''  in_situ=.true. /', &
    '&delamination below_ply=''between_angles''     ! toughness is that of the library', &
    '              friction=0.3  shear_cracks=.true. /']
  character(len=*), parameter :: blank(*) = [character(len=width) :: '']

  !> The drop-weight test.
  character(len=*), parameter :: d7136(*) = [character(len=width) :: &
    '! Drop-weight test after ASTM D7136 on a quasi-isotropic panel: 100 x 150 mm over a window of 75 x 125 mm,', &
    '! [45/0/-45/90]4s of 4 to 6 mm, a hemisphere of 16 mm and 5.5 kg, 6.7 J per mm of thickness. AITM 1-0010 has', &
    '! the same panel, window and nose. `implam explain GROUP` lists all keys of a group, with their defaults,', &
    '! doc/manual/which_interfaces.md and which_cells.md how to choose values. `implam new --rig d7137` writes the', &
    '! compression of this panel after the impact.', &
    blank, panel, &
    '&support      window=125e-3, 75e-3  unilateral=.true.  bearing=''edge'' /   ! frame, which it may lift off', &
    '&support      clamps=50e-3,44e-3, -50e-3,44e-3, 50e-3,-44e-3, -50e-3,-44e-3', &
    '              clamp_force=1100 /             ! each, the least that the standard allows', &
    blank, &
    '&mesh         elements=20, 30                ! of the modelled half', &
    '              core=72e-3, 54e-3  cell=3e-3   ! equal cells at the damage, larger ones outside', &
    '              patch=2e-3 /                   ! least side of the loaded square', &
    '! On 3 mm delaminations of single plies grow by energy: `implam check` prints the errors measured with such', &
    '! cells (doc/manual/which_cells.md); cell=1.5e-3 with elements=34, 50 takes some ten times as long.', &
    blank, laminate, blank, &
    '&impactor     mass=5.5  energy=28.1          ! 6.7 J/mm times 4.19 mm', &
    '              radius=8e-3  contact_area=''sphere'' /', &
    '&indentation  law=''thornton''  face=''laminate'' /   ! stiffness and strength through its thickness', &
    blank, damage, blank, &
    '&time         integrator=''central_difference'' /   ! it ends after the impactor has left', &
    '&output       directory=''results''  fields_every=1e-3  checkpoint_every=1e-3 /']

  !> The compression.
  character(len=*), parameter :: d7137(*) = [character(len=width) :: &
    '! Compression after ASTM D7137 of the panel struck by d7136.nml, the deck of `implam new --rig d7136`, whose', &
    '! final state is in results/d7136_restart.h5. Groups &plate, &material, &laminate, &ply_damage and', &
    '! &delamination are those of that deck: what is changed in one is changed in both, the check compares them.', &
    '! doc/manual/compression_after_impact.md explains how to choose values and how to read the results.', &
    blank, panel, &
    '&support      window=134e-3, 90e-3  bearing=''face''  sides=''edge'' /   ! clamped ends, sides on knife edges', &
    blank, &
    '&initial_state from=''results/d7136_restart.h5'' /   ! of the impact; relative to the working directory', &
    '&line         at=75e-3  component=''u''        ! moves this end, and by symmetry the other one towards it', &
    '              displacement=-0.65e-3  rise=1e-3 /   ! shortening of 1.3 mm at the end of the run', &
    '&gauge        at=50e-3, 25e-3  face=''front'' /', &
    '&gauge        at=50e-3, 25e-3  face=''back'' /', &
    blank, &
    '&mesh         elements=20, 34                ! of the modelled half', &
    '              core=72e-3, 90e-3  cell=3e-3 / ! from side to side, as fibres are crushed; damage is mapped', &
    '! `implam check` reports the longest cell for G_fc, which strengths require.', &
    blank, laminate, blank, damage, blank, &
    '! The plate comes to rest in the fixture during settle: at least 1.3 periods of its first bending mode, which', &
    '! `implam check` prints; the load takes ten or more. The undamaged panel, for comparison: leave out', &
    '! &initial_state and settle, and give an imperfection of &plate.', &
    '&time         integrator=''central_difference''  settle=0.8e-3  end=5.4e-3  mass_scaling=10 /', &
    '&output       directory=''results''  fields_every=0.5e-3 /']

contains

  !> Lines of the deck of a rig.
  pure function rig_lines(rig) result(lines)
    !> Its name
    character(len=*), intent(in) :: rig
    type(line_t), allocatable :: lines(:)

    select case (rig)
    case ('d7136')
      lines = lines_of(d7136)
    case ('d7137')
      lines = lines_of(d7137)
    case ('stiffened')
      lines = lines_of(stiffened)
    case default
      lines = lines_of(stiffened_compression)
    end select
  end function rig_lines

  !> Lines of a deck without trailing blanks.
  pure function lines_of(deck) result(lines)
    !> Its lines, padded with blanks
    character(len=*), intent(in) :: deck(:)
    type(line_t), allocatable :: lines(:)
    integer :: i

    do i = 1, size(deck)
      call append(lines, trim(deck(i)))
    end do
  end function lines_of
end module rig_decks
