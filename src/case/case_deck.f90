!> Name and title of the case: rows of the deck's table and their filling.
module case_deck
  use deck_settings, only: settings_t
  use kinds, only: wp
  use deck_vocabulary, only: group_row_length, key_row_length
  use text, only: lower_case
  implicit none
  private
  public :: case_t, fill_case, stem_of, has_accuracy, needs_coarse_run

  !> Names of the group and of keys.
  character(len=*), parameter, public :: case_group = 'case', key_name = 'name', &
                                         key_accuracy = 'accuracy', key_refine = 'refine', &
                                         key_error_estimate = 'error_estimate', key_units = 'units'
  character(len=*), parameter :: group = case_group
  character(len=group_row_length), parameter, public :: case_group_row = &
    'case | settings | Name and title of the case, units, accuracy and kinematics.'
  character(len=key_row_length), parameter, public :: case_rows(*) = [character(len=key_row_length) :: &
    'case | name | name | 1 | - | = the deck''s file name | letters, digits, . _ - | &
      &Names the output files.', &
    'case | title | text | 1 | - | '''' | any text | &
      &Free text kept with the results.', &
    'case | accuracy | choice or real | 1 | % | none | draft standard reference, >= 0.01, <= 20 | &
      &Permitted error of the peak force (draft 5, standard 1, reference 0.2); it chooses mesh and steps not given.', &
    'case | units | choice | 1 | - | none | SI mm-t-s mm-kg-ms mm-mN-kg-s | &
      &System of units of the deck; the check compares values with usual ones, and results name it.', &
    'case | strict | logical | 1 | - | .false. | .true. .false. | &
      &Whether a run ends with exit code 3 where it exceeds a limit of the model, instead of a warning.', &
    'case | error_estimate | logical | 1 | - | none | .true. .false. | Whether a coarser run, an eighth of the work, &
      &estimates errors. Default: with accuracy, unless the impact is elastic.', &
    'case | refine | integer | 1 | - | 0 | >= 0, <= 4 | &
      &Number of halvings of elements and steps; results are then named NAME_finer1 and so on.']

  !> Permitted errors of the peak force for each `accuracy`, %. doc/studies/defaults.md has their
  !> cost.
  real(wp), parameter :: draft_error = 5, standard_error = 1, reference_error = 0.2_wp

  !> The case as a whole: names, and what holds for all of the deck.
  type :: case_t
    !> Name of the case, which names its files
    character(len=:), allocatable :: name
    !> Free text kept with the results
    character(len=:), allocatable :: title
    !> Error of the peak force for the choice of mesh and steps, %; 0: they are given in the deck
    real(wp) :: accuracy = 0
    !> Units of the deck; empty: any that are consistent
    character(len=:), allocatable :: units
    !> True: the run ends beyond the limits of the model
    logical :: strict = .false.
    !> Times that elements and steps are halved
    integer :: refine = 0
  end type case_t

contains

  !> The keys of the group; a case without a name is named after its deck.
  subroutine fill_case(settings, source, filled)
    !> Keys in effect; receives a default of the name
    type(settings_t), intent(inout) :: settings
    !> Path of the deck
    character(len=*), intent(in) :: source
    !> The case
    type(case_t), intent(out) :: filled

    if (.not. settings%is_known(group, 'name')) call settings%derive(group, 'name', name_from(source), .true.)
    filled%name = settings%text_of(group, 'name')
    filled%title = settings%text_of(group, 'title')
    filled%refine = settings%integer_of(group, key_refine)
    filled%units = settings%text_of(group, key_units)
    filled%strict = settings%logical_of(group, 'strict')
    select case (lower_case(settings%text_of(group, key_accuracy)))
    case ('draft')
      filled%accuracy = draft_error
    case ('standard')
      filled%accuracy = standard_error
    case ('reference')
      filled%accuracy = reference_error
    case default
      filled%accuracy = settings%real_of(group, key_accuracy)
    end select
  end subroutine fill_case

  !> True: mesh and steps are chosen by the accuracy of the deck.
  pure logical function has_accuracy(settings)
    type(settings_t), intent(in) :: settings

    has_accuracy = settings%is_given(group, key_accuracy)
  end function has_accuracy

  !> True: errors of the results are estimated by a coarse run.
  pure logical function needs_coarse_run(settings, has_estimate)
    type(settings_t), intent(in) :: settings
    !> True: they are estimated by the preliminary elastic impact
    logical, intent(in) :: has_estimate

    needs_coarse_run = has_accuracy(settings) .and. .not. has_estimate
    if (settings%is_given(group, key_error_estimate)) needs_coarse_run = settings%logical_of(group, key_error_estimate)
  end function needs_coarse_run

  !> File name of a path without folders and extension; invalid characters of a case name become _.
  pure function name_from(path) result(name)
    character(len=*), intent(in) :: path
    !> A valid case name
    character(len=:), allocatable :: name
    integer :: i

    name = stem_of(path)
    name = name(:min(len(name), 80))
    do i = 1, len(name)
      if (verify(lower_case(name(i:i)), 'abcdefghijklmnopqrstuvwxyz0123456789._-') > 0) name(i:i) = '_'
    end do
    if (verify(name(:min(1, len(name))), '._-') == 0) name = 'case'//name
  end function name_from

  !> File name of a path without folders and extension.
  pure function stem_of(path) result(stem)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: stem

    stem = path(index(path, '/', back=.true.) + 1:)
    if (index(stem, '.', back=.true.) > 1) stem = stem(:index(stem, '.', back=.true.) - 1)
  end function stem_of
end module case_deck
