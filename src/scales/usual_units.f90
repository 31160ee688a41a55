!> Values in the units that people use: mm, ms, kN, J, MPa, if the system of units of the deck is known.
module usual_units
  use kinds, only: wp
  use text, only: rounded_text
  use unit_systems, only: base_units, system_named
  implicit none
  private
  public :: in_usual_unit

  !> Kinds of units, as in the tables of results.
  character(len=*), parameter, public :: length_kind = 'length', area_kind = 'area', time_kind = 'time', &
                                         velocity_kind = 'length/time', force_kind = 'force', &
                                         pressure_kind = 'pressure', energy_kind = 'energy', &
                                         frequency_kind = 'frequency'

  !> A unit.
  type :: unit_t
    !> Name
    character(len=3) :: name
    !> Kind, as in tables of results
    character(len=11) :: kind
    !> Size in SI, and the least value in it
    real(wp) :: si, from
  end type unit_t

  !> Of each kind the largest one is used that gives at least the least value, else the first one. Moduli are in GPa,
  !> strengths in MPa.
  type(unit_t), parameter :: units(*) = [ &
    unit_t('um', length_kind, 1.0e-6_wp, 0.0_wp), unit_t('mm', length_kind, 1.0e-3_wp, 0.1_wp), &
    unit_t('us', time_kind, 1.0e-6_wp, 0.0_wp), unit_t('ms', time_kind, 1.0e-3_wp, 0.1_wp), &
    unit_t('mm2', area_kind, 1.0e-6_wp, 0.0_wp), unit_t('m/s', velocity_kind, 1.0_wp, 0.0_wp), &
    unit_t('N', force_kind, 1.0_wp, 0.0_wp), unit_t('kN', force_kind, 1.0e3_wp, 0.1_wp), &
    unit_t('MPa', pressure_kind, 1.0e6_wp, 0.0_wp), unit_t('GPa', pressure_kind, 1.0e9_wp, 5.0_wp), &
    unit_t('mJ', energy_kind, 1.0e-3_wp, 0.0_wp), unit_t('J', energy_kind, 1.0_wp, 0.1_wp), &
    unit_t('Hz', frequency_kind, 1.0_wp, 0.0_wp), unit_t('kHz', frequency_kind, 1.0e3_wp, 1.0_wp)]

contains

  !> A value with its unit; without a unit if it has none, or if the system is not known.
  pure function in_usual_unit(value, kind, system, digits) result(words)
    !> The value, in the units of the deck
    real(wp), intent(in) :: value
    !> Kind of its unit, such as force
    character(len=*), intent(in) :: kind
    !> System of units of the deck; empty: not known
    character(len=*), intent(in) :: system
    !> Significant digits, four if not given
    integer, intent(in), optional :: digits
    !> Such as 2.468 kN
    character(len=:), allocatable :: words
    real(wp) :: size_in_si
    integer :: i, chosen

    words = rounded_text(value, digits)
    if (system_named(system) == 0 .or. .not. abs(value) > 0) return
    size_in_si = value*si_of(kind, base_units(system_named(system)))
    chosen = 0
    do i = 1, size(units)
      if (units(i)%kind /= kind) cycle
      if (chosen == 0 .or. abs(size_in_si) >= units(i)%from*units(i)%si) chosen = i
    end do
    if (chosen > 0) words = rounded_text(size_in_si/units(chosen)%si, digits)//' '//trim(units(chosen)%name)
  end function in_usual_unit

  !> One unit of a kind in SI.
  pure real(wp) function si_of(kind, base) result(si)
    !> Kind of unit
    character(len=*), intent(in) :: kind
    !> Length, mass and time of the system in SI
    real(wp), intent(in) :: base(3)

    associate (length => base(1), mass => base(2), time => base(3))
      select case (kind)
      case (length_kind)
        si = length
      case (area_kind)
        si = length**2
      case (time_kind)
        si = time
      case (frequency_kind)
        si = 1/time
      case (velocity_kind)
        si = length/time
      case (force_kind)
        si = mass*length/time**2
      case (energy_kind)
        si = mass*length**2/time**2
      case (pressure_kind)
        si = mass/(length*time**2)
      case default
        si = 1
      end select
    end associate
  end function si_of
end module usual_units
