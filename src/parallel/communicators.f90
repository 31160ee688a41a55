!> The ranks of a run and what they say to each other. Only this folder knows of MPI; on one rank
!> every procedure returns at once, so a communicator that was never set up serves serial work.
module communicators
  use mpi_f08, only: MPI_Comm, MPI_COMM_WORLD, MPI_IN_PLACE, MPI_DOUBLE_PRECISION, MPI_INTEGER, MPI_INTEGER8, &
                     MPI_LOGICAL, MPI_CHARACTER, MPI_SUM, MPI_MAX, MPI_MIN, MPI_LOR, MPI_Op, MPI_Init, &
                     MPI_Initialized, MPI_Finalize, MPI_Comm_rank, MPI_Comm_size, MPI_Allreduce, MPI_Bcast, &
                     MPI_Allgather, MPI_Allgatherv, MPI_Gatherv, MPI_Exscan, MPI_Barrier
  use errors, only: error_t
  use kinds, only: wp, long
  implicit none
  private
  public :: communicator_t, start_mpi, finish_mpi, communicator_from_handle

  !> A group of ranks. By default one rank, without MPI.
  type :: communicator_t
    !> Number of this rank, from 0
    integer :: rank = 0
    !> Number of ranks
    integer :: size = 1
    !> MPI's own object, undefined until set up by `start_mpi` or `communicator_from_handle`
    type(MPI_Comm), private :: group
  contains
    !> The integer handle that PETSc and HDF5 ask for.
    procedure :: handle
    !> Whether this is rank 0, which writes.
    procedure :: is_root
    !> Replaces a value by its sum over the ranks, the same on every rank.
    generic :: sum => sum_real, sum_reals, sum_integer, sum_long
    !> Replaces a value by its greatest over the ranks.
    generic :: maximum => maximum_real, maximum_integer
    !> Replaces a value by its least over the ranks.
    generic :: minimum => minimum_real, minimum_integer
    !> Whether a flag is raised on at least one rank.
    procedure :: any => any_flag
    !> Whether a flag is raised on every rank.
    procedure :: all => all_flags
    !> Sum of a count over the ranks before this one.
    procedure :: preceding
    !> Copies a value of rank 0 to every rank.
    generic :: broadcast => broadcast_real, broadcast_reals, broadcast_integer, broadcast_integers, &
      broadcast_logical, broadcast_characters
    !> Copies a text of rank 0, whatever its length, to every rank.
    procedure :: broadcast_text
    !> Strings the parts of all ranks together on rank 0, in the order of ranks; empty elsewhere.
    generic :: gather => gather_reals, gather_integers, gather_table
    !> Strings the parts of all ranks together on every rank, in the order of ranks.
    generic :: allgather => allgather_reals, allgather_integers
    !> Waits for all ranks.
    procedure :: barrier
    !> If any rank failed, gives every rank the error of the lowest rank that did.
    procedure :: agree
    procedure, private :: sum_real, sum_reals, sum_integer, sum_long
    procedure, private :: maximum_real, maximum_integer, minimum_real, minimum_integer
    procedure, private :: broadcast_real, broadcast_reals, broadcast_integer, broadcast_integers
    procedure, private :: broadcast_logical, broadcast_characters
    procedure, private :: gather_reals, gather_integers, gather_table, allgather_reals, allgather_integers
    procedure, private :: counts_of_ranks
  end type communicator_t

