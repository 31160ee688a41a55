!> Modules for a test file on one process.
module funit
  use asserts
  use comparisons, only: KEEP_ALL, TRIM_ALL, IGNORE_DIFFERENCES, IGNORE_ALL
  use test_cases, only: AbstractTestParameter, ParameterizedTestCase, TestCase
  use test_failures, only: SourceLocation, anyExceptions
  implicit none
  public
end module funit
