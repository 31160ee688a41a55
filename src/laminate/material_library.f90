!> Published values of some materials, each with its source, by which `library` of &material fills in keys left out.
module material_library
  use text, only: line_t, append, joined, lower_case, words_of
  use text_tables, only: table_row
  implicit none
  private
  public :: library_value_t, library_values, library_lines

  !> One value.
  type :: library_value_t
    !> Group and key to which it belongs
    character(len=:), allocatable :: group, key
    !> Its significant digits, SI
    character(len=:), allocatable :: figures
    !> Its power of ten
    integer :: exponent = 0
    !> Letter of its source
    character(len=1) :: source = ' '
  end type library_value_t

  !> Names of the materials as `library` takes them, in the order of the columns.
  character(len=*), parameter, public :: library_names = &
    't700_m21 t700gc_m21 im7_8552 as4_3501_6 t300_976 e_glass_my750'
  !> A row a key: group, key, unit in SI, and for each material the value with the letter of its source, or -. Values
  !> are written as figures, e and a power of ten, so that another system of units only shifts the power.
  character(len=*), parameter :: rows(*) = [character(len=150) :: &
    'material | density | kg/m^3 | 1600e0 c | 1600e0 c | 1580e0 c | 1560e0 h | 1600e0 i | 2000e0 k', &
    'material | E1 | Pa | 130e9 a | 130e9 b | 171.42e9 d | 126e9 g | 135.1e9 i | 45.6e9 g', &
    'material | E1c | Pa | 100e9 n | 100e9 n | - | - | - | -', &
    'material | E2 | Pa | 7.7e9 a | 7.7e9 b | 9.08e9 d | 11e9 g | 9.24e9 i | 16.2e9 g', &
    'material | G12 | Pa | 4.8e9 a | 4.8e9 b | 5.29e9 d | 6.6e9 g | 6.27e9 i | 5.83e9 g', &
    'material | G13 | Pa | 4.8e9 a | 4.8e9 b | 5.29e9 j | 6.6e9 j | 6.27e9 j | 5.83e9 j', &
    'material | G23 | Pa | 3.8e9 a | 3.8e9 b | 2.99e9 j | 3.93e9 j | 3.3e9 j | 5.79e9 j', &
    'material | nu12 | - | .30e0 a | .33e0 b | .32e0 d | .28e0 g | .318e0 i | .278e0 g', &
    'material | nu23 | - | .35e0 a | .35e0 b | .52e0 e | .40e0 g | .40e0 l | .40e0 g', &
    'material | XT | Pa | 2080e6 a | 2080e6 b | 2326.2e6 d | 1950e6 g | 1455e6 i | 1280e6 g', &
    'material | XC | Pa | 1250e6 a | 1250e6 b | 1200.1e6 d | 1480e6 g | 1296e6 i | 800e6 g', &
    'material | YT | Pa | 60e6 a | 60e6 b | 62.3e6 d | 48e6 g | 39.0e6 i | 40e6 g', &
    'material | YC | Pa | 290e6 a | 290e6 b | 199.8e6 d | 200e6 g | 207e6 i | 145e6 g', &
    'material | S12 | Pa | 110e6 a | 110e6 b | 92.3e6 d | 79e6 g | 76.5e6 i | 73e6 g', &
    'material | G_ft | J/m^2 | 133e3 m | 133e3 m | 133.3e3 f | - | - | -', &
    'material | G_fc | J/m^2 | 10e3 a | 40e3 b | 47.5e3 e | - | - | -', &
    'material | G_mt | J/m^2 | 500e0 a | 600e0 b | 277e0 e | - | - | -', &
    'material | G_mc | J/m^2 | 1600e0 a | 2100e0 b | 788e0 e | - | - | -', &
    'delamination | G_Ic | J/m^2 | 500e0 a | 600e0 b | 277e0 e | - | - | -', &
    'delamination | G_IIc | J/m^2 | 1600e0 a | 2100e0 b | 788e0 e | - | - | -', &
    'delamination | eta | - | 1.45e0 a | 1.45e0 b | 1.634e0 e | - | - | -']
  !> Columns before those of the materials.
  integer, parameter :: heads = 3
  !> Sources of the values.
  character(len=*), parameter :: sources(*) = [character(len=190) :: &
    'a | W. Tan, B. G. Falzon, L. N. S. Chiu, M. Price, Composites A 71 (2015) 212-226, for the panel of 6.5 J of '// &
    'Rivallant, Bouvet, Hongkarnjanakul (2013)', &
    'b | the same paper, for the panel of 25 J of Hongkarnjanakul, Bouvet, Rivallant, Composite Structures 106 '// &
    '(2013) 549', &
    'c | assumed, a usual value of such laminates', &
    'd | P. P. Camanho, P. Maimi, C. G. Davila, Composites Science and Technology 67 (2007) 2715-2727', &
    'e | P. P. Camanho, M. A. Bessa, G. Catalanotti, M. Vogler, R. Rolfes, Mechanics of Materials 59 (2013) 36-49', &
    'f | G. Catalanotti, P. P. Camanho, J. Xavier, C. G. Davila, A. T. Marques, Composites Science and Technology '// &
    '70 (2010) 1986-1993', &
    'g | P. D. Soden, M. J. Hinton, A. S. Kaddour, Composites Science and Technology 58 (1998) 1011-1022', &
    'h | MIL-HDBK-17-2F (2002), table 4.2.12', &
    'i | MIL-HDBK-17-2F (2002), table 4.2.17, means of five specimens at 22 degrees', &
    'j | from isotropy across the fibres: G13 = G12, G23 = E2/(2 (1 + nu23))', &
    'k | of 60 % of glass with 2540 kg/m^3 in a resin of 1200 kg/m^3', &
    'l | assumed, that of AS4/3501-6', &
    'm | that of T300/913 (B below), which the papers a and b take; not measured on T700/M21', &
    'n | from memory, C. Bouvet, S. Rivallant, J. J. Barrau, Composites Science and Technology 72 (2012) 1977; '// &
    'the bending stiffnesses there are those of the mean, 115 GPa']

