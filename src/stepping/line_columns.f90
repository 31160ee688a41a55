!> Columns of the history for lines that support, displace or load the plate.
module line_columns
  use kinds, only: wp
  use line_loads, only: line_load_t
  use mesh_parameters, only: is_halved, plate_t
  use models, only: model_t
  use rank_totals, only: totals_of
  use result_tables, only: result_row_length
  use states, only: state_t
  implicit none
  private
  public :: line_values, end_values, has_ends, pressed_axis

  !> Columns of decks with lines, the last two once per line: N is its number in the deck.
  character(len=result_row_length), parameter, public :: line_column_rows(*) = [character(len=result_row_length) :: &
    'load_factor | real | - | Ramps of lines, and the pressure of a static analysis, over their full values; only with &
      &&line.', &
    'line_force_N | real | force | Total force on the plate of the N-th &line along its component; for a rotation the &
      &moment.', &
    'line_displacement_N | real | length | Mean displacement or rotation of the N-th &line along its component.']

  !> Columns of a plate whose ends are compressed or pulled by lines.
  character(len=result_row_length), parameter, public :: end_rows(*) = [character(len=result_row_length) :: &
    'far_field_stress | real | pressure | Load, also of doublers and stringers, over width and thickness of the &
      &laminate, positive in compression, mean of the ends displaced; only with lines that displace ends of the &
      &plate.', &
    'shortening | real | length | Reduction of the distance between the ends of the plate.', &
    'nominal_strain | real | - | Shortening over the length of the plate.']

contains

  !> Load factor, then force and displacement of every line. Collective.
  function line_values(model, now) result(values)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> One value per column, the same on every rank; none without lines
    real(wp), allocatable :: values(:)
    real(wp), allocatable :: totals(:)
    integer :: i

    allocate (values(0))
    if (size(model%loads%lines) == 0) return
    totals = totals_of(model%plate%communicator, &
                       [(model%loads%lines(i)%totals(now%motion%displacement, now%load_factor), &
                                             i=1, size(model%loads%lines))])
    do i = 1, size(totals), 3
      ! Supports that fix the entire line fix its mean, too.
      values = [values, totals(i), totals(i + 1)/max(1 - totals(i + 2), tiny(1.0_wp))]
    end do
    if (allocated(now%line_reactions)) then
      do i = 1, size(model%loads%lines)
        if (model%loads%lines(i)%load%prescribed) values(2*i - 1) = now%line_reactions(i)
      end do
    end if
    values = [now%load_factor, values]
  end function line_values

  !> True: lines displace ends of the plate in its plane.
  pure logical function has_ends(plate, lines)
    type(plate_t), intent(in) :: plate
    !> Lines of the deck
    type(line_load_t), intent(in) :: lines(:)

    has_ends = count(on_ends(plate, lines)) > 0
  end function has_ends

  !> Lines on the two ends of the displaced axis, also on a fixed end.
  pure function on_ends(plate, lines) result(on)
    type(plate_t), intent(in) :: plate
    !> Lines of the deck
    type(line_load_t), intent(in) :: lines(:)
    !> True for each such line
    logical :: on(size(lines))
    integer :: i, moved

    on = [(lines(i)%is_end(plate%length), i=1, size(lines))]
    moved = findloc(on .and. abs(lines%value) > 0, .true., dim=1)
    if (moved == 0) then
      on = .false.
    else
      on = on .and. lines%component == lines(moved)%component
    end if
  end function on_ends

  !> Axis along which lines displace ends of the plate; 0: none do.
  pure integer function pressed_axis(model) result(along)
    type(model_t), intent(in) :: model
    logical :: on(size(model%loads%lines))

    along = 0
    on = on_ends(model%plate%setup%plate, model%loads%lines%load)
    if (any(on)) along = model%loads%lines(findloc(on, .true., dim=1))%load%component
  end function pressed_axis

  !> Far-field stress and shortening, from forces and displacements of the lines.
  pure function end_values(model, values) result(ends)
    type(model_t), intent(in) :: model
    !> Load factor, then force and displacement of every line
    real(wp), intent(in) :: values(:)
    !> One value per column; none without such lines
    real(wp), allocatable :: ends(:)
    real(wp) :: sides(size(model%loads%lines))
    logical :: on(size(model%loads%lines)), halved(2)
    integer :: i, along

    allocate (ends(0))
    associate (plate => model%plate%setup%plate, lines => model%loads%lines%load)
      on = on_ends(plate, lines)
      if (.not. any(on)) return
      along = pressed_axis(model)
      sides = merge(sign(1.0_wp, lines%at), 0.0_wp, on)
      halved = is_halved(plate%symmetry)
      ends = [-sum([(sides(i)*values(2*i), i=1, size(on))]) &
              /(count(on)*plate%length(3 - along)*model%plate%layup%thickness), &
              -merge(2, 1, halved(along))*sum([(sides(i)*values(2*i + 1), i=1, size(on))])]
      ends = [ends, ends(2)/plate%length(along)]
    end associate
  end function end_values
end module line_columns
