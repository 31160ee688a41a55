!> The decks that `implam new` writes: a drop-weight test on a cross-ply coupon, small enough to run at once, or the
!> test of a rig.
module starter_decks
  use errors, only: error_t
  use whole_files, only: write_new_file
  use rig_decks, only: lines_of, rig_lines
  implicit none
  private
  public :: write_starter

  !> Its default name.
  character(len=*), parameter, public :: starter_name = 'impact.nml'
  !> Its lines. Material and interface are those of input/peanut.nml.
  character(len=106), parameter :: lines(*) = [character(len=106) :: &
    '! A drop weight strikes the middle of a composite plate. `implam explain GROUP` lists all keys of a group,', &
    '! with their defaults; `implam explain case units` names other units.', &
    '', &
    '&case         units=''SI'' /             ! m, kg, s, so N, J, Pa', &
    '&plate        length=0.10, 0.10        ! sides along x and y', &
    '              edges=''clamped''          ! or ''simple'', ''free''; four values: x-min, x-max, y-min, y-max', &
    '              symmetry=''quarter'' /     ! plies at 0 and 90 degrees; others: ''point'' or ''none''', &
    '', &
    '&mesh         elements=26, 20          ! along x and y; more are more accurate and take longer', &
    '              core=36e-3, 24e-3        ! around the struck point cells are equal,', &
    '              cell=1e-3                ! of this side; outside they grow', &
    '              patch=2e-3 /             ! side of the square that the impactor presses on, its contact', &
    '', &
    '&material     name=''carbon/epoxy''  density=1580', &
    '              E1=139e9  E2=9.4e9  G12=4.5e9  G23=2.98e9  nu12=0.309   ! stiffness of a ply', &
    '              YT=46e6  S12=105e6 /     ! strengths: across the fibres, in shear', &
    '', &
    '&laminate     materials=''carbon/epoxy''', &
    '              stacking=''[0_4/90_4]s''  ply_thickness=0.125e-3 /    ! from the struck face', &
    '', &
    '&impactor     mass=1.0  energy=3.5     ! or velocity instead of energy', &
    '              radius=8e-3 /            ! of the nose', &
    '&indentation  law=''tan_sun''  alpha_cr=80.3e-6 /        ! indentation of the struck face', &
    '', &
    '! The interface below ply 12, where the lower 0-degree plies begin, delaminates: leave this group out', &
    '! for a plate that does not delaminate; add &ply_damage for plies that crack.', &
    '&delamination below_ply=12  G_Ic=280  G_IIc=790    ! fracture energies per area, opening and shear', &
    '              zone=36e-3, 24e-3 /      ! where it may grow', &
    '', &
    '&time         end=4e-3 /               ! contact lasts about 3.5 ms', &
    '&output       directory=''results''  fields_every=0.5e-3 /   ! history, fields for ParaView, checkpoint']

contains

  !> Writes the deck into a new file.
  subroutine write_starter(path, rig, error)
    character(len=*), intent(in) :: path
    !> Name of a rig; empty: none
    character(len=*), intent(in) :: rig
    !> Set if the file exists or cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (rig /= '') then
      call write_new_file(path, rig_lines(rig), error)
    else
      call write_new_file(path, lines_of(lines), error)
    end if
  end subroutine write_starter
end module starter_decks
