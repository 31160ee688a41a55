!> Sections of plies whose moduli along the fibres in tension and in compression differ, without softening plies.
module bimodular_sections
  use batch_resultants, only: element_means
  use element_batches, only: batch_of, first_element, lane_of, lanes
  use kinds, only: wp
  use mean_sections, only: mean_sections_t, new_mean_sections
  use mean_stiffnesses, only: change_values, mean_change, sub_ply_middle, mean_strains_at
  use composite_plates, only: composite_plate_t
  use plies, only: elasticity_t, compressed, uniaxial_strain
  use ply_stacks, only: ply_stack_t
  use section_laws, only: section_law_t
  implicit none
  private
  public :: bimodular_sections_t, new_bimodular_sections

  !> The sections.
  type, extends(section_law_t) :: bimodular_sections_t
    !> Their changes by compressed sub-plies
    type(mean_sections_t) :: signs
    !> Resultants of stress-free strains with these changes, (lanes, 7, batches)
    real(wp), allocatable :: free(:, :, :)
    !> The same with the moduli in tension
    real(wp), allocatable, private :: tensile(:, :, :)
    !> The different stacks of elements
    type(ply_stack_t), allocatable, private :: stacks(:)
    !> Stack of each element, (elements)
    integer, allocatable, private :: stack(:)
    !> Constants of the stack of elements with failed plies, (plies, elements); allocated where plies may fail
    type(elasticity_t), allocatable, private :: constants(:, :)
    !> True for these elements
    logical, allocatable, private :: failed(:)
  contains
    procedure :: soften
    procedure :: reduce
  end type bimodular_sections_t

contains

  !> Sections without strains.
  function new_bimodular_sections(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(bimodular_sections_t) :: self

    self%signs = new_mean_sections(plate)
    allocate (self%free(lanes, 7, plate%elements%batches), source=0.0_wp)
    if (allocated(plate%layup%free)) self%free = plate%layup%free
    self%tensile = self%free
    self%stacks = plate%layup%stacks
    self%stack = plate%layup%stack
    allocate (self%failed(plate%elements%elements), source=.false.)
    if (plate%setup%ply_damage%is_present) allocate (self%constants(plate%layup%plies, plate%elements%elements))
  end function new_bimodular_sections

  !> Takes over the reduced constants of the plies of an element.
  subroutine reduce(self, element, constants, tensile)
    class(bimodular_sections_t), intent(inout) :: self
    integer, intent(in) :: element
    !> Its constants in tension
    type(elasticity_t), intent(in) :: constants(:)
    !> Resultants of stress-free strains with them
    real(wp), intent(in) :: tensile(7)

    self%failed(element) = .true.
    self%constants(:size(constants), element) = constants
    self%tensile(lane_of(element), :, batch_of(element)) = tensile
  end subroutine reduce

  !> Resultants of a batch under trial strains. The stiffness is that of tension.
  subroutine soften(self, b, weight, strains, stiffness, free)
    !> The sections; store the resultants
    class(bimodular_sections_t), intent(inout) :: self
    integer, intent(in) :: b
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    !> Section stiffness
    real(wp), intent(inout) :: stiffness(lanes, 21)
    !> Resultants of stress-free strains
    real(wp), intent(inout), optional :: free(lanes, 7)
    real(wp) :: means(lanes, 6)
    logical :: undamaged(lanes)
    integer :: lane, element

    means = element_means(weight, strains)
    undamaged = .true.
    do lane = 1, min(lanes, size(self%failed) - first_element(b) + 1)
      element = first_element(b) + lane - 1
      undamaged(lane) = .not. self%failed(element)
      if (self%failed(element)) call self%signs%set_element(element, change_of(self, element, means(lane, :)))
    end do
    call self%signs%update(b, means, undamaged)
    self%free(:, :, b) = self%tensile(:, :, b) + self%signs%resultants(b, means)
    if (present(free)) free = self%free(:, :, b)
  end subroutine soften

  !> Change of the section of an element with failed plies.
  pure function change_of(self, element, means) result(change)
    type(bimodular_sections_t), intent(in) :: self
    integer, intent(in) :: element
    !> Its mean strains
    real(wp), intent(in) :: means(6)
    !> The change
    real(wp) :: change(change_values)
    real(wp) :: z
    integer :: ply, number

    change = 0
    associate (plies => self%stacks(self%stack(element))%plies)
      do ply = 1, size(plies)
        do number = 1, plies(ply)%sub_plies
          z = sub_ply_middle(plies(ply), number)
          associate (constants => self%constants(ply, element))
            if (uniaxial_strain(constants, mean_strains_at(plies(ply), means, z)) < 0) &
              change = change + mean_change(plies(ply), constants, compressed(constants), z)
          end associate
        end do
      end do
    end associate
  end function change_of
end module bimodular_sections
