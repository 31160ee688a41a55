!> The ranks of a run and their communication. Only this folder uses MPI. On one rank every procedure returns at once,
!> so that a communicator without MPI can be used in serial runs.
module communicators
  use mpi_f08, only: MPI_COMM_WORLD, MPI_DOUBLE_PRECISION, MPI_INTEGER, MPI_LOGICAL, MPI_CHARACTER, MPI_Init, &
                     MPI_Initialized, MPI_Finalize, MPI_Comm_rank, MPI_Comm_size, MPI_Bcast, MPI_Allgather, &
                     MPI_Allgatherv
  use environment_variables, only: set_environment_variable
  use errors, only: error_t
  use kinds, only: wp
  use launchers, only: launched
  use rank_groups, only: rank_group_t
  implicit none
  private
  public :: communicator_t, start_mpi, finish_mpi, communicator_from_handle

  !> A group of ranks that exchange data. By default one rank, without MPI.
  type, extends(rank_group_t) :: communicator_t
  contains
    !> Copies a value of rank 0, or a list of any rank, to every rank.
    generic :: broadcast => broadcast_real, broadcast_reals, broadcast_integer, broadcast_integers, &
      broadcast_logical, broadcast_characters
    procedure :: broadcast_text
    !> Concatenates the parts of all ranks on every rank, in the order of ranks.
    generic :: allgather => allgather_reals, allgather_integers
    procedure :: agree
    procedure, private :: broadcast_real, broadcast_reals, broadcast_integer, broadcast_integers
    procedure, private :: broadcast_logical, broadcast_characters
    procedure, private :: allgather_reals, allgather_integers
    procedure, private :: counts_of_ranks
  end type communicator_t

