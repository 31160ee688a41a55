!> Usual ranges of quantities, by which values in another unit are found. The row of a key names its quantity.
module usual_ranges
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: quantity_named, range_in_words

  !> Range of a quantity.
  type :: usual_range_t
    !> Its name in the rows of keys
    character(len=18) :: name
    !> Its unit in SI
    character(len=6) :: unit
    !> Smallest, usual and largest value, SI
    real(wp) :: least, usual, largest
  end type usual_range_t

  !> Values of plates, impactors and their materials. Moduli reach from foam to diamond, densities from foam to
  !> platinum, velocities from a tool that slips to a fragment, strengths from glue to fibres. Fracture energies of
  !> fibres are of 10 to 200 kJ/m^2. The usual value chooses one of several units that fit.
  type(usual_range_t), parameter, public :: ranges(*) = [ &
    usual_range_t('modulus', 'Pa', 1.0e7_wp, 7.0e10_wp, 1.5e12_wp), &
    usual_range_t('density', 'kg/m^3', 10.0_wp, 1.6e3_wp, 2.5e4_wp), &
    usual_range_t('length', 'm', 1.0e-3_wp, 0.2_wp, 20.0_wp), &
    usual_range_t('laminate thickness', 'm', 2.0e-5_wp, 2.0e-3_wp, 0.5_wp), &
    usual_range_t('radius', 'm', 1.0e-4_wp, 1.0e-2_wp, 1.0_wp), &
    usual_range_t('mass', 'kg', 1.0e-6_wp, 0.3_wp, 1.0e5_wp), &
    usual_range_t('velocity', 'm/s', 0.05_wp, 3.0_wp, 1.0e3_wp), &
    usual_range_t('toughness', 'J/m^2', 5.0_wp, 6.0e2_wp, 1.0e5_wp), &
    usual_range_t('time', 's', 1.0e-8_wp, 1.0e-3_wp, 1.0e2_wp), &
    usual_range_t('strength', 'Pa', 1.0e5_wp, 5.0e8_wp, 2.0e10_wp), &
    usual_range_t('fibre toughness', 'J/m^2', 1.0e3_wp, 5.0e4_wp, 1.0e6_wp)]

contains

  !> Number of a quantity in the table; 0: it is not there.
  pure integer function quantity_named(name) result(quantity)
    character(len=*), intent(in) :: name

    do quantity = size(ranges), 1, -1
      if (ranges(quantity)%name == name) return
    end do
  end function quantity_named

  !> The range of a quantity for `explain` and the manual, such as usual mass 1e-6 to 1e5 kg.
  pure function range_in_words(name) result(words)
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: words
    integer :: i

    i = quantity_named(name)
    words = ''
    if (i > 0) words = 'usual '//name//' '//to_text(ranges(i)%least)//' to '//to_text(ranges(i)%largest)//' '// &
                       trim(ranges(i)%unit)
  end function range_in_words
end module usual_ranges
