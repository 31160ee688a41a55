!> The linear solver in the deck: rows of its table, filling and checks. The other keys of the group &solver are in
!> `equilibrium_deck`.
module linear_solver_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: tell
  use deck_settings, only: settings_t
  use deck_vocabulary, only: key_row_length
  use linear_solver_parameters, only: linear_solver_parameters_t, factorization_mumps, factorization_cholmod
  implicit none
  private
  public :: fill_linear_solver, check_ranks

  character(len=*), parameter :: group = 'solver'
  !> Rows of the keys.
  character(len=key_row_length), parameter, public :: linear_solver_rows(*) = [character(len=key_row_length) :: &
    'solver | factorization | choice | 1 | - | ''mumps'' | mumps cholmod | &
      &Direct solver; cholmod on one rank only.', &
    'solver | petsc_options | text | 1 | - | '''' | any text | &
      &Options handed to PETSc as they are.']

contains

  !> The linear solver.
  subroutine fill_linear_solver(settings, solver)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives them
    type(linear_solver_parameters_t), intent(inout) :: solver

    solver%factorization = code_of(settings%text_of(group, 'factorization'), 'mumps cholmod', &
                                   [factorization_mumps, factorization_cholmod])
    solver%petsc_options = settings%text_of(group, 'petsc_options')
  end subroutine fill_linear_solver

  !> Whether the factorization runs on so many ranks.
  subroutine check_ranks(settings, solver, ranks, problems)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> The linear solver
    type(linear_solver_parameters_t), intent(in) :: solver
    !> Number of ranks
    integer, intent(in) :: ranks
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (solver%factorization == factorization_cholmod .and. ranks > 1) call tell(settings, problems, group, &
      'factorization', 'works on one rank only; run on one rank, or take ''mumps''.')
  end subroutine check_ranks
end module linear_solver_deck
