!> Exact sums of reals, rounded once at the end, independent of the order of the terms and of their distribution over
!> ranks.
!>
!> Small superaccumulator of R. M. Neal, Fast exact summation using small and large superaccumulators (2015,
!> arXiv:1505.05571): a fixed-point number as wide as the range of double precision, in chunks of 64 bits whose lowest
!> bits are 32 bits apart. The upper half of a chunk receives carries. Here a term is split into three parts below 2^32
!> instead of two, so that carries are due after 2^30 terms instead of 2^11.
!>
!> Lists are first reduced block by block: (s + x) - s, with a power of two s larger than the sum of a block, is the
!> leading part of x, all leading parts of the block have an exact sum in double precision, and what is left of x is
!> exact, too (S. M. Rump, T. Ogita, S. Oishi, SIAM Journal on Scientific Computing 31 (2008) 189-224). These loops are
!> vectorized.
module exact_sums
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_quiet_nan, ieee_positive_inf, ieee_negative_inf
  use kinds, only: wp, long
  implicit none
  private
  public :: exact_sum_t

  !> Bits of the fraction, of a place, and unit of the lowest place as a power of two: the smallest denormal number
  integer, parameter :: fraction_bits = 52, place_bits = 32, lowest = -1074
  !> Largest exponent, which represents infinities and NaN
  integer, parameter :: not_finite = 2047
  !> Places for exponents up to 2046 with 53 bits behind, then room for the carries of 2^63 terms
  integer, parameter :: highest = not_finite - 1 + fraction_bits
  integer, parameter :: places = (highest - mod(highest, place_bits))/place_bits + 3
  !> Number of leading bits of a sum from which it is rounded: as many as an integer of 64 bits has besides its sign,
  !> less one; a real has 53, and one more resolves a tie
  integer, parameter :: leading_bits = 62
  !> Terms after which carries are due: each adds less than 2^32 to a chunk with a capacity of 2^63
  integer, parameter :: max_terms = 2**30
  !> Terms of a block: columns of as many as a vector has, fewer than 2^block_bits with two more
  integer, parameter :: columns = 64, width = 8, block_bits = 10
  !> Largest number of leading parts: the rest of a double whose exponent is at least 76 below the largest, or of one in
  !> the range of denormal numbers, is added by itself
  integer, parameter :: max_parts = 3
  !> Largest number in a place, and fraction, as masks
  integer(long), parameter :: place_mask = 2_long**place_bits - 1, fraction_mask = 2_long**fraction_bits - 1

  !> A sum.
  type :: exact_sum_t
    !> The places from the lowest, each with its sign, then how many terms were +Inf, -Inf and NaN. Sums over parts are
    !> added number by number after `carry`
    integer(long) :: chunks(places + 3) = 0
    !> Terms since carries were propagated
    integer, private :: terms = 0
  contains
    !> Adds terms.
    generic :: add => add_value, add_values, add_table
    procedure, private :: add_value, add_values, add_table
    procedure :: carry
    procedure :: rounded
  end type exact_sum_t

