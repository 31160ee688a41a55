!> Study of linear solvers on several ranks: the tangent of a deck's plate, as one matrix or in subdomains, is factored,
!> and systems are solved, by the solver that PETSc's options choose. tests/studies/parallel_solvers.py has the options
!> and prints the table.
!>
!> Usage: parallel_solvers DECK [-study_parts] [-study_step SECONDS] [-study_factors N] [-study_solves N]
!>        [options of PETSc]
program parallel_solvers
  use petscksp, only: tMat, tVec, tKSP, tPC, PETSC_NULL_OPTIONS, PETSC_DEFAULT_REAL, PETSC_DEFAULT_INTEGER, &
                      KSPSetOperators, PetscOptionsGetInt, NORM_2, MAT_SPD, PETSC_TRUE
  use communicators, only: communicator_t, finish_mpi, start_mpi
  use computations, only: read_deck_everywhere
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use errors, only: error_t
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use model_building, only: create_model
  use models, only: model_t
  use numberings, only: number_equations, numbering_t
  use operator_assembly, only: assemble_elements
  use petsc_matrices, only: put
  use petsc_session, only: finish_petsc, start_petsc
  use subdomain_matrices, only: create_parts, describe_motions
  implicit none
  type(communicator_t) :: communicator
  type(deck_t) :: deck
  type(problems_t) :: problems
  type(model_t) :: model
  type(numbering_t) :: numbering
  type(linear_solver_t) :: solver
  type(tKSP) :: krylov
  type(tVec) :: right, left
  type(error_t), allocatable :: error
  character(len=:), allocatable :: path, options
  integer :: ierr

  call read_arguments(path, options)
  call start_mpi(communicator)
  call read_deck_everywhere(path, communicator, deck, problems)
  call start_petsc(communicator, options, error)
  if (.not. allocated(error)) call create_model(deck%setup, communicator, model, error)
  if (allocated(error)) error stop 'There is no such model.'
  ! PETSc reports its errors, as without Implam's own handler.
  call PetscPopErrorHandler(ierr)
  call number_equations(model%plate%mesh, model%plate%distribution, model%plate%constraints%fixed, numbering, &
                        model%plate%constraints%images)
  call assemble()
  call set_up()
  call measure()
  call KSPDestroy(krylov, ierr)
  call solver%matrix%release()
  call finish_petsc()
  call finish_mpi()

