!> Modules for a test file on several processes.
module pfunit
  use funit
  use test_cases, only: MpiTestCase, MpiTestMethod
  implicit none
  public
end module pfunit
