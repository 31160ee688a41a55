!> Initial state from the end of another run: it is read from that run's checkpoint, compared with the deck, and
!> transferred to the model.
module initial_states
  use archives, only: archive_t
  use checkpoints, only: checkpoint_archive_t, checkpoint_ending
  use cell_grids, only: cells_from_struck
  use cell_lines, only: cell_line_t
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use deck_initial_states, only: has_same_contact, inheritance_objection, is_mapped
  use deck_plate_cuts, only: cut_of
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck_text
  use errors, only: error_t, exit_deck, exit_files, fail
  use files, only: file_exists, is_same_file
  use inherited_states, only: visit_inheritance
  use initial_state_deck, only: initial_state_group
  use initial_state_parameters, only: motion_rest
  use adaptive_zones, only: visit_zones, zone_notes
  use delamination_deck, only: key_zone
  use kinds, only: wp
  use layer_transfers, only: layer_transfer_t
  use mapped_figures, only: after_mapping, before_cutting, before_mapping, mapped_figures_t
  use mapped_interfaces, only: put_fractions, set_damage, set_slips
  use mesh_transfers, only: mesh_transfer_t
  use logger, only: log_t
  use mesh_parameters, only: symmetry_none
  use model_building, only: create_model
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use plate_cuts, only: plate_cut_t
  use root_output, only: print_lines
  use run_records, only: run_record_t
  use states, only: new_state, state_t, time_item
  use stepping_parameters, only: end_of_run
  use tan_sun_indentation, only: indentation_t
  use text, only: append, line_t, rounded_text, to_text
  use steppers, only: stepper_t
  implicit none
  private
  public :: fit_initial_state, take_initial_state, visit_incomplete_start

