!> Variables of the environment, set for libraries that read them.
module environment_variables
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  implicit none
  private
  public :: set_environment_variable

  interface
    !> C library: sets a variable of the environment.
    integer(c_int) function setenv(name, value, overwrite) bind(c, name='setenv')
      import :: c_char, c_int
      !> Name and value, ended by null characters
      character(kind=c_char), intent(in) :: name(*), value(*)
      !> 0: a variable that is set is not changed
      integer(c_int), value :: overwrite
    end function setenv
  end interface

contains

  !> Sets a variable of the environment; a failure, for lack of memory, has no effect.
  subroutine set_environment_variable(name, value, overwrite)
    !> Name and value
    character(len=*), intent(in) :: name, value
    !> False: a variable that is set is not changed
    logical, intent(in) :: overwrite
    integer(c_int) :: status

    status = setenv(name//c_null_char, value//c_null_char, merge(1_c_int, 0_c_int, overwrite))
  end subroutine set_environment_variable
end module environment_variables
