!> Systems of units of decks, and recognition of values that do not fit the system.
module unit_systems
  use kinds, only: wp
  use text, only: lower_case
  use usual_ranges, only: ranges
  implicit none
  private
  public :: is_unusual, unit_that_fits, unit_name, system_named, base_units, units_in_metre, decades_of

  !> Kinds of quantities, in the order of the usual ranges.
  integer, parameter, public :: of_pressure = 1, of_density = 2, of_length = 3, of_thickness = 4, of_radius = 5, &
                                of_mass = 6, of_velocity = 7, of_toughness = 8, of_time = 9, of_strength = 10, &
                                of_fibre_toughness = 11
  !> Number of kinds of quantities.
  integer, parameter, public :: quantities = size(ranges)
  !> The systems: metre, kilogram, second; millimetre, tonne, second; millimetre, kilogram, millisecond; millimetre,
  !> millinewton, kilogram, second.
  character(len=*), parameter, public :: systems(4) = [character(len=10) :: 'SI', 'mm-t-s', 'mm-kg-ms', 'mm-mN-kg-s']
  !> Length, mass and time of each system, in metres, kilograms and seconds.
  real(wp), parameter :: bases(3, 4) = reshape([1.0_wp, 1.0_wp, 1.0_wp, &
                                                1.0e-3_wp, 1.0e3_wp, 1.0_wp, &
                                                1.0e-3_wp, 1.0_wp, 1.0e-3_wp, &
                                                1.0e-3_wp, 1.0_wp, 1.0_wp], [3, 4])

  !> A unit that people write.
  type :: unit_t
    !> Its symbol
    character(len=8) :: name
    !> The kind of quantity it measures
    integer :: quantity
    !> SI units in it
    real(wp) :: size
  end type unit_t

  !> The units, in order of their kinds. Thicknesses and radii have those of lengths, strengths those of pressures, and
  !> the fracture energies of fibres those of toughnesses.
  type(unit_t), parameter :: units(*) = [ &
    unit_t('Pa', of_pressure, 1.0_wp), unit_t('kPa', of_pressure, 1.0e3_wp), unit_t('MPa', of_pressure, 1.0e6_wp), &
    unit_t('GPa', of_pressure, 1.0e9_wp), &
    unit_t('kg/m^3', of_density, 1.0_wp), unit_t('g/cm^3', of_density, 1.0e3_wp), &
    unit_t('kg/mm^3', of_density, 1.0e9_wp), unit_t('t/mm^3', of_density, 1.0e12_wp), &
    unit_t('m', of_length, 1.0_wp), unit_t('mm', of_length, 1.0e-3_wp), &
    unit_t('kg', of_mass, 1.0_wp), unit_t('g', of_mass, 1.0e-3_wp), unit_t('t', of_mass, 1.0e3_wp), &
    unit_t('m/s', of_velocity, 1.0_wp), unit_t('mm/s', of_velocity, 1.0e-3_wp), &
    unit_t('J/m^2', of_toughness, 1.0_wp), unit_t('mN/mm', of_toughness, 1.0_wp), &
    unit_t('N/mm', of_toughness, 1.0e3_wp), unit_t('kN/mm', of_toughness, 1.0e6_wp), &
    unit_t('s', of_time, 1.0_wp), unit_t('ms', of_time, 1.0e-3_wp), unit_t('us', of_time, 1.0e-6_wp)]
  !> Which of them each system has for pressure, density, length, mass, velocity, toughness and time.
  character(len=*), parameter :: unit_of(9, 4) = reshape([character(len=8) :: &
    'Pa', 'kg/m^3', 'm', 'm', 'm', 'kg', 'm/s', 'J/m^2', 's', &
    'MPa', 't/mm^3', 'mm', 'mm', 'mm', 't', 'mm/s', 'N/mm', 's', &
    'GPa', 'kg/mm^3', 'mm', 'mm', 'mm', 'kg', 'm/s', 'kN/mm', 'ms', &
    'kPa', 'kg/mm^3', 'mm', 'mm', 'mm', 'kg', 'mm/s', 'mN/mm', 's'], [9, 4])

contains

  !> Index of the system with a name; 0: there is none.
  pure integer function system_named(name) result(system)
    !> The name, in any case
    character(len=*), intent(in) :: name

    do system = size(systems), 1, -1
      if (lower_case(name) == lower_case(trim(systems(system)))) return
    end do
  end function system_named

  !> Length, mass and time of a system, in metres, kilograms and seconds.
  pure function base_units(system) result(base)
    integer, intent(in) :: system
    real(wp) :: base(3)

    base = bases(:, system)
  end function base_units

  !> Number of units of length in a metre; 0: there is no such system.
  pure real(wp) function units_in_metre(name) result(number)
    !> Name of the system, in any case
    character(len=*), intent(in) :: name

    number = 0
    if (system_named(name) > 0) number = 1/bases(1, system_named(name))
  end function units_in_metre

  !> True: a value in the units of a system is outside the range of its kind of quantity.
  pure logical function is_unusual(quantity, value, system)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: value
    integer, intent(in) :: system

    is_unusual = .not. in_range(quantity, value*size_of(quantity, unit_name(quantity, system)))
  end function is_unusual

  !> The unit in which a value would have a usual magnitude, or an empty text if there is none.
  pure function unit_that_fits(quantity, value) result(name)
    integer, intent(in) :: quantity
    real(wp), intent(in) :: value
    !> Symbol of the unit
    character(len=:), allocatable :: name
    real(wp) :: decades, nearest
    integer :: i

    name = ''
    nearest = huge(nearest)
    do i = 1, size(units)
      if (units(i)%quantity /= dimension_of(quantity) .or. .not. in_range(quantity, value*units(i)%size)) cycle
      decades = abs(log(value*units(i)%size/ranges(quantity)%usual))
      if (decades < nearest) name = trim(units(i)%name)
      nearest = min(nearest, decades)
    end do
  end function unit_that_fits

  !> Unit of a system.
  pure function unit_name(quantity, system) result(name)
    integer, intent(in) :: quantity
    integer, intent(in) :: system
    character(len=:), allocatable :: name

    name = trim(unit_of(dimension_of(quantity), system))
  end function unit_name

  !> Unit of a system in SI units, a power of ten, by which a value in SI is divided.
  pure integer function decades_of(quantity, system) result(decades)
    integer, intent(in) :: quantity
    integer, intent(in) :: system

    decades = nint(log10(size_of(quantity, unit_name(quantity, system))))
  end function decades_of

  !> True: a value within the range of its kind of quantity.
  pure logical function in_range(quantity, value)
    integer, intent(in) :: quantity
    !> The value, SI
    real(wp), intent(in) :: value

    in_range = value >= ranges(quantity)%least .and. value <= ranges(quantity)%largest
  end function in_range

  !> SI units in a unit.
  pure real(wp) function size_of(quantity, name)
    integer, intent(in) :: quantity
    !> Symbol of the unit
    character(len=*), intent(in) :: name
    integer :: i

    size_of = 1
    do i = 1, size(units)
      if (units(i)%quantity == dimension_of(quantity) .and. units(i)%name == name) size_of = units(i)%size
    end do
  end function size_of

  !> The kind of quantity that has the units of another one.
  pure integer function dimension_of(quantity)
    integer, intent(in) :: quantity

    dimension_of = quantity
    if (quantity == of_thickness .or. quantity == of_radius) dimension_of = of_length
    if (quantity == of_strength) dimension_of = of_pressure
    if (quantity == of_fibre_toughness) dimension_of = of_toughness
  end function dimension_of
end module unit_systems