contains

  !> The deck, and all other arguments for PETSc.
  subroutine read_arguments(path, options)
    !> Path of the deck
    character(len=:), allocatable, intent(out) :: path
    !> The options
    character(len=:), allocatable, intent(out) :: options
    character(len=4096) :: word
    integer :: i

    options = ''
    do i = 1, command_argument_count()
      call get_command_argument(i, word)
      if (i == 1) path = trim(word)
      if (i > 1) options = options//' '//trim(word)
    end do
  end subroutine read_arguments

  !> A number among the options.
  integer function option(name, otherwise)
    !> Name of the option
    character(len=*), intent(in) :: name
    !> Its value unless given
    integer, intent(in) :: otherwise
    logical :: given
    integer :: ierr

    call PetscOptionsGetInt(PETSC_NULL_OPTIONS, '', name, option, given, ierr)
    if (.not. given) option = otherwise
  end function option

  !> Whether an option is given.
  logical function has(name)
    !> Name of the option
    character(len=*), intent(in) :: name
    integer :: ierr

    call PetscOptionsHasName(PETSC_NULL_OPTIONS, '', name, has, ierr)
  end function has

  !> Assembles K + 4 M/h^2, the tangent of a step of Newmark's method, or K; as one matrix, or in subdomains of the
  !> ranks.
  subroutine assemble()
    real(wp), allocatable :: diagonal(:, :), still(:, :)
    real(wp) :: step
    logical :: given
    integer :: ierr

    if (has('-study_parts')) then
      call create_parts(communicator, numbering, solver%matrix)
    else
      call solver%matrix%define(communicator, numbering%first_row, numbering%total, numbering%row_start, &
                                numbering%columns, error)
    end if
    call PetscOptionsGetReal(PETSC_NULL_OPTIONS, '', '-study_step', step, given, ierr)
    allocate (diagonal(5, size(model%plate%distribution%points)), source=0.0_wp)
    allocate (still, source=diagonal)
    call assemble_elements(model, model%plate%elements%stiffness, numbering, still, 1.0_wp, &
                           merge(4/step**2, 0.0_wp, given), solver, diagonal)
    call solver%matrix%finish_assembly(error)
    if (allocated(error)) error stop 'The matrix was not assembled.'
  end subroutine assemble

  !> The solver that the options choose.
  subroutine set_up()
    type(tPC) :: preconditioner
    integer :: ierr

    call MatSetOption(solver%matrix%object, MAT_SPD, PETSC_TRUE, ierr)
    call KSPCreate(communicator%handle(), krylov, ierr)
    call KSPSetOperators(krylov, solver%matrix%object, solver%matrix%object, ierr)
    call KSPSetType(krylov, 'cg', ierr)
    ! The forcing term of Newton's method.
    call KSPSetTolerances(krylov, 1.0e-3_wp, PETSC_DEFAULT_REAL, PETSC_DEFAULT_REAL, PETSC_DEFAULT_INTEGER, ierr)
    call KSPGetPC(krylov, preconditioner, ierr)
    if (has('-study_parts')) then
      call PCSetType(preconditioner, 'bddc', ierr)
      call describe_motions(communicator, model, numbering, solver%matrix, preconditioner)
    end if
    call KSPSetFromOptions(krylov, ierr)
  end subroutine set_up

  !> Factors and solves, and prints the cost of the last factor and of all solves.
  subroutine measure()
    real(wp) :: seconds(3), flops(3), iterations
    real(wp), allocatable :: load(:)
    integer :: factor, solve, row, ierr, needed

    allocate (load(numbering%rows))
    call MatCreateVecs(solver%matrix%object, left, right, ierr)
    iterations = 0
    do factor = 1, option('-study_factors', 1)
      ! Other values, the same pattern: a new factor, without an analysis of the pattern
      if (factor > 1) call MatScale(solver%matrix%object, 1.0_wp + 1.0e-12_wp, ierr)
      call note(seconds(1), flops(1))
      call KSPSetOperators(krylov, solver%matrix%object, solver%matrix%object, ierr)
      call KSPSetUp(krylov, ierr)
      if (ierr /= 0) error stop 'The matrix was not factored.'
      call factorize_gathered()
    end do
    call note(seconds(2), flops(2))
    do solve = 1, option('-study_solves', 1)
      load = [(sin(real(37*solve, wp)*row), row=numbering%first_row + 1, numbering%first_row + numbering%rows)]
      call put(right, load, ierr)
      call KSPSolve(krylov, right, left, ierr)
      if (ierr /= 0) error stop 'There was no solution.'
      call KSPGetIterationNumber(krylov, needed, ierr)
      iterations = iterations + needed
    end do
    call note(seconds(3), flops(3))
    call count_of_mumps(flops)
    call print_line(seconds, flops, iterations/max(1, option('-study_solves', 1)))
  end subroutine measure

  !> Factors the matrix gathered on one rank now, and not in the first solve.
  subroutine factorize_gathered()
    type(tPC) :: preconditioner
    type(tKSP) :: inner
    character(len=16) :: name
    integer :: ierr

    name = ''
    call KSPGetPC(krylov, preconditioner, ierr)
    call PCGetType(preconditioner, name, ierr)
    if (name /= 'telescope' .or. .not. communicator%is_root()) return
    call PCTelescopeGetKSP(preconditioner, inner, ierr)
    call KSPSetUp(inner, ierr)
  end subroutine factorize_gathered

  !> Processor time and operations of this rank, after a barrier of all ranks.
  subroutine note(seconds, flops)
    !> Processor time, and operations counted by PETSc
    real(wp), intent(out) :: seconds, flops
    integer :: ierr, ranks

    ranks = 1
    call communicator%sum(ranks)
    call cpu_time(seconds)
    call PetscGetFlops(flops, ierr)
  end subroutine note

  !> Operations of MUMPS by its own count. PETSc 3.18 reads other counters: those of assembly instead of elimination,
  !> and of pivots instead of entries of the factor.
  subroutine count_of_mumps(flops)
    !> Operations before the last factor, after it, after the solves
    real(wp), intent(inout) :: flops(3)
    type(tPC) :: preconditioner
    type(tMat) :: factor
    real(wp) :: eliminations
    character(len=16) :: name
    integer :: entries, ierr

    name = ''
    call KSPGetPC(krylov, preconditioner, ierr)
    call PCGetType(preconditioner, name, ierr)
    if (name /= 'cholesky') return
    call PCFactorGetMatSolverType(preconditioner, name, ierr)
    if (name /= 'mumps') return
    call PCFactorGetMatrix(preconditioner, factor, ierr)
    call MatMumpsGetRinfo(factor, 3, eliminations, ierr)
    call MatMumpsGetInfo(factor, 27, entries, ierr)
    flops(2) = flops(1) + eliminations
    ! A negative number of entries is in millions.
    flops(3) = flops(2) + option('-study_solves', 1)*4*merge(-1.0e6_wp, 1.0_wp, entries < 0)*entries
  end subroutine count_of_mumps

  !> Prints a line of the table.
  subroutine print_line(seconds, flops, iterations)
    !> Processor time and operations before the last factor, after it, after the solves
    real(wp), intent(in) :: seconds(3), flops(3)
    !> Mean number of iterations of a solve
    real(wp), intent(in) :: iterations
    type(tVec) :: left_over
    real(wp) :: figures(5), memory, norms(2)
    integer :: ierr

    call PetscMemoryGetCurrentUsage(memory, ierr)
    figures = [seconds(2:) - seconds(:2), flops(2:) - flops(:2), memory]
    call communicator%maximum(figures)
    call communicator%sum(memory)
    call VecDuplicate(left, left_over, ierr)
    call MatMult(solver%matrix%object, left, left_over, ierr)
    call VecAXPY(left_over, -1.0_wp, right, ierr)
    call VecNorm(left_over, NORM_2, norms(1), ierr)
    call VecNorm(right, NORM_2, norms(2), ierr)
    if (communicator%is_root()) &
      print '(a, i0, *(1x, es10.3))', 'study ', numbering%total, figures(:4), iterations, memory, norms(1)/norms(2)
    call VecDestroy(left_over, ierr)
  end subroutine print_line
end program parallel_solvers
