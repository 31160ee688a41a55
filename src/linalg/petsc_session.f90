!> Begin and end of PETSc within a run: our communicator, our command line, our error messages.
module petsc_session
  use, intrinsic :: iso_c_binding, only: c_int, c_ptr, c_null_ptr, c_char, c_null_char, c_funptr, c_funloc, &
                                         c_associated, c_f_pointer
  use communicators, only: communicator_t
  use environment_variables, only: set_environment_variable
  use errors, only: error_t, fail, exit_usage, exit_internal
  implicit none
  private
  public :: start_petsc, finish_petsc, report_petsc

  !> Ours, which the user's override: signals are for the run to see; and CHOLMOD factors all matrices as it does large
  !> ones, with square roots, so that it refuses what is not positive definite.
  !> "telescope" is the solver on one rank for all of them.
  character(len=*), parameter :: own_options = '-no_signal_handler true -mat_cholmod_factor supernodal '// &
    '-telescope_pc_type cholesky -telescope_pc_factor_mat_solver_type cholmod '// &
    '-telescope_mat_cholmod_factor supernodal '

  interface
    !> Starts PETSc. This is the C entry, as the Fortran one reads the command line in any case.
    integer(c_int) function initialize() bind(c, name='PetscInitializeNoArguments')
      import :: c_int
    end function initialize

    !> Makes PETSc's constants known to its Fortran interface.
    integer(c_int) function initialize_fortran() bind(c, name='PetscInitializeFortran')
      import :: c_int
    end function initialize_fortran

    !> Pushes what PETSc does when it finds an error.
    integer(c_int) function push_error_handler(handler, context) bind(c, name='PetscPushErrorHandler')
      import :: c_int, c_funptr, c_ptr
      !> The handler
      type(c_funptr), value :: handler
      !> Data of its own
      type(c_ptr), value :: context
    end function push_error_handler

    !> PETSc's handler that says nothing and returns the code. It is never called from here, so its
    !> arguments are left out.
    integer(c_int) function quiet_handler() bind(c, name='PetscIgnoreErrorHandler')
      import :: c_int
    end function quiet_handler

    !> OpenMP: how deep parallel regions may be nested; 0: none are parallel.
    subroutine limit_parallel_regions(levels) bind(c, name='omp_set_max_active_levels')
      import :: c_int
      !> The limit
      integer(c_int), value :: levels
    end subroutine limit_parallel_regions

    !> Meaning of an error code, in general and for the latest error.
    integer(c_int) function error_message(code, general, particular) bind(c, name='PetscErrorMessage')
      import :: c_int, c_ptr
      !> The code
      integer(c_int), value :: code
      !> Texts ended by a null character
      type(c_ptr), intent(out) :: general, particular
    end function error_message
  end interface

contains

  !> Starts PETSc, unless it runs already. The command line stays ours.
  subroutine start_petsc(communicator, options, error)
    !> All ranks of the run
    type(communicator_t), intent(in) :: communicator
    !> Options for PETSc's database, such as `-log_view -mat_mumps_icntl_14 50`; may be blank
    character(len=*), intent(in) :: options
    !> Raised when PETSc does not start
    type(error_t), allocatable, intent(inout) :: error
    logical :: running
    integer :: ierr, length
    character(len=:), allocatable :: all_options

    call PetscInitialized(running, ierr)
    if (running) return
    call set_threads()
    ! Options such as -log_view must be there when PETSc starts, and it looks for them in the environment.
    call get_environment_variable('PETSC_OPTIONS', length=length)
    allocate (character(len=length) :: all_options)
    if (length > 0) call get_environment_variable('PETSC_OPTIONS', all_options)
    all_options = own_options//all_options//' '//trim(options)
    call set_environment_variable('PETSC_OPTIONS', all_options, overwrite=.true.)
    ierr = push_error_handler(c_funloc(quiet_handler), c_null_ptr)
    if (ierr == 0) ierr = initialize()
    if (ierr == 0) ierr = initialize_fortran()
    if (ierr /= 0) call fail(error, exit_usage, 'PETSc does not start with the options "'//trim(options)//'".')
    call communicator%agree(error)
  end subroutine start_petsc

  !> Keeps OpenMP to one thread a rank, as the ranks share the work, unless the environment requests more. CHOLMOD
  !> before SuiteSparse 6 else takes four, whatever the environment says, for loops over before these have begun.
  subroutine set_threads()
    character(len=8) :: threads
    integer :: length

    call get_environment_variable('OMP_NUM_THREADS', threads, length=length)
    if (length == 0 .or. threads == '1') call limit_parallel_regions(0_c_int)
  end subroutine set_threads

  !> Ends PETSc; its objects must have been freed before.
  subroutine finish_petsc()
    logical :: running
    integer :: ierr

    call PetscInitialized(running, ierr)
    if (running) call PetscFinalize(ierr)
  end subroutine finish_petsc

  !> Raises an error when one of several codes that PETSc returned isn't zero.
  subroutine report_petsc(codes, error)
    !> Codes in the order of the calls
    integer, intent(in) :: codes(:)
    !> Raised with PETSc's own words
    type(error_t), allocatable, intent(inout) :: error
    type(c_ptr) :: general, particular
    integer :: i, ierr

    do i = 1, size(codes)
      if (codes(i) == 0) cycle
      ierr = error_message(int(codes(i), c_int), general, particular)
      call fail(error, exit_internal, 'PETSc failed: '//text_at(general)//'; '//text_at(particular))
      return
    end do
  end subroutine report_petsc

  !> First line of a C text.
  function text_at(address) result(text)
    !> Where the text begins; nowhere for an empty text
    type(c_ptr), intent(in) :: address
    !> The text
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer, parameter :: longest = 1024
    integer :: i

    text = ''
    if (.not. c_associated(address)) return
    call c_f_pointer(address, letters, [longest])
    do i = 1, longest
      if (letters(i) == c_null_char .or. letters(i) == new_line('a')) exit
      text = text//letters(i)
    end do
  end function text_at
end module petsc_session
