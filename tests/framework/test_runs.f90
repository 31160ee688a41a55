!> A run of tests: selection, processes, results, and the exit code of the program.
module test_runs
  use, intrinsic :: iso_fortran_env, only: output_unit
  use mpi, only: MPI_CHARACTER, MPI_COMM_NULL, MPI_COMM_WORLD, MPI_INTEGER, MPI_UNDEFINED, &
                 MPI_Comm_free, MPI_Comm_rank, MPI_Comm_size, MPI_Comm_split, MPI_Finalize, MPI_Gather, MPI_Init
  use test_failures, only: add_failure, take_failures
  implicit none
  private
  public :: test_run

  !> Exit code of a run with a failure, or without a test
  integer, parameter :: exit_failed = 2

  !> A run of tests
  type :: test_run
    private
    !> Rank of this process and number of processes
    integer :: rank = 0, processes = 1
    !> Processes of the current test; MPI_COMM_NULL on those that do not take part
    integer, public :: communicator = MPI_COMM_NULL
    !> Numbers of tests run, failed and disabled
    integer :: finished = 0, failed = 0, disabled = 0
    !> Whether each test is announced
    logical :: verbose = .false.
    !> Only tests with this text in their name are run
    character(len=:), allocatable :: pattern
    !> Name of the current test; not allocated if it is not to be run
    character(len=:), allocatable :: name
  contains
    procedure :: start
    procedure :: begins
    procedure :: ends
    procedure :: skips
    procedure :: finish
  end type test_run

contains

  !> Starts MPI and reads the arguments: -v announces each test, -f PATTERN selects some.
  subroutine start(this)
    !> The run
    class(test_run), intent(inout) :: this
    character(len=256) :: argument
    integer :: i, ignored

    call MPI_Init(ignored)
    call MPI_Comm_rank(MPI_COMM_WORLD, this%rank, ignored)
    call MPI_Comm_size(MPI_COMM_WORLD, this%processes, ignored)
    this%pattern = ''
    do i = 1, command_argument_count()
      call get_command_argument(i, argument)
      if (argument == '-v') this%verbose = .true.
      if (argument == '-f' .and. i < command_argument_count()) then
        call get_command_argument(i + 1, argument)
        this%pattern = trim(argument)
      end if
    end do
  end subroutine start

  !> Announces a test; true if it is to be run, on this process.
  logical function begins(this, name, processes)
    !> The run
    class(test_run), intent(inout) :: this
    !> Name of the test
    character(len=*), intent(in) :: name
    !> Number of processes that it requires
    integer, intent(in) :: processes
    integer :: colour, ignored

    begins = .false.
    if (index(name, this%pattern) == 0) return
    this%name = name
    if (this%verbose .and. this%rank == 0) write (output_unit, '(a)') 'running '//name
    if (processes > this%processes) then
      if (this%rank == 0) call add_failure('the test needs more processes than there are')
      return
    end if
    colour = merge(0, MPI_UNDEFINED, this%rank < processes)
    call MPI_Comm_split(MPI_COMM_WORLD, colour, this%rank, this%communicator, ignored)
    begins = colour == 0
  end function begins

  !> Collects the results of the current test on all processes.
  subroutine ends(this)
    !> The run
    class(test_run), intent(inout) :: this
    character(len=:), allocatable :: failures
    integer :: ignored

    if (.not. allocated(this%name)) return
    if (this%communicator /= MPI_COMM_NULL) call MPI_Comm_free(this%communicator, ignored)
    call take_failures(failures)
    call gather(failures, this%rank, this%processes)
    this%finished = this%finished + 1
    if (this%rank == 0 .and. len(failures) > 0) then
      this%failed = this%failed + 1
      write (output_unit, '(a)') 'FAILED '//this%name, failures(:len(failures) - 1)
      flush (output_unit)
    end if
    deallocate (this%name)
  end subroutine ends

  !> Counts a test that is disabled.
  subroutine skips(this, name)
    !> The run
    class(test_run), intent(inout) :: this
    !> Name of the test
    character(len=*), intent(in) :: name

    if (this%rank == 0) write (output_unit, '(a)') 'disabled '//name
    this%disabled = this%disabled + 1
  end subroutine skips

  !> Prints the totals and ends the program. A run without a test has failed, too.
  subroutine finish(this)
    !> The run
    class(test_run), intent(inout) :: this
    integer :: ignored

    call MPI_Finalize(ignored)
    if (this%rank /= 0) return
    write (output_unit, '(3(i0,a))') this%finished, ' tests run, ', this%failed, ' failed, ', this%disabled, ' disabled'
    if (this%finished == 0) write (output_unit, '(a)') 'no test was run: that is a failure'
    flush (output_unit)
    if (this%failed > 0 .or. this%finished == 0) stop exit_failed
  end subroutine finish

  !> Joins the texts of all processes on the first one, each line with its rank.
  subroutine gather(text, rank, processes)
    !> Text of this process; on the first one afterwards that of all
    character(len=:), allocatable, intent(inout) :: text
    !> Rank of this process and number of processes
    integer, intent(in) :: rank, processes
    character(len=4096) :: mine
    character(len=4096), allocatable :: all_texts(:)
    character(len=16) :: label
    integer :: i, ignored

    if (processes == 1) return
    mine = text
    allocate (all_texts(processes))
    call MPI_Gather(mine, len(mine), MPI_CHARACTER, all_texts, len(mine), MPI_CHARACTER, 0, MPI_COMM_WORLD, ignored)
    text = ''
    if (rank /= 0) return
    do i = 1, processes
      write (label, '("  process ",i0,":")') i - 1
      if (len_trim(all_texts(i)) > 0) text = text//trim(label)//new_line('a')//trim(all_texts(i))
    end do
  end subroutine gather
end module test_runs
