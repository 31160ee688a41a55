!> Threads of the linear algebra library. Ranks share the work out already; threads beside them wait more than they do.
module blas_threads
  use, intrinsic :: iso_c_binding, only: c_int, c_char, c_ptr, c_funptr, c_null_ptr, c_null_char, c_associated, &
                                         c_f_procpointer
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

  interface
    !> Address of a procedure that the program may or may not have.
    function find_procedure(library, name) result(address) bind(c, name='dlsym')
      import :: c_ptr, c_char, c_funptr
      !> Library, null for all that are loaded
      type(c_ptr), value :: library
      !> Name, ended by a null character
      character(kind=c_char), intent(in) :: name(*)
      !> Address, null where there is none
      type(c_funptr) :: address
    end function find_procedure
  end interface

contains

  !> Lets OpenBLAS work with one thread, unless the environment says how many; other libraries are left as they are.
  subroutine use_one_thread()
    procedure(set_threads), pointer :: set
    type(c_funptr) :: address

    if (is_set('OMP_NUM_THREADS') .or. is_set('OPENBLAS_NUM_THREADS')) return
    address = find_procedure(c_null_ptr, 'openblas_set_num_threads'//c_null_char)
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
