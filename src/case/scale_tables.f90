!> The table of `implam check` and of the log: scales of the setup and expected results. If &case gives units, values
!> are in mm, ms, N, J, kg, MPa, otherwise in those of the deck with their dimension.
module scale_tables
  use deck_contents, only: deck_t
  use interface_flexibility, only: added_share
  use kinds, only: wp
  use mean_stiffnesses, only: bending_error_of
  use plies, only: is_bimodular, ply_t
  use short_numbers, only: short_text
  use stacking, only: stacked_plies
  use stringers, only: mass_of
  use text, only: line_t, append
  use unit_systems, only: base_units, system_named
  implicit none
  private
  public :: dimension_t, scale_lines, length_unit, length_unit_size, length_text, read_as, table_line, unit_of

  !> Characters before the values, and characters of a value.
  integer, parameter :: name_width = 56, value_width = 12

  !> A physical dimension.
  type :: dimension_t
    !> Its name, and the unit in which it is printed
    character(len=16) :: name, unit
    !> Exponents of length, mass and time
    real(wp) :: exponents(3)
    !> SI units in the unit
    real(wp) :: size
  end type dimension_t

  !> The dimensions of the table; the first is for bare numbers.
  type(dimension_t), parameter, public :: &
    bare = dimension_t('', '', [0.0_wp, 0.0_wp, 0.0_wp], 1.0_wp), &
    percent = dimension_t('%', '%', [0.0_wp, 0.0_wp, 0.0_wp], 1.0_wp), &
    length = dimension_t('length', 'mm', [1.0_wp, 0.0_wp, 0.0_wp], 1.0e-3_wp), &
    mass = dimension_t('mass', 'kg', [0.0_wp, 1.0_wp, 0.0_wp], 1.0_wp), &
    time = dimension_t('time', 'ms', [0.0_wp, 0.0_wp, 1.0_wp], 1.0e-3_wp), &
    rate = dimension_t('1/time', '1/s', [0.0_wp, 0.0_wp, -1.0_wp], 1.0_wp), &
    force = dimension_t('force', 'N', [1.0_wp, 1.0_wp, -2.0_wp], 1.0_wp), &
    energy = dimension_t('energy', 'J', [2.0_wp, 1.0_wp, -2.0_wp], 1.0_wp), &
    toughness = dimension_t('energy/area', 'N/mm', [0.0_wp, 1.0_wp, -2.0_wp], 1.0e3_wp), &
    volume = dimension_t('volume', 'mm3', [3.0_wp, 0.0_wp, 0.0_wp], 1.0e-9_wp), &
    pressure = dimension_t('pressure', 'MPa', [-1.0_wp, 1.0_wp, -2.0_wp], 1.0e6_wp), &
    contact = dimension_t('force/length^1.5', 'N/mm^1.5', [-0.5_wp, 1.0_wp, -2.0_wp], 1.0e3_wp*sqrt(1.0e3_wp))

