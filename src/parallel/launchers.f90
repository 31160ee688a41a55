!> Whether a launcher such as mpirun has started this process.
module launchers
  implicit none
  private
  public :: launched

contains

  !> True if a launcher has started this process as a rank of a run: known launchers set the rank in an environment
  !> variable.
  logical function launched()
    !> Open MPI; PMIx (srun, prterun); PMI (MPICH, Intel MPI, srun); MVAPICH2
    character(len=*), parameter :: variables(*) = [character(len=20) :: 'OMPI_COMM_WORLD_RANK', 'PMIX_RANK', &
                                                   'PMI_RANK', 'MV2_COMM_WORLD_RANK']
    integer :: i, length

    launched = .false.
    do i = 1, size(variables)
      call get_environment_variable(trim(variables(i)), length=length)
      launched = launched .or. length > 0
    end do
  end function launched
end module launchers
