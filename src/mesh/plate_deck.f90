!> The plate of the deck: rows of its table, filling and checks.
module plate_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: remark, report
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mesh_parameters, only: plate_t, edge_free, edge_simple, edge_clamped, edge_elastic, symmetry_none, &
                             symmetry_quarter, symmetry_half_x, symmetry_half_y, symmetry_point, in_plane_free, &
                             in_plane_fixed, in_plane_tangential, curvatures, is_halved, has_symmetric_imperfection
  use plate_options, only: max_slope
  use text, only: line_t, lower_case, rounded_text, to_text
  implicit none
  private
  public :: fill_plate, check_plate, check_edges

  !> Names that checks across groups use.
  character(len=*), parameter, public :: plate_group = 'plate', key_length = 'length', key_symmetry = 'symmetry', &
                                         key_imperfection = 'imperfection', key_half_waves = 'half_waves', &
                                         key_curvature_radius = 'curvature_radius'
  character(len=group_row_length), parameter, public :: plate_group_row = &
    'plate | required | The plate: size, edges, curvature, imperfection and symmetry.'
  character(len=key_row_length), parameter, public :: plate_rows(*) = [character(len=key_row_length) :: &
    'plate | length | real | 2 | length | required | > 0 | &
      &Lengths of the full plate along x and y, also under symmetry. | | length', &
    'plate | edges | choice | 1 or 4 | - | required | clamped simple free elastic | &
      &Supports at x-min, x-max, y-min, y-max; one value serves all.', &
    'plate | edge_stiffness | real | 1 | pressure | none | > 0 | &
      &Stiffness of an elastic edge against deflection, force per length and deflection; left out: rigid. | &
      &edges = elastic', &
    'plate | edge_rotation_stiffness | real | 1 | force | none | > 0 | &
      &Stiffness of an elastic edge against rotation, moment per length and angle; left out: free rotation. | &
      &edges = elastic', &
    'plate | in_plane | choice | 1 | - | ''fixed'' | fixed free tangential | &
      &In-plane displacements of supported edges: fixed, free, or fixed along the edge and free across it.', &
    'plate | curvature_radius | real | 2 | length | none | any | &
      &Radius of lines along x and along y without stress, 0: straight; positive: the convex side is struck.', &
    'plate | imperfection | real | 1 | length | none | any | &
      &Amplitude of the initial, stress-free deflection.', &
    'plate | half_waves | integer | 2 | - | none | >= 1, <= 100 | &
      &Number of half waves of the initial deflection along x and y; left out: one along each. | imperfection', &
    'plate | symmetry | choice | 1 | - | ''none'' | none quarter half_x half_y point | &
      &Part that is modelled: all, x >= 0 and y >= 0, x >= 0, y >= 0, or x >= 0 of a plate with point symmetry.']

  !> Keys of elastic edges: stiffness against deflection and against rotation.
  character(len=*), parameter :: stiffness_keys(2) = [character(len=23) :: 'edge_stiffness', 'edge_rotation_stiffness']
  !> Largest ratio of the plate's sides: with one square element across, a thousand along; the most of a mesh are 1e6.
  real(wp), parameter :: max_aspect_ratio = 1.0e3_wp
  !> Largest rise over span of a shallow shell (E. Reissner, J. Math. Phys. 25 (1946) 80-85); V. Z. Vlasov, General
  !> Theory of Shells, 1949, takes 1/5.
  real(wp), parameter :: max_rise = 0.125_wp

contains

  !> The plate.
  subroutine fill_plate(settings, plate)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(inout) :: plate
    type(line_t), allocatable :: edges(:)
    integer :: i

    if (settings%is_known(plate_group, key_length)) plate%length = settings%reals_of(plate_group, key_length)
    edges = settings%texts_of(plate_group, 'edges')
    do i = 1, merge(4, 0, size(edges) > 0)
      plate%edges(i) = code_of(edges(min(i, size(edges)))%text, 'free simple clamped elastic', &
                               [edge_free, edge_simple, edge_clamped, edge_elastic])
    end do
    do i = 1, size(stiffness_keys)
      if (settings%is_given(plate_group, stiffness_keys(i))) &
        plate%edge_stiffness(i) = settings%real_of(plate_group, stiffness_keys(i))
    end do
    plate%in_plane = code_of(settings%text_of(plate_group, 'in_plane'), 'fixed free tangential', &
                             [in_plane_fixed, in_plane_free, in_plane_tangential])
    if (settings%is_known(plate_group, key_curvature_radius)) &
      plate%curvature_radius = settings%reals_of(plate_group, key_curvature_radius)
    if (settings%is_given(plate_group, key_imperfection)) &
      plate%imperfection = settings%real_of(plate_group, key_imperfection)
    if (settings%is_given(plate_group, key_half_waves)) &
      plate%half_waves = settings%integers_of(plate_group, key_half_waves)
    plate%symmetry = code_of(settings%text_of(plate_group, key_symmetry), 'none quarter half_x half_y point', &
                             [symmetry_none, symmetry_quarter, symmetry_half_x, symmetry_half_y, symmetry_point])
  end subroutine fill_plate

  !> Checks the ratio of the plate's sides, and its supports and imperfection against its symmetry.
  subroutine check_plate(settings, plate, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(problems_t), intent(inout) :: problems
    real(wp) :: slope
    logical :: halved(2)

    if (any(plate%edges == edge_elastic) .and. all(plate%edge_stiffness <= 0)) &
      call report(settings, problems, plate_group, 'edges', 'an elastic edge needs edge_stiffness, '// &
                'edge_rotation_stiffness or both.')
    if (.not. has_symmetric_imperfection(plate, plate%symmetry)) &
      call report(settings, problems, plate_group, key_half_waves, &
      'this shape is not that of the full plate with symmetry = '''// &
      lower_case(settings%text_of(plate_group, key_symmetry))//'''; give odd half waves along x for ''half_x'', '// &
      'along y for ''half_y'', along both for ''quarter'', an even sum for ''point'', or use ''none''.')
    slope = 0
    if (settings%is_known(plate_group, key_length)) &
      slope = abs(plate%imperfection)*pi*maxval(plate%half_waves/plate%length)
    if (slope > max_slope) call remark(settings, problems, plate_group, key_imperfection, 'has a slope of '// &
                                      rounded_text(slope)//', but the strains assume at most '//to_text(max_slope)//'.')
    call check_curvature(settings, plate, problems)
    ! A plate with point symmetry has equal opposite edges.
    halved = is_halved(plate%symmetry) .or. plate%symmetry == symmetry_point
    if (settings%is_known(plate_group, key_length) .and. maxval(plate%length) > max_aspect_ratio*minval(plate%length)) &
      call report(settings, problems, plate_group, key_length, 'one side is more than '//to_text(max_aspect_ratio)// &
                ' times the other; such a strip is not a plate.')
    if (plate%edges(1) /= plate%edges(2) .and. halved(1) .or. plate%edges(3) /= plate%edges(4) .and. halved(2)) &
      call report(settings, problems, plate_group, 'edges', 'symmetry = '''// &
                lower_case(settings%text_of(plate_group, key_symmetry))//''' needs the same support at opposite edges.')
  end subroutine check_plate

  !> Checks that the plate is as shallow as its strains assume.
  subroutine check_curvature(settings, plate, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: axes = 'xy'
    real(wp) :: curvature(2), rise
    integer :: i

    if (.not. settings%is_known(plate_group, key_length)) return
    curvature = curvatures(plate)
    do i = 1, 2
      rise = plate%length(i)*abs(curvature(i))/8
      if (rise > max_rise) then
        call report(settings, problems, plate_group, key_curvature_radius, 'the rise of the lines along '//axes(i:i)// &
                    ' is '//rounded_text(rise)//' times their length, and theory of shallow shells holds up to '// &
                    to_text(max_rise)//'; allowed: 0, or a radius of at least '// &
                    to_text(plate%length(i)/(8*max_rise))//'.')
      else if (4*rise > max_slope) then
        call remark(settings, problems, plate_group, key_curvature_radius, 'gives the lines along '//axes(i:i)// &
                    ' a slope of '//rounded_text(4*rise)//' at their ends, but the strains assume at most '// &
                    to_text(max_slope)//'.')
      end if
    end do
  end subroutine check_curvature

  !> Checks that edges support a plate without rigs; only a static analysis needs them.
  subroutine check_edges(settings, plate, problems)
    type(settings_t), intent(in) :: settings
    type(plate_t), intent(in) :: plate
    type(problems_t), intent(inout) :: problems

    if (.not. settings%is_known(plate_group, 'edges')) return
    if (all(plate%edges == edge_free)) then
      call report(settings, problems, plate_group, 'edges', &
                'nothing holds the plate in a static analysis; support an edge.')
    else if (count(plate%edges /= edge_free) == 1 .and. all(plate%edges /= edge_clamped) .and. &
             .not. plate%edge_stiffness(2) > 0) then
      call report(settings, problems, plate_group, 'edges', 'in a static analysis the plate turns about its one '// &
                'simply supported edge; clamp it or support another one.')
    end if
  end subroutine check_edges
end module plate_deck
