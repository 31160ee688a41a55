!> Settings of OpenBLAS, where that is the library of dense linear algebra: kernels for the processor at hand; and one
!> thread a rank, of OpenMP too.
module blas_settings
  use, intrinsic :: iso_c_binding, only: c_int, c_funptr, c_associated, c_f_procpointer
  use found_procedures, only: address_of
  implicit none
  private
  public :: settle_blas

  interface
    !> Lets OpenBLAS choose its kernels by the processor's instructions where it does not know its name.
    subroutine choose_blas_kernels() bind(c, name='implam_choose_blas_kernels')
    end subroutine choose_blas_kernels
  end interface

  abstract interface
    !> Sets the number of threads of a library.
    subroutine set_threads(count) bind(c)
      import :: c_int
      !> Number of threads
      integer(c_int), value :: count
    end subroutine set_threads
  end interface

contains

  !> Settles threads and kernels; once more does no harm.
  subroutine settle_blas()
    call use_one_thread('openblas_set_num_threads', 1_c_int, ['OMP_NUM_THREADS     ', 'OPENBLAS_NUM_THREADS'])
    ! CHOLMOD asks for four threads in loops that are over before these have begun.
    call use_one_thread('omp_set_max_active_levels', 0_c_int, ['OMP_NUM_THREADS'])
    call choose_blas_kernels()
  end subroutine settle_blas

  !> Lets a library work with one thread, unless the environment asks for more. Ranks share the work out already, and
  !> threads beside them wait more than they do.
  subroutine use_one_thread(setting, value, variables)
    !> Procedure of the library that sets it; where there is none nothing happens
    character(len=*), intent(in) :: setting
    !> What it takes for one thread
    integer(c_int), intent(in) :: value
    !> Variables of the environment that ask for threads
    character(len=*), intent(in) :: variables(:)
    procedure(set_threads), pointer :: set
    type(c_funptr) :: address
    character(len=8) :: threads
    integer :: i, length

    do i = 1, size(variables)
      call get_environment_variable(trim(variables(i)), threads, length=length)
      if (length > 0 .and. threads /= '1') return
    end do
    address = address_of(setting)
    if (.not. c_associated(address)) return
    call c_f_procpointer(address, set)
    call set(value)
  end subroutine use_one_thread
end module blas_settings
