!> A group of ranks and the numbers that all of them combine: sums, extremes, flags. On one rank every procedure
!> returns at once.
module rank_groups
  use mpi_f08, only: MPI_Comm, MPI_COMM_SELF, MPI_IN_PLACE, MPI_DOUBLE_PRECISION, MPI_INTEGER, MPI_INTEGER8, &
                     MPI_LOGICAL, MPI_SUM, MPI_MAX, MPI_MIN, MPI_LOR, MPI_Allreduce, MPI_Exscan, &
                     MPI_Barrier
  use kinds, only: wp, long
  implicit none
  private
  public :: rank_group_t

  !> A group of ranks. By default one rank, without MPI.
  type :: rank_group_t
    !> Number of this rank, from 0
    integer :: rank = 0
    !> Number of ranks
    integer :: size = 1
    !> MPI's own object, undefined until MPI has been started; for the modules of this folder only
    type(MPI_Comm) :: group
  contains
    procedure :: handle
    procedure :: is_root
    !> Replaces a value by its sum over the ranks, the same on every rank.
    generic :: sum => sum_real, sum_reals, sum_table, sum_integer, sum_long, sum_longs
    !> Replaces a value by its greatest over the ranks.
    generic :: maximum => maximum_real, maximum_reals, maximum_integer
    !> Replaces a value by its least over the ranks.
    generic :: minimum => minimum_real, minimum_integer
    procedure :: any => any_flag
    procedure :: all => all_flags
    procedure :: preceding
    procedure :: barrier
    procedure, private :: sum_real, sum_reals, sum_table, sum_integer, sum_long, sum_longs
    procedure, private :: maximum_real, maximum_reals, maximum_integer, minimum_real, minimum_integer
  end type rank_group_t

contains

  !> The integer handle for PETSc and HDF5. A single rank may have been set up before MPI.
  pure integer function handle(self)
    class(rank_group_t), intent(in) :: self

    handle = MPI_COMM_SELF%mpi_val
    if (self%size > 1) handle = self%group%mpi_val
  end function handle

  !> Whether this is rank 0, which writes.
  pure logical function is_root(self)
    class(rank_group_t), intent(in) :: self

    is_root = self%rank == 0
  end function is_root

  !> Sum of a real over the ranks.
  subroutine sum_real(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's contribution; the sum on return
    real(wp), intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_SUM, self%group)
  end subroutine sum_real

  !> Sum of a list of reals over the ranks, item by item.
  subroutine sum_reals(self, values)
    class(rank_group_t), intent(in) :: self
    !> This rank's contributions; the sums on return
    real(wp), contiguous, intent(inout) :: values(:)

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, values, size(values), MPI_DOUBLE_PRECISION, MPI_SUM, self%group)
  end subroutine sum_reals

  !> Sum of a table of reals over the ranks, item by item.
  subroutine sum_table(self, values)
    class(rank_group_t), intent(in) :: self
    !> This rank's contributions; the sums on return
    real(wp), contiguous, intent(inout) :: values(:, :)

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, values, size(values), MPI_DOUBLE_PRECISION, MPI_SUM, self%group)
  end subroutine sum_table

  !> Sum of an integer over the ranks.
  subroutine sum_integer(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's contribution; the sum on return
    integer, intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_SUM, self%group)
  end subroutine sum_integer

  !> Sum of a long integer over the ranks.
  subroutine sum_long(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's contribution; the sum on return
    integer(long), intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER8, MPI_SUM, self%group)
  end subroutine sum_long

  !> Sum of a list of long integers over the ranks, item by item.
  subroutine sum_longs(self, values)
    class(rank_group_t), intent(in) :: self
    !> This rank's contributions; the sums on return
    integer(long), contiguous, intent(inout) :: values(:)

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, values, size(values), MPI_INTEGER8, MPI_SUM, self%group)
  end subroutine sum_longs

  !> Greatest real of the ranks.
  subroutine maximum_real(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's value; the greatest on return
    real(wp), intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_MAX, self%group)
  end subroutine maximum_real

  !> Greatest reals of the ranks, item by item.
  subroutine maximum_reals(self, values)
    class(rank_group_t), intent(in) :: self
    !> This rank's values; the greatest on return
    real(wp), contiguous, intent(inout) :: values(:)

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, values, size(values), MPI_DOUBLE_PRECISION, MPI_MAX, self%group)
  end subroutine maximum_reals

  !> Greatest integer of the ranks.
  subroutine maximum_integer(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's value; the greatest on return
    integer, intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_MAX, self%group)
  end subroutine maximum_integer

  !> Least real of the ranks.
  subroutine minimum_real(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's value; the least on return
    real(wp), intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_DOUBLE_PRECISION, MPI_MIN, self%group)
  end subroutine minimum_real

  !> Least integer of the ranks.
  subroutine minimum_integer(self, value)
    class(rank_group_t), intent(in) :: self
    !> This rank's value; the least on return
    integer, intent(inout) :: value

    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, value, 1, MPI_INTEGER, MPI_MIN, self%group)
  end subroutine minimum_integer

  !> Whether a flag is raised on at least one rank.
  logical function any_flag(self, flag) result(raised)
    class(rank_group_t), intent(in) :: self
    !> This rank's flag
    logical, intent(in) :: flag

    raised = flag
    if (self%size > 1) call MPI_Allreduce(MPI_IN_PLACE, raised, 1, MPI_LOGICAL, MPI_LOR, self%group)
  end function any_flag

  !> Whether a flag is raised on every rank.
  logical function all_flags(self, flag) result(raised)
    class(rank_group_t), intent(in) :: self
    !> This rank's flag
    logical, intent(in) :: flag

    raised = .not. self%any(.not. flag)
  end function all_flags

  !> Sum of a count over the ranks before this one.
  integer function preceding(self, count)
    class(rank_group_t), intent(in) :: self
    !> This rank's count
    integer, intent(in) :: count

    preceding = 0
    if (self%size == 1) return
    call MPI_Exscan(count, preceding, 1, MPI_INTEGER, MPI_SUM, self%group)
    if (self%rank == 0) preceding = 0
  end function preceding

  !> Waits for all ranks.
  subroutine barrier(self)
    class(rank_group_t), intent(in) :: self

    if (self%size > 1) call MPI_Barrier(self%group)
  end subroutine barrier
end module rank_groups
