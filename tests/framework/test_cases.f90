!> What a test is given: a fixture, a parameter, processes.
module test_cases
  use mpi, only: MPI_COMM_NULL, MPI_Comm_rank, MPI_Comm_size
  implicit none
  private
  public :: AbstractTestParameter, TestCase, ParameterizedTestCase, MpiTestCase, MpiTestMethod

  !> A value that a test is run with
  type, abstract :: AbstractTestParameter
  contains
    procedure(to_string), deferred :: toString
  end type AbstractTestParameter

  abstract interface
    !> The value written out, for the name of the test.
    function to_string(this) result(string)
      import :: AbstractTestParameter
      !> The value
      class(AbstractTestParameter), intent(in) :: this
      character(len=:), allocatable :: string
    end function to_string
  end interface

  !> Ground for a test: set up before it, torn down after it
  type :: TestCase
  contains
    procedure :: setUp
    procedure :: tearDown
    procedure :: join
  end type TestCase

  !> Ground that is built from a parameter
  type, extends(TestCase) :: ParameterizedTestCase
  end type ParameterizedTestCase

  !> Ground for a test on several processes
  type, extends(ParameterizedTestCase) :: MpiTestCase
    private
    !> Processes that run the test
    integer :: communicator = MPI_COMM_NULL
  contains
    procedure :: join => join_processes
    procedure :: getMpiCommunicator
    procedure :: getProcessRank
    procedure :: getNumProcesses
  end type MpiTestCase

  !> A test on several processes without more ground than these
  type, extends(MpiTestCase) :: MpiTestMethod
  end type MpiTestMethod

contains

  !> Nothing to set up.
  subroutine setUp(this)
    !> Ground for the test
    class(TestCase), intent(inout) :: this
  end subroutine setUp

  !> Nothing to tear down.
  subroutine tearDown(this)
    !> Ground for the test
    class(TestCase), intent(inout) :: this
  end subroutine tearDown

  !> A test on one process needs no communicator.
  subroutine join(this, communicator)
    !> Ground for the test
    class(TestCase), intent(inout) :: this
    !> Processes that run the test
    integer, intent(in) :: communicator
  end subroutine join

  !> Takes the processes that run the test.
  subroutine join_processes(this, communicator)
    !> Ground for the test
    class(MpiTestCase), intent(inout) :: this
    !> Processes that run the test
    integer, intent(in) :: communicator

    this%communicator = communicator
  end subroutine join_processes

  !> Communicator of the processes that run the test.
  integer function getMpiCommunicator(this)
    !> Ground for the test
    class(MpiTestCase), intent(in) :: this

    getMpiCommunicator = this%communicator
  end function getMpiCommunicator

  !> Rank of this process among them.
  integer function getProcessRank(this)
    !> Ground for the test
    class(MpiTestCase), intent(in) :: this
    integer :: ignored

    call MPI_Comm_rank(this%communicator, getProcessRank, ignored)
  end function getProcessRank

  !> Number of processes that run the test.
  integer function getNumProcesses(this)
    !> Ground for the test
    class(MpiTestCase), intent(in) :: this
    integer :: ignored

    call MPI_Comm_size(this%communicator, getNumProcesses, ignored)
  end function getNumProcesses
end module test_cases
