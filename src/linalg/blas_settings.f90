!> Settings of OpenBLAS, where that is the library of dense linear algebra: kernels for the processor at hand, one
!> thread a rank.
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
    call use_one_thread()
    call choose_blas_kernels()
  end subroutine settle_blas

  !> Lets OpenBLAS work with one thread, unless the environment says how many; other libraries are left as they are.
  !> Ranks share the work out already, and threads beside them wait more than they do.
  subroutine use_one_thread()
    procedure(set_threads), pointer :: set
    type(c_funptr) :: address

    if (is_set('OMP_NUM_THREADS')) return
    if (is_set('OPENBLAS_NUM_THREADS')) return
    address = address_of('openblas_set_num_threads')
    if (.not. c_associated(address)) return
    call c_f_procpointer(address, set)
    call set(1_c_int)
  end subroutine use_one_thread

  !> True if a variable of the environment has a value.
  logical function is_set(name)
    !> Its name
    character(len=*), intent(in) :: name
    integer :: length

    call get_environment_variable(name, length=length)
    is_set = length > 0
  end function is_set
end module blas_settings
