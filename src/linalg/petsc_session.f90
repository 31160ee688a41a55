!> Start and end of PETSc in a run, with the program's communicator, command line and error messages.
module petsc_session
  use, intrinsic :: iso_c_binding, only: c_int, c_ptr, c_null_ptr, c_char, c_null_char, c_funptr, c_funloc, &
                                         c_associated, c_f_pointer
  use communicators, only: communicator_t
  use environment_variables, only: set_environment_variable
  use errors, only: error_t, fail, exit_usage, exit_internal
  implicit none
  private
  public :: start_petsc, finish_petsc, report_petsc

  !> Options of the program, which those of the user override: the run handles signals, and CHOLMOD uses its supernodal
  !> factorization with square roots for all matrices, which detects those that are not positive definite. "telescope"
  !> is the solver on one rank for all of them.
  character(len=*), parameter :: own_options = '-no_signal_handler true -options_left no '// &
    '-mat_cholmod_factor supernodal -telescope_mat_cholmod_factor supernodal '// &
    '-telescope_pc_type cholesky -telescope_pc_factor_mat_solver_type cholmod '

  interface
    !> Starts PETSc by its C entry: the Fortran one always reads the command line.
    integer(c_int) function initialize() bind(c, name='PetscInitializeNoArguments')
      import :: c_int
    end function initialize

    !> Initializes PETSc's Fortran interface.
    integer(c_int) function initialize_fortran() bind(c, name='PetscInitializeFortran')
      import :: c_int
    end function initialize_fortran

    !> Sets PETSc's error handler.
    integer(c_int) function push_error_handler(handler, context) bind(c, name='PetscPushErrorHandler')
      import :: c_int, c_funptr, c_ptr
      !> The handler
      type(c_funptr), value :: handler
      !> Its context
      type(c_ptr), value :: context
    end function push_error_handler

    !> PETSc's handler that prints nothing and returns the code. It is not called from Fortran, so its arguments are
    !> omitted.
    integer(c_int) function quiet_handler() bind(c, name='PetscIgnoreErrorHandler')
      import :: c_int
    end function quiet_handler

    !> OpenMP: largest depth of nested parallel regions; 0: none are parallel.
    subroutine limit_parallel_regions(levels) bind(c, name='omp_set_max_active_levels')
      import :: c_int
      !> The limit
      integer(c_int), value :: levels
    end subroutine limit_parallel_regions

    !> Messages of PETSc for an error code and for the latest error.
    integer(c_int) function error_message(code, general, particular) bind(c, name='PetscErrorMessage')
      import :: c_int, c_ptr
      !> The code
      integer(c_int), value :: code
      !> Texts ended by a null character
      type(c_ptr), intent(out) :: general, particular
    end function error_message
  end interface

contains

  !> Starts PETSc, unless it is already started, without the command line.
  subroutine start_petsc(communicator, options, error)
    type(communicator_t), intent(in) :: communicator
    !> Options for PETSc's database, such as `-log_view -mat_mumps_icntl_14 50`; may be blank
    character(len=*), intent(in) :: options
    !> Set if PETSc does not start
    type(error_t), allocatable, intent(inout) :: error
    logical :: running
    integer :: ierr, length
    character(len=8) :: threads
    character(len=:), allocatable :: all_options

    call PetscInitialized(running, ierr)
    if (running) return
    ! Limits OpenMP to one thread per rank, unless the environment requests more. Otherwise CHOLMOD before SuiteSparse 6
    ! uses four threads, whatever the environment requests, for loops too short to benefit.
    call get_environment_variable('OMP_NUM_THREADS', threads, length=length)
    if (length == 0 .or. threads == '1') call limit_parallel_regions(0_c_int)
    ! Options such as -log_view must be set when PETSc starts, which reads them from the environment.
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

  !> Ends PETSc; its objects must be deallocated before.
  subroutine finish_petsc()
    logical :: running
    integer :: ierr

    call PetscInitialized(running, ierr)
    if (running) call PetscFinalize(ierr)
  end subroutine finish_petsc

  !> Sets an error if one of several codes of PETSc is not zero.
  subroutine report_petsc(codes, error)
    !> Codes in the order of the calls
    integer, intent(in) :: codes(:)
    !> Set with PETSc's message
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
    !> Address of the text; null for an empty one
    type(c_ptr), intent(in) :: address
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
