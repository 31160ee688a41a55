!> PETSc and MUMPS, which are loaded when something needs them: with the hundred libraries behind them they take longer
!> to load than a small run takes. What uses them stands in a library of its own, the folder `petsc`.
module petsc_library
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_procpointer, c_funptr, c_int, c_loc, &
                                         c_null_char, c_ptr
  use communicators, only: communicator_t, start_mpi
  use errors, only: error_t, fail, exit_files
  use found_procedures, only: address_of
  use linear_solvers, only: linear_solver_t
  implicit none
  private
  public :: petsc_request_t, start_petsc, finish_petsc, new_petsc_solver

  !> Its file name, found beside the program or where it was installed
  character(len=*), parameter :: library = 'libimplam_petsc.so'
  !> Flags of the loader: find procedures as they are called, let what is found later see them
  integer(c_int), parameter :: lazily = 1, for_all = 256

  !> What is asked of the library, and its answer.
  type :: petsc_request_t
    !> All ranks
    type(communicator_t) :: communicator
    !> Options for PETSc's database
    character(len=:), allocatable :: options
    !> Raised when it cannot be done
    type(error_t), allocatable :: error
    !> A solver that is not set up yet
    class(linear_solver_t), allocatable :: solver
  end type petsc_request_t

  abstract interface
    !> Does what is asked.
    subroutine answer(request) bind(c)
      import :: c_ptr
      !> Address of a `petsc_request_t`
      type(c_ptr), value :: request
    end subroutine answer

    !> Ends something.
    subroutine ending() bind(c)
    end subroutine ending
  end interface

  interface
    !> C library: loads a library.
    function load_library(path, flags) result(handle) bind(c, name='dlopen')
      import :: c_char, c_int, c_ptr
      !> File name, ended by a null character
      character(kind=c_char), intent(in) :: path(*)
      !> How
      integer(c_int), value :: flags
      !> The library, null where it can't be loaded
      type(c_ptr) :: handle
    end function load_library
  end interface

contains

  !> Starts PETSc, and MPI before it, unless they run already.
  subroutine start_petsc(communicator, options, error)
    !> All ranks of the run
    type(communicator_t), intent(in) :: communicator
    !> Options for PETSc's database, such as `-log_view -mat_mumps_icntl_14 50`; may be blank
    character(len=*), intent(in) :: options
    !> Raised when PETSc does not start
    type(error_t), allocatable, intent(inout) :: error
    type(petsc_request_t), target :: request

    call ask('implam_start_petsc', communicator, options, request, error)
  end subroutine start_petsc

  !> A solver of MUMPS, not set up yet; PETSc is started for it.
  subroutine new_petsc_solver(communicator, solver, error)
    !> All ranks of the run
    type(communicator_t), intent(in) :: communicator
    !> The solver
    class(linear_solver_t), allocatable, intent(out) :: solver
    !> Raised when PETSc does not start
    type(error_t), allocatable, intent(inout) :: error
    type(petsc_request_t), target :: request

    call ask('implam_new_petsc_solver', communicator, '', request, error)
    call move_alloc(request%solver, solver)
  end subroutine new_petsc_solver

  !> Ends PETSc if it was started; its objects must have been freed before.
  subroutine finish_petsc()
    procedure(ending), pointer :: finish
    type(c_funptr) :: address

    address = address_of('implam_finish_petsc')
    if (.not. c_associated(address)) return
    call c_f_procpointer(address, finish)
    call finish()
  end subroutine finish_petsc

  !> Asks something of the library, which is loaded if it wasn't before.
  subroutine ask(entry_name, communicator, options, request, error)
    !> Procedure of the library
    character(len=*), intent(in) :: entry_name
    !> All ranks of the run
    type(communicator_t), intent(in) :: communicator
    !> Options for PETSc's database
    character(len=*), intent(in) :: options
    !> Receives the answer
    type(petsc_request_t), target, intent(inout) :: request
    !> Raised when it cannot be done
    type(error_t), allocatable, intent(inout) :: error
    procedure(answer), pointer :: act
    type(c_funptr) :: address
    type(c_ptr) :: handle

    address = address_of(entry_name)
    if (.not. c_associated(address)) then
      handle = load_library(library//c_null_char, ior(lazily, for_all))
      address = address_of(entry_name)
    end if
    if (.not. c_associated(address)) &
      call fail(error, exit_files, 'The library '//library//', which holds PETSc and MUMPS, could not be loaded.')
    call communicator%agree(error)
    if (allocated(error)) return
    request%communicator = communicator
    if (communicator%size == 1) call start_mpi(request%communicator)
    request%options = options
    call c_f_procpointer(address, act)
    call act(c_loc(request))
    if (allocated(request%error)) call move_alloc(request%error, error)
  end subroutine ask
end module petsc_library
