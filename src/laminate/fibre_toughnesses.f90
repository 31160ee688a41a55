!> Measured fracture energies of fibres by the thickness of the block of plies that they lie in: fibres of thick blocks
!> pull out further.
module fibre_toughnesses
  use kinds, only: wp
  use text, only: append, line_t, words_of
  use text_tables, only: table_row
  implicit none
  private
  public :: fibre_toughness_lines, measured_toughness

  !> Thickness, m, of two plies, from which blocks count as thick: that of the specimens.
  real(wp), parameter, public :: thick_block = 0.25e-3_wp
  !> Energies in N/mm, which is kJ/m2, of thick blocks, and bounds of those of single plies; tension, T300/920.
  character(len=*), parameter :: of_thick = '132', of_single = '57 to 69'
  !> Rows: material, key, blocks, energy in N/mm, source.
  character(len=*), parameter :: rows(*) = [character(len=80) :: &
    'T300/920 | G_ft | two plies, .25 mm | '//of_thick//' | A', &
    'T300/920 | G_ft | single plies | '//of_single//' | A', &
    'T300/913 | G_ft | not known here | 91.6 at onset, 133 | B', &
    'T300/913 | G_fc | not known here | 79.9 at onset | B']
  !> Sources of the rows.
  character(len=*), parameter :: sources(*) = [character(len=190) :: &
    'A | M. J. Laffan, S. T. Pinho, P. Robinson, L. Iannucci, Composites Science and Technology 70 (2010), '// &
    'abstract: [90/0_2] sub-laminates and all other lay-ups', &
    'B | S. T. Pinho, P. Robinson, L. Iannucci, Composites Science and Technology 66 (2006) 2069-2079']

contains

  !> Measured energy of fibres in tension, N/mm.
  pure function measured_toughness(is_thick) result(energy)
    !> True: of blocks of two plies and more
    logical, intent(in) :: is_thick
    !> A value, or both bounds
    character(len=:), allocatable :: energy

    energy = trim(merge(of_thick//'     ', of_single, is_thick))
  end function measured_toughness

  !> The table with its sources.
  pure subroutine fibre_toughness_lines(markdown, lines)
    !> True: as tables for the manual
    logical, intent(in) :: markdown
    type(line_t), allocatable, intent(out) :: lines(:)
    type(line_t), allocatable :: cells(:)
    integer, parameter :: widths(5) = 20
    integer :: row

    allocate (lines(0))
    call append(lines, table_row([line_t('material'), line_t('key'), line_t('blocks of plies'), line_t('N/mm'), &
                                  line_t('source')], widths, markdown))
    if (markdown) call append(lines, '|---|---|---|---|---|')
    do row = 1, size(rows)
      call append(lines, table_row(words_of(trim(rows(row)), '|'), widths, markdown))
    end do
    call append(lines, '')
    do row = 1, size(sources)
      cells = words_of(trim(sources(row)), '|')
      call append(lines, merge('- ', '  ', markdown)//cells(1)%text//merge(': ', '  ', markdown)//cells(2)%text//'.')
    end do
  end subroutine fibre_toughness_lines
end module fibre_toughnesses