contains

  !> Starts MPI, unless it runs, and hands over the communicator of all ranks.
  subroutine start_mpi(communicator)
    type(communicator_t), intent(out) :: communicator
    logical :: running

    call MPI_Initialized(running)
    if (.not. running) call set_open_mpi()
    if (.not. running) call MPI_Init()
    communicator = communicator_from_handle(MPI_COMM_WORLD%mpi_val)
  end subroutine start_mpi

  !> Sets parameters of Open MPI. Values of the user are kept, and other MPI libraries ignore these variables.
  !>
  !> Shared file pointers, which are not used, would need named semaphores (sm) or lock files (lockedfile). Both outlive
  !> a killed run; the first block later runs that open a file of the same name, the second limit its name to 256
  !> characters. The remaining method needs two files, removed when the file is closed.
  !>
  !> A run without mpirun does not start the daemon for further processes, whose start took longer than the rest of
  !> MPI's. It does not create a folder shared with other ranks: all such runs of a machine would use the same folder,
  !> which one run removes while another begins; about one start in 240 failed with six at a time.
  subroutine set_open_mpi()
    call set_environment_variable('OMPI_MCA_sharedfp', '^sm,lockedfile', overwrite=.false.)
    if (launched()) return
    call set_environment_variable('OMPI_MCA_ess_singleton_isolated', '1', overwrite=.false.)
    call set_environment_variable('OMPI_MCA_orte_create_session_dirs', '0', overwrite=.false.)
  end subroutine set_open_mpi

  !> Ends MPI if it was started; no communication is possible afterwards.
  subroutine finish_mpi()
    logical :: running

    call MPI_Initialized(running)
    if (running) call MPI_Finalize()
  end subroutine finish_mpi

  !> The communicator behind an integer handle.
  function communicator_from_handle(handle) result(communicator)
    !> Handle of MPI's Fortran interfaces
    integer, intent(in) :: handle
    type(communicator_t) :: communicator

    communicator%group%mpi_val = handle
    call MPI_Comm_rank(communicator%group, communicator%rank)
    call MPI_Comm_size(communicator%group, communicator%size)
  end function communicator_from_handle

  !> Copies a real of rank 0 to every rank.
  subroutine broadcast_real(self, value)
    class(communicator_t), intent(in) :: self
    !> The value; read on rank 0 only
    real(wp), intent(inout) :: value

    if (self%size > 1) call MPI_Bcast(value, 1, MPI_DOUBLE_PRECISION, 0, self%group)
  end subroutine broadcast_real

  !> Copies a list of reals of one rank to every rank.
  subroutine broadcast_reals(self, values, from)
    class(communicator_t), intent(in) :: self
    !> The list, equally long on every rank; read on that rank only
    real(wp), contiguous, intent(inout) :: values(:)
    !> The rank; rank 0 if absent
    integer, intent(in), optional :: from
    integer :: rank

    rank = 0
    if (present(from)) rank = from
    if (self%size > 1) call MPI_Bcast(values, size(values), MPI_DOUBLE_PRECISION, rank, self%group)
  end subroutine broadcast_reals

  !> Copies an integer of rank 0 to every rank.
  subroutine broadcast_integer(self, value)
    class(communicator_t), intent(in) :: self
    !> The value; read on rank 0 only
    integer, intent(inout) :: value

    if (self%size > 1) call MPI_Bcast(value, 1, MPI_INTEGER, 0, self%group)
  end subroutine broadcast_integer

  !> Copies a list of integers of rank 0 to every rank.
  subroutine broadcast_integers(self, values)
    class(communicator_t), intent(in) :: self
    !> The list, equally long on every rank; read on rank 0 only
    integer, contiguous, intent(inout) :: values(:)

    if (self%size > 1) call MPI_Bcast(values, size(values), MPI_INTEGER, 0, self%group)
  end subroutine broadcast_integers

  !> Copies a logical of rank 0 to every rank.
  subroutine broadcast_logical(self, value)
    class(communicator_t), intent(in) :: self
    !> The value; read on rank 0 only
    logical, intent(inout) :: value

    if (self%size > 1) call MPI_Bcast(value, 1, MPI_LOGICAL, 0, self%group)
  end subroutine broadcast_logical

  !> Copies characters of rank 0 to every rank.
  subroutine broadcast_characters(self, value)
    class(communicator_t), intent(in) :: self
    !> The characters, equally many on every rank; read on rank 0 only
    character(len=*), intent(inout) :: value

    if (self%size > 1) call MPI_Bcast(value, len(value), MPI_CHARACTER, 0, self%group)
  end subroutine broadcast_characters

  !> Copies a text of rank 0, whatever its length, to every rank.
  subroutine broadcast_text(self, text)
    class(communicator_t), intent(in) :: self
    !> The text; read on rank 0 only, where it is allocated
    character(len=:), allocatable, intent(inout) :: text
    integer :: length

    if (self%size == 1) return
    length = 0
    if (self%is_root()) length = len(text)
    call self%broadcast(length)
    if (.not. self%is_root()) text = repeat(' ', length)
    call self%broadcast(text)
  end subroutine broadcast_text

  !> Concatenates lists of reals on every rank.
  subroutine allgather_reals(self, part, whole)
    class(communicator_t), intent(in) :: self
    !> This rank's list
    real(wp), contiguous, intent(in) :: part(:)
    !> The lists of all ranks in the order of ranks
    real(wp), allocatable, intent(out) :: whole(:)
    integer :: counts(self%size), offsets(self%size)

    call self%counts_of_ranks(size(part), counts, offsets)
    allocate (whole(sum(counts)))
    if (self%size == 1) then
      whole = part
    else
      call MPI_Allgatherv(part, size(part), MPI_DOUBLE_PRECISION, whole, counts, offsets, MPI_DOUBLE_PRECISION, &
                          self%group)
    end if
  end subroutine allgather_reals

  !> Concatenates lists of integers on every rank.
  subroutine allgather_integers(self, part, whole)
    class(communicator_t), intent(in) :: self
    !> This rank's list
    integer, contiguous, intent(in) :: part(:)
    !> The lists of all ranks in the order of ranks
    integer, allocatable, intent(out) :: whole(:)
    integer :: counts(self%size), offsets(self%size)

    call self%counts_of_ranks(size(part), counts, offsets)
    allocate (whole(sum(counts)))
    if (self%size == 1) then
      whole = part
    else
      call MPI_Allgatherv(part, size(part), MPI_INTEGER, whole, counts, offsets, MPI_INTEGER, self%group)
    end if
  end subroutine allgather_integers

  !> How many items each rank has, and how many precede them.
  subroutine counts_of_ranks(self, count, counts, offsets)
    class(communicator_t), intent(in) :: self
    !> Number of items of this rank
    integer, intent(in) :: count
    !> Number of items of each rank
    integer, intent(out) :: counts(:)
    !> Number of items of the ranks before each
    integer, intent(out) :: offsets(:)
    integer :: i

    counts(1) = count
    if (self%size > 1) call MPI_Allgather(count, 1, MPI_INTEGER, counts, 1, MPI_INTEGER, self%group)
    offsets = [(sum(counts(:i - 1)), i=1, self%size)]
  end subroutine counts_of_ranks

  !> If any rank failed, gives every rank the error of the lowest rank that did.
  subroutine agree(self, error)
    class(communicator_t), intent(in) :: self
    !> This rank's error, replaced by the one agreed upon
    type(error_t), allocatable, intent(inout) :: error
    integer :: first, length

    if (self%size == 1) return
    first = merge(self%rank, self%size, allocated(error))
    call self%minimum(first)
    if (first == self%size) return
    if (.not. allocated(error)) allocate (error)
    length = 0
    if (self%rank == first) length = len(error%message)
    call MPI_Bcast(length, 1, MPI_INTEGER, first, self%group)
    if (self%rank /= first) error%message = repeat(' ', length)
    call MPI_Bcast(error%code, 1, MPI_INTEGER, first, self%group)
    call MPI_Bcast(error%message, length, MPI_CHARACTER, first, self%group)
  end subroutine agree
end module communicators
