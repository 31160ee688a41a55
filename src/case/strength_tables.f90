!> The part of the table of `implam check` and of the log on strengths: in place, by the stressed volume or by position,
!> by the strain rate, and the fracture energy of fibres.
module strength_tables
  use deck_contents, only: deck_t
  use deck_fibre_strengths, only: block_volumes, fibre_factors, scatter_of
  use deck_stacks, only: place_of_stack, stacks_of
  use deck_strain_rates, only: expected_rate
  use fibre_toughnesses, only: measured_toughness, thick_block
  use in_situ_strengths, only: material_in_place
  use kinds, only: wp
  use loading_rates, only: strengthened_at
  use material_parameters, only: first_alike, material_t
  use ply_blocks, only: blocks_of
  use ply_stacks, only: ply_stack_t
  use roundings, only: rounding
  use scale_tables, only: bare, length, percent, pressure, rate, read_as, table_line, toughness, unit_of, volume
  use text, only: line_t, append, to_text
  use unit_systems, only: base_units, system_named
  implicit none
  private
  public :: strength_lines

contains

  !> All lines.
  function strength_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    type(line_t), allocatable :: lines(:)

    lines = [in_situ_lines(deck), volume_lines(deck), rate_lines(deck), toughness_lines(deck)]
  end function strength_lines

  !> In-situ strengths of all plies, from the struck face; consecutive plies with equal strengths share a line. Of
  !> laminates at doublers and ply drops plies are listed whose strengths are others there.
  function in_situ_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    !> The lines; none unless the deck requests these strengths
    type(line_t), allocatable :: lines(:)
    type(ply_stack_t), allocatable :: stacks(:)
    type(line_t), allocatable :: first(:), values(:)
    integer :: i, ply

    allocate (lines(0))
    if (.not. deck%setup%ply_damage%in_situ) return
    stacks = stacks_of(deck%setup)
    first = strengths_of(deck, stacks(1))
    do i = 1, size(stacks)
      values = strengths_of(deck, stacks(i))
      if (i > 1) then
        do ply = 1, size(values)
          associate (same => findloc(stacks(1)%number, stacks(i)%number(ply), 1))
            if (same == 0) cycle
            if (values(ply)%text == first(same)%text) values(ply)%text = ''
          end associate
        end do
      end if
      call append_ranges(deck, stacks(i), values, lines)
    end do
  end function in_situ_lines

  !> In-situ strengths of each ply of a laminate in words.
  function strengths_of(deck, stack) result(values)
    type(deck_t), intent(in) :: deck
    type(ply_stack_t), intent(in) :: stack
    type(line_t) :: values(size(stack%plies))
    type(material_t) :: material
    integer :: ply

    do ply = 1, size(values)
      material = material_in_place(stack%plies, ply, deck%setup%materials, deck%setup%ply_damage)
      values(ply)%text = read_as(deck, material%yt, pressure)//', '//read_as(deck, material%s12, pressure)
    end do
  end function strengths_of

  !> Adds a line for each range of plies of equal strengths.
  subroutine append_ranges(deck, stack, values, lines)
    type(deck_t), intent(in) :: deck
    type(ply_stack_t), intent(in) :: stack
    !> Strengths of its plies; empty: not listed
    type(line_t), intent(in) :: values(:)
    type(line_t), allocatable, intent(inout) :: lines(:)
    character(len=:), allocatable :: name
    integer :: from, to

    to = 0
    do while (to < size(values))
      from = to + 1
      to = from
      do while (to < size(values))
        if (values(to + 1)%text /= values(from)%text .or. stack%number(to + 1) /= stack%number(to) + 1) exit
        to = to + 1
      end do
      if (values(from)%text == '') cycle
      name = 'in-situ YT and S12, ply '//to_text(stack%number(from))
      if (to > from) name = 'in-situ YT and S12, plies '//to_text(stack%number(from))//' to '// &
                            to_text(stack%number(to))
      call append(lines, table_line(name//place_of_stack(deck%setup, stack), values(from)%text, &
                                    unit_of(deck, pressure)))
    end do
  end subroutine append_ranges

  !> Tensile strength of the fibres of each material where the smallest and where the largest volume is stressed; means
  !> and their scatter if strengths are drawn by position.
  function volume_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    !> The lines; none unless the deck requests it
    type(line_t), allocatable :: lines(:)
    character(len=34) :: names(2)
    real(wp) :: volumes(2), factors(2)
    integer :: place, i

    allocate (lines(0))
    if (.not. (deck%setup%ply_damage%is_present .and. deck%setup%ply_damage%weibull_modulus > 0)) return
    names = [character(len=34) :: 'XT in one cell of a block', 'XT in a block stressed all over']
    if (deck%setup%ply_damage%scatters()) names = [character(len=34) :: 'mean XT in one cell of a ply', &
                                             'mean XT of a ply stressed all over']
    do place = 1, size(deck%setup%materials)
      volumes = block_volumes(deck, place)
      factors = fibre_factors(deck, place)
      if (first_alike(deck%setup%materials, place) /= place .or. .not. all(volumes > 0)) cycle
      do i = 1, size(names)
        call append(lines, table_line(trim(names(i))//', '//read_as(deck, volumes(i), volume)//' '// &
                                      unit_of(deck, volume), read_as(deck, factors(i)*deck%setup%materials(place)%xt, &
                                                                     pressure), unit_of(deck, pressure)))
      end do
    end do
    if (deck%setup%ply_damage%scatters()) call append(lines, table_line( &
      'coefficient of variation of XT in squares of '// &
      read_as(deck, deck%setup%ply_damage%strength_length, length)//' '//unit_of(deck, length), &
      read_as(deck, 100*scatter_of(deck%setup%ply_damage%weibull_modulus), percent), '%'))
  end function volume_lines

  !> Strain rate that the impact is expected to have, and the factor of the matrix strengths of each material at that
  !> rate; none for materials without strengthening.
  function rate_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    type(line_t), allocatable :: lines(:)
    real(wp) :: expected
    integer :: place

    allocate (lines(0))
    expected = expected_rate(deck)
    if (.not. expected > 0) return
    call append(lines, table_line('expected strain rate of the outer plies', read_as(deck, expected, rate), &
                                  unit_of(deck, rate)))
    do place = 1, size(deck%setup%materials)
      associate (m => deck%setup%materials(place))
        if (m%rate_gain > 0) call append(lines, table_line('factor of YT, YC and S12 at this rate, '//m%name, &
          read_as(deck, strengthened_at(m%rate_gain, m%reference_rate, expected), bare), ''))
      end associate
    end do
  end function rate_lines

  !> Fracture energy of fibres in tension of each material, in thick blocks of plies and in thin ones, with the energy
  !> measured in such blocks; none without units or without softening plies.
  function toughness_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    type(line_t), allocatable :: lines(:)
    type(ply_stack_t), allocatable :: stacks(:)
    real(wp), allocatable :: blocks(:)
    logical, allocatable :: is_thick(:)
    real(wp) :: metre
    integer :: place, i

    allocate (lines(0))
    if (system_named(deck%case%units) == 0 .or. .not. deck%setup%ply_damage%is_present) return
    stacks = stacks_of(deck%setup)
    metre = product(base_units(system_named(deck%case%units))**length%exponents)
    do place = 1, size(deck%setup%materials)
      if (first_alike(deck%setup%materials, place) /= place) cycle
      if (.not. deck%setup%materials(place)%toughness(1) > 0) cycle
      blocks = [(blocks_of(stacks(i)%plies, place), i=1, size(stacks))]
      is_thick = blocks*metre >= thick_block*(1 - rounding)
      call append_line(pack(blocks, .not. is_thick), .false.)
      call append_line(pack(blocks, is_thick), .true.)
    end do

  contains

    !> Adds the line of some blocks.
    subroutine append_line(thicknesses, are_thick)
      !> Their thicknesses; none: no line
      real(wp), intent(in) :: thicknesses(:)
      !> True: they count as thick
      logical, intent(in) :: are_thick
      character(len=:), allocatable :: name

      if (size(thicknesses) == 0) return
      name = read_as(deck, minval(thicknesses), length)
      if (maxval(thicknesses) > minval(thicknesses)*(1 + rounding)) name = name//' to '// &
                                                                        read_as(deck, maxval(thicknesses), length)
      name = 'G_ft, blocks of '//name//' mm (T300/920: '//measured_toughness(are_thick)//')'
      call append(lines, table_line(name, read_as(deck, deck%setup%materials(place)%toughness(1), toughness), &
                                    unit_of(deck, toughness)))
    end subroutine append_line
  end function toughness_lines
end module strength_tables