contains

  !> Compares a deck with the run from which it starts, and sets the zones of its interfaces to those of that run.
  !> Collective.
  subroutine fit_initial_state(deck, communicator, error, lacks)
    type(deck_t), intent(inout) :: deck
    type(communicator_t), intent(in) :: communicator
    !> Set (files) if the checkpoint cannot be read, (deck) if it is of another plate
    type(error_t), allocatable, intent(inout) :: error
    !> Returns true instead of an error if there is no such file, as the other run may not have been started yet
    logical, intent(out), optional :: lacks
    type(checkpoint_archive_t) :: archive
    type(deck_t) :: old
    character(len=:), allocatable :: objection
    type(line_t) :: remark
    real(wp) :: contact_end, force
    logical :: failed
    integer :: i

    if (present(lacks)) lacks = .false.
    if (.not. deck%setup%initial%is_inherited) return
    call refuse_own_end(deck, communicator, error)
    if (allocated(error)) return
    if (present(lacks)) then
      if (communicator%is_root()) lacks = .not. file_exists(deck%setup%initial%from)
      call communicator%broadcast(lacks)
      if (lacks) return
    end if
    call open_checkpoint(deck%setup%initial%from, communicator, archive, old, error)
    if (allocated(error)) return
    call archive%item(time_item, deck%setup%initial%reached)
    call archive%item('record/contact_end', contact_end)
    call archive%item('record/force', force)
    call archive%item('compression/failed', failed)
    call archive%close(error)
    if (allocated(error)) return
    objection = inheritance_objection(deck, old)
    if (objection /= '') then
      call refuse(deck, 'the deck does not fit that run, '//objection, error)
      return
    end if
    if (is_mapped(deck, old) .and. force > 0) then
      call refuse(deck, 'the impactor is in contact at the end of that run, and a state under contact force '// &
                  'cannot be mapped to another mesh; run the impact to its end, or give the mesh of that run', error)
      return
    end if
    do i = 1, size(deck%setup%delaminations)
      if (.not. deck%setup%delaminations(i)%is_adaptive) cycle
      if (.not. deck%setup%impactor%is_present .and. deck%setup%plate%symmetry == symmetry_none .and. &
          .not. any(deck%setup%delaminations%starter > 0)) &
        deck%setup%delaminations(i)%zone_at = deck%setup%delaminations(i)%zone_at + centre_distance(deck, old, i)
      if (is_mapped(deck, old) .or. any(abs(centre_distance(deck, old, i)) > 0)) &
        old%setup%delaminations(i)%zone = covering_extents(deck, old, i)
      deck%setup%delaminations(i)%zone = max(deck%setup%delaminations(i)%zone, old%setup%delaminations(i)%zone)
    end do
    deck%setup%initial%end = merge(1.0_wp, end_of_run(old%stepping, contact_end), old%setup%is_static())
    if (old%stepping%time%ends_at_failure .and. failed) deck%setup%initial%end = deck%setup%initial%reached
    call remark_stopped(deck, remark)
    if (allocated(remark%text)) call print_lines(communicator, [remark])
  end subroutine fit_initial_state

  !> Refuses the checkpoint that the run itself will write.
  subroutine refuse_own_end(deck, communicator, error)
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    !> Set (deck) if it is that checkpoint
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: own
    logical :: is_own

    own = deck%output%directory//'/'//deck%case%name//checkpoint_ending
    is_own = .false.
    if (communicator%is_root()) is_own = is_same_file(deck%setup%initial%from, own)
    call communicator%broadcast(is_own)
    if (is_own) call refuse(deck, 'is the checkpoint that this run writes at its own end, from which the next run '// &
                            'would start; allowed: another &case name or &output directory', error)
  end subroutine refuse_own_end

  !> Warns of a start from a run that was stopped before its end, such as by a time limit, and whose later damage is
  !> missing.
  subroutine remark_stopped(deck, remark)
    !> The deck; the summary of its run repeats the warning
    type(deck_t), intent(inout) :: deck
    !> The warning, with file and line; unallocated: the other run reached its end
    type(line_t), intent(out) :: remark
    character(len=:), allocatable :: line, sentence

    if (.not. deck%setup%initial%reached < deck%setup%initial%end) return
    line = to_text(deck%settings%line_of_group(initial_state_group))
    sentence = '&'//initial_state_group//' from = '''//deck%setup%initial%from// &
               ''': is of a run that was stopped at '// &
               rounded_text(deck%setup%initial%reached)//' of '//rounded_text(deck%setup%initial%end)// &
               ': later damage is missing; complete it first.'
    remark = line_t(deck%source//':'//line//': warning: '//sentence)
    call append(deck%remarks, 'line '//line//': '//sentence)
  end subroutine remark_stopped

  !> Saves or loads the time that the other run reached: a restart does not read the checkpoint of that run again, and
  !> its summary repeats the warning.
  subroutine visit_incomplete_start(deck, archive)
    type(deck_t), intent(inout) :: deck
    class(archive_t), intent(inout) :: archive
    type(line_t) :: remark

    if (.not. deck%setup%initial%is_inherited) return
    call archive%item('initial_state/reached', deck%setup%initial%reached)
    call archive%item('initial_state/end', deck%setup%initial%end)
    if (archive%loading) call remark_stopped(deck, remark)
  end subroutine visit_incomplete_start

  !> Refuses the checkpoint of the initial state.
  subroutine refuse(deck, reason, error)
    type(deck_t), intent(in) :: deck
    !> A clause
    character(len=*), intent(in) :: reason
    type(error_t), allocatable, intent(inout) :: error

    call fail(error, exit_deck, deck%source//':'//to_text(deck%settings%line_of_group(initial_state_group))//': &'// &
              initial_state_group//' from='''//deck%setup%initial%from//''': '//reason//'.')
  end subroutine refuse

  !> Extents of a zone that cover the cells of the other run's zone and one more, as nodes on the border of a zone have
  !> no interface.
  pure function covering_extents(deck, old, zone) result(extents)
    !> The deck, and that of the other run with the zones at its end
    type(deck_t), intent(in) :: deck, old
    integer, intent(in) :: zone
    !> Full extents along x and y
    real(wp) :: extents(2)
    type(cell_line_t) :: line
    real(wp) :: distance(2)
    integer :: direction

    distance = abs(centre_distance(deck, old, zone))
    do direction = 1, 2
      line = cells_from_struck(old%setup%plate, old%setup%mesh, direction)
      line = line%from(old%setup%delaminations(zone)%zone_at(direction))
      ! An edge of the plate may end the cells on one side; the extent is that of the side that reaches farther.
      extents(direction) = 2*maxval(abs(line%span(line%within(old%setup%delaminations(zone)%zone(direction))))) &
                           + 2*distance(direction)
      line = cells_from_struck(deck%setup%plate, deck%setup%mesh, direction)
      line = line%from(deck%setup%delaminations(zone)%zone_at(direction))
      extents(direction) = line%widened(extents(direction), 1)
    end do
  end function covering_extents

  !> Distance from the centre of a zone to that of the other run's zone.
  pure function centre_distance(deck, old, zone) result(distance)
    !> The deck, and that of the other run with the zones at its end
    type(deck_t), intent(in) :: deck, old
    integer, intent(in) :: zone
    !> Along x and y
    real(wp) :: distance(2)

    distance = old%setup%mesh%struck + old%setup%delaminations(zone)%zone_at &
               - deck%setup%initial%cut_at - deck%setup%mesh%struck - deck%setup%delaminations(zone)%zone_at
  end function centre_distance

  !> Opens a checkpoint and reads its deck, with the zones at its end. Collective.
  subroutine open_checkpoint(path, communicator, archive, old, error)
    !> The checkpoint
    character(len=*), intent(in) :: path
    type(communicator_t), intent(in) :: communicator
    type(checkpoint_archive_t), intent(inout) :: archive
    !> Receives its deck
    type(deck_t), intent(out) :: old
    !> Set if it cannot be read
    type(error_t), allocatable, intent(inout) :: error
    type(problems_t) :: problems

    call archive%open_for_loading(communicator, path, error)
    if (allocated(error)) return
    call read_deck_text(archive%provenance%deck, path, old, problems)
    if (problems%errors() > 0) then
      call fail(error, exit_files, 'The deck in the checkpoint '//path//' has faults by this version of Implam; '// &
                'run it again.')
    else
      call visit_zones(old%setup%delaminations, archive)
    end if
  end subroutine open_checkpoint

  !> Transfers the end of the other run to this one. Collective.
  subroutine take_initial_state(deck, model, stepper, record, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    !> The time stepper at its start
    class(stepper_t), intent(inout) :: stepper
    !> Receives the quantities before and after mapping, and the failures before this run
    type(run_record_t), intent(inout) :: record
    type(log_t), intent(inout) :: log
    !> Set if the checkpoint cannot be read, or has damage where the deck has no interface
    type(error_t), allocatable, intent(inout) :: error
    class(layer_transfer_t), allocatable :: transfer
    type(line_t), allocatable :: notes(:)
    type(deck_t) :: old
    integer :: i

    call load_transfer(deck, model%plate, stepper, transfer, record%mapping, old, error)
    if (allocated(error)) return
    call log%note('The plate starts from the end of the run of '//deck%setup%initial%from//'.')
    notes = zone_notes(model%plate%setup%delaminations, 'the start', deck%case%units)
    do i = 1, size(notes)
      call log%note(notes(i)%text)
    end do
    ! At rest, damage would only grow by errors of the mapping.
    call stepper%now%hold_damage(is_mapped(deck, old) .and. deck%setup%loading%start > 0 .and. &
                                 deck%setup%initial%motion == motion_rest)
    call begin_contact(deck, old, stepper%now%impact%indentation, log)
    call stepper%begin_inherited(model, transfer, deck%setup%initial%motion, error)
    if (allocated(error)) return
    call record%inherit(model%plate, stepper%now)
    if (is_mapped(deck, old)) then
      call record%mapping%note(model%plate, stepper%now, after_mapping)
      if (record%mapping%is_cut()) call log%note(record%mapping%cut_line(deck%setup%delaminations%below_ply))
      call log%note(record%mapping%line(deck%setup%delaminations%below_ply))
      call log%note(record%mapping%energy_line(stepper%now%holds_damage))
      if (record%mapping%first_loss() > 0) then
        call refuse(deck, 'the interface below ply '// &
                    to_text(deck%setup%delaminations(record%mapping%first_loss())%below_ply)// &
                    ' has delaminated beyond its '//key_zone//' in this deck', error)
        return
      end if
    end if
    associate (ledger => stepper%now%ledger)
      call log%note('The energy ledger starts with '//rounded_text(ledger%initial)//': dissipated by that run '// &
                    rounded_text(ledger%delamination + ledger%ply_damage + ledger%friction)//', strain '// &
                    rounded_text(ledger%strain)//', kinetic '//rounded_text(ledger%kinetic)//'.')
    end associate
  end subroutine take_initial_state

  !> Begins a contact on the dent of the other run, if its impactor was the same at the same place, or on a face
  !> without a dent.
  subroutine begin_contact(deck, old, indentation, log)
    type(deck_t), intent(in) :: deck, old
    !> That at the end of the other run; receives that of the new contact
    type(indentation_t), intent(inout) :: indentation
    type(log_t), intent(inout) :: log

    if (.not. has_same_contact(deck, old)) then
      indentation = indentation_t()
      return
    end if
    call indentation%begin_again()
    if (indentation%dent > 0) call log%note('The impactor strikes the dent of that run, '// &
                                            rounded_text(indentation%dent)//' deep by the indentation law.')
  end subroutine begin_contact

  !> Loads the state of the other run, on its mesh, and transfers it to this one's. Collective.
  subroutine load_transfer(deck, plate, stepper, transfer, mapping, old, error)
    type(deck_t), intent(in) :: deck
    type(composite_plate_t), intent(in) :: plate
    !> The time stepper; receives the inherited state
    class(stepper_t), intent(inout) :: stepper
    !> Receives the map of points and elements
    class(layer_transfer_t), allocatable, intent(out) :: transfer
    !> Receives the quantities on the other mesh if this one differs
    type(mapped_figures_t), intent(inout) :: mapping
    !> Receives the other run's deck
    type(deck_t), intent(out) :: old
    !> Set if the checkpoint cannot be read
    type(error_t), allocatable, intent(inout) :: error
    type(checkpoint_archive_t) :: archive
    type(model_t), allocatable :: old_model
    type(state_t), allocatable :: state
    type(mesh_transfer_t) :: mapped

    call open_checkpoint(deck%setup%initial%from, plate%communicator, archive, old, error)
    if (allocated(error)) return
    allocate (old_model)
    call create_model(old%setup, plate%communicator, old_model, error)
    if (allocated(error)) return
    allocate (state, source=new_state(old_model))
    call visit_inheritance(state, archive, old_model%plate)
    call archive%item('ledger/strain', state%ledger%strain)
    call archive%close(error)
    if (allocated(error)) return
    if (is_mapped(deck, old)) then
      mapped%origin = deck%setup%initial%cut_at
      allocate (transfer, source=mapped)
      call note_before(cut_of(deck), old_model%plate, state, mapping)
      call put_fractions(state%interfaces%cohesive, old_model%plate)
    else
      allocate (layer_transfer_t :: transfer)
    end if
    transfer%communicator = plate%communicator
    call visit_inheritance(state, transfer, old_model%plate)
    call transfer%turn_to(old_model%plate%mesh, plate%mesh)
    call visit_inheritance(stepper%now, transfer, plate)
    if (.not. is_mapped(deck, old)) return
    associate (now => stepper%now)
      call set_damage(now%interfaces%cohesive, plate)
      call set_slips(now%interfaces%cohesive, plate, now%motion%displacement)
    end associate
  end subroutine load_transfer

  !> Stores the quantities of the other run's plate, and of the part that is cut from it. Collective.
  subroutine note_before(cut, old_model, state, mapping)
    !> The part; the full plate: nothing is cut
    type(plate_cut_t), intent(in) :: cut
    !> Plate of the other run; points and elements keep the areas inside of the part
    type(composite_plate_t), intent(inout) :: old_model
    !> Its state
    type(state_t), intent(inout) :: state
    !> Receives the quantities
    type(mapped_figures_t), intent(inout) :: mapping
    real(wp), allocatable :: parts(:)

    if (.not. cut%is_whole(old_model%setup%plate%length)) then
      call mapping%note(old_model, state, before_cutting)
      parts = cut%of_nodes(old_model%mesh)
      if (allocated(old_model%interfaces%contact_area)) old_model%interfaces%contact_area = &
        old_model%interfaces%contact_area*parts(old_model%mesh%point_node(old_model%distribution%points))
      parts = cut%of_cells(old_model%mesh)
      if (allocated(state%plies%bands)) state%plies%bands%area = &
        state%plies%bands%area*parts(old_model%mesh%element_cell(old_model%distribution%elements))
    end if
    call mapping%note(old_model, state, before_mapping)
  end subroutine note_before
end module initial_states
