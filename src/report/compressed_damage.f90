!> Damage of a plate under compression: delamination of each interface and fibre failure of each ply, with its position
!> along the load and its extent over the width. The difference from the damage at the start gives the location of
!> failure.
module compressed_damage
  use archives, only: archive_t
  use delamination_parameters, only: law_cohesive
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use mesh_parameters, only: image_signs
  use composite_plates, only: composite_plate_t
  use ply_damage_parameters, only: fibre_failure
  use rank_totals, only: totals_of
  use states, only: state_t
  use support_parameters, only: window_rectangle
  implicit none
  private
  public :: compressed_damage_t, damage_of, between_supports

  !> Quantities of an interface or a ply of the full plate: failed area; mean and largest distance from the middle along
  !> the load; fraction of the width between the supports with failure anywhere along the load.
  integer, parameter, public :: figure_area = 1, figure_mean = 2, figure_reach = 3, figure_width = 4
  integer, parameter :: number_of_figures = 4

  !> Damage at one time, the same on every rank.
  type :: compressed_damage_t
    !> (quantities, interfaces) of delamination, and (quantities, plies) of fibre failure
    real(wp), allocatable :: interfaces(:, :), plies(:, :)
  contains
    procedure :: visit
  end type compressed_damage_t

  !> Sums and maxima over the failed places of one interface or ply on this rank.
  type :: collected_t
    !> Areas, and areas times their distances
    type(exact_sum_t) :: area, moment
    !> Largest distance; negative: no failure
    real(wp) :: reach = -1
    !> 1 for each row of cells along the load with failure, else 0
    real(wp), allocatable :: rows(:)
  contains
    procedure :: add
  end type collected_t

