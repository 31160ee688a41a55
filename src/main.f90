!> Implam: low-velocity impact on composite laminates. The only place where the program stops.
program implam
  use programs, only: run_program
  implicit none
  integer :: code
  logical :: close_failed

  call run_program(code, close_failed)
  if (close_failed) call leave_at_once(code)
  if (code /= 0) call quit(code)

contains

  !> Ends the process with an exit code, which `stop` would announce on the terminal.
  subroutine quit(code)
    use, intrinsic :: iso_c_binding, only: c_int
    integer, intent(in) :: code
    interface
      !> The C library's way out.
      subroutine exit_process(status) bind(c, name='exit')
        import :: c_int
        !> Exit code
        integer(c_int), value :: status
      end subroutine exit_process
    end interface

    call exit_process(int(code, c_int))
  end subroutine quit

  !> Ends the process without the exit handlers of libraries; files written so far are kept.
  subroutine leave_at_once(code)
    use, intrinsic :: iso_c_binding, only: c_int, c_null_ptr, c_ptr
    use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
    integer, intent(in) :: code
    interface
      !> C library: hands buffered output to the operating system.
      integer(c_int) function flush_streams(stream) bind(c, name='fflush')
        import :: c_int, c_ptr
        !> Null: all streams
        type(c_ptr), value :: stream
      end function flush_streams
      !> C library: ends the process without the exit handlers of libraries.
      subroutine leave_process(status) bind(c, name='_exit')
        import :: c_int
        !> Exit code
        integer(c_int), value :: status
      end subroutine leave_process
    end interface
    integer(c_int) :: ignored

    flush (output_unit)
    flush (error_unit)
    ignored = flush_streams(c_null_ptr)
    call leave_process(int(code, c_int))
  end subroutine leave_at_once
end program implam