contains

  !> Starts MPI and hands over the communicator of all ranks.
  subroutine start_mpi(communicator)
    !> All ranks of the run
    type(communicator_t), intent(out) :: communicator
    logical :: running

    call MPI_Initialized(running)
    if (.not. running) call avoid_named_semaphores()
    if (.not. running) call MPI_Init()
    communicator = communicator_from_handle(MPI_COMM_WORLD%mpi_val)
  end subroutine start_mpi

  !> Keeps Open MPI's parallel files off named semaphores, which outlive a killed run and make every later run that
  !> opens a file of the same name wait for ever. Nothing here uses what they are for (shared file pointers), and a
  !> choice of the user's own is left alone. Other MPI libraries ignore the variable.
  subroutine avoid_named_semaphores()
    use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
    interface
      !> C library: sets a variable of the environment.
      integer(c_int) function setenv(name, value, overwrite) bind(c, name='setenv')
        import :: c_char, c_int
        !> Name and value
        character(kind=c_char), intent(in) :: name(*), value(*)
        !> 0: a variable that is set stays as it is
        integer(c_int), value :: overwrite
      end function setenv
    end interface
    integer(c_int) :: status

    status = setenv('OMPI_MCA_sharedfp'//c_null_char, '^sm'//c_null_char, 0_c_int)
  end subroutine avoid_named_semaphores

  !> Ends MPI; nothing may be said between ranks afterwards.
  subroutine finish_mpi()
    call MPI_Finalize()
  end subroutine finish_mpi

  !> The communicator behind an integer handle.
  function communicator_from_handle(handle) result(communicator)
    !> Handle of MPI's Fortran interfaces
    integer, intent(in) :: handle
    !> Its ranks
    type(communicator_t) :: communicator

    communicator%group%mpi_val = handle
    call MPI_Comm_rank(communicator%group, communicator%rank)
    call MPI_Comm_size(communicator%group, communicator%size)
  end function communicator_from_handle

  !> The integer handle that PETSc and HDF5 ask for.
  pure integer function handle(self)
    class(communicator_t), intent(in) :: self

    handle = self%group%mpi_val
  end function handle

  !> Whether this is rank 0, which writes.
  pure logical function is_root(self)
    class(communicator_t), intent(in) :: self

    is_root = self%rank == 0
  end function is_root

  !> Sum of a real over the ranks.
  subroutine sum_real(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's share; the sum on return
    real(wp), intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_SUM, self%group)
  end subroutine sum_real

  !> Sum of a list of reals over the ranks, item by item.
  subroutine sum_reals(self, values)
    class(communicator_t), intent(in) :: self
    !> This rank's shares; the sums on return
    real(wp), contiguous, intent(inout) :: values(:)

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, values, size(values), MPI_DOUBLE_PRECISION, MPI_SUM, self%group)
  end subroutine sum_reals

  !> Sum of an integer over the ranks.
  subroutine sum_integer(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's share; the sum on return
    integer, intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_SUM, self%group)
  end subroutine sum_integer

  !> Sum of a long integer over the ranks.
  subroutine sum_long(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's share; the sum on return
    integer(long), intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER8, MPI_SUM, self%group)
  end subroutine sum_long

  !> Greatest real of the ranks.
  subroutine maximum_real(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's value; the greatest on return
    real(wp), intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_MAX, self%group)
  end subroutine maximum_real

  !> Greatest integer of the ranks.
  subroutine maximum_integer(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's value; the greatest on return
    integer, intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_MAX, self%group)
  end subroutine maximum_integer

  !> Least real of the ranks.
  subroutine minimum_real(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's value; the least on return
    real(wp), intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_MIN, self%group)
  end subroutine minimum_real

  !> Least integer of the ranks.
  subroutine minimum_integer(self, value)
    class(communicator_t), intent(in) :: self
    !> This rank's value; the least on return
    integer, intent(inout) :: value

    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_MIN, self%group)
  end subroutine minimum_integer

  !> Whether a flag is raised on at least one rank.
  logical function any_flag(self, flag) result(raised)
    class(communicator_t), intent(in) :: self
    !> This rank's flag
    logical, intent(in) :: flag

    raised = flag
    if (self%size == 1) return
    call MPI_Allreduce(MPI_IN_PLACE, raised, 1, MPI_LOGICAL, MPI_LOR, self%group)
  end function any_flag

  !> Whether a flag is raised on every rank.
  logical function all_flags(self, flag) result(raised)
    class(communicator_t), intent(in) :: self
    !> This rank's flag
    logical, intent(in) :: flag

    raised = .not. self%any(.not. flag)
  end function all_flags

  !> Sum of a count over the ranks before this one.
  integer function preceding(self, count)
    class(communicator_t), intent(in) :: self
    !> This rank's count
    integer, intent(in) :: count

    preceding = 0
    if (self%size == 1) return
    call MPI_Exscan(count, preceding, 1, MPI_INTEGER, MPI_SUM, self%group)
    if (self%rank == 0) preceding = 0
  end function preceding

  !> Copies a real of rank 0 to every rank.
  subroutine broadcast_real(self, value)
    class(communicator_t), intent(in) :: self
    !> The value; read on rank 0 only
    real(wp), intent(inout) :: value

    if (self%size > 1) call MPI_Bcast(value, 1, MPI_DOUBLE_PRECISION, 0, self%group)
  end subroutine broadcast_real

  !> Copies a list of reals of rank 0 to every rank.
  subroutine broadcast_reals(self, values)
    class(communicator_t), intent(in) :: self
    !> The list, equally long on every rank; read on rank 0 only
    real(wp), contiguous, intent(inout) :: values(:)

    if (self%size > 1) call MPI_Bcast(values, size(values), MPI_DOUBLE_PRECISION, 0, self%group)
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

  !> Strings lists of reals together on rank 0.
  subroutine gather_reals(self, part, whole)
    class(communicator_t), intent(in) :: self
    !> This rank's list
    real(wp), contiguous, intent(in) :: part(:)
    !> The lists of all ranks in the order of ranks; empty on ranks other than 0
    real(wp), allocatable, intent(out) :: whole(:)
    integer :: counts(self%size), offsets(self%size)

    call self%counts_of_ranks(size(part), counts, offsets)
    allocate (whole(merge(sum(counts), 0, self%is_root())))
    if (self%size == 1) then
      whole = part
    else
      call MPI_Gatherv(part, size(part), MPI_DOUBLE_PRECISION, whole, counts, offsets, MPI_DOUBLE_PRECISION, 0, &
                       self%group)
    end if
  end subroutine gather_reals

  !> Strings lists of integers together on rank 0.
  subroutine gather_integers(self, part, whole)
    class(communicator_t), intent(in) :: self
    !> This rank's list
    integer, contiguous, intent(in) :: part(:)
    !> The lists of all ranks in the order of ranks; empty on ranks other than 0
    integer, allocatable, intent(out) :: whole(:)
    integer :: counts(self%size), offsets(self%size)

    call self%counts_of_ranks(size(part), counts, offsets)
    allocate (whole(merge(sum(counts), 0, self%is_root())))
    if (self%size == 1) then
      whole = part
    else
      call MPI_Gatherv(part, size(part), MPI_INTEGER, whole, counts, offsets, MPI_INTEGER, 0, self%group)
    end if
  end subroutine gather_integers

  !> Strings tables together on rank 0, column after column.
  subroutine gather_table(self, part, whole)
    class(communicator_t), intent(in) :: self
    !> This rank's columns, of the same height on every rank
    real(wp), contiguous, intent(in) :: part(:, :)
    !> The columns of all ranks in the order of ranks; no columns on ranks other than 0
    real(wp), allocatable, intent(out) :: whole(:, :)
    integer :: counts(self%size), offsets(self%size)

    call self%counts_of_ranks(size(part), counts, offsets)
    allocate (whole(size(part, 1), merge(sum(counts)/max(size(part, 1), 1), 0, self%is_root())))
    if (self%size == 1) then
      whole = part
    else
      call MPI_Gatherv(part, size(part), MPI_DOUBLE_PRECISION, whole, counts, offsets, MPI_DOUBLE_PRECISION, 0, &
                       self%group)
    end if
  end subroutine gather_table

  !> Strings lists of reals together on every rank.
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

  !> Strings lists of integers together on every rank.
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

  !> Waits for all ranks.
  subroutine barrier(self)
    class(communicator_t), intent(in) :: self

    if (self%size > 1) call MPI_Barrier(self%group)
  end subroutine barrier

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