contains

  !> The scales of the setup and expected results.
  function scale_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    !> One line each
    type(line_t), allocatable :: lines(:)

    allocate (lines(0))
    if (system_named(deck%case%units) == 0) then
      call append(lines, 'Scales of the case, in the units of the deck (mm, ms and N if &case has units):')
    else
      call append(lines, 'Scales of the case:')
    end if
    associate (o => deck%expected, scales => deck%expected%scales)
      call put(trim(merge('thickness of the laminate    ', 'thickness at the struck point', &
                          deck%setup%zones%is_empty())), scales%thickness, length)
      call put_sub_plies(lines, deck, stacked_plies(deck%setup%laminate, deck%setup%materials))
      call put('mass of the plate', scales%plate_mass, mass)
      call put('mass of the stringers', mass_of(deck%setup%stringers), mass)
      call put('period of the first bending mode', scales%first_period, time)
      call put('delamination threshold force (closed form)', scales%threshold, force)
      call put('force at interlaminar shear failure beside the contact', scales%onset, force)
      call put('deflection added by the stiffness of the interfaces', &
               100*added_share(deck%setup, scales%compliance), percent)
      if (.not. o%of_impact) return
      call put('impact energy', scales%energy, energy)
      call put('stiffness k of the contact law', deck%setup%impactor%indentation%k, contact)
      call put('rise time of the contact force', scales%contact_time, time)
      call put('time steps in the rise time', scales%contact_time/deck%stepping%time%step, bare)
      call put('bending wavelength at first contact', scales%wave_length, length)
      call put('elements in a wavelength', scales%wave_length/o%edge, bare)
      call put(trim(merge('expected peak force (undamaged, without stringers)   ', &
                          'expected peak force (undamaged plate, linear strains)', &
                          size(deck%setup%stringers) > 0)), &
               o%force, force)
      call put('expected indentation', o%indentation, length)
      call put('expected deflection over thickness', o%deflection/scales%thickness, bare)
      call put('expected number of contacts', real(o%contacts, wp), bare)
      call put('expected end of the last contact', o%last_contact, time, o%is_cut)
      call put('error of the peak force due to the time step', 100*o%step_error(1), percent)
      call put('error of the force history due to the time step', 100*o%step_error(2), percent)
      call put('error of the peak force due to the mesh', 100*o%mesh_error(1), percent)
      call put('error of the force history due to the mesh', 100*o%mesh_error(2), percent)
    end associate

  contains

    !> Adds a line for a known, non-zero value.
    subroutine put(name, value, dimension, is_bound)
      !> Name of the quantity
      character(len=*), intent(in) :: name
      !> Its size, in the deck's units
      real(wp), intent(in) :: value
      type(dimension_t), intent(in) :: dimension
      !> True: the value is a lower bound
      logical, intent(in), optional :: is_bound

      call put_scale(lines, deck, name, value, dimension, is_bound)
    end subroutine put
  end function scale_lines

  !> Adds a line for a known, non-zero value.
  subroutine put_scale(lines, deck, name, value, dimension, is_bound)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    !> Name of the quantity
    character(len=*), intent(in) :: name
    !> Its size, in the deck's units
    real(wp), intent(in) :: value
    type(dimension_t), intent(in) :: dimension
    !> True: the value is a lower bound
    logical, intent(in), optional :: is_bound
    character(len=:), allocatable :: number

    if (.not. value > 0) return
    number = read_as(deck, value, dimension)
    if (present(is_bound)) then
      if (is_bound) number = '> '//number
    end if
    call append(lines, table_line(name, number, unit_of(deck, dimension)))
  end subroutine put_scale

  !> Adds the number of sub-plies where moduli in tension and compression differ, and the error that is left.
  subroutine put_sub_plies(lines, deck, plies)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(ply_t), intent(in) :: plies(:)

    if (.not. any(is_bimodular(plies%elasticity))) return
    call put_scale(lines, deck, 'sub-plies of the ply that has most (E1c)', real(maxval(plies%sub_plies), wp), bare)
    call put_scale(lines, deck, 'error of the bending stiffness by their thickness', &
             100*maxval(bending_error_of(plies, deck%expected%scales%thickness)), percent)
  end subroutine put_sub_plies

  !> A line of the table.
  pure function table_line(name, value, unit) result(line)
    !> Name of the quantity, its value, and its unit or dimension
    character(len=*), intent(in) :: name, value, unit
    character(len=:), allocatable :: line

    line = '  '//name//repeat(' ', max(1, name_width - len(name)))//value
    if (unit /= '') line = line//repeat(' ', max(1, value_width - len(value)))//unit
  end function table_line

  !> A value to three digits, in the unit in which it is printed.
  pure function read_as(deck, value, dimension) result(digits)
    type(deck_t), intent(in) :: deck
    !> The value, in its units
    real(wp), intent(in) :: value
    type(dimension_t), intent(in) :: dimension
    character(len=:), allocatable :: digits
    integer :: system

    system = system_named(deck%case%units)
    digits = short_text(value)
    if (system > 0) digits = short_text(value*product(base_units(system)**dimension%exponents)/dimension%size)
  end function read_as

  !> Unit of lengths after a blank; empty if the deck does not name its units.
  pure function length_unit(deck) result(unit)
    type(deck_t), intent(in) :: deck
    !> Such as ' mm'
    character(len=:), allocatable :: unit

    unit = ''
    if (system_named(deck%case%units) > 0) unit = ' '//trim(length%unit)
  end function length_unit

  !> That unit in the deck's own.
  pure real(wp) function length_unit_size(deck) result(its_size)
    type(deck_t), intent(in) :: deck
    real(wp) :: base(3)
    integer :: system

    its_size = 1
    system = system_named(deck%case%units)
    if (system == 0) return
    base = base_units(system)
    its_size = length%size/base(1)
  end function length_unit_size

  !> A length to three digits with its unit.
  pure function length_text(deck, value) result(words)
    type(deck_t), intent(in) :: deck
    !> The length, in its units
    real(wp), intent(in) :: value
    !> Such as 0.0823 mm
    character(len=:), allocatable :: words

    words = read_as(deck, value, length)//length_unit(deck)
  end function length_text

  !> Unit of a value, or its dimension where the deck does not name its units.
  pure function unit_of(deck, dimension) result(unit)
    type(deck_t), intent(in) :: deck
    type(dimension_t), intent(in) :: dimension
    !> Such as mm, or length
    character(len=:), allocatable :: unit

    unit = trim(dimension%name)
    if (system_named(deck%case%units) > 0) unit = trim(dimension%unit)
  end function unit_of
end module scale_tables
