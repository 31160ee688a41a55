!> Cost of a run, for `implam check`: steps and processor time.
module run_costs
  use deck_contents, only: deck_t
  use explicit_costs, only: duration_text, explicit_sentence, untaken_step
  use kinds, only: wp
  use model_sizes, only: model_size_t
  use plate_options, only: kinematics_linear
  use shortest_cells, only: shortest_cell_text
  use stepping_parameters, only: is_error_controlled, is_explicit
  use text, only: line_t, append, counted, rounded_text, to_text
  use usual_units, only: in_usual_unit, time_kind
  implicit none
  private
  public :: cost_lines

  !> Seconds of one processor for an implicit step of an undamaged plate with one solve: of each unknown for forces,
  !> ledger and columns, and of each megabyte of the estimated factor without and with interfaces. Measured: 2.8e-8 to
  !> 4e-8; 8.0e-5 on a plate with linear strains, 6.2e-5 with von Karman's, 3.2e-5 with an interface
  !> (doc/manual/queue.md).
  real(wp), parameter :: seconds_per_unknown = 3.0e-8_wp, seconds_per_megabyte(2) = [6.5e-5_wp, 3.0e-5_wp]
  !> Solves of such a step with von Karman's strains, and tangents of a load step: as measured, doc/manual/queue.md.
  real(wp), parameter :: solves_if_curved = 2, tangents_of_load_step = 4
  !> Ratio of the times of a factorization and a solve: 19 to 23 on 38 000 to 60 000 unknowns (doc/manual/queue.md).
  real(wp), parameter :: factor_over_solve = 22

contains

  !> Sentences on steps and time.
  function cost_lines(deck, model_size) result(lines)
    type(deck_t), intent(in) :: deck
    type(model_size_t), intent(in) :: model_size
    type(line_t), allocatable :: lines(:)

    allocate (lines(0))
    if (deck%setup%is_static()) then
      call append(lines, counted(to_text(deck%setup%loading%steps), 'load step')//min_time(deck, model_size, &
        deck%setup%loading%steps*tangents_of_load_step*factor_over_solve, &
        deck%setup%loading%steps*tangents_of_load_step))
    else if (.not. deck%stepping%time%step > 0) then
      return
    else if (is_explicit(deck%stepping)) then
      call append(lines, explicit_sentence(deck, model_size))
      call append(lines, 'The shortest cells limit the step: '//shortest_cell_text(deck)//'.')
      if (untaken_step(deck, deck%stepping%time%step) /= '') &
        call append(lines, untaken_step(deck, deck%stepping%time%step))
    else
      call append(lines, implicit_sentence(deck, model_size))
    end if
  end function cost_lines

  !> Implicit steps: the time of an undamaged plate is a lower bound.
  function implicit_sentence(deck, model_size) result(sentence)
    type(deck_t), intent(in) :: deck
    type(model_size_t), intent(in) :: model_size
    character(len=:), allocatable :: sentence
    real(wp) :: steps, solves

    steps = deck%stepping%time%end/deck%stepping%time%step
    solves = merge(1.0_wp, solves_if_curved, deck%setup%mesh%kinematics == kinematics_linear)
    sentence = 'About '//counted(rounded_text(max(1.0_wp, anint(steps))), 'step')//' of '// &
               in_usual_unit(deck%stepping%time%step, time_kind, deck%case%units)
    if (is_error_controlled(deck%stepping%adapt)) sentence = sentence//', fewer as they grow'
    sentence = sentence//min_time(deck, model_size, steps*solves + factor_over_solve, steps*solves)
  end function implicit_sentence

  !> Processor time for an undamaged plate.
  function min_time(deck, model_size, solves, residuals) result(clause)
    type(deck_t), intent(in) :: deck
    type(model_size_t), intent(in) :: model_size
    !> Number of solves, with factorizations converted to solves, and of residuals
    real(wp), intent(in) :: solves, residuals
    !> The end of a sentence
    character(len=:), allocatable :: clause
    real(wp) :: seconds

    seconds = seconds_per_unknown*model_size%unknowns*residuals + model_size%megabytes*solves* &
              seconds_per_megabyte(merge(2, 1, size(deck%setup%delaminations) > 0))
    clause = ': about '
    if (seconds > 1) clause = ': at least '
    clause = clause//duration_text(seconds)//' of one processor'
    if (deck%setup%ply_damage%is_present .or. size(deck%setup%delaminations) > 0) clause = clause// &
      ' without damage, many times that with damage'
    clause = clause//'.'
  end function min_time
end module run_costs
