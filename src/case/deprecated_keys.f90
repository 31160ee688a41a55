!> Keys and values of the deck that are deprecated. A row warns for one minor version and is then removed
!> (doc/policy.md); `ctest -R lint_version` fails while a row is older than that.
module deprecated_keys
  use deprecated_names, only: deprecation_row_length
  implicit none
  private

  !> Group, key, value or - if the key itself is deprecated, replacement or - if there is none, first version that
  !> warns. For example 'time | settling | - | settle | 0.2.0'.
  character(len=*), parameter, public :: deprecated_rows(*) = [character(len=deprecation_row_length) ::]
end module deprecated_keys
