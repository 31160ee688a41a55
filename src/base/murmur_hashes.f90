!> Reproducible random numbers of keys: MurmurHash3 of 32 bits (A. Appleby, 2011), the same on every machine, rank and
!> run. Numbers of 32 bits stand in 64-bit integers, in which no product overflows.
module murmur_hashes
  use kinds, only: long, wp
  implicit none
  private
  public :: murmur3, uniform_of

  !> Largest hash.
  integer(long), parameter :: mask = int(z'ffffffff', long)

contains

  !> Hash of 32-bit words, from 0 to 2^32 - 1.
  pure integer(long) function murmur3(words, seed) result(hash)
    !> Their low 32 bits count
    integer(long), intent(in) :: words(:)
    !> The same
    integer(long), intent(in) :: seed
    integer :: i

    hash = iand(seed, mask)
    do i = 1, size(words)
      hash = ieor(hash, product_of(turned(product_of(words(i), int(z'cc9e2d51', long)), 15), int(z'1b873593', long)))
      hash = iand(5*turned(hash, 13) + int(z'e6546b64', long), mask)
    end do
    hash = ieor(hash, 4_long*size(words))
    hash = product_of(ieor(hash, ishft(hash, -16)), int(z'85ebca6b', long))
    hash = product_of(ieor(hash, ishft(hash, -13)), int(z'c2b2ae35', long))
    hash = ieor(hash, ishft(hash, -16))
  end function murmur3

  !> A number between 0 and 1, neither of them, that grows with the hash.
  elemental real(wp) function uniform_of(hash)
    !> From 0 to 2^32 - 1
    integer(long), intent(in) :: hash

    uniform_of = (hash + 0.5_wp)/(mask + 1.0_wp)
  end function uniform_of

  !> Product of two words, its low 32 bits.
  elemental integer(long) function product_of(a, b) result(low)
    !> 32 bits each count
    integer(long), intent(in) :: a, b
    integer(long) :: upper

    upper = iand(b, mask)*ibits(a, 16, 16)
    low = iand(iand(b, mask)*ibits(a, 0, 16) + ishft(iand(upper, mask), 16), mask)
  end function product_of

  !> A word rotated to the left.
  elemental integer(long) function turned(word, bits)
    integer(long), intent(in) :: word
    !> By how much
    integer, intent(in) :: bits

    turned = ior(iand(ishft(word, bits), mask), ishft(word, bits - 32))
  end function turned
end module murmur_hashes
