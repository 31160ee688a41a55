!> The mesh of the deck: rows of its table, filling and checks. Keys of the element are in `element_deck`.
module mesh_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use mesh_parameters, only: mesh_t
  use text, only: to_text
  implicit none
  private
  public :: fill_mesh, check_mesh

  !> Names that checks across groups use.
  character(len=*), parameter, public :: mesh_group = 'mesh', key_elements = 'elements', key_patch = 'patch', &
                                         key_core = 'core', key_cell = 'cell', key_grading = 'grading'
  character(len=*), parameter, public :: key_lines(2) = ['lines_x', 'lines_y']
  !> Largest number of elements: with 20 unknowns per element and about 40 entries per row, the upper triangle of the
  !> matrix has 8e8 entries, and default integers reach 2.1e9.
  real(wp), parameter, public :: max_elements = 1.0e6_wp
  character(len=group_row_length), parameter, public :: mesh_group_row = &
    'mesh | settings | The rectangle of nine-node elements and the loaded patch.'
  character(len=key_row_length), parameter, public :: mesh_rows(*) = [character(len=key_row_length) :: &
    'mesh | elements | integer | 2 | - | = by &case accuracy | >= 2, <= 2000 | &
      &Elements along x and y of the modelled part.', &
    'mesh | grading | real | 1 | - | 0 | >= 0, <= 1000 | &
      &Ratio of the largest to the smallest element edge outside the patch; 0: chosen for smooth growth.', &
    'mesh | patch | real | 1 | length | 0 | >= 0 | &
      &Side of the loaded square centred on the struck point; an impactor needs one.', &
    'mesh | core | real | 2 | length | none | > 0 | &
      &Full extents of a rectangle of equal elements around the struck point; given with `cell`.', &
    'mesh | cell | real | 1 | length | none | > 0 | &
      &Side of the elements in the core; outside sizes grow smoothly or by `grading`.', &
    'mesh | lines_x | real | 1 or more | length | none | any | &
      &Distances from the centre along x at which mesh lines are placed on both sides, as for another deck''s rig.', &
    'mesh | lines_y | real | 1 or more | length | none | any | &
      &Distances from the centre along y at which mesh lines are placed on both sides, as for another deck''s rig.']

contains

  !> The mesh without the choices of its element and without required lines.
  subroutine fill_mesh(settings, mesh)
    type(settings_t), intent(in) :: settings
    type(mesh_t), intent(inout) :: mesh

    if (settings%is_known(mesh_group, key_elements)) mesh%elements = settings%integers_of(mesh_group, key_elements)
    mesh%grading = settings%real_of(mesh_group, key_grading)
    mesh%patch = settings%real_of(mesh_group, key_patch)
    if (settings%is_known(mesh_group, key_core)) mesh%core = settings%reals_of(mesh_group, key_core)
    if (settings%is_known(mesh_group, key_cell)) mesh%cell = settings%real_of(mesh_group, key_cell)
  end subroutine fill_mesh

  !> Checks the number of elements, the grading, and keys that require each other.
  subroutine check_mesh(settings, mesh, problems)
    type(settings_t), intent(in) :: settings
    type(mesh_t), intent(in) :: mesh
    type(problems_t), intent(inout) :: problems

    if (product(real(mesh%elements, wp)) > max_elements) call report(settings, problems, mesh_group, key_elements, &
      'more than '//to_text(max_elements)//' elements in all; give fewer.')
    if (mesh%grading > 0 .and. mesh%grading < 1) call report(settings, problems, mesh_group, key_grading, &
      'the largest edge is not smaller than the smallest; allowed: 0 or >= 1.')
    if (.not. are_clear(settings, problems, mesh_group, key_core//' '//key_cell)) return
    if (settings%is_given(mesh_group, key_core) .and. .not. settings%is_known(mesh_group, key_cell)) then
      call report(settings, problems, mesh_group, key_cell, 'is missing; `core` and `cell` require each other.')
    else if (settings%is_given(mesh_group, key_cell) .and. .not. settings%is_known(mesh_group, key_core)) then
      call report(settings, problems, mesh_group, key_core, 'is missing; `core` and `cell` require each other.')
    end if
  end subroutine check_mesh
end module mesh_deck
