!> Stable step of central differences before there is a model: that of the smallest element with all its layers.
!>
!> The grid is a tensor product of lines along x and y, so that one of its elements has the shortest side along both.
!> With equal sections this element has the highest frequency; with scaled inertia the frequencies of longer ones are
!> about the same. Before layers are inserted the step of a run is longer; the contact reduces it (`nose_steps`).
module element_steps
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use errors, only: error_t
  use inertia_scaling, only: inertia_scaling_t, create_inertia_scaling
  use kinds, only: wp
  use mesh_parameters, only: edge_free, mesh_t, symmetry_none
  use model_building, only: create_model
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use ply_failures, only: ply_failure_t, new_ply_failure
  use setups, only: setup_t
  use section_bounds, only: largest_stiffness
  use stable_steps, only: find_stiffened_frequency, highest_element_frequency
  implicit none
  private
  public :: smallest_element_step, small_setup

contains

  !> Longest stable step, of all plies that the plate has somewhere; 0: not found.
  real(wp) function smallest_element_step(deck, slope) result(step)
    !> The deck, its mesh checked
    type(deck_t), intent(in) :: deck
    !> Slope of the plate, the largest of a half sine, whose membrane strain is the mean of half the squared slope; 0 if
    !> absent
    real(wp), intent(in), optional :: slope
    logical, allocatable :: known(:, :)
    real(wp), allocatable :: shares(:)
    integer :: i, stringer

    call deck%setup%zones%find_shares(deck%setup%plate%length, known, shares)
    step = huge(step)
    do i = 1, size(shares)
      if (.not. shares(i) > 0) cycle
      do stringer = 0, size(deck%setup%stringers)
        step = min(step, step_of_plies(deck, known(:, i), stringer, slope))
      end do
    end do
    if (step >= huge(step)) step = 0
  end function smallest_element_step

  !> Longest stable step of the smallest element with the plies that the plate has where some zones are, and with one of
  !> the stringers on it; 0: not found.
  real(wp) function step_of_plies(deck, here, stringer, slope) result(step)
    !> The deck, its mesh checked
    type(deck_t), intent(in) :: deck
    !> True for these zones
    logical, intent(in) :: here(:)
    !> The stringer; 0: none
    integer, intent(in) :: stringer
    !> Slope of the plate; 0 if absent
    real(wp), intent(in), optional :: slope
    type(setup_t) :: setup
    type(model_t) :: model
    type(ply_failure_t) :: plies
    type(communicator_t) :: alone
    type(inertia_scaling_t) :: scaling
    type(error_t), allocatable :: error
    real(wp), allocatable :: of_elements(:, :)
    real(wp) :: frequency, steep
    integer :: element, direction

    step = 0
    setup = small_setup(deck, 2, here)
    if (stringer > 0) then
      setup%stringers = [deck%setup%stringers(stringer)]
      setup%stringers(1)%at = 0
      setup%stringers(1)%ends = [-setup%plate%length(setup%stringers(1)%along), &
                                 setup%plate%length(setup%stringers(1)%along)]/2
    end if
    call create_model(setup, alone, model, error)
    if (allocated(error)) return
    plies = new_ply_failure(model%plate)
    scaling = create_inertia_scaling(deck%setup, deck%stepping%central%mass_scaling)
    call highest_element_frequency(model%plate, largest_stiffness(plies), scaling, frequency, element, of_elements)
    if (present(slope)) then
      do direction = 1, 2
        call find_stiffened_frequency(model%plate, largest_stiffness(plies), of_elements, &
                                      sloped_motion(model%plate, slope, direction), steep)
        frequency = max(frequency, steep)
      end do
    end if
    if (frequency > 0) step = 2/frequency
  end function step_of_plies

  !> Motion of a plate with a uniform slope along one direction and the membrane strain of a half sine with this largest
  !> slope, a quarter of its square. The uniform slope causes a strain of half the square, the in-plane displacement one
  !> of minus a quarter.
  pure function sloped_motion(plate, slope, direction) result(motion)
    type(composite_plate_t), intent(in) :: plate
    !> The slope
    real(wp), intent(in) :: slope
    integer, intent(in) :: direction
    !> (5, points)
    real(wp) :: motion(5, plate%mesh%points())
    integer :: point

    motion = 0
    do point = 1, size(motion, 2)
      associate (place => plate%mesh%node_coordinates(direction, plate%mesh%point_node(point)))
        motion(3, point) = slope*place
        motion(direction, point) = -slope**2/4*place
      end associate
    end do
  end function sloped_motion

  !> A free plate of the smallest elements, layered wherever an interface may delaminate.
  pure function small_setup(deck, cells, here) result(setup)
    type(deck_t), intent(in) :: deck
    !> Elements along each side
    integer, intent(in) :: cells
    !> True for the doublers and ply drops that it has
    logical, intent(in) :: here(:)
    type(setup_t) :: setup
    type(cell_line_t) :: line
    integer :: i

    setup%materials = deck%setup%materials
    setup%laminate = deck%setup%laminate
    setup%zones = deck%setup%zones%everywhere(here)
    setup%delaminations = deck%setup%delaminations
    do i = 1, 2
      line = cells_along(deck%setup%plate, deck%setup%mesh, i)
      setup%plate%length(i) = cells*minval(line%sides())
    end do
    setup%plate%edges = edge_free
    setup%plate%symmetry = symmetry_none
    setup%mesh = mesh_t(elements=cells, grading=1, shear=deck%setup%mesh%shear, mass=deck%setup%mesh%mass, &
                        kinematics=deck%setup%mesh%kinematics)
    do i = 1, size(setup%delaminations)
      associate (d => setup%delaminations(i))
        d%zone = setup%plate%length
        d%zone_at = 0
        d%is_adaptive = .false.
        d%starter = 0
        d%starter_strip = 0
      end associate
    end do
  end function small_setup
end module element_steps
