!> Threads of the linear algebra library. Ranks share the work out already; threads beside them wait more than they do.
module blas_threads
  use, intrinsic :: iso_c_binding, only: c_int, c_funptr, c_associated, c_f_procpointer
  use found_procedures, only: address_of
  implicit none
  private
  public :: use_one_thread

  abstract interface
    !> Sets the number of threads of a library.
    subroutine set_threads(count) bind(c)
      import :: c_int
      !> Number of threads
      integer(c_int), value :: count
    end subroutine set_threads
  end interface

contains

  !> Lets OpenBLAS work with one thread, unless the environment says how many; other libraries are left as they are.
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
end module blas_threads