contains

  !> All values of one material; none if there is no such material.
  pure function library_values(name) result(values)
    !> Its name in any case
    character(len=*), intent(in) :: name
    type(library_value_t), allocatable :: values(:)
    type(line_t), allocatable :: names(:), cells(:), words(:)
    type(library_value_t) :: value
    integer :: column, row, mark

    names = words_of(library_names, ' ')
    allocate (values(0))
    do column = 1, size(names)
      if (names(column)%text /= lower_case(name)) cycle
      do row = 1, size(rows)
        cells = words_of(trim(rows(row)), '|')
        words = words_of(cells(heads + column)%text, ' ')
        if (size(words) < 2) cycle
        mark = index(words(1)%text, 'e')
        value%group = cells(1)%text
        value%key = cells(2)%text
        value%figures = words(1)%text(:mark - 1)
        read (words(1)%text(mark + 1:), *) value%exponent
        value%source = words(2)%text
        values = [values, value]
      end do
    end do
  end function library_values

  !> The table of all values, and their sources.
  pure subroutine library_lines(wanted, markdown, lines)
    !> Beginning of the names of the materials wanted; empty: all
    character(len=*), intent(in) :: wanted
    !> True: as tables for the manual
    logical, intent(in) :: markdown
    !> The lines; none: no material has such a name
    type(line_t), allocatable, intent(out) :: lines(:)
    type(line_t), allocatable :: cells(:), names(:)
    integer, allocatable :: columns(:)
    character(len=:), allocatable :: cited
    integer :: row, i

    allocate (lines(0))
    names = words_of(library_names, ' ')
    columns = pack([(i, i=1, size(names))], [(index(names(i)%text, lower_case(wanted)) == 1, i=1, size(names))])
    if (size(columns) == 0) return
    cited = ''
    call append(lines, table_line([line_t('key'), line_t('unit'), names(columns)], markdown))
    if (markdown) call append(lines, '|'//repeat('---|', size(columns) + 2))
    do row = 1, size(rows)
      cells = words_of(trim(rows(row)), '|')
      call append(lines, table_line([cells(2:heads), cells(heads + columns)], markdown))
      cited = cited//joined(cells(heads + columns), ' ')//' '
    end do
    call append(lines, '')
    do row = 1, size(sources)
      cells = words_of(trim(sources(row)), '|')
      if (index(cited, ' '//cells(1)%text//' ') == 0) cycle
      if (markdown) then
        call append(lines, '- '//cells(1)%text//': '//cells(2)%text//'.')
      else
        call append(lines, '  '//cells(1)%text//'  '//cells(2)%text//'.')
      end if
    end do
  end subroutine library_lines

  !> One line of the table; a power of ten of zero is omitted.
  pure function table_line(cells, markdown) result(line)
    !> Its cells
    type(line_t), intent(in) :: cells(:)
    !> True: separated by bars
    logical, intent(in) :: markdown
    character(len=:), allocatable :: line
    type(line_t) :: plain_cells(size(cells))
    integer :: i, mark

    plain_cells = cells
    do i = 1, size(cells)
      mark = index(cells(i)%text, 'e0 ')
      if (mark > 0) plain_cells(i)%text = cells(i)%text(:mark - 1)//cells(i)%text(mark + 2:)
    end do
    line = table_row(plain_cells, [(merge(8, 14, i < heads), i=1, size(cells))], markdown)
  end function table_line
end module material_library