contains

  !> Adds a term.
  pure subroutine add_value(self, value)
    class(exact_sum_t), intent(inout) :: self
    !> The term
    real(wp), intent(in) :: value
    integer(long) :: bits, fraction, upper, sign
    integer :: exponent, place

    if (value == 0) return
    bits = transfer(value, bits)
    exponent = int(iand(shiftr(bits, fraction_bits), int(not_finite, long)))
    fraction = iand(bits, fraction_mask)
    if (exponent == not_finite) then
      place = places + merge(3, merge(2, 1, bits < 0), fraction /= 0)
      self%chunks(place) = self%chunks(place) + 1
      return
    end if
    if (exponent > 0) then
      fraction = ibset(fraction, fraction_bits)
      exponent = exponent - 1
    end if
    place = 1 + exponent/place_bits
    exponent = iand(exponent, place_bits - 1)
    ! The fraction moves up by less than 32 bits and takes three places.
    upper = shiftr(fraction, place_bits - exponent)
    fraction = iand(shiftl(fraction, exponent), place_mask)
    ! 0 or -1: its exclusive or, less itself, is the number or its negative.
    sign = shifta(bits, bit_size(bits) - 1)
    self%chunks(place) = self%chunks(place) + ieor(fraction, sign) - sign
    self%chunks(place + 1) = self%chunks(place + 1) + ieor(iand(upper, place_mask), sign) - sign
    self%chunks(place + 2) = self%chunks(place + 2) + ieor(shiftr(upper, place_bits), sign) - sign
    self%terms = self%terms + 1
    if (self%terms == max_terms) call self%carry()
  end subroutine add_value

  !> Adds a list of terms.
  pure subroutine add_values(self, values)
    class(exact_sum_t), intent(inout) :: self
    !> The terms
    real(wp), intent(in) :: values(:)
    integer :: i, last

    do i = 1, size(values), width*columns
      last = min(i + width*columns - 1, size(values))
      call add_block(self, last - i + 1, values(i:last))
    end do
  end subroutine add_values

  !> Adds a table of terms.
  pure subroutine add_table(self, values)
    class(exact_sum_t), intent(inout) :: self
    !> The terms
    real(wp), intent(in) :: values(:, :)

    call self%add_values(reshape(values, [size(values)]))
  end subroutine add_table

  !> Adds the terms of a block by their leading parts.
  pure subroutine add_block(self, terms, values)
    type(exact_sum_t), intent(inout) :: self
    !> Number of terms, that of a block at most
    integer, intent(in) :: terms
    !> The terms
    real(wp), intent(in) :: values(terms)
    real(wp) :: rest(width*columns), sums(width), unit, leading
    integer(long) :: bits(terms), largest
    integer :: part, i, k

    largest = 0
    bits = transfer(values, bits)
    do i = 1, terms
      largest = max(largest, ibclr(bits(i), bit_size(largest) - 1))
    end do
    if (largest == 0) return
    rest(:terms) = values
    rest(terms + 1:) = 0
    i = int(shiftr(largest, fraction_bits))
    ! The power of two above the largest magnitude, unless that is denormal or close to overflow or infinite.
    if (i > 0 .and. i < not_finite - 1 - block_bits) then
      unit = 2*real(transfer(shiftl(int(i, long), fraction_bits), unit), wp)
      do part = 1, max_parts
        unit = unit*2.0_wp**block_bits
        sums = 0
        do i = 1, width*columns, width
          do k = 1, width
            leading = (unit + rest(i + k - 1)) - unit
            rest(i + k - 1) = rest(i + k - 1) - leading
            sums(k) = sums(k) + leading
          end do
        end do
        call self%add_value(sum(sums))
        unit = unit*2.0_wp**(-fraction_bits - 1)
        if (.not. any(abs(rest) > 0)) return
      end do
    end if
    do i = 1, terms
      call self%add_value(rest(i))
    end do
  end subroutine add_block

  !> Propagates carries: all places but the highest are then from 0 to 2^32 - 1, and that one has the sign. Sums over up
  !> to 2^31 parts can then be added number by number.
  pure subroutine carry(self)
    class(exact_sum_t), intent(inout) :: self
    integer :: place

    do place = 1, places - 1
      ! An arithmetic shift rounds down, so that the remainder is not negative.
      self%chunks(place + 1) = self%chunks(place + 1) + shifta(self%chunks(place), place_bits)
      self%chunks(place) = iand(self%chunks(place), place_mask)
    end do
    self%terms = 0
  end subroutine carry

  !> The sum rounded to the nearest number, to the even one of two. Infinities and NaN are summed as reals are.
  pure real(wp) function rounded(self) result(value)
    class(exact_sum_t), intent(in) :: self
    type(exact_sum_t) :: magnitude
    logical :: negative

    associate (specials => self%chunks(places + 1:))
      if (any(specials /= 0)) then
        value = ieee_value(value, ieee_quiet_nan)
        if (specials(3) == 0 .and. specials(2) == 0) value = ieee_value(value, ieee_positive_inf)
        if (specials(3) == 0 .and. specials(1) == 0) value = ieee_value(value, ieee_negative_inf)
        return
      end if
    end associate
    magnitude = self
    call magnitude%carry()
    negative = magnitude%chunks(places) < 0
    if (negative) then
      magnitude%chunks = -magnitude%chunks
      call magnitude%carry()
    end if
    value = rounded_magnitude(magnitude%chunks(:places))
    if (negative) value = -value
  end function rounded

  !> A number that is not negative, rounded to the nearest.
  pure real(wp) function rounded_magnitude(chunks) result(value)
    !> Its digits in base 2^32
    integer(long), intent(in) :: chunks(:)
    integer(long) :: leading
    integer :: top, dropped, place, within

    do top = size(chunks), 2, -1
      if (chunks(top) /= 0) exit
    end do
    dropped = max(0, place_bits*(top - 1) + 2*place_bits - leadz(chunks(top)) - leading_bits)
    place = 1 + dropped/place_bits
    within = mod(dropped, place_bits)
    leading = shiftr(chunks(place), within)
    if (place < top) leading = leading + shiftl(chunks(place + 1), place_bits - within)
    if (place + 1 < top) leading = leading + shiftl(chunks(place + 2), 2*place_bits - within)
    ! Dropped bits matter only to a tie: one bit represents all of them.
    if (any(chunks(:place - 1) /= 0) .or. trailz(chunks(place)) < within) leading = ibset(leading, 0)
    value = scale(real(leading, wp), dropped + lowest)
  end function rounded_magnitude
end module exact_sums