contains

  !> Damage of a state. Collective.
  function damage_of(plate, now, along) result(damage)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Axis of the load
    integer, intent(in) :: along
    type(compressed_damage_t) :: damage
    type(collected_t) :: interfaces(size(plate%mesh%zones)), plies(plate%layup%plies)
    integer :: i, parts

    do i = 1, size(interfaces)
      interfaces(i) = delaminated(plate, now, along, i)
    end do
    do i = 1, size(plies)
      plies(i) = fibres_failed(plate, now, along, i)
    end do
    parts = size(plate%layup%images, 2)
    damage%interfaces = figures_of(plate, along, interfaces, spread([(i, i=1, size(interfaces))], 2, parts))
    damage%plies = figures_of(plate, along, plies, plate%layup%images)
  end function damage_of

  !> Length between the supports of the plate along an axis: that of the window of its frame, or of the plate.
  pure real(wp) function between_supports(plate, axis) result(length)
    type(composite_plate_t), intent(in) :: plate
    !> The axis
    integer, intent(in) :: axis
    integer :: i

    length = plate%setup%plate%length(axis)
    do i = 1, size(plate%setup%supports)
      associate (support => plate%setup%supports(i))
        if (support%shape == window_rectangle) length = min(length, support%window(axis))
      end associate
    end do
  end function between_supports

  !> Delamination of an interface: failed nodes of a cohesive law, or cells released by fronts.
  function delaminated(plate, now, along, zone) result(collected)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Axis of the load, and interface
    integer, intent(in) :: along, zone
    !> Contribution of this rank
    type(collected_t) :: collected
    integer :: i, column, row, lines(2)

    allocate (collected%rows(plate%mesh%cells(3 - along)), source=0.0_wp)
    associate (mesh => plate%mesh, cohesive => now%interfaces%cohesive)
      if (plate%setup%delaminations(zone)%law == law_cohesive) then
        if (.not. allocated(cohesive%cohesive)) return
        do i = 1, plate%distribution%owned
          if (plate%zone(i) /= zone .or. .not. cohesive%cohesive(i)) cycle
          if (cohesive%points(i)%damage < 1) cycle
          associate (node => mesh%point_node(plate%distribution%points(i)))
            lines = mesh%lines_of(node)
            ! Odd lines of nodes are the centre lines of rows of cells; other nodes lie between two rows.
            row = merge((lines(3 - along) + 1)/2, 0, modulo(lines(3 - along), 2) == 1)
            call collected%add(plate%interfaces%contact_area(i), abs(mesh%node_coordinates(along, node)), row)
          end associate
        end do
        return
      end if
      ! Every rank has all cells of a front; only the first rank adds them.
      if (.not. plate%communicator%is_root()) return
      associate (region => now%interfaces%contact%regions(zone))
        do row = region%rows(1), region%rows(2)
          do column = region%columns(1), region%columns(2)
            if (region%is_delaminated(column, row)) call add_cell(collected, plate, along, [column, row])
          end do
        end do
      end associate
    end associate
  end function delaminated

  !> Fibre failure of a ply.
  function fibres_failed(plate, now, along, ply) result(collected)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Axis of the load, and ply
    integer, intent(in) :: along, ply
    !> Contribution of this rank
    type(collected_t) :: collected
    integer :: i

    allocate (collected%rows(plate%mesh%cells(3 - along)), source=0.0_wp)
    if (.not. plate%setup%ply_damage%is_present) return
    associate (failed => now%plies%failed_in_elements(plate, ply), mesh => plate%mesh)
      do i = 1, plate%elements%elements
        if (.not. failed(fibre_failure, i)) cycle
        call add_cell(collected, plate, along, mesh%place_of(mesh%element_cell(plate%distribution%elements(i))))
      end do
    end associate
  end function fibres_failed

  !> Adds a failed cell.
  pure subroutine add_cell(collected, plate, along, place)
    type(collected_t), intent(inout) :: collected
    type(composite_plate_t), intent(in) :: plate
    !> Axis of the load
    integer, intent(in) :: along
    !> Column and row of the cell
    integer, intent(in) :: place(2)
    real(wp) :: middle(2)

    middle = [sum(plate%mesh%along(1)%ends(place(1))), sum(plate%mesh%along(2)%ends(place(2)))]/2
    call collected%add(plate%mesh%cell_area(place), abs(middle(along)), place(3 - along))
  end subroutine add_cell

  !> Adds a failed place.
  pure subroutine add(self, area, distance, row)
    class(collected_t), intent(inout) :: self
    !> Area, and distance from the middle along the load
    real(wp), intent(in) :: area, distance
    !> Row of cells along the load; 0: none
    integer, intent(in) :: row

    call self%area%add(area)
    call self%moment%add(area*distance)
    self%reach = max(self%reach, distance)
    if (row > 0) self%rows(row) = 1
  end subroutine add

  !> Quantities of the full plate from the contributions of all ranks. Collective.
  function figures_of(plate, along, collected, images) result(figures)
    type(composite_plate_t), intent(in) :: plate
    !> Axis of the load
    integer, intent(in) :: along
    !> Contribution of this rank for each interface or ply
    type(collected_t), intent(in) :: collected(:)
    !> Interface or ply at the images of each, itself first, (interfaces or plies, parts of the plate)
    integer, intent(in) :: images(:, :)
    !> (figures, interfaces or plies)
    real(wp) :: figures(number_of_figures, size(collected))
    real(wp) :: sums(size(collected), 2), reach(size(collected))
    real(wp) :: rows(plate%mesh%cells(3 - along), size(collected))
    integer :: i

    sums = reshape(totals_of(plate%communicator, [collected%area, collected%moment]), shape(sums))
    reach = collected%reach
    call plate%communicator%maximum(reach)
    do i = 1, size(collected)
      rows(:, i) = collected(i)%rows
      call plate%communicator%maximum(rows(:, i))
    end do
    figures = 0
    do i = 1, size(collected)
      associate (area => sum(sums(images(i, :), 1)), moment => sum(sums(images(i, :), 2)))
        if (.not. area > 0) cycle
        figures(figure_area, i) = area
        figures(figure_mean, i) = moment/area
      end associate
      figures(figure_reach, i) = maxval(reach(images(i, :)))
      figures(figure_width, i) = share_of_width(plate, along, rows(:, images(i, :)) > 0)
    end do
  end function figures_of

  !> Fraction of the width between the supports with failure in its rows. A strip of the plate's thickness is excluded
  !> at each side, where supports prevent opening.
  pure real(wp) function share_of_width(plate, along, failed) result(share)
    type(composite_plate_t), intent(in) :: plate
    !> Axis of the load
    integer, intent(in) :: along
    !> True for modelled rows with failure in each image, (rows, parts of the plate)
    logical, intent(in) :: failed(:, :)
    real(wp) :: widths(size(failed, 1)), middles(size(failed, 1))
    logical :: either(size(failed, 1), 2)
    integer :: signs(2, size(failed, 2)), part, side

    widths = plate%mesh%along(3 - along)%sides()
    middles = plate%mesh%along(3 - along)%middles()
    signs(:, 1) = 1
    signs(:, 2:) = image_signs(plate%setup%plate%symmetry)
    ! Rows on both sides of the line of symmetry, if it is along the load, otherwise all rows twice.
    either = .false.
    do part = 1, size(failed, 2)
      if (plate%mesh%halved(3 - along)) then
        side = merge(1, 2, signs(3 - along, part) > 0)
        either(:, side) = either(:, side) .or. failed(:, part)
      else if (signs(3 - along, part) > 0) then
        either = either .or. spread(failed(:, part), 2, 2)
      else
        either = either .or. spread(failed(size(failed, 1):1:-1, part), 2, 2)
      end if
    end do
    widths = merge(widths, 0.0_wp, abs(middles) < between_supports(plate, 3 - along)/2 - plate%layup%thickness)
    share = 0
    if (sum(widths) > 0) share = (sum(widths, mask=either(:, 1)) + sum(widths, mask=either(:, 2)))/(2*sum(widths))
  end function share_of_width

  !> Saves or loads the damage.
  subroutine visit(self, name, archive)
    class(compressed_damage_t), intent(inout) :: self
    !> Beginning of the names in the archive
    character(len=*), intent(in) :: name
    class(archive_t), intent(inout) :: archive

    logical :: known

    known = allocated(self%plies)
    call archive%item(name//'/known', known)
    if (.not. known) return
    call archive%item(name//'/interfaces', self%interfaces)
    call archive%item(name//'/plies', self%plies)
  end subroutine visit
end module compressed_damage
