!> Convergence of equilibrium and linear algebra in the deck: rows of its table, filling and checks.
module solver_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use linear_solver_parameters, only: linear_solver_parameters_t, factorization_mumps, factorization_cholmod, &
                                      factorization_automatic
  use stepping_parameters, only: equilibrium_t
  use text, only: joined, line_t, words_of
  implicit none
  private
  public :: fill_equilibrium, fill_linear_solver, check_petsc_options

  !> Name that checks across groups use.
  character(len=*), parameter, public :: solver_group = 'solver'
  character(len=group_row_length), parameter, public :: solver_group_row = &
    'solver | settings | Tolerance of equilibrium, and the linear solver.'
  character(len=key_row_length), parameter, public :: solver_rows(*) = [character(len=key_row_length) :: &
    'solver | tolerance | real | 1 | - | 1e-6 | >= 1e-13, <= 0.01 | &
      &Residual of equilibrium accepted, relative to the reference force.', &
    'solver | max_iterations | integer | 1 | - | 30 | >= 1, <= 10000 | &
      &Iterations before a step is tried again with half its length.', &
    'solver | factorization | choice | 1 | - | ''automatic'' | automatic mumps cholmod | &
      &Direct solver; automatic: cholmod for positive definite matrices, unless several ranks share a large model.', &
    'solver | petsc_options | text | 1 | - | '''' | any text | &
      &Options passed to PETSc.']

  !> Prefixes of the options for PETSc allowed in a deck, those of its matrices and solvers.
  character(len=*), parameter :: allowed_prefixes = '-ksp_ -pc_ -mat_ '// &
    '-indefinite_ksp_ -indefinite_pc_ -indefinite_mat_ -telescope_ksp_ -telescope_pc_ -telescope_mat_ -newton_ksp_'

contains

  !> Convergence of equilibrium.
  subroutine fill_equilibrium(settings, equilibrium)
    type(settings_t), intent(in) :: settings
    type(equilibrium_t), intent(inout) :: equilibrium

    equilibrium%tolerance = settings%real_of(solver_group, 'tolerance')
    equilibrium%max_iterations = settings%integer_of(solver_group, 'max_iterations')
  end subroutine fill_equilibrium

  !> The linear solver.
  subroutine fill_linear_solver(settings, solver)
    type(settings_t), intent(in) :: settings
    type(linear_solver_parameters_t), intent(inout) :: solver

    solver%factorization = code_of(settings%text_of(solver_group, 'factorization'), 'automatic mumps cholmod', &
                                   [factorization_automatic, factorization_mumps, factorization_cholmod])
    solver%petsc_options = settings%text_of(solver_group, 'petsc_options')
  end subroutine fill_linear_solver

  !> Checks options for PETSc: options of the solver are allowed, but not those that write files, as a deck may come
  !> from an unknown source.
  subroutine check_petsc_options(settings, solver, problems)
    type(settings_t), intent(in) :: settings
    type(linear_solver_parameters_t), intent(in) :: solver
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: words(:)
    integer :: i

    words = words_of(solver%petsc_options, ' ')
    do i = 1, size(words)
      if (is_allowed(words(i)%text)) cycle
      call report(settings, problems, solver_group, 'petsc_options', words(i)%text// &
                  ' might write files; allowed: -log_view, words without : and /, and options that begin '// &
                  'with one of '//joined(words_of(allowed_prefixes, ' '), ', ')//'; give others on the command line.')
      return
    end do
  end subroutine check_petsc_options

  !> True if a word is an allowed option, or a value that is not the name of a file.
  pure logical function is_allowed(word)
    character(len=*), intent(in) :: word
    type(line_t), allocatable :: prefixes(:)
    integer :: i

    ! PETSc would separate words at a tab.
    is_allowed = scan(word, ':/'//achar(9)) == 0
    if (.not. is_allowed .or. word == '-log_view' .or. index(word, '-') /= 1) return
    if (len(word) > 1) is_allowed = scan(word(2:2), '0123456789.') == 1
    prefixes = words_of(allowed_prefixes, ' ')
    do i = 1, size(prefixes)
      if (index(word, prefixes(i)%text) == 1) is_allowed = .true.
    end do
  end function is_allowed
end module solver_deck
