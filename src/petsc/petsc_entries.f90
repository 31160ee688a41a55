!> Where the program, which loads this folder as a library when it needs MUMPS, comes in.
module petsc_entries
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
  use petsc_library, only: petsc_request_t
  use petsc_session, only: finish_session => finish_petsc, start_session => start_petsc
  use petsc_solvers, only: petsc_solver_t
  implicit none
  private
  public :: start_petsc, new_petsc_solver, finish_petsc

contains

  !> Starts PETSc.
  subroutine start_petsc(request) bind(c, name='implam_start_petsc')
    !> Address of a `petsc_request_t`
    type(c_ptr), value :: request
    type(petsc_request_t), pointer :: asked

    call c_f_pointer(request, asked)
    call start_session(asked%communicator, asked%options, asked%error)
  end subroutine start_petsc

  !> Starts PETSc unless it runs, and makes a solver.
  subroutine new_petsc_solver(request) bind(c, name='implam_new_petsc_solver')
    !> Address of a `petsc_request_t`
    type(c_ptr), value :: request
    type(petsc_request_t), pointer :: asked

    call start_petsc(request)
    call c_f_pointer(request, asked)
    if (.not. allocated(asked%error)) allocate (petsc_solver_t :: asked%solver)
  end subroutine new_petsc_solver

  !> Ends PETSc.
  subroutine finish_petsc() bind(c, name='implam_finish_petsc')
    call finish_session()
  end subroutine finish_petsc
end module petsc_entries
