!> Bytes of any type of numbers from one rank to another, such as those of a file that the first rank alone has open.
module root_messages
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_int8_t, c_ptr
  use communicators, only: communicator_t
  use mpi_f08, only: MPI_BYTE, MPI_Recv, MPI_Send, MPI_STATUS_IGNORE
  implicit none
  private
  public :: receive_bytes, send_bytes

contains

  !> Sends bytes to a rank.
  subroutine send_bytes(communicator, rank, address, count)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The other rank
    integer, intent(in) :: rank
    !> Address of the bytes
    type(c_ptr), intent(in) :: address
    !> Their number
    integer, intent(in) :: count
    integer(c_int8_t), pointer :: bytes(:)

    call c_f_pointer(address, bytes, [count])
    call MPI_Send(bytes, count, MPI_BYTE, rank, 0, communicator%group)
  end subroutine send_bytes

  !> Receives bytes from a rank.
  subroutine receive_bytes(communicator, rank, address, count)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The other rank
    integer, intent(in) :: rank
    !> Address for the bytes
    type(c_ptr), intent(in) :: address
    !> Their number
    integer, intent(in) :: count
    integer(c_int8_t), pointer :: bytes(:)

    call c_f_pointer(address, bytes, [count])
    call MPI_Recv(bytes, count, MPI_BYTE, rank, 0, communicator%group, MPI_STATUS_IGNORE)
  end subroutine receive_bytes
end module root_messages
