!> PETSc for the tests: started once before the first of them and not finalized, because the test framework has
!> finalized MPI by then.
module petsc_fixture
  use communicators, only: communicator_t, start_mpi
  use errors, only: error_t
  use petsc_session, only: start_petsc
  implicit none
  private
  public :: start_petsc_for_tests

contains

  !> Starts MPI unless the framework has, and PETSc on all its ranks.
  subroutine start_petsc_for_tests()
    type(communicator_t) :: world
    type(error_t), allocatable :: error

    call start_mpi(world)
    call start_petsc(world, '', error)
    if (allocated(error)) error stop 'PETSc did not start, so no test can run'
  end subroutine start_petsc_for_tests
end module petsc_fixture
