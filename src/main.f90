!> Implam: low-velocity impact on composite laminates. The only place where the program stops.
program implam
  use programs, only: run_program
  implicit none
  integer :: code

  call run_program(code)
  if (code /= 0) call quit(code)

contains

  !> Ends the process with an exit code, which `stop` would announce on the terminal.
  subroutine quit(code)
    use, intrinsic :: iso_c_binding, only: c_int
    !> The exit code
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
end program implam
