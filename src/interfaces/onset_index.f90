!> Onset index of delamination: interlaminar stresses from equilibrium through the thickness over the strengths, theory
!> (D7) and (D8).
module onset_index
  use interface_strengths, only: interlaminar_strengths
  use interlaminar_stresses, only: unit_stresses_t, unit_stresses_of
  use joined_stacks, only: joined_stacks_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use ply_stacks, only: ply_stack_t
  implicit none
  private
  public :: onset_of_elements, onset_of_joined_cells

  !> A laminate with strengths of its interfaces and stresses under unit shear forces.
  type :: strengths_t
    !> Its plies
    type(ply_stack_t) :: stack
    !> In shear and opening, of the interface below each ply, (2, plies - 1)
    real(wp), allocatable :: values(:, :)
    type(unit_stresses_t) :: unit
  end type strengths_t

  !> Data for the index of a stack.
  type :: onset_t
    type(joined_stacks_t) :: stacks
    !> The different laminates, their strengths and stresses
    type(strengths_t), allocatable :: laminates(:)
  contains
    procedure :: indices
  end type onset_t

contains

  !> Largest index of the interfaces within each element and on top of it, and the ply above that interface.
  pure function onset_of_elements(plate, stacks) result(onset)
    type(composite_plate_t), intent(in) :: plate
    type(joined_stacks_t), intent(in) :: stacks
    !> Index and ply; both 0 without strengths, (2, elements)
    real(wp), allocatable :: onset(:, :)
    type(onset_t) :: self
    integer :: i, range(2), place

    self = new_onset(plate, stacks)
    allocate (onset(2, plate%elements%elements), source=0.0_wp)
    do i = 1, size(onset, 2)
      associate (element => plate%distribution%elements(i))
        ! From the interface on top of the element to the one above its last ply.
        range = plate%mesh%plies_of(element) - [1, 1]
        range(1) = max(range(1), self%stacks%plies(1, element))
        if (range(2) < range(1)) cycle
        associate (found => self%indices(plate, element, range))
          place = maxloc(found, 1)
          if (found(place) > 0) onset(:, i) = [found(place), real(range(1) + place - 1, wp)]
        end associate
      end associate
    end do
  end function onset_of_elements

  !> Index of each interface in the cells of the mesh where it lies within one layer, 0 in the others.
  pure function onset_of_joined_cells(plate, stacks) result(onset)
    type(composite_plate_t), intent(in) :: plate
    type(joined_stacks_t), intent(in) :: stacks
    !> Stress over strength, (cells of the mesh, zones)
    real(wp), allocatable :: onset(:, :)
    type(onset_t) :: self
    integer :: element, zone, below, range(2)

    self = new_onset(plate, stacks)
    associate (mesh => plate%mesh)
      allocate (onset(product(mesh%cells), size(mesh%zones)), source=0.0_wp)
      do element = 1, mesh%elements()
        range = mesh%plies_of(element) - [0, 1]
        if (.not. any(mesh%zones%below_ply >= range(1) .and. mesh%zones%below_ply <= range(2))) cycle
        associate (found => self%indices(plate, element, range))
          do zone = 1, size(mesh%zones)
            below = mesh%zones(zone)%below_ply
            if (below >= range(1) .and. below <= range(2)) &
              onset(mesh%element_cell(element), zone) = found(below - range(1) + 1)
          end do
        end associate
      end do
    end associate
  end function onset_of_joined_cells

  !> Gathers the data for indices.
  pure function new_onset(plate, stacks) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(joined_stacks_t), intent(in) :: stacks
    type(onset_t) :: self
    integer :: i

    self%stacks = stacks
    allocate (self%laminates(size(plate%layup%laminates)))
    do i = 1, size(self%laminates)
      associate (own => self%laminates(i))
        own%stack = plate%layup%laminates(i)
        own%values = interlaminar_strengths(own%stack%plies, own%stack%number, plate%setup%materials, &
                                            plate%setup%delaminations)
        own%unit = unit_stresses_of(own%stack%plies)
      end associate
    end do
  end function new_onset

  !> Indices of the interfaces below a range of plies of an element's stack.
  pure function indices(self, plate, element, range)
    class(onset_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Element of the mesh
    integer, intent(in) :: element
    !> First and last ply
    integer, intent(in) :: range(2)
    !> Index below each
    real(wp) :: indices(range(2) - range(1) + 1)
    real(wp), allocatable :: all(:)
    type(ply_stack_t) :: joined
    type(unit_stresses_t) :: unit
    integer :: places(2), place, i

    associate (first => self%stacks%plies(1, element), last => self%stacks%plies(2, element), &
               force => self%stacks%force(:, element), gradient => self%stacks%gradient(:, :, element), &
               own => self%laminates(plate%mesh%layers(plate%mesh%element_layer(element))%laminate))
      if (own%stack%lies_within(first, last)) then
        all = own%unit%onset_indices(own%values, force, gradient)
        places = [1, size(own%stack%plies)]
      else
        joined = own%stack%layer(first, last)
        unit = unit_stresses_of(joined%plies)
        places = joined%places()
        all = unit%onset_indices(own%values(:, places(1):places(2) - 1), force, gradient)
      end if
      indices = 0
      do i = 1, size(indices)
        place = own%stack%place(range(1) + i - 1)
        ! The bond on the struck face is above the first ply of the laminate.
        if (range(1) + i == 1) place = own%stack%place(1) - 1
        place = place - places(1) + 1
        if (place >= 1 .and. place <= size(all)) indices(i) = all(place)
      end do
    end associate
  end function indices
end module onset_index
