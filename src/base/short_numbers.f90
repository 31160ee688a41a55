!> Numbers of three digits for messages.
module short_numbers
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: short_text, text_at_least, text_at_most

  !> Relative distance of a number from one of three digits within which it is taken to be that number: a thousand
  !> operations lose as much.
  real(wp), parameter :: rounding_tolerance = 1.0e-12_wp

contains

  !> A number to three digits.
  pure function short_text(value) result(digits)
    real(wp), intent(in) :: value
    !> Such as 0.00345
    character(len=:), allocatable :: digits

    digits = to_text(rounded(value, 'rn'))
  end function short_text

  !> A number rounded up to three digits, as a lower bound that can be typed.
  pure function text_at_least(value) result(digits)
    real(wp), intent(in) :: value
    !> Such as 0.00346
    character(len=:), allocatable :: digits

    digits = to_text(rounded(value, 'ru'))
  end function text_at_least

  !> A number rounded down to three digits, as an upper bound that can be typed.
  pure function text_at_most(value) result(digits)
    real(wp), intent(in) :: value
    !> Such as 0.00345
    character(len=:), allocatable :: digits

    digits = to_text(rounded(value, 'rd'))
  end function text_at_most

  !> A number to three digits.
  pure real(wp) function rounded(value, mode)
    real(wp), intent(in) :: value
    !> Mode of rounding as in formats: rn to the nearest, ru up, rd down
    character(len=2), intent(in) :: mode
    character(len=12) :: digits

    write (digits, '(rn,es12.2e3)') value
    read (digits, *) rounded
    ! The binary form of 0.005 is above 0.005 and would be rounded up to 0.00501.
    if (abs(rounded - value) <= rounding_tolerance*abs(value)) return
    write (digits, '('//mode//',es12.2e3)') value
    read (digits, *) rounded
  end function rounded
end module short_numbers
