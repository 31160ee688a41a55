!> Kinds of numbers used throughout.
module kinds
  use, intrinsic :: iso_fortran_env, only: real64, int64
  implicit none
  private

  !> Working precision of every physical quantity.
  integer, parameter, public :: wp = real64
  !> Counters that may pass 2**31 (bytes, element visits).
  integer, parameter, public :: long = int64
end module kinds
