!> Files of a folder in the order of their age.
module folder_listings
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  implicit none
  private
  public :: file_by_age

  !> Longest name of a file in a folder.
  integer, parameter :: longest = 256

  interface
    !> Name of the file for which a given number of others are newer. Returns its length, or 0 if there is none.
    integer(c_int) function implam_file_by_age(folder, ending, newer, name) bind(c)
      import :: c_char, c_int
      !> Zero-terminated path of the folder, and the ending of the names
      character(kind=c_char), intent(in) :: folder(*), ending(*)
      !> Number of newer files
      integer(c_int), value :: newer
      !> Receives the name, without a zero at its end
      character(kind=c_char), intent(out) :: name(*)
    end function implam_file_by_age
  end interface

contains

  !> Name of the file with a certain ending for which a given number of others are newer; empty if there is none.
  function file_by_age(folder, ending, newer) result(name)
    !> Path of the folder
    character(len=*), intent(in) :: folder
    !> Ending of the names, which are longer
    character(len=*), intent(in) :: ending
    !> Number of newer files, from 0
    integer, intent(in) :: newer
    !> The name, without the folder
    character(len=:), allocatable :: name
    character(len=longest) :: found
    integer :: length

    length = implam_file_by_age(folder//c_null_char, ending//c_null_char, int(newer, c_int), found)
    name = found(:length)
  end function file_by_age
end module folder_listings
