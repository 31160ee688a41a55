!> Procedures of the C library and of the linear algebra library that a system may or may not have.
module found_procedures
  use, intrinsic :: iso_c_binding, only: c_char, c_ptr, c_funptr, c_null_ptr, c_null_char
  implicit none
  private
  public :: address_of

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

  !> Address of a procedure in any library that is loaded.
  function address_of(name) result(address)
    !> Its name
    character(len=*), intent(in) :: name
    !> Address, null where there is none
    type(c_funptr) :: address

    address = find_procedure(c_null_ptr, name//c_null_char)
  end function address_of
end module found_procedures
