!> Sudden failure of the plies of every element, irreversible in each mode (section 3.2 of the paper), and the reduced
!> elastic constants.
module failed_modes
  use field_mappings, only: ply_field
  use kinds, only: wp
  use archives, only: archive_t
  use plies, only: elasticity_t
  use ply_damage_parameters, only: failure_modes
  use degradation, only: degraded
  use composite_plates, only: composite_plate_t
  use criterion_strains, only: mean_strains_of_elements
  use ply_criteria, only: failure_measures
  implicit none
  private
  public :: failed_modes_t, new_failed_modes

  !> Failed modes in this rank's elements.
  type :: failed_modes_t
    !> True for failed modes, (modes, plies, elements); unallocated: not modelled
    logical, allocatable, private :: occurred(:, :, :)
  contains
    procedure :: find
    procedure :: elasticity
    procedure :: elasticities
    procedure :: failed
    procedure :: visit
  end type failed_modes_t

contains

  !> No failure.
  pure function new_failed_modes(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(failed_modes_t) :: self

    if (.not. plate%setup%ply_damage%is_present) return
    allocate (self%occurred(failure_modes, plate%layup%plies, plate%elements%elements), source=.false.)
  end function new_failed_modes

  !> Finds the modes whose criteria are met for the first time.
  subroutine find(self, plate, stiffness, displacement, found)
    class(failed_modes_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> True for elements with a new failure, (elements)
    logical, allocatable, intent(out) :: found(:)
    real(wp), allocatable :: strains(:, :)
    logical, allocatable :: failing(:, :)
    integer :: element

    strains = mean_strains_of_elements(plate, displacement)
    allocate (found(size(strains, 2)))
    do element = 1, size(found)
      associate (plies => plate%layup%stacks(plate%layup%stack(element))%number)
        failing = failure_measures(plate, stiffness, element, self%elasticities(plate, element), &
                                   strains(:, element)) >= 1 .and. .not. self%occurred(:, plies, element)
        self%occurred(:, plies, element) = self%occurred(:, plies, element) .or. failing
      end associate
      found(element) = any(failing)
    end do
  end subroutine find

  !> Reduced elastic constants of a ply of an element.
  pure function elasticity(self, plate, ply, element)
    class(failed_modes_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Ply of the laminate, and element of this rank that has it
    integer, intent(in) :: ply, element
    !> Constants of the ply
    type(elasticity_t) :: elasticity

    associate (stack => plate%layup%stacks(plate%layup%stack(element)))
      elasticity = stack%plies(stack%place(ply))%elasticity
    end associate
    if (allocated(self%occurred)) &
      elasticity = degraded(elasticity, self%occurred(:, ply, element), plate%setup%ply_damage)
  end function elasticity

  !> Reduced elastic constants of the plies of an element.
  pure function elasticities(self, plate, element) result(elasticity)
    class(failed_modes_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: element
    !> Constants of the element's plies
    type(elasticity_t), allocatable :: elasticity(:)
    integer :: i

    associate (plies => plate%layup%stacks(plate%layup%stack(element))%number)
      allocate (elasticity(size(plies)))
      do i = 1, size(plies)
        elasticity(i) = self%elasticity(plate, plies(i), element)
      end do
    end associate
  end function elasticities

  !> Failed modes of a ply of an element.
  pure function failed(self, ply, element)
    class(failed_modes_t), intent(in) :: self
    !> Ply of the laminate, and element of this rank
    integer, intent(in) :: ply, element
    !> True for failed modes
    logical :: failed(failure_modes)

    failed = self%occurred(:, ply, element)
  end function failed

  !> Saves or loads the modes.
  subroutine visit(self, archive, plate)
    class(failed_modes_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    logical, allocatable :: of_images(:, :, :)
    real(wp), allocatable :: table(:, :)
    integer :: element, ply, i

    if (.not. allocated(self%occurred)) return
    of_images = self%occurred
    do i = 2, size(plate%layup%images, 2)
      of_images = of_images .or. self%occurred(:, plate%layup%images(:, i), :)
    end do
    table = reshape(merge(1.0_wp, 0.0_wp, of_images), [size(self%occurred, 1)*size(self%occurred, 2), &
                                                          size(self%occurred, 3)])
    call archive%field('ply_failure/occurred', plate%distribution%elements, plate%mesh%elements(), table, ply_field)
    self%occurred = reshape(table, shape(self%occurred)) > 0
    ! The loaded state may be that of an element with more plies.
    do element = 1, size(self%occurred, 3)
      do ply = 1, size(self%occurred, 2)
        if (.not. plate%layup%stacks(plate%layup%stack(element))%has(ply)) self%occurred(:, ply, element) = .false.
      end do
    end do
  end subroutine visit
end module failed_modes
