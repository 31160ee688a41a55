!> Where delaminations would begin: interlaminar shear by equilibrium through the thickness, over the strength.
module onset_index
  use element_batches, only: first_element, lanes
  use interface_strengths, only: shear_strengths
  use interlaminar_shear, only: onset_indices, shear_under_unit_forces
  use kinds, only: wp
  use models, only: model_t
  use strain_recovery, only: mean_strains
  implicit none
  private
  public :: onset_of_elements, onset_of_joined_cells

contains

  !> Largest shear stress over strength in the interfaces within each element and on top of it, and the ply above that
  !> interface. Layers that are joined in a cell, less than half of their area delaminated, make one stack; its shear
  !> force is the sum of theirs. Stresses of opening are left out: under a load from above, equilibrium through the
  !> thickness presses the plies together. All ranks must call together.
  function onset_of_elements(model, stiffness, delaminated, displacement) result(onset)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Part of each element's area that has delaminated above it, (1, elements)
    real(wp), intent(in) :: delaminated(:, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Index and ply, (2, elements)
    real(wp), allocatable :: onset(:, :)
    real(wp), allocatable :: everywhere(:, :), strengths(:)
    integer :: i

    strengths = shear_strengths(model%plies, model%scene%materials, model%scene%delaminations)
    everywhere = gathered(model, stiffness, delaminated, displacement)
    allocate (onset(2, model%elements%elements), source=0.0_wp)
    do i = 1, size(onset, 2)
      onset(:, i) = onset_in_stack(model, strengths, everywhere, model%distribution%elements(i))
    end do
  end function onset_of_elements

  !> The index of each interface in the cells of the mesh whose layers it does not part, 0 in the others. All ranks must
  !> call together and find the same.
  function onset_of_joined_cells(model, stiffness, delaminated, displacement) result(onset)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Part of each element's area that has delaminated above it, (1, elements)
    real(wp), intent(in) :: delaminated(:, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Shear stress over strength, (cells of the mesh, zones)
    real(wp), allocatable :: onset(:, :)
    real(wp), allocatable :: everywhere(:, :), strengths(:), undivided(:, :, :)
    integer :: cell, zone, element

    strengths = shear_strengths(model%plies, model%scene%materials, model%scene%delaminations)
    everywhere = gathered(model, stiffness, delaminated, displacement)
    undivided = shear_under_unit_forces(model%plies)
    allocate (onset(product(model%mesh%cells), size(model%mesh%zones)), source=0.0_wp)
    do zone = 1, size(onset, 2)
      do cell = 1, size(onset, 1)
        associate (mesh => model%mesh, below => model%mesh%zones(zone)%below_ply)
          element = mesh%element_at(cell, below)
          if (mesh%element_plies(2, element) == below .or. .not. strengths(below) > 0) cycle
          if (all(mesh%element_plies(:, element) == [1, size(model%plies)])) then
            onset(cell, zone) = norm2(matmul(undivided(:, :, below), everywhere(1:2, element)))/strengths(below)
          else
            onset(cell, zone) = onset_below(model, strengths, everywhere, element, below)
          end if
        end associate
      end do
    end do
  end function onset_of_joined_cells

  !> Index of the interface below a ply within an element, from the stack of joined layers that the element is in.
  pure real(wp) function onset_below(model, strengths, everywhere, element, ply) result(onset)
    type(model_t), intent(in) :: model
    !> Strength of the interface below each ply
    real(wp), intent(in) :: strengths(:)
    !> What gathered returns
    real(wp), intent(in) :: everywhere(:, :)
    !> Element of the mesh, and the ply
    integer, intent(in) :: element, ply
    real(wp), allocatable :: indices(:)
    integer :: first

    call find_stack_indices(model, strengths, everywhere, element, first, indices)
    onset = indices(ply - first + 1)
  end function onset_below

  !> Indices of all interfaces in the stack of joined layers that an element is in.
  pure subroutine find_stack_indices(model, strengths, everywhere, element, first, indices)
    type(model_t), intent(in) :: model
    !> Strength of the interface below each ply
    real(wp), intent(in) :: strengths(:)
    !> What gathered returns
    real(wp), intent(in) :: everywhere(:, :)
    !> Element of the mesh
    integer, intent(in) :: element
    !> First ply of the stack
    integer, intent(out) :: first
    !> Index below each of its plies but the last
    real(wp), allocatable, intent(out) :: indices(:)
    integer :: stack(2), last

    stack = joined_elements(model, everywhere, element)
    first = model%mesh%element_plies(1, stack(1))
    last = model%mesh%element_plies(2, stack(2))
    indices = onset_indices(model%plies(first:last), strengths(first:last - 1), &
                            sum(everywhere(1:2, stack(1):stack(2)), 2))
  end subroutine find_stack_indices

  !> First and last element of the stack of joined layers that an element is in.
  pure function joined_elements(model, everywhere, element) result(stack)
    type(model_t), intent(in) :: model
    !> What gathered returns
    real(wp), intent(in) :: everywhere(:, :)
    !> Element of the mesh
    integer, intent(in) :: element
    !> First and last
    integer :: stack(2)

    stack = element
    associate (first => model%mesh%first_element, cell => model%mesh%element_cell(element))
      do while (stack(1) > first(cell))
        if (everywhere(3, stack(1)) >= 0.5_wp) exit
        stack(1) = stack(1) - 1
      end do
      do while (stack(2) < first(cell + 1) - 1)
        if (everywhere(3, stack(2) + 1) >= 0.5_wp) exit
        stack(2) = stack(2) + 1
      end do
    end associate
  end function joined_elements

  !> Shear forces and delaminated parts of all elements of the mesh. All ranks must call together.
  function gathered(model, stiffness, delaminated, displacement) result(everywhere)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Part of each element's area that has delaminated above it, (1, elements)
    real(wp), intent(in) :: delaminated(:, :)
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Qx, Qy, delaminated part, (3, elements of the mesh)
    real(wp), allocatable :: everywhere(:, :)
    real(wp), allocatable :: motion(:, :), list(:)
    real(wp) :: means(lanes, 8)
    integer :: b, lane, i

    allocate (everywhere(3, model%mesh%elements()), source=0.0_wp)
    motion = model%motion_of(displacement)
    do b = 1, model%elements%batches
      call mean_strains(model%elements, b, model%scene%kinematics, motion, means)
      do lane = 1, model%elements%lanes_used(b)
        i = first_element(b) + lane - 1
        associate (s => stiffness(lane, 19:21, b), shear => means(lane, 7:8))
          everywhere(:, model%distribution%elements(i)) = &
            [s(1)*shear(1) + s(2)*shear(2), s(2)*shear(1) + s(3)*shear(2), delaminated(1, i)]
        end associate
      end do
    end do
    list = reshape(everywhere, [size(everywhere)])
    call model%communicator%sum(list)
    everywhere = reshape(list, shape(everywhere))
  end function gathered

  !> Index of an element from the stack of joined layers that it is in.
  pure function onset_in_stack(model, strengths, everywhere, element) result(onset)
    type(model_t), intent(in) :: model
    !> Strength of the interface below each ply
    real(wp), intent(in) :: strengths(:)
    !> What gathered returns
    real(wp), intent(in) :: everywhere(:, :)
    !> Element of the mesh
    integer, intent(in) :: element
    !> Index and ply above the interface; both 0 where no strength is known
    real(wp) :: onset(2)
    real(wp), allocatable :: indices(:)
    integer :: first, within(2), place

    call find_stack_indices(model, strengths, everywhere, element, first, indices)
    ! From the interface on top of the element to the one above its last ply.
    within = [max(1, model%mesh%element_plies(1, element) - first), model%mesh%element_plies(2, element) - first]
    onset = 0
    if (within(2) < within(1)) return
    place = within(1) + maxloc(indices(within(1):within(2)), 1) - 1
    if (indices(place) > 0) onset = [indices(place), real(first + place - 1, wp)]
  end function onset_in_stack
end module onset_index
