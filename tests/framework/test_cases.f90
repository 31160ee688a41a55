!> Arguments of a test: a fixture, a parameter, processes.
module test_cases
  use mpi, only: MPI_COMM_NULL, MPI_Comm_rank, MPI_Comm_size
  implicit none
  private
  public :: AbstractTestParameter, TestCase, ParameterizedTestCase, MpiTestCase, MpiTestMethod

  !> A value with which a test is run
  type, abstract :: AbstractTestParameter
  contains
    procedure(to_string), deferred :: toString
  end type AbstractTestParameter

  abstract interface
    !> The value as text, for the name of the test.
    function to_string(this) result(string)
      import :: AbstractTestParameter
      !> The value
      class(AbstractTestParameter), intent(in) :: this
      character(len=:), allocatable :: string
    end function to_string
  end interface

  !> Fixture of a test: set up before it, torn down after it
  type :: TestCase
  contains
    procedure :: setUp
    procedure :: tearDown
    procedure :: join
  end type TestCase

  !> Fixture that is built from a parameter
  type, extends(TestCase) :: ParameterizedTestCase
  end type ParameterizedTestCase

  !> Fixture of a test on several processes
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

  !> A test on several processes without further fixture
  type, extends(MpiTestCase) :: MpiTestMethod
  end type MpiTestMethod

contains

  !> No set-up.
  subroutine setUp(this)
    !> The fixture
    class(TestCase), intent(inout) :: this
  end subroutine setUp

  !> No tear-down.
  subroutine tearDown(this)
    !> The fixture
    class(TestCase), intent(inout) :: this
  end subroutine tearDown

  !> A test on one process needs no communicator.
  subroutine join(this, communicator)
    !> The fixture
    class(TestCase), intent(inout) :: this
    !> Processes that run the test
    integer, intent(in) :: communicator
  end subroutine join

  !> Sets the processes that run the test.
  subroutine join_processes(this, communicator)
    !> The fixture
    class(MpiTestCase), intent(inout) :: this
    !> Processes that run the test
    integer, intent(in) :: communicator

    this%communicator = communicator
  end subroutine join_processes

  !> Communicator of the processes that run the test.
  integer function getMpiCommunicator(this)
    !> The fixture
    class(MpiTestCase), intent(in) :: this

    getMpiCommunicator = this%communicator
  end function getMpiCommunicator

  !> Rank of this process among them.
  integer function getProcessRank(this)
    !> The fixture
    class(MpiTestCase), intent(in) :: this
    integer :: ignored

    call MPI_Comm_rank(this%communicator, getProcessRank, ignored)
  end function getProcessRank

  !> Number of processes that run the test.
  integer function getNumProcesses(this)
    !> The fixture
    class(MpiTestCase), intent(in) :: this
    integer :: ignored

    call MPI_Comm_size(this%communicator, getNumProcesses, ignored)
  end function getNumProcesses
end module test_cases
