!> Lines of the deck: rows of its table, filling and checks.
module line_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use line_loads, only: line_load_t, along_x, along_y, line_ramp, line_fixed, all_layers
  implicit none
  private
  public :: fill_lines, check_lines

  !> Names that checks across groups use.
  character(len=*), parameter, public :: line_group = 'line', key_at = 'at', key_layer = 'layer', &
                                         key_rise = 'rise', key_displacement = 'displacement', &
                                         key_force = 'force'
  !> Keys of values, displacements first.
  character(len=*), parameter :: value_keys(4) = [character(len=12) :: 'force', 'displacement', 'moment', 'rotation']
  character(len=group_row_length), parameter, public :: line_group_row = &
    'line | several | A line across the plate with a support, a prescribed displacement or a load.'
  character(len=key_row_length), parameter, public :: line_rows(*) = [character(len=key_row_length) :: &
    'line | at | real | 1 | length | required | any | &
      &Coordinate of the line from the plate''s centre: x of a line along y, y of a line along x.', &
    'line | direction | choice | 1 | - | ''y'' | x y | &
      &Direction in which the line runs, from edge to edge of the plate.', &
    'line | layer | integer | 1 | - | none | >= 1, <= 1000 | &
      &Layer on whose mid-surface the line acts, counted from the struck face; left out: all layers.', &
    'line | component | choice | 1 | - | ''w'' | u v w theta_x theta_y | &
      &Displacement or rotation that is supported, prescribed or loaded.', &
    'line | force | real | 1 | force | none | any | &
      &Total force on the line, in the direction of u, v or w.', &
    'line | displacement | real | 1 | length | none | any | &
      &Displacement u, v or w of the line; 0 is a support.', &
    'line | moment | real | 1 | energy | none | any | &
      &Total moment on the line, acting on theta_x or theta_y.', &
    'line | rotation | real | 1 | radian | none | any | &
      &Rotation theta_x or theta_y of the line.', &
    'line | history | choice | 1 | - | ''ramp'' | ramp fixed | &
      &ramp: in proportion to the load factor, in time to time/end; fixed: full value from the start.', &
    'line | rise | real | 1 | time | 0 | >= 0 | &
      &Smooth start: time in which the velocity of a ramp rises, or a fixed value is reached; 0: sudden. | not &static']

contains

  !> All lines, in the order of the deck.
  subroutine fill_lines(settings, end_time, lines)
    type(settings_t), intent(in) :: settings
    !> End of a run in time; 0: load steps
    real(wp), intent(in) :: end_time
    type(line_load_t), allocatable, intent(out) :: lines(:)
    integer :: place, k

    allocate (lines(settings%groups_named(line_group)))
    do place = 1, size(lines)
      associate (s => settings, line => lines(place))
        if (s%is_known(line_group, key_at, place)) line%at = s%real_of(line_group, key_at, place)
        line%direction = code_of(s%text_of(line_group, 'direction', place), 'x y', [along_x, along_y])
        if (s%is_given(line_group, key_layer, place)) line%layer = s%integer_of(line_group, key_layer, place)
        line%component = code_of(s%text_of(line_group, 'component', place), 'u v w theta_x theta_y', [1, 2, 3, 4, 5])
        line%history = code_of(s%text_of(line_group, 'history', place), 'ramp fixed', [line_ramp, line_fixed])
        if (end_time > 0) line%rise = s%real_of(line_group, key_rise, place)/end_time
        do k = 1, size(value_keys)
          if (.not. s%is_given(line_group, trim(value_keys(k)), place)) cycle
          line%value = s%real_of(line_group, trim(value_keys(k)), place)
          line%prescribed = modulo(k, 2) == 0
        end do
      end associate
    end do
  end subroutine fill_lines

  !> Checks that each line has one value, of a kind that suits its component.
  subroutine check_lines(settings, lines, problems)
    type(settings_t), intent(in) :: settings
    type(line_load_t), intent(in) :: lines(:)
    type(problems_t), intent(inout) :: problems
    logical :: given(size(value_keys)), suits(size(value_keys))
    integer :: place, k

    do place = 1, size(lines)
      if (.not. are_clear(settings, problems, line_group, 'component force displacement moment rotation', place)) cycle
      given = [(settings%is_given(line_group, trim(value_keys(k)), place), k=1, size(value_keys))]
      suits = [spread(lines(place)%component <= 3, 1, 2), spread(lines(place)%component > 3, 1, 2)]
      if (count(given) /= 1) then
        call report(settings, problems, line_group, '', 'give one of force, displacement, moment and rotation.', place)
      else if (any(given .and. .not. suits)) then
        call report(settings, problems, line_group, 'component', &
                    'u, v and w go with force or displacement, theta_x '// &
                  'and theta_y with moment or rotation.', place)
      else if (.not. lines(place)%prescribed .and. abs(lines(place)%value) <= 0) then
        call remark(settings, problems, line_group, '', 'a force or moment of 0 is no load.', place)
      end if
      if (lines(place)%rise > 1) &
        call report(settings, problems, line_group, key_rise, 'the rise lasts longer than the run.', place)
    end do
  end subroutine check_lines
end module line_deck
