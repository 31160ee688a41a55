!> Convergence of equilibrium in the deck: rows of its table and their filling. The linear solver's keys of the same
!> group are in `linear_solver_deck`.
module equilibrium_deck
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use stepping_parameters, only: equilibrium_t
  implicit none
  private
  public :: fill_equilibrium

  !> Name that checks across groups use.
  character(len=*), parameter, public :: solver_group = 'solver'
  !> Row of the group.
  character(len=group_row_length), parameter, public :: solver_group_row = &
    'solver | settings | Convergence of equilibrium and linear algebra.'
  !> Rows of the keys.
  character(len=key_row_length), parameter, public :: equilibrium_rows(*) = [character(len=key_row_length) :: &
    'solver | tolerance | real | 1 | - | 1e-6 | >= 1e-13, <= 0.01 | &
      &Residual of equilibrium accepted, relative to the reference force.', &
    'solver | max_iterations | integer | 1 | - | 30 | >= 1, <= 10000 | &
      &Iterations before a step is tried again with half its length.']

contains

  !> Convergence of equilibrium.
  subroutine fill_equilibrium(settings, equilibrium)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives them
    type(equilibrium_t), intent(inout) :: equilibrium

    equilibrium%tolerance = settings%real_of(solver_group, 'tolerance')
    equilibrium%max_iterations = settings%integer_of(solver_group, 'max_iterations')
  end subroutine fill_equilibrium
end module equilibrium_deck
